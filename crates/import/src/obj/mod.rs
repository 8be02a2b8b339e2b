//! The format Wavefront OBJ with libraries of materials (MTL).
//!
//! | module | holds |
//! |---|---|
//! | `format` | the format of models: objects, materials and textures with their names |
//! | `mtl` | parser of libraries of materials |
//! | `library` | the libraries and pictures of an OBJ |
//! | `files` | names of files, as other systems write them |
//! | `materials` | materials as `principled` |
//! | `pieces` | meshes by object and material, smoothing groups |
//!
//! The faces are read by [`parse_obj`](juggler_scene::import::parse_obj). All bytes may be hostile:
//! sizes are limited, and errors name file and line.

mod files;
mod format;
mod library;
mod materials;
mod mtl;
mod pieces;

pub(crate) use format::DEFAULT_MATERIAL;
pub use format::ObjFormat;
pub(crate) use materials::gray;
pub use mtl::{MtlMap, MtlMaterial, parse_mtl};
