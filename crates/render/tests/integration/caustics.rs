//! Caustics of specular spheres: light sampling through a sphere against the same sphere in a mask
//! of opacity 1, which hides the sphere from light sampling, so that paths find its light by BSDF
//! sampling alone.

use crate::probe::{Estimate, Scene, camera, is_deep, looking, measure, path, picture};
use crate::skies::panorama;
use juggler_camera::ShutterCamera;
use juggler_math::testing::{Random, family_wise_deviations};
use juggler_math::{Transform, Vec3};

const MIRROR: &str = r#"{"conductor": {"reflectance": 0.9}}"#;
const GLASS: &str = r#"{"dielectric": {"ior": 1.5}}"#;

/// Material as it is, or in a mask of opacity 1.
fn made_of(material: &str, is_hidden: bool) -> String {
    if is_hidden { format!(r#"{{"mask": {{"opacity": 1, "material": {material}}}}}"#) } else { material.into() }
}

fn sphere(radius: f32) -> String {
    format!(r#"{{"sphere": {{"radius": {radius}}}}}"#)
}

fn sphere_light(scene: Scene, radius: f32, at: Vec3, radiance: f32) -> Scene {
    scene.with(&sphere(radius), at, &format!(r#"{{"emissive": {{"radiance": {radiance}}}}}"#))
}

pub type Build = fn(bool) -> Scene;

fn mirror(hidden: bool) -> Scene {
    let scene = Scene::floor().with(&sphere(0.5), Vec3::new(0.8, 0.5, 0.0), &made_of(MIRROR, hidden));
    sphere_light(scene, 0.5, Vec3::new(-1.0, 2.5, 0.5), 10.0)
}

/// A rectangular light that faces down, and a floor whose center lies in the sphere's caustic.
fn glass(material: &str, hidden: bool) -> Scene {
    let down = Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap();
    Scene::floor().with(&sphere(0.5), Vec3::new(0.1, 0.6, 0.0), &made_of(material, hidden)).placed(
        r#"{"rectangle": {"size": [2, 2]}}"#,
        down.then(&Transform::translation(Vec3::Y * 3.0)),
        r#"{"emissive": {"radiance": 5}}"#,
    )
}

fn clear(hidden: bool) -> Scene {
    glass(GLASS, hidden)
}

fn green(hidden: bool) -> Scene {
    glass(r#"{"dielectric": {"ior": 1.7, "medium": {"color": [0.4, 0.9, 0.5], "distance": 1}}}"#, hidden)
}

/// A layer of varnish over paint: light sampling covers its specular lobe, but not its diffuse one.
fn varnished(hidden: bool) -> Scene {
    let material = r#"{"plastic": {"reflectance": 0.3, "roughness": 0, "ior": 2}}"#;
    let scene = Scene::floor().with(&sphere(0.7), Vec3::new(0.9, 0.7, 0.0), &made_of(material, hidden));
    sphere_light(scene, 0.7, Vec3::new(-1.0, 2.5, 0.5), 10.0)
}

fn classic(hidden: bool) -> Scene {
    let material = r#"{"phong": {"diffuse": 0.3, "reflection": 0.6}}"#;
    let scene = Scene::floor().with(&sphere(0.7), Vec3::new(0.9, 0.7, 0.0), &made_of(material, hidden));
    sphere_light(scene, 0.7, Vec3::new(-1.0, 2.5, 0.5), 10.0)
}

fn sky(hidden: bool) -> Scene {
    Scene::floor().with(&sphere(0.5), Vec3::new(0.3, 0.6, 0.1), &made_of(GLASS, hidden)).before(panorama())
}

/// Several vertices per path, several spheres, one of them scaled, and a glossy floor.
fn room(hidden: bool) -> Scene {
    let small = Transform::scale(Vec3::splat(0.4)).unwrap().then(&Transform::translation(Vec3::new(-0.7, 0.4, 0.5)));
    let scene = Scene::new()
        .with(
            r#"{"cuboid": {"min": [-2, -0.05, -2], "max": [2, 3, 2]}}"#,
            Vec3::ZERO,
            r#"{"diffuse": {"reflectance": 0.5}}"#,
        )
        .with(
            r#"{"cuboid": {"min": [-1.5, -0.1, -1.5], "max": [1.5, 0, 1.5]}}"#,
            Vec3::ZERO,
            r#"{"plastic": {"reflectance": 0.5, "roughness": 0.3}}"#,
        )
        .with(&sphere(0.5), Vec3::new(0.6, 0.6, 0.1), &made_of(GLASS, hidden))
        .placed(&sphere(1.0), small, &made_of(MIRROR, hidden));
    sphere_light(scene, 0.6, Vec3::new(0.2, 2.3, 0.0), 4.0)
}

pub fn look() -> ShutterCamera {
    looking(Vec3::new(-0.5, 0.4, 1.9), Vec3::new(0.0, 0.0, 0.05))
}

pub const SCENES: [(&str, Build); 7] = [
    ("mirror", mirror),
    ("clear glass", clear),
    ("green glass", green),
    ("varnish", varnished),
    ("classic", classic),
    ("sky", sky),
    ("room", room),
];

#[test]
fn light_through_spheres_is_neither_lost_nor_counted_twice() {
    for (name, build) in SCENES {
        let options = path(r#""max_depth": 10"#);
        let [light_sampled, bsdf_sampled] =
            [false, true].map(|hidden| measure(&build(hidden).world(), &look(), &*options, 1024));
        println!("{name}: {light_sampled:?} {bsdf_sampled:?}");
        light_sampled.equals(bsdf_sampled, name);
    }
}

#[test]
fn light_sampling_through_spheres_reduces_noise() {
    for (name, build, least) in
        [("mirror", mirror as Build, 3.0), ("varnish", varnished, 2.0), ("classic", classic, 2.0)]
    {
        let options = path(r#""max_depth": 10"#);
        let [light_sampled, bsdf_sampled] =
            [false, true].map(|hidden| measure(&build(hidden).world(), &look(), &*options, 64));
        assert!(bsdf_sampled.sigma > least * light_sampled.sigma, "{name}: {light_sampled:?} {bsdf_sampled:?}");
    }
}

/// A point light casts the same caustic as a small sphere of equal intensity, though no path can
/// hit it.
#[test]
fn lights_without_a_size_are_sampled_too() {
    let at = Vec3::new(0.4, 2.0, 0.3);
    for (material, place) in [(MIRROR, Vec3::new(0.8, 0.5, 0.0)), (GLASS, Vec3::new(-0.1, 0.7, 0.1))] {
        let scene = || Scene::floor().with(&sphere(0.4), place, material);
        let point = scene().lit(r#"{"point": {"position": [0.4, 2, 0.3], "color": 1, "intensity": 3}}"#);
        // I = L π r².
        let small = sphere_light(scene(), 0.02, at, 3.0 / (std::f32::consts::PI * 4e-4));
        let seen = |scene: Scene| measure(&scene.world(), &look(), &*path(r#""max_depth": 4"#), 256);
        let without = seen(
            Scene::floor()
                .with(&sphere(0.4), place, r#"{"diffuse": {"reflectance": 0}}"#)
                .lit(r#"{"point": {"position": [0.4, 2, 0.3], "color": 1, "intensity": 3}}"#),
        );
        let [point, small]: [Estimate; 2] = [seen(point), seen(small)];
        assert!(point.mean > 1.03 * without.mean, "{material}: the sphere casts no caustic: {point:?} {without:?}");
        let off = (point.mean - small.mean) / small.mean;
        assert!(off.abs() < 0.01 + 3.0 * small.sigma / small.mean, "{material}: {point:?} {small:?}");
    }
}

/// Glass and metal spheres over the floor: single, nested, overlapping and coincident ones, in
/// random order.
fn heap(count: usize, random: &mut Random, is_hidden: bool) -> Scene {
    let mut spheres: Vec<(Vec3, f32, &str)> = Vec::new();
    while spheres.len() < count {
        let center = Vec3::new(random.range(-1.2, 1.2), random.range(0.4, 1.2), random.range(-1.2, 1.2));
        let (radius, material) = (random.range(0.1, 0.4), if random.range(0.0, 1.0) < 0.7 { GLASS } else { MIRROR });
        spheres.push((center, radius, material));
        match random.range(0.0, 4.0) as u32 {
            0 => spheres.push((center, radius, material)),
            1 => spheres.push((center, radius * random.range(0.3, 0.95), GLASS)),
            2 => spheres.push((center + random.unit_vector() * radius, radius, material)),
            _ => (),
        }
    }
    spheres.truncate(count);
    let mut order: Vec<(f32, _)> = spheres.into_iter().map(|sphere| (random.range(0.0, 1.0), sphere)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let scene = order.into_iter().fold(Scene::floor(), |scene, (_, (center, radius, material))| {
        scene.with(&sphere(radius), center, &made_of(material, is_hidden))
    });
    sphere_light(scene, 1.5, Vec3::new(0.2, 4.0, 0.1), 3.0)
}

#[test]
fn light_through_many_spheres_is_neither_lost_nor_counted_twice() {
    let options = path(r#""max_depth": 8"#);
    let camera =
        camera(r#"{"orthographic": {"eye": [0, 0.01, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "height": 3}}"#);
    let all: Vec<usize> = (1..=40).collect();
    let counts = if is_deep() { &all[..] } else { &[1, 2, 5, 16, 17, 18, 25, 40] };
    let deviations = family_wise_deviations(counts.len());
    for (seed, &count) in (0..).zip(counts) {
        let seen = |is_hidden| {
            let scene = heap(count, &mut Random::new(3450 + seed), is_hidden);
            picture(&scene.world(), &camera, &*options, 512, 1)
        };
        let [light_sampled, bsdf_sampled] = [false, true].map(seen);
        // The floor is lit unevenly, so compare pixel by pixel.
        let differences: Vec<f64> =
            light_sampled.iter().zip(&bsdf_sampled).map(|(a, b)| f64::from(a.r) - f64::from(b.r)).collect();
        let level = bsdf_sampled.iter().map(|pixel| f64::from(pixel.r)).sum::<f64>() / bsdf_sampled.len() as f64;
        let Estimate { mean, sigma } = Estimate::of(&differences);
        println!("{count}: {level} {mean} ± {sigma}");
        assert!(sigma < 0.01 * level, "{count} spheres: too noisy: {mean} ± {sigma} of {level}");
        assert!(mean.abs() < deviations * sigma + 1e-4 * level, "{count} spheres: {mean} ± {sigma} of {level}");
    }
}

/// Spheres at exactly and nearly the same position, of one material and of two; the caustic on the
/// floor counts once.
#[test]
fn coincident_spheres_transmit_light_once() {
    let at = Vec3::new(0.1, 0.6, 0.0);
    let green = r#"{"dielectric": {"ior": 1.5, "medium": {"color": [0.4, 0.9, 0.5], "distance": 1}}}"#;
    for (name, aside, second) in
        [("the same", 0.0, GLASS), ("nearly the same", 3e-6, GLASS), ("two materials", 0.0, green)]
    {
        let build = |is_hidden| clear(is_hidden).with(&sphere(0.5), at + Vec3::X * aside, &made_of(second, is_hidden));
        let options = path(r#""max_depth": 10"#);
        let [light_sampled, bsdf_sampled] =
            [false, true].map(|hidden| measure(&build(hidden).world(), &look(), &*options, 1024));
        println!("{name}: {light_sampled:?} {bsdf_sampled:?}");
        light_sampled.equals(bsdf_sampled, name);
    }
}

/// An opaque disk 1 % of the radius below a glass sphere leaves no caustic on the floor: segments
/// of shadow rays end at the sphere, not well before it.
#[test]
fn a_disk_right_below_a_sphere_blocks_its_caustic() {
    let floor = looking(Vec3::new(3.0, 0.3, 0.0), Vec3::ZERO);
    let scene = || {
        Scene::floor()
            .with(&sphere(0.5), Vec3::Y * 0.75, GLASS)
            .lit(r#"{"point": {"position": [0.1, 8, 0], "color": 1, "intensity": 30}}"#)
    };
    let seen = |scene: Scene| measure(&scene.world(), &floor, &*path(r#""max_depth": 8"#), 64).mean;
    assert!(seen(scene()) > 0.1, "there is no caustic to block");
    let black = r#"{"diffuse": {"reflectance": 0}}"#;
    let blocked = seen(scene().with(r#"{"disk": {"radius": 0.6}}"#, Vec3::Y * 0.245, black));
    assert_eq!(blocked, 0.0);
}

/// A small rectangular light beside a glass sphere, seen at another angle from the sphere's surface
/// than from its center.
fn close_light(is_hidden: bool) -> Scene {
    let tilted = Transform::rotation(Vec3::Z, 2.2).unwrap();
    Scene::floor().with(&sphere(0.5), Vec3::new(0.1, 0.6, 0.0), &made_of(GLASS, is_hidden)).placed(
        r#"{"rectangle": {"size": [0.5, 0.5]}}"#,
        tilted.then(&Transform::translation(Vec3::new(-0.2, 1.45, 0.1))),
        r#"{"emissive": {"radiance": 20}}"#,
    )
}

#[test]
fn light_close_to_a_sphere_is_neither_lost_nor_counted_twice() {
    let options = path(r#""max_depth": 6"#);
    let [light_sampled, bsdf_sampled] =
        [false, true].map(|hidden| measure(&close_light(hidden).world(), &look(), &*options, 4096));
    println!("{light_sampled:?} {bsdf_sampled:?}");
    light_sampled.equals(bsdf_sampled, "a light close to a sphere");
}

/// Light sampling through a sphere obeys the limits of path length and of specular bounces, as
/// BSDF sampling does.
#[test]
fn light_through_spheres_obeys_the_limits_of_paths() {
    let limits = (2..=5).map(|depth| format!(r#""max_depth": {depth}"#));
    let limits = limits.chain((0..=3).map(|specular| format!(r#""max_depth": 8, "max_specular": {specular}"#)));
    for limit in limits {
        for (name, build) in [("mirror", mirror as Build), ("glass", clear)] {
            let [light_sampled, bsdf_sampled] =
                [false, true].map(|hidden| measure(&build(hidden).world(), &look(), &*path(&limit), 256));
            println!("{name}, {limit}: {light_sampled:?} {bsdf_sampled:?}");
            // Paths of some limits carry no light at all.
            let sigma = (light_sampled.sigma.powi(2) + bsdf_sampled.sigma.powi(2)).sqrt();
            let off = (light_sampled.mean - bsdf_sampled.mean).abs();
            assert!(sigma < 0.004 && off <= 3.0 * sigma + 1e-4, "{name}, {limit}: off by {off} ± {sigma}");
        }
    }
}
