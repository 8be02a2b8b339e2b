//! Animations (glTF 2.0, section 3.11; KHR_animation_pointer) and skins (section 3.7.3).

use super::number::Index;
use crate::gltf::pose;
use serde::Deserialize;

/// An animation.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Animation {
    /// Animated properties with their samplers.
    pub channels: Vec<Channel>,
    /// Keys and interpolation.
    pub samplers: Vec<KeySampler>,
    /// Name for people.
    pub name: Option<String>,
}

/// An animated property.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Channel {
    /// Index into the samplers of the animation.
    pub sampler: Index,
    /// The property.
    pub target: ChannelTarget,
}

/// Property that a channel animates.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct ChannelTarget {
    /// Index of the node; a channel without node is skipped.
    pub node: Option<Index>,
    /// `translation`, `rotation`, `scale`, `weights` or `pointer`.
    pub path: String,
    /// Extensions.
    #[serde(default)]
    pub extensions: ChannelTargetExtensions,
}

/// Extensions of the target of a channel.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct ChannelTargetExtensions {
    /// Property of the document.
    #[serde(rename = "KHR_animation_pointer")]
    pub pointer: Option<PointerTarget>,
}

/// Property of the document by its JSON pointer.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct PointerTarget {
    /// JSON pointer, such as `/materials/0/emissiveFactor`.
    pub pointer: String,
}

/// Keys of an animation.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct KeySampler {
    /// Accessor of the times in seconds.
    pub input: Index,
    /// Accessor of the values.
    pub output: Index,
    /// Interpolation between keys.
    #[serde(default)]
    pub interpolation: Interpolation,
}

/// Interpolation between keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Interpolation {
    /// The value of the earlier key.
    #[serde(rename = "STEP")]
    Step,
    /// Linear, of rotations spherical linear.
    #[default]
    #[serde(rename = "LINEAR")]
    Linear,
    /// Cubic spline with tangents.
    #[serde(rename = "CUBICSPLINE")]
    CubicSpline,
}

impl From<Interpolation> for pose::Interpolation {
    fn from(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Step => Self::Step,
            Interpolation::Linear => Self::Linear,
            Interpolation::CubicSpline => Self::CubicSpline,
        }
    }
}

/// A skin: nodes that move vertices.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Skin {
    /// Accessor of the inverse bind matrices; without, they are the identity.
    pub inverse_bind_matrices: Option<Index>,
    /// Node at the root of the skeleton; it has no effect.
    pub skeleton: Option<Index>,
    /// Indices of the joints' nodes.
    pub joints: Vec<Index>,
    /// Name for people.
    pub name: Option<String>,
}
