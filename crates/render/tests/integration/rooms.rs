//! Room furnaces: surfaces of albedo a that emit 1 − a have radiance 1 everywhere, whatever their
//! shape, if all other light has radiance 1 too. Covers every emissive shape, exact and as a mesh,
//! from inside and outside, under many transforms, with every sampling strategy; and flat emitters
//! in their own plane, where rounding decides on which side a point lies.

use crate::probe::{Estimate, Scene, camera, is_deep, json, looking, measure, path, picture};
use juggler_bvh::simd_levels;
use juggler_camera::ShutterCamera;
use juggler_integrator::Integrator;
use juggler_math::testing::Random;
use juggler_math::{Rgb, Transform, Vec3};
use juggler_world::World;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Maximum difference of a mean from 1, and maximum standard error of a mean.
const TOLERANCE: f64 = 0.002;
const MOST_NOISE: f64 = 0.0008;

/// Maximum standard error over the whole grid, whose tolerances include it.
const DEEP_NOISE: f64 = 3.0 * MOST_NOISE;

/// Maximum factor on the number of samples of noisy means.
const MOST_REPEATS: u32 = 64;

/// Number of standard errors that one of about 3,000 means exceeds by chance in one of a hundred
/// runs (Šidák).
const FAMILY_WISE: f64 = 4.7;

/// A surface that surrounds a room or stands alone; about 2 across, around the origin.
struct Room {
    name: &'static str,
    walls: Vec<(String, Transform)>,
    form: Form,
    /// Whether transforms that keep angles leave a shape that is light-sampled by solid angle.
    by_solid_angle: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// The front faces outside, and no light enters.
    Closed,
    /// The front of the walls faces inside.
    FacingIn,
    /// Light passes around or through the shape, or the shape is infinite.
    Open,
}

