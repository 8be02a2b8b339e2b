//! JSON messages between pages and server. [`crate::encoded_frame`] has the binary frames.

use juggler_session::wire::EditMessage;
use juggler_session::{PixelInfo, Status};
use serde::{Deserialize, Serialize};

/// Message from a page: an object with one member.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PageMessage {
    /// Requests an edit; only the page that steers may send it.
    Edit(Box<EditMessage>),
    /// Acknowledges that the frame with this serial number was displayed, and all before it.
    Ack(u32),
    /// Probes a pixel.
    Probe([u32; 2]),
    /// Opens the dropped files that were uploaded under this number; only the page that steers may
    /// send it.
    Dropped(u64),
    /// Takes the wheel.
    Steer(True),
    /// Keeps the connection alive.
    Here(True),
}

/// The value `true`; `false` is rejected.
#[derive(Debug, Deserialize)]
#[serde(try_from = "bool")]
pub struct True;

impl TryFrom<bool> for True {
    type Error = &'static str;

    fn try_from(value: bool) -> Result<Self, Self::Error> {
        if value { Ok(Self) } else { Err("must be `true`") }
    }
}

/// Message from the server: an object with one member.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ServerMessage<'a> {
    /// Status of the session.
    Status(&'a Status),
    /// Steering.
    Wheel {
        /// Whether the receiving page steers.
        steering: bool,
        /// Whether no page steers.
        free: bool,
        /// Number of connected pages.
        watching: usize,
    },
    /// Result of a probe; `None` before a world is built.
    Probe(Option<PixelInfo>),
    /// Reason why a request was refused.
    Refused(&'a str),
}

impl ServerMessage<'_> {
    /// Returns the message as JSON text. Serialization cannot fail; otherwise the text would be
    /// empty.
    pub fn text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Returns whether a text is a valid message from a page on this machine that steers.
pub fn is_allowed(text: &str) -> bool {
    match serde_json::from_str(text) {
        Ok(PageMessage::Edit(message)) => crate::edits::read(*message, None, true).is_ok_and(|edit| edit.is_ok()),
        other => other.is_ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_session::Edit;

    #[test]
    fn each_message_is_an_object_with_one_member() {
        let read = |text: &str| serde_json::from_str::<PageMessage>(text);
        assert!(matches!(read(r#"{"ack": 7}"#), Ok(PageMessage::Ack(7))));
        assert!(matches!(read(r#"{"steer": true}"#), Ok(PageMessage::Steer(_))));
        let edit = |text: &str| match read(text) {
            Ok(PageMessage::Edit(message)) => message.read(),
            other => panic!("{other:?}"),
        };
        assert_eq!(edit(r#"{"edit": {"zoom": 1.5}}"#), Ok(Edit::Zoom(1.5)));
        assert_eq!(edit(r#"{"edit": "reload"}"#), Ok(Edit::Reload));
        for wrong in [r#"{"steer": false}"#, r#"{"ack": 1, "here": true}"#, r#"{"ack": -1}"#, "[]", "{}", "7", ""] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
        let deep = format!("{{\"edit\": {{\"look\": {}{}}}}}", "[".repeat(30_000), "]".repeat(30_000));
        assert!(read(&deep).is_err());
        assert_eq!(ServerMessage::Refused("no").text(), r#"{"refused":"no"}"#);
    }
}
