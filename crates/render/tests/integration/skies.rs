//! Infinite lights, against sums over all directions.

use crate::probe::{Scene, at_origin, measure, read, traced};
use juggler_integrator::AnyIntegrator;
use juggler_light::background::{AnyBackground, Environment, Panorama};
use juggler_math::{Image, Ray, Rgb, Vec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn prepared(mut background: AnyBackground) -> AnyBackground {
    background.prepare().unwrap();
    background
}

/// Radiance of a floor of albedo 0.5 under the upper hemisphere: 0.5 / π ∫ L cos dω.
fn shown(background: &AnyBackground, rows: u32) -> f64 {
    let columns = 2 * rows;
    let mut sum = 0.0;
    for i in 0..rows {
        // Uniform in the squared cosine, so that all directions have the same weight.
        let height = ((f64::from(i) + 0.5) / f64::from(rows)).sqrt();
        for j in 0..columns {
            let (sin, cos) = ((f64::from(j) + 0.5) * TAU / f64::from(columns)).sin_cos();
            let radius = (1.0 - height * height).sqrt();
            let direction = Vec3::new((radius * cos) as f32, height as f32, (radius * sin) as f32);
            sum += f64::from(background.radiance(&Ray::new(Vec3::ZERO, direction)).r);
        }
    }
    0.5 * sum / f64::from(rows * columns)
}

#[test]
fn uniform_sky_matches_the_closed_form() {
    traced(Scene::floor().in_light(3.0), &at_origin(), 16).is(1.5);
}

#[test]
fn gradient_sky_matches_the_closed_form() {
    // ∫ cos (h + (z - h) cos) dω / π = h / 3 + 2 z / 3, and (h + z) / 2 for a blend by the squared
    // cosine.
    for (blend, expected) in [("sine", 1.0 / 3.0 + 8.0 / 3.0), ("sine_squared", 2.5)] {
        let sky = format!(r#"{{"gradient": {{"horizon": 1, "zenith": 4, "nadir": 9, "blend": "{blend}"}}}}"#);
        traced(Scene::floor().before(prepared(read(&sky))), &at_origin(), 256).is(0.5 * expected);
    }
}

#[test]
fn clear_sky_and_sun_match_quadrature() {
    let sky = |sun: bool| {
        prepared(read(&format!(r#"{{"sky": {{"sun_elevation_degrees": 30, "turbidity": 3, "sun": {sun}}}}}"#)))
    };
    let without = shown(&sky(false), 400);
    traced(Scene::floor().before(sky(false)), &at_origin(), 256).is(without);
    // The sun's disk: radiance at its center times solid angle times cosine.
    let towards = {
        let (sin, cos) = 135f64.to_radians().sin_cos();
        let up = 30f64.to_radians();
        Vec3::new((up.cos() * sin) as f32, up.sin() as f32, (-up.cos() * cos) as f32)
    };
    let ray = Ray::new(Vec3::ZERO, towards.normalize());
    let disk = f64::from(sky(true).radiance(&ray).r) - f64::from(sky(false).radiance(&ray).r);
    let solid_angle = TAU * (1.0 - 0.2665f64.to_radians().cos());
    let direct = 0.5 / PI * disk * solid_angle * 0.5;
    traced(Scene::floor().before(sky(true)), &at_origin(), 256).is(without + direct);
}

/// A gray panorama with a small bright spot.
pub fn panorama() -> AnyBackground {
    let mut image = Image::filled(64, 32, Rgb::splat(0.3));
    for (x, y) in [(20, 8), (21, 8), (21, 9)] {
        image.pixels_mut()[y * 64 + x] = Rgb::new(300.0, 200.0, 100.0);
    }
    let mut environment = Environment::from_file("spot.exr");
    environment.set_panorama(Arc::new(Panorama::new(image).unwrap()));
    prepared(environment.into())
}

#[test]
fn panorama_with_a_hot_spot_matches_quadrature() {
    let expected = shown(&panorama(), 1500);
    traced(Scene::floor().before(panorama()), &at_origin(), 256).is(expected);
}

/// Camera rays see `visible_as`, through masks too; floors and mirrors see the studio itself.
#[test]
fn what_is_visible_instead_of_the_background_is_seen_by_camera_rays_only() {
    let studio = |visible: &str| prepared(read(&format!(r#"{{"studio": {{{visible}}}}}"#)));
    let [seen, plain] = [r#""visible_as": [0.25, 0.25, 0.25]"#, ""].map(studio);
    let mask = || {
        let masked = r#"{"mask": {"opacity": 0, "material": {"diffuse": {}}}}"#;
        Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, masked)
    };
    let mirror = || Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"conductor": {"reflectance": 0.9}}"#);
    for integrator in [r#"{"path": {}}"#, r#"{"direct": {}}"#, r#"{"classic": {}}"#] {
        let integrator: AnyIntegrator = read(integrator);
        let color = |scene: Scene, background: &AnyBackground| {
            measure(&scene.before(background.clone()).world(), &at_origin(), &*integrator, 64).mean
        };
        for scene in [Scene::new, mask] {
            assert!((color(scene(), &seen) - 0.25).abs() < 1e-6, "{integrator:?}");
            assert!(color(scene(), &plain) < 0.2, "{integrator:?}");
        }
        for scene in [Scene::floor, mirror] {
            assert_eq!(color(scene(), &seen), color(scene(), &plain), "{integrator:?}");
        }
    }
    // The floor shows the irradiance π of the studio.
    traced(Scene::floor().before(seen), &at_origin(), 256).is(0.5);
}

/// Slab of a material below the camera, of thickness 0.5.
fn slab(material: &str) -> Scene {
    let shape = r#"{"cuboid": {"min": [-50, -0.5, -50], "max": [50, 0, 50]}}"#;
    Scene::new().with(shape, Vec3::ZERO, material)
}

/// Uniform light of radiance 1, which camera rays see as `visible`.
fn uniform(visible: Option<f32>) -> AnyBackground {
    let mut environment = Environment::from_file("white.exr");
    environment.set_panorama(Arc::new(Panorama::new(Image::filled(8, 4, Rgb::WHITE)).unwrap()));
    environment.visible_as = visible.map(Rgb::splat);
    prepared(environment.into())
}

fn seen_with(scene: Scene, background: AnyBackground, integrator: &str, samples: u32) -> f64 {
    measure(&scene.before(background).world(), &at_origin(), &*read::<AnyIntegrator>(integrator), samples).mean
}

/// Glass shows the backdrop along paths that it only transmits, whatever its roughness.
#[test]
fn glass_shows_the_backdrop() {
    let strategies = ["mis", "light", "bsdf"].map(|sampling| format!(r#"{{"path": {{"sampling": "{sampling}"}}}}"#));
    // Fresnel reflectance for the index 1.5 of a view at the cosine 2 / √29.
    let (cosine, refracted) = (2.0 / 29f64.sqrt(), (1.0 - 25.0 / 29.0 / 2.25f64).sqrt());
    let squared_ratio = |a: f64, b: f64| ((a - b) / (a + b)).powi(2);
    let reflectance = 0.5 * (squared_ratio(cosine, 1.5 * refracted) + squared_ratio(1.5 * cosine, refracted));
    for integrator in &strategies {
        // Both surfaces transmit the backdrop; internal reflections show the light.
        let clear = |visible| seen_with(slab(r#"{"dielectric": {}}"#), uniform(Some(visible)), integrator, 1024);
        let transmitted = (clear(3.0) - clear(1.0)) / 2.0;
        assert!((transmitted - (1.0 - reflectance).powi(2)).abs() < 0.02, "{integrator}: {transmitted}");
        // A furnace in which the backdrop equals the light: no light counts twice.
        for glass in [
            r#"{"dielectric": {"roughness": 0.4}}"#,
            r#"{"principled": {"transmission": 1, "thin": true, "roughness": 0.4}}"#,
        ] {
            let furnace = |visible| seen_with(slab(glass), uniform(visible), integrator, 256);
            let (alike, plain) = (furnace(Some(1.0)), furnace(None));
            assert!((alike - plain).abs() < 0.01, "{integrator} {glass}: {alike} {plain}");
            assert!(furnace(Some(2.0)) > plain + 0.3, "{integrator} {glass}");
        }
    }
    // Classic glass: no Fresnel reflection unless the material has it.
    let classic = r#"{"phong": {"diffuse": 0, "transparency": 1, "ior": 1.5}}"#;
    assert_eq!(seen_with(slab(classic), uniform(Some(3.0)), r#"{"classic": {}}"#, 1), 3.0);
}

/// Leaves, metal, and glass in front of a mirror show the light.
#[test]
fn diffuse_transmission_and_reflections_show_the_light() {
    let mirrored = || {
        slab(r#"{"dielectric": {}}"#).with(r#"{"plane": {}}"#, Vec3::NEG_Y, r#"{"conductor": {"reflectance": 0.9}}"#)
    };
    for scene in [
        &|| slab(r#"{"translucent": {"reflectance": 0.2, "transmittance": 0.7}}"#) as Scene,
        &|| slab(r#"{"conductor": {"reflectance": 0.9, "roughness": 0.4}}"#),
        &mirrored,
        &|| slab(r#"{"boundary": {"medium": {"scattering": 50}}}"#),
    ] as [&dyn Fn() -> Scene; 4]
    {
        let [seen, plain] =
            [Some(3.0), None].map(|visible| seen_with(scene(), uniform(visible), r#"{"path": {}}"#, 64));
        assert!((seen - plain).abs() < 1e-6, "{seen} {plain}");
    }
}
