//! Picking light: which of many emitters to ask, and which place of one, each with its chance.
//!
//! Nothing here knows scenes or materials: a [`LightTree`] picks among boxes that shine, an [`AreaEmitter`] is a surface
//! in world space seen from a point.

mod area;
mod tree;

pub use area::{AreaEmitter, AreaSample, DiskEmitter, RectangleEmitter, SphereEmitter, TriangleEmitter};
pub use tree::{LightBounds, LightTree, Pick};
