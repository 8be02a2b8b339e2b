//! Import of other programs' scene files.
//!
//! The crate reads bytes and returns typed documents and decoded arrays; it opens no files itself
//! ([`Files`](juggler_scene::model::Files) reads the files that a document names).

pub mod gltf;
pub mod obj;
pub mod stl;
mod textures;
