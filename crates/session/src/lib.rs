//! Interactive rendering session: a scene, a camera and an image that refines progressively. The
//! crate has no window; the native viewer, the browser page and scripts are its clients.
//!
//! - [`Session`] accepts [`Edit`]s, provides [`Frame`]s and its [`Status`], and returns the
//!   [`PixelInfo`] of a pixel. It works on its own threads; none of its functions blocks until an
//!   image is rendered.
//! - An edit cancels rendering. The session then renders a coarse frame, as fine as the frame
//!   budget allows, and refines it sample by sample until it is bit-identical to the image that
//!   `juggler render` writes.
//! - [`wire`] has the JSON of edits, statuses and probes.
//!
//! The default feature `native` provides threads, clocks and file watching. Clients without it,
//! such as the page that renders inside the browser, bring their own and use [`Subject`],
//! [`preview`], [`screen`] and [`RenderRate`].

mod apply;
#[cfg(feature = "native")]
mod background_build;
mod build;
mod choices;
mod coarse;
#[cfg(feature = "native")]
mod denoising;
mod edit;
mod edited_scene;
mod frame;
mod interest;
mod memory;
mod model_status;
#[cfg(feature = "native")]
mod options;
mod pixel_info;
pub mod pose;
pub mod preview;
#[cfg(feature = "native")]
mod rendering;
pub mod screen;
#[cfg(feature = "native")]
mod session;
#[cfg(feature = "native")]
mod shared;
mod status;
mod subject;
#[cfg(feature = "native")]
mod thumbnails;
#[cfg(feature = "native")]
mod watch;
pub mod wire;
#[cfg(feature = "native")]
mod worker;
#[cfg(feature = "native")]
mod worker_state;

pub use apply::EditEffect;
pub use build::{BuildError, BuildRequest, MAX_PIXELS, error_text};
pub use coarse::{RenderRate, coarse_size, next_pass};
pub use edit::{Channel, Edit, Fly, Orbit, SceneFiles, Setting};
pub use frame::Frame;
pub use model_status::ModelStatus;
#[cfg(feature = "native")]
pub use options::SessionOptions;
pub use pixel_info::PixelInfo;
#[cfg(feature = "native")]
pub use session::{SaveError, Session};
pub use status::{Stage, Status};
pub use subject::Subject;
#[cfg(feature = "native")]
pub use thumbnails::thumbnail;

#[cfg(all(doctest, feature = "native"))]
#[doc = include_str!("../README.md")]
struct Readme;
