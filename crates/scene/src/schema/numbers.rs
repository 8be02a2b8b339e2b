//! Numbers as people write them.

use serde_json::{Number, Value};

/// Writes 32-bit numbers with the digits they need: 0.8, not 0.800000011920929. What reads them as 32-bit numbers
/// gets the same bits.
pub fn tidy(json: &mut Value) {
    match json {
        Value::Number(number) if number.is_f64() => {
            if let Some(shorter) = number.as_f64().and_then(shorter) {
                *number = shorter;
            }
        }
        Value::Array(elements) => elements.iter_mut().for_each(tidy),
        Value::Object(members) => members.values_mut().for_each(tidy),
        _ => {}
    }
}

/// Leaves out what is null: in a scene file that means the same as nothing.
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
    if value == value.trunc() && value.abs() < 1.0e15 {
        return Some(Number::from(value as i64));
    }
    Number::from_f64(single.to_string().parse().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_that_say_nothing_go_and_bits_stay() {
        let mut json = serde_json::json!([f64::from(0.8_f32), 0.1, 1.0, f64::from(f32::MAX), -0.0, 7]);
        tidy(&mut json);
        assert_eq!(json.to_string(), "[0.8,0.1,1,3.4028235e38,0,7]");
        let read: Vec<f32> = serde_json::from_value(json).unwrap();
        assert_eq!(read, [0.8, 0.1, 1.0, f32::MAX, 0.0, 7.0]);
    }
}
