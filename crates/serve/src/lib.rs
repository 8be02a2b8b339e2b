//! The browser's door to a [`Session`](juggler_session::Session): a small web server with its page inside. No files to
//! find, nothing fetched from elsewhere. The protocol is in this crate's `README.md`.
//!
//! - [`Server::bind`] listens, [`Server::start`] serves on threads of its own until the [`Running`] is dropped;
//! - who is let in: `access`; how much of anything there may be: [`Limits`]; what a page may ask for: `edits`;
//! - a page's socket: `socket`, its pictures: `picture`, who steers: `wheel`.

mod accept;
mod access;
mod assets;
mod catalogue;
mod edits;
mod hub;
mod message;
mod picture;
mod refusals;
mod routes;
mod server;
mod socket;
mod wheel;

pub use message::is_allowed;
pub use picture::HEADER_BYTES;
pub use server::{Limits, Options, Running, ServeError, Server};
