//! A scene to walk around in: a world, a camera, a picture that becomes better while one looks at it. No window in
//! here; the native viewer, the browser's page and scripts all stand on it.
//!
//! - [`Session`]: takes [`Edit`]s, gives [`Frame`]s and its [`Status`], answers [`Probe`]s. Its work happens on threads of
//!   its own; none of its functions makes the caller wait for a picture.
//! - An edit cancels what is being rendered. What follows is first a coarse frame, as fine as the frame budget allows,
//!   then the picture itself, sample by sample, until it is the one that `juggler render` writes, to the bit.

mod coarse;
mod draw;
mod edit;
mod frame;
mod pose;
mod probe;
pub mod screen;
mod session;
mod shared;
mod status;
mod subject;
mod worker;

pub use coarse::Pace;
pub use edit::{Channel, Edit, Fly, Orbit, Setting};
pub use frame::Frame;
pub use probe::Probe;
pub use session::{Options, SaveError, Session};
pub use status::{Stage, Status};
pub use subject::{Build, Change, Subject, text_of};
