//! What is told to a page, and when.

use crate::hub::Hub;
use crate::message::ToPage;
use crate::picture::Kind;
use crate::wheel::PageId;
use axum::extract::ws::{Message, WebSocket};
use futures_util::SinkExt;
use futures_util::stream::SplitSink;
use juggler_session::{Frame, Stage, Status};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until};

/// Pictures on the way that the page has not shown yet: one is shown while the next one travels.
const IN_FLIGHT: u32 = 2;
/// Time between two statuses.
const STATUS_PAUSE: Duration = Duration::from_millis(80);
/// How long a picture must be finished before it is sent again without loss.
const SETTLED: Duration = Duration::from_millis(250);

/// What a page knows.
pub struct Speaker {
    hub: Arc<Hub>,
    id: PageId,
    sink: SplitSink<WebSocket, Message>,
    acknowledged: watch::Receiver<u32>,
    /// Number of the last picture that was sent.
    serial: u32,
    /// Its frame, and its kind.
    sent: Option<(u64, Kind)>,
    sent_at: Instant,
    status: Option<u64>,
    status_at: Instant,
    wheel: Option<u64>,
}

/// The page is gone.
struct Gone;

impl Speaker {
    /// Nothing is told yet.
    pub fn new(
        hub: Arc<Hub>,
        id: PageId,
        sink: SplitSink<WebSocket, Message>,
        acknowledged: watch::Receiver<u32>,
    ) -> Self {
        let now = Instant::now();
        let status_at = now.checked_sub(STATUS_PAUSE).unwrap_or(now);
        Self { hub, id, sink, acknowledged, serial: 0, sent: None, sent_at: now, status: None, status_at, wheel: None }
    }

    /// Tells what there is to tell until the page is gone.
    pub async fn run(mut self, mut answers: mpsc::Receiver<String>) {
        let mut news = self.hub.news();
        let ask = self.hub.limits.silence / 3;
        let mut next_ask = Instant::now() + ask;
        loop {
            news.mark_unchanged();
            let Ok(due) = self.tell().await else { return };
            let due = due.unwrap_or(next_ask).min(next_ask);
            let message = tokio::select! {
                answer = answers.recv() => answer.map(|text| Message::Text(text.into())),
                changed = news.changed() => if changed.is_ok() { continue } else { return },
                changed = self.acknowledged.changed() => if changed.is_ok() { continue } else { return },
                () = sleep_until(due) => {
                    if due < next_ask {
                        continue;
                    }
                    next_ask = Instant::now() + ask;
                    Some(Message::Ping(Default::default()))
                }
            };
            let Some(message) = message else { return };
            if self.sink.send(message).await.is_err() {
                return;
            }
        }
    }

    /// Tells what is new; and when to come again, if not only for news.
    async fn tell(&mut self) -> Result<Option<Instant>, Gone> {
        self.tell_wheel().await?;
        // The frame first: a status that was read later knows all about it.
        let frame = self.hub.session.frame();
        let status = self.hub.session.status();
        let status_due = self.tell_status(&status).await?;
        let picture_due = match frame {
            Some(frame) => self.show(&frame, &status).await?,
            None => None,
        };
        Ok(status_due.into_iter().chain(picture_due).min())
    }

    async fn tell_wheel(&mut self) -> Result<(), Gone> {
        let text = {
            let wheel = self.hub.wheel();
            if self.wheel == Some(wheel.number) {
                return Ok(());
            }
            self.wheel = Some(wheel.number);
            let (steering, free, watching) = (wheel.is_steered_by(self.id), wheel.is_free(), wheel.watching());
            ToPage::Wheel { steering, free, watching }.text()
        };
        self.send(Message::Text(text.into())).await
    }

    async fn tell_status(&mut self, status: &Status) -> Result<Option<Instant>, Gone> {
        if self.status == Some(status.number) {
            return Ok(None);
        }
        let due = self.status_at + STATUS_PAUSE;
        if Instant::now() < due {
            return Ok(Some(due));
        }
        (self.status, self.status_at) = (Some(status.number), Instant::now());
        self.send(Message::Text(ToPage::Status(status).text().into())).await?;
        Ok(None)
    }

    /// The newest frame, when the page has shown all but the last; the finished one once more, without loss.
    async fn show(&mut self, frame: &Arc<Frame>, status: &Status) -> Result<Option<Instant>, Gone> {
        let on_the_way = self.serial.saturating_sub(*self.acknowledged.borrow_and_update());
        let new = self.sent.is_none_or(|(number, _)| number != frame.number);
        if new {
            if on_the_way >= IN_FLIGHT {
                return Ok(None);
            }
            let moving = status.stage == Stage::Moving || frame.samples <= 0.0;
            self.picture(frame, if moving { Kind::Moving } else { Kind::Refining }).await?;
        }
        let exact = self.sent == Some((frame.number, Kind::Exact));
        let finished = status.stage == Stage::Finished;
        if exact || !finished || (on_the_way > 0 && !new) {
            return Ok(None);
        }
        let settled = self.sent_at + SETTLED;
        if Instant::now() < settled {
            return Ok(Some(settled));
        }
        self.picture(frame, Kind::Exact).await?;
        Ok(None)
    }

    async fn picture(&mut self, frame: &Arc<Frame>, kind: Kind) -> Result<(), Gone> {
        self.sent = Some((frame.number, kind));
        self.sent_at = Instant::now();
        let Some(picture) = self.hub.packer.pack(frame, kind).await else { return Ok(()) };
        self.serial = self.serial.wrapping_add(1);
        self.send(Message::Binary(picture.message(self.serial).into())).await
    }

    async fn send(&mut self, message: Message) -> Result<(), Gone> {
        self.sink.send(message).await.map_err(|_| Gone)
    }
}
