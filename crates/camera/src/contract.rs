//! Contract tests of all cameras, and of the fields that they share.

use super::*;
use juggler_math::testing::{Random, chi_squared, close, close3};
use juggler_math::{Ray, Vec2, Vec3, portable};

const SIZE: UVec2 = UVec2::new(64, 48);

fn parse(json: &str) -> AnyCamera {
    serde_json::from_str(json).unwrap()
}

fn ray(camera: &AnyCamera, film: Vec2) -> Ray {
    camera.projection(SIZE).unwrap().ray(film, Vec2::splat(0.5), 0.0)
}

/// Ray through the center of the picture.
fn axis(json: &str) -> Ray {
    ray(&parse(json), SIZE.as_vec2() * 0.5)
}

/// Directions of the picture's right and top, from points on rays through its edges.
fn sides(json: &str) -> (Vec3, Vec3) {
    let camera = parse(json);
    let far = |x: f32, y: f32| ray(&camera, Vec2::new(x, y)).at(10.0);
    ((far(64.0, 24.0) - far(0.0, 24.0)).normalize(), (far(32.0, 0.0) - far(32.0, 48.0)).normalize())
}

#[test]
fn rays_are_unit_and_carry_the_time() {
    let mut random = Random::new(41);
    for camera in AnyCamera::examples() {
        let projection = camera.projection(SIZE).unwrap();
        for _ in 0..2000 {
            let film = random.vec2() * SIZE.as_vec2();
            let ray = projection.ray(film, random.vec2(), 0.25);
            assert!(close(ray.direction.length(), 1.0, 3e-7), "{camera:?} {ray:?}");
            assert!(ray.origin.is_finite() && ray.time == 0.25 && ray.t_min == 0.0 && ray.t_max == f32::INFINITY);
        }
    }
}

#[test]
fn pictures_are_not_mirrored() {
    for camera in AnyCamera::examples() {
        let far = |x: f32, y: f32| ray(&camera, Vec2::new(x, y)).at(1.0);
        let (left, right, top, bottom) = (far(0.0, 24.0), far(64.0, 24.0), far(32.0, 0.0), far(32.0, 48.0));
        let forward = ray(&camera, SIZE.as_vec2() * 0.5).direction;
        assert!((right - left).cross(top - bottom).dot(forward) < 0.0, "{camera:?}");
    }
}

/// Ray origins are uniform on the lens, for any point of the film: 8 rings of equal area by 16
/// sectors.
#[test]
fn lens_is_sampled_uniformly() {
    let (mut random, count) = (Random::new(42), 1_000_000);
    let mut lenses = 0;
    for camera in AnyCamera::examples() {
        let AnyCamera::ThinLens(lens) = &camera else { continue };
        let (radius, axes) = (lens.lens_radius, camera.axes().unwrap());
        if radius == 0.0 {
            continue;
        }
        let projection = camera.projection(SIZE).unwrap();
        assert!(projection.needs_lens());
        let mut observed = [0.0; 128];
        for _ in 0..count {
            let aside = projection.ray(random.vec2() * SIZE.as_vec2(), random.vec2(), 0.0).origin - axes.eye;
            assert!(aside.dot(axes.forward).abs() < 1e-5 * radius.max(1.0));
            let (x, y) = (aside.dot(axes.right) / radius, aside.dot(axes.up) / radius);
            let ring = (((x * x + y * y) * 8.0) as usize).min(7);
            let azimuth = (portable::atan2(y, x) / std::f32::consts::TAU).rem_euclid(1.0);
            observed[ring * 16 + ((azimuth * 16.0) as usize).min(15)] += 1.0;
        }
        chi_squared(&observed, &[f64::from(count) / 128.0; 128], 5e-4).unwrap_or_else(|e| panic!("{camera:?}: {e}"));
        lenses += 1;
    }
    assert!(lenses > 1);
}

#[test]
fn json_round_trips() {
    for camera in AnyCamera::examples() {
        let text = serde_json::to_string(&camera).unwrap();
        assert_eq!(parse(&text), camera, "{text}");
    }
}

