//! Checks and clamping of material inputs: ranges of constants and of texture values.

use super::MaterialError;
use super::error::in_range;
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};

/// Whether a number has the default 0, which scenes leave out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature is that of serde")]
pub fn is_zero(number: &f32) -> bool {
    *number == 0.0
}

/// Whether a number has the default 1, which scenes leave out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature is that of serde")]
pub fn is_one(number: &f32) -> bool {
    *number == 1.0
}

/// Rejects a constant color or factor with a channel outside 0 to 1.
pub fn check_unit_color(field: &'static str, input: &Input<Rgb>) -> Result<(), MaterialError> {
    check_color(field, input, 1.0)
}

/// Rejects a constant color or factor with a channel outside 0 to `max`.
pub fn check_color(field: &'static str, input: &Input<Rgb>, max: f32) -> Result<(), MaterialError> {
    let Some(color) = input.constant_factor() else { return Ok(()) };
    color.to_array().iter().try_for_each(|channel| in_range(field, *channel, 0.0, max))
}

/// Rejects emission whose color, factor, or product of both is below 0 or above [`MAX_LIGHT`] in a
/// channel.
pub fn check_emission(
    field: &'static str,
    color: &Input<Rgb>,
    factor_field: &'static str,
    factor: f32,
) -> Result<(), MaterialError> {
    check_color(field, color, MAX_LIGHT)?;
    in_range(factor_field, factor, 0.0, MAX_LIGHT)?;
    match color.constant_factor() {
        Some(color) if (color * factor).max_channel() > MAX_LIGHT => {
            let message = format!("`{field}` times `{factor_field}` must not exceed {MAX_LIGHT:e} in any channel");
            Err(MaterialError::Invalid { field: factor_field, message })
        }
        _ => Ok(()),
    }
}

/// Rejects a constant number or factor outside `low` to `high`.
pub fn check_number(field: &'static str, input: &Input<f32>, low: f32, high: f32) -> Result<(), MaterialError> {
    let Some(number) = input.constant_factor() else { return Ok(()) };
    in_range(field, number, low, high)
}

/// Color with channels from 0 to 1, such as a reflectance. Texture values are clamped.
pub fn unit_color(textures: &TextureTable, slot: &Slot<Rgb>, at: &TextureLookup) -> Rgb {
    match slot {
        Slot::Value(color) => *color,
        Slot::Texture(_) | Slot::Product(_) => textures.color(slot, at).map(|channel| channel.clamp(0.0, 1.0)),
    }
}

/// Number from 0 to 1. Texture values are clamped.
pub fn unit_number(textures: &TextureTable, slot: &Slot<f32>, at: &TextureLookup) -> f32 {
    match slot {
        Slot::Value(number) => *number,
        Slot::Texture(_) | Slot::Product(_) => textures.number(slot, at).clamp(0.0, 1.0),
    }
}

/// Emission, 0 or more per channel. Negative texture values count as 0.
pub fn emitted_color(textures: &TextureTable, slot: &Slot<Rgb>, at: &TextureLookup) -> Rgb {
    match slot {
        Slot::Value(color) => *color,
        Slot::Texture(_) | Slot::Product(_) => textures.color(slot, at).map(|channel| channel.max(0.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_checked_as_constants_and_products_are_clamped_as_textures() {
        let error = check_number("roughness", &Input::product("t", 1.5), 0.0, 1.0).unwrap_err();
        assert_eq!(error.path(), "roughness");
        assert!(check_unit_color("base_color", &Input::product("t", Rgb::new(0.5, 2.0, 0.5))).is_err());
        assert!(check_unit_color("base_color", &Input::product("t", Rgb::WHITE)).is_ok());
        let bright = Input::product("t", Rgb::splat(1e20));
        assert_eq!(check_emission("emissive", &bright, "scale", 1e20).unwrap_err().path(), "scale");

        let white = serde_json::from_str(r#"{"constant": {"color": [4, -4, 0.5]}}"#).unwrap();
        let textures = TextureTable::new([("t".to_owned(), white)]);
        let at = TextureLookup::default();
        let slot = textures.resolve("base_color", &Input::product("t", Rgb::splat(0.5))).unwrap();
        assert_eq!(unit_color(&textures, &slot, &at), Rgb::new(1.0, 0.0, 0.25));
        assert_eq!(emitted_color(&textures, &slot, &at), Rgb::new(2.0, 0.0, 0.25));
        let slot = textures.resolve("roughness", &Input::product("t", 1.0)).unwrap();
        assert_eq!(unit_number(&textures, &slot, &at), Rgb::new(4.0, -4.0, 0.5).luminance().clamp(0.0, 1.0));
    }
}
