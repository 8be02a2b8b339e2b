//! How strong a light is: a number of its own measure, or its radiant flux in watts.

use super::{InvalidLight, either, in_range};
use juggler_math::{MAX_LIGHT, Rgb};

/// The two fields of which a light has at most one.
#[derive(Clone, Copy, Debug)]
pub struct Strength {
    /// Field of the light's own measure: `intensity`, `radiance`.
    pub name: &'static str,
    /// Its value.
    pub value: Option<f32>,
    /// The field `power`: radiant flux in watts.
    pub power: Option<f32>,
}

impl Strength {
    /// Checks both fields and the color; `total` is what they make together, per channel.
    pub fn check(self, color: Rgb, total: Rgb) -> Result<(), InvalidLight> {
        let Self { name, value, power } = self;
        either(("power", power.is_some()), (name, value.is_some()))?;
        color.to_array().iter().try_for_each(|v| in_range("color", *v, 0.0, MAX_LIGHT))?;
        let field = if power.is_some() { "power" } else { name };
        in_range(field, power.or(value).unwrap_or(0.0), 0.0, MAX_LIGHT)?;
        if total.max_channel() <= MAX_LIGHT {
            return Ok(());
        }
        let message = format!("`color` times `{field}` must not exceed {MAX_LIGHT:e} in any channel");
        Err(InvalidLight { field, message })
    }
}
