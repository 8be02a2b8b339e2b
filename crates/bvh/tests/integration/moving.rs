//! Motion blur: trees agree with brute force at random times, for every quality and SIMD level, and
//! no ray leaves closed meshes.
//! `JUGGLER_RAYS=1_000_000 cargo test --release -p juggler-bvh --test integration moving::` sets
//! the number of rays.

use crate::common::mesh::{Mesh, crossed, globe, rays_to_try};
use crate::common::rays::{Aim, cut};
use crate::common::{Keep, Random, brute_force};
use juggler_bvh::{MovingBvh, MovingTriangleBvh, Quality, TriangleBvh, TriangleError, simd_levels};
use juggler_math::{Aabb, Ray, Vec3, vec3};

const SMALL: usize = 3000;
const SHUTTER: f32 = 0.04;

/// Normalized shutter time: at the ends, beyond them, or in between.
fn time(random: &mut Random) -> f32 {
    [0.0, 1.0, -0.5, 2.0, 0.5, random.unit(), random.unit(), random.unit()][random.below(8)]
}

fn at(share: f32, ray: &Ray) -> Ray {
    Ray { time: share * SHUTTER, ..*ray }
}

/// Interpolated position at the ray's time.
fn between(open: Vec3, close: Vec3, ray: &Ray) -> Vec3 {
    let share = (ray.time / SHUTTER).clamp(0.0, 1.0);
    open * (1.0 - share) + close * share
}

#[test]
fn moving_boxes_are_found_where_they_are() {
    let random = &mut Random::new(61);
    for count in [0, 1, 9, 700] {
        let one = |random: &mut Random| {
            let (center, size) = (random.point(), random.point() * 0.1);
            Aabb::from_points([center - size, center + size])
        };
        let boxes: Vec<[Aabb; 2]> = (0..count).map(|_| [one(random), one(random)]).collect();
        for quality in Quality::ALL {
            let tree = MovingBvh::build(&boxes, SHUTTER, quality);
            for level in simd_levels() {
                let tree = tree.clone().with_simd_level(level);
                for _ in 0..rays_to_try(SMALL) / 10 {
                    let ray = at(time(random), &Ray::new(random.point() * 2.0, random.direction()));
                    let now: Vec<Aabb> = boxes
                        .iter()
                        .map(|[open, close]| {
                            let corner = |a, b| between(a, b, &ray);
                            Aabb { min: corner(open.min, close.min), max: corner(open.max, close.max) }
                        })
                        .collect();
                    let mut leaf = Keep::new(&now, tree.order(), 1);
                    tree.closest(&mut { ray }, &mut leaf);
                    let expected = brute_force(&now, &ray);
                    assert_eq!(leaf.nearest(), [expected], "{count}, {quality:?}, {level:?}: {ray:?}");
                    assert_eq!(tree.any(&ray, &mut leaf), expected.is_some(), "{count}, {quality:?}: {ray:?}");
                }
            }
        }
    }
}

/// A mesh at shutter open and at shutter close.
struct Moving {
    open: Mesh,
    close: Mesh,
}

impl Moving {
    fn build(&self, quality: Quality) -> MovingTriangleBvh {
        let Self { open, close } = self;
        MovingTriangleBvh::build(&open.positions, &close.positions, &open.triangles, SHUTTER, quality).unwrap()
    }

    /// Mesh at the ray's time.
    fn at_time(&self, ray: &Ray) -> Mesh {
        let ends = self.open.positions.iter().zip(&self.close.positions);
        let positions = ends.map(|(open, close)| between(*open, *close, ray)).collect();
        Mesh { positions, triangles: self.open.triangles.clone() }
    }
}

/// Trees for each quality and SIMD level.
fn trees(moving: &Moving) -> Vec<(String, MovingTriangleBvh)> {
    let all = Quality::ALL.map(|quality| {
        let tree = moving.build(quality);
        simd_levels()
            .into_iter()
            .map(move |level| (format!("{quality:?}, {level:?}"), tree.clone().with_simd_level(level)))
    });
    all.into_iter().flatten().collect()
}

fn check(name: &str, moving: &Moving, seed: u32) {
    let (random, trees) = (&mut Random::new(seed), trees(moving));
    let (mut tried, mut hit) = (0, 0);
    while tried < rays_to_try(SMALL) {
        let share = time(random);
        let at_time = moving.at_time(&at(share, &Ray::new(Vec3::ZERO, Vec3::X)));
        for ray in Aim::at(&at_time).call(random) {
            let ray = at(share, &ray);
            let first = at_time.closest(&ray);
            let end = cut(random, &ray, first.map(|hit| hit.t));
            for (ray, expected) in [(ray, first), (end, at_time.closest(&end))] {
                for (tree_name, tree) in &trees {
                    assert_eq!(tree.closest(&ray), expected, "{name}, {tree_name}: {ray:?}");
                    assert_eq!(tree.any(&ray), expected.is_some(), "{name}, {tree_name}: {ray:?}");
                }
            }
            (tried, hit) = (tried + 1, hit + usize::from(first.is_some()));
        }
    }
    assert!(hit * 20 > tried, "{name}: only {hit} of {tried} hit");
}

