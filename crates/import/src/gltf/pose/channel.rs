//! Animation channels: a curve and the property that it animates.

use super::curve::{Curve, CurveError};
use super::target::{ChannelTarget, NodeProperty};

/// Error of an animation channel.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChannelError {
    /// The curve has another number of components than the target.
    #[error("the keys have {found} components; the target has {expected}")]
    Components {
        /// Number of components of the curve.
        found: usize,
        /// Number of components of the target.
        expected: usize,
    },
    /// The keys are not those of the target.
    #[error(transparent)]
    Curve(#[from] CurveError),
}

/// A curve with the property that it animates.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    target: ChannelTarget,
    curve: Curve,
}

impl Channel {
    /// Constructs a channel. The curve must have as many components as the target, and rotations
    /// must not be 0.
    pub fn new(target: ChannelTarget, curve: Curve) -> Result<Self, ChannelError> {
        let found = curve.components();
        match target.components() {
            Some(expected) if expected != found => return Err(ChannelError::Components { found, expected }),
            _ => {}
        }
        if is_rotation(&target) {
            curve.check_rotations()?;
        }
        Ok(Self { target, curve })
    }

    /// The animated property.
    pub fn target(&self) -> &ChannelTarget {
        &self.target
    }

    /// The curve.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// Number of quaternions among the keys whose length deviates from 1 by more than 1e-3; 0 if
    /// the target is no rotation. Evaluation normalizes them.
    pub fn unnormalized_rotations(&self) -> usize {
        if is_rotation(&self.target) { self.curve.unnormalized_rotations() } else { 0 }
    }
}

fn is_rotation(target: &ChannelTarget) -> bool {
    matches!(target, ChannelTarget::Node { property: NodeProperty::Rotation, .. })
}

#[cfg(test)]
mod tests {
    use super::super::curve::Interpolation;
    use super::*;

    fn channel(pointer: &str, components: usize, value: f32) -> Result<Channel, ChannelError> {
        let curve = Curve::new(vec![0.0], vec![value; components], components, Interpolation::Linear).unwrap();
        Channel::new(ChannelTarget::from_pointer(pointer), curve)
    }

    #[test]
    fn number_of_components_follows_from_the_target() {
        for (pointer, components) in [
            ("/nodes/0/translation", 3),
            ("/nodes/0/rotation", 4),
            ("/nodes/0/scale", 3),
            ("/nodes/0/weights/3", 1),
            ("/nodes/0/extensions/KHR_node_visibility/visible", 1),
            ("/meshes/0/weights/3", 1),
        ] {
            assert!(channel(pointer, components, 0.5).is_ok(), "{pointer}");
            let error = channel(pointer, components + 1, 0.5).unwrap_err();
            assert_eq!(error, ChannelError::Components { found: components + 1, expected: components });
        }
        assert!(channel("/nodes/0/weights", 7, 0.5).is_ok() && channel("/materials/0/x", 5, 0.5).is_ok());
    }

    #[test]
    fn rotations_are_not_zero() {
        let error = channel("/nodes/0/rotation", 4, 0.0).unwrap_err();
        assert_eq!(error.to_string(), "the quaternion of key 0 is 0 0 0 0, which is no rotation");
        assert_eq!(channel("/nodes/0/rotation", 4, 0.6).unwrap().unnormalized_rotations(), 1);
        assert_eq!(channel("/nodes/0/rotation", 4, 0.5).unwrap().unnormalized_rotations(), 0);
        assert_eq!(channel("/materials/0/x", 4, 0.6).unwrap().unnormalized_rotations(), 0);
    }
}
