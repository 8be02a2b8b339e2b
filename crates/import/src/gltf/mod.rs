//! The format glTF 2.0 (Khronos Group, ISO/IEC 12113): documents, decoded arrays and poses.
//!
//! The modules know the format, not scenes, except the last step. A file passes through them in
//! this order:
//!
//! | step | result |
//! |---|---|
//! | [`Gltf::open`]: container, JSON, structure | a [`document`] that is valid, and warnings |
//! | [`Gltf::load`] by [`Files`] | [`GltfData`]: the document with the contents of its buffers |
//! | [`GltfData::vec3`] and similar methods | arrays of accessors |
//! | [`GltfData::assemble`] | vertices and faces of a primitive |
//! | [`pose`] | transforms, morphed and skinned vertices at a time |
//! | [`GltfFormat`] | parts of a scene at a time |
//!
//! All bytes may be hostile. [`Limits`] bound what a file may demand, and a [`Fault`] names the
//! place of an error.

mod accessor;
mod check;
mod container;
mod data;
mod digest;
pub mod document;
pub mod draco;
mod error;
pub mod extensions;
mod format;
mod image_size;
mod json;
pub mod ktx2;
pub mod ktx2_head;
mod limits;
mod location;
mod media;
pub mod meshopt;
mod needs;
mod open;
pub mod pose;
mod primitive;
mod summary;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod translate;
mod uri;
mod warning;

pub use container::is_binary;
pub use data::GltfData;
pub use error::{Fault, GltfError, Place};
pub use format::GltfFormat;
pub(crate) use image_size::{image_size, picture_extension};
pub use juggler_scene::model::{FileError, Files};
pub use limits::Limits;
pub use open::Gltf;
pub use primitive::{Assembly, DracoArrays, DracoStream, Faces, GeometryKey, JointSet, PrimitiveArrays};
pub use warning::{Warning, Warnings};
