//! Extent of the objects of a scene.

use crate::path::Path;
use juggler_math::{Aabb, Transform, Vec3};
use juggler_world::Object;

/// Bounding box of all bounded objects; the box of [`or_some`] if there are none.
pub fn bounds(objects: &[Object]) -> Aabb {
    or_some(objects.iter().map(Object::bounds).fold(Aabb::EMPTY, Aabb::union))
}

/// Replaces an empty box by the cube from −1 to 1.
fn or_some(bounds: Aabb) -> Aabb {
    if bounds.is_empty() { Transform::IDENTITY.aabb(&Aabb { min: -Vec3::ONE, max: Vec3::ONE }) } else { bounds }
}

/// Path of the object that extends farthest from the origin; `entries` holds the index of the first
/// shape of each scene entry.
pub fn farthest_object(objects: &[Object], entries: &[u32]) -> Path {
    let reach = |bounds: Aabb| match bounds.is_empty() {
        true => 0.0,
        false => bounds.min.abs().max(bounds.max.abs()).max_element(),
    };
    let (mut first, mut most, mut number) = (0u64, 0.0, 0);
    for object in objects {
        let size = reach(object.bounds());
        if size > most {
            (most, number) = (size, first);
        }
        first = first.saturating_add(object.shapes());
    }
    let entry = entries.partition_point(|entry| u64::from(*entry) <= number).saturating_sub(1);
    Path::root().key("objects").index(entry)
}