#[test]
fn moving_triangles_are_found_where_they_are() {
    let random = &mut Random::new(62);
    for count in [1, 9, 300] {
        let near = |random: &mut Random| {
            Mesh::from_triangles((0..count).map(|_| {
                let center = random.point();
                [(); 3].map(|()| center + random.point() * 0.3)
            }))
        };
        check(&format!("{count} triangles"), &Moving { open: near(random), close: near(random) }, 63);
    }
    let open = crossed(random, 400, 40);
    for (scale, offset) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e3)] {
        let [open, close] = [(1.0, 0.0), (-0.7, 0.3)].map(|(size, by)| {
            open.moved(vec3(1.0, size, 1.0), Vec3::X * by).moved(Vec3::splat(scale), Vec3::splat(offset))
        });
        check(&format!("crossed, scale {scale:e}, offset {offset}"), &Moving { open, close }, 64);
    }
}

/// Triangles that are degenerate at one end or in between, that are not finite, and missing
/// vertices.
#[test]
fn degenerate_moving_triangles_are_handled() {
    let open = Mesh::from_triangles([
        [Vec3::ZERO; 3],
        [Vec3::ZERO, Vec3::X, Vec3::Y],
        [Vec3::Z, Vec3::NAN, Vec3::Y],
        [Vec3::Z * -1.0, Vec3::X, Vec3::Y],
    ]);
    let close = Mesh::from_triangles([
        [Vec3::ZERO, Vec3::X, Vec3::Y],
        [Vec3::ZERO, Vec3::Y, Vec3::X],
        [Vec3::Z, Vec3::X, Vec3::Y],
        [Vec3::Z, Vec3::X, Vec3::INFINITY],
    ]);
    let moving = Moving { open, close };
    for (name, tree) in trees(&moving) {
        assert_eq!((tree.stats().items, tree.stats().left_out), (2, 2), "{name}");
        let ray = Ray::new(vec3(0.3, 0.3, 1.0), -Vec3::Z);
        let index = |share: f32| tree.closest(&at(share, &ray)).map(|hit| hit.index);
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(index), [Some(1), Some(1), None, Some(0)], "{name}");
    }
    let Moving { open, close } = &moving;
    let build = |close: &[Vec3]| MovingTriangleBvh::build(&open.positions, close, &open.triangles, 1.0, Quality::Fast);
    let error = build(&close.positions[..7]).unwrap_err();
    assert_eq!(error, TriangleError::NoSuchVertex { triangle: 2, vertex: 7, vertices: 7 });
}

/// A motion of zero gives the same bits as a static tree.
#[test]
fn moving_tree_without_motion_equals_the_static_tree() {
    let random = &mut Random::new(65);
    let mesh = crossed(random, 2000, 100);
    let still = TriangleBvh::build(&mesh.positions, &mesh.triangles, Quality::Balanced).unwrap();
    let moving = Moving { open: mesh.clone(), close: mesh.clone() }.build(Quality::Balanced);
    for _ in 0..rays_to_try(SMALL) {
        let ray = Ray::new(random.point() * 2.0, random.direction());
        for time in [0.0, SHUTTER] {
            assert_eq!(moving.closest(&Ray { time, ..ray }), still.closest(&ray));
        }
    }
    let (low, high) = (moving.bounds().min, moving.bounds().max);
    assert!(low.cmple(still.bounds().min).all() && high.cmpge(still.bounds().max).all());
    assert!(moving.bytes() > still.bytes());
}

/// Adjacent triangles share their vertices at every time, so no ray leaves the mesh.
#[test]
fn closed_meshes_stay_closed() {
    let random = &mut Random::new(66);
    let open = globe(random, 24, 36, 0.1);
    let turned = |p: &Vec3| vec3(p.z, p.y, -p.x) * 0.9 + Vec3::X * 0.2;
    let positions = open.positions.iter().map(turned).collect();
    let moving = Moving { close: Mesh { positions, triangles: open.triangles.clone() }, open };
    for (name, tree) in trees(&moving) {
        for _ in 0..rays_to_try(SMALL) {
            let share = random.unit() * 0.2;
            let at_time = |vertex: usize| {
                between(
                    moving.open.positions[vertex],
                    moving.close.positions[vertex],
                    &at(share, &Ray::new(Vec3::ZERO, Vec3::X)),
                )
            };
            let [a, b, _] =
                moving.open.triangles[random.below(moving.open.triangles.len())].map(|v| at_time(v as usize));
            let origin = random.point() * 0.2;
            let target = [a, a * 0.5 + b * 0.5, a.lerp(b, random.unit())][random.below(3)];
            let ray = at(share, &Ray::new(origin, target - origin));
            assert!(tree.closest(&ray).is_some() && tree.any(&ray), "{name}: a ray gets out: {ray:?}");
        }
    }
}
