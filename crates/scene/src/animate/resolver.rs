//! Evaluates single values of a scene for one frame. Variables and paths are evaluated once.

use super::tree_resolver::TreeResolver;
use super::{Programs, SceneSources, predefined_names};
use crate::document::{Node, Value};
use crate::path::PathRef;
use crate::report::Finding;
use crate::validate;
use juggler_expression::Program;

/// Evaluates values for one frame.
pub(crate) struct Resolver<'s> {
    resolver: TreeResolver<'s>,
}

impl<'s> Resolver<'s> {
    /// Creates a resolver for a frame. `head` holds the scene's `animation`, `variables` and
    /// `paths`, `programs` the scene's compiled expressions.
    pub fn new(head: &'s Node, sources: SceneSources<'s>, programs: &'s Programs, frame: f64) -> Self {
        let mut resolver = TreeResolver::new(head, sources, programs, predefined_names(head, frame));
        resolver.variables();
        if let Some(paths) = resolver.all_paths() {
            let paths = Node { place: None, value: Value::Object(paths) };
            let at = PathRef::Root.key("paths");
            let checked = validate::item(&paths, &(&at).into(), &at, validate::NameScope::Tree(head), 0);
            checked.findings.into_iter().for_each(|finding| resolver.report(finding));
        }
        Self { resolver }
    }

    /// Evaluates a value; messages report it at the path `at`.
    pub fn value(&mut self, node: &Node, at: &PathRef<'_>) -> Node {
        self.resolver.node(node, at).unwrap_or_else(|| node.clone())
    }

    /// Value of a compiled expression, as JSON would hold it; `None` for an expression that is
    /// wrong or has no value.
    pub fn number(&mut self, program: &Program) -> Option<f64> {
        // JSON has no negative zero among whole numbers.
        self.resolver.number(program).map(|value| value + 0.0)
    }

    /// Returns all findings.
    pub fn finish(self) -> Vec<Finding> {
        self.resolver.findings
    }
}
