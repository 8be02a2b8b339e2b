//! Cameras of nodes. They look along -z of their node, with y upwards; a node's scale has no effect.

use super::Source;
use super::nodes::nodes_of_scene;
use crate::gltf::document::{Camera, CameraType};
use glam::{DAffine3, DVec3};
use indexmap::IndexMap;
use juggler_camera::{AnyCamera, Orthographic, Perspective};

/// Cameras of the nodes of a scene by name.
pub fn cameras(
    source: &Source<'_>,
    worlds: &[DAffine3],
    scene: Option<usize>,
    prefix: &str,
) -> IndexMap<String, AnyCamera> {
    let document = &source.data.gltf.document;
    let mut cameras = IndexMap::new();
    for (index, _) in nodes_of_scene(source, scene) {
        let camera = document.nodes.get(index).and_then(|node| node.camera);
        let Some(camera) = camera.and_then(|camera| document.cameras.get(camera.get())) else { continue };
        let world = worlds.get(index).copied().unwrap_or(DAffine3::IDENTITY);
        let node = source.names.nodes.get(index).map(String::as_str).unwrap_or_default();
        let name = camera.name.as_deref().filter(|name| !name.is_empty()).unwrap_or(node);
        let name = free_name(&cameras, format!("{prefix}{name}"));
        cameras.insert(name, any_camera(camera, &world));
    }
    cameras
}

fn free_name(known: &IndexMap<String, AnyCamera>, name: String) -> String {
    let mut candidate = name.clone();
    let mut number = 1u64;
    while known.contains_key(&candidate) {
        number += 1;
        candidate = format!("{name}#{number}");
    }
    candidate
}

fn any_camera(camera: &Camera, world: &DAffine3) -> AnyCamera {
    let eye = world.translation.as_vec3();
    let axis = |axis: DVec3, default: DVec3| world.transform_vector3(axis).try_normalize().unwrap_or(default).as_vec3();
    let (direction, up) = (Some(axis(DVec3::NEG_Z, DVec3::NEG_Z)), axis(DVec3::Y, DVec3::Y));
    match (camera.camera_type, &camera.orthographic, &camera.perspective) {
        (CameraType::Orthographic, Some(projection), _) => {
            let height = Some((2.0 * projection.ymag.abs()) as f32).filter(|height| *height > 0.0);
            Orthographic { eye, direction, up, height, ..Orthographic::default() }.into()
        }
        (_, _, projection) => {
            let vertical_fov_degrees = projection.map(|projection| projection.yfov.to_degrees() as f32);
            Perspective { eye, direction, up, vertical_fov_degrees, ..Perspective::default() }.into()
        }
    }
}
