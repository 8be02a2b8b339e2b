//! Shortening of numbers and objects for output.

use serde_json::{Number, Value};

/// Shortens 32-bit numbers to the digits that they need: 0.8, not 0.800000011920929. Parsed as
/// 32-bit numbers, they have the same bits.
pub fn shorten_numbers(json: &mut Value) {
    match json {
        Value::Number(number) if number.is_f64() => {
            if let Some(shorter) = number.as_f64().and_then(shorter) {
                *number = shorter;
            }
        }
        Value::Array(elements) => elements.iter_mut().for_each(shorten_numbers),
        Value::Object(members) => members.values_mut().for_each(shorten_numbers),
        _ => {}
    }
}

/// Removes members that are null, which scene files treat as absent.
pub fn drop_nulls(json: &mut Value) {
    match json {
        Value::Array(elements) => elements.iter_mut().for_each(drop_nulls),
        Value::Object(members) => {
            members.retain(|_, value| !value.is_null());
            members.values_mut().for_each(drop_nulls);
        }
        _ => {}
    }
}

fn shorter(value: f64) -> Option<Number> {
    let single = value as f32;
    if f64::from(single) != value {
        return None;
    }
    let negative_zero = value == 0.0 && value.is_sign_negative();
    if value == value.trunc() && value.abs() < 1.0e15 && !negative_zero {
        return Some(Number::from(value as i64));
    }
    Number::from_f64(single.to_string().parse().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_precision_numbers_are_shortened_without_changing_bits() {
        let numbers = [0.8_f32, 1.0, f32::MAX, f32::MIN_POSITIVE, 1.0e-45, -0.0, 16_777_216.0, 0.1 + 0.2];
        let mut json = serde_json::json!(numbers.map(f64::from));
        shorten_numbers(&mut json);
        let text = json.to_string();
        assert!(text.starts_with("[0.8,1,3.4028235e") && text.contains(",-0.0,16777216,"), "{text}");
        let read: Vec<f32> = serde_json::from_str(&text).unwrap();
        let bits = |numbers: &[f32]| numbers.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&numbers));
    }

    #[test]
    fn integers_and_double_precision_numbers_are_unchanged() {
        let mut json = serde_json::json!([0.1, 7, u64::MAX, 1.0e300, {"deep": [0.3]}]);
        let before = json.clone();
        shorten_numbers(&mut json);
        assert_eq!(json, before);
    }
}
