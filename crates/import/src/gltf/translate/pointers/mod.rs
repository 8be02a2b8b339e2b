//! Animated numbers of materials, textures, lights and cameras (KHR_animation_pointer): a document
//! in which they replace those of the file.

mod materials;
mod number;

use crate::gltf::document::{Camera, Document, PunctualLight};
use crate::gltf::pose::Pose;
use crate::gltf::warning::Warnings;
use number::{NOT_NEGATIVE, Number, POSITIVE, UNIT, set};
use std::borrow::Cow;

/// The document in a pose. Properties that cannot be animated are warnings.
pub fn animated<'d>(document: &'d Document, pose: &Pose, warnings: &mut Warnings) -> Cow<'d, Document> {
    if pose.properties.is_empty() {
        return Cow::Borrowed(document);
    }
    let mut animated = document.clone();
    for (pointer, values) in &pose.properties {
        let is_known = apply(&mut animated, pointer, values);
        warnings.add(pointer, "an animation of this property has no effect", u64::from(!is_known));
    }
    Cow::Owned(animated)
}

/// Sets the property of a JSON pointer; whether it is one that can be animated.
fn apply(document: &mut Document, pointer: &str, values: &[f64]) -> bool {
    let tokens: Vec<&str> = pointer.split('/').skip(1).collect();
    let known = match tokens.as_slice() {
        ["materials", index, rest @ ..] => {
            element(&mut document.materials, index).and_then(|material| materials::apply(material, rest, values))
        }
        ["cameras", index, rest @ ..] => {
            element(&mut document.cameras, index).and_then(|camera| apply_to_camera(camera, rest, values))
        }
        ["extensions", "KHR_lights_punctual", "lights", index, rest @ ..] => {
            let lights = document.extensions.lights_punctual.as_mut();
            let light = lights.and_then(|lights| element(&mut lights.lights, index));
            light.and_then(|light| apply_to_light(light, rest, values))
        }
        _ => None,
    };
    known.is_some()
}

fn element<'e, T>(list: &'e mut [T], index: &str) -> Option<&'e mut T> {
    index.parse::<usize>().ok().and_then(|index| list.get_mut(index))
}

/// Sets a property of a camera. Clipping planes have no effect on rendered images.
fn apply_to_camera(camera: &mut Camera, tokens: &[&str], values: &[f64]) -> Option<()> {
    match tokens {
        ["perspective", name] => {
            let projection = camera.perspective.as_mut()?;
            match *name {
                "yfov" => set(&mut projection.yfov, values, POSITIVE),
                "aspectRatio" => set(projection.aspect_ratio.get_or_insert(1.0), values, POSITIVE),
                "znear" | "zfar" => Some(()),
                _ => None,
            }
        }
        ["orthographic", name] => {
            let projection = camera.orthographic.as_mut()?;
            match *name {
                "xmag" => set(&mut projection.xmag, values, POSITIVE),
                "ymag" => set(&mut projection.ymag, values, POSITIVE),
                "znear" | "zfar" => Some(()),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Sets a property of a light.
fn apply_to_light(light: &mut PunctualLight, tokens: &[&str], values: &[f64]) -> Option<()> {
    match tokens {
        ["color"] => light.color.set(values, UNIT),
        ["intensity"] => set(&mut light.intensity, values, NOT_NEGATIVE),
        ["range"] => set(light.range.get_or_insert(1.0), values, POSITIVE),
        ["spot", "innerConeAngle"] => {
            set(&mut light.spot.get_or_insert_default().inner_cone_angle, values, NOT_NEGATIVE)
        }
        ["spot", "outerConeAngle"] => {
            set(&mut light.spot.get_or_insert_default().outer_cone_angle, values, NOT_NEGATIVE)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests;
