//! What ray casting is measured with: meshes that are made by rule, sets of rays on them, and a stopwatch that
//! other programs do not disturb.
//!
//! - [`meshes`]: six meshes that stress different things, each with a camera and a light;
//! - [`rays`]: six kinds of rays on any mesh, from camera rays to second bounces in random order;
//! - [`kernel`]: the ways in which a [`TriangleBvh`](juggler_bvh::TriangleBvh) can be asked;
//! - [`measure`]: rates of several tracers, taken in turns;
//! - [`clock`]: time of the processor beside that of the wall.
//!
//! `juggler bench rays` and the benchmark `embree` of `juggler-bvh` are made of these, so that their figures can
//! be compared. The same name always gives the same mesh and the same rays, bit for bit.

pub mod clock;
pub mod kernel;
pub mod measure;
pub mod meshes;
pub mod rays;

pub use meshes::{Mesh, View};
pub use rays::{Kind, RaySet};
