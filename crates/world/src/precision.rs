//! Self-intersection of rays that leave surfaces, and shadow rays: every shape at extreme sizes and
//! positions, under extreme transforms and from extreme distances, through the code that renders.

use super::tests::world_with;
use super::*;
use juggler_math::testing::Random;
use juggler_math::{DVec3, Frame, Transform, Vec3, portable, robust};
use juggler_shape::testing::{bounding_sphere, distance, is_convex, is_flat, is_solid};
use juggler_shape::{AnyShape, Cuboid, Mesh, MeshData, Plane, Sphere};

/// One object with its transform.
struct Subject {
    world: World,
    shape: AnyShape,
    transform: Transform,
    size: f32,
}

const SIZES: [f32; 5] = [1e-4, 1e-2, 1.0, 1e3, 1e6];

/// Number of linear maps; the first two preserve angles.
const MAPS: usize = 5;

fn linear(map: usize, scale: f32, random: &mut Random) -> Transform {
    let by = |x, y, z| Transform::scale(Vec3::new(x, y, z) * scale).unwrap();
    match map {
        0 => by(1.0, 1.0, 1.0),
        1 => by(-1.0, 1.0, 1.0).then(&random.rotation()),
        2 => random.rotation().then(&by(1.0, 5.0, 1.0)).then(&random.rotation()),
        // Nonuniform scaling between two rotations shears.
        3 => random.rotation().then(&by(3.0, 1.0 / 3.0, 1.0)).then(&random.rotation()),
        _ => (0..5).fold(by(1.0, 1.0, 1.0), |all, _| {
            all.then(&random.rotation()).then(&Transform::scale(Vec3::new(1.3, 0.8, 1.0)).unwrap())
        }),
    }
}

impl Subject {
    /// Places the shape. `size` is its size in world space, and `far` its distance from the origin
    /// in sizes; 0 leaves it where the shape defines it.
    fn new(shape: &AnyShape, map: usize, size: f32, far: f32, random: &mut Random) -> Self {
        let (center, radius) = bounding_sphere(shape);
        let linear = linear(map, size / radius, random);
        let place = random.unit_vector() * (far * size) - linear.point(center);
        let place = if far > 0.0 { place } else { Vec3::ZERO };
        let transform = linear.then(&Transform::translation(place));
        let world = world_with(shape.clone(), transform, map % 2 == 1);
        Self { world, shape: shape.clone(), transform, size }
    }

    /// Samples a point on the surface, with its normal; object space.
    fn place_on(&self, random: &mut Random) -> (Vec3, Vec3) {
        let (sin, cos) = portable::sin_cos_turns(random.f32());
        match &self.shape {
            AnyShape::Plane(_) => (random.point(1.0) * Vec3::new(1.0, 0.0, 1.0), Vec3::Y),
            AnyShape::Tube(t) => (Vec3::new(cos, random.range(-1.0, 1.0), sin) * t.radius, Vec3::new(cos, 0.0, sin)),
            shape => loop {
                let (center, radius) = bounding_sphere(shape);
                let from = center + random.unit_vector() * (3.0 * radius);
                if let Some(sample) = shape.sample(from, random.vec2()) {
                    return (sample.point, sample.normal);
                }
            },
        }
    }

    /// Hits the surface from a distance between very small and very large.
    fn arrive(&self, random: &mut Random) -> Option<Surface> {
        let target = self.transform.point(self.place_on(random).0);
        let away = [1e-3, 0.5, 3.0, 100.0, 1e4, 1e6][random.below(6)] * self.size;
        self.intersect(&towards(target + random.unit_vector() * away, target))
    }

    fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let mut ray = *ray;
        let hit = self.world.closest(&mut ray);
        hit.is_some().then(|| self.world.vertex(&ray, &hit).surface)
    }

    /// Distance of a surface point from the exact surface, in world space and `f64`.
    fn off(&self, surface: &Surface) -> f64 {
        let from_place = surface.point.as_dvec3() - self.transform.origin().as_dvec3();
        if let (AnyShape::Sphere(sphere), Some(scale)) = (&self.shape, self.transform.uniform_scale()) {
            return (from_place.length() - f64::from(sphere.radius * scale)).abs();
        }
        let (back, there) = (self.transform.inverse_matrix(), self.transform.matrix());
        let local: DVec3 = (0..3).map(|i| back.col(i).as_dvec3() * from_place[i]).sum();
        let from_shape = match &self.shape {
            // Rounding may move a point across the edge of a narrow triangle: measure only its
            // distance from the plane.
            AnyShape::Triangle(triangle) => {
                let [a, b, c] = triangle.vertices.map(|corner| corner.as_dvec3());
                (b - a).cross(c - a).normalize().dot(local - a).abs()
            }
            shape => distance(shape, local),
        };
        // Convert the object-space distance to world space.
        let across = DVec3::from_array(std::array::from_fn(|i| there.col(i).dot(surface.normal).into()));
        from_shape * across.length()
    }
}

