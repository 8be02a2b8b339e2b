//! Native viewer window, which `juggler view` opens. A [`Session`] owns image, scene and camera;
//! this crate has the window, keys and panels.
//!
//! - `keys`: table of all keys and gestures, used by the input and by the help;
//! - `controls`: conversion of key presses and drags to [`Edit`](juggler_session::Edit)s,
//!   independent of the window;
//! - `picture`: the displayed frame, and the pixel under the pointer;
//! - `app` combines the other modules: `panel`, `timeline`, `chooser`, `probe`, `region`, `help`,
//!   `overlay`.

mod app;
mod chooser;
mod controls;
mod frame_rate;
mod help;
mod keys;
mod lights;
mod models;
mod overlay;
mod panel;
mod picture;
mod pixel_extent;
mod pointer;
mod probe;
mod region;
mod saving;
mod style;
mod thumbnails;
mod timeline;
mod title;

use eframe::egui;
use juggler_session::Session;

/// Initial size of the window, in points.
const WINDOW: [f32; 2] = [1280.0, 800.0];
/// Minimum size of the window, in points.
const MIN_WINDOW: [f32; 2] = [480.0, 320.0];

/// Error of opening a window.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// There is no display.
    #[error("no window can be opened: there is no display (neither DISPLAY nor WAYLAND_DISPLAY leads to one)")]
    NoDisplay,
    /// The system refuses the window, for example without OpenGL.
    #[error("no window can be opened: {0}")]
    NoWindow(String),
}

/// Options with which a window is opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewerOptions {
    /// Whether the scene chooser is open at first.
    pub choose: bool,
}

/// Shows a session in a window; returns when the window is closed.
pub fn run(session: Session, options: ViewerOptions) -> Result<(), ViewerError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("juggler")
        .with_app_id("juggler")
        .with_icon(style::icon())
        .with_inner_size(WINDOW)
        .with_min_inner_size(MIN_WINDOW);
    let native = eframe::NativeOptions { viewport, persist_window: false, ..eframe::NativeOptions::default() };
    eframe::run_native("juggler", native, Box::new(|context| Ok(Box::new(app::Viewer::new(session, options, context)))))
        .map_err(|error| match error {
            eframe::Error::WinitEventLoop(_) => ViewerError::NoDisplay,
            other => ViewerError::NoWindow(other.to_string()),
        })
}
