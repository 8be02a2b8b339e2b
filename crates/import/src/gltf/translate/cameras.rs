//! Cameras of nodes. They look along -z of their node, with y upwards; scale has no effect.

use super::names::{node_name, unique};
use super::objects::View;
use crate::gltf::document::{Camera, CameraType, Document};
use glam::{DAffine3, DVec3};
use indexmap::IndexMap;
use juggler_camera::{AnyCamera, Orthographic, Perspective};
use juggler_math::Vec3;
use std::borrow::Cow;

/// Cameras of the nodes of a scene by name.
pub fn cameras(view: &View<'_>, document: &Document) -> IndexMap<String, AnyCamera> {
    let (names, cameras): (Vec<String>, Vec<AnyCamera>) = placed(view, document)
        .map(|(name, camera, world)| (format!("{}{name}", view.prefix), any_camera(camera, &world)))
        .unzip();
    unique("camera", names.iter().map(|name| Some(name.as_str()))).into_iter().zip(cameras).collect()
}

/// Names of the cameras of a scene, with width by height of their pictures.
pub fn camera_aspects(view: &View<'_>, document: &Document) -> Vec<(String, Option<f32>)> {
    let (names, aspects): (Vec<String>, Vec<Option<f32>>) =
        placed(view, document).map(|(name, camera, _)| (format!("{}{name}", view.prefix), aspect(camera))).unzip();
    unique("camera", names.iter().map(|name| Some(name.as_str()))).into_iter().zip(aspects).collect()
}

/// Cameras with the names of their own or of their nodes, and the transforms of the nodes.
fn placed<'v>(
    view: &'v View<'v>,
    document: &'v Document,
) -> impl Iterator<Item = (Cow<'v, str>, &'v Camera, DAffine3)> {
    view.nodes.iter().filter_map(|node| {
        let camera = document.cameras.get(document.nodes.get(node.index)?.camera?.get())?;
        let name = camera.name.as_deref().filter(|name| !name.is_empty()).map(Cow::Borrowed);
        let name = name.unwrap_or_else(|| node_name(document, node.index));
        Some((name, camera, view.worlds.get(node.index).copied().unwrap_or_default()))
    })
}

/// Width by height of a camera's picture, if the camera sets it.
fn aspect(camera: &Camera) -> Option<f32> {
    let aspect = match (camera.camera_type, camera.perspective, camera.orthographic) {
        (CameraType::Perspective, Some(projection), _) => projection.aspect_ratio?,
        (CameraType::Orthographic, _, Some(projection)) => (projection.xmag / projection.ymag).abs(),
        _ => return None,
    };
    Some(aspect as f32).filter(|aspect| aspect.is_finite() && *aspect > 0.0)
}

/// Camera at the place of a node.
fn any_camera(camera: &Camera, world: &DAffine3) -> AnyCamera {
    let eye = position(world);
    let (direction, up) = axes(world);
    match (camera.camera_type, camera.orthographic) {
        (CameraType::Orthographic, projection) => {
            let height = projection.map(|projection| (2.0 * projection.ymag.abs()) as f32);
            let height = height.filter(|height| height.is_finite() && *height > 0.0);
            let fit_aspect = aspect(camera);
            Orthographic { eye, direction: Some(direction), up, height, fit_aspect, ..Orthographic::default() }.into()
        }
        (CameraType::Perspective, _) => {
            let degrees = camera.perspective.map(|projection| projection.yfov.to_degrees().clamp(0.01, 179.9) as f32);
            let (direction, vertical_fov_degrees) = (Some(direction), degrees);
            let fit_aspect = aspect(camera);
            Perspective { eye, direction, up, vertical_fov_degrees, fit_aspect, ..Perspective::default() }.into()
        }
    }
}

/// Origin of a node in world space, in the range of coordinates.
pub fn position(world: &DAffine3) -> Vec3 {
    let position = world.translation.clamp(DVec3::splat(-1e30), DVec3::splat(1e30));
    if position.is_finite() { position.as_vec3() } else { Vec3::ZERO }
}

/// Direction of -z of a node in world space.
pub fn forward(world: &DAffine3) -> DVec3 {
    world.transform_vector3(DVec3::NEG_Z).try_normalize().unwrap_or(DVec3::NEG_Z)
}

/// Directions of -z and y of a node, which are not parallel.
fn axes(world: &DAffine3) -> (Vec3, Vec3) {
    let direction = forward(world);
    let up = world.transform_vector3(DVec3::Y).try_normalize().unwrap_or(DVec3::Y);
    let is_parallel = direction.cross(up).length() < 1e-6;
    let up = if is_parallel { direction.any_orthonormal_vector() } else { up };
    (direction.as_vec3(), up.as_vec3())
}
