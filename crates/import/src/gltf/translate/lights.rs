//! Lights of nodes (KHR_lights_punctual): candela are radiant intensity, lux are irradiance.

use super::Source;
use super::nodes::nodes_of_scene;
use crate::gltf::document::{LightType, PunctualLight, SpotCone};
use glam::{DAffine3, DVec3};
use juggler_light::{AnyLight, Directional, Point, Spot};
use juggler_math::Rgb;

/// Luminous efficacy by which photometric intensities are divided, in lumens per watt.
const LUMENS_PER_WATT: f64 = 683.0;

/// Lights of the nodes of a scene with the names of their nodes.
pub fn lights(
    source: &Source<'_>,
    worlds: &[DAffine3],
    scene: Option<usize>,
    photometric: bool,
) -> Vec<(String, AnyLight)> {
    let document = &source.data.gltf.document;
    let known = document.extensions.lights_punctual.as_ref().map(|lights| lights.lights.as_slice()).unwrap_or_default();
    let scale = if photometric { 1.0 / LUMENS_PER_WATT } else { 1.0 };
    let light = |(index, path): (usize, String)| {
        let extensions = document.nodes.get(index)?.extensions.as_deref()?;
        let light = known.get(extensions.light_punctual?.light.get())?;
        let world = worlds.get(index).copied().unwrap_or(DAffine3::IDENTITY);
        Some((path, any_light(light, &world, scale)))
    };
    nodes_of_scene(source, scene).into_iter().filter_map(light).collect()
}

fn any_light(light: &PunctualLight, world: &DAffine3, scale: f64) -> AnyLight {
    let [r, g, b] = light.color.map(|channel| channel as f32);
    let (color, intensity) = (Rgb::new(r, g, b), (light.intensity * scale) as f32);
    let position = world.translation.as_vec3();
    let direction = world.transform_vector3(DVec3::NEG_Z).try_normalize().unwrap_or(DVec3::NEG_Z).as_vec3();
    match light.light_type {
        LightType::Directional => Directional { direction, color, intensity, ..Directional::default() }.into(),
        LightType::Point => Point { position, color, intensity: Some(intensity), ..Point::default() }.into(),
        LightType::Spot => {
            let SpotCone { inner_cone_angle, outer_cone_angle } = light.spot.unwrap_or_default();
            let [beam_degrees, cutoff_degrees] = [inner_cone_angle, outer_cone_angle].map(|a| a.to_degrees() as f32);
            let intensity = Some(intensity);
            let beam_exponent = 0.0;
            Spot {
                position,
                direction,
                color,
                intensity,
                beam_degrees,
                cutoff_degrees,
                beam_exponent,
                ..Spot::default()
            }
            .into()
        }
    }
}
