//! Saving of images on a separate thread, since large images take long to encode.

use crate::title::short;
use juggler_session::Session;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};

/// Seconds for which a success is displayed.
const NOTICE_SECONDS: f64 = 5.0;

/// Destination path, and result of the last attempt.
#[derive(Default)]
pub struct Saving {
    /// Content of the path field; empty for the default of [`Saving::path`].
    pub text: String,
    /// Saved file or error, with the time in seconds.
    result: Option<(Result<String, String>, f64)>,
    /// File that is being written.
    writing: String,
    work: Option<Receiver<Result<String, String>>>,
}

impl Saving {
    /// Returns the destination; by default a file in the current folder, named after the scene.
    pub fn path(&self, scene: &str) -> PathBuf {
        match self.text.trim() {
            "" => PathBuf::from(format!("{}.png", short(scene))),
            text => PathBuf::from(text),
        }
    }

    /// Returns whether an image is being written.
    pub fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// Starts to write the current image, and calls `wake` at the end.
    pub fn start(&mut self, session: &Session, scene: &str, wake: impl FnOnce() + Send + 'static) {
        if self.is_busy() {
            return;
        }
        let (session, path) = (session.clone(), self.path(scene));
        self.writing = path.display().to_string();
        let (sender, receiver) = channel();
        let write = move || {
            let full = || std::path::absolute(&path).unwrap_or_else(|_| path.clone()).display().to_string();
            let result = session.save(&path).map(|()| full()).map_err(|error| error.to_string());
            let _ = sender.send(result);
            wake();
        };
        match std::thread::Builder::new().name("save".into()).spawn(write) {
            Ok(_) => (self.work, self.result) = (Some(receiver), None),
            Err(error) => self.result = Some((Err(error.to_string()), f64::INFINITY)),
        }
    }

    /// Polls for the result; `now` is the time in seconds.
    pub fn poll(&mut self, now: f64) {
        if let Some(result) = self.work.as_ref().and_then(|work| work.try_recv().ok()) {
            (self.result, self.work) = (Some((result, now)), None);
        }
    }

    /// Returns the message to display: the file that is being written, the saved file for some
    /// seconds, or an error until the next attempt or [`Self::dismiss`].
    pub fn notice(&self, now: f64) -> Option<Result<String, String>> {
        if self.is_busy() {
            return Some(Ok(format!("saving {}", self.writing)));
        }
        match self.result.as_ref()? {
            (Ok(file), at) => (now - at < NOTICE_SECONDS).then(|| Ok(format!("saved {file}"))),
            (Err(why), _) => Some(Err(format!("not saved: {why}"))),
        }
    }

    /// Discards the last result.
    pub fn dismiss(&mut self) {
        self.result = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn save_notice_expires_and_error_stays_until_dismissed() {
        let mut saving = Saving::default();
        assert_eq!(saving.notice(0.0), None);
        saving.result = Some((Ok("/pictures/a.png".into()), 10.0));
        assert_eq!(saving.notice(11.0), Some(Ok("saved /pictures/a.png".into())));
        assert_eq!(saving.notice(10.0 + NOTICE_SECONDS), None);
        saving.result = Some((Err("no space".into()), 10.0));
        assert_eq!(saving.notice(1000.0), Some(Err("not saved: no space".into())));
        saving.dismiss();
        assert_eq!(saving.notice(1000.0), None);
    }

    #[test]
    fn saved_file_is_named() {
        let options = juggler_session::SessionOptions { size: Some([24, 18]), threads: 1, ..Default::default() };
        let session = Session::open("one-sphere", options);
        while session.status().stage != juggler_session::Stage::Finished {
            session.wait(u64::MAX, session.status().number, std::time::Duration::from_millis(50));
        }
        let mut saving = Saving::default();
        let file = std::env::temp_dir().join(format!("juggler-saving-{}.png", std::process::id()));
        saving.text = file.display().to_string();
        let (done, woken) = channel();
        saving.start(&session, "one-sphere", move || done.send(()).unwrap());
        assert_eq!(saving.notice(0.0), Some(Ok(format!("saving {}", file.display()))));
        woken.recv().unwrap();
        saving.poll(3.0);
        assert_eq!(saving.notice(3.5), Some(Ok(format!("saved {}", file.display()))));
        std::fs::remove_file(file).unwrap();
    }

    #[test]
    fn default_file_name_follows_the_scene() {
        let mut saving = Saving::default();
        assert_eq!(saving.path("folder/marbles.json"), PathBuf::from("marbles.png"));
        assert_eq!(saving.path(""), PathBuf::from("picture.png"));
        saving.text = " other.exr ".into();
        assert_eq!(saving.path("marbles"), PathBuf::from("other.exr"));
    }
}
