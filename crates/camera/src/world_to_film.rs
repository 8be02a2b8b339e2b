//! Transform from world space to the film: the inverse of [`Projection::ray`].

use super::projection::Lens;
use super::{Projection, ShutterCamera};
use juggler_math::{DVec2, DVec3, Vec3};

/// 4 × 4 matrix for row vectors: `[x, y, z, 1]` times the matrix; the last component divides the
/// others.
pub type Matrix = [[f64; 4]; 4];

/// Transform from world space to the film, through the center of the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldToFilm {
    matrix: Matrix,
}

impl WorldToFilm {
    /// Creates the transform of a projection; `None` if the film has no area.
    pub fn new(projection: &Projection) -> Option<Self> {
        let Projection { origin, corner, right, down, lens } = *projection;
        let [origin, corner, right, down] = [origin, corner, right, down].map(|v: Vec3| v.as_dvec3());
        let matrix = match lens {
            // A pinhole maps film (x, y) to origin + s · (corner + right · x + down · y), at depth
            // s.
            Lens::Pinhole | Lens::Disk { .. } => {
                let [x, y, depth] = inverse_rows([right, down, corner])?;
                affine_columns([(x, 0.0), (y, 0.0), (depth, -1.0), (depth, 0.0)], origin)
            }
            // A parallel projection maps film (x, y) to origin + corner + right · x + down · y +
            // forward · s.
            Lens::Parallel { forward } => {
                let [x, y, depth] = inverse_rows([right, down, forward.as_dvec3()])?;
                affine_columns([(x, 0.0), (y, 0.0), (depth, 0.0), (DVec3::ZERO, 1.0)], origin + corner)
            }
        };
        matrix.iter().flatten().all(|number| number.is_finite()).then_some(Self { matrix })
    }

    /// Matrix from world space to the film, in pixels from the picture's top left corner with y
    /// down. The third component is 1 − 1 / depth for a perspective projection and the depth for a
    /// parallel one, with the depth along the view direction.
    pub fn matrix(&self) -> Matrix {
        self.matrix
    }

    /// Film position of a point in pixels; `None` if the point is behind the eye.
    #[inline]
    pub fn point(&self, point: Vec3) -> Option<DVec2> {
        self.project(point.as_dvec3(), 1.0)
    }

    /// Film position of an infinitely distant point in a direction, in pixels. `None` if it is
    /// behind the eye or if the projection is parallel.
    #[inline]
    pub fn direction(&self, direction: Vec3) -> Option<DVec2> {
        self.project(direction.as_dvec3(), 0.0)
    }

    fn project(&self, point: DVec3, last: f64) -> Option<DVec2> {
        let [a, b, c, d] = &self.matrix;
        let sum = |column: usize| point.x * a[column] + point.y * b[column] + point.z * c[column] + last * d[column];
        let distance = sum(3);
        (distance > 0.0).then(|| DVec2::new(sum(0) / distance, sum(1) / distance))
    }
}

impl Projection {
    /// Matrix from world space to camera space in scene units: x to the picture's right, y to its
    /// top, z into the picture (left-handed, as in OpenEXR and RenderMan).
    pub fn to_camera(&self) -> Matrix {
        let unit = |v: Vec3| v.as_dvec3().normalize_or_zero();
        let right = unit(self.right);
        let forward = unit(-self.down).cross(right).normalize_or_zero();
        let up = right.cross(forward);
        affine_columns([(right, 0.0), (up, 0.0), (forward, 0.0), (DVec3::ZERO, 1.0)], self.origin.as_dvec3())
    }
}

impl ShutterCamera {
    /// Transform from world space to the film at a time between 0 and 1.
    pub fn world_to_film(&self, time: f32) -> Option<WorldToFilm> {
        WorldToFilm::new(&self.projection_at(time))
    }
}

/// Matrix of affine functions of a point p: column i is the function v·(p − origin) + w of the pair
/// (v, w) in `columns[i]`.
fn affine_columns(columns: [(DVec3, f64); 4], origin: DVec3) -> Matrix {
    [
        columns.map(|(along, _)| along.x),
        columns.map(|(along, _)| along.y),
        columns.map(|(along, _)| along.z),
        columns.map(|(along, more)| more - along.dot(origin)),
    ]
}

/// Rows of the inverse of the matrix with the columns a, b and c; `None` if it is singular.
fn inverse_rows([a, b, c]: [DVec3; 3]) -> Option<[DVec3; 3]> {
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
    fn world_to_film_inverts_camera_rays() {
        let mut random = Random::new(61);
        for camera in AnyCamera::examples() {
            let projection = camera.projection(SIZE).unwrap();
            let world_to_film = WorldToFilm::new(&projection).unwrap();
            for _ in 0..500 {
                let film = random.vec2() * SIZE.as_vec2();
                let ray = projection.ray(film, Vec2::splat(0.5), 0.0);
                let point = ray.at(0.5 + random.f32() * 20.0);
                let found = world_to_film.point(point).unwrap();
                // A pixel is about 1e-4 of the distance to the origin here.
                assert!((found - film.as_dvec2()).length() < 0.02, "{camera:?}: {found} for {film}");
                let behind = world_to_film.point(ray.origin - ray.direction * 3.0);
                match (&camera, world_to_film.direction(ray.direction)) {
                    (AnyCamera::Orthographic(_), at_infinity) => assert_eq!(at_infinity, None),
                    (_, at_infinity) => {
                        assert!((at_infinity.unwrap() - film.as_dvec2()).length() < 0.02 && behind.is_none());
                    }
                }
            }
        }
    }

    /// The depth along the view direction is the third component of camera space.
    #[test]
    fn the_view_direction_is_the_forward_axis_of_each_camera() {
        for camera in AnyCamera::examples() {
            let (axes, projection) = (camera.axes().unwrap(), camera.projection(SIZE).unwrap());
            assert!(projection.view_direction().abs_diff_eq(axes.forward, 1e-6), "{camera:?}");
        }
    }

    #[test]
    fn camera_space_is_left_handed_with_the_view_along_z() {
        for camera in AnyCamera::examples() {
            let (axes, matrix) = (camera.axes().unwrap(), camera.projection(SIZE).unwrap().to_camera());
            let point = axes.eye + axes.right * 2.0 + axes.up * 3.0 + axes.forward * 5.0;
            let row = [point.x, point.y, point.z, 1.0].map(f64::from);
            let found = [0, 1, 2, 3].map(|column| (0..4).map(|i| row[i] * matrix[i][column]).sum::<f64>());
            for (found, expected) in found.into_iter().zip([2.0, 3.0, 5.0, 1.0]) {
                assert!((found - expected).abs() < 1e-3, "{camera:?}: {found} for {expected}");
            }
        }
    }
}
