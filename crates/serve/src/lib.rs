//! Web server with an embedded page that controls a [`Session`](juggler_session::Session). It needs
//! no other files and fetches nothing from other servers. This crate's `README.md` describes the
//! protocol.
//!
//! - [`Server::bind`] opens the port, [`Server::start`] serves on its own threads until the
//!   [`Running`] is dropped.
//! - `access` has the access rules, [`Limits`] the resource limits, `edits` the edits that a page
//!   may send.
//! - `dropped` receives files that were dropped on a page, and `uploads` keeps them until a page opens
//!   them.
//! - `socket` serves a page's WebSocket, `encoded_frame` encodes its frames, `wheel` decides which
//!   page steers.

mod accept;
mod access;
mod assets;
mod catalog;
mod dropped;
mod edits;
mod encoded_frame;
mod message;
mod refusal_log;
mod routes;
mod server;
mod socket;
mod state;
mod uploads;
mod wheel;

pub use encoded_frame::HEADER_BYTES;
pub use message::is_allowed;
pub use server::{Limits, Running, ServeError, Server, ServerOptions};