fn towards(from: Vec3, to: Vec3) -> Ray {
    Ray::new(from, (to.as_dvec3() - from.as_dvec3()).normalize_or(DVec3::X).as_vec3())
}

/// Samples a direction on one side of a surface, uniform in the logarithm of its angle to the
/// surface; returns both.
fn leave(random: &mut Random, normal: Vec3, side: f32, flattest: f32) -> (Vec3, f32) {
    let angle = portable::exp(random.range(portable::ln(flattest), portable::ln(std::f32::consts::FRAC_PI_2)));
    let ((sin, cos), (up, along)) = (portable::sin_cos_turns(random.f32()), portable::sin_cos(angle));
    let frame = Frame::around(normal);
    let flat = (frame.tangent.as_dvec3() * f64::from(cos) + frame.bitangent.as_dvec3() * f64::from(sin)).normalize();
    let direction = flat * f64::from(along) + normal.as_dvec3() * f64::from(up * side);
    (direction.normalize().as_vec3(), angle)
}

/// Results for the rays that left one object.
#[derive(Debug, Default)]
struct Tally {
    hits: usize,
    /// Rays that left outwards, or on either side of a flat shape, and hit the shape again.
    acne: usize,
    /// Rays that left inwards and hit nothing, or the outside.
    leaks: usize,
    /// Points whose actual error exceeds the stated bound.
    wrong: usize,
    /// Ratios of the stated error bound to the actual error.
    width: Vec<f64>,
    /// Largest distance from surface point to ray origin, in ulps of the largest coordinate.
    moved: f32,
}

impl Tally {
    fn of(subject: &Subject, count: usize, random: &mut Random) -> Self {
        let mut tally = Self::default();
        for _ in 0..count {
            let Some(surface) = subject.arrive(random) else { continue };
            tally.hits += 1;
            let coordinate = surface.point.abs().max(subject.transform.origin().abs()).max_element();
            let ulp = f32::EPSILON * coordinate.max(subject.size);
            tally.measure(subject, &surface, ulp);
            for side in [1.0, -1.0] {
                let (direction, _) = leave(random, surface.normal, side, 1e-4);
                let ray = surface.spawn_ray(direction, 0.0);
                tally.moved = tally.moved.max(ray.origin.distance(surface.point) / ulp);
                let next = subject.intersect(&ray);
                let into = side < 0.0 && is_solid(&subject.shape);
                tally.acne += usize::from(next.is_some() && !into);
                tally.leaks += usize::from(into && !next.is_some_and(|s| s.normal.dot(direction) > 0.0));
            }
        }
        tally
    }

    fn measure(&mut self, subject: &Subject, surface: &Surface, ulp: f32) {
        let (off, error) = (subject.off(surface), f64::from(surface.position_error));
        // The corners of a polygon need not be exactly coplanar, and where coordinates are coarse,
        // rounding may move a point on a face across its edge.
        let coarse = ulp > 16.0 * f32::EPSILON * subject.size;
        let slack = if coarse || matches!(subject.shape, AnyShape::Polygon(_)) { f64::from(ulp) } else { 0.0 };
        self.wrong += usize::from(off > error + slack);
        if off > 0.0 {
            self.width.push(error / off);
        }
    }
}

/// Smallest extent of a shape divided by its size.
fn thinness(shape: &AnyShape) -> f32 {
    let (extent, size) = (shape.bounds().extent().min_element(), bounding_sphere(shape).1);
    if extent > 0.0 { (extent / size).min(1.0) } else { 1.0 }
}

