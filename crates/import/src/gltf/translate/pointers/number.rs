//! Numbers that animations set. They stay in the ranges of the format, which cubic splines may
//! leave.

/// Smallest and largest value.
pub type Range = [f64; 2];

/// Any number.
pub const ANY: Range = [-1e30, 1e30];
/// From 0 to 1.
pub const UNIT: Range = [0.0, 1.0];
/// At least 0.
pub const NOT_NEGATIVE: Range = [0.0, 1e30];
/// Above 0.
pub const POSITIVE: Range = [1e-6, 1e30];

/// Property of one or several numbers.
pub trait Number {
    /// Sets the property; `None` if there are too few or too many values.
    fn set(&mut self, values: &[f64], range: Range) -> Option<()>;
}

impl Number for f64 {
    fn set(&mut self, values: &[f64], [low, high]: Range) -> Option<()> {
        let [value] = values else { return None };
        *self = value.max(low).min(high);
        Some(())
    }
}

impl<const N: usize> Number for [f64; N] {
    fn set(&mut self, values: &[f64], [low, high]: Range) -> Option<()> {
        let values: &[f64; N] = values.try_into().ok()?;
        *self = values.map(|value| value.max(low).min(high));
        Some(())
    }
}

/// Sets a property of a single number.
pub fn set(number: &mut f64, values: &[f64], range: Range) -> Option<()> {
    number.set(values, range)
}
