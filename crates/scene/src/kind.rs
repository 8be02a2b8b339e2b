//! The name of a kind as scene files write it.

use serde::Serialize;

/// The key of an externally tagged value: `sphere` for `{"sphere": {...}}`; empty for anything else.
pub fn name_of(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::Object(members)) => members.keys().next().cloned().unwrap_or_default(),
        Ok(serde_json::Value::String(name)) => name,
        _ => String::new(),
    }
}
