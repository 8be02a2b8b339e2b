//! Range checks for numbers of the scene format, and their error messages.

/// Largest value of a color channel of emitted light, alone or multiplied by its intensity. Sums of
/// 16 samples and products with weights up to 10^7 stay finite in `f32`.
pub const MAX_LIGHT: f32 = 1e30;

/// Error message for a `value` outside `low..=high` or NaN; `None` for a value inside. A `low` of
/// `f32::MIN_POSITIVE` reads "above 0"; a `high` of `f32::MAX` means no upper limit.
pub fn range_error(field: &str, value: f32, low: f32, high: f32) -> Option<String> {
    if value >= low && value <= high {
        return None;
    }
    let range = match (low == f32::MIN_POSITIVE, high == f32::MAX) {
        (true, true) => "above 0".to_owned(),
        (true, false) => format!("above 0, up to {}", format_number(high)),
        (false, true) => format!("{} or more", format_number(low)),
        (false, false) => format!("between {} and {}", format_number(low), format_number(high)),
    };
    Some(format!("`{field}` must be {range}, it is {}", format_number(value)))
}

/// Formats a number for messages, with an exponent below 1e-5 and from 1e9 on.
pub fn format_number(value: f32) -> String {
    let size = value.abs();
    if value.is_finite() && (size >= 1e9 || size > 0.0 && size < 1e-5) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn range_limits_are_inclusive_and_named_in_errors() {
        for (low, high) in [(0.0, MAX_LIGHT), (1e-6, 1e30), (0.01, 100.0), (-1e4, 1e4), (0.0, f32::MAX)] {
            assert_eq!(range_error("x", low, low, high), None);
            assert_eq!(range_error("x", high, low, high), None);
            assert!(
                range_error("x", low.next_down(), low, high).is_some()
                    && range_error("x", f32::NAN, low, high).is_some()
            );
        }
        let message = |value, low, high| range_error("x", value, low, high).unwrap_or_default();
        assert_eq!(message(3.4e38, 0.0, MAX_LIGHT), "`x` must be between 0 and 1e30, it is 3.4e38");
        assert_eq!(message(-1.5, 0.0, f32::MAX), "`x` must be 0 or more, it is -1.5");
        assert_eq!(message(0.0, f32::MIN_POSITIVE, f32::MAX), "`x` must be above 0, it is 0");
        assert_eq!(message(2e12, f32::MIN_POSITIVE, 1e12), "`x` must be above 0, up to 1e12, it is 2e12");
        assert_eq!(message(5e-7, 1e-6, 64.0), "`x` must be between 1e-6 and 64, it is 5e-7");
        assert_eq!(message(f32::INFINITY, 0.0, 1.0), "`x` must be between 0 and 1, it is inf");
    }
}
