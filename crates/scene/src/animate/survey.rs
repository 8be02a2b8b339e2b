//! What moves in a scene: its value forms for people to read, and whether anything changes with time.

use super::values::{self, Interpolation, Repeat};
use super::walk::Walk;
use super::{CHANGING, PLAIN};
use crate::document::{Node, Value};
use crate::expression::names_in;
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
    let mut search = Search::after_variables(tree);
    parts(tree).any(|part| search.changes(part, false))
}

/// How many expressions depend on time.
pub(super) fn changing_expressions(tree: &Node) -> usize {
    let mut search = Search::after_variables(tree);
    parts(tree).for_each(|part| {
        search.changes(part, false);
    });
    search.expressions
}

/// The parts of a scene in which things may move.
fn parts(tree: &Node) -> impl Iterator<Item = &Node> {
    let moves = |key: &str| key == "paths" || !PLAIN.contains(&key);
    tree.members().filter(move |(key, _)| moves(key)).map(|(_, member)| &member.node)
}

struct Search<'t> {
    /// Names whose values change with time.
    changing: BTreeSet<&'t str>,
    /// Expressions that changed so far.
    expressions: usize,
}

impl<'t> Search<'t> {
    fn after_variables(tree: &'t Node) -> Self {
        let mut search = Self { changing: BTreeSet::from(CHANGING), expressions: 0 };
        for (name, member) in tree.get("variables").into_iter().flat_map(Node::members) {
            if search.changes(&member.node, true) {
                search.changing.insert(name);
            }
        }
        search
    }

    /// Whether a value changes with time, all of it looked at; `bare` where texts are expressions without a sign in front, too.
    fn changes(&mut self, node: &Node, bare: bool) -> bool {
        match &node.value {
            Value::String(text) => {
                let expression = text.strip_prefix('=').or_else(|| bare.then_some(text.as_str()));
                let changes = expression.is_some_and(|text| names_in(text).any(|name| self.changing.contains(name)));
                self.expressions += usize::from(changes);
                changes
            }
            Value::Array(elements) => elements.iter().filter(|element| self.changes(element, bare)).count() > 0,
            Value::Object(members) => {
                let own = values::kind_in(members).is_some_and(|_| looks_up_seconds(node));
                members.values().filter(|member| self.changes(&member.node, false)).count() > 0 || own
            }
            _ => false,
        }
    }
}

/// Whether it is a track that says nothing of the time that it looks up.
fn looks_up_seconds(form: &Node) -> bool {
    form.get("animate").is_some_and(|content| content.get("at").is_none())
}
