//! Surfaces of several objects at one place: the picture does not depend on their order, and agrees
//! with closed forms. `JUGGLER_FURNACES=all` runs 200 random stacks: `check.sh deep furnaces`.

use crate::probe::{Estimate, Scene, is_deep, looking, measure, path, prepared, read};
use juggler_integrator::AnyIntegrator;
use juggler_math::testing::{Random, family_wise_deviations};
use juggler_math::{Motion, Transform, Vec3};
use juggler_world::{Content, Geometry, Object};
use std::sync::Arc;

/// An object of a test scene.
#[derive(Clone, Debug)]
pub struct Item {
    shape: String,
    motion: Motion,
    material: String,
    is_instance: bool,
}

impl Item {
    pub fn new(shape: impl Into<String>, material: impl Into<String>) -> Self {
        let (shape, material) = (shape.into(), material.into());
        Self { shape, motion: Transform::IDENTITY.into(), material, is_instance: false }
    }

    pub fn cuboid(min: [f64; 3], max: [f64; 3], material: impl Into<String>) -> Self {
        Self::new(format!(r#"{{"cuboid": {{"min": {min:?}, "max": {max:?}}}}}"#), material)
    }

    pub fn moved(self, motion: impl Into<Motion>) -> Self {
        Self { motion: motion.into(), ..self }
    }

    /// The same surface in another representation: 0 as it is, 1 as a mesh, 2 in an instance.
    pub fn represented(self, kind: usize) -> Self {
        match kind {
            1 => Self { shape: mesh_of(&self.shape), ..self },
            2 => Self { is_instance: true, ..self },
            _ => self,
        }
    }

    fn add_to(&self, scene: &mut Scene) {
        let material = scene.material(&self.material);
        let object = Object::new(prepared(&self.shape), Transform::IDENTITY, material);
        scene.objects.push(if self.is_instance {
            Object { content: instance(object), motion: self.motion.clone(), material: None, attributes: None }
        } else {
            Object { motion: self.motion.clone(), ..object }
        });
    }
}

fn instance(object: Object) -> Content {
    Content::Geometry(Arc::new(Geometry::new(vec![object], &juggler_math::BuildControl::default()).unwrap()))
}

/// Triangle mesh with the surface of a cuboid or of a rectangle in the plane y = 0.
fn mesh_of(shape: &str) -> String {
    let bounds = juggler_shape::Shape::bounds(&*prepared(shape));
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        [pick(0), pick(1), pick(2)]
    };
    let (corners, triangles): (Vec<_>, &[[u32; 3]]) = if bounds.extent().y > 0.0 {
        let sides: &[[u32; 3]] = &[
            [0, 4, 6],
            [0, 6, 2],
            [1, 3, 7],
            [1, 7, 5],
            [0, 1, 5],
            [0, 5, 4],
            [2, 6, 7],
            [2, 7, 3],
            [0, 2, 3],
            [0, 3, 1],
            [4, 5, 7],
            [4, 7, 6],
        ];
        ((0..8).map(corner).collect(), sides)
    } else {
        ([0, 1, 5, 4].map(corner).to_vec(), &[[0, 3, 2], [0, 2, 1]])
    };
    format!(r#"{{"mesh": {{"positions": {corners:?}, "triangles": {triangles:?}}}}}"#)
}

/// All orders of a list.
pub fn orders<T: Clone>(items: &[T]) -> Vec<Vec<T>> {
    let [first, rest @ ..] = items else { return vec![Vec::new()] };
    let mut all = Vec::new();
    for order in orders(rest) {
        for at in 0..=order.len() {
            let mut one = order.clone();
            one.insert(at, first.clone());
            all.push(one);
        }
    }
    all
}

pub fn scene(items: &[Item]) -> Scene {
    let mut scene = Scene::new();
    items.iter().for_each(|item| item.add_to(&mut scene));
    scene
}

pub fn glass(ior: f64) -> String {
    format!(r#"{{"dielectric": {{"ior": {ior}}}}}"#)
}

/// Fog that lets a fraction of light through a distance of 1.
pub fn fog(fraction: f64) -> String {
    format!(r#"{{"boundary": {{"medium": {{"color": {fraction}, "distance": 1}}}}}}"#)
}

const EMITTER: &str = r#"{"emissive": {"radiance": 1}}"#;
const CUT_OUT: &str = r#"{"mask": {"opacity": 0, "material": {"diffuse": {}}}}"#;

pub fn floor(size: f64) -> String {
    format!(r#"{{"rectangle": {{"size": [{size}, {size}]}}}}"#)
}

/// Turns, shifts and motions of whole scenes, by number; a few of them unless all cases are run.
pub fn placements() -> Vec<(usize, Motion)> {
    let all = all_placements().into_iter().enumerate();
    all.filter(|(number, _)| is_deep() || [0, 7, 17, 18].contains(number)).collect()
}

fn all_placements() -> Vec<Motion> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.3, 1.0, 0.2)];
    let turn = |i: usize| Transform::rotation(axes[i % 4].normalize(), 0.37 * i as f32).unwrap();
    let mut all: Vec<Motion> = (0..17).map(|i| turn(i).into()).collect();
    all.push(Transform::translation(Vec3::new(1000.0, -700.0, 300.0)).into());
    let away = Transform::translation(Vec3::new(0.3, 0.1, -0.2));
    all.push(Motion::from_keys(vec![turn(3), turn(3).then(&away)]).unwrap());
    all
}

/// Radiance along rays around the origin of `placement`, from the direction `from` before it.
pub fn seen(items: &[Item], placement: &Motion, from: Vec3, background: f32, integrator: &AnyIntegrator) -> Estimate {
    let middle = placement.at(0.5);
    let moved: Vec<Item> = items.iter().map(|item| item.clone().moved(item.motion.then(placement))).collect();
    let camera = looking(middle.point(from), middle.point(Vec3::ZERO));
    measure(&scene(&moved).in_light(background).world(), &camera, &**integrator, 64)
}

#[track_caller]
pub fn is_near(what: &str, seen: Estimate, expected: f64, tolerance: f64) {
    assert!((seen.mean - expected).abs() <= tolerance, "{what}: {seen:?} instead of {expected}");
}

/// Pairs of solids around the plane x = 0 that touch or overlap.
fn pairs() -> Vec<(&'static str, [Item; 2])> {
    let left = |n| Item::cuboid([-1.0, -1.0, -0.5], [0.0, 1.0, 0.5], glass(n));
    let right = |n| Item::cuboid([0.0, -1.0, -0.5], [1.0, 1.0, 0.5], glass(n));
    let over = |n| Item::cuboid([-0.5, -1.0, -0.5], [0.6, 1.0, 0.5], glass(n));
    vec![
        ("touching, 1.5 and 1.5", [left(1.5), right(1.5)]),
        ("touching, 1.5 and 1.7", [left(1.5), right(1.7)]),
        ("overlapping, 1.5 and 1.5", [left(1.5), over(1.5)]),
        ("overlapping, 1.5 and 1.7", [left(1.5), over(1.7)]),
    ]
}

#[test]
fn touching_and_overlapping_glass_is_invisible_in_a_white_furnace() {
    let placements = placements();
    for (name, pair) in pairs() {
        for (number, placement) in &placements {
            for order in orders(&pair) {
                for kind in 0..3 {
                    let items: Vec<Item> = order.iter().cloned().map(|item| item.represented(kind)).collect();
                    for from in [Vec3::new(3.0, 0.4, 0.7), Vec3::new(0.8, 3.0, 1.1)] {
                        let result = seen(&items, placement, from, 1.0, &path(r#""max_depth": 500"#));
                        is_near(&format!("{name}, placement {number}, representation {kind}"), result, 1.0, 0.002);
                    }
                }
            }
        }
    }
}

#[test]
fn touching_media_attenuate_once_each() {
    let block = |x: f64| Item::cuboid([x, -1.0, -0.5], [x + 1.0, 1.0, 0.5], fog(0.5));
    let clear = r#"{"dielectric": {"ior": 1, "medium": {"absorption": 0.5}}}"#;
    let solid = |x: f64| Item::cuboid([x, -1.0, -0.5], [x + 1.0, 1.0, 0.5], clear);
    let (two, three) = ([block(-1.0), block(0.0)], [block(-1.0), block(0.0), block(1.0)]);
    let cases = [(&two[..], 0.25), (&three[..], 0.125), (&[solid(-1.0), solid(0.0)][..], (-1.0_f64).exp())];
    for (items, expected) in cases {
        for (number, placement) in &placements() {
            for order in orders(items) {
                for kind in 0..3 {
                    let items: Vec<Item> = order.iter().cloned().map(|item| item.represented(kind)).collect();
                    let result = seen(&items, placement, Vec3::new(5.0, 0.0, 0.0), 1.0, &path(""));
                    let what = format!("{} blocks, placement {number}, representation {kind}", items.len());
                    // Far from the origin, and while they move, lengths are rounded.
                    is_near(&what, result, expected, if *number < 17 { 1e-5 } else { 1e-3 });
                }
            }
        }
    }
}

/// An emitter emits its radiance into the medium that it touches: through the glass (1 - R) / n² of
/// it arrive, since the emitter absorbs what the glass reflects.
#[test]
fn glass_that_stands_on_an_emitter_refracts_its_light() {
    let block = Item::cuboid([-1.0, 0.0, -1.0], [1.0, 1.0, 1.0], glass(1.5));
    for order in orders(&[block, Item::new(floor(8.0), EMITTER)]) {
        for (_, placement) in placements().iter().filter(|(number, _)| *number < 17) {
            for kind in 0..3 {
                let items: Vec<Item> = order.iter().cloned().map(|item| item.represented(kind)).collect();
                let result = seen(&items, placement, Vec3::new(0.0, 3.0, 0.0), 0.0, &path(""));
                is_near("emitter", result, 0.96 / 2.25, 0.004);
            }
        }
    }
}

/// A glass box on a table: one picture in both orders, that of a box sunk into the table.
#[test]
fn glass_that_stands_on_a_table_shows_the_table() {
    let table = Item::new(floor(8.0), r#"{"diffuse": {"reflectance": 0.8}}"#);
    let block = |low: f64| Item::cuboid([-1.0, low, -1.0], [1.0, 1.0, 1.0], glass(1.5));
    let picture = |items: &[Item]| {
        let camera = looking(Vec3::new(1.0, 3.0, 2.0), Vec3::ZERO);
        measure(&scene(items).in_light(1.0).world(), &camera, &*path(""), 256)
    };
    let sunk = picture(&[block(-1e-3), table.clone()]);
    for order in orders(&[block(0.0), table]) {
        picture(&order).equals(sunk, "a glass box on a table");
    }
}

/// Cut-outs, one-sided backs and unlit surfaces on a wall hide nothing of it, in every integrator.
#[test]
fn absent_surfaces_on_a_wall_show_the_wall() {
    let wall = Item::new(floor(8.0), EMITTER);
    let behind = Item::new(floor(8.0), r#"{"emissive": {"radiance": 5}}"#)
        .moved(Transform::translation(Vec3::new(0.0, -1.0, 0.0)));
    let back = Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap();
    let one_sided = Item::new(floor(6.0), r#"{"diffuse": {"sides": "front"}}"#).moved(back);
    let integrators: Vec<AnyIntegrator> =
        vec![path(""), read(r#"{"classic": {}}"#), read(r#"{"albedo": {}}"#), read(r#"{"depth": {}}"#)];
    for absent in [Item::new(floor(6.0), CUT_OUT), one_sided] {
        for integrator in &integrators {
            let alone = seen(
                std::slice::from_ref(&wall),
                &Transform::IDENTITY.into(),
                Vec3::new(1.0, 3.0, 2.0),
                0.0,
                integrator,
            );
            for order in orders(&[wall.clone(), absent.clone(), behind.clone()]) {
                for (_, placement) in placements().iter().filter(|(number, _)| *number < 17) {
                    for kind in 0..3 {
                        let items: Vec<Item> = order.iter().cloned().map(|item| item.represented(kind)).collect();
                        let result = seen(&items, placement, Vec3::new(1.0, 3.0, 2.0), 0.0, integrator);
                        is_near("wall", result, alone.mean, 2e-5);
                    }
                }
            }
        }
    }
}

/// Shadow rays to a light pass a cut-out on a wall, and nothing else.
#[test]
fn walls_behind_cut_outs_cast_shadows() {
    let light = r#"{"point": {"position": [0, 4, 0], "intensity": 16}}"#;
    let floor_below = Item::new(floor(20.0), r#"{"diffuse": {"reflectance": 0.5}}"#)
        .moved(Transform::translation(Vec3::new(0.0, -2.0, 0.0)));
    for integrator in [path(r#""max_depth": 2"#), read(r#"{"classic": {}}"#)] {
        let lit = |items: &[Item]| {
            let camera = looking(Vec3::new(0.5, -1.0, 0.4), Vec3::new(0.1, -2.0, 0.1));
            measure(&scene(items).lit(light).world(), &camera, &*integrator, 4).mean
        };
        let sheet = Item::new(floor(6.0), CUT_OUT);
        let wall = Item::new(floor(6.0), r#"{"diffuse": {}}"#);
        assert!(lit(&[sheet.clone(), floor_below.clone()]) > 0.05);
        for order in orders(&[sheet, wall, floor_below.clone()]) {
            assert_eq!(lit(&order), 0.0);
        }
    }
}

/// Two coincident faces of contrary winding, each without a back, in one mesh or in two.
#[test]
fn faces_back_to_back_are_seen_from_both_sides() {
    let material = r#"{"diffuse": {"reflectance": 0.5, "sides": "front"}}"#;
    let faces = ["[[0, 3, 2], [0, 2, 1]]", "[[0, 2, 3], [0, 1, 2]]", "[[0, 3, 2], [0, 2, 1], [0, 2, 3], [0, 1, 2]]"];
    let [up, down, both] = faces.map(|triangles| {
        let corners = "[[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]";
        Item::new(format!(r#"{{"mesh": {{"positions": {corners}, "triangles": {triangles}}}}}"#), material)
    });
    for items in [vec![up.clone(), down.clone()], vec![down, up], vec![both]] {
        for (_, placement) in placements() {
            for from in [Vec3::new(0.3, 3.0, 0.2), Vec3::new(0.3, -3.0, 0.2)] {
                let result = seen(&items, &placement, from, 1.0, &path(""));
                is_near("sheet", result, 0.5, 0.002);
            }
        }
    }
}

/// A glass sphere fills a shell of its own radius and index: both are one sphere.
#[test]
fn a_sphere_in_a_shell_of_its_own_radius_is_one_solid() {
    let sphere = |n: f64| Item::new(r#"{"sphere": {"radius": 1}}"#, glass(n));
    for pair in [[sphere(1.5), sphere(1.5)], [sphere(1.5), sphere(1.7)]] {
        for order in orders(&pair) {
            for (_, placement) in placements() {
                let result = seen(&order, &placement, Vec3::new(3.0, 0.4, 0.7), 1.0, &path(r#""max_depth": 500"#));
                is_near("shell", result, 1.0, 0.002);
            }
        }
    }
}

/// A member of a random stack that starts at the height `y`, and its thickness.
fn layer(random: &mut Random, y: f64) -> (Item, f64) {
    let (kind, thickness) = (random.below(3), 0.25 * (1 + random.below(4)) as f64);
    let glass = glass(1.2 + 0.1 * random.below(6) as f64);
    let block = |material: &str| Item::cuboid([-4.0, y, -4.0], [4.0, y + thickness, 4.0], material);
    let up = Transform::translation(Vec3::new(0.0, y as f32, 0.0));
    let turned = Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap().then(&up);
    let one_sided = r#"{"diffuse": {"sides": "front"}}"#;
    let (item, thickness) = match random.below(6) {
        0 | 1 => (block(&fog(0.5)), thickness),
        2 => (block(&glass), thickness),
        3 => (block(r#"{"dielectric": {"ior": 1, "medium": {"absorption": 0.4}}}"#), thickness),
        4 => (Item::new(floor(8.0), CUT_OUT).moved(up), 0.0),
        _ => (Item::new(floor(8.0), one_sided).moved(turned), 0.0),
    };
    (item.represented(kind), thickness)
}

/// A stack of 2 to 4 layers along y, `distance` apart, on a diffuse floor if `random`
/// says so.
fn stack(random: &mut Random, distance: f64) -> Vec<Item> {
    let (mut items, mut y) = (Vec::new(), 0.0);
    if random.below(2) == 0 {
        items.push(Item::new(floor(8.0), r#"{"diffuse": {"reflectance": 0.6}}"#));
        y += distance;
    }
    for _ in items.len()..2 + random.below(3) {
        let (item, thickness) = layer(random, y);
        items.push(item);
        y += thickness + distance;
    }
    items
}

#[test]
fn random_stacks_do_not_depend_on_the_order_of_their_layers() {
    let stacks = if is_deep() { 200 } else { 6 };
    let deviations = family_wise_deviations(stacks * 24);
    for number in 0..stacks {
        let make = |distance: f64| stack(&mut Random::new(number as u64), distance);
        let placement = all_placements()[if number % 2 == 0 { 0 } else { number % 17 }].clone();
        let integrator = path(r#""max_depth": 200"#);
        let picture = |items: &[Item]| seen(items, &placement, Vec3::new(2.0, 6.0, 1.0), 1.0, &integrator);
        let (items, first) = (make(0.0), picture(&make(0.0)));
        for order in orders(&items) {
            let other = picture(&order);
            let allowed = deviations * (first.sigma * first.sigma + other.sigma * other.sigma).sqrt();
            assert!(first.sigma < (0.05 * first.mean).max(1e-3), "stack {number} is too noisy: {first:?}");
            let difference = (other.mean - first.mean).abs();
            assert!(difference <= allowed + 1e-4 * first.mean, "stack {number}: {first:?}, {other:?}, {order:?}");
        }
        // Small distances change nothing without refraction, and unless a floor faces a one-sided
        // sheet.
        let has = |text: &str| items.iter().any(|item| item.material.contains(text));
        let refracts = items.iter().any(|item| item.material.starts_with(r#"{"dielectric": {"ior": 1."#));
        if !(refracts || has("0.6") && has("sides")) {
            let apart = picture(&make(1e-3));
            let allowed = 0.005 + deviations * (first.sigma + apart.sigma);
            assert!((apart.mean - first.mean).abs() < allowed, "stack {number}: {first:?}, {apart:?}");
        }
    }
}
