//! A window to walk around in a scene: what `juggler view` opens. The picture, the scene and the camera belong to a
//! [`Session`]; here are its window, keys and panels.
//!
//! - `keys`: every key and gesture in one table, read by the input and by the help;
//! - `controls`: what was pressed and dragged → [`Edit`](juggler_session::Edit)s, without a window;
//! - `picture`: the frame on the screen, and which pixel the pointer is on;
//! - `app` puts the rest together: `panel`, `timeline`, `chooser`, `probe`, `region`, `help`, `overlay`.

mod app;
mod chooser;
mod controls;
mod help;
mod keys;
mod lens;
mod lights;
mod overlay;
mod panel;
mod picture;
mod pilot;
mod probe;
mod rate;
mod region;
mod saving;
mod style;
mod thumbnails;
mod timeline;
mod title;

use eframe::egui;
use juggler_session::Session;

/// Width and height of the window in points when it opens.
const WINDOW: [f32; 2] = [1280.0, 800.0];
/// The smallest window.
const SMALLEST: [f32; 2] = [480.0, 320.0];

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    /// Nothing to show it on.
    #[error("no window can be opened: there is no display (neither DISPLAY nor WAYLAND_DISPLAY leads to one)")]
    NoDisplay,
    /// The system gives none: no permission, no OpenGL.
    #[error("no window can be opened: {0}")]
    NoWindow(String),
}

/// What a window is opened with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Whether it begins with the choice of scenes.
    pub choose: bool,
}

/// Shows a session in a window until that is closed.
pub fn run(session: Session, options: Options) -> Result<(), ViewerError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("juggler")
        .with_app_id("juggler")
        .with_icon(style::icon())
        .with_inner_size(WINDOW)
        .with_min_inner_size(SMALLEST);
    let native = eframe::NativeOptions { viewport, persist_window: false, ..eframe::NativeOptions::default() };
    eframe::run_native("juggler", native, Box::new(|context| Ok(Box::new(app::Viewer::new(session, options, context)))))
        .map_err(|error| match error {
            eframe::Error::WinitEventLoop(_) => ViewerError::NoDisplay,
            other => ViewerError::NoWindow(other.to_string()),
        })
}
