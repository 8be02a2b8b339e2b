//! Names of kinds as in scene files.

use serde::Serialize;

/// Key of an externally tagged value: `sphere` for `{"sphere": {...}}` and for `"sphere"`; empty
/// for other values.
pub fn name_of(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::Object(members)) => members.keys().next().cloned().unwrap_or_default(),
        Ok(serde_json::Value::String(name)) => name,
        _ => String::new(),
    }
}
