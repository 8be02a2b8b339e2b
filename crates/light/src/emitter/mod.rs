//! Light sampling: selection of an emitter among many, and of a point on it, with their densities.
//!
//! This module is independent of scenes and materials: a [`LightTree`] selects among bounds of
//! emitters, and an [`AreaEmitter`] is a surface in world space.

mod area;
mod tree;

pub use area::{AreaEmitter, AreaSample, DiskEmitter, RectangleEmitter, SphereEmitter, TriangleEmitter};
pub use tree::{LightBounds, LightTree, LightTreeSample};
