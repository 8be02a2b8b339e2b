//! Paths of a scene: named curves. Each is resolved once, on first use or after all variables.

use super::curve::Curve;
use super::tree_resolver::TreeResolver;
use crate::document::{Members, Node, Value};
use crate::path::PathRef;
use juggler_math::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Maximum number of points of a path.
pub const MAX_POINTS: usize = 10_000;

/// Name of a curve in the scene's `paths`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PathName(pub String);

/// Paths of a scene with their state of resolution.
pub(super) struct Paths<'s> {
    written: Option<&'s Arc<Members>>,
    known: BTreeMap<&'s str, PathState>,
}

/// State of resolution of a path.
enum PathState {
    /// The path is being resolved.
    InProgress,
    /// The path is resolved; `None` if it has no expressions.
    Node(Option<Node>),
    /// The curve is built, too; `None` if the path is invalid, which validation reports.
    Curve(Option<Node>, Option<Arc<Curve>>),
}

/// Result of a search for a path.
pub(super) enum PathLookup {
    /// Curve of the path.
    Found(Arc<Curve>),
    /// The path is invalid, which validation reports.
    Invalid,
    /// The path depends on itself.
    Cyclic,
    /// No path has this name.
    Missing,
}

impl<'s> Paths<'s> {
    pub fn from_tree(tree: &'s Node) -> Self {
        let written = match tree.get("paths").map(|paths| &paths.value) {
            Some(Value::Object(members)) => Some(members),
            _ => None,
        };
        Self { written, known: BTreeMap::new() }
    }

    /// Names of all paths.
    pub fn names(&self) -> impl Iterator<Item = &'s str> + Clone + use<'s> {
        self.written.into_iter().flat_map(|members| members.keys()).map(String::as_str)
    }
}

impl<'s> TreeResolver<'s> {
    /// Returns the curve of a path. Resolves the path on first use.
    pub fn curve(&mut self, name: &str) -> PathLookup {
        let Some((key, member)) = self.paths.written.and_then(|written| written.get_key_value(name)) else {
            return PathLookup::Missing;
        };
        self.resolve_path(key, &member.node);
        let node = match self.paths.known.get_mut(key.as_str()) {
            Some(PathState::Node(node)) => node.take(),
            Some(PathState::Curve(_, curve)) => return curve.clone().map_or(PathLookup::Invalid, PathLookup::Found),
            _ => return PathLookup::Cyclic,
        };
        let curve = curve_from_json(node.as_ref().unwrap_or(&member.node)).map(Arc::new);
        self.paths.known.insert(key, PathState::Curve(node, curve.clone()));
        curve.map_or(PathLookup::Invalid, PathLookup::Found)
    }

    /// Resolves all paths; `None` if no path has expressions.
    pub fn all_paths(&mut self) -> Option<Arc<Members>> {
        let written = self.paths.written?;
        let mut resolved: Option<Members> = None;
        for (i, (name, member)) in written.iter().enumerate() {
            self.resolve_path(name, &member.node);
            let (Some(PathState::Node(node)) | Some(PathState::Curve(node, _))) = self.paths.known.get(name.as_str())
            else {
                continue;
            };
            if let Some(node) = node {
                let resolved = resolved.get_or_insert_with(|| (**written).clone());
                if let Some(member) = resolved.at_mut(i) {
                    member.node = node.clone();
                }
            }
        }
        resolved.map(Arc::new)
    }

    /// Resolves a path, unless that is done or in progress.
    fn resolve_path(&mut self, name: &'s str, node: &'s Node) {
        if self.paths.known.contains_key(name) {
            return;
        }
        self.paths.known.insert(name, PathState::InProgress);
        let resolved = self.node(node, &PathRef::Root.key("paths").key(name));
        self.paths.known.insert(name, PathState::Node(resolved));
    }
}

/// Builds the curve of a resolved path; `None` if the path does not fit the schema.
fn curve_from_json(path: &Node) -> Option<Curve> {
    let closed = match path.get("closed").map(|closed| &closed.value) {
        None => false,
        Some(Value::Bool(closed)) => *closed,
        Some(_) => return None,
    };
    let points = path.get("points")?.elements();
    if points.len() > MAX_POINTS {
        return None;
    }
    Curve::from_points(points.iter().map(point).collect::<Option<Vec<DVec3>>>()?, closed)
}

fn point(node: &Node) -> Option<DVec3> {
    let coordinate = |node: &Node| match &node.value {
        // Round to 32 bits, the precision of all scene data: distances neither vanish nor overflow.
        Value::Number(number) => number.as_f64().map(|value| f64::from(value as f32)).filter(|value| value.is_finite()),
        _ => None,
    };
    match node.elements() {
        [x, y, z] => Some(DVec3::new(coordinate(x)?, coordinate(y)?, coordinate(z)?)),
        _ => None,
    }
}
