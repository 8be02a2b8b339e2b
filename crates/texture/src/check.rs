//! Checks of values in texture descriptions.

use super::{Input, InvalidTexture};
use juggler_math::{Rgb, Vec3, range};

/// Largest channel of a color; interpolating two such colors cannot overflow.
const MAX_CHANNEL: f32 = 1e37;

/// Rejects a number outside `low..=high`, and NaN.
pub fn in_range(field: &str, value: f32, low: f32, high: f32) -> Result<(), InvalidTexture> {
    let wrong = range::range_error(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(InvalidTexture::new(field, message)))
}

/// Rejects a constant color or factor that is too large to interpolate. Textures are checked on
/// their own.
pub fn color(field: impl Into<String>, input: &Input<Rgb>) -> Result<(), InvalidTexture> {
    match input.constant_factor() {
        Some(color) if !color.to_array().iter().all(|v| v.abs() <= MAX_CHANNEL) => {
            let field = field.into();
            let message = format!("`{field}` must be finite and below {MAX_CHANNEL:e}");
            Err(InvalidTexture::new(field, message))
        }
        _ => Ok(()),
    }
}

/// Rejects a vector that is not finite.
pub fn vector(field: &str, value: Vec3) -> Result<(), InvalidTexture> {
    if value.is_finite() { Ok(()) } else { Err(InvalidTexture::new(field, format!("`{field}` must be finite"))) }
}
