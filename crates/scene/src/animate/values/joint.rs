//! Value form `joint`: position of the joint of two bones.
//!
//! ```json
//! {"joint": {"from": [0, 0, 0], "to": [0, 4, 0], "lengths": [3, 2], "plane_normal": [0, 0, 1]}}
//! ```

use super::Kind;
use crate::animate::numbers;
use crate::animate::tree_resolver::TreeResolver;
use crate::animate::value_source::Animatable;
use crate::description::{Bones, positive_items};
use crate::document::Node;
use crate::path::PathRef;
use crate::report::Finding;
use juggler_math::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Position of the joint of two bones, as in a `limb`: an elbow or a knee, to place shapes along
/// the bones.
///
/// The bones bend from the line between the ends toward the direction of the cross product
/// (to − from) × `plane_normal`. The distance between the ends must not exceed the sum of the
/// lengths, nor fall below their difference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Joint {
    /// One end: a hand or a foot.
    #[schemars(extend("x-unit" = "scene units"))]
    pub from: Animatable<[f64; 3]>,
    /// Other end: a shoulder or a hip.
    #[schemars(extend("x-unit" = "scene units"))]
    pub to: Animatable<[f64; 3]>,
    /// Lengths of the bones at `from` and at `to`.
    #[schemars(transform = positive_items, extend("x-unit" = "scene units"))]
    pub lengths: Animatable<[f64; 2]>,
    /// Normal of the plane in which the bones bend, in the space of `from` and `to`. It has any
    /// length except zero and must not be parallel to `to − from`.
    pub plane_normal: Animatable<[f64; 3]>,
    /// Whether the bones keep their lengths if `plane_normal` is not perpendicular to `to − from`.
    /// With `false`, the joint moves closer to the line between the ends.
    #[serde(default = "yes")]
    pub keep_lengths: bool,
}

fn yes() -> bool {
    true
}

impl Joint {
    /// Creates the joint of two bones between `from` and `to`, which keep their lengths.
    pub fn new(
        from: impl Into<Animatable<[f64; 3]>>,
        to: impl Into<Animatable<[f64; 3]>>,
        lengths: impl Into<Animatable<[f64; 2]>>,
        plane_normal: impl Into<Animatable<[f64; 3]>>,
    ) -> Self {
        let [from, to, plane_normal] = [from.into(), to.into(), plane_normal.into()];
        Self { from, to, lengths: lengths.into(), plane_normal, keep_lengths: true }
    }
}

pub const KIND: Kind = Kind { name: "joint", value };

fn value(resolver: &mut TreeResolver<'_>, content: &Node, at: &PathRef<'_>) -> Option<Node> {
    let Joint { from, to, lengths, plane_normal, keep_lengths } = resolver.read("Joint", content, at)?;
    resolver.record_form(at, |track| track);
    let [from, to, plane_normal] = [from.value()?, to.value()?, plane_normal.value()?].map(DVec3::from);
    let lengths = lengths.value()?;
    match (Bones { from, to, lengths, plane_normal, keep_lengths }).joint() {
        Ok(joint) if joint.is_finite() => Some(numbers(joint.to_array(), content)),
        Ok(_) => {
            resolver.report_error(content, at, "these numbers are too large: the position of the joint is not finite");
            None
        }
        Err(wrong) => {
            let node = content.get(wrong.field).unwrap_or(content);
            resolver.report(Finding::error(wrong.message).at(at.join(wrong.field)).on(node.place));
            None
        }
    }
}
