//! Writes a scene with its animation as JSON.

use super::AnyItem;
use crate::Object;
use crate::description::Description;
use crate::document::{Member, Members, Node, Value};
use crate::item::Item;
use crate::path::Step;
use crate::schema;
use serde_json::{Map, Value as Json};
use std::sync::Arc;

/// JSON of a scene's `animation`, `variables` and `paths`, which expressions may refer to.
pub(crate) fn head(scene: &Description) -> Node {
    let mut members = Members::default();
    let mut add = |key: &str, node: Node| {
        members.insert(key.to_owned(), Member { key_place: None, node });
    };
    add("animation", serde_json::to_value(scene.animation).unwrap_or_default().into());
    for (key, written) in [("variables", &scene.variables), ("paths", &scene.paths)] {
        if let Some(node) = written.node() {
            add(key, node.clone());
        }
    }
    Node { place: None, value: Value::Object(members.into()) }
}

/// JSON of an item with its expressions and value forms.
pub(crate) fn node(item: &dyn AnyItem) -> Node {
    item.template().map_or_else(|| item.json().into(), |template| template.node.clone())
}

/// JSON of an object with the expressions and value forms of the object and its children.
pub(crate) fn object_node(object: &Item<Object>) -> Node {
    let mut node = node(object);
    if let (None, Value::Object(members)) = (object.template(), &mut node.value)
        && let Some(list) = Arc::make_mut(members).get_mut("objects")
    {
        list.node.value = Value::Array(Arc::new(object.inner().iter().map(object_node).collect()));
    }
    node
}

/// JSON of a scene with its animation. Edits must have been merged into templates
/// ([`edits_merged`](super::edits_merged)).
pub(crate) fn written(scene: &Description) -> Json {
    let mut json = serde_json::to_value(scene).unwrap_or_default();
    schema::shorten_numbers(&mut json);
    schema::drop_nulls(&mut json);
    for source in scene.templates(|_| true) {
        put(&mut json, source.path.steps(), source.template.node.to_json());
    }
    if let Some(textures) = json.get_mut("textures").and_then(Json::as_object_mut) {
        // Reading the scene names inline textures again.
        scene.form_textures.iter().for_each(|name| drop(textures.shift_remove(name)));
    }
    json
}

fn put(json: &mut Json, steps: &[Step], value: Json) {
    let Some((step, rest)) = steps.split_first() else {
        *json = value;
        return;
    };
    match (json, step) {
        (Json::Object(members), Step::Key(key)) => {
            put(members.entry(key.as_str()).or_insert_with(|| Json::Object(Map::new())), rest, value);
        }
        (Json::Array(elements), Step::Index(i)) => {
            if let Some(element) = elements.get_mut(*i) {
                put(element, rest, value);
            }
        }
        _ => {}
    }
}
