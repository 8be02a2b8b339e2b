//! Camera motion: pure functions from a camera to a camera. Axes and signs are those of the crate
//! `camera` (`pose.rs`). The result has `eye`, `direction` and `up`, as a scene file would have.

use crate::edit::{Fly, Orbit};
use juggler::camera::{AnyCamera, CameraAxes};
use juggler::math::{Aabb, Ray, UVec2, Vec2, Vec3, portable};

/// Maximum elevation of an orbit, in degrees.
const POLE_DEGREES: f32 = 89.9;
/// Range of [`Orbit::closer`].
const CLOSER_RANGE: std::ops::RangeInclusive<f32> = 1e-3..=1e3;
/// Largest absolute coordinate of a camera position; rays from farther away find nothing.
const MAX_COORDINATE: f32 = 1e15;

/// Rotates a camera about its own axes, then translates it along them. Returns `None` if the pose
/// becomes invalid.
pub fn fly(camera: &AnyCamera, upward: Vec3, fly: &Fly) -> Option<AnyCamera> {
    let mut axes = camera.axes().ok()?;
    (axes.forward, axes.right) = rotate_in_plane(axes.forward, axes.right, fly.yaw_degrees);
    (axes.forward, axes.up) = rotate_in_plane(axes.forward, axes.up, fly.pitch_degrees);
    (axes.up, axes.right) = rotate_in_plane(axes.up, axes.right, fly.roll_degrees);
    axes.eye += axes.right * fly.right + axes.up * fly.up + axes.forward * fly.forward;
    with_axes(camera, upward, &axes)
}

/// Rotates a camera about `interest`, which keeps its position in the image. Returns `None` if the
/// pose becomes invalid.
pub fn orbit(camera: &AnyCamera, upward: Vec3, interest: Vec3, orbit: &Orbit) -> Option<AnyCamera> {
    let axes = camera.axes().ok()?;
    let upward = upward.normalize_or(Vec3::Y);
    // Limit the elevation
    let elevation = portable::asin((-axes.forward.dot(upward)).clamp(-1.0, 1.0)).to_degrees();
    let limit = POLE_DEGREES.max(elevation.abs());
    let rise = (elevation + orbit.pitch_degrees).clamp(-limit, limit) - elevation;
    // Rotate about the up axis and the horizontal axis
    let level = axes.forward.cross(upward);
    let level = if level.length_squared() > 1e-8 { level.normalize() } else { axes.right };
    let turned = |v: Vec3| rotate_about_axis(upward, -orbit.yaw_degrees, rotate_about_axis(level, -rise, v));
    let closer = if orbit.closer > 0.0 { orbit.closer.clamp(*CLOSER_RANGE.start(), *CLOSER_RANGE.end()) } else { 1.0 };
    let axes = CameraAxes {
        eye: interest + turned(axes.eye - interest) / closer,
        right: turned(axes.right),
        up: turned(axes.up),
        forward: turned(axes.forward),
    };
    let mut camera = with_axes(camera, upward, &axes)?;
    // Zoom an orthographic camera, for which distance has no effect
    if matches!(camera, AnyCamera::Orthographic(_)) {
        camera.zoom(closer);
    }
    Some(camera)
}

/// Divides the tangent of half the field of view by `factor`, clamped to 0.1 to 10.
pub fn zoom(camera: &AnyCamera, factor: f32) -> Option<AnyCamera> {
    let mut zoomed = camera.clone();
    zoomed.zoom(if factor > 0.0 { factor.clamp(0.1, 10.0) } else { 1.0 });
    valid(zoomed)
}

/// Focuses a thin lens on `point`; a camera without a lens stays unchanged.
pub fn focus(camera: &AnyCamera, point: Vec3) -> Option<AnyCamera> {
    let axes = camera.axes().ok()?;
    let distance = (point - axes.eye).dot(axes.forward);
    let mut focused = camera.clone();
    if distance > 0.0 && distance.is_finite() {
        focused.focus(distance);
    }
    valid(focused)
}

/// Moves a camera along its view direction until the bounding sphere of `bounds` fits an image of
/// `size` pixels.
pub fn frame(camera: &AnyCamera, upward: Vec3, bounds: &Aabb, size: [u32; 2]) -> Option<AnyCamera> {
    let axes = camera.axes().ok()?;
    let [width, height] = size.map(|edge| edge.max(1) as f32);
    let projection = camera.projection(UVec2::new(width as u32, height as u32)).ok()?;
    let ray = |x: f32, y: f32| projection.ray(Vec2::new(x * width, y * height), Vec2::splat(0.5), 0.0);
    let edges = [ray(0.0, 0.5), ray(0.5, 0.0)];
    let (center, radius) = bounding_sphere(bounds);
    let mut framed = camera.clone();
    let distance = if matches!(camera, AnyCamera::Orthographic(_)) {
        let half = edges.map(|edge| (edge.origin - axes.eye).length());
        framed.zoom(half[0].min(half[1]) / radius);
        radius * 2.0
    } else {
        let sine = edges.map(|edge| sine_of(&edge, axes.forward));
        radius / sine[0].min(sine[1]).max(1e-6)
    };
    with_axes(&framed, upward, &CameraAxes { eye: center - axes.forward * distance, ..axes })
}

