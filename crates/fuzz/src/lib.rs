//! Hostile input for every reader of the workspace.
//!
//! - [`targets`]: one function a reader, for mutations and for cargo-fuzz (folder `cargo-fuzz` of this crate);
//! - [`seeds`]: good files, made by the program's own writers;
//! - [`mutate`]: changes of a file, drawn from a fixed seed, after which checksums may be made to fit again;
//! - [`fields`]: every number of the scene format at extreme values;
//! - [`cases`]: runs such cases in a process of its own, whose address space is limited;
//! - [`bombs`]: small files that ask for much, given to the program.

pub mod bombs;
pub mod cases;
pub mod fields;
pub mod mutate;
pub mod seeds;
pub mod targets;
