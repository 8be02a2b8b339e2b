//! Light by way of polished balls, which is asked for, against the same balls under a material that hides from the path
//! tracer what they are, so that their light is met by chance only.

use crate::probe::{Measured, Scene, looking, measure, path};
use crate::skies::panorama;
use juggler_math::{Transform, Vec3};
use juggler_tracer::camera::Shot;

const MIRROR: &str = r#"{"conductor": {"reflectance": 0.9}}"#;
const GLASS: &str = r#"{"dielectric": {"ior": 1.5}}"#;

/// As it is, or behind a mask without holes.
fn made_of(material: &str, is_hidden: bool) -> String {
    if is_hidden { format!(r#"{{"mask": {{"opacity": 1, "material": {material}}}}}"#) } else { material.into() }
}

fn ball(radius: f32) -> String {
    format!(r#"{{"sphere": {{"radius": {radius}}}}}"#)
}

fn lamp(scene: Scene, radius: f32, at: Vec3, radiance: f32) -> Scene {
    scene.with(&ball(radius), at, &format!(r#"{{"emissive": {{"radiance": {radiance}}}}}"#))
}

type Build = fn(bool) -> Scene;

fn mirror(hidden: bool) -> Scene {
    let scene = Scene::floor().with(&ball(0.5), Vec3::new(0.8, 0.5, 0.0), &made_of(MIRROR, hidden));
    lamp(scene, 0.5, Vec3::new(-1.0, 2.5, 0.5), 10.0)
}

/// A rectangle that shines down, and the floor in the middle of what the ball throws there.
fn glass(material: &str, hidden: bool) -> Scene {
    let down = Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap();
    Scene::floor().with(&ball(0.5), Vec3::new(0.1, 0.6, 0.0), &made_of(material, hidden)).placed(
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

/// A layer of varnish over paint: its mirror is asked for, its paint is not.
fn varnished(hidden: bool) -> Scene {
    let material = r#"{"plastic": {"reflectance": 0.3, "roughness": 0, "ior": 2}}"#;
    let scene = Scene::floor().with(&ball(0.7), Vec3::new(0.9, 0.7, 0.0), &made_of(material, hidden));
    lamp(scene, 0.7, Vec3::new(-1.0, 2.5, 0.5), 10.0)
}

fn classic(hidden: bool) -> Scene {
    let material = r#"{"phong": {"diffuse": 0.3, "reflection": 0.6}}"#;
    let scene = Scene::floor().with(&ball(0.7), Vec3::new(0.9, 0.7, 0.0), &made_of(material, hidden));
    lamp(scene, 0.7, Vec3::new(-1.0, 2.5, 0.5), 10.0)
}

fn sky(hidden: bool) -> Scene {
    Scene::floor().with(&ball(0.5), Vec3::new(0.3, 0.6, 0.1), &made_of(GLASS, hidden)).before(panorama())
}

/// Many vertices, several balls, one of them scaled, and a glossy floor.
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
        .with(&ball(0.5), Vec3::new(0.6, 0.6, 0.1), &made_of(GLASS, hidden))
        .placed(&ball(1.0), small, &made_of(MIRROR, hidden));
    lamp(scene, 0.6, Vec3::new(0.2, 2.3, 0.0), 4.0)
}

fn look() -> Shot {
    looking(Vec3::new(-0.5, 0.4, 1.9), Vec3::new(0.0, 0.0, 0.05))
}

const SCENES: [(&str, Build); 7] = [
    ("mirror", mirror),
    ("clear glass", clear),
    ("green glass", green),
    ("varnish", varnished),
    ("classic", classic),
    ("sky", sky),
    ("room", room),
];

#[test]
fn light_by_way_of_balls_is_neither_lost_nor_counted_twice() {
    for (name, build) in SCENES {
        let options = path(r#""max_depth": 10"#);
        let [asked, met] = [false, true].map(|hidden| measure(&build(hidden).world(), &look(), &*options, 1024));
        println!("{name}: {asked:?} {met:?}");
        asked.equals(met, name);
    }
}

#[test]
fn asking_by_way_of_balls_takes_noise_away() {
    for (name, build, least) in
        [("mirror", mirror as Build, 3.0), ("varnish", varnished, 2.0), ("classic", classic, 2.0)]
    {
        let options = path(r#""max_depth": 10"#);
        let [asked, met] = [false, true].map(|hidden| measure(&build(hidden).world(), &look(), &*options, 64));
        assert!(met.sigma > least * asked.sigma, "{name}: {asked:?} {met:?}");
    }
}

/// A lamp without a size throws what a small ball throws that is as strong, though no path can meet it.
#[test]
fn lamps_without_a_size_are_asked_too() {
    let at = Vec3::new(0.4, 2.0, 0.3);
    for (material, place) in [(MIRROR, Vec3::new(0.8, 0.5, 0.0)), (GLASS, Vec3::new(-0.1, 0.7, 0.1))] {
        let scene = || Scene::floor().with(&ball(0.4), place, material);
        let point = scene().lit(r#"{"point": {"position": [0.4, 2, 0.3], "color": 1, "intensity": 3}}"#);
        // I = L π r².
        let small = lamp(scene(), 0.02, at, 3.0 / (std::f32::consts::PI * 4e-4));
        let seen = |scene: Scene| measure(&scene.world(), &look(), &*path(r#""max_depth": 4"#), 256);
        let without = seen(
            Scene::floor()
                .with(&ball(0.4), place, r#"{"diffuse": {"reflectance": 0}}"#)
                .lit(r#"{"point": {"position": [0.4, 2, 0.3], "color": 1, "intensity": 3}}"#),
        );
        let [point, small]: [Measured; 2] = [seen(point), seen(small)];
        assert!(point.mean > 1.03 * without.mean, "{material}: the ball throws nothing: {point:?} {without:?}");
        let off = (point.mean - small.mean) / small.mean;
        assert!(off.abs() < 0.01 + 3.0 * small.sigma / small.mean, "{material}: {point:?} {small:?}");
    }
}
