//! Lights, cameras and media of a model in the space of the scene.

use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_math::{Transform, Vec3};

/// A light of a model after the transform of its object. Intensities stay.
pub fn placed_light(light: &AnyLight, transform: &Transform) -> AnyLight {
    let mut light = light.clone();
    match &mut light {
        AnyLight::Point(point) => point.position = transform.point(point.position),
        AnyLight::Spot(spot) => {
            spot.position = transform.point(spot.position);
            spot.direction = direction(transform, spot.direction);
        }
        AnyLight::Directional(sun) => sun.direction = direction(transform, sun.direction),
        _ => {}
    }
    light
}

/// Sets the light group of a light that has none.
pub fn set_light_group(light: &mut AnyLight, group: Option<&str>) {
    let slot = match light {
        AnyLight::Point(point) => &mut point.light_group,
        AnyLight::Spot(spot) => &mut spot.light_group,
        AnyLight::Directional(sun) => &mut sun.light_group,
        _ => return,
    };
    if slot.is_none() {
        *slot = group.map(str::to_owned);
    }
}

/// A camera of a model after the transform of its object.
pub fn placed_camera(camera: &AnyCamera, transform: &Transform) -> AnyCamera {
    let mut camera = camera.clone();
    let (eye, target, view, up) = match &mut camera {
        AnyCamera::Perspective(c) => (&mut c.eye, &mut c.look_at, &mut c.direction, &mut c.up),
        AnyCamera::ThinLens(c) => (&mut c.eye, &mut c.look_at, &mut c.direction, &mut c.up),
        AnyCamera::Orthographic(c) => (&mut c.eye, &mut c.look_at, &mut c.direction, &mut c.up),
    };
    if view.is_none() {
        *target = Some(transform.point(target.unwrap_or(Vec3::ZERO)));
    }
    *eye = transform.point(*eye);
    *view = view.map(|view| direction(transform, view));
    *up = direction(transform, *up);
    camera
}

fn direction(transform: &Transform, v: Vec3) -> Vec3 {
    transform.vector(v).normalize_or(v)
}

/// A material whose media have their distances multiplied by the scale of the model.
pub fn scaled_media(material: AnyMaterial, scale: f32) -> AnyMaterial {
    if scale == 1.0 || !scale.is_finite() {
        return material;
    }
    match material {
        AnyMaterial::Principled(mut principled) => {
            principled.medium.distance *= scale;
            principled.into()
        }
        AnyMaterial::NormalMap(mut map) => {
            if let MaterialRef::Inline(inner) = map.material {
                map.material = MaterialRef::Inline(Box::new(scaled_media(*inner, scale)));
            }
            map.into()
        }
        other => other,
    }
}
