//! Value forms: objects with one reserved key that stand wherever a value may stand, and become a value at each frame.
//!
//! To add one: write its file with the struct of its settings, which is its JSON, and its [`Kind`]; then a line in
//! [`ValueForm`] and one in [`KINDS`].

use super::walk::Walk;
use crate::document::{Members, Node};
use crate::path::Trail;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod along;
mod blend;
mod joint;
mod keys;
mod track;

pub use along::Along;
pub use joint::Joint;
pub use keys::{Key, MAX_KEYS};
pub use track::{Animate, Interpolation, Repeat};

/// Stands wherever a value may stand, in `variables` and inside each other too, and becomes a value at each frame.
/// Everything inside may be an expression.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ValueForm {
    /// A value that changes from key to key.
    Animate(Animate),
    /// A point on one of the scene's paths: three numbers.
    Along(Along),
    /// Where two bones meet: three numbers.
    Joint(Joint),
}

/// All value forms.
pub const KINDS: [Kind; 3] = [track::KIND, along::KIND, joint::KIND];

/// A value form as the walk uses it.
pub struct Kind {
    /// Its reserved key.
    pub name: &'static str,
    /// Its value, from its content; nothing when something is wrong with it, which is then reported. The value's place is
    /// where to look when it does not fit.
    pub value: fn(&mut Walk<'_>, &Node, &Trail<'_>) -> Option<Node>,
}

/// The form that an object is, or was meant to be.
pub fn kind_in(members: &Members) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| members.contains_key(kind.name))
}
