//! Checks of skins and animations.

use super::checker::Checker;
use crate::gltf::document::ComponentType::{F32, I8, I16, U8, U16};
use crate::gltf::document::ElementType::{Mat4, Scalar, Vec2, Vec3, Vec4};
use crate::gltf::document::{Animation, Channel, ElementType, Interpolation};
use crate::gltf::location::Location;

/// Types of the values that a pointer may animate.
const POINTER_TYPES: &[ElementType] = &[Scalar, Vec2, Vec3, Vec4];

impl Checker<'_> {
    /// Checks the joints and matrices of skins.
    pub(super) fn skins(&mut self) {
        let document = self.document;
        let list = Location::root("skins");
        for (position, skin) in document.skins.iter().enumerate() {
            let at = list.index(position);
            let joints = at.key("joints");
            if skin.joints.is_empty() {
                self.fault(&joints, format_args!("there are no joints"));
            }
            self.count(&joints, skin.joints.len() as u64, self.limits.joints as u64, "joints");
            for (position, joint) in skin.joints.iter().enumerate() {
                self.index(&joints.index(position), *joint, document.nodes.len(), "node");
            }
            self.unique(&joints, &skin.joints);
            self.index(&at.key("skeleton"), skin.skeleton, document.nodes.len(), "node");
            let Some(matrices) = skin.inverse_bind_matrices else { continue };
            let at = at.key("inverseBindMatrices");
            let Some(accessor) = self.typed(&at, matrices, &[Mat4], &[F32]) else { continue };
            let (count, joints) = (accessor.count, skin.joints.len());
            if count.get() < joints as u64 {
                self.fault(&at, format_args!("accessor {matrices} has {count} matrices for {joints} joints"));
            }
        }
    }

    /// Checks the samplers and channels of animations.
    pub(super) fn animations(&mut self) {
        let list = Location::root("animations");
        for (position, animation) in self.document.animations.iter().enumerate() {
            let at = list.index(position);
            let samplers = at.key("samplers");
            for (position, sampler) in animation.samplers.iter().enumerate() {
                let at = samplers.index(position);
                let input = at.key("input");
                if let Some(accessor) = self.typed(&input, sampler.input, &[Scalar], &[F32]) {
                    let keys = accessor.count.get();
                    self.count(&input, keys, self.limits.keys, "keys");
                }
                let count = self.document.accessors.len();
                self.index(&at.key("output"), sampler.output, count, "accessor");
            }
            let channels = at.key("channels");
            self.count(&channels, animation.channels.len() as u64, self.limits.channels as u64, "channels");
            for (position, channel) in animation.channels.iter().enumerate() {
                self.channel(&channels.index(position), animation, channel);
            }
        }
    }

    /// Checks the target of a channel and the type of its values.
    fn channel(&mut self, at: &Location<'_>, animation: &Animation, channel: &Channel) {
        self.index(&at.key("sampler"), channel.sampler, animation.samplers.len(), "sampler");
        let target = at.key("target");
        self.index(&target.key("node"), channel.target.node, self.document.nodes.len(), "node");
        let mesh = channel.target.node.and_then(|node| self.document.nodes.get(node.get())).and_then(|node| node.mesh);
        let (types, per_key): (&[ElementType], usize) = match channel.target.path.as_str() {
            "translation" | "scale" => (&[Vec3], 1),
            "rotation" => (&[Vec4], 1),
            "weights" if channel.target.node.is_none() => return,
            "weights" => (&[Scalar], self.target_count(mesh)),
            "pointer" if channel.target.extensions.pointer.is_some() => {
                return self.pointer_values(at, animation, channel);
            }
            "pointer" => {
                return self.warn(&target, "has no `KHR_animation_pointer`, so the channel has no effect");
            }
            path => return self.warn(&target, format_args!("channels of `{path}` have no effect")),
        };
        if per_key == 0 {
            return self.warn(&target, "channels of `weights` have no effect without morph targets");
        }
        let Some(sampler) = animation.samplers.get(channel.sampler.get()) else { return };
        let key = at.key("sampler");
        let Some(accessor) = self.typed(&key, sampler.output, types, &[F32, I8, U8, I16, U16]) else { return };
        let (found, keys) = (accessor.count.get(), self.document.accessors.get(sampler.input.get()));
        let Some(keys) = keys.map(|accessor| accessor.count.get()) else { return };
        if channel.target.path == "rotation" || channel.target.path == "weights" {
            self.normalized(&key, sampler.output);
        }
        let per_key =
            if sampler.interpolation == Interpolation::CubicSpline { per_key.saturating_mul(3) } else { per_key };
        let expected = keys.saturating_mul(per_key as u64);
        if found != expected {
            let output = sampler.output;
            self.fault(&key, format_args!("accessor {output} has {found} elements, {keys} keys need {expected}"));
        }
    }

    /// Checks the values of a channel with a pointer: a whole number of elements per key.
    fn pointer_values(&mut self, at: &Location<'_>, animation: &Animation, channel: &Channel) {
        let Some(sampler) = animation.samplers.get(channel.sampler.get()) else { return };
        let key = at.key("sampler");
        let Some(accessor) = self.typed(&key, sampler.output, POINTER_TYPES, &[F32, I8, U8, I16, U16]) else { return };
        let (found, keys) = (accessor.count.get(), self.document.accessors.get(sampler.input.get()));
        let Some(keys) = keys.map(|accessor| accessor.count.get()) else { return };
        let elements = if sampler.interpolation == Interpolation::CubicSpline { keys.saturating_mul(3) } else { keys };
        if elements == 0 || !found.is_multiple_of(elements) {
            let output = sampler.output;
            self.fault(&key, format_args!("accessor {output} has {found} elements for {keys} keys"));
        }
    }
}
