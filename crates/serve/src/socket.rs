//! A page's WebSocket: one task listens to the page, one speaks to it. The speaker has at most a few pictures on
//! the way that the page has not shown, and always sends the newest; so a slow page costs pictures, not memory. A page
//! that sends faster than can be done is listened to more slowly.

use crate::access::Peer;
use crate::edits;
use crate::hub::Hub;
use crate::message::{FromPage, ToPage};
use crate::wheel::PageId;
use axum::extract::ws::{Message, WebSocket};
use futures_util::StreamExt;
use futures_util::stream::SplitStream;
use juggler_session::Edit;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::timeout;

mod speaker;

/// Answers that wait for the speaker.
const ANSWERS: usize = 8;
/// Edits that the session has not taken account of; more make the page wait.
const MOST_WAITING: u64 = 256;
/// How long it waits at most.
const PATIENCE: Duration = Duration::from_secs(1);

/// Serves a page until it goes.
pub async fn run(socket: WebSocket, hub: Arc<Hub>, peer: Peer) {
    let id = hub.new_page();
    hub.turn(|wheel| wheel.come(id));
    let (sink, stream) = socket.split();
    let (answers, waiting) = mpsc::channel(ANSWERS);
    let (shown, acknowledged) = watch::channel(0);
    let speaker = speaker::Speaker::new(Arc::clone(&hub), id, sink, acknowledged);
    let mut listener = Listener { hub: Arc::clone(&hub), peer, id, answers, shown };
    // Whoever ends first ends both.
    let why = tokio::select! {
        why = listener.run(stream) => why,
        () = speaker.run(waiting) => None,
    };
    if let Some(why) = why {
        hub.refusals.say(peer.remote, &why);
    }
    hub.turn(|wheel| wheel.go(id));
}

struct Listener {
    hub: Arc<Hub>,
    peer: Peer,
    id: PageId,
    answers: mpsc::Sender<String>,
    shown: watch::Sender<u32>,
}

impl Listener {
    /// Until the page goes, or does what ends it, which is told.
    async fn run(&mut self, mut stream: SplitStream<WebSocket>) -> Option<String> {
        loop {
            let message = match timeout(self.hub.limits.silence, stream.next()).await {
                Ok(Some(Ok(message))) => message,
                Ok(Some(Err(error))) => return complaint(&error),
                Ok(None) => return None,
                Err(_) => return Some("a page was silent for too long".into()),
            };
            match message {
                Message::Text(text) => self.hear(&text).await,
                Message::Binary(_) => self.refuse("pages send texts only").await,
                Message::Close(_) => return None,
                Message::Ping(_) | Message::Pong(_) => {}
            }
        }
    }

    async fn hear(&mut self, text: &str) {
        match serde_json::from_str(text) {
            Ok(FromPage::Edit(edit)) => self.edit(*edit).await,
            Ok(FromPage::Ack(serial)) => {
                self.shown.send_replace(serial);
            }
            Ok(FromPage::Probe(pixel)) => self.probe(pixel).await,
            Ok(FromPage::Steer(_)) => self.hub.turn(|wheel| wheel.take(self.id)),
            Ok(FromPage::Here(_)) => {}
            Err(error) => self.refuse(&format!("a message that means nothing, at column {}", error.column())).await,
        }
    }

    async fn edit(&mut self, edit: Edit) {
        if !self.steers() {
            return self.answer(&ToPage::Refused("another page steers")).await;
        }
        if let Err(why) = edits::check(&edit, self.hub.scene.as_deref(), self.peer.is_local()) {
            return self.refuse(&why).await;
        }
        let wanted = self.hub.session.edit(edit);
        let _ = timeout(PATIENCE, self.caught_up(wanted)).await;
    }

    /// Whether this page steers; a free wheel goes to whoever turns it.
    fn steers(&self) -> bool {
        let (mine, free) = {
            let wheel = self.hub.wheel();
            (wheel.is_steered_by(self.id), wheel.is_free())
        };
        if free {
            self.hub.turn(|wheel| wheel.take(self.id));
        }
        mine || free
    }

    /// Waits until the session has not too much to do.
    async fn caught_up(&self, wanted: u64) {
        let mut news = self.hub.news();
        while wanted.saturating_sub(self.hub.session.status().revision) > MOST_WAITING {
            if news.changed().await.is_err() {
                return;
            }
        }
    }

    async fn probe(&self, pixel: [u32; 2]) {
        let session = self.hub.session.clone();
        if let Ok(probe) = tokio::task::spawn_blocking(move || session.probe(pixel)).await {
            self.answer(&ToPage::Probe(probe)).await;
        }
    }

    async fn refuse(&self, why: &str) {
        self.hub.refusals.say(self.peer.remote, why);
        self.answer(&ToPage::Refused(why)).await;
    }

    /// Waits for the speaker when too many answers wait already.
    async fn answer(&self, answer: &ToPage<'_>) {
        let _ = self.answers.send(answer.text()).await;
    }
}

/// What to log of an error; pages that merely went away are no news.
fn complaint(error: &axum::Error) -> Option<String> {
    let text = error.to_string();
    let wrong = ["too long", "too large", "UTF-8", "utf-8", "Space limit"];
    let invalid = text.contains("protocol error") && !text.contains("without closing handshake");
    (invalid || wrong.iter().any(|part| text.contains(part))).then_some(text)
}
