//! Strength of a light: intensity or radiance, or radiant flux in watts.

use super::{InvalidLight, check_exclusive, in_range};
use juggler_math::{MAX_LIGHT, Rgb};

/// Two fields that set the strength of a light; at most one may be given.
#[derive(Clone, Copy, Debug)]
pub struct Strength {
    /// Name of the first field: `intensity` or `radiance`.
    pub field: &'static str,
    /// Value of the first field.
    pub value: Option<f32>,
    /// Value of the field `power`: radiant flux in watts.
    pub power: Option<f32>,
}

impl Strength {
    /// Checks both fields and the color; `total` is their product per channel.
    pub fn check(self, color: Rgb, total: Rgb) -> Result<(), InvalidLight> {
        let Self { field, value, power } = self;
        check_exclusive(("power", power.is_some()), (field, value.is_some()))?;
        color.to_array().iter().try_for_each(|v| in_range("color", *v, 0.0, MAX_LIGHT))?;
        let field = if power.is_some() { "power" } else { field };
        in_range(field, power.or(value).unwrap_or(0.0), 0.0, MAX_LIGHT)?;
        if total.max_channel() <= MAX_LIGHT {
            return Ok(());
        }
        let message = format!("`color` times `{field}` must not exceed {MAX_LIGHT:e} in any channel");
        Err(InvalidLight { field, message })
    }
}
