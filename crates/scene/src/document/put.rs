//! A value put into a tree at a place, which is a JSON pointer (RFC 6901).

use super::tree::{Member, Node, Value};
use crate::path::Path;
use crate::report::Finding;
use std::sync::Arc;

/// Most steps of a pointer.
const MAX_STEPS: usize = 64;

/// Puts `value` at `pointer`; `null` takes away what is there. Objects on the way are made where there are none; into an
/// array, the place after its last appends.
pub fn put(tree: &mut Node, pointer: &str, value: serde_json::Value) -> Result<(), Finding> {
    let Some(steps) = pointer.strip_prefix('/') else {
        return Err(Finding::error(format!("`{pointer}` is no place in a scene: places begin with `/`")));
    };
    let steps: Vec<String> = steps.split('/').map(|step| step.replace("~1", "/").replace("~0", "~")).collect();
    if steps.len() > MAX_STEPS {
        return Err(Finding::error(format!(
            "a place in a scene has at most {MAX_STEPS} steps, this has {}",
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
                let message = format!("there is no element `{step}` here, there are {count}");
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
        _ => Err(Finding::error(format!("nothing lies in {}: `{step}` cannot be set", node.kind())).at(at)),
    }
}
