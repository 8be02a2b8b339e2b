//! Bounding box of a scene in the rest pose, which is the same at all times.

use super::View;
use super::faults::Faults;
use crate::gltf::pose::Pose;
use juggler_math::{Aabb, Vec3};

/// Bounding box of the scene's meshes in the rest pose; empty without meshes.
pub fn rest_bounds(view: &View<'_>, faults: &mut Faults) -> Aabb {
    let content = view.content;
    let document = &content.data.gltf.document;
    let worlds = content.tree.world_transforms(&content.data.gltf.document, &Pose::default());
    let mut bounds = Aabb::EMPTY;
    for node in view.nodes {
        let Some(mesh) = document.nodes.get(node.index).and_then(|node| node.mesh) else { continue };
        let world = worlds.get(node.index).copied().unwrap_or_default();
        let parts = document.meshes.get(mesh.get()).map_or(0, |mesh| mesh.primitives.len());
        let slots = (0..parts).filter_map(|part| content.meshes.slot(mesh.get(), part));
        for slot in slots {
            let Some((Some(geometry), _)) = faults.take(content.meshes.get(&content.data, slot)) else { continue };
            for corner in corners(&geometry.bounds) {
                let corner = world.transform_point3(corner.as_dvec3()).as_vec3();
                bounds = Aabb { min: bounds.min.min(corner), max: bounds.max.max(corner) };
            }
        }
    }
    bounds
}

fn corners(bounds: &Aabb) -> impl Iterator<Item = Vec3> {
    let Aabb { min, max } = *bounds;
    (0..8).map(move |i| {
        Vec3::new(
            if i & 1 == 0 { min.x } else { max.x },
            if i & 2 == 0 { min.y } else { max.y },
            if i & 4 == 0 { min.z } else { max.z },
        )
    })
}

/// Diagonal of a bounding box; 1 for a box without a size.
pub fn diagonal(bounds: &Aabb) -> f64 {
    let diagonal = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).length();
    if diagonal.is_finite() && diagonal > 0.0 { diagonal } else { 1.0 }
}
