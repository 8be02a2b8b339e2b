//! Single values of a scene, worked out for one frame: the scene's variables and paths are looked at once, then as many
//! values as are wanted.

use super::walk::Walk;
use super::{Programs, given};
use crate::document::{Node, Sources, Value};
use crate::path::Trail;
use crate::report::Finding;
use crate::validate;
use juggler_expression::Program;

/// Works out values for one frame.
pub(crate) struct Resolver<'s> {
    walk: Walk<'s>,
}

impl<'s> Resolver<'s> {
    /// For a frame of the scene whose `animation`, `variables` and `paths` `head` holds. `sources` are the texts that
    /// they were read from, `programs` the scene's compiled expressions.
    pub fn new(head: &'s Node, sources: &'s Sources, programs: &'s Programs, frame: f64) -> Self {
        let mut walk = Walk::new(head, sources, programs, given(head, frame));
        walk.variables();
        if let Some(paths) = walk.all_paths() {
            let paths = Node { place: None, value: Value::Object(paths) };
            let at = Trail::Root.key("paths");
            let checked = validate::item(&paths, &(&at).into(), &at, validate::NameScope::Tree(head));
            checked.findings.into_iter().for_each(|finding| walk.report(finding));
        }
        Self { walk }
    }

    /// The value at the frame; `at` is where messages say that it stands.
    pub fn value(&mut self, node: &Node, at: &Trail<'_>) -> Node {
        self.walk.node(node, at).unwrap_or_else(|| node.clone())
    }

    /// Value of a compiled expression, as JSON would hold it; `None` for an expression that is wrong or has no value.
    pub fn number(&mut self, program: &Program) -> Option<f64> {
        // JSON has no negative zero among whole numbers.
        self.walk.number(program).map(|value| value + 0.0)
    }

    /// All that was wrong.
    pub fn finish(self) -> Vec<Finding> {
        self.walk.findings
    }
}
