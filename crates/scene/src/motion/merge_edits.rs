//! Merges edits by programs into the templates of animated items. An edited value becomes constant;
//! values that the program left alone stay animated.

use super::{FormValue, ItemSource, read_items, write};
use crate::animate::{SceneSources, TimeDependence, has_expressions, is_form};
use crate::description::Description;
use crate::document::{Node, Value};
use crate::item::Template;
use crate::path::{Path, Step};
use std::borrow::Cow;
use std::sync::Arc;

/// Returns the scene with all edits merged into its templates; borrows the scene if it has no such
/// edits.
pub(crate) fn edits_merged<'s>(scene: &'s Description, sources: SceneSources<'_>, frame: f64) -> Cow<'s, Description> {
    let mut changed: Vec<(Path, Arc<Template>, serde_json::Value)> = Vec::new();
    scene.each_item(&mut |at, item| {
        if let Some(template) = item.template().filter(|_| item.is_changed()) {
            changed.push((at.into(), Arc::clone(template), item.json()));
        }
    });
    let stale = scene.list_forms.iter().any(|form| !is_unchanged(scene, &form.path, &form.given));
    if changed.is_empty() && !stale {
        return Cow::Borrowed(scene);
    }
    let mut edits_merged = scene.clone();
    let head = write::head(scene);
    let mut time_dependence = TimeDependence::from_tree(&head, &scene.programs);
    for (path, template, after) in changed {
        let node = value_before_edit(scene, &head, sources, frame, &path, &template)
            .map(|before| merge_edit(&template.node, &before, &after))
            .filter(|node| has_expressions(node, &scene.programs));
        let template = node.map(|node| {
            let depends_on_time = time_dependence.depends_on_time(&node);
            Arc::new(Template::new(node, depends_on_time, &scene.programs))
        });
        if let Some(item) = edits_merged.item_mut(&path) {
            item.set_template(template);
        }
    }
    edits_merged.list_forms.retain(|form| is_unchanged(scene, &form.path, &form.given));
    Cow::Owned(edits_merged)
}

/// JSON of the item before the edit; `None` if its template can no longer be evaluated.
fn value_before_edit(
    scene: &Description,
    head: &Node,
    sources: SceneSources<'_>,
    frame: f64,
    path: &Path,
    template: &Arc<Template>,
) -> Option<serde_json::Value> {
    let source = ItemSource {
        path: path.clone(),
        template: Arc::clone(template),
        keeps_template: true,
        value_is_known: false,
        place: None,
    };
    let (_, part) = read_items(scene, head, sources, frame, &[source]).0?.into_iter().next()?;
    Some(part.json())
}

/// Merges an edit: the JSON after the edit, with the template's expressions and value forms
/// wherever the edit left the value unchanged.
fn merge_edit(template: &Node, before: &serde_json::Value, after: &serde_json::Value) -> Node {
    let mut moving = Vec::new();
    sources_in(template, &mut Path::root(), &mut moving);
    let mut node = Node::from(after.clone());
    for (path, source) in moving {
        if value_at(before, path.steps()) == value_at(after, path.steps()) {
            put(&mut node, path.steps(), source);
        }
    }
    node
}

/// Outermost expressions and value forms of a template as JSON, with their paths.
pub(crate) fn animated_values(template: &Node) -> Vec<(Path, serde_json::Value)> {
    let mut sources = Vec::new();
    sources_in(template, &mut Path::root(), &mut sources);
    sources.into_iter().map(|(path, source)| (path, source.to_json())).collect()
}

/// Collects the outermost expressions and value forms of a template with their paths.
pub(super) fn sources_in<'n>(node: &'n Node, at: &mut Path, found: &mut Vec<(Path, &'n Node)>) {
    match &node.value {
        Value::String(text) if text.starts_with('=') => found.push((at.clone(), node)),
        Value::Object(members) if is_form(members) => found.push((at.clone(), node)),
        Value::Object(members) => {
            for (key, member) in members.iter() {
                at.push(Step::Key(key.clone()));
                sources_in(&member.node, at, found);
                at.pop();
            }
        }
        Value::Array(elements) => {
            for (i, element) in elements.iter().enumerate() {
                at.push(Step::Index(i));
                sources_in(element, at, found);
                at.pop();
            }
        }
        _ => {}
    }
}

/// Value at a path in serialized JSON, in which a single transform step is an array of one.
fn value_at<'j>(json: &'j serde_json::Value, steps: &[Step]) -> Option<&'j serde_json::Value> {
    let Some((step, rest)) = steps.split_first() else { return Some(json) };
    match (json, step) {
        (serde_json::Value::Object(members), Step::Key(key)) => value_at(members.get(key)?, rest),
        (serde_json::Value::Array(elements), Step::Index(i)) => value_at(elements.get(*i)?, rest),
        (serde_json::Value::Array(elements), Step::Key(_)) if elements.len() == 1 => value_at(elements.first()?, steps),
        _ => None,
    }
}

/// Stores an expression or value form at a path, if the path exists.
fn put(node: &mut Node, steps: &[Step], source: &Node) {
    let Some((step, rest)) = steps.split_first() else {
        *node = source.clone();
        return;
    };
    match (&mut node.value, step) {
        (Value::Object(members), Step::Key(key)) => {
            let members = Arc::make_mut(members);
            match members.get_mut(key) {
                Some(member) => put(&mut member.node, rest, source),
                // Serialization omits default values; only the last step can lead to one.
                None if rest.is_empty() => {
                    let member = crate::document::Member { key_place: None, node: source.clone() };
                    members.insert(key.clone(), member);
                }
                None => {}
            }
        }
        (Value::Array(elements), Step::Index(i)) => {
            if let Some(element) = Arc::make_mut(elements).get_mut(*i) {
                put(element, rest, source);
            }
        }
        (Value::Array(elements), Step::Key(_)) if elements.len() == 1 => {
            if let Some(element) = Arc::make_mut(elements).first_mut() {
                put(element, steps, source);
            }
        }
        _ => {}
    }
}

/// Whether the scene still holds the value of a list form.
fn is_unchanged(scene: &Description, path: &Path, given: &FormValue) -> bool {
    match (given, path.steps()) {
        (FormValue::Objects(objects), [_, Step::Key(group)]) => {
            scene.groups.get(group).is_some_and(|known| known.is_same(objects))
        }
        (FormValue::Objects(objects), _) => scene.objects.is_same(objects),
        (FormValue::Lights(lights), _) => scene.lights.is_same(lights),
        (FormValue::LightGroup(label), _) => scene.background_light_group.as_ref() == Some(label),
    }
}
