//! What material inputs have in common: ranges of what is written, and of what textures give.

use super::MaterialError;
use super::error::in_range;
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Lookup, Slot, TextureTable};

/// Refuses a written colour with a channel outside 0 to 1.
pub fn check_share(field: &'static str, input: &Input<Rgb>) -> Result<(), MaterialError> {
    check_color(field, input, 1.0)
}

/// Refuses a written colour with a channel outside 0 to `most`.
pub fn check_color(field: &'static str, input: &Input<Rgb>, most: f32) -> Result<(), MaterialError> {
    let Input::Value(color) = input else { return Ok(()) };
    color.to_array().iter().try_for_each(|channel| in_range(field, *channel, 0.0, most))
}

/// Refuses light whose color, factor, or product of both has a channel below 0 or above [`MAX_LIGHT`].
pub fn check_light(
    field: &'static str,
    color: &Input<Rgb>,
    factor_field: &'static str,
    factor: f32,
) -> Result<(), MaterialError> {
    check_color(field, color, MAX_LIGHT)?;
    in_range(factor_field, factor, 0.0, MAX_LIGHT)?;
    match color {
        Input::Value(color) if (*color * factor).max_channel() > MAX_LIGHT => {
            let message = format!("`{field}` times `{factor_field}` must not exceed {MAX_LIGHT:e} in any channel");
            Err(MaterialError::Invalid { field: factor_field, message })
        }
        _ => Ok(()),
    }
}

/// Refuses a written number outside `low` to `high`.
pub fn check_number(field: &'static str, input: &Input<f32>, low: f32, high: f32) -> Result<(), MaterialError> {
    let Input::Value(number) = input else { return Ok(()) };
    in_range(field, *number, low, high)
}

/// A colour whose channels are shares: what textures give beyond 0 and 1 is cut off.
pub fn share(textures: &TextureTable, slot: &Slot<Rgb>, at: &Lookup) -> Rgb {
    match slot {
        Slot::Value(color) => *color,
        Slot::Texture(_) => textures.color(slot, at).map(|channel| channel.clamp(0.0, 1.0)),
    }
}

/// A number between 0 and 1: what textures give beyond is cut off.
pub fn fraction(textures: &TextureTable, slot: &Slot<f32>, at: &Lookup) -> f32 {
    match slot {
        Slot::Value(number) => *number,
        Slot::Texture(_) => textures.number(slot, at).clamp(0.0, 1.0),
    }
}

/// Light: what textures give below zero is none.
pub fn light(textures: &TextureTable, slot: &Slot<Rgb>, at: &Lookup) -> Rgb {
    match slot {
        Slot::Value(color) => *color,
        Slot::Texture(_) => textures.color(slot, at).map(|channel| channel.max(0.0)),
    }
}
