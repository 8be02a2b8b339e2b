//! Defaults of a scene: a camera that sees all objects, lights and a background.

use crate::description::Description;
use crate::integrator::{IntegratorChoice, IntegratorRequirements};
use crate::path::Path;
use crate::report::Finding;
use juggler_camera::{AnyCamera, Perspective};
use juggler_light::background::{AnyBackground, Solid};
use juggler_light::{Ambient, AnyLight, Extent, Point};
use juggler_math::{Aabb, Rgb, UVec2, Vec3, portable};

/// Direction from the center of the scene to the default camera: in front, slightly to the right
/// and above.
const TOWARDS_CAMERA: Vec3 = Vec3::new(0.35, 0.35, 1.0);
/// Direction from the center of the scene to the default light: above the camera's left shoulder.
const TOWARDS_LIGHT: Vec3 = Vec3::new(-0.6, 1.2, 1.0);

/// Perspective camera that sees all of `bounds`, with the default field of view of 40 degrees.
pub fn camera(bounds: &Aabb, size: UVec2) -> AnyCamera {
    let (center, radius) = bounding_sphere(bounds);
    let half_vertical = 20.0_f32.to_radians();
    let aspect = size.x.max(1) as f32 / size.y.max(1) as f32;
    let (sin, cos) = portable::sin_cos(half_vertical);
    let narrow = sin / cos * aspect.min(1.0);
    let sine = narrow / (1.0 + narrow * narrow).sqrt();
    let eye = center + TOWARDS_CAMERA.normalize() * (radius * 1.05 / sine);
    Perspective { eye, look_at: center.into(), ..Perspective::default() }.into()
}

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

/// Camera that sees all of `bounds`. Reports it at `farthest_object` if it is invalid.
pub fn checked_camera(bounds: &Aabb, size: UVec2, farthest_object: &Path, findings: &mut Vec<Finding>) -> AnyCamera {
    let camera = camera(bounds, size);
    if camera.projection(size).is_err() {
        let problem =
            Finding::error("this object is too large or too far away for the default camera to see the whole scene");
        findings.push(problem.at(farthest_object).help("make it smaller, move it closer, or add a `camera`"));
    }
    camera
}

/// Reports a camera that is invalid for pictures of `size`.
pub fn check_camera(camera: &AnyCamera, size: UVec2, path: &Path, findings: &mut Vec<Finding>) {
    if let Err(invalid) = camera.projection(size) {
        let path = path.key(crate::kind::name_of(camera)).join(invalid.field);
        findings.push(Finding::error(invalid.message).at(&path));
    }
}