#[test]
fn fields_of_view_span_their_angles() {
    for (json, top, right) in [
        (r#"{"perspective": {}}"#, portable::tan(20f32.to_radians()), None),
        (r#"{"perspective": {"vertical_fov_degrees": 90}}"#, 1.0, None),
        (r#"{"perspective": {"horizontal_fov_degrees": 90}}"#, 0.75, None),
        (r#"{"perspective": {"screen": {"width": 100, "distance": 50}}}"#, 0.75, None),
        (r#"{"perspective": {"view_plane": {"width": 3, "height": 2, "distance": 4}}}"#, 0.25, Some(0.375)),
        (r#"{"thin_lens": {"vertical_fov_degrees": 90}}"#, 1.0, None),
    ] {
        let tangent = |x: f32, y: f32| {
            let d = ray(&parse(json), Vec2::new(x, y)).direction;
            (d / -d.z).truncate()
        };
        let corner = tangent(64.0, 0.0);
        let expected = Vec2::new(right.unwrap_or(top * 4.0 / 3.0), top);
        assert!((corner - expected).length() < 1e-6, "{json} {corner} {expected}");
        assert!((tangent(0.0, 48.0) + expected).length() < 1e-6, "{json}");
    }
}

/// On both sides of the aspect ratio, the film's corner, the footprint of a pixel and the
/// projection of a point agree.
#[test]
fn narrow_pictures_keep_the_width_of_the_fitted_aspect() {
    let tangent = portable::tan(20f32.to_radians());
    for (kind, half_height, depth) in [("perspective", tangent, 1.0), ("thin_lens", tangent, 5.0)] {
        let json = format!(r#"{{"{kind}": {{"eye": [0, 0, 0], "direction": [0, 0, -1], "fit_aspect": 2}}}}"#);
        fits(&parse(&json), half_height * depth, depth);
    }
    fits(&parse(r#"{"orthographic": {"direction": [0, 0, -1], "eye": [0, 0, 0], "fit_aspect": 2}}"#), 2.0, 1.0);
}

fn fits(camera: &AnyCamera, half_height: f32, depth: f32) {
    for (size, expected) in [
        (UVec2::new(80, 20), Vec2::new(4.0, 1.0)),
        (UVec2::new(40, 20), Vec2::new(2.0, 1.0)),
        (UVec2::new(20, 20), Vec2::new(2.0, 2.0)),
        (UVec2::new(10, 40), Vec2::new(2.0, 8.0)),
    ] {
        let (expected, projection) = (expected * half_height, camera.projection(size).unwrap());
        let ray = projection.ray(Vec2::new(size.x as f32, 0.0), Vec2::splat(0.5), 0.0);
        let corner = ray.at((-depth - ray.origin.z) / ray.direction.z);
        assert!(close3(corner, expected.extend(-depth), 1e-5), "{camera:?} {size}: {corner} {expected}");
        let found = WorldToFilm::new(&projection).unwrap().point(expected.extend(-depth)).unwrap();
        assert!((found.as_vec2() - Vec2::new(size.x as f32, 0.0)).length() < 1e-3, "{camera:?} {size}: {found}");
        let pixel = |x: f32| {
            let ray = projection.ray(size.as_vec2() * 0.5 + Vec2::new(x, 0.0), Vec2::splat(0.5), 0.0);
            ray.at((-depth - ray.origin.z) / ray.direction.z)
        };
        let step = pixel(1.0) - pixel(0.0);
        assert!(close(step.x, 2.0 * expected.x / size.x as f32, 1e-5), "{camera:?} {size}: {step}");
    }
}

#[test]
fn vertical_angle_is_the_zoom_angle_of_scalablitz() {
    // ScalaBlitz's ray through pixel (x, y): zoom · ((2x/W - 1) · W/H, 1 - 2y/H) with zoom = tan(π
    // α / 360).
    let camera = parse(r#"{"perspective": {"vertical_fov_degrees": 30}}"#);
    let zoom = portable::tan(std::f32::consts::PI * 30.0 / 360.0);
    for (x, y) in [(0.0, 0.0), (10.0, 40.0), (63.0, 1.0)] {
        let d = ray(&camera, Vec2::new(x, y)).direction;
        let theirs = Vec2::new((2.0 * x / 64.0 - 1.0) * 64.0 / 48.0, 1.0 - 2.0 * y / 48.0) * zoom;
        assert!(((d / -d.z).truncate() - theirs).length() < 1e-6);
    }
}

#[test]
fn cameras_look_along_their_description() {
    for camera in ["perspective", "thin_lens", "orthographic"] {
        let json = |fields: &str| format!(r#"{{"{camera}": {{"eye": [1, 2, 3], {fields}}}}}"#);
        let to = Vec3::new(4.0, -2.0, 3.0) - Vec3::new(1.0, 2.0, 3.0);
        for fields in [r#""look_at": [4, -2, 3]"#, r#""direction": [0.003, -0.004, 0]"#] {
            let ray = axis(&json(fields));
            assert!(close3(ray.direction, to / 5.0, 1e-6) && close3(ray.origin, Vec3::new(1.0, 2.0, 3.0), 1e-6));
        }
        assert!(close3(axis(&json(r#""up": [0, 1, 0]"#)).direction, -Vec3::new(1.0, 2.0, 3.0).normalize(), 1e-6));
    }
}

#[test]
fn view_parallel_to_up_has_a_valid_frame() {
    for (direction, up, right, top) in [
        ("[0, -1, 0]", "[0, 1, 0]", Vec3::X, -Vec3::Z),
        ("[0, 1, 0]", "[0, 1, 0]", Vec3::X, Vec3::Z),
        ("[0, 0, -1]", "[0, 0, 1]", Vec3::X, Vec3::Y),
        ("[3, 0, 0]", "[-2, 0, 0]", Vec3::Y, -Vec3::Z),
    ] {
        let json = format!(r#"{{"perspective": {{"direction": {direction}, "up": {up}}}}}"#);
        let (r, t) = sides(&json);
        assert!(close3(r, right, 1e-6) && close3(t, top, 1e-6), "{json}: {r} {t}");
    }
}

#[test]
fn yaw_pitch_and_roll_have_the_documented_signs() {
    let facing = |turn: &str| format!(r#"{{"perspective": {{"direction": [0, 0, -1], {turn}}}}}"#);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    assert!(close3(axis(&facing(r#""yaw_degrees": 45"#)).direction, Vec3::new(half, 0.0, -half), 1e-6));
    assert!(close3(axis(&facing(r#""pitch_degrees": 45"#)).direction, Vec3::new(0.0, half, -half), 1e-6));
    let (right, up) = sides(&facing(r#""roll_degrees": 45"#));
    assert!(close3(up, Vec3::new(half, half, 0.0), 1e-6) && close3(right, Vec3::new(half, -half, 0.0), 1e-6));
    // Yaw comes first, then pitch about the right axis that yaw has rotated.
    let both = axis(&facing(r#""yaw_degrees": 90, "pitch_degrees": 45"#));
    assert!(close3(both.direction, Vec3::new(half, half, 0.0), 1e-6), "{both:?}");
}

#[test]
fn scalablitz_rotations_are_yaw_and_pitch() {
    // Forward (-cos p sin j, sin p, cos p cos j) with the z axis, which points into the picture,
    // reversed.
    for (p, j) in [(0.1f32, 0.3f32), (-0.7, 1.2), (0.4, -2.0)] {
        let ((sp, cp), (sj, cj)) = (portable::sin_cos(p), portable::sin_cos(j));
        let turn = format!(r#""pitch_degrees": {}, "yaw_degrees": {}"#, p.to_degrees(), -j.to_degrees());
        let json = format!(r#"{{"perspective": {{"direction": [0, 0, -1], {turn}}}}}"#);
        assert!(close3(axis(&json).direction, Vec3::new(-cp * sj, sp, -cp * cj), 1e-6));
        let (right, up) = sides(&json);
        assert!(close3(right, Vec3::new(cj, 0.0, -sj), 2e-6), "{right}");
        assert!(close3(up, Vec3::new(sp * sj, cp, sp * cj), 2e-6), "{up}");
    }
}

#[test]
fn cameras_move_along_their_own_axes() {
    let json = r#"{"orthographic": {"eye": [1, 2, 3], "direction": [-1, 0, 0], "roll_degrees": 90,
        "move": {"right": 10, "up": 100, "forward": 1000}}}"#;
    // A camera that faces -x has -z on its right; after a roll of 90 degrees, -z at its top and -y
    // on its right.
    assert!(close3(axis(json).origin, Vec3::new(1.0 - 1000.0, 2.0 - 10.0, 3.0 - 100.0), 1e-6));
}

#[test]
fn extreme_positions_give_unit_directions() {
    for eye in ["[1e30, 1e30, 1e30]", "[1e-38, 0, 0]", "[0, 3e38, 1]"] {
        let ray = axis(&format!(r#"{{"perspective": {{"eye": {eye}}}}}"#));
        assert!(close(ray.direction.length(), 1.0, 3e-7), "{ray:?}");
    }
    assert!(parse(r#"{"perspective": {}}"#).projection(UVec2::ZERO).is_ok());
}

#[test]
fn invalid_fields_are_named() {
    for (fields, field) in [
        (r#""eye": [1, 2, 3], "look_at": [1, 2, 3]"#, "look_at"),
        (r#""direction": [0, 0, 0]"#, "direction"),
        (r#""direction": [0, 0, 1], "look_at": [1, 2, 3]"#, "direction"),
        (r#""up": [0, 0, 0]"#, "up"),
        (r#""eye": [1e39, 0, 0]"#, "eye"),
        (r#""roll_degrees": 1e39"#, "roll_degrees"),
        (r#""move": {"up": -1e39}"#, "move"),
        (r#""vertical_fov_degrees": 0"#, "vertical_fov_degrees"),
        (r#""vertical_fov_degrees": 180"#, "vertical_fov_degrees"),
        (r#""horizontal_fov_degrees": -5"#, "horizontal_fov_degrees"),
        (r#""horizontal_fov_degrees": 50, "vertical_fov_degrees": 50"#, "horizontal_fov_degrees"),
        (r#""fit_aspect": 0"#, "fit_aspect"),
        (r#""fit_aspect": 1e39"#, "fit_aspect"),
        (r#""fit_aspect": 2, "horizontal_fov_degrees": 50"#, "fit_aspect"),
        (r#""screen": {"width": 0, "distance": 1}"#, "screen.width"),
        (r#""screen": {"width": 1e30, "distance": 1e-30}"#, "screen"),
        (r#""view_plane": {"width": 1, "height": 1, "distance": -1}"#, "view_plane.distance"),
        (r#""view_plane": {"width": 1, "height": 1, "distance": 1}, "horizontal_fov_degrees": 9"#, "view_plane"),
    ] {
        let error = parse(&format!(r#"{{"perspective": {{{fields}}}}}"#)).projection(SIZE).unwrap_err();
        assert_eq!(error.field, field, "{fields}");
        assert!(error.message.contains(field.rsplit('.').next().unwrap()), "{}", error.message);
    }
}
