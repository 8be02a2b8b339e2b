//! Invertible affine transforms between object (local) space and world space.

use crate::{Aabb, Ray};
use glam::{Mat3, Vec3};

/// An invertible affine transform `p ↦ matrix · p + translation`, stored with its inverse matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    matrix: Mat3,
    translation: Vec3,
    inverse_matrix: Mat3,
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { matrix: Mat3::IDENTITY, translation: Vec3::ZERO, inverse_matrix: Mat3::IDENTITY };

    /// Constructs a transform from a matrix (columns: images of the axes) and a translation; `None`
    /// if the matrix is singular or an entry is not finite.
    pub fn new(matrix: Mat3, translation: Vec3) -> Option<Self> {
        let inverse_matrix = inverse(&matrix)?;
        (matrix.is_finite() && translation.is_finite()).then_some(Self { matrix, translation, inverse_matrix })
    }

    /// Translation by `by`.
    pub fn translation(by: Vec3) -> Self {
        Self { translation: by, ..Self::IDENTITY }
    }

    /// Scaling along the axes; `None` if it is not invertible, as for a factor of zero.
    pub fn scale(by: Vec3) -> Option<Self> {
        Self::new(Mat3::from_diagonal(by), Vec3::ZERO)
    }

    /// Right-handed rotation by `radians` about an axis through the origin (Rodrigues 1840); `None`
    /// for a zero axis.
    pub fn rotation(axis: Vec3, radians: f32) -> Option<Self> {
        let axis = axis.try_normalize()?;
        let (sin, cos) = crate::portable::sin_cos(radians);
        let rotate = |v: Vec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
        Self::new(Mat3::from_cols(rotate(Vec3::X), rotate(Vec3::Y), rotate(Vec3::Z)), Vec3::ZERO)
    }

    /// The same matrix with another translation.
    pub fn with_translation(&self, translation: Vec3) -> Self {
        Self { translation, ..*self }
    }

    /// Whether all numbers have the same bits.
    pub fn has_bits_of(&self, other: &Self) -> bool {
        let bits = |matrix: &Mat3| matrix.to_cols_array().map(f32::to_bits);
        bits(&self.matrix) == bits(&other.matrix)
            && bits(&self.inverse_matrix) == bits(&other.inverse_matrix)
            && self.translation.to_array().map(f32::to_bits) == other.translation.to_array().map(f32::to_bits)
    }

    /// Composition: applies `self` first, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        Self {
            matrix: next.matrix * self.matrix,
            translation: next.matrix * self.translation + next.translation,
            inverse_matrix: self.inverse_matrix * next.inverse_matrix,
        }
    }

    /// Linear part; its columns are the images of the axes.
    pub fn matrix(&self) -> Mat3 {
        self.matrix
    }

    /// Linear part of the inverse transform.
    pub fn inverse_matrix(&self) -> Mat3 {
        self.inverse_matrix
    }

    /// World position of the local origin.
    pub fn origin(&self) -> Vec3 {
        self.translation
    }

    /// Transforms a point to world space.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.matrix * p + self.translation
    }

    /// Transforms a vector to world space; its length changes with the transform.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.matrix * v
    }

    /// Transforms a normal to world space by the inverse transpose and normalizes it. Under a
    /// reflection it still points to the outside.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        (self.inverse_matrix.transpose() * n).normalize()
    }

    /// Transforms a point from world to local space.
    pub fn point_to_local(&self, p: Vec3) -> Vec3 {
        self.inverse_matrix * (p - self.translation)
    }

    /// Transforms a vector from world to local space.
    pub fn vector_to_local(&self, v: Vec3) -> Vec3 {
        self.inverse_matrix * v
    }

    /// Transforms a ray from world to local space. Parameters `t` keep their meaning, so the local
    /// direction is not normalized.
    pub fn ray_to_local(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point_to_local(ray.origin), direction: self.vector_to_local(ray.direction), ..*ray }
    }

    /// World-space bounds of a local box: the bounds of its eight corners. An infinite box stays
    /// infinite.
    pub fn aabb(&self, local: &Aabb) -> Aabb {
        if !local.is_finite() {
            return if local.is_empty() { Aabb::EMPTY } else { Aabb::INFINITE };
        }
        Aabb::from_points(local.corners().map(|c| self.point(c)))
    }

    /// Scale factor of a similarity (rotation or reflection, translation, uniform scale); `None`
    /// for any other transform.
    pub fn uniform_scale(&self) -> Option<f32> {
        let [x, y, z] = [self.matrix.x_axis, self.matrix.y_axis, self.matrix.z_axis];
        let squared = x.length_squared();
        // Products of single-precision rotations deviate by a few ulps.
        let tolerance = 1e-5 * squared;
        let even =
            (y.length_squared() - squared).abs() <= tolerance && (z.length_squared() - squared).abs() <= tolerance;
        let square = x.dot(y).abs() <= tolerance && y.dot(z).abs() <= tolerance && z.dot(x).abs() <= tolerance;
        (even && square).then(|| squared.sqrt())
    }

    /// Upper bound on the factor by which the transform lengthens a vector (Frobenius norm).
    pub fn max_scale(&self) -> f32 {
        let [x, y, z] = [self.matrix.x_axis, self.matrix.y_axis, self.matrix.z_axis];
        (x.length_squared() + y.length_squared() + z.length_squared()).sqrt()
    }
}

