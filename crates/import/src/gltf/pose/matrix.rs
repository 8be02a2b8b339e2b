//! Affine maps of nodes and skins: checks of a file's matrices, inverses, and the map of normals.
//!
//! [`DAffine3`] has three columns and a translation in double precision; its products are sums in
//! one fixed order.

use glam::{DAffine3, DMat3, DVec3};

/// Largest deviation of the last row from 0 0 0 1. Inverse bind matrices that a program inverted in
/// single precision deviate by some ulps.
const LAST_ROW_TOLERANCE: f64 = 1e-5;

/// Relative determinant below which a matrix counts as singular.
const SINGULAR: f64 = 1e-12;

/// Error of a 4×4 matrix in a file.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixError {
    /// An element is infinite or not a number.
    #[error("element {index} of the matrix is {value}; all 16 must be finite")]
    NotFinite {
        /// Index of the element, column-major.
        index: usize,
        /// The element.
        value: f64,
    },
    /// The matrix is not affine.
    #[error("the last row of the matrix is {row:?}; it must be [0, 0, 0, 1]")]
    NotAffine {
        /// The last row.
        row: [f64; 4],
    },
}

/// Affine map of a 4×4 matrix in column-major order, whose last row must be 0 0 0 1 to within
/// 1e-5. Shear is kept.
pub fn affine_from_columns(columns: &[f64; 16]) -> Result<DAffine3, MatrixError> {
    if let Some((index, value)) = columns.iter().copied().enumerate().find(|(_, value)| !value.is_finite()) {
        return Err(MatrixError::NotFinite { index, value });
    }
    let [x0, x1, x2, x3, y0, y1, y2, y3, z0, z1, z2, z3, t0, t1, t2, t3] = *columns;
    let row = [x3, y3, z3, t3];
    if row.iter().zip([0.0, 0.0, 0.0, 1.0]).any(|(found, expected)| (found - expected).abs() > LAST_ROW_TOLERANCE) {
        return Err(MatrixError::NotAffine { row });
    }
    Ok(DAffine3::from_cols(
        DVec3::new(x0, x1, x2),
        DVec3::new(y0, y1, y2),
        DVec3::new(z0, z1, z2),
        DVec3::new(t0, t1, t2),
    ))
}

/// Whether a matrix has an inverse. The test is relative to the lengths of the columns, so small
/// scale factors are fine and a scale factor of 0 is not. False if an element is not finite.
pub fn is_invertible(linear: &DMat3) -> bool {
    match [linear.x_axis, linear.y_axis, linear.z_axis].map(unit) {
        [Some(x), Some(y), Some(z)] => x.dot(y.cross(z)).abs() > SINGULAR,
        _ => false,
    }
}

/// The vector at unit length; `None` if it is zero or not finite. Neither large nor small elements
/// overflow.
fn unit(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    (vector.is_finite() && largest > 0.0).then(|| (vector / largest).normalize())
}

/// Inverse of an affine map; `None` if the map is not [invertible](is_invertible) or the inverse is
/// not finite.
pub fn inverse(map: &DAffine3) -> Option<DAffine3> {
    if !is_invertible(&map.matrix3) {
        return None;
    }
    let linear = map.matrix3.try_inverse()?;
    let inverse = DAffine3::from_mat3_translation(linear, -(linear * map.translation));
    inverse.is_finite().then_some(inverse)
}

/// Positive multiple of the inverse transpose, which maps normals and keeps the outside outside
/// under reflections. It consists of cofactors, so it exists for singular matrices too. Zero if an
/// element is not finite.
pub fn normal_matrix(linear: &DMat3) -> DMat3 {
    let largest = linear.to_cols_array().iter().fold(0.0_f64, |largest, element| largest.max(element.abs()));
    if !linear.is_finite() || largest <= 0.0 {
        return DMat3::ZERO;
    }
    // Divide first, so that the products do not overflow.
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis].map(|column| column / largest);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if x.dot(cofactors.x_axis) < 0.0 { -cofactors } else { cofactors }
}