/// `JUGGLER_HITS=2000` tests 100,000 hits and more of each shape.
#[test]
fn rays_leave_every_shape_and_stay_in_every_solid() {
    let count = std::env::var("JUGGLER_HITS").ok().and_then(|text| text.parse().ok()).unwrap_or(100);
    let mut shapes = AnyShape::examples();
    shapes.iter_mut().for_each(|shape| shape.prepare().unwrap());
    // The open mesh folds back on itself, so that its rays may hit it again.
    let meshes = |shape: &AnyShape| matches!(shape, AnyShape::Mesh(_));
    // Points on axis-aligned planes are exact, or all have the same error.
    let round = |shape: &AnyShape| matches!(shape, AnyShape::Sphere(_) | AnyShape::Tube(_) | AnyShape::Mesh(_));
    let closed = |shape: &AnyShape| is_flat(shape) || is_convex(shape) || meshes(shape) && is_solid(shape);
    for shape in shapes.iter().filter(|shape| closed(shape)) {
        for (map, size) in (0..MAPS).flat_map(|map| SIZES.map(|size| (map, size))) {
            for far in [0.0, 1.0, 300.0, 1e5, 1e6] {
                let mut random = Random::new(31);
                let subject = Subject::new(shape, map, size, far, &mut random);
                let mut tally = Tally::of(&subject, count, &mut random);
                tally.width.sort_by(f64::total_cmp);
                let width = tally.width.get(tally.width.len() / 2).copied().unwrap_or(0.0);
                let name = format!("{shape:?} map {map} size {size} far {far}");
                assert!((tally.hits > 0 || far > 1e4) && tally.acne == 0 && tally.wrong == 0, "{name}: {tally:?}");
                // Beside an edge sharper than a cube's, an offset inwards may leave through the
                // other face. The probability grows with the coarseness of coordinates relative to
                // the shape; a shape thinner than the offset has no inside at all.
                let sharp = meshes(shape) || map > 1 || far > 1.0;
                let share = if sharp { 0.01 + 16.0 * f32::EPSILON * far / thinness(shape) } else { 0.0 };
                assert!(tally.leaks as f32 <= (share * tally.hits as f32).ceil(), "{name}: {tally:?}");
                // Offsets are a few dozen ulps of the largest coordinate.
                assert!(tally.moved < 40.0 && (width < 70.0 || !round(shape)), "{name}: {tally:?}");
            }
        }
    }
}

/// A huge sphere as ground through the origin, where coordinates are much finer than its radius.
#[test]
fn rays_leave_huge_spheres_where_coordinates_are_small() {
    let mut random = Random::new(32);
    for radius in [1.0f32, 1e3, 1e6] {
        let up = random.unit_vector();
        let place = Transform::translation(-up * radius);
        let world = world_with(Sphere { radius }.into(), place, false);
        let subject = Subject { world, shape: Sphere { radius }.into(), transform: place, size: radius };
        for spread in [1e-6f32, 1e-4, 1e-2, 1.0] {
            for away in [1e-3f32, 1.0, 30.0, 70.0, 1e4] {
                for _ in 0..500 {
                    let target = random.unit_vector() * (spread * radius * random.f32());
                    let out = random.unit_vector();
                    let from = target + out * (away * radius).copysign(out.dot(up));
                    let Some(surface) = subject.intersect(&towards(from, target)) else { continue };
                    assert!(
                        subject.off(&surface) <= surface.position_error.into(),
                        "{radius} {spread} {away}: {surface:?}"
                    );
                    for side in [1.0, -1.0] {
                        let (direction, _) = leave(&mut random, surface.normal, side, 1e-4);
                        let next = subject.intersect(&surface.spawn_ray(direction, 0.0));
                        let fine = if side > 0.0 { next.is_none() } else { next.is_some() };
                        assert!(fine, "{radius} {spread} {away}: {surface:?} {direction} {next:?}");
                    }
                }
            }
        }
    }
}

