//! Trees agree with brute force bit for bit: every quality, every query, coherent and incoherent
//! rays.

use crate::common::{Random, Shape, Sphere, check};
use juggler_math::{Aabb, Ray, Vec3};

fn spheres(random: &mut Random, count: usize) -> Vec<Sphere> {
    (0..count).map(|_| Sphere { center: random.point(), radius: 0.01 + 0.1 * random.unit() }).collect()
}

fn boxes(random: &mut Random, count: usize) -> Vec<Aabb> {
    let size = |random: &mut Random| random.unit() * random.unit() * 0.2;
    (0..count)
        .map(|_| {
            let (min, size) = (random.point(), Vec3::new(size(random), size(random), size(random)));
            Aabb { min, max: min + size }
        })
        .collect()
}

/// Unit boxes at integer coordinates; rays at integer coordinates lie in their planes.
fn bricks(random: &mut Random, count: usize) -> Vec<Aabb> {
    let whole = |random: &mut Random| Vec3::from(std::array::from_fn(|_| random.below(8) as f32 - 4.0));
    (0..count)
        .map(|_| {
            let min = whole(random);
            // Some boxes are flat.
            Aabb { min, max: min + whole(random).max(Vec3::ZERO).min(Vec3::ONE) }
        })
        .collect()
}

fn incoherent(random: &mut Random, count: usize) -> Vec<Ray> {
    (0..count)
        .map(|_| {
            let ray = Ray::new(random.point() * 2.0, random.direction() * (0.1 + random.unit() * 3.0));
            if random.below(4) == 0 { Ray { t_min: random.unit(), t_max: random.unit() * 2.0, ..ray } } else { ray }
        })
        .collect()
}

/// Eight rays through each of several pixels, from a point or a small aperture.
fn coherent(random: &mut Random, pixels: usize, spread: f32, aperture: f32) -> Vec<Ray> {
    let mut rays = Vec::new();
    for _ in 0..pixels {
        let (eye, target) = (random.direction() * 3.0, random.point());
        rays.extend((0..8).map(|_| {
            let origin = eye + random.point() * aperture;
            Ray::new(origin, (target + random.point() * spread - origin).normalize())
        }));
    }
    rays
}

/// Rays parallel to an axis or a coordinate plane, with zeros of both signs, from integer and other
/// coordinates.
fn axis_parallel(random: &mut Random, count: usize) -> Vec<Ray> {
    let component = |random: &mut Random| [0.0, -0.0, 1.0, -1.0, 1e-40, -1e-42, 1e-30, 0.5][random.below(8)];
    let coordinate = |random: &mut Random| {
        let whole = random.below(12) as f32 - 6.0;
        if random.below(3) == 0 { whole + random.unit() } else { whole }
    };
    (0..count)
        .filter_map(|_| {
            let origin = Vec3::from(std::array::from_fn(|_| coordinate(random)));
            let direction = Vec3::from(std::array::from_fn(|_| component(random)));
            // Shorter directions would overflow in the shapes' own tests.
            (direction.length() > 0.1).then(|| Ray::new(origin, direction))
        })
        .collect()
}

fn all_rays<S: Shape>(name: &str, shapes: &[S], seed: u32) {
    let random = &mut Random::new(seed);
    check(&format!("{name}, incoherent"), shapes, &incoherent(random, 400), 8);
    check(&format!("{name}, one pixel"), shapes, &coherent(random, 60, 1e-3, 0.0), 8);
    check(&format!("{name}, lens"), shapes, &coherent(random, 40, 0.1, 0.3), 8);
    check(&format!("{name}, odd groups"), shapes, &coherent(random, 30, 0.05, 0.01), 5);
    check(&format!("{name}, large groups"), shapes, &coherent(random, 30, 0.05, 0.01), 27);
    check(&format!("{name}, axis-parallel"), shapes, &axis_parallel(random, 400), 8);
}

#[test]
fn random_spheres_match_brute_force() {
    for (count, seed) in [(1, 1), (7, 2), (9, 3), (70, 4), (700, 5)] {
        all_rays(&format!("{count} spheres"), &spheres(&mut Random::new(seed), count), seed);
    }
}

#[test]
fn random_boxes_match_brute_force() {
    for (count, seed) in [(2, 11), (40, 12), (500, 13)] {
        all_rays(&format!("{count} boxes"), &boxes(&mut Random::new(seed), count), seed);
    }
}

/// Boxes that are a few ulps wide, far from the origin, and rays between them.
#[test]
fn boxes_far_from_the_origin_match_brute_force() {
    let random = &mut Random::new(71);
    for distance in [1e3, 1e5, 1e7] {
        let far = Vec3::new(1.0, -0.7, 0.3) * distance;
        let point = |random: &mut Random| far + random.point() * (distance * 2e-6);
        let shapes: Vec<Aabb> = (0..300)
            .map(|_| {
                let min = point(random);
                Aabb { min, max: min.map(f32::next_up).map(f32::next_up) }
            })
            .collect();
        let rays: Vec<Ray> = (0..2000)
            .map(|_| {
                let (from, to) = (point(random), shapes[random.below(300)]);
                let target = [to.min, to.max, to.center()][random.below(3)];
                Ray::new(from, if from == target { Vec3::X } else { target - from })
            })
            .collect();
        check(&format!("{distance} away"), &shapes, &rays, 8);
    }
}

