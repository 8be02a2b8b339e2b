//! From the tree of a scene to its types.

use super::Description;
use crate::document::Node;
use crate::path::Path;
use crate::report::Finding;
use crate::validate::{Plain, validate};
use serde::Deserialize;
use std::borrow::Cow;

/// The types of a tree, as far as it fits them, with the names of textures that were written in place; and all that is wrong
/// with it.
pub(crate) fn described(tree: &Node, findings: &mut Vec<Finding>) -> Option<(Description, Vec<String>)> {
    let mut validated = validate(tree);
    let json = validated.json.take();
    let in_place = std::mem::take(&mut validated.textures).into_iter().map(|(name, _)| name).collect();
    findings.append(&mut validated.all());
    let json = json?;
    match Description::deserialize(&json) {
        Ok(description) => Some((description, in_place)),
        // The schema allows what the types refuse: only a slip of ours can bring us here.
        Err(error) => {
            findings.push(Finding::error(error.to_string()).at(refused_part(&json)));
            None
        }
    }
}

/// The smallest section or item of a description that the types refuse by itself; the root if there is none. The same
/// deserializer serves as for the whole: each one more would double what this crate takes to build.
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
