//! Setting a value in a document by its JSON pointer (RFC 6901).

use super::tree::{Member, Node, Value};
use crate::path::Path;
use crate::report::Finding;
use std::sync::Arc;

/// Maximum number of steps of a pointer.
const MAX_STEPS: usize = 64;

/// Sets the value at `pointer`; `null` removes it. Missing objects along the pointer are created,
/// and an array index equal to the array's length appends.
pub fn set_at_pointer(tree: &mut Node, pointer: &str, value: serde_json::Value) -> Result<(), Finding> {
    let Some(steps) = pointer.strip_prefix('/') else {
        return Err(Finding::error(format!("`{pointer}` is not a JSON pointer: it must begin with `/`")));
    };
    let steps: Vec<String> = steps.split('/').map(|step| step.replace("~1", "/").replace("~0", "~")).collect();
    if steps.len() > MAX_STEPS {
        return Err(Finding::error(format!(
            "a JSON pointer must have at most {MAX_STEPS} steps, this one has {}",
            steps.len()
        )));
    }
    descend(tree, &steps, Path::root(), value)
}

fn descend(node: &mut Node, steps: &[String], at: Path, value: serde_json::Value) -> Result<(), Finding> {
    let Some((step, rest)) = steps.split_first() else {
        *node = value.into();
        return Ok(());
    };
    match &mut node.value {
        Value::Object(members) => {
            let members = Arc::make_mut(members);
            if rest.is_empty() && value.is_null() {
                members.remove(step);
                return Ok(());
            }
            let empty = Member { key_place: None, node: serde_json::json!({}).into() };
            match members.get_or_append(step, empty) {
                Some(member) => descend(&mut member.node, rest, at.key(step.as_str()), value),
                None => Ok(()),
            }
        }
        Value::Array(elements) => {
            let count = elements.len();
            let Some(index) = step.parse().ok().filter(|index| *index <= count) else {
                let message = format!("no element `{step}` in this array of {count} elements");
                return Err(Finding::error(message).at(at));
            };
            let elements = Arc::make_mut(elements);
            if rest.is_empty() && value.is_null() {
                if index < count {
                    elements.remove(index);
                }
                return Ok(());
            }
            if index == count {
                elements.push(serde_json::json!({}).into());
            }
            match elements.get_mut(index) {
                Some(element) => descend(element, rest, at.index(index), value),
                None => Ok(()),
            }
        }
        _ => Err(Finding::error(format!("cannot set `{step}` inside {}", node.kind())).at(at)),
    }
}
