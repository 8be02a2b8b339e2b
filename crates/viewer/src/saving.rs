//! Saving a picture: on a thread of its own, since large pictures take a while to encode.

use crate::title::short;
use juggler_session::Session;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};

/// A path to save to, and how the last attempt went.
#[derive(Default)]
pub struct Saving {
    /// What stands in the field; empty stands for [`Saving::path`]'s choice.
    pub text: String,
    /// What to say of the last attempt.
    pub said: Option<Result<String, String>>,
    work: Option<Receiver<Result<String, String>>>,
}

impl Saving {
    /// Where the picture goes: by default into the current folder, named after the scene.
    pub fn path(&self, scene: &str) -> PathBuf {
        match self.text.trim() {
            "" => PathBuf::from(format!("{}.png", short(scene))),
            text => PathBuf::from(text),
        }
    }

    /// Whether a picture is being written.
    pub fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// Starts to write the picture as it is now; `wake` is called when that is done.
    pub fn start(&mut self, session: &Session, scene: &str, wake: impl FnOnce() + Send + 'static) {
        if self.is_busy() {
            return;
        }
        let (session, path) = (session.clone(), self.path(scene));
        let (sender, receiver) = channel();
        let write = move || {
            let said = session.save(&path).map(|()| path.display().to_string()).map_err(|error| error.to_string());
            let _ = sender.send(said);
            wake();
        };
        match std::thread::Builder::new().name("save".into()).spawn(write) {
            Ok(_) => (self.work, self.said) = (Some(receiver), None),
            Err(error) => self.said = Some(Err(error.to_string())),
        }
    }

    /// Takes note of what was written.
    pub fn look(&mut self) {
        if let Some(said) = self.work.as_ref().and_then(|work| work.try_recv().ok()) {
            (self.said, self.work) = (Some(said), None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_found() {
        let mut saving = Saving::default();
        assert_eq!(saving.path("folder/marbles.json"), PathBuf::from("marbles.png"));
        assert_eq!(saving.path(""), PathBuf::from("picture.png"));
        saving.text = " other.exr ".into();
        assert_eq!(saving.path("marbles"), PathBuf::from("other.exr"));
    }
}
