//! What a scene gets that says nothing: a camera that sees everything, and light to see it by.

use crate::description::Description;
use crate::integrator::{Holdings, IntegratorChoice};
use juggler_camera::{AnyCamera, Perspective};
use juggler_light::background::{AnyBackground, Solid};
use juggler_light::{Ambient, AnyLight, Extent, Point};
use juggler_math::{Aabb, Rgb, UVec2, Vec3, fun};

/// Where the default camera stands, seen from the middle: in front, a little right of and above it.
const TOWARDS_CAMERA: Vec3 = Vec3::new(0.35, 0.35, 1.0);
/// Where the default light stands: above the camera's left shoulder.
const TOWARDS_LIGHT: Vec3 = Vec3::new(-0.6, 1.2, 1.0);

/// A camera with the default field of view of 40 degrees that sees all of `bounds`.
pub fn camera(bounds: &Aabb, size: UVec2) -> AnyCamera {
    let (center, radius) = ball(bounds);
    let half_vertical = 20.0_f32.to_radians();
    let aspect = size.x.max(1) as f32 / size.y.max(1) as f32;
    let (sin, cos) = fun::sin_cos(half_vertical);
    let narrow = sin / cos * aspect.min(1.0);
    let sine = narrow / (1.0 + narrow * narrow).sqrt();
    let eye = center + TOWARDS_CAMERA.normalize() * (radius * 1.05 / sine);
    Perspective { eye, look_at: center.into(), ..Perspective::default() }.into()
}

/// A soft light above the camera's shoulder, and for integrators that follow no paths a little light from everywhere;
/// paths find that in the default background.
pub fn lights(bounds: &Aabb, scene: &Description, integrator: &IntegratorChoice) -> Vec<AnyLight> {
    let (center, radius) = ball(bounds);
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

/// Factor on the default light, for the same look under every integrator: of a light without a surface, `phong` reflects π
/// times as much as physical materials of the same color. A scene that has both gets the geometric mean.
fn strength(scene: &Description, integrator: &IntegratorChoice) -> f32 {
    let Holdings { physical, has_phong, .. } = Holdings::of(scene);
    match (integrator.follows_paths() && physical.is_some(), has_phong) {
        (false, _) => 1.0,
        (true, true) => std::f32::consts::PI.sqrt(),
        (true, false) => std::f32::consts::PI,
    }
}

/// Black where the scene has its own light, else a soft grey.
pub fn background(lit: bool) -> AnyBackground {
    Solid { color: if lit { Rgb::BLACK } else { Rgb::splat(0.25) } }.into()
}

fn ball(bounds: &Aabb) -> (Vec3, f32) {
    let half = (bounds.max - bounds.min) * 0.5;
    (bounds.min + half, half.length().max(1e-6))
}
