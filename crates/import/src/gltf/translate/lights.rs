//! Lights of nodes (KHR_lights_punctual and EXT_lights_ies). Candela are taken as W/sr and lux as
//! W/m², unless the choice says that the numbers are photometric.

use super::cameras::{forward, position};
use super::objects::View;
use crate::gltf::document::{Document, IesReference, LightType, PunctualLight, SpotCone};
use glam::DAffine3;
use indexmap::IndexMap;
use juggler_light::{AnyLight, Directional, Ies, Point, Spot, SpotFalloff};
use juggler_math::Rgb;
use juggler_scene::Asset;

/// Luminous efficacy in lumens per watt, by which photometric intensities are divided.
pub const EFFICACY: f64 = 683.0;
/// Largest intensity of a light.
const MAX_INTENSITY: f64 = 1e30;

/// Lights of a scene and the profiles that they use.
#[derive(Debug, Default)]
pub struct Lights {
    /// Lights with the names of their nodes.
    pub lights: Vec<(String, AnyLight)>,
    /// Profiles by the names that the lights use as `file`.
    pub assets: IndexMap<String, Asset>,
}

/// Lights of the nodes of a scene. Lights of hidden nodes have the intensity 0.
pub fn lights(view: &View<'_>, document: &Document, photometric: bool) -> Lights {
    let mut found = Lights::default();
    let known = document.extensions.lights_punctual.as_ref().map(|lights| lights.lights.as_slice());
    for node in view.nodes {
        let extensions = document.nodes.get(node.index).and_then(|node| node.extensions.as_deref());
        let Some(extensions) = extensions else { continue };
        let world = view.worlds.get(node.index).copied().unwrap_or_default();
        let is_visible = view.visible.get(node.index).copied().unwrap_or(true);
        let scale = if is_visible { 1.0 } else { 0.0 } / if photometric { EFFICACY } else { 1.0 };
        let name = || format!("{}{}", view.prefix, node.path);
        let punctual = extensions.light_punctual.and_then(|light| known?.get(light.light.get()));
        if let Some(light) = punctual {
            found.lights.extend(any_light(light, &world, scale).map(|light| (name(), light)));
        }
        if let Some(reference) = extensions.light_ies {
            let profile = reference.light.get();
            let Some(asset) = view.content.data.profile_asset(profile) else { continue };
            let file = format!("{}light profile {profile}.ies", view.prefix);
            found.assets.entry(file.clone()).or_insert(asset);
            found.lights.push((name(), profile_light(&reference, file, &world, scale)));
        }
    }
    found
}

/// Light of a node; `None` if its kind is not known.
fn any_light(light: &PunctualLight, world: &DAffine3, scale: f64) -> Option<AnyLight> {
    let (color, intensity) = (rgb(light.color), intensity(light.intensity * scale));
    let (position, direction) = (position(world), forward(world).as_vec3());
    Some(match light.light_type {
        LightType::Unknown => return None,
        LightType::Directional => Directional { direction, color, intensity, ..Directional::default() }.into(),
        LightType::Point => {
            Point { position, color, intensity: Some(intensity), range: range(light), ..Point::default() }.into()
        }
        LightType::Spot => {
            let SpotCone { inner_cone_angle, outer_cone_angle } = light.spot.unwrap_or_default();
            let cutoff_degrees = (outer_cone_angle.to_degrees() as f32).clamp(0.0, 180.0);
            let beam_degrees = (inner_cone_angle.to_degrees() as f32).clamp(0.0, cutoff_degrees);
            let (intensity, beam_exponent) = (Some(intensity), 0.0);
            let spot = Spot { position, direction, color, intensity, beam_degrees, cutoff_degrees, ..Spot::default() };
            Spot { beam_exponent, falloff: SpotFalloff::SquaredCosine, range: range(light), ..spot }.into()
        }
    })
}

/// Range of a light, if it has one.
fn range(light: &PunctualLight) -> Option<f32> {
    light.range.map(|range| range as f32).filter(|range| range.is_finite() && *range > 0.0)
}

/// Light with the distribution of a profile. Vertical angle 0 is the direction -z of the node.
fn profile_light(reference: &IesReference, file: String, world: &DAffine3, scale: f64) -> AnyLight {
    let mut ies = Ies::from_file(file);
    (ies.direction, ies.absolute) = (Some(forward(world).as_vec3()), true);
    let (color, intensity) = (rgb(reference.color), Some(intensity(reference.multiplier * scale)));
    Point { position: position(world), color, intensity, ies: Some(ies), ..Point::default() }.into()
}

fn rgb(color: [f64; 3]) -> Rgb {
    let [r, g, b] = color.map(|channel| if channel > 0.0 { channel.min(MAX_INTENSITY) as f32 } else { 0.0 });
    Rgb::new(r, g, b)
}

fn intensity(intensity: f64) -> f32 {
    if intensity > 0.0 { intensity.min(MAX_INTENSITY) as f32 } else { 0.0 }
}