/// Inverse by cofactors in double precision, with a tolerance relative to the column lengths, so
/// that a matrix of small entries (a model in millimeters) is as invertible as one of large
/// entries. `None` if singular to working precision.
fn inverse(m: &Mat3) -> Option<Mat3> {
    let d = m.as_dmat3();
    let [x, y, z] = [d.x_axis, d.y_axis, d.z_axis];
    let rows = [y.cross(z), z.cross(x), x.cross(y)];
    let determinant = x.dot(rows[0]);
    let size = x.length() * y.length() * z.length();
    if !determinant.is_finite() || determinant.abs() <= 1e-12 * size {
        return None;
    }
    let inverse = glam::DMat3::from_cols(rows[0], rows[1], rows[2]).transpose() * (1.0 / determinant);
    let inverse = inverse.as_mat3();
    inverse.is_finite().then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, close, close3};

    fn samples() -> Vec<Transform> {
        let mut random = Random::new(91);
        let mirror = Transform::scale(Vec3::new(-1.0, 1.0, 1.0)).unwrap();
        let tiny = Transform::scale(Vec3::splat(1e-4)).unwrap();
        let uneven = Transform::scale(Vec3::new(1e-4, 1.0, 30.0)).unwrap();
        let any: Vec<Transform> = (0..50).map(|_| random.transform()).collect();
        any.iter().flat_map(|t| [*t, t.then(&mirror), tiny.then(t), uneven.then(t)]).collect()
    }

    #[test]
    fn local_and_world_transforms_are_inverse() {
        let mut random = Random::new(92);
        for t in samples() {
            for _ in 0..20 {
                let p = random.point(3.0);
                let stretch_back = t.inverse_matrix().to_cols_array().iter().map(|v| v * v).sum::<f32>().sqrt();
                let condition = t.max_scale() * stretch_back;
                assert!(close3(t.vector_to_local(t.vector(p)), p, 4e-7 * condition), "{t:?}");
                // A point also carries the rounding error of the translation, which a small scale
                // magnifies.
                let tolerance = 4e-7 * (condition + t.origin().length() * stretch_back);
                assert!(close3(t.point_to_local(t.point(p)), p, tolerance), "{t:?}");
            }
        }
    }

    #[test]
    fn rays_keep_their_distances() {
        let mut random = Random::new(93);
        for t in (0..200).map(|_| random.transform()).collect::<Vec<_>>() {
            let ray = Ray { t_min: 0.5, t_max: 9.0, time: 0.25, ..random.ray(5.0) };
            let local = t.ray_to_local(&ray);
            assert!(close3(t.point(local.at(2.5)), ray.at(2.5), 1e-4));
            assert_eq!((local.t_min, local.t_max, local.time), (0.5, 9.0, 0.25));
        }
    }

    #[test]
    fn normals_stay_perpendicular_and_outside() {
        let mut random = Random::new(94);
        for t in samples() {
            let (n, v) = (random.unit_vector(), random.unit_vector());
            let (tangent, world) = (t.vector(n.cross(v)).normalize(), t.normal(n));
            assert!(close(world.length(), 1.0, 1e-6) && world.dot(tangent).abs() < 1e-3, "{t:?}");
            assert!(world.dot(t.vector(n)) > 0.0, "{t:?}");
        }
    }

    #[test]
    fn then_composes_transforms_in_order() {
        let mut random = Random::new(95);
        for _ in 0..200 {
            let (a, b, p) = (random.transform(), random.transform(), random.point(3.0));
            assert!(close3(a.then(&b).point(p), b.point(a.point(p)), 1e-5));
            assert!(close3(a.then(&b).point_to_local(p), a.point_to_local(b.point_to_local(p)), 1e-3));
        }
    }

    #[test]
    fn rotations_are_right_handed_and_rigid() {
        let quarter = Transform::rotation(Vec3::Y * 3.0, std::f32::consts::FRAC_PI_2).unwrap();
        assert!(close3(quarter.point(Vec3::Z), Vec3::X, 1e-6) && close3(quarter.point(Vec3::X), -Vec3::Z, 1e-6));
        let mut random = Random::new(96);
        for _ in 0..1000 {
            let rotation = random.rotation().then(&random.rotation());
            assert!(close(rotation.uniform_scale().expect("a rotation is even"), 1.0, 1e-6));
        }
    }

    #[test]
    fn uniform_scales_are_recognized() {
        let mut random = Random::new(97);
        for factor in [1e-4, -0.5, 1.0, 700.0] {
            let t = Transform::scale(Vec3::splat(factor)).unwrap().then(&random.rotation());
            assert!(close(t.uniform_scale().unwrap() / factor.abs(), 1.0, 1e-5));
        }
        assert_eq!(Transform::scale(Vec3::new(1.0, 1.0, 1.001)).unwrap().uniform_scale(), None);
        for t in samples() {
            let v = random.unit_vector();
            assert!(t.vector(v).length() <= t.max_scale() * 1.000_001);
        }
    }

    #[test]
    fn boxes_hold_the_images_of_their_points() {
        let mut random = Random::new(98);
        let local = Aabb { min: Vec3::new(-1.0, 0.0, 2.0), max: Vec3::new(1.0, 0.5, 2.5) };
        for t in samples() {
            let inside = local.min + local.extent() * random.vec3();
            assert!(t.aabb(&local).grown(1e-5).contains(t.point(inside)));
        }
        assert_eq!(random.transform().aabb(&Aabb::INFINITE), Aabb::INFINITE);
        assert_eq!(random.transform().aabb(&Aabb::EMPTY), Aabb::EMPTY);
    }

    #[test]
    fn singular_transforms_are_rejected() {
        let flat = Mat3::from_cols(Vec3::X, Vec3::Y, Vec3::X + Vec3::Y);
        assert_eq!(Transform::new(flat, Vec3::ZERO), None);
        assert_eq!(Transform::scale(Vec3::new(1.0, 0.0, 1.0)), None);
        assert_eq!(Transform::scale(Vec3::splat(1e-39)), None);
        assert_eq!(Transform::scale(Vec3::new(f32::NAN, 1.0, 1.0)), None);
        assert_eq!(Transform::new(Mat3::IDENTITY, Vec3::splat(f32::INFINITY)), None);
        assert_eq!(Transform::rotation(Vec3::ZERO, 1.0), None);
        assert!(Transform::scale(Vec3::splat(1e-12)).is_some());
    }
}
