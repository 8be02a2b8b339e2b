//! WebSocket of a page: one task receives, another one sends. The sender limits the number of
//! frames that the page has not displayed, and always sends the newest, so a slow page skips frames
//! instead of using memory. A page that sends faster than the session works is read more slowly.

use crate::access::Peer;
use crate::edits;
use crate::message::{PageMessage, ServerMessage};
use crate::state::ServerState;
use crate::wheel::PageId;
use axum::extract::ws::{Message, WebSocket};
use futures_util::StreamExt;
use futures_util::stream::SplitStream;
use juggler_session::Edit;
use juggler_session::wire::EditMessage;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::timeout;

mod sender;

/// Reason why a page that only watches is refused an edit.
const WATCHES: &str = "another page controls the session";
/// Maximum number of queued answers.
const ANSWERS: usize = 8;
/// Maximum number of pending edits; a page waits beyond it.
const MAX_PENDING_EDITS: u64 = 256;
/// Maximum time of such a wait.
const MAX_WAIT: Duration = Duration::from_secs(1);

/// Serves a page until it disconnects.
pub async fn run(socket: WebSocket, state: Arc<ServerState>, peer: Peer) {
    let id = state.new_page();
    state.change_wheel(|wheel| wheel.add(id));
    let (sink, stream) = socket.split();
    let (answers, waiting) = mpsc::channel(ANSWERS);
    let (displayed, acknowledged) = watch::channel(0);
    let sender = sender::Sender::new(Arc::clone(&state), id, sink, acknowledged);
    let mut listener = Listener { state: Arc::clone(&state), peer, id, answers, displayed };
    // Each task ends the other one.
    let why = tokio::select! {
        why = listener.run(stream) => why,
        () = sender.run(waiting) => None,
    };
    if let Some(why) = why {
        state.refusals.log(peer.remote, &why);
    }
    state.change_wheel(|wheel| wheel.remove(id));
}

struct Listener {
    state: Arc<ServerState>,
    peer: Peer,
    id: PageId,
    answers: mpsc::Sender<String>,
    displayed: watch::Sender<u32>,
}

impl Listener {
    /// Listens until the page disconnects or violates the protocol, and returns the violation.
    async fn run(&mut self, mut stream: SplitStream<WebSocket>) -> Option<String> {
        loop {
            let message = match timeout(self.state.limits.silence, stream.next()).await {
                Ok(Some(Ok(message))) => message,
                Ok(Some(Err(error))) => return log_entry(&error),
                Ok(None) => return None,
                Err(_) => return Some("a page was silent for too long".into()),
            };
            match message {
                Message::Text(text) => self.receive(&text).await,
                Message::Binary(_) => self.refuse("pages must send text messages, not binary ones").await,
                Message::Close(_) => return None,
                Message::Ping(_) | Message::Pong(_) => {}
            }
        }
    }

    async fn receive(&mut self, text: &str) {
        match serde_json::from_str(text) {
            Ok(PageMessage::Edit(message)) => self.edit(*message).await,
            Ok(PageMessage::Ack(serial)) => {
                self.displayed.send_replace(serial);
            }
            Ok(PageMessage::Probe(pixel)) => self.probe(pixel).await,
            Ok(PageMessage::Dropped(number)) => self.open_dropped(number).await,
            Ok(PageMessage::Steer(_)) => self.state.change_wheel(|wheel| wheel.take(self.id)),
            Ok(PageMessage::Here(_)) => {}
            Err(error) => self.refuse(&format!("a message is invalid at column {}", error.column())).await,
        }
    }

    async fn open_dropped(&mut self, number: u64) {
        if !self.try_steer() {
            return self.answer(&ServerMessage::Refused(WATCHES)).await;
        }
        match self.state.uploads.take(number) {
            Some(files) => drop(self.state.session.edit(Edit::Files(files))),
            None => self.answer(&ServerMessage::Refused("other files were dropped in the meantime")).await,
        }
    }

    async fn edit(&mut self, message: EditMessage) {
        if !self.try_steer() {
            return self.answer(&ServerMessage::Refused(WATCHES)).await;
        }
        let revision = match edits::read(message, self.state.scene.as_deref(), self.peer.is_local()) {
            Ok(Ok(edit)) => self.state.session.edit(edit),
            Ok(Err(error)) => self.state.session.report_unread(error),
            Err(why) => return self.refuse(&why).await,
        };
        let _ = timeout(MAX_WAIT, self.wait_for_session(revision)).await;
    }

    /// Returns whether this page steers; it takes the wheel if no page has it.
    fn try_steer(&self) -> bool {
        let (mine, free) = {
            let wheel = self.state.wheel();
            (wheel.is_steered_by(self.id), wheel.is_free())
        };
        if free {
            self.state.change_wheel(|wheel| wheel.take(self.id));
        }
        mine || free
    }

    /// Waits until the number of pending edits is below the limit.
    async fn wait_for_session(&self, revision: u64) {
        let mut updates = self.state.updates();
        while revision.saturating_sub(self.state.session.status().revision) > MAX_PENDING_EDITS {
            if updates.changed().await.is_err() {
                return;
            }
        }
    }

    async fn probe(&self, pixel: [u32; 2]) {
        let session = self.state.session.clone();
        if let Ok(probe) = tokio::task::spawn_blocking(move || session.probe(pixel)).await {
            self.answer(&ServerMessage::Probe(probe)).await;
        }
    }

    async fn refuse(&self, why: &str) {
        self.state.refusals.log(self.peer.remote, why);
        self.answer(&ServerMessage::Refused(why)).await;
    }

    /// Queues an answer; waits while the queue is full.
    async fn answer(&self, answer: &ServerMessage<'_>) {
        let _ = self.answers.send(answer.text()).await;
    }
}

/// Returns the log entry of an error; `None` if the page merely disconnected.
fn log_entry(error: &axum::Error) -> Option<String> {
    let text = error.to_string();
    let wrong = ["too long", "too large", "UTF-8", "utf-8", "Space limit"];
    let invalid = text.contains("protocol error") && !text.contains("without closing handshake");
    (invalid || wrong.iter().any(|part| text.contains(part))).then_some(text)
}
