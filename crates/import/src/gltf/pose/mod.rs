//! Poses: animation curves and clips, node transforms, skins and morph targets (glTF 2.0, sections
//! 3.5, 3.7.2.2, 3.7.3, 3.11 and appendix C; KHR_animation_pointer; KHR_node_visibility).
//!
//! The modules take plain numbers, not a glTF document. All computations are in double precision
//! and give the same bits on every machine; deformed vertices are rounded to single precision once.
//!
//! | step | function |
//! |---|---|
//! | map a time to the time of a clip | [`Clip::local_time`] |
//! | evaluate the channels of a clip | [`Clip::pose`] |
//! | compute the transform of each node to its parent | [`NodeTransform::to_parent`] |
//! | compute the transforms of all nodes to world space | [`Hierarchy::world_transforms`] |
//! | select the weights of morph targets | [`WeightSources::resolve`] |
//! | compute the matrices of joints | [`Skin::joint_matrices`] |
//! | morph and skin a mesh | [`deform`] |

mod channel;
mod clip;
mod curve;
mod deform;
mod hierarchy;
mod matrix;
mod morph;
mod node;
mod skin;
mod surface_normals;
mod target;
mod vertices;
mod weights;

#[cfg(test)]
mod testing;

pub use channel::{Channel, ChannelError};
pub use clip::{Clip, NodePose, Pose, Repeat};
pub use curve::{Curve, CurveError, Interpolation};
pub use deform::{DeformError, Deformed, MorphBinding, deform};
pub use hierarchy::{Hierarchy, HierarchyError};
pub use matrix::{MatrixError, affine_from_columns, inverse, is_invertible, normal_matrix};
pub use morph::MorphError;
pub use node::{NodeError, NodeTransform};
pub use skin::{InfluenceSet, Skin, SkinBinding, SkinError};
pub use target::{ChannelTarget, NodeProperty};
pub use vertices::{MorphDeltas, Vertices};
pub use weights::{AnimatedWeights, WeightSources};
