//! Affine maps with their inverses: from a shape's own (local, object) space to the world and back.

use crate::{Aabb, Ray};
use glam::{Mat3, Vec3};

/// An invertible affine map `p ↦ matrix · p + translation`, kept with its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    matrix: Mat3,
    translation: Vec3,
    inverse_matrix: Mat3,
}

impl Transform {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self { matrix: Mat3::IDENTITY, translation: Vec3::ZERO, inverse_matrix: Mat3::IDENTITY };

    /// From a linear part (columns: images of the axes) and a translation; `None` when it cannot be
    /// inverted or holds numbers that are not finite.
    pub fn new(matrix: Mat3, translation: Vec3) -> Option<Self> {
        let inverse_matrix = inverse(&matrix)?;
        (matrix.is_finite() && translation.is_finite()).then_some(Self { matrix, translation, inverse_matrix })
    }

    /// Moves by `by`.
    pub fn translation(by: Vec3) -> Self {
        Self { translation: by, ..Self::IDENTITY }
    }

    /// Scales along the axes; `None` when a factor is zero.
    pub fn scale(by: Vec3) -> Option<Self> {
        Self::new(Mat3::from_diagonal(by), Vec3::ZERO)
    }

    /// Turns by `radians` about the axis through the origin (Rodrigues 1840), right-handed; `None` for a
    /// zero axis.
    pub fn rotation(axis: Vec3, radians: f32) -> Option<Self> {
        let axis = axis.try_normalize()?;
        let (sin, cos) = crate::fun::sin_cos(radians);
        let turn = |v: Vec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
        Self::new(Mat3::from_cols(turn(Vec3::X), turn(Vec3::Y), turn(Vec3::Z)), Vec3::ZERO)
    }

    /// First `self`, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        Self {
            matrix: next.matrix * self.matrix,
            translation: next.matrix * self.translation + next.translation,
            inverse_matrix: self.inverse_matrix * next.inverse_matrix,
        }
    }

    /// The linear part; its columns are the images of the axes.
    pub fn matrix(&self) -> Mat3 {
        self.matrix
    }

    /// The linear part of the way back.
    pub fn inverse_matrix(&self) -> Mat3 {
        self.inverse_matrix
    }

    /// Where the local origin goes.
    pub fn origin(&self) -> Vec3 {
        self.translation
    }

    /// A point to the world.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.matrix * p + self.translation
    }

    /// A direction to the world; its length changes with the map.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.matrix * v
    }

    /// A normal to the world (inverse transpose), unit length. A mirrored map keeps the outside outside.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        (self.inverse_matrix.transpose() * n).normalize()
    }

    /// A world point into local space.
    pub fn point_to_local(&self, p: Vec3) -> Vec3 {
        self.inverse_matrix * (p - self.translation)
    }

    /// A world direction into local space.
    pub fn vector_to_local(&self, v: Vec3) -> Vec3 {
        self.inverse_matrix * v
    }

    /// A world ray into local space; distances `t` stay the same, so the direction is not unit any more.
    pub fn ray_to_local(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point_to_local(ray.origin), direction: self.vector_to_local(ray.direction), ..*ray }
    }

    /// The world box around a local box (Arvo 1990); an infinite box stays infinite.
    pub fn aabb(&self, local: &Aabb) -> Aabb {
        if !local.is_finite() {
            return if local.is_empty() { Aabb::EMPTY } else { Aabb::INFINITE };
        }
        Aabb::from_points(local.corners().map(|c| self.point(c)))
    }

    /// The factor of a map that only turns, moves and scales evenly; `None` for any other.
    pub fn uniform_scale(&self) -> Option<f32> {
        let [x, y, z] = [self.matrix.x_axis, self.matrix.y_axis, self.matrix.z_axis];
        let squared = x.length_squared();
        let tolerance = 1e-6 * squared;
        let even =
            (y.length_squared() - squared).abs() <= tolerance && (z.length_squared() - squared).abs() <= tolerance;
        let square = x.dot(y).abs() <= tolerance && y.dot(z).abs() <= tolerance && z.dot(x).abs() <= tolerance;
        (even && square).then(|| squared.sqrt())
    }

    /// How much the map can lengthen a vector, at most (Frobenius norm, an upper bound).
    pub fn max_stretch(&self) -> f32 {
        let [x, y, z] = [self.matrix.x_axis, self.matrix.y_axis, self.matrix.z_axis];
        (x.length_squared() + y.length_squared() + z.length_squared()).sqrt()
    }
}

/// Inverse by cofactors in f64: a matrix of small entries (a model in millimetres) is as invertible as one
/// of large ones. `None` when singular to working precision.
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
