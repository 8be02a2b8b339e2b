//! Instances of a mesh (EXT_mesh_gpu_instancing).

use crate::gltf::data::GltfData;
use crate::gltf::document::Instancing;
use crate::gltf::error::Fault;
use glam::{DAffine3, DQuat, DVec3};
use juggler_math::quaternion;

/// Transforms of the instances to the space of their node: translation · rotation · scale.
///
/// # Errors
///
/// An array is not valid, or the arrays have different lengths.
pub fn instance_transforms(data: &GltfData, node: usize, instancing: &Instancing) -> Result<Vec<DAffine3>, Fault> {
    let at = format!("/nodes/{node}/extensions/EXT_mesh_gpu_instancing");
    let named = |name: &str| instancing.attributes.iter().find(|(semantic, _)| semantic.to_string() == name);
    let translations = named("TRANSLATION").map(|(_, accessor)| data.vec3(accessor)).transpose()?;
    let rotations = named("ROTATION").map(|(_, accessor)| data.vec4(accessor)).transpose()?;
    let scales = named("SCALE").map(|(_, accessor)| data.vec3(accessor)).transpose()?;
    let lengths =
        [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    let count = lengths.into_iter().flatten().next().unwrap_or(0);
    if lengths.into_iter().flatten().any(|length| length != count) {
        return Err(Fault::at(at, "the attributes of the instances have different lengths"));
    }
    if count as u64 > data.gltf.limits.instances {
        return Err(Fault::at(at, format!("has {count} instances, the limit is {}", data.gltf.limits.instances)));
    }
    let transform = |i: usize| {
        let translation = translations.as_ref().and_then(|all| all.get(i)).map_or(DVec3::ZERO, |t| t.as_dvec3());
        let scale = scales.as_ref().and_then(|all| all.get(i)).map_or(DVec3::ONE, |s| s.as_dvec3());
        let rotation = rotations.as_ref().and_then(|all| all.get(i)).map(|r| r.map(f64::from));
        let rotation = rotation.map_or(Some(DQuat::IDENTITY), quaternion::normalized);
        rotation.map(|rotation| DAffine3::from_scale_rotation_translation(scale, rotation, translation))
    };
    let transforms: Option<Vec<DAffine3>> = (0..count).map(transform).collect();
    transforms.ok_or_else(|| Fault::at(at, "a rotation is zero"))
}
