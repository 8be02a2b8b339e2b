//! What the cameras of a scene frame and focus on.

use juggler_math::{Aabb, BuildControl, Vec3};
use juggler_world::{Object, extreme_points};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What the cameras of a scene frame and focus on.
#[derive(Clone, Debug, Default)]
pub struct Subjects {
    /// Points that the default camera frames: the extreme points of all objects, or the corners of their
    /// bounding box if nothing is bounded. `None` if the scene has a camera of its own.
    pub framed_points: Option<Arc<[Vec3]>>,
    /// Middles of the objects that cameras focus on, by name; `None` if no object of the name is bounded.
    pub(super) middles: Arc<BTreeMap<String, Option<Vec3>>>,
}

/// Extreme points of objects, or the corners of `bounds` if nothing is bounded; incomplete if
/// `control` is cancelled.
pub fn points_of(objects: &[Object], bounds: &Aabb, control: &BuildControl) -> Vec<Vec3> {
    let points = extreme_points(objects, control);
    if points.is_empty() { bounds.corners().into() } else { points }
}
