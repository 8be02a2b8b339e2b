//! Survey of a scene's value forms, and detection of time-dependent values.

use super::tree_resolver::TreeResolver;
use super::values::{self, Extrapolation, Interpolation};
use super::{NOT_ANIMATED, Programs, TIME_NAMES};
use crate::document::{Node, Value};
use crate::path::{Path, PathRef};
use std::collections::BTreeSet;

/// Animation of a scene, for display.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Value forms, in order of evaluation.
    pub forms: Vec<FormSummary>,
    /// Number of expressions that depend on time, directly or through variables.
    pub expressions: usize,
}

/// Value form of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FormSummary {
    /// Path of the form.
    pub path: Path,
    /// Reserved key, such as `animate`.
    pub kind: String,
    /// Number of keys.
    pub keys: Option<usize>,
    /// Times of the first and the last key.
    pub time_range: Option<[f64; 2]>,
    /// Interpolation between the keys.
    pub interpolation: Option<Interpolation>,
    /// Extrapolation beyond the keys.
    pub repeat: Option<Extrapolation>,
    /// Name of the path that the form follows.
    pub along: Option<String>,
    /// Model file and node that the form follows, such as "fox.glb: Head".
    pub node: Option<String>,
}

impl TreeResolver<'_> {
    /// Records a value form whose content is at `at`, if the walk is a survey.
    pub fn record_form(&mut self, at: &PathRef<'_>, fill: impl FnOnce(FormSummary) -> FormSummary) {
        let Some(forms) = &mut self.forms else { return };
        let (PathRef::Key(outer, _) | PathRef::Index(outer, _)) = at else { return };
        let kind = at.last_key().unwrap_or_default().to_owned();
        forms.push(fill(FormSummary { path: Path::from(*outer), kind, ..FormSummary::default() }));
    }
}

/// Whether any value of a tree depends on time. Unused variables do not count.
pub fn depends_on_time(tree: &Node) -> bool {
    let programs = Programs::default();
    let mut time_dependence = TimeDependence::from_tree(tree, &programs);
    parts(tree).any(|part| time_dependence.depends_on_time(part))
}

/// Number of expressions that depend on time.
pub(super) fn changing_expressions(tree: &Node, programs: &Programs) -> usize {
    let mut time_dependence = TimeDependence::from_tree(tree, programs);
    time_dependence.expressions = 0;
    for (_, variable) in tree.get("variables").into_iter().flat_map(Node::members) {
        time_dependence.search(&variable.node, true);
    }
    parts(tree).for_each(|part| {
        time_dependence.depends_on_time(part);
    });
    time_dependence.expressions
}

/// Sections of a scene that may be animated.
fn parts(tree: &Node) -> impl Iterator<Item = &Node> {
    let moves = |key: &str| key == "paths" || !NOT_ANIMATED.contains(&key);
    tree.members().filter(move |(key, _)| moves(key)).map(|(_, member)| &member.node)
}

/// Whether a value contains a value form, or an expression that uses a name other than `pi`.
pub(crate) fn has_expressions(node: &Node, programs: &Programs) -> bool {
    match &node.value {
        Value::String(text) => text.strip_prefix('=').is_some_and(|text| uses(text, programs, |name| name != "pi")),
        Value::Array(elements) => elements.iter().any(|element| has_expressions(element, programs)),
        Value::Object(members) => {
            values::kind_in(members).is_some() || members.values().any(|member| has_expressions(&member.node, programs))
        }
        _ => false,
    }
}

/// Whether an expression uses a name that satisfies a predicate. Invalid expressions count as using
/// one.
fn uses(expression: &str, programs: &Programs, predicate: impl Fn(&str) -> bool) -> bool {
    let program = programs.parse(expression).ok();
    program.is_none_or(|program| program.inputs().iter().any(|input| predicate(&input.name)))
}

/// Names of variables and paths that depend on time, and the search for their uses.
pub(crate) struct TimeDependence<'t> {
    names: BTreeSet<&'t str>,
    paths: BTreeSet<&'t str>,
    /// Number of time-dependent expressions found so far.
    expressions: usize,
    programs: &'t Programs,
}

impl<'t> TimeDependence<'t> {
    /// Finds the time-dependent variables and paths of a scene.
    pub fn from_tree(tree: &'t Node, programs: &'t Programs) -> Self {
        let names = BTreeSet::from(TIME_NAMES);
        let mut time_dependence = Self { names, paths: BTreeSet::new(), expressions: 0, programs };
        // Iterate to a fixed point: variables may use paths; paths may use variables and each
        // other.
        loop {
            let before = time_dependence.names.len() + time_dependence.paths.len();
            for (name, member) in tree.get("variables").into_iter().flat_map(Node::members) {
                if time_dependence.search(&member.node, true) {
                    time_dependence.names.insert(name);
                }
            }
            for (name, member) in tree.get("paths").into_iter().flat_map(Node::members) {
                if time_dependence.search(&member.node, false) {
                    time_dependence.paths.insert(name);
                }
            }
            if time_dependence.names.len() + time_dependence.paths.len() == before {
                return time_dependence;
            }
        }
    }

    /// Whether a value depends on time.
    pub fn depends_on_time(&mut self, node: &Node) -> bool {
        self.search(node, false)
    }

    /// Searches a whole value. `bare` accepts strings without a leading `=` as expressions.
    fn search(&mut self, node: &Node, bare: bool) -> bool {
        match &node.value {
            Value::String(text) => {
                let expression = text.strip_prefix('=').or_else(|| bare.then_some(text.as_str()));
                let depends =
                    expression.is_some_and(|text| uses(text, self.programs, |name| self.names.contains(name)));
                self.expressions += usize::from(depends);
                depends
            }
            Value::Array(elements) => elements.iter().filter(|element| self.search(element, bare)).count() > 0,
            Value::Object(members) => {
                let own =
                    values::kind_in(members).is_some_and(|_| uses_scene_time(node) || self.follows_animated_path(node));
                members.values().filter(|member| self.search(&member.node, false)).count() > 0 || own
            }
            _ => false,
        }
    }

    /// Whether a form follows a path that depends on time.
    fn follows_animated_path(&self, form: &Node) -> bool {
        let path = form.get("along").and_then(|content| content.get("path")?.as_str());
        path.is_some_and(|path| self.paths.contains(path))
    }
}

/// Whether a form has no time of its own (`at`) and is evaluated at the scene's time.
fn uses_scene_time(form: &Node) -> bool {
    ["animate", "posed"].iter().any(|kind| form.get(kind).is_some_and(|content| content.get("at").is_none()))
}