/// A box that is intersected in double precision.
#[derive(Clone, Copy)]
struct Exact(Aabb);

impl Shape for Exact {
    fn bounds(&self) -> Aabb {
        self.0
    }

    fn hit(&self, ray: &Ray) -> Option<f32> {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (low, high) = ((self.0.min.as_dvec3() - origin) / direction, (self.0.max.as_dvec3() - origin) / direction);
        let (enter, leave) = (low.min(high).max_element(), low.max(high).min_element());
        let t = enter as f32;
        (enter <= leave && ray.t_min <= t && t <= ray.t_max).then_some(t)
    }
}

/// Rays that hit points exactly, despite all rounding of the box tests. Each point occurs many
/// times, so a hit must not hide the others at its distance.
#[test]
fn coincident_points_are_all_hit() {
    let random = &mut Random::new(81);
    // Directions with few bits, so that small multiples are exact.
    let directions: Vec<Vec3> = (0..60).map(|_| (random.point() * 4096.0).round() + 0.5).collect();
    let point = |i: usize| directions[i % 60] * [3.0, 5.0, 7.0][i % 3];
    let mut shapes: Vec<Exact> = (0..720).map(|i| Exact(Aabb { min: point(i), max: point(i) })).collect();
    for i in (1..shapes.len()).rev() {
        shapes.swap(i, random.below(i + 1));
    }
    let rays: Vec<Ray> = (0..800)
        .map(|_| {
            let number = random.below(60);
            let ray = Ray::new(Vec3::ZERO, directions[number]);
            // End some rays at the distance of the point.
            if random.below(2) == 0 { ray } else { ray.with_t_max([3.0, 5.0, 7.0][number % 3]) }
        })
        .collect();
    check("points", &shapes, &rays, 8);
    let alike: Vec<Ray> = rays.iter().take(150).flat_map(|&ray| [ray; 9]).collect();
    check("points, nine times the same ray", &shapes, &alike, 9);
}

#[test]
fn rays_in_the_planes_of_boxes_match_brute_force() {
    for (count, seed) in [(30, 21), (200, 22), (600, 23)] {
        all_rays(&format!("{count} bricks"), &bricks(&mut Random::new(seed), count), seed);
    }
}

/// Axis-parallel rays share an octant only if their zeros have the same signs, as here.
#[test]
fn axis_parallel_packets_match_brute_force() {
    let random = &mut Random::new(31);
    let shapes = bricks(random, 300);
    let mut rays = Vec::new();
    for zero in [0.0, -0.0] {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut direction = Vec3::splat(zero);
                direction[axis] = sign;
                for _ in 0..10 {
                    let corner = Vec3::from(std::array::from_fn(|_| random.below(10) as f32 - 5.0));
                    let step = [Vec3::ZERO, Vec3::splat(0.25)][random.below(2)];
                    rays.extend((0..8u8).map(|i| Ray::new(corner + step * f32::from(i), direction)));
                }
            }
        }
    }
    check("parallel", &shapes, &rays, 8);
}

/// Calls of 1 to 70 rays: partial packets, partial groups, groups with a remainder; in one octant
/// and in several.
#[test]
fn batches_of_any_size_match_brute_force() {
    let random = &mut Random::new(61);
    let shapes = spheres(random, 300);
    for count in 1..=70 {
        let (eye, target) = (random.direction() * 3.0, random.point());
        for spread in [0.01, 0.3, 3.0] {
            let aim = |random: &mut Random| target + random.point() * spread - eye;
            let rays: Vec<Ray> = (0..4 * count).map(|_| Ray::new(eye, aim(random))).collect();
            check(&format!("{count} rays"), &shapes, &rays, count);
        }
    }
}

#[test]
fn packets_accept_terminated_rays() {
    let random = &mut Random::new(41);
    let shapes = spheres(random, 200);
    let mut rays = coherent(random, 100, 0.01, 0.0);
    for ray in &mut rays {
        match random.below(4) {
            0 => ray.t_max = f32::NEG_INFINITY,
            1 => ray.t_max = random.unit() * 4.0,
            2 => ray.t_min = random.unit() * 4.0,
            _ => {}
        }
    }
    check("ended", &shapes, &rays, 8);
}

/// Equal shapes in many leaves: the smallest index wins, wherever the rays come from.
#[test]
fn ties_go_to_the_smallest_number() {
    let shapes = vec![Sphere { center: Vec3::ZERO, radius: 0.5 }; 100];
    let random = &mut Random::new(51);
    check("ties", &shapes, &coherent(random, 20, 0.3, 0.1), 8);
    // Bricks in a row: neighbors share a face, and rays in that face hit both at the same distance.
    let row: Vec<Aabb> =
        (0..200u8).map(|i| Aabb { min: Vec3::X * f32::from(i), max: Vec3::X * f32::from(i) + Vec3::ONE }).collect();
    let down = |i: u8| Ray::new(Vec3::new(f32::from(i), 5.0, 0.5), -Vec3::Y);
    check("faces", &row, &(0..=200).map(down).collect::<Vec<_>>(), 8);
}
