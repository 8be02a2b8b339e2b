//! Sender of statuses and frames to a page.

use crate::encoded_frame::Encoding;
use crate::message::ServerMessage;
use crate::state::ServerState;
use crate::wheel::PageId;
use axum::extract::ws::{Message, WebSocket};
use futures_util::SinkExt;
use futures_util::stream::SplitSink;
use juggler_session::{Frame, Stage, Status};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until};

/// Maximum number of frames that the page has not displayed: one is displayed while the next is
/// transferred.
const IN_FLIGHT: u32 = 2;
/// Minimum time between two statuses.
const STATUS_PAUSE: Duration = Duration::from_millis(80);
/// Time after which a finished frame is sent again without loss.
const SETTLED: Duration = Duration::from_millis(250);

/// Sender with the state that its page knows.
pub struct Sender {
    state: Arc<ServerState>,
    id: PageId,
    sink: SplitSink<WebSocket, Message>,
    acknowledged: watch::Receiver<u32>,
    /// Serial number of the last frame sent.
    serial: u32,
    /// Number and kind of the last frame sent.
    sent: Option<(u64, Encoding)>,
    sent_at: Instant,
    status: Option<u64>,
    status_at: Instant,
    wheel: Option<u64>,
}

/// Error: the page has disconnected.
struct Disconnected;

impl Sender {
    /// Creates a sender for a page that knows nothing yet.
    pub fn new(
        state: Arc<ServerState>,
        id: PageId,
        sink: SplitSink<WebSocket, Message>,
        acknowledged: watch::Receiver<u32>,
    ) -> Self {
        let now = Instant::now();
        let status_at = now.checked_sub(STATUS_PAUSE).unwrap_or(now);
        Self {
            state,
            id,
            sink,
            acknowledged,
            serial: 0,
            sent: None,
            sent_at: now,
            status: None,
            status_at,
            wheel: None,
        }
    }

    /// Sends updates until the page disconnects.
    pub async fn run(mut self, mut answers: mpsc::Receiver<String>) {
        let mut updates = self.state.updates();
        let ping_interval = self.state.limits.silence / 3;
        let mut next_ping = Instant::now() + ping_interval;
        loop {
            updates.mark_unchanged();
            let Ok(due) = self.send_updates().await else { return };
            let due = due.unwrap_or(next_ping).min(next_ping);
            let message = tokio::select! {
                answer = answers.recv() => answer.map(|text| Message::Text(text.into())),
                changed = updates.changed() => if changed.is_ok() { continue } else { return },
                changed = self.acknowledged.changed() => if changed.is_ok() { continue } else { return },
                () = sleep_until(due) => {
                    if due < next_ping {
                        continue;
                    }
                    next_ping = Instant::now() + ping_interval;
                    Some(Message::Ping(Default::default()))
                }
            };
            let Some(message) = message else { return };
            if self.sink.send(message).await.is_err() {
                return;
            }
        }
    }

    /// Sends what has changed. Returns the time of the next attempt if a message is held back.
    async fn send_updates(&mut self) -> Result<Option<Instant>, Disconnected> {
        self.send_wheel().await?;
        // Read the frame first, so that the status is at least as new.
        let frame = self.state.session.frame();
        let status = self.state.session.status();
        let status_due = self.send_status(&status).await?;
        let picture_due = match frame {
            Some(frame) => self.send_frame(&frame, &status).await?,
            None => None,
        };
        Ok(status_due.into_iter().chain(picture_due).min())
    }

    async fn send_wheel(&mut self) -> Result<(), Disconnected> {
        let text = {
            let wheel = self.state.wheel();
            if self.wheel == Some(wheel.number) {
                return Ok(());
            }
            self.wheel = Some(wheel.number);
            let (steering, free, watching) = (wheel.is_steered_by(self.id), wheel.is_free(), wheel.watching());
            ServerMessage::Wheel { steering, free, watching }.text()
        };
        self.send(Message::Text(text.into())).await
    }

    async fn send_status(&mut self, status: &Status) -> Result<Option<Instant>, Disconnected> {
        if self.status == Some(status.number) {
            return Ok(None);
        }
        let due = self.status_at + STATUS_PAUSE;
        if Instant::now() < due {
            return Ok(Some(due));
        }
        (self.status, self.status_at) = (Some(status.number), Instant::now());
        self.send(Message::Text(ServerMessage::Status(status).text().into())).await?;
        Ok(None)
    }

    /// Sends the newest frame unless too many are in flight, and the finished one once more without
    /// loss.
    async fn send_frame(&mut self, frame: &Arc<Frame>, status: &Status) -> Result<Option<Instant>, Disconnected> {
        let in_flight = self.serial.saturating_sub(*self.acknowledged.borrow_and_update());
        let new = self.sent.is_none_or(|(number, _)| number != frame.number);
        if new {
            if in_flight >= IN_FLIGHT {
                return Ok(None);
            }
            let moving = status.stage == Stage::Moving || frame.samples <= 0.0;
            self.send_encoded(frame, if moving { Encoding::Moving } else { Encoding::Refining }).await?;
        }
        let exact = self.sent == Some((frame.number, Encoding::Exact));
        let finished = status.stage == Stage::Finished;
        if exact || !finished || (in_flight > 0 && !new) {
            return Ok(None);
        }
        let settled = self.sent_at + SETTLED;
        if Instant::now() < settled {
            return Ok(Some(settled));
        }
        self.send_encoded(frame, Encoding::Exact).await?;
        Ok(None)
    }

    async fn send_encoded(&mut self, frame: &Arc<Frame>, encoding: Encoding) -> Result<(), Disconnected> {
        self.sent = Some((frame.number, encoding));
        self.sent_at = Instant::now();
        let Some(encoded) = self.state.encoder.encode(frame, encoding).await else { return Ok(()) };
        self.serial = self.serial.wrapping_add(1);
        self.send(Message::Binary(encoded.message(self.serial).into())).await
    }

    async fn send(&mut self, message: Message) -> Result<(), Disconnected> {
        self.sink.send(message).await.map_err(|_| Disconnected)
    }
}
