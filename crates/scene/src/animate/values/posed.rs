//! Value form `posed`: place of a node of a model at a time.
//!
//! ```json
//! {"posed": {"file": "fox.glb", "node": "Head", "animation": "Run", "point": [0, 0, 0]}}
//! ```

use super::Kind;
use crate::animate::numbers;
use crate::animate::survey::FormSummary;
use crate::animate::tree_resolver::TreeResolver;
use crate::animate::value_source::Animatable;
use crate::document::{Node, Value};
use crate::model::{AnimationChoice, ModelChoice, ModelRepeat, NameOrIndex};
use crate::path::PathRef;
use crate::report::Finding;
use glam::{DAffine3, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Position, direction or matrix of a node of a model (glTF) in an animation clip.
///
/// The value is in the space of the model file. If the model's object has a transform, the follower
/// needs the same transform.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Posed {
    /// Model file, relative to the scene file.
    pub file: String,
    /// Name of the node, or the names of its ancestors and its own, separated by `/`, if several
    /// nodes have the name.
    pub node: String,
    /// Animation clip, by name or index; `"none"` for the rest pose. Defaults to the first clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub animation: Option<NameOrIndex>,
    /// Time in the clip. Defaults to the time of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "seconds"))]
    pub at: Option<Animatable<f64>>,
    /// What happens after the end of the clip.
    #[serde(default)]
    pub repeat: ModelRepeat,
    /// Point in the space of the node. The value is then its position: three numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "scene units"))]
    pub point: Option<[f64; 3]>,
    /// Vector in the space of the node. The value is then the transformed vector, three numbers: a
    /// direction. Without `point` and `vector`, the value has 12 numbers: the rows of the matrix
    /// from the space of the node to that of the file, as the transform step `matrix` takes them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vector: Option<[f64; 3]>,
}

pub const KIND: Kind = Kind { name: "posed", value };

fn value(resolver: &mut TreeResolver<'_>, content: &Node, at: &PathRef<'_>) -> Option<Node> {
    let posed: Posed = resolver.read("Posed", content, at)?;
    resolver.record_form(at, |form| FormSummary { node: Some(format!("{}: {}", posed.file, posed.node)), ..form });
    if posed.point.is_some() && posed.vector.is_some() {
        resolver.report_error(content, at, "`point` and `vector` exclude each other");
        return None;
    }
    match node_transform(resolver, &posed, content) {
        Ok(transform) => Some(numbers(posed.applied(&transform), content)),
        Err((key, faults)) => {
            let (at, node) = (at.key(key), content.get(key).unwrap_or(content));
            faults.into_iter().for_each(|fault| resolver.report(Finding::error(fault).at(&at).on(node.place)));
            None
        }
    }
}

/// Transform of the node, or the setting that is wrong, with messages.
fn node_transform(
    resolver: &TreeResolver<'_>,
    posed: &Posed,
    content: &Node,
) -> Result<DAffine3, (&'static str, Vec<String>)> {
    let place = content.get("file").and_then(|file| file.place);
    let sources = resolver.sources;
    let model = sources.asset_cache.model(&sources.locate(&posed.file, place));
    let file = model.file.as_ref().map_err(|faults| ("file", faults.clone()))?;
    let choice = ModelChoice {
        animation: AnimationChoice::from_setting(posed.animation.as_ref()),
        seconds: posed.at.as_ref().and_then(Animatable::value).unwrap_or_else(|| resolver.seconds()),
        repeat: posed.repeat,
        ..ModelChoice::default()
    };
    let transform = file.node_transform(&posed.node, &choice).map_err(|error| ("node", error.faults))?;
    if transform.is_finite() { Ok(transform) } else { Err(("node", vec!["the transform is not finite".to_owned()])) }
}

impl Posed {
    /// The numbers of the value.
    fn applied(&self, transform: &DAffine3) -> Vec<f64> {
        match (self.point, self.vector) {
            (Some(point), _) => transform.transform_point3(DVec3::from(point)).to_array().to_vec(),
            (None, Some(vector)) => transform.transform_vector3(DVec3::from(vector)).to_array().to_vec(),
            (None, None) => {
                let columns = [transform.x_axis, transform.y_axis, transform.z_axis, transform.translation];
                (0..3).flat_map(|row| columns.map(|column| column.to_array()[row])).collect()
            }
        }
    }
}

/// Names of the files in the forms of a tree, each with the node of the name.
pub fn posed_files<'n>(node: &'n Node, found: &mut Vec<(&'n str, &'n Node)>) {
    match &node.value {
        Value::Array(elements) => elements.iter().for_each(|element| posed_files(element, found)),
        Value::Object(members) => {
            let file = node.get(KIND.name).and_then(|content| content.get("file"));
            found.extend(file.and_then(|file| Some((file.as_str()?, file))));
            members.values().for_each(|member| posed_files(&member.node, found));
        }
        _ => {}
    }
}
