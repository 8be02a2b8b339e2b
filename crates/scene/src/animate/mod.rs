//! Animation: a tree with expressions and value forms becomes, for one frame, a tree with plain values. The rest of
//! the program only ever sees still scenes.
//!
//! ```json
//! {"translate": {"animate": {"keys": [[0, [0, 1, 0]], [2, [5, 1, 0]]], "interpolation": "smooth", "repeat": "loop"}}}
//! ```
//!
//! Order: variables, each of which may use those before it; paths, which variables may ask for earlier; all the rest.

use crate::document::{Members, Node, Sources, Value};
use crate::path::Trail;
use crate::report::Finding;
use crate::suggest;
use juggler_expression::{Names, PointEvaluator, Program};
use std::sync::Arc;
use walk::Walk;

mod curve;
mod easing;
mod paths;
mod programs;
mod resolver;
mod spline;
mod survey;
mod values;
mod variables;
mod walk;

pub use easing::{Ease, Easing};
pub use paths::{MAX_POINTS, PathName};
pub(crate) use programs::Programs;
pub(crate) use resolver::Resolver;
pub use survey::{Survey, Track, depends_on_time};
pub(crate) use survey::{TimeDependence, has_expressions};
pub use values::{Along, Animate, Interpolation, Joint, Key, MAX_KEYS, Repeat, ValueForm};
pub use walk::MAX_NESTING;

/// Parts of a scene in which a text that begins with `=` is just a text, or that come before all others.
const PLAIN: [&str; 5] = ["title", "description", "animation", "variables", "paths"];
/// Parts of a scene that are maps: what their keys say is a name, never a value form.
const NAMED: [&str; 4] = ["cameras", "textures", "materials", "groups"];
/// Names that every expression may use.
const GIVEN: [&str; 4] = ["frame", "frames", "seconds", "pi"];
/// Names among them that change from frame to frame.
const CHANGING: [&str; 2] = ["frame", "seconds"];

/// The tree at a frame (which may lie between two), with every mistake in an expression or value form. What holds
/// neither is shared with `tree`.
pub fn resolve(tree: &Node, sources: &Sources, frame: f64) -> (Node, Vec<Finding>) {
    resolve_with(tree, sources, &Programs::default(), frame)
}

/// [`resolve`] with the scene's compiled expressions.
pub(crate) fn resolve_with(tree: &Node, sources: &Sources, programs: &Programs, frame: f64) -> (Node, Vec<Finding>) {
    let mut walk = Walk::new(tree, sources, programs, given(tree, frame));
    let resolved = resolved(&mut walk, tree);
    (resolved, walk.findings)
}

/// What moves in a tree, for people to read.
pub(crate) fn survey(tree: &Node, sources: &Sources, programs: &Programs) -> Survey {
    let mut walk = Walk::new(tree, sources, programs, given(tree, 0.0)).surveying();
    resolved(&mut walk, tree);
    Survey { tracks: walk.tracks.unwrap_or_default(), expressions: survey::changing_expressions(tree, programs) }
}

fn resolved(walk: &mut Walk<'_>, tree: &Node) -> Node {
    walk.variables();
    let paths = walk.all_paths();
    let mut resolved = tree.clone();
    if let Value::Object(members) = &mut resolved.value {
        let members = Arc::make_mut(members);
        for (key, member) in members.iter_mut().filter(|(key, _)| !PLAIN.contains(&key.as_str())) {
            let at = Trail::Root.key(key);
            let inner = match &member.node.value {
                Value::Object(named) if NAMED.contains(&key.as_str()) => {
                    let named = walk.object(named, &at);
                    named.map(|named| Node { place: member.node.place, value: Value::Object(named) })
                }
                _ => walk.node(&member.node, &at),
            };
            if let Some(node) = inner {
                member.node = node;
            }
        }
        if let Some((paths, member)) = paths.zip(members.get_mut("paths")) {
            member.node.value = Value::Object(paths);
        }
        members.remove("variables");
    }
    resolved
}

/// What expressions may use in any scene.
fn given(tree: &Node, frame: f64) -> Names {
    let number = |key: &str, default: f64| {
        let node = tree.get("animation").and_then(|animation| animation.get(key));
        match node.map(|node| &node.value) {
            Some(Value::Number(number)) => number.as_f64().filter(|v| *v > 0.0).unwrap_or(default),
            _ => default,
        }
    };
    let frames = number("frames", 1.0);
    let seconds = frame / number("frames_per_second", 30.0);
    let values = [frame, frames, seconds, std::f64::consts::PI].map(Into::into);
    GIVEN.into_iter().zip(values).collect()
}

/// A whole number stays one, so that it can count things.
fn number(value: f64) -> Value {
    if value == value.trunc() && value.abs() < 9.0e15 {
        return Value::Number((value as i64).into());
    }
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

/// An array of numbers in place of `node`.
fn numbers(values: impl IntoIterator<Item = f64>, node: &Node) -> Node {
    let element = |value| Node { place: node.place, value: number(value) };
    Node { place: node.place, value: Value::Array(Arc::new(values.into_iter().map(element).collect())) }
}

/// Suggests `=` for a text where a number should be: `"2*pi"` probably misses it.
pub fn looks_like_expression(text: &str) -> bool {
    let names: Names = GIVEN.into_iter().map(|name| (name, 1.0.into())).collect();
    let has_value = |program: Program| PointEvaluator::default().value(&program, &names).is_ok();
    suggest::closest(text, ["inf", "nan"]).is_none() && Program::compile(text, &names).is_ok_and(has_value)
}

/// The reserved keys of value forms.
pub fn forms() -> impl Iterator<Item = &'static str> + Clone {
    values::KINDS.iter().map(|kind| kind.name)
}

/// Whether an object is a value form, or was meant to be one.
pub(crate) fn is_form(members: &Members) -> bool {
    values::kind_in(members).is_some()
}

/// Suggests the name of a value form for the only key of an object that stands where none can.
pub fn nearest_form(key: &str) -> Option<&'static str> {
    suggest::closest(key, forms())
}