fn sine_of(ray: &Ray, forward: Vec3) -> f32 {
    ray.direction.cross(forward).length()
}

/// Returns center and radius of the sphere around a box; the radius is at least 1e-6.
fn bounding_sphere(bounds: &Aabb) -> (Vec3, f32) {
    let half = (bounds.max - bounds.min) * 0.5;
    (bounds.min + half, half.length().max(1e-6))
}

/// Moves a camera to other axes. Returns `None` if they are degenerate or out of range.
fn with_axes(camera: &AnyCamera, upward: Vec3, axes: &CameraAxes) -> Option<AnyCamera> {
    let forward = axes.forward.try_normalize()?;
    let up = (axes.up - forward * axes.up.dot(forward)).try_normalize()?;
    // Prefer the scene's up vector if it gives the same orientation, as a file would have it.
    let level = forward.cross(upward);
    let right = forward.cross(up);
    let plain = level.length() > 1e-3 * upward.length() && (level.normalize_or_zero() - right).length() < 1e-5;
    let mut moved = camera.clone();
    moved.set_pose(axes.eye, forward, if plain { upward } else { up });
    valid(moved)
}

fn valid(camera: AnyCamera) -> Option<AnyCamera> {
    let near = camera.axes().is_ok_and(|axes| axes.eye.abs().max_element() <= MAX_COORDINATE);
    near.then_some(camera)
}

/// Rotates the orthogonal vectors `a` and `b` in their plane, `a` towards `b`.
fn rotate_in_plane(a: Vec3, b: Vec3, degrees: f32) -> (Vec3, Vec3) {
    let (sin, cos) = portable::sin_cos((degrees % 360.0).to_radians());
    (a * cos + b * sin, b * cos - a * sin)
}

