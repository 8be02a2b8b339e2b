//! Where two bones meet.
//!
//! ```json
//! {"joint": {"from": [0, 0, 0], "to": [0, 4, 0], "lengths": [3, 2], "plane_normal": [0, 0, 1]}}
//! ```

use super::Kind;
use crate::animate::numbers;
use crate::animate::walk::Walk;
use crate::description::{Bones, positive_items};
use crate::document::Node;
use crate::path::Trail;
use crate::report::Finding;
use juggler_math::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where two bones meet, as for the object `limb`: an elbow or a knee, to put anything along the bones.
///
/// It lies in the plane through `from` that `plane_normal` is perpendicular to, on the side of the cross product
/// (to − from) × normal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Joint {
    /// One end: a hand or a foot.
    pub from: [f64; 3],
    /// The other end: a shoulder or a hip.
    pub to: [f64; 3],
    /// Lengths of the bone at `from` and of the bone at `to`.
    #[schemars(transform = positive_items)]
    pub lengths: [f64; 2],
    /// Normal of the plane in which the bones bend; need not be unit.
    pub plane_normal: [f64; 3],
    /// Whether the bones keep their lengths although `plane_normal` is not perpendicular to the line between the
    /// ends. Without it the joint comes nearer to that line.
    #[serde(default = "yes")]
    pub keep_lengths: bool,
}

fn yes() -> bool {
    true
}

pub const KIND: Kind = Kind { name: "joint", value };

fn value(walk: &mut Walk<'_>, content: &Node, at: &Trail<'_>) -> Option<Node> {
    let Joint { from, to, lengths, plane_normal, keep_lengths } = walk.read("Joint", content, at)?;
    walk.note(at, |track| track);
    let [from, to, plane_normal] = [from, to, plane_normal].map(DVec3::from);
    match (Bones { from, to, lengths, plane_normal, keep_lengths }).joint() {
        Ok(joint) if joint.is_finite() => Some(numbers(joint.to_array(), content)),
        Ok(_) => {
            walk.wrong(content, at, "these numbers are too large: the joint has no place");
            None
        }
        Err(wrong) => {
            let node = content.get(wrong.field).unwrap_or(content);
            walk.report(Finding::error(wrong.message).at(at.join(wrong.field)).on(node.place));
            None
        }
    }
}
