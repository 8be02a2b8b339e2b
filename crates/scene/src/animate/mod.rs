//! Animation: evaluates the expressions and value forms of a scene's JSON tree at one frame. The
//! rest of the program sees static scenes only.
//!
//! ```json
//! {"translate": {"animate": {
//!   "keys": [[0, [0, 1, 0]], [2, [5, 1, 0]]], "interpolation": "smooth", "repeat": "loop"}}}
//! ```
//!
//! Order of evaluation: variables, each of which may refer to variables above it; paths, which
//! variables may request earlier; all other values.

use crate::compile::AssetCache;
use crate::document::{Members, Node, SourceSpan, Sources, Value};
use crate::path::PathRef;
use crate::report::Finding;
use crate::suggest;
use juggler_expression::{Names, PointEvaluator, Program};
use std::path::PathBuf;
use std::sync::Arc;
use tree_resolver::TreeResolver;

mod curve;
mod easing;
mod key_time;
mod paths;
mod programs;
mod resolver;
mod spline;
mod survey;
mod tree_resolver;
mod value_source;
mod values;
mod variables;

pub use easing::{Ease, Easing};
pub use key_time::{Frames, KeyTime, Seconds};
pub use paths::{MAX_POINTS, PathName};
pub(crate) use programs::Programs;
pub(crate) use resolver::Resolver;
pub use survey::{FormSummary, Survey, depends_on_time};
pub(crate) use survey::{TimeDependence, has_expressions};
pub use tree_resolver::MAX_NESTING;
pub use value_source::{Animatable, ValueSource};
pub(crate) use values::posed_files;
pub use values::{Along, Animate, Extrapolation, Interpolation, Joint, Key, MAX_KEYS, Posed, ValueForm};

/// Sections in which a string that begins with `=` is plain text, or that are evaluated first.
const NOT_ANIMATED: [&str; 5] = ["title", "description", "animation", "variables", "paths"];
/// Sections that are maps, whose keys are names and never reserved keys of value forms.
const NAMED: [&str; 4] = ["cameras", "textures", "materials", "groups"];
/// Names that are defined in every expression.
const PREDEFINED_NAMES: [&str; 4] = ["frame", "frames", "seconds", "pi"];
/// Predefined names that change from frame to frame.
const TIME_NAMES: [&str; 2] = ["frame", "seconds"];

/// Files that the evaluation of a scene needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneSources<'s> {
    /// Source texts of the scene, for messages.
    pub texts: &'s Sources,
    /// Cache of loaded files, for the poses of models.
    pub asset_cache: &'s AssetCache,
}

impl SceneSources<'_> {
    /// Location of a file that the text at `place` names: the asset of that name, or a file relative
    /// to the scene file that contains the text.
    pub fn locate(&self, file: &str, place: Option<SourceSpan>) -> PathBuf {
        let asset = self.asset_cache.store().assets.path_of(file);
        asset.unwrap_or_else(|| self.texts.folder(place).join(file))
    }
}

/// Evaluates a tree at a frame, which may be fractional. Returns the tree with plain values, and
/// all errors in expressions and value forms. Nodes without any of these are shared with `tree`.
/// Models cannot be read.
pub fn resolve(tree: &Node, sources: &Sources, frame: f64) -> (Node, Vec<Finding>) {
    let asset_cache = AssetCache::default();
    resolve_with(tree, SceneSources { texts: sources, asset_cache: &asset_cache }, &Programs::default(), frame)
}

/// [`resolve`] with the scene's files and compiled expressions.
pub(crate) fn resolve_with(
    tree: &Node,
    sources: SceneSources<'_>,
    programs: &Programs,
    frame: f64,
) -> (Node, Vec<Finding>) {
    let mut resolver = TreeResolver::new(tree, sources, programs, predefined_names(tree, frame));
    let resolved = resolved(&mut resolver, tree);
    (resolved, resolver.findings)
}

/// Surveys the value forms and time-dependent expressions of a tree.
pub(crate) fn survey(tree: &Node, sources: SceneSources<'_>, programs: &Programs) -> Survey {
    let mut resolver = TreeResolver::new(tree, sources, programs, predefined_names(tree, 0.0)).surveying();
    resolved(&mut resolver, tree);
    Survey { forms: resolver.forms.unwrap_or_default(), expressions: survey::changing_expressions(tree, programs) }
}

fn resolved(resolver: &mut TreeResolver<'_>, tree: &Node) -> Node {
    resolver.variables();
    let paths = resolver.all_paths();
    let mut resolved = tree.clone();
    if let Value::Object(members) = &mut resolved.value {
        let members = Arc::make_mut(members);
        for (key, member) in members.iter_mut().filter(|(key, _)| !NOT_ANIMATED.contains(&key.as_str())) {
            let at = PathRef::Root.key(key);
            let inner = match &member.node.value {
                Value::Object(named) if NAMED.contains(&key.as_str()) => {
                    let named = resolver.object(named, &at);
                    named.map(|named| Node { place: member.node.place, value: Value::Object(named) })
                }
                _ => resolver.node(&member.node, &at),
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

/// Predefined names and their values at a frame.
fn predefined_names(tree: &Node, frame: f64) -> Names {
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
    PREDEFINED_NAMES.into_iter().zip(values).collect()
}

/// JSON number. Whole numbers become integers, so that they are valid counts.
fn number(value: f64) -> Value {
    if value == value.trunc() && value.abs() < 9.0e15 {
        return Value::Number((value as i64).into());
    }
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

/// JSON array of numbers, at the source location of `node`.
fn numbers(values: impl IntoIterator<Item = f64>, node: &Node) -> Node {
    let element = |value| Node { place: node.place, value: number(value) };
    Node { place: node.place, value: Value::Array(Arc::new(values.into_iter().map(element).collect())) }
}

/// Whether a string in place of a number is an expression that lacks its `=`, such as `"2*pi"`.
pub fn looks_like_expression(text: &str) -> bool {
    let names: Names = PREDEFINED_NAMES.into_iter().map(|name| (name, 1.0.into())).collect();
    let has_value = |program: Program| PointEvaluator::default().value(&program, &names).is_ok();
    suggest::closest(text, ["inf", "nan"]).is_none() && Program::compile(text, &names).is_ok_and(has_value)
}

/// Reserved keys of value forms.
pub fn forms() -> impl Iterator<Item = &'static str> + Clone {
    values::KINDS.iter().map(|kind| kind.name)
}

/// Whether an object has the reserved key of a value form.
pub(crate) fn is_form(members: &Members) -> bool {
    values::kind_in(members).is_some()
}

/// Reserved key of a value form that resembles `key`, as a suggestion for messages.
pub fn closest_form(key: &str) -> Option<&'static str> {
    suggest::closest(key, forms())
}
