//! Value forms: objects with one reserved key that replace a value and are evaluated at each frame.
//!
//! To add a form, write its file with the struct of its settings, which defines its JSON, and its
//! [`Kind`]; then add a line to [`ValueForm`] and one to [`KINDS`].

use super::tree_resolver::TreeResolver;
use crate::document::{Members, Node};
use crate::path::PathRef;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod along;
mod blend;
mod joint;
mod keys;
mod posed;
mod track;

pub use along::Along;
pub use joint::Joint;
pub use keys::{Key, MAX_KEYS};
pub use posed::Posed;
pub(crate) use posed::posed_files;
pub use track::{Animate, Extrapolation, Interpolation};

/// Value form, which may replace a value, also in `variables` and inside other value forms, and
/// is evaluated at each frame. All values inside may be expressions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ValueForm {
    /// Value interpolated between keys.
    Animate(Animate),
    /// Point on a path of the scene: three numbers.
    Along(Along),
    /// Position of the joint of two bones: three numbers.
    Joint(Joint),
    /// Place of a node of a model (glTF) in a clip, in the space of the model file: three numbers, or
    /// the 12 of a matrix. Lights, cameras and objects follow the node with it.
    Posed(Posed),
}

/// All value forms.
pub const KINDS: [Kind; 4] = [track::KIND, along::KIND, joint::KIND, posed::KIND];

/// Value form, as the traversal uses it.
pub struct Kind {
    /// Reserved key.
    pub name: &'static str,
    /// Evaluates the form's content, whose expressions are resolved. Returns `None` after an error,
    /// which the function reports. Later errors refer to the source location of the returned value.
    pub value: fn(&mut TreeResolver<'_>, &Node, &PathRef<'_>) -> Option<Node>,
}

/// Value form whose reserved key an object has.
pub fn kind_in(members: &Members) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| members.contains_key(kind.name))
}