#[cfg(test)]
mod tests {
    use super::super::testing::random_affine;
    use super::*;
    use juggler_math::testing::Random;

    const IDENTITY: [f64; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

    #[test]
    fn columns_become_axes_and_translation() {
        let mut columns = IDENTITY;
        for (i, element) in [(0, 2.0), (1, 3.0), (4, 4.0), (10, 5.0), (12, 6.0), (13, 7.0), (14, 8.0)] {
            columns[i] = element;
        }
        let map = affine_from_columns(&columns).unwrap();
        assert_eq!(map.transform_point3(DVec3::X), DVec3::new(8.0, 10.0, 8.0));
        assert_eq!(map.transform_vector3(DVec3::Y), DVec3::new(4.0, 1.0, 0.0));
        assert_eq!(map.transform_vector3(DVec3::Z), DVec3::new(0.0, 0.0, 5.0));
    }

    #[test]
    fn projections_and_numbers_that_are_not_finite_are_errors() {
        for (index, value) in [(3, 0.1), (7, -1e-3), (11, 1.0), (15, 0.0), (15, 2.0)] {
            let mut columns = IDENTITY;
            columns[index] = value;
            let error = affine_from_columns(&columns).unwrap_err();
            assert!(matches!(error, MatrixError::NotAffine { .. }), "{index} {value}: {error}");
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut columns = IDENTITY;
            columns[5] = value;
            let error = affine_from_columns(&columns).unwrap_err();
            assert!(error.to_string().starts_with("element 5 of the matrix is "), "{error}");
        }
        let mut rounded = IDENTITY;
        (rounded[3], rounded[15]) = (1e-7, 0.999_999_9);
        assert_eq!(affine_from_columns(&rounded).unwrap(), DAffine3::IDENTITY);
    }

    #[test]
    fn inverses_undo_their_maps() {
        let mut random = Random::new(11);
        for _ in 0..200 {
            let map = random_affine(&mut random);
            for scale in [1e-100, 1e-6, 1.0, 1e6] {
                let map = DAffine3::from_scale(DVec3::splat(scale)) * map;
                let both = inverse(&map).unwrap() * map;
                assert!(both.abs_diff_eq(DAffine3::IDENTITY, 1e-10), "{both}");
            }
        }
    }

    #[test]
    fn singular_matrices_have_no_inverse() {
        let flat = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::X + DVec3::Y);
        let scales = [DVec3::new(1.0, 0.0, 1.0), DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 1.0)];
        for singular in scales.map(DMat3::from_diagonal).iter().chain([&flat]) {
            assert!(!is_invertible(singular), "{singular}");
            assert_eq!(inverse(&DAffine3::from_mat3(*singular)), None);
        }
        assert!(!is_invertible(&DMat3::from_diagonal(DVec3::splat(f64::INFINITY))));
        assert!(is_invertible(&DMat3::from_diagonal(DVec3::new(1e-200, 1.0, 1e200))));
    }

    #[test]
    fn normals_map_by_the_inverse_transpose() {
        let mut random = Random::new(12);
        for _ in 0..200 {
            let linear = random_affine(&mut random).matrix3;
            let n = random.unit_vector().as_dvec3();
            let expected = (linear.inverse().transpose() * n).normalize();
            for scale in [1e-180, 1.0, 1e150] {
                let found = (normal_matrix(&(linear * scale)) * n).normalize();
                assert!(found.abs_diff_eq(expected, 1e-9), "{found} {expected}");
            }
        }
        let flat = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(normal_matrix(&flat) * DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.0, 0.8));
        let infinite = DMat3::from_diagonal(DVec3::splat(f64::INFINITY));
        assert!(normal_matrix(&infinite) == DMat3::ZERO && normal_matrix(&DMat3::ZERO) == DMat3::ZERO);
    }
}
