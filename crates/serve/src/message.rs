//! What pages and server say to each other, as JSON texts. Pictures are in [`crate::picture`].

use juggler_session::{Edit, Probe, Status};
use serde::{Deserialize, Serialize};

/// What a page says: an object with one member.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FromPage {
    /// It wants a change; only the page that steers may.
    Edit(Box<Edit>),
    /// It has shown the picture with this serial number, and all before it.
    Ack(u32),
    /// It asks what is known about a pixel.
    Probe([u32; 2]),
    /// It takes the wheel.
    Steer(True),
    /// It is still there.
    Here(True),
}

/// Only `true` will do.
#[derive(Debug, Deserialize)]
#[serde(try_from = "bool")]
pub struct True;

impl TryFrom<bool> for True {
    type Error = &'static str;

    fn try_from(value: bool) -> Result<Self, Self::Error> {
        if value { Ok(Self) } else { Err("only `true` will do") }
    }
}

/// What the server says: an object with one member.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ToPage<'a> {
    /// How things stand.
    Status(&'a Status),
    /// Who steers.
    Wheel {
        /// This very page does.
        steering: bool,
        /// Nobody does.
        free: bool,
        /// Pages that are there.
        watching: usize,
    },
    /// What is known about a pixel; nothing before there is a world.
    Probe(Option<Probe>),
    /// What the page asked for is not done, and why.
    Refused(&'a str),
}

impl ToPage<'_> {
    /// As text. Nothing in it can fail to be JSON; if it did, the page would be told nothing.
    pub fn text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Whether a text is a message that a page on this machine may send, whoever steers.
pub fn is_allowed(text: &str) -> bool {
    match serde_json::from_str(text) {
        Ok(FromPage::Edit(edit)) => crate::edits::check(&edit, None, true).is_ok(),
        other => other.is_ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_message_is_an_object_with_one_member() {
        let read = |text: &str| serde_json::from_str::<FromPage>(text);
        assert!(matches!(read(r#"{"ack": 7}"#), Ok(FromPage::Ack(7))));
        assert!(matches!(read(r#"{"steer": true}"#), Ok(FromPage::Steer(_))));
        assert!(matches!(read(r#"{"edit": {"zoom": 1.5}}"#), Ok(FromPage::Edit(edit)) if *edit == Edit::Zoom(1.5)));
        assert!(matches!(read(r#"{"edit": "reload"}"#), Ok(FromPage::Edit(edit)) if *edit == Edit::Reload));
        for wrong in [r#"{"steer": false}"#, r#"{"ack": 1, "here": true}"#, r#"{"ack": -1}"#, "[]", "{}", "7", ""] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
        let deep = format!("{{\"edit\": {{\"look\": {}{}}}}}", "[".repeat(30_000), "]".repeat(30_000));
        assert!(read(&deep).is_err());
        assert_eq!(ToPage::Refused("no").text(), r#"{"refused":"no"}"#);
    }
}
