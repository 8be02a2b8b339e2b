//! Defaults of a scene: lights and a background.

use crate::description::Description;
use crate::integrator::{IntegratorChoice, IntegratorRequirements};
use juggler_light::background::{AnyBackground, Solid};
use juggler_light::{Ambient, AnyLight, Extent, Point};
use juggler_math::{Aabb, Rgb, Vec3};

/// Direction from the center of the scene to the default light: above the camera's left shoulder.
const TOWARDS_LIGHT: Vec3 = Vec3::new(-0.6, 1.2, 1.0);

/// Default lights: a spherical light above the camera's left shoulder and, without path tracing,
/// ambient light. With path tracing, the default background replaces the latter.
pub fn lights(bounds: &Aabb, scene: &Description, integrator: &IntegratorChoice) -> Vec<AnyLight> {
    let (center, radius) = bounding_sphere(bounds);
    let distance = radius * 4.0;
    let key = Point {
        position: center + TOWARDS_LIGHT.normalize() * distance,
        color: Rgb::WHITE,
        intensity: Some(0.6 * distance * distance * strength(scene, integrator)),
        extent: Some(Extent::Sphere { radius: 0.5 * radius }),
        ..Point::default()
    };
    let ambient = Ambient { intensity: 0.15, ..Ambient::default() };
    let from_everywhere = (!integrator.follows_paths()).then(|| ambient.into());
    [key.into()].into_iter().chain(from_everywhere).collect()
}

/// Factor of the default light, for equal brightness with every integrator: under a light without
/// area, `phong` reflects π times as much as physical materials of the same color. A scene with
/// both gets the geometric mean.
fn strength(scene: &Description, integrator: &IntegratorChoice) -> f32 {
    let IntegratorRequirements { physical, has_phong, .. } = IntegratorRequirements::from_scene(scene);
    match (integrator.follows_paths() && physical.is_some(), has_phong) {
        (false, _) => 1.0,
        (true, true) => std::f32::consts::PI.sqrt(),
        (true, false) => std::f32::consts::PI,
    }
}

/// Default background: black if the scene has light of its own, otherwise a uniform gray.
pub fn background(has_lights: bool) -> AnyBackground {
    Solid { color: if has_lights { Rgb::BLACK } else { Rgb::splat(0.25) } }.into()
}

fn bounding_sphere(bounds: &Aabb) -> (Vec3, f32) {
    let half = (bounds.max - bounds.min) * 0.5;
    (bounds.min + half, half.length().max(1e-6))
}
