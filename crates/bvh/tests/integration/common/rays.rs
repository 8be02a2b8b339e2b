//! Adversarial rays: in planes, along axes, through vertices, from surfaces, with extreme direction
//! lengths.

use super::Random;
use super::mesh::Mesh;
use juggler_math::{Ray, Vec3};

/// Maximum number of rays per call: two groups of packets and a remainder.
const MOST: usize = 70;

/// Generator of rays around a mesh.
pub struct Aim<'a> {
    mesh: &'a Mesh,
    center: Vec3,
    /// Half the size of the mesh.
    radius: f32,
}

impl<'a> Aim<'a> {
    pub fn at(mesh: &'a Mesh) -> Self {
        let usable = || mesh.positions.iter().filter(|p| p.is_finite());
        let (low, high) = usable().fold((Vec3::MAX, Vec3::MIN), |(low, high), &p| (low.min(p), high.max(p)));
        let center = low * 0.5 + high * 0.5;
        Self { mesh, center, radius: (high * 0.5 - low * 0.5).max_element().max(f32::MIN_POSITIVE) }
    }

    fn somewhere(&self, random: &mut Random, reach: f32) -> Vec3 {
        self.center + random.point() * (self.radius * reach)
    }

    fn triangle(&self, random: &mut Random) -> [Vec3; 3] {
        self.mesh.corners(random.below(self.mesh.triangles.len()))
    }

    /// A vertex, the midpoint of an edge, a point on an edge, or an inner point of a triangle.
    fn on_a_triangle(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.triangle(random);
        match random.below(4) {
            0 => a,
            1 => b * 0.5 + c * 0.5,
            2 => a + (b - a) * random.unit(),
            _ => a + (b - a) * (random.unit() * 0.5) + (c - a) * (random.unit() * 0.5),
        }
    }

    /// A point whose coordinates mostly are those of random vertices: in planes, on edges and at
    /// corners of boxes.
    fn on_planes(&self, random: &mut Random) -> Vec3 {
        Vec3::from(std::array::from_fn(|axis| {
            let corner = self.triangle(random)[random.below(3)];
            if random.below(6) == 0 { self.somewhere(random, 1.2)[axis] } else { corner[axis] }
        }))
    }

    /// A ray of one of eight kinds.
    fn ray(&self, random: &mut Random, kind: usize) -> Ray {
        let origin = match kind {
            0 | 1 => self.somewhere(random, 2.0),
            2 => self.on_a_triangle(random),
            3..=5 => self.on_planes(random),
            6 => self.in_a_plane(random),
            _ => self.somewhere(random, 1.0),
        };
        let direction = match kind {
            1 | 2 => self.on_a_triangle(random) - origin,
            3 => axis_like(random),
            4 => self.on_planes(random) - origin,
            5 => self.on_a_triangle(random) - origin,
            6 => self.along(random),
            _ => random.direction() * [1.0, self.shortest(), 1e30, 1e-6, 1e6][random.below(5)],
        };
        Ray::new(origin, usable(direction))
    }

    /// Shortest direction for which distances stay below 2^100, the limit of single rays along the
    /// axes.
    fn shortest(&self) -> f32 {
        1e-30 * self.radius.max(1.0)
    }

    /// A point in the plane of a triangle, inside it or not.
    fn in_a_plane(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.triangle(random);
        let whole = |random: &mut Random| [-1.0, 0.0, 0.5, 1.0, 2.0][random.below(5)];
        a + (b - a) * whole(random) + (c - a) * whole(random)
    }

    /// A direction along an edge, or from a vertex to the midpoint of the opposite edge.
    fn along(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.triangle(random);
        [b - a, a - c, (b - a) * 0.5 + (c - a) * 0.5][random.below(3)]
    }

    /// Rays of one call, 1 to 70: of one kind or mixed, coherent or incoherent.
    pub fn call(&self, random: &mut Random) -> Vec<Ray> {
        let count = 1 + random.below(MOST);
        let kind = random.below(8);
        match random.below(4) {
            0 => (0..count).map(|_| self.ray(random, kind)).collect(),
            1 => (0..count)
                .map(|_| {
                    let kind = random.below(8);
                    self.ray(random, kind)
                })
                .collect(),
            2 => self.nearly_equal(random, kind, count),
            _ => self.through_an_eye(random, count),
        }
    }

    /// Nearly equal rays; with a spread of zero, equal ones.
    fn nearly_equal(&self, random: &mut Random, kind: usize, count: usize) -> Vec<Ray> {
        let first = self.ray(random, kind);
        let spread = [0.0, 1e-6, 1e-3, 0.1][random.below(4)];
        let size = first.direction.abs();
        (0..count)
            .map(|_| {
                // Relative perturbation keeps zeros and signs.
                let direction = first.direction + random.point() * size * spread;
                let aside = random.point() * (self.radius * spread * random.below(2) as f32);
                Ray { origin: first.origin + aside, direction: usable(direction), ..first }
            })
            .collect()
    }

    /// Rays from a point to the neighborhood of a target, as in a tile of camera rays.
    fn through_an_eye(&self, random: &mut Random, count: usize) -> Vec<Ray> {
        let (eye, target) = (self.somewhere(random, 3.0), self.on_a_triangle(random));
        let spread = self.radius * [1e-3, 0.05, 0.5][random.below(3)];
        (0..count).map(|_| Ray::new(eye, usable(target + random.point() * spread - eye))).collect()
    }
}

/// A direction with zeros of both signs and nearly zero components; never zero in all.
fn axis_like(random: &mut Random) -> Vec3 {
    let small = |random: &mut Random| [0.0, -0.0, 0.0, -0.0, 1e-40, -1e-42, 1e-30, -1e-30, 0.5][random.below(9)];
    let mut direction = Vec3::from(std::array::from_fn(|_| small(random)));
    direction[random.below(3)] = [1.0, -1.0, 2.0, -0.25, 1e-10, -1e10][random.below(6)];
    direction
}

/// Replaces directions that are too short or not finite.
fn usable(direction: Vec3) -> Vec3 {
    if direction.is_finite() && direction.abs().max_element() > 1e-37 { direction } else { -Vec3::X }
}

/// The same ray with another interval around its hit: from, up to or exactly at the hit, one ulp
/// before or behind, or empty.
pub fn cut(random: &mut Random, ray: &Ray, t: Option<f32>) -> Ray {
    let Some(t) = t else { return Ray { t_max: f32::NEG_INFINITY, ..*ray } };
    let ends = [
        (t, f32::INFINITY),
        (0.0, t),
        (t, t),
        (t.next_up(), f32::INFINITY),
        (0.0, t.next_down().max(0.0)),
        (t, t.next_down()),
        (t * 2.0, t * 0.5),
        (0.0, f32::NEG_INFINITY),
        (0.0, 0.0),
        (t * 0.999_999, t * 1.000_001),
    ];
    let (t_min, t_max) = ends[random.below(ends.len())];
    Ray { t_min, t_max, ..*ray }
}
