//! Benchmark inputs and tools for ray casting: procedural meshes, sets of rays on them, and a
//! stopwatch that other programs do not disturb.
//!
//! - [`meshes`]: six meshes that stress different properties, each with a camera and a light;
//! - [`rays`]: six kinds of rays on any mesh, from camera rays to second bounces in random order;
//! - [`kernel`]: ways to trace a [`TriangleBvh`](juggler_bvh::TriangleBvh);
//! - [`measure`]: rates of several tracers, measured alternately;
//! - [`clock`]: CPU time and wall-clock time.
//!
//! `juggler bench rays` and the benchmark `embree` of `juggler-bvh` both use this crate, so their
//! figures are comparable. The same name always gives the same mesh and the same rays, bit for bit.

pub mod clock;
pub mod kernel;
pub mod measure;
pub mod meshes;
pub mod rays;

pub use meshes::{Mesh, View};
pub use rays::{Kind, RaySet};
