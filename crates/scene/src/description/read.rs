//! Deserializes a scene from its JSON tree.

use super::Description;
use crate::document::Node;
use crate::path::Path;
use crate::report::Finding;
use crate::validate::{Plain, validate};
use serde::Deserialize;
use std::borrow::Cow;

/// Validates and deserializes a scene's JSON tree. Returns the scene and the names of its inline
/// textures, or `None` if the tree does not fit the types. Appends all findings.
pub(crate) fn deserialize_scene(tree: &Node, findings: &mut Vec<Finding>) -> Option<(Description, Vec<String>)> {
    let mut validated = validate(tree);
    let json = validated.json.take();
    let inline_names = std::mem::take(&mut validated.textures).into_iter().map(|(name, _)| name).collect();
    findings.append(&mut validated.all());
    let json = json?;
    match Description::deserialize(&json) {
        Ok(description) => Some((description, inline_names)),
        // The types reject what the schema accepts: a bug of this program.
        Err(error) => {
            findings.push(Finding::error(error.to_string()).at(refused_part(&json)));
            None
        }
    }
}

/// Path of the smallest section or item that the types reject by itself; the root if there is none.
/// Uses the deserializer of the whole scene, since every further one would double the build time of
/// this crate.
fn refused_part(json: &Plain) -> Path {
    let refused = |key: &Cow<'static, str>, value: Plain| {
        let only = vec![("version".into(), Plain::Number(1.into())), (key.clone(), value)];
        Description::deserialize(&Plain::Object(only)).is_err()
    };
    let root = Path::root();
    let Plain::Object(sections) = json else { return root };
    let Some((key, value)) = sections.iter().find(|(key, value)| refused(key, value.clone())) else { return root };
    let section = root.key(&**key);
    let item = match value {
        Plain::Array(items) => {
            let at = items.iter().position(|item| refused(key, Plain::Array(vec![item.clone()])));
            at.map(|at| section.index(at))
        }
        Plain::Object(items) => {
            let found = items.iter().find(|(name, item)| refused(key, Plain::member(name.clone(), item.clone())));
            found.map(|(name, _)| section.key(&**name))
        }
        _ => None,
    };
    item.unwrap_or(section)
}
