//! Rays that look for trouble: in planes, along axes, through corners, from surfaces, of extreme length.

use super::Random;
use super::mesh::Mesh;
use juggler_math::{Ray, Vec3};

/// Most rays of a call: two groups of packets and an odd rest.
const MOST: usize = 70;

/// Rays of a mesh's box and corners.
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

    /// A corner, the middle of an edge, a point of an edge or one within.
    fn on_a_triangle(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.triangle(random);
        match random.below(4) {
            0 => a,
            1 => b * 0.5 + c * 0.5,
            2 => a + (b - a) * random.unit(),
            _ => a + (b - a) * (random.unit() * 0.5) + (c - a) * (random.unit() * 0.5),
        }
    }

    /// Each coordinate that of some corner: in planes of boxes, on their edges and corners.
    fn on_planes(&self, random: &mut Random) -> Vec3 {
        Vec3::from(std::array::from_fn(|axis| {
            let corner = self.triangle(random)[random.below(3)];
            if random.below(6) == 0 { self.somewhere(random, 1.2)[axis] } else { corner[axis] }
        }))
    }

    /// A ray of any kind.
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

    /// Distances stay below 2^100, as far as single rays along the axes see.
    fn shortest(&self) -> f32 {
        1e-30 * self.radius.max(1.0)
    }

    /// In the plane of a triangle, not always in it.
    fn in_a_plane(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.triangle(random);
        let whole = |random: &mut Random| [-1.0, 0.0, 0.5, 1.0, 2.0][random.below(5)];
        a + (b - a) * whole(random) + (c - a) * whole(random)
    }

    /// Along an edge or from a corner to the middle of an edge.
    fn along(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.triangle(random);
        [b - a, a - c, (b - a) * 0.5 + (c - a) * 0.5][random.below(3)]
    }

    /// The rays of one call: of one kind or mixed, from one place or anywhere, 1 to 70.
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
            2 => self.neighbours(random, kind, count),
            _ => self.through_an_eye(random, count),
        }
    }

    /// Almost one ray; some of them exactly.
    fn neighbours(&self, random: &mut Random, kind: usize, count: usize) -> Vec<Ray> {
        let first = self.ray(random, kind);
        let spread = [0.0, 1e-6, 1e-3, 0.1][random.below(4)];
        let size = first.direction.abs();
        (0..count)
            .map(|_| {
                // Zeros stay zeros, signs stay.
                let direction = first.direction + random.point() * size * spread;
                let aside = random.point() * (self.radius * spread * random.below(2) as f32);
                Ray { origin: first.origin + aside, direction: usable(direction), ..first }
            })
            .collect()
    }

    /// From an eye to what lies near a point: a camera's tile.
    fn through_an_eye(&self, random: &mut Random, count: usize) -> Vec<Ray> {
        let (eye, target) = (self.somewhere(random, 3.0), self.on_a_triangle(random));
        let spread = self.radius * [1e-3, 0.05, 0.5][random.below(3)];
        (0..count).map(|_| Ray::new(eye, usable(target + random.point() * spread - eye))).collect()
    }
}

/// Zeros of both signs and components that are almost zero; never along no axis.
fn axis_like(random: &mut Random) -> Vec3 {
    let small = |random: &mut Random| [0.0, -0.0, 0.0, -0.0, 1e-40, -1e-42, 1e-30, -1e-30, 0.5][random.below(9)];
    let mut direction = Vec3::from(std::array::from_fn(|_| small(random)));
    direction[random.below(3)] = [1.0, -1.0, 2.0, -0.25, 1e-10, -1e10][random.below(6)];
    direction
}

/// Rays must have a direction.
fn usable(direction: Vec3) -> Vec3 {
    if direction.is_finite() && direction.abs().max_element() > 1e-37 { direction } else { -Vec3::X }
}

/// The same rays with other ends, now that it is known what they hit: just there, just before, just behind, empty.
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
