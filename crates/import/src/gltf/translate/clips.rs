//! Animation clips of a file, and their poses.

use super::Names;
use crate::gltf::data::GltfData;
use crate::gltf::document::{Animation, Channel as DocumentChannel};
use crate::gltf::error::Fault;
use crate::gltf::pose::{Channel, ChannelTarget, Clip, Curve, NodeProperty, Pose, Repeat};
use crate::gltf::warning::Warnings;
use juggler_scene::model::{ModelChoice, ModelRepeat};

/// Clips of a file by index.
#[derive(Clone, Debug, Default)]
pub struct ClipSet {
    clips: Vec<Clip>,
    /// Warnings about channels without effect.
    pub warnings: Warnings,
}

impl ClipSet {
    /// Reads the clips of a file.
    ///
    /// # Errors
    ///
    /// Times or values of a channel are not valid.
    pub fn new(data: &GltfData, names: &Names) -> Result<Self, Fault> {
        let mut set = Self::default();
        for (index, (animation, name)) in data.gltf.document.animations.iter().zip(&names.animations).enumerate() {
            let clip = set.clip(data, index, animation, name)?;
            set.clips.push(clip);
        }
        Ok(set)
    }

    fn clip(&mut self, data: &GltfData, index: usize, animation: &Animation, name: &str) -> Result<Clip, Fault> {
        let mut clip = Clip { name: name.to_owned(), channels: Vec::new() };
        for (number, channel) in animation.channels.iter().enumerate() {
            let at = format!("/animations/{index}/channels/{number}");
            let Some(target) = self.target(&at, channel) else { continue };
            let Some(sampler) = animation.samplers.get(channel.sampler.get()) else { continue };
            let (times, values) = (data.scalars(sampler.input)?, data.numbers(sampler.output)?);
            let interpolation = sampler.interpolation.into();
            let components = components(&times, &values, interpolation);
            let curve = Curve::new(times, values, components, interpolation).map_err(|error| Fault::at(&at, error))?;
            self.warnings.add(&at, "keys have equal times; the later ones count", curve.equal_keys() as u64);
            clip.channels.push(Channel::new(target, curve).map_err(|error| Fault::at(&at, error))?);
        }
        Ok(clip)
    }

    /// Target of a channel; `None` if it has no effect.
    fn target(&mut self, at: &str, channel: &DocumentChannel) -> Option<ChannelTarget> {
        if let Some(target) = &channel.target.extensions.pointer {
            let parsed = ChannelTarget::from_pointer(&target.pointer);
            if !matches!(parsed, ChannelTarget::Pointer(_)) {
                return Some(parsed);
            }
            self.warnings.add(at, format!("the animation of `{}` has no effect", target.pointer), 1);
            return None;
        }
        let node = channel.target.node?.get();
        let property = match channel.target.path.as_str() {
            "translation" => NodeProperty::Translation,
            "rotation" => NodeProperty::Rotation,
            "scale" => NodeProperty::Scale,
            "weights" => NodeProperty::Weights,
            _ => return None,
        };
        Some(ChannelTarget::Node { node, property })
    }

    /// Number of clips.
    pub fn len(&self) -> usize {
        self.clips.len()
    }

    /// Names of the clips.
    pub fn names(&self) -> Vec<String> {
        self.clips.iter().map(|clip| clip.name.clone()).collect()
    }

    /// Duration of a clip in seconds; 0 for an unknown clip.
    pub fn duration(&self, clip: usize) -> f64 {
        self.clips.get(clip).map_or(0.0, Clip::duration)
    }

    /// Pose of a clip at the time of a choice.
    pub fn pose(&self, clip: usize, choice: &ModelChoice) -> Pose {
        let repeat = match choice.repeat {
            ModelRepeat::Loop => Repeat::Loop,
            ModelRepeat::Once => Repeat::Once,
        };
        self.clips.get(clip).map(|clip| clip.pose(clip.local_time(choice.seconds, repeat))).unwrap_or_default()
    }
}

/// Components of each value of a channel, from the numbers of times and values.
fn components(times: &[f32], values: &[f32], interpolation: crate::gltf::pose::Interpolation) -> usize {
    let keys = times.len().saturating_mul(interpolation.elements_per_key());
    if keys == 0 { 0 } else { values.len() / keys }
}
