//! A scene to walk around in: a world, a camera, a picture that becomes better while one looks at it. No window in
//! here; the native viewer, the browser's page and scripts all stand on it.
//!
//! - [`Session`]: takes [`Edit`]s, gives [`Frame`]s and its [`Status`], answers [`Probe`]s. Its work happens on threads of
//!   its own; none of its functions makes the caller wait for a picture.
//! - An edit cancels what is being rendered. What follows is first a coarse frame, as fine as the frame budget allows,
//!   then the picture itself, sample by sample, until it is the one that `juggler render` writes, to the bit.

//!
//! With the feature `native`, which is there by default. Without it there are neither threads nor clocks nor files that are
//! watched: what stands here for who brings their own, as the page that renders in the browser alone, is [`Subject`] with
//! what makes pictures of it: [`draw`], [`screen`], [`Pace`].

mod build;
mod coarse;
#[cfg(feature = "native")]
mod denoising;
pub mod draw;
mod edit;
mod frame;
mod interest;
pub mod pose;
mod probe;
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
#[cfg(feature = "native")]
mod worker;
#[cfg(feature = "native")]
mod worlds;

pub use build::{Build, MOST_PIXELS, Mistake, text_of};
pub use coarse::{Pace, coarse_size, finer};
pub use edit::{Channel, Edit, Fly, Orbit, Setting};
pub use frame::Frame;
pub use probe::Probe;
#[cfg(feature = "native")]
pub use session::{Options, SaveError, Session};
pub use status::{Stage, Status};
pub use subject::{Change, Subject};
#[cfg(feature = "native")]
pub use thumbnails::thumbnail;

#[cfg(all(doctest, feature = "native"))]
#[doc = include_str!("../README.md")]
struct Readme;
