//! The scene's paths: resolved once each, when somebody asks for them or after all variables.

use super::curve::Curve;
use super::walk::Walk;
use crate::document::{Members, Node, Value};
use crate::path::Trail;
use juggler_math::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Most points of a path.
pub const MAX_POINTS: usize = 10_000;

/// Name of one of the scene's paths.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PathName(pub String);

/// The paths of a scene, as far as they are known.
pub(super) struct Paths<'s> {
    written: Option<&'s Arc<Members>>,
    known: BTreeMap<&'s str, Known>,
}

/// What is known of a path.
enum Known {
    /// It is being resolved.
    Open,
    /// It is resolved; the node is there when that changed anything.
    Node(Option<Node>),
    /// The curve, too; nothing when the path is wrong, which others report.
    Curve(Option<Node>, Option<Arc<Curve>>),
}

/// What becomes of the search for a path.
pub(super) enum Search {
    /// There it is.
    Found(Arc<Curve>),
    /// Something is wrong with it, which is reported where it stands.
    Wrong,
    /// It is needed for itself.
    Open,
    /// No path has this name.
    Missing,
}

impl<'s> Paths<'s> {
    pub fn of(tree: &'s Node) -> Self {
        let written = match tree.get("paths").map(|paths| &paths.value) {
            Some(Value::Object(members)) => Some(members),
            _ => None,
        };
        Self { written, known: BTreeMap::new() }
    }

    /// What the paths are called.
    pub fn names(&self) -> impl Iterator<Item = &'s str> + Clone + use<'s> {
        self.written.into_iter().flat_map(|members| members.keys()).map(String::as_str)
    }
}

impl<'s> Walk<'s> {
    /// The curve of a path.
    pub fn curve(&mut self, name: &str) -> Search {
        let Some((key, member)) = self.paths.written.and_then(|written| written.get_key_value(name)) else {
            return Search::Missing;
        };
        self.resolve_path(key, &member.node);
        let node = match self.paths.known.get_mut(key.as_str()) {
            Some(Known::Node(node)) => node.take(),
            Some(Known::Curve(_, curve)) => return curve.clone().map_or(Search::Wrong, Search::Found),
            _ => return Search::Open,
        };
        let curve = curve_of(node.as_ref().unwrap_or(&member.node)).map(Arc::new);
        self.paths.known.insert(key, Known::Curve(node, curve.clone()));
        curve.map_or(Search::Wrong, Search::Found)
    }

    /// All paths with values for expressions; nothing when they can stay as they are.
    pub fn all_paths(&mut self) -> Option<Arc<Members>> {
        let written = self.paths.written?;
        let mut resolved: Option<Members> = None;
        for (i, (name, member)) in written.iter().enumerate() {
            self.resolve_path(name, &member.node);
            let (Some(Known::Node(node)) | Some(Known::Curve(node, _))) = self.paths.known.get(name.as_str()) else {
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

    /// Puts values in place of a path's expressions, unless that has been done or is being done.
    fn resolve_path(&mut self, name: &'s str, node: &'s Node) {
        if self.paths.known.contains_key(name) {
            return;
        }
        self.paths.known.insert(name, Known::Open);
        let resolved = self.node(node, &Trail::Root.key("paths").key(name));
        self.paths.known.insert(name, Known::Node(resolved));
    }
}

/// The curve of a path as it stands; nothing when it does not fit the schema.
fn curve_of(path: &Node) -> Option<Curve> {
    let closed = match path.get("closed").map(|closed| &closed.value) {
        None => false,
        Some(Value::Bool(closed)) => *closed,
        Some(_) => return None,
    };
    let points = path.get("points")?.elements();
    if points.len() > MAX_POINTS {
        return None;
    }
    Curve::through(points.iter().map(point).collect::<Option<Vec<DVec3>>>()?, closed)
}

fn point(node: &Node) -> Option<DVec3> {
    let coordinate = |node: &Node| match &node.value {
        // What 32 bits can hold, as everywhere in a scene: so that distances neither vanish nor overflow.
        Value::Number(number) => number.as_f64().map(|value| f64::from(value as f32)).filter(|value| value.is_finite()),
        _ => None,
    };
    match node.elements() {
        [x, y, z] => Some(DVec3::new(coordinate(x)?, coordinate(y)?, coordinate(z)?)),
        _ => None,
    }
}
