//! How cameras move: pure functions from a camera to a camera. Signs and axes are those of `camera/pose.rs` in the
//! tracer. What results is plain: `eye`, `direction` and `up`, as a scene file would have it.

use crate::{Fly, Orbit};
use juggler::math::{Aabb, Ray, UVec2, Vec2, Vec3, fun};
use juggler::tracer::camera::{AnyCamera, Axes};

/// How far an orbit goes towards a pole.
const POLE_DEGREES: f32 = 89.9;
/// Farthest and nearest that one step of an orbit goes.
const CLOSER: std::ops::RangeInclusive<f32> = 1e-3..=1e3;
/// Where coordinates end: beyond, no ray finds anything.
const FARTHEST: f32 = 1e15;

/// Turns about the camera's own axes, then steps along them.
pub fn fly(camera: &AnyCamera, upward: Vec3, fly: &Fly) -> Option<AnyCamera> {
    let mut axes = camera.axes().ok()?;
    (axes.forward, axes.right) = turn(axes.forward, axes.right, fly.yaw_degrees);
    (axes.forward, axes.up) = turn(axes.forward, axes.up, fly.pitch_degrees);
    (axes.up, axes.right) = turn(axes.up, axes.right, fly.roll_degrees);
    axes.eye += axes.right * fly.right + axes.up * fly.up + axes.forward * fly.forward;
    stand(camera, upward, &axes)
}

/// Round `interest`, which keeps its place in the picture.
pub fn orbit(camera: &AnyCamera, upward: Vec3, interest: Vec3, orbit: &Orbit) -> Option<AnyCamera> {
    let axes = camera.axes().ok()?;
    let upward = upward.normalize_or(Vec3::Y);
    let elevation = fun::asin((-axes.forward.dot(upward)).clamp(-1.0, 1.0)).to_degrees();
    let limit = POLE_DEGREES.max(elevation.abs());
    let rise = (elevation + orbit.pitch_degrees).clamp(-limit, limit) - elevation;
    let level = axes.forward.cross(upward);
    let level = if level.length_squared() > 1e-8 { level.normalize() } else { axes.right };
    let turned = |v: Vec3| around(upward, -orbit.yaw_degrees, around(level, -rise, v));
    let closer = if orbit.closer > 0.0 { orbit.closer.clamp(*CLOSER.start(), *CLOSER.end()) } else { 1.0 };
    let axes = Axes {
        eye: interest + turned(axes.eye - interest) / closer,
        right: turned(axes.right),
        up: turned(axes.up),
        forward: turned(axes.forward),
    };
    let mut camera = stand(camera, upward, &axes)?;
    if matches!(camera, AnyCamera::Orthographic(_)) {
        camera.zoom(closer);
    }
    Some(camera)
}

/// Narrows the field of view.
pub fn zoom(camera: &AnyCamera, factor: f32) -> Option<AnyCamera> {
    let mut zoomed = camera.clone();
    zoomed.zoom(if factor > 0.0 { factor.clamp(0.1, 10.0) } else { 1.0 });
    valid(zoomed)
}

/// A lens is sharp at `point`; a camera without one stays.
pub fn focus(camera: &AnyCamera, point: Vec3) -> Option<AnyCamera> {
    let axes = camera.axes().ok()?;
    let distance = (point - axes.eye).dot(axes.forward);
    let mut focused = camera.clone();
    if distance > 0.0 && distance.is_finite() {
        focused.focus(distance);
    }
    valid(focused)
}

/// Steps back, or forward, until a ball around `bounds` fills the picture.
pub fn frame(camera: &AnyCamera, upward: Vec3, bounds: &Aabb, size: [u32; 2]) -> Option<AnyCamera> {
    let axes = camera.axes().ok()?;
    let [width, height] = size.map(|edge| edge.max(1) as f32);
    let projection = camera.project(UVec2::new(width as u32, height as u32)).ok()?;
    let ray = |x: f32, y: f32| projection.ray(Vec2::new(x * width, y * height), Vec2::splat(0.5), 0.0);
    let edges = [ray(0.0, 0.5), ray(0.5, 0.0)];
    let (center, radius) = ball(bounds);
    let mut framed = camera.clone();
    let distance = if matches!(camera, AnyCamera::Orthographic(_)) {
        let half = edges.map(|edge| (edge.origin - axes.eye).length());
        framed.zoom(half[0].min(half[1]) / radius);
        radius * 2.0
    } else {
        let sine = edges.map(|edge| sine_of(&edge, axes.forward));
        radius / sine[0].min(sine[1]).max(1e-6)
    };
    stand(&framed, upward, &Axes { eye: center - axes.forward * distance, ..axes })
}

fn sine_of(ray: &Ray, forward: Vec3) -> f32 {
    ray.direction.cross(forward).length()
}

/// Middle and radius of the ball around a box; of some size, always.
fn ball(bounds: &Aabb) -> (Vec3, f32) {
    let half = (bounds.max - bounds.min) * 0.5;
    (bounds.min + half, half.length().max(1e-6))
}

/// The camera in another place; nothing where numbers have no meaning any more.
fn stand(camera: &AnyCamera, upward: Vec3, axes: &Axes) -> Option<AnyCamera> {
    let forward = axes.forward.try_normalize()?;
    let up = (axes.up - forward * axes.up.dot(forward)).try_normalize()?;
    // Where the scene's own upward direction says the same, that is what a file should have.
    let level = forward.cross(upward);
    let right = forward.cross(up);
    let plain = level.length() > 1e-3 * upward.length() && (level.normalize_or_zero() - right).length() < 1e-5;
    let mut moved = camera.clone();
    moved.stand(axes.eye, forward, if plain { upward } else { up });
    valid(moved)
}

fn valid(camera: AnyCamera) -> Option<AnyCamera> {
    let near = camera.axes().is_ok_and(|axes| axes.eye.abs().max_element() <= FARTHEST);
    near.then_some(camera)
}

/// Turns `a` towards `b`, and `b` away from where `a` was.
fn turn(a: Vec3, b: Vec3, degrees: f32) -> (Vec3, Vec3) {
    let (sin, cos) = fun::sin_cos((degrees % 360.0).to_radians());
    (a * cos + b * sin, b * cos - a * sin)
}

/// Turns `v` about a unit `axis`, counter-clockwise for who sees the axis come towards them (Rodrigues).
fn around(axis: Vec3, degrees: f32, v: Vec3) -> Vec3 {
    let (sin, cos) = fun::sin_cos((degrees % 360.0).to_radians());
    v * cos + axis.cross(v) * sin + axis * axis.dot(v) * (1.0 - cos)
}
