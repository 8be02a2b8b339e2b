//! Hostile input for every reader of the workspace.
//!
//! - [`targets`]: one function per reader, for mutations and for cargo-fuzz (folder `cargo-fuzz`);
//! - [`seeds`]: valid files, by the program's own writers where they exist;
//! - [`streams`]: seeds of compressed arrays and pictures, by the reference encoders;
//! - [`models`]: seeds of the format glTF, and its reader;
//! - [`obj`]: seeds of MTL, and the readers of OBJ models and MTL;
//! - [`mutate`]: seeded mutations of a file, with optional repair of checksums;
//! - [`fields`]: every number of the scene format at extreme values;
//! - [`cases`]: runs such cases in separate processes with a limited address space;
//! - [`bombs`]: small files that demand excessive resources, run against the program.

pub mod bombs;
pub mod cases;
pub mod fields;
pub mod models;
pub mod mutate;
pub mod obj;
pub mod seeds;
pub mod streams;
pub mod targets;