/// Rotates `v` counterclockwise about a unit `axis` that points towards the viewer (Rodrigues'
/// formula).
fn rotate_about_axis(axis: Vec3, degrees: f32, v: Vec3) -> Vec3 {
    let (sin, cos) = portable::sin_cos((degrees % 360.0).to_radians());
    v * cos + axis.cross(v) * sin + axis * axis.dot(v) * (1.0 - cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler::camera::{Orthographic, Perspective, ThinLens};
    use juggler::math::vec3;

    const SIZE: UVec2 = UVec2::new(80, 60);

    /// Camera at (0, 0, 5) that looks along -z.
    fn plain() -> AnyCamera {
        Perspective::default().into()
    }

    fn tilted() -> AnyCamera {
        let (eye, look_at) = (vec3(3.0, 4.0, 5.0), Some(vec3(0.5, 1.0, -1.0)));
        Perspective { eye, look_at, roll_degrees: 20.0, ..Perspective::default() }.into()
    }

    fn near(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-4 * (1.0 + b.length())
    }

    /// Returns the projected position of a point, relative to the image center.
    fn place(camera: &AnyCamera, point: Vec3) -> Vec2 {
        let axes = camera.axes().unwrap();
        let to = point - axes.eye;
        let scale = if matches!(camera, AnyCamera::Orthographic(_)) { 1.0 } else { to.dot(axes.forward) };
        Vec2::new(to.dot(axes.right), to.dot(axes.up)) / scale
    }

    #[test]
    fn flying_goes_along_the_cameras_own_axes() {
        let moved = fly(&plain(), Vec3::Y, &Fly { right: 1.0, up: 2.0, forward: 3.0, ..Fly::default() }).unwrap();
        assert!(near(moved.axes().unwrap().eye, vec3(1.0, 2.0, 2.0)));
        let known = [
            (Fly { yaw_degrees: 90.0, ..Fly::default() }, Vec3::X, Vec3::Y),
            (Fly { pitch_degrees: 90.0, ..Fly::default() }, Vec3::Y, Vec3::Z),
            (Fly { roll_degrees: 90.0, ..Fly::default() }, -Vec3::Z, Vec3::X),
        ];
        for (turn, forward, up) in known {
            let axes = fly(&plain(), Vec3::Y, &turn).unwrap().axes().unwrap();
            assert!(near(axes.forward, forward) && near(axes.up, up), "{turn:?} {axes:?}");
        }
    }

    #[test]
    fn flying_back_restores_the_pose() {
        let step = |camera: &AnyCamera, right, yaw_degrees| {
            fly(camera, Vec3::Y, &Fly { right, yaw_degrees, ..Fly::default() }).unwrap()
        };
        let back = step(&step(&step(&tilted(), 0.3, 20.0), -0.3, 0.0), 0.0, -20.0);
        let [first, last] = [&tilted(), &back].map(|camera| camera.axes().unwrap());
        assert!(near(first.eye, last.eye) && near(first.forward, last.forward) && near(first.up, last.up));
    }

    #[test]
    fn orbits_keep_distance_and_place_of_the_point() {
        let interest = vec3(0.4, 0.2, -0.3);
        for camera in [plain(), tilted(), Orthographic { eye: vec3(1.0, 2.0, 5.0), ..Orthographic::default() }.into()] {
            let step = Orbit { yaw_degrees: 33.0, pitch_degrees: 12.0, closer: 1.0 };
            let moved = orbit(&camera, Vec3::Y, interest, &step).unwrap();
            let distance = |camera: &AnyCamera| (camera.axes().unwrap().eye - interest).length();
            assert!((distance(&camera) - distance(&moved)).abs() < 1e-4);
            assert!((place(&camera, interest) - place(&moved, interest)).length() < 1e-4);
            let closer = orbit(&camera, Vec3::Y, interest, &Orbit { closer: 2.0, ..Orbit::default() }).unwrap();
            assert!((distance(&closer) - distance(&camera) / 2.0).abs() < 1e-4);
        }
    }

    #[test]
    fn orbits_go_left_and_up_and_not_beyond_the_poles() {
        let step = |yaw_degrees, pitch_degrees| Orbit { yaw_degrees, pitch_degrees, closer: 1.0 };
        let eye = |by| orbit(&plain(), Vec3::Y, Vec3::ZERO, &by).unwrap().axes().unwrap().eye;
        assert!(near(eye(step(90.0, 0.0)), vec3(-5.0, 0.0, 0.0)));
        assert!(near(eye(step(0.0, 30.0)), vec3(0.0, 2.5, 4.330_127)));
        let mut camera = plain();
        for _ in 0..30 {
            camera = orbit(&camera, Vec3::Y, Vec3::ZERO, &step(5.0, 17.0)).unwrap();
            let axes = camera.axes().unwrap();
            assert!(axes.up.y > 0.0 && axes.eye.y < 5.0 && (axes.eye.length() - 5.0).abs() < 1e-3, "{axes:?}");
        }
        assert!(camera.axes().unwrap().eye.y > 4.999, "it got there");
    }

    #[test]
    fn zooming_divides_the_tangent_and_is_limited() {
        let half = |camera: &AnyCamera| {
            let top = camera.projection(SIZE).unwrap().ray(Vec2::new(40.0, 0.0), Vec2::splat(0.5), 0.0).direction;
            top.y / -top.z
        };
        let zoomed = zoom(&plain(), 2.0).unwrap();
        assert!((half(&plain()) / half(&zoomed) - 2.0).abs() < 1e-4);
        assert!((half(&zoom(&zoomed, 0.5).unwrap()) - half(&plain())).abs() < 1e-5);
        for mut camera in [plain(), tilted(), ThinLens::default().into(), Orthographic::default().into()] {
            for factor in [10.0; 30].into_iter().chain([0.1; 60]) {
                camera = zoom(&camera, factor).unwrap();
                assert!(camera.projection(SIZE).is_ok(), "{camera:?}");
            }
        }
        assert_eq!(zoom(&plain(), f32::NAN), zoom(&plain(), 1.0));
    }

    #[test]
    fn focus_distance_is_measured_along_the_view() {
        let lens: AnyCamera = ThinLens::default().into();
        let distance = |camera: &AnyCamera| match camera {
            AnyCamera::ThinLens(lens) => lens.focus_distance,
            _ => 0.0,
        };
        assert_eq!(distance(&focus(&lens, vec3(3.0, 1.0, 2.0)).unwrap()), 3.0);
        assert_eq!(focus(&lens, vec3(0.0, 0.0, 9.0)), Some(lens), "nothing behind");
        assert_eq!(focus(&plain(), Vec3::ZERO), Some(plain()));
    }

    #[test]
    fn framed_bounds_just_fit_the_picture() {
        let bounds = Aabb { min: vec3(1.0, 1.0, 1.0), max: vec3(2.0, 3.0, 2.0) };
        let (center, radius) = bounding_sphere(&bounds);
        for camera in [plain(), tilted(), Orthographic::default().into()] {
            let framed = frame(&camera, Vec3::Y, &bounds, SIZE.to_array()).unwrap();
            let [axes, before] = [&framed, &camera].map(|camera| camera.axes().unwrap());
            assert!(near(axes.forward, before.forward) && place(&framed, center).length() < 1e-4);
            // The sphere touches the ray through the center of the image's upper edge.
            let top = framed.projection(SIZE).unwrap().ray(Vec2::new(40.0, 0.0), Vec2::splat(0.5), 0.0);
            let to = center - top.origin;
            let distance = (to - top.direction * to.dot(top.direction)).length();
            assert!((distance - radius).abs() < 1e-3, "{distance} {radius}");
        }
    }

    #[test]
    fn nonfinite_and_huge_edits_give_no_invalid_camera() {
        for wild in [f32::INFINITY, f32::NAN, 1e30] {
            assert_eq!(fly(&plain(), Vec3::Y, &Fly { forward: wild, ..Fly::default() }), None);
            let step = Orbit { yaw_degrees: wild, pitch_degrees: wild, closer: wild };
            let moved = orbit(&plain(), Vec3::Y, Vec3::ZERO, &step);
            assert!(moved.is_none_or(|camera| camera.projection(SIZE).is_ok()));
        }
    }
}
