//! Validation of descriptions: every number is finite, and its square fits a float.

use super::InvalidShape;
use juggler_math::{Vec3, range};

/// Largest length or coordinate; its reciprocal is the smallest radius or edge.
pub const MAX_LENGTH: f32 = 1e18;

/// Error that names its field.
pub fn invalid(field: impl Into<String>, message: impl Into<String>) -> InvalidShape {
    InvalidShape { field: field.into(), message: message.into() }
}

/// Checks that a number is within a range.
pub fn number(field: &str, value: f32, low: f32, high: f32) -> Result<(), InvalidShape> {
    range::range_error(field, value, low, high).map_or(Ok(()), |message| Err(invalid(field, message)))
}

/// Checks a coordinate or signed length.
pub fn coordinate(field: &str, value: f32) -> Result<(), InvalidShape> {
    if value.abs() <= MAX_LENGTH {
        return Ok(());
    }
    Err(invalid(
        field,
        format!("`{field}` must be a finite number between -{MAX_LENGTH:e} and {MAX_LENGTH:e}, is {value}"),
    ))
}

/// Checks a length above zero.
pub fn positive(field: &str, value: f32) -> Result<(), InvalidShape> {
    if (1.0 / MAX_LENGTH..=MAX_LENGTH).contains(&value) {
        return Ok(());
    }
    let limits = format!("{:e} to {MAX_LENGTH:e}", 1.0 / MAX_LENGTH);
    Err(invalid(field, format!("`{field}` must be a length above 0 ({limits}), is {value}")))
}

/// Checks the three coordinates of a point.
pub fn point(field: &str, value: Vec3) -> Result<(), InvalidShape> {
    value.to_array().into_iter().enumerate().try_for_each(|(axis, v)| coordinate(&format!("{field}[{axis}]"), v))
}
