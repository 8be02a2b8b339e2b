//! Building blocks of the procedural meshes.

use super::{Mesh, View};
use juggler_math::{Frame, Vec3, hash, portable, vec3};

/// A mesh under construction.
#[derive(Default)]
pub struct Builder {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

/// A placement on the ground: a rotation about the vertical axis, then a translation.
#[derive(Clone, Copy)]
pub struct Placement {
    pub origin: Vec3,
    pub turns: f32,
}

impl Placement {
    /// Transforms a point from local to world space.
    pub fn point(&self, p: Vec3) -> Vec3 {
        let (sin, cos) = portable::sin_cos_turns(self.turns);
        self.origin + vec3(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin)
    }
}

impl Builder {
    pub fn finish(self, view: View) -> Mesh {
        Mesh { positions: self.positions, triangles: self.triangles, view }
    }

    fn vertex(&mut self, position: Vec3) -> u32 {
        self.positions.push(position);
        self.positions.len() as u32 - 1
    }

    /// Appends a planar quad with four vertices in order around it: two triangles.
    pub fn quad(&mut self, corners: [Vec3; 4]) {
        let [a, b, c, d] = corners.map(|corner| self.vertex(corner));
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// Appends a patch of `columns` × `rows` quads; `at` gives the vertex at (column, row), both
    /// inclusive of their maximum. Vertices are shared within the patch only.
    pub fn patch(&mut self, columns: u32, rows: u32, at: impl Fn(u32, u32) -> Vec3) {
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            self.positions.extend((0..=columns).map(|column| at(column, row)));
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
                self.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }

    /// Appends a box of the given half edge lengths around a local center: twelve triangles.
    pub fn cuboid(&mut self, place: Placement, center: Vec3, half: Vec3) {
        let corner = |i: u32| {
            let sign = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            place.point(center + half * vec3(sign(0), sign(1), sign(2)))
        };
        let [a, b, c, d, e, f, g, h] = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| self.vertex(corner(i)));
        for [p, q, r, s] in [[a, c, d, b], [e, f, h, g], [a, b, f, e], [c, g, h, d], [a, e, g, c], [b, d, h, f]] {
            self.triangles.extend([[p, q, r], [p, r, s]]);
        }
    }

    /// Appends a straight rod with flat ends: `4 sides` triangles.
    pub fn rod(&mut self, from: Vec3, to: Vec3, radius: f32, sides: u32) {
        self.tube(&[from, to], sides, |_| radius);
        let ring = |end: u32| self.positions.len() as u32 - (2 - end) * sides;
        let (start, end) = (ring(0), ring(1));
        for (first, middle) in [(start, from), (end, to)] {
            let middle = self.vertex(middle);
            self.triangles.extend((0..sides).map(|i| [middle, first + i, first + (i + 1) % sides]));
        }
    }

    /// Appends an open tube along a polyline: `2 sides` triangles per piece. Each ring has `sides`
    /// vertices, perpendicular to the line and rotated as little as possible relative to the
    /// previous ring.
    pub fn tube(&mut self, line: &[Vec3], sides: u32, radius: impl Fn(usize) -> f32) {
        let first = self.positions.len() as u32;
        let mut across = Vec3::ZERO;
        for (i, &point) in line.iter().enumerate() {
            let (before, after) = (line[i.saturating_sub(1)], line[(i + 1).min(line.len() - 1)]);
            let along = (after - before).normalize_or(Vec3::Y);
            across = (across - along * across.dot(along)).normalize_or(Frame::around(along).tangent);
            let beside = along.cross(across);
            for side in 0..sides {
                let (sin, cos) = portable::sin_cos_turns(side as f32 / sides as f32);
                self.positions.push(point + (across * cos + beside * sin) * radius(i));
            }
        }
        for ring in 1..line.len() as u32 {
            for side in 0..sides {
                let (here, next) = (first + ring * sides, (side + 1) % sides);
                let [a, b, c, d] = [here - sides + side, here - sides + next, here + side, here + next];
                self.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }

    /// Appends a closed surface around `center`, the six faces of a cube with `n` × `n` quads each:
    /// `12 n²` triangles of similar size. `radius` gives the distance for each unit direction.
    pub fn cube_sphere(&mut self, center: Vec3, n: u32, radius: impl Fn(Vec3) -> f32) {
        let at = |i: u32| i as f32 / n as f32 * 2.0 - 1.0;
        for face in 0..6 {
            let side = if face < 3 { 1.0 } else { -1.0 };
            self.patch(n, n, |column, row| {
                let mut cube = [0.0; 3];
                cube[face % 3] = side;
                cube[(face + 1) % 3] = at(column);
                cube[(face + 2) % 3] = at(row);
                let direction = Vec3::from(cube).normalize();
                center + direction * radius(direction)
            });
        }
    }
}

/// Deterministic random numbers.
pub struct Random {
    seed: u32,
    count: u32,
}

impl Random {
    /// Constructs a generator whose sequence depends on `seed` only.
    pub fn new(seed: u32) -> Self {
        Self { seed, count: 0 }
    }

    pub fn unit(&mut self) -> f32 {
        self.count = self.count.wrapping_add(1);
        hash::unit_f32(hash::combine(self.seed, self.count))
    }

    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// A point in the cube [-1, 1)³.
    pub fn cube(&mut self) -> Vec3 {
        vec3(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0))
    }
}