/// A light on a surface is not occluded by that surface, and is occluded by anything just in front
/// of it.
#[test]
fn shadow_rays_end_before_the_surface_below_the_light() {
    let mut random = Random::new(33);
    let shapes: [AnyShape; 3] = [Plane {}.into(), Sphere::default().into(), Cuboid::default().into()];
    for (shape, map) in shapes.iter().flat_map(|shape| (0..MAPS).map(move |map| (shape, map))) {
        for (size, far) in SIZES.iter().flat_map(|size| [0.0, 1.0, 10.0].map(|far| (*size, far))) {
            let subject = Subject::new(shape, map, size, far, &mut random);
            for _ in 0..300 {
                let (local, outwards) = subject.place_on(&mut random);
                let (light, outwards) = (subject.transform.point(local), subject.transform.normal(outwards));
                let distance = size * [0.1, 1.0, 30.0][random.below(3)];
                let (out, angle) = leave(&mut random, outwards, 1.0, 0.2);
                let point = light + out * distance;
                let (normal, to) = (random.unit_vector(), light - point);
                let error = robust::gamma(4) * point.abs().dot(normal.abs());
                let here = Surface::new(point, error, normal, Vec2::ZERO);
                let ray = here.spawn_ray_to(to.normalize(), to.length(), 0.0);
                assert!(subject.intersect(&ray).is_none(), "{shape:?} {map} {size} {far}: {ray:?} {angle}");
                let behind = light - out * (2e-3 * size);
                let (to, distance_behind) = (behind - point, (behind - point).length());
                let deep = angle > 0.5 && distance < 2.0 * size;
                let is_hit =
                    subject.intersect(&here.spawn_ray_to(to / distance_behind, distance_behind, 0.0)).is_some();
                assert!(is_hit || !deep, "{shape:?} {map} {size} {far}: {point} {behind} {angle}");
            }
        }
    }
}

/// Rays from inside at points beside an edge hit a wall, and so do rays that leave there.
#[test]
fn closed_boxes_are_closed_along_their_edges() {
    let corner = |i: u8| Vec3::from_array([0, 1, 2].map(|axis| f32::from(i >> axis & 1) - 0.5));
    let sides = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]];
    let others = [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]];
    let positions = (0..8).map(corner).collect();
    let data = MeshData { positions, triangles: [sides, others].concat(), ..MeshData::default() };
    let mut random = Random::new(34);
    for mut shape in [AnyShape::from(Cuboid::default()), Mesh::from(data).into()] {
        shape.prepare().unwrap();
        for (map, size) in [0, 1].into_iter().flat_map(|map| SIZES.map(|size| (map, size))) {
            for (far, near) in [0.0, 1.0].into_iter().flat_map(|far| [0.0, 1e-7f32, 1e-6, 1e-3].map(|near| (far, near)))
            {
                let subject = Subject::new(&shape, map, size, far, &mut random);
                for _ in 0..200 {
                    let axis = random.below(3);
                    let mut target = random.point(0.5);
                    target[axis] = 0.5f32.copysign(target[axis]);
                    let other = (axis + 1 + random.below(2)) % 3;
                    target[other] = (0.5 - near * random.f32()).copysign(target[other]);
                    let ray = towards(subject.transform.point(random.point(0.4)), subject.transform.point(target));
                    let surface =
                        subject.intersect(&ray).unwrap_or_else(|| panic!("{map} {size} {far} {near}: {ray:?}"));
                    let (direction, _) = leave(&mut random, surface.normal, -1.0, 1e-4);
                    let next = subject.intersect(&surface.spawn_ray(direction, 0.0));
                    assert!(next.is_some(), "{map} {size} {far} {near}: {surface:?} {direction}");
                }
            }
        }
    }
}

/// A wall a few dozen ulps thick still has two sides.
#[test]
fn thin_walls_are_not_jumped_over() {
    let mut random = Random::new(35);
    for (far, map) in [0.0f32, 1.0, 100.0, 1e4].into_iter().flat_map(|far| [0, 1].map(|map| (far, map))) {
        for size in SIZES {
            let thin = 48.0 * f32::EPSILON * (1.0 + far);
            let wall = Cuboid { min: Vec3::new(-0.5, -0.5, 0.0), max: Vec3::new(0.5, 0.5, thin) };
            let subject = Subject::new(&wall.into(), map, size, far, &mut random);
            for _ in 0..300 {
                let target = Vec3::new(random.range(-0.4, 0.4), random.range(-0.4, 0.4), 0.0);
                let from =
                    target + Vec3::new(random.f32(), random.f32(), if random.below(2) == 0 { 1.0 } else { -1.0 });
                let ray = towards(subject.transform.point(from), subject.transform.point(target));
                let surface = subject.intersect(&ray).unwrap_or_else(|| panic!("{map} {size} {far}: {ray:?}"));
                let (inwards, _) = leave(&mut random, surface.normal, -1.0, 0.1);
                let next = subject.intersect(&surface.spawn_ray(inwards, 0.0));
                let fine = next.is_some_and(|next| next.normal.dot(inwards) > 0.0);
                assert!(fine, "{map} {size} {far}: {surface:?} {inwards} {next:?}");
            }
        }
    }
}
