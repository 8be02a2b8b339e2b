//! What numbers of a texture must keep.

use super::{Input, InvalidTexture};
use juggler_math::{Rgb, Vec3, range};

/// The largest channel of a colour: far beyond any light, and mixing two cannot overflow.
const LARGEST: f32 = 1e37;

/// Refuses a number outside `low..=high`, and what is no number.
pub fn in_range(field: &str, value: f32, low: f32, high: f32) -> Result<(), InvalidTexture> {
    let wrong = range::outside(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(InvalidTexture::new(field, message)))
}

/// Refuses a colour too large to be mixed; one that comes from a texture is checked there.
pub fn color(field: impl Into<String>, input: &Input<Rgb>) -> Result<(), InvalidTexture> {
    match input {
        Input::Value(color) if !color.to_array().iter().all(|v| v.abs() <= LARGEST) => {
            let field = field.into();
            let message = format!("`{field}` must be finite and below {LARGEST:e}");
            Err(InvalidTexture::new(field, message))
        }
        _ => Ok(()),
    }
}

/// Refuses a vector that is not finite.
pub fn vector(field: &str, value: Vec3) -> Result<(), InvalidTexture> {
    if value.is_finite() { Ok(()) } else { Err(InvalidTexture::new(field, format!("`{field}` must be finite"))) }
}