/// JSON of a mesh.
fn mesh(positions: &[Vec3], triangles: &[[usize; 3]]) -> String {
    let positions: Vec<String> = positions.iter().map(|position| json(*position)).collect();
    format!(r#"{{"mesh": {{"positions": [{}], "triangles": {triangles:?}}}}}"#, positions.join(", "))
}

/// A cube of two triangles per side.
fn box_mesh() -> String {
    let corners: Vec<Vec3> =
        (0..8u8).map(|i| Vec3::new(f32::from(i & 1), f32::from(i >> 1 & 1), f32::from(i >> 2)) * 2.0 - 1.0).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[usize; 3]> = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    mesh(&corners, &triangles)
}

/// A surface of revolution around y: rings of 12 corners with these heights and radii.
fn lathe(rings: &[(f32, f32)]) -> String {
    let around = |(y, radius): (f32, f32)| {
        (0..12u8).map(move |i| {
            let angle = f32::from(i) / 12.0 * TAU;
            Vec3::new(angle.cos() * radius, y, -angle.sin() * radius)
        })
    };
    let corners: Vec<Vec3> = rings.iter().copied().flat_map(around).collect();
    let side = |ring: usize, i: usize| {
        let (a, b) = (ring * 12 + i, ring * 12 + (i + 1) % 12);
        [[a, b, b + 12], [a, b + 12, a + 12]]
    };
    let sides = (0..rings.len() - 1).flat_map(|ring| (0..12).flat_map(move |i| side(ring, i)));
    mesh(&corners, &sides.collect::<Vec<_>>())
}

fn sphere_mesh() -> String {
    let rings: Vec<(f32, f32)> = (0..=6u8).map(|i| f32::from(i) / 6.0 * PI - FRAC_PI_2).map(f32::sin_cos).collect();
    lathe(&rings)
}

/// Six squares of side 2 that face in.
fn walls() -> Vec<(String, Transform)> {
    let turn = |axis: Vec3, quarters: f32| Transform::rotation(axis, quarters * FRAC_PI_2).unwrap();
    let turns = [
        turn(Vec3::X, 0.0),
        turn(Vec3::X, 1.0),
        turn(Vec3::X, 2.0),
        turn(Vec3::X, 3.0),
        turn(Vec3::Z, 1.0),
        turn(Vec3::Z, 3.0),
    ];
    let floor = Transform::translation(Vec3::NEG_Y);
    turns.map(|turn| (r#"{"rectangle": {"size": [2, 2]}}"#.to_owned(), floor.then(&turn))).to_vec()
}

fn rooms() -> Vec<Room> {
    let still = Transform::translation(Vec3::ZERO);
    let one = |name, shape: &str, form, by_solid_angle| Room {
        name,
        walls: vec![(shape.to_owned(), still)],
        form,
        by_solid_angle,
    };
    let polygon = r#"{"polygon": {"vertices": [[-1, 0, -1], [-1, 0, 1], [0.5, 0, 1], [1, 0, 0], [0.5, 0, -1]]}}"#;
    vec![
        one("sphere", r#"{"sphere": {"radius": 1}}"#, Form::Closed, true),
        one("cuboid", r#"{"cuboid": {"min": [-1, -1, -1], "max": [1, 1, 1]}}"#, Form::Closed, false),
        one("cylinder", r#"{"cylinder": {"radius": 1, "y_min": -1, "y_max": 1}}"#, Form::Closed, false),
        one("tube", r#"{"cylinder": {"radius": 1, "y_min": -1, "y_max": 1, "capped": false}}"#, Form::Open, false),
        one("endless tube", r#"{"tube": {"radius": 1}}"#, Form::Open, false),
        one("plane", r#"{"plane": {}}"#, Form::Open, false),
        one("disk", r#"{"disk": {"radius": 1}}"#, Form::Open, false),
        one("ring", r#"{"disk": {"radius": 1, "inner_radius": 0.5}}"#, Form::Open, false),
        one("rectangle", r#"{"rectangle": {"size": [2, 2]}}"#, Form::Open, true),
        one("triangle", r#"{"triangle": {"vertices": [[-1, 0, 1], [1, 0, 1], [0, 0, -1]]}}"#, Form::Open, true),
        one("polygon", polygon, Form::Open, false),
        one("box mesh", &box_mesh(), Form::Closed, true),
        one("sphere mesh", &sphere_mesh(), Form::Closed, true),
        one("tube mesh", &lathe(&[(-1.0, 1.0), (1.0, 1.0)]), Form::Open, true),
        Room { name: "six walls", walls: walls(), form: Form::FacingIn, by_solid_angle: true },
    ]
}

/// Name and transform of each placement of the rooms, and whether the transform keeps angles.
fn places() -> Vec<(&'static str, Transform, bool)> {
    let turn = Transform::rotation(Vec3::new(1.0, 2.0, 0.5), 0.9).unwrap();
    let scale = |scale: [f32; 3]| Transform::scale(Vec3::from(scale)).unwrap();
    let near = Transform::translation(Vec3::new(3.0, -1.0, 2.0));
    let far = Transform::translation(Vec3::new(700.0, -300.0, 500.0));
    vec![
        ("still", Transform::translation(Vec3::ZERO), true),
        ("even", scale([0.3; 3]).then(&turn).then(&near), true),
        ("uneven", scale([0.5, 1.5, 1.0]).then(&turn), false),
        ("mirrored", turn.then(&scale([-1.0, 0.6, 1.4])).then(&near), false),
        ("far", scale([1.3; 3]).then(&turn).then(&far), true),
        ("far, uneven", scale([1.3, 1.0, 0.7]).then(&turn).then(&far), false),
    ]
}

/// Material of a wall that emits what it does not reflect.
fn wall(albedo: f32, sides: &str) -> String {
    let reflecting = format!(r#"{{"diffuse": {{"reflectance": {albedo}}}}}"#);
    format!(r#"{{"emissive": {{"radiance": {}, "sides": "{sides}", "material": {reflecting}}}}}"#, 1.0 - albedo)
}

/// A room, its transform, material and sampling options.
struct Case<'a> {
    room: &'a Room,
    place: (&'static str, Transform, bool),
    albedo: f32,
    sampling: &'static str,
    light_samples: u32,
    samples: u32,
}

impl Case<'_> {
    fn measure(&self, sides: &str, around: f32, camera: &ShutterCamera) -> Estimate {
        let material = wall(self.albedo, sides);
        let scene = self.room.walls.iter().fold(Scene::new().in_light(around), |scene, (shape, place)| {
            scene.placed(shape, place.then(&self.place.1), &material)
        });
        // Path segments after which less than 10⁻⁴ of the light is missing.
        let depth = (1e-4f32.ln() / self.albedo.ln()).ceil() as u32 + 2;
        let options = format!(
            r#""sampling": "{}", "light_samples": {}, "max_depth": {depth}, "roulette_depth": null"#,
            self.sampling, self.light_samples
        );
        self.measure_until_sure(&scene.world(), camera, &*path(&options))
    }

    /// Estimates a mean. Over the whole grid, if the variance is bounded, the number of samples is
    /// quadrupled until the standard error is small enough; light sampling alone is noisy at a high
    /// albedo.
    fn measure_until_sure(&self, world: &World, camera: &ShutterCamera, integrator: &dyn Integrator) -> Estimate {
        let mut samples = self.samples;
        loop {
            let mean = measure(world, camera, integrator, samples);
            if !is_deep() || !self.has_bound() || mean.sigma <= DEEP_NOISE || samples >= MOST_REPEATS * self.samples {
                return mean;
            }
            samples *= 4;
        }
    }

    /// View between two points of the room's object space.
    fn view(&self, eye: Vec3, at: Vec3, degrees: f32) -> ShutterCamera {
        let (eye, at) = (json(self.place.1.point(eye)), json(self.place.1.point(at)));
        camera(&format!(r#"{{"perspective": {{"eye": {eye}, "look_at": {at}, "vertical_fov_degrees": {degrees}}}}}"#))
    }

    /// Checks the views that show radiance 1, and returns the failures.
    fn check(&self) -> Vec<String> {
        let inside = self.view(Vec3::new(0.3, 0.2, -0.25), Vec3::new(-0.4, -0.3, 0.1), 110.0);
        let outside = self.view(Vec3::new(1.5, 2.2, 3.1), Vec3::ZERO, 40.0);
        let means = match self.room.form {
            Form::Closed => vec![
                ("inside", self.measure("both", 0.0, &inside)),
                ("outside", self.measure("both", 1.0, &outside)),
                ("outside, front", self.measure("front", 1.0, &outside)),
            ],
            Form::FacingIn => vec![
                ("inside", self.measure("both", 0.0, &inside)),
                ("inside, front", self.measure("front", 0.0, &inside)),
            ],
            Form::Open => {
                vec![("near", self.measure("both", 1.0, &inside)), ("afar", self.measure("both", 1.0, &outside))]
            }
        };
        means.iter().for_each(|(view, mean)| println!("{}, {view}: {:.5} ± {:.5}", self.name(), mean.mean, mean.sigma));
        let mut failures: Vec<String> = means
            .iter()
            .filter(|(_, mean)| self.is_wrong(mean))
            .map(|(view, mean)| format!("{}, {view}: {:.5} ± {:.5}", self.name(), mean.mean, mean.sigma))
            .collect();
        if self.room.form == Form::Closed {
            let dark = self.measure("front", 0.0, &inside).mean;
            failures.extend(
                (dark > self.most_leaked()).then(|| format!("{}, emitting outwards, inside: {dark}", self.name())),
            );
        }
        failures
    }

    /// Maximum radiance that leaks into a closed room whose walls emit outwards. Points of a wall
    /// within a unit in the last place (of the coordinates) of an edge may be rounded to beyond the
    /// next wall, whose front then lights them. With e the fraction of such points, a path of
    /// albedo a meets them e / (1 - a) times and sees 1 - a each time: e in all. For a square of
    /// side 2 s the fraction is 2 / s units.
    fn most_leaked(&self) -> f64 {
        let place = &self.place.1;
        let center = place.point(Vec3::ZERO);
        let sizes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| place.point(axis).distance(center));
        let unit = f32::EPSILON * center.abs().max_element();
        f64::from(2.0 * unit / sizes.into_iter().fold(f32::INFINITY, f32::min)).max(1e-6)
    }

    /// Whether the variance of the samples is bounded. Light samples that are not distributed by
    /// solid angle have unbounded variance.
    fn has_bound(&self) -> bool {
        self.sampling != "light" || (self.room.by_solid_angle && self.place.2)
    }

    /// Whether a mean differs from 1. Means of unbounded variance are judged by their standard
    /// errors alone.
    fn is_wrong(&self, &Estimate { mean, sigma }: &Estimate) -> bool {
        let off = (mean - 1.0).abs();
        if !is_deep() {
            return off > TOLERANCE || sigma > MOST_NOISE;
        }
        off > TOLERANCE + FAMILY_WISE * sigma || (self.has_bound() && sigma > DEEP_NOISE)
    }

    fn name(&self) -> String {
        let Self { room, place, albedo, sampling, light_samples, .. } = self;
        format!("{}, {}, albedo {albedo}, {sampling}, {light_samples} light samples", room.name, place.0)
    }
}

#[test]
fn emissive_shapes_of_every_kind_form_a_furnace() {
    let all = is_deep();
    let strategies: &[(&str, u32)] =
        if all { &[("mis", 1), ("mis", 4), ("bsdf", 1), ("light", 1)] } else { &[("mis", 1)] };
    let albedos: &[(f32, u32)] = if all { &[(0.2, 128), (0.5, 128), (0.95, 64)] } else { &[(0.5, 32)] };
    let mut failures = Vec::new();
    for room in &rooms() {
        for place in places() {
            for &(albedo, samples) in albedos {
                for &(sampling, light_samples) in strategies {
                    failures.extend(Case { room, place, albedo, sampling, light_samples, samples }.check());
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

/// Random rotation and translation; for even numbers also a non-uniform scale.
fn pose(random: &mut Random, number: u32) -> Transform {
    let turn = Transform::rotation(random.unit_vector(), random.range(0.0, TAU)).unwrap();
    let stretch = Vec3::new(random.range(0.3, 3.0), random.range(0.3, 3.0), random.range(0.3, 3.0));
    let scale = Transform::scale(if number.is_multiple_of(2) { stretch } else { Vec3::splat(stretch.x) }).unwrap();
    scale.then(&turn).then(&Transform::translation(random.point(10.0)))
}

/// Flat shapes, exact and as meshes, with a corner at z = 1.
const FLAT: [&str; 6] = [
    r#"{"rectangle": {"size": [2, 2]}}"#,
    r#"{"mesh": {"positions": [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], "triangles": [[0, 1, 2], [0, 2, 3]]}}"#,
    r#"{"mesh": {"positions": [[-1, 0, 1], [1, 0, 1], [0.5, 0, -1], [-1, 0, -1]], "triangles": [[0, 1, 2], [0, 2, 3]]}}"#,
    r#"{"triangle": {"vertices": [[-1, 0, 1], [1, 0, 1], [0, 0, -1]]}}"#,
    r#"{"disk": {"radius": 1}}"#,
    r#"{"polygon": {"vertices": [[-1, 0, -1], [-1, 0, 1], [0.5, 0, 1], [1, 0, 0], [0.5, 0, -1]]}}"#,
];

/// Asserts that a lone flat shape in the dark has radiance 1 in all pixels, from its front or its
/// back.
fn alone(shape: &str, material: &str, side: f32) {
    let mut random = Random::new(3401);
    for number in 0..40 {
        let place = pose(&mut random, number);
        let world = Scene::new().placed(shape, place, material).world();
        let at = Vec3::new(random.range(-0.3, 0.3), 0.0, random.range(-0.3, 0.3));
        let camera = looking(place.point(at + Vec3::new(0.4, 3.0 * side, 0.2)), place.point(at));
        let expected = if side > 0.0 { Rgb::WHITE } else { Rgb::BLACK };
        for level in simd_levels() {
            let shown = picture(&world.clone().with_simd_level(level), &camera, &*path(""), 2, 1);
            let wrong = shown.iter().find(|pixel| **pixel != expected);
            assert_eq!(wrong, None, "{shape}, {material}, pose {number}, {level:?}");
        }
    }
}

#[test]
fn flat_emitters_do_not_light_themselves() {
    let reflecting = r#"{"principled": {"base_color": 0.8, "emissive": 1}}"#;
    let diffuse = r#"{"emissive": {"radiance": 1, "sides": "front", "material": {"diffuse": {"reflectance": 0.8}}}}"#;
    for shape in FLAT {
        alone(shape, reflecting, 1.0);
        alone(shape, diffuse, 1.0);
        alone(shape, diffuse, -1.0);
    }
}
