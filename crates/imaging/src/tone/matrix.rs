//! Matrices between color spaces.

use juggler_math::Rgb;

/// 3 × 3 matrix, stored by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix(pub(crate) [[f64; 3]; 3]);

impl Matrix {
    /// Diagonal matrix.
    pub fn diagonal([x, y, z]: [f64; 3]) -> Self {
        Self([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
    }

    /// Matrix product `self` · `first`, which applies `first` first.
    pub fn times(&self, first: &Self) -> Self {
        let columns = first.transposed().0.map(|column| self.apply(column));
        Self(columns).transposed()
    }

    /// Transposed matrix.
    pub fn transposed(&self) -> Self {
        let [a, b, c] = self.0;
        Self([[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]])
    }

    /// Inverse by cofactors; not finite if the matrix is singular.
    pub fn inverse(&self) -> Self {
        let [a, b, c] = self.0;
        let cross = |p: [f64; 3], q: [f64; 3]| {
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
        };
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, columns[0]);
        Self(columns.map(|column| column.map(|v| v / determinant))).transposed()
    }

    /// Product with a column vector.
    pub fn apply(&self, column: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| dot(row, column))
    }

    /// Product with a color.
    pub fn color(&self, color: Rgb) -> Rgb {
        Rgb::from(self.apply(color.to_array().map(f64::from)).map(|v| v as f32))
    }

    /// Whether all elements are finite.
    pub fn is_finite(&self) -> bool {
        self.0.iter().flatten().all(|v| v.is_finite())
    }
}

/// Dot product.
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrix_inverse_inverts() {
        let matrix = Matrix([[2.0, 0.5, -1.0], [0.25, 3.0, 0.0], [1.0, -2.0, 4.0]]);
        for product in [matrix.times(&matrix.inverse()), matrix.inverse().times(&matrix)] {
            let one = Matrix::diagonal([1.0; 3]);
            let error = product.0.iter().flatten().zip(one.0.iter().flatten()).map(|(a, b)| (a - b).abs());
            assert!(error.fold(0.0, f64::max) < 1e-14, "{product:?}");
        }
        assert!(!Matrix([[1.0; 3]; 3]).inverse().is_finite());
    }

    #[test]
    fn matrix_products_apply_from_right_to_left() {
        let (first, then) =
            (Matrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), Matrix::diagonal([2.0, 3.0, 5.0]));
        assert_eq!(then.times(&first).apply([1.0, 10.0, 100.0]), [20.0, 3.0, 500.0]);
    }
}
