//! Cameras inside solids and media.

use super::*;
use juggler_math::portable;

const BACKGROUND: Rgb = Rgb::new(0.5, 1.0, 2.0);

fn mean(pixels: &[Rgb]) -> Rgb {
    pixels.iter().fold(Rgb::BLACK, |sum, pixel| sum + *pixel) / pixels.len() as f32
}

fn seen(world: &World, eye: Vec3, samples: u32) -> Vec<Rgb> {
    let size = UVec2::new(6, 4);
    let camera = look(eye, eye - Vec3::Z, "60", size);
    pixels(world, &camera, &juggler_integrator::Path::default().into(), size, samples)
}

/// From the center of a sphere, all directions are attenuated over one radius (Beer–Lambert law).
#[test]
fn absorbing_sphere_attenuates_all_directions_equally_from_its_center() {
    let sphere = r#"{"sphere": {"radius": 2}}"#;
    let dark = r#"{"boundary": {"medium": {"absorption": [0.1, 0.3, 0.7]}}}"#;
    let left = Rgb::new(0.1, 0.3, 0.7).map(|absorption| portable::exp(-2.0 * absorption)) * BACKGROUND;
    for place in [Vec3::ZERO, Vec3::new(3.0, -7.0, 2.0)] {
        let world = world(&[(sphere, place, dark)], &[], BACKGROUND);
        assert!(seen(&world, place, 4).iter().all(|pixel| near(*pixel, left, 1e-5)), "{left:?}");
        // A camera outside, beside the sphere, sees no attenuation.
        assert!(seen(&world, place + Vec3::Y * 9.0, 1).iter().all(|pixel| *pixel == BACKGROUND));
    }
    // If the camera crosses the surface while the shutter is open, its position at mid-shutter
    // counts.
    let world = world(&[(sphere, Vec3::ZERO, dark)], &[], BACKGROUND);
    let size = UVec2::ONE;
    let at = |z: f32| look(Vec3::Z * z, Vec3::NEG_Z * 9.0, "5", size).projection_at(0.0);
    let moving = ShutterCamera::from_keys(at(0.0), vec![at(0.0), at(9.0)]);
    let integrator = juggler_integrator::Path::default().into();
    assert!(near(pixels(&world, &moving, &integrator, size, 1)[0], left, 1e-4));
}

/// In fog of albedo 1, lit from all directions by the same radiance, the radiance is the same
/// everywhere.
#[test]
fn white_fog_in_uniform_light_has_that_radiance_everywhere() {
    let room = r#"{"cuboid": {"min": [-2, -2, -2], "max": [2, 2, 2]}}"#;
    let fog = |absorption: f32| {
        format!(r#"{{"boundary": {{"medium": {{"scattering": 0.4, "absorption": {absorption}, "anisotropy": 0.5}}}}}}"#)
    };
    let white = world(&[(room, Vec3::ZERO, &fog(0.0))], &[], Rgb::WHITE);
    let inside = mean(&seen(&white, Vec3::new(0.3, 0.5, -0.2), 64));
    assert!(near(inside, Rgb::WHITE, 0.02), "{inside:?}");
    let smoke = world(&[(room, Vec3::ZERO, &fog(0.4))], &[], Rgb::WHITE);
    let inside = mean(&seen(&smoke, Vec3::new(0.3, 0.5, -0.2), 64));
    // More than the unscattered transmittance to the outside, and less than 1.
    assert!(inside.g > portable::exp(-0.8 * 2.5) && inside.g < 0.75, "{inside:?}");
}

/// From under water the sky appears within Snell's window, its radiance scaled by n²; beyond it,
/// total internal reflection shows the ground.
#[test]
fn sky_seen_from_under_water_fills_snells_window() {
    let sea = [(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"dielectric": {"ior": 1.33}}"#)];
    let world = world(&sea, &[], Rgb::WHITE);
    let integrator = juggler_integrator::Path::default().into();
    let up = |degrees: f32| {
        let (sin, cos) = portable::sin_cos(degrees.to_radians());
        let eye = Vec3::new(0.5, -3.0, 0.5);
        let camera = look(eye, eye + Vec3::new(sin, cos, 0.001), "0.1", PIXEL);
        pixels(&world, &camera, &integrator, PIXEL, 256)[0].g
    };
    let share = fresnel::dielectric_reflectance(1.0, 1.0 / 1.33);
    let straight = share + (1.0 - share) * 1.33 * 1.33;
    assert!((up(1.0) - straight).abs() < 0.05, "{} {straight}", up(1.0));
    // The critical angle is 48.75 degrees.
    assert!(up(47.0) > 1.2 && (up(51.0) - 1.0).abs() < 1e-3, "{} {}", up(47.0), up(51.0));
}
