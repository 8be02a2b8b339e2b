//! From a point of the world to its place on the film: the way back from [`Projection::ray`].

use super::projection::Lens;
use super::{Projection, Shot};
use juggler_math::{DVec2, DVec3, Vec3};

/// A matrix that row vectors are multiplied by: `[x, y, z, 1]` times it, and the last of the four numbers divides the others.
pub type Matrix = [[f64; 4]; 4];

/// Where points of the world are on the film, as through the middle of the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finder {
    matrix: Matrix,
}

impl Finder {
    /// Of a projection; nothing where its film has no area.
    pub fn new(projection: &Projection) -> Option<Self> {
        let Projection { origin, corner, right, down, lens } = *projection;
        let [origin, corner, right, down] = [origin, corner, right, down].map(|v: Vec3| v.as_dvec3());
        let matrix = match lens {
            // origin + s · (corner + right · x + down · y) for a distance of s: all through one point.
            Lens::Pinhole | Lens::Disk { .. } => {
                let [x, y, depth] = inverse([right, down, corner])?;
                columns([(x, 0.0), (y, 0.0), (depth, -1.0), (depth, 0.0)], origin)
            }
            // origin + corner + right · x + down · y + forward · s.
            Lens::Parallel { forward } => {
                let [x, y, depth] = inverse([right, down, forward.as_dvec3()])?;
                columns([(x, 0.0), (y, 0.0), (depth, 0.0), (DVec3::ZERO, 1.0)], origin + corner)
            }
        };
        matrix.iter().flatten().all(|number| number.is_finite()).then_some(Self { matrix })
    }

    /// From the world to the film: pixels from the picture's top left corner, y down. The third number is 1 − 1 / distance along
    /// the view for a perspective, and that distance itself where all rays are parallel.
    pub fn matrix(&self) -> Matrix {
        self.matrix
    }

    /// Where a point is seen; nothing where it is behind the eye.
    #[inline]
    pub fn point(&self, point: Vec3) -> Option<DVec2> {
        self.divided(point.as_dvec3(), 1.0)
    }

    /// Where something without end in a direction is seen; nothing where it is behind the eye, or all rays are parallel.
    #[inline]
    pub fn direction(&self, direction: Vec3) -> Option<DVec2> {
        self.divided(direction.as_dvec3(), 0.0)
    }

    fn divided(&self, point: DVec3, last: f64) -> Option<DVec2> {
        let [a, b, c, d] = &self.matrix;
        let sum = |column: usize| point.x * a[column] + point.y * b[column] + point.z * c[column] + last * d[column];
        let distance = sum(3);
        (distance > 0.0).then(|| DVec2::new(sum(0) / distance, sum(1) / distance))
    }
}

impl Projection {
    /// From the world to the camera: x to the picture's right, y to its top, z into it (left-handed, as OpenEXR and RenderMan
    /// have it), in scene units.
    pub fn to_camera(&self) -> Matrix {
        let unit = |v: Vec3| v.as_dvec3().normalize_or_zero();
        let right = unit(self.right);
        let forward = unit(-self.down).cross(right).normalize_or_zero();
        let up = right.cross(forward);
        columns([(right, 0.0), (up, 0.0), (forward, 0.0), (DVec3::ZERO, 1.0)], self.origin.as_dvec3())
    }
}

impl Shot {
    /// Where points are seen at a time between 0 and 1.
    pub fn finder(&self, time: f32) -> Option<Finder> {
        Finder::new(&self.at(time))
    }
}

/// The matrix whose columns tell, of a point's way from `origin`, how much of it goes along each vector, and something more.
fn columns(columns: [(DVec3, f64); 4], origin: DVec3) -> Matrix {
    [
        columns.map(|(along, _)| along.x),
        columns.map(|(along, _)| along.y),
        columns.map(|(along, _)| along.z),
        columns.map(|(along, more)| more - along.dot(origin)),
    ]
}

/// What tells how much of each of three vectors another one is made of; nothing where they lie in a plane.
fn inverse([a, b, c]: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let volume = a.dot(b.cross(c));
    (volume != 0.0).then(|| [b.cross(c) / volume, c.cross(a) / volume, a.cross(b) / volume])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AnyCamera;
    use juggler_math::testing::Random;
    use juggler_math::{UVec2, Vec2};

    const SIZE: UVec2 = UVec2::new(80, 60);

    #[test]
    fn what_a_ray_meets_is_found_where_the_ray_came_from() {
        let mut random = Random::new(61);
        for camera in AnyCamera::examples() {
            let projection = camera.project(SIZE).unwrap();
            let finder = Finder::new(&projection).unwrap();
            for _ in 0..500 {
                let film = random.vec2() * SIZE.as_vec2();
                let ray = projection.ray(film, Vec2::splat(0.5), 0.0);
                let point = ray.at(0.5 + random.f32() * 20.0);
                let found = finder.point(point).unwrap();
                // A pixel is as small as a ten thousandth of the way to the origin here.
                assert!((found - film.as_dvec2()).length() < 0.02, "{camera:?}: {found} for {film}");
                let behind = finder.point(ray.origin - ray.direction * 3.0);
                match (&camera, finder.direction(ray.direction)) {
                    (AnyCamera::Orthographic(_), at_infinity) => assert_eq!(at_infinity, None),
                    (_, at_infinity) => {
                        assert!((at_infinity.unwrap() - film.as_dvec2()).length() < 0.02 && behind.is_none());
                    }
                }
            }
        }
    }

    #[test]
    fn camera_space_is_left_handed_with_the_view_along_z() {
        for camera in AnyCamera::examples() {
            let (axes, matrix) = (camera.axes().unwrap(), camera.project(SIZE).unwrap().to_camera());
            let point = axes.eye + axes.right * 2.0 + axes.up * 3.0 + axes.forward * 5.0;
            let row = [point.x, point.y, point.z, 1.0].map(f64::from);
            let found = [0, 1, 2, 3].map(|column| (0..4).map(|i| row[i] * matrix[i][column]).sum::<f64>());
            for (found, expected) in found.into_iter().zip([2.0, 3.0, 5.0, 1.0]) {
                assert!((found - expected).abs() < 1e-3, "{camera:?}: {found} for {expected}");
            }
        }
    }
}
