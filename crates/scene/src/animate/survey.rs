//! What moves in a scene: its value forms for people to read, and whether anything changes with time.

use super::values::{self, Interpolation, Repeat};
use super::walk::Walk;
use super::{CHANGING, PLAIN, Programs};
use crate::document::{Node, Value};
use crate::path::{Path, Trail};
use std::collections::BTreeSet;

/// What moves in a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Its value forms, in the order in which they are resolved.
    pub tracks: Vec<Track>,
    /// Expressions that depend on time, by themselves or through variables.
    pub expressions: usize,
}

/// A value form of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Where it stands.
    pub path: Path,
    /// Its reserved key: `animate`.
    pub kind: String,
    /// How many keys it has.
    pub keys: Option<usize>,
    /// The times of the first and the last key.
    pub span: Option<[f64; 2]>,
    /// What lies between the keys.
    pub interpolation: Option<Interpolation>,
    /// What lies outside of them.
    pub repeat: Option<Repeat>,
    /// The path that it goes along.
    pub along: Option<String>,
}

impl Walk<'_> {
    /// Writes down a value form whose content stands at `at`, where somebody asks for them.
    pub fn note(&mut self, at: &Trail<'_>, fill: impl FnOnce(Track) -> Track) {
        let Some(tracks) = &mut self.tracks else { return };
        let (Trail::Key(outer, _) | Trail::Index(outer, _)) = at else { return };
        let kind = at.last_key().unwrap_or_default().to_owned();
        tracks.push(fill(Track { path: Path::from(*outer), kind, ..Track::default() }));
    }
}

/// Whether anything in a tree may change with the frame. Variables that nothing uses do not count.
pub fn depends_on_time(tree: &Node) -> bool {
    let programs = Programs::default();
    let mut changes = TimeDependence::of(tree, &programs);
    parts(tree).any(|part| changes.holds(part))
}

/// How many expressions depend on time.
pub(super) fn changing_expressions(tree: &Node, programs: &Programs) -> usize {
    let mut changes = TimeDependence::of(tree, programs);
    changes.expressions = 0;
    for (_, variable) in tree.get("variables").into_iter().flat_map(Node::members) {
        changes.search(&variable.node, true);
    }
    parts(tree).for_each(|part| {
        changes.holds(part);
    });
    changes.expressions
}

/// The parts of a scene in which things may move.
fn parts(tree: &Node) -> impl Iterator<Item = &Node> {
    let moves = |key: &str| key == "paths" || !PLAIN.contains(&key);
    tree.members().filter(move |(key, _)| moves(key)).map(|(_, member)| &member.node)
}

/// Whether a value may differ from scene to scene: it holds a value form, or an expression that
/// uses a name other than
/// `pi`.
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

/// Whether an expression uses a name that satisfies a predicate. An expression that is no program,
/// because of an error, counts as one that does.
fn uses(expression: &str, programs: &Programs, is_wanted: impl Fn(&str) -> bool) -> bool {
    let program = programs.parse(expression).ok();
    program.is_none_or(|program| program.inputs().iter().any(|input| is_wanted(&input.name)))
}

/// What changes with time, by name: the search for it in values.
pub(crate) struct TimeDependence<'t> {
    names: BTreeSet<&'t str>,
    paths: BTreeSet<&'t str>,
    /// Expressions that changed so far.
    expressions: usize,
    programs: &'t Programs,
}

impl<'t> TimeDependence<'t> {
    /// By the variables and paths of a scene, and its compiled expressions.
    pub fn of(tree: &'t Node, programs: &'t Programs) -> Self {
        let names = BTreeSet::from(CHANGING);
        let mut changing = Self { names, paths: BTreeSet::new(), expressions: 0, programs };
        // Variables may ask for paths, and paths for variables and for each other: until nothing is added.
        loop {
            let before = changing.names.len() + changing.paths.len();
            for (name, member) in tree.get("variables").into_iter().flat_map(Node::members) {
                if changing.search(&member.node, true) {
                    changing.names.insert(name);
                }
            }
            for (name, member) in tree.get("paths").into_iter().flat_map(Node::members) {
                if changing.search(&member.node, false) {
                    changing.paths.insert(name);
                }
            }
            if changing.names.len() + changing.paths.len() == before {
                return changing;
            }
        }
    }

    /// Whether a value changes with time.
    pub fn holds(&mut self, node: &Node) -> bool {
        self.search(node, false)
    }

    /// All of a value is looked at; `bare` where texts are expressions without a sign in front, too.
    fn search(&mut self, node: &Node, bare: bool) -> bool {
        match &node.value {
            Value::String(text) => {
                let expression = text.strip_prefix('=').or_else(|| bare.then_some(text.as_str()));
                let changes =
                    expression.is_some_and(|text| uses(text, self.programs, |name| self.names.contains(name)));
                self.expressions += usize::from(changes);
                changes
            }
            Value::Array(elements) => elements.iter().filter(|element| self.search(element, bare)).count() > 0,
            Value::Object(members) => {
                let own = values::kind_in(members).is_some_and(|_| looks_up_seconds(node) || self.goes_along(node));
                members.values().filter(|member| self.search(&member.node, false)).count() > 0 || own
            }
            _ => false,
        }
    }

    /// Whether a form follows a path that changes.
    fn goes_along(&self, form: &Node) -> bool {
        let path = form.get("along").and_then(|content| content.get("path")?.as_str());
        path.is_some_and(|path| self.paths.contains(path))
    }
}

/// Whether it is a track that says nothing of the time that it looks up.
fn looks_up_seconds(form: &Node) -> bool {
    form.get("animate").is_some_and(|content| content.get("at").is_none())
}
