//! Checks of descriptions: every number finite and of a size whose square still fits a float.

use super::InvalidShape;
use juggler_math::{Vec3, range};

/// The greatest length or coordinate; its reciprocal is the smallest radius or edge.
pub const MAX_LENGTH: f32 = 1e18;

/// An error that names its field.
pub fn invalid(field: impl Into<String>, message: impl Into<String>) -> InvalidShape {
    InvalidShape { field: field.into(), message: message.into() }
}

/// A number within a range.
pub fn number(field: &str, value: f32, low: f32, high: f32) -> Result<(), InvalidShape> {
    range::outside(field, value, low, high).map_or(Ok(()), |message| Err(invalid(field, message)))
}

/// A coordinate or signed length.
pub fn coordinate(field: &str, value: f32) -> Result<(), InvalidShape> {
    if value.abs() <= MAX_LENGTH {
        return Ok(());
    }
    Err(invalid(
        field,
        format!("`{field}` must be a finite number between -{MAX_LENGTH:e} and {MAX_LENGTH:e}, is {value}"),
    ))
}

/// A length above zero.
pub fn positive(field: &str, value: f32) -> Result<(), InvalidShape> {
    if (1.0 / MAX_LENGTH..=MAX_LENGTH).contains(&value) {
        return Ok(());
    }
    let limits = format!("{:e} to {MAX_LENGTH:e}", 1.0 / MAX_LENGTH);
    Err(invalid(field, format!("`{field}` must be a length above 0 ({limits}), is {value}")))
}

/// A point: three coordinates.
pub fn point(field: &str, value: Vec3) -> Result<(), InvalidShape> {
    value.to_array().into_iter().enumerate().try_for_each(|(axis, v)| coordinate(&format!("{field}[{axis}]"), v))
}
