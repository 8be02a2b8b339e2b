//! Animation clips of a file.

use super::faults::Faults;
use crate::gltf::data::GltfData;
use crate::gltf::document::{Animation, Channel as FileChannel, Document};
use crate::gltf::error::Fault;
use crate::gltf::pose::{Channel, ChannelTarget, Clip, Curve, NodeProperty, Pose, Repeat};
use crate::gltf::warning::Warnings;
use juggler_scene::model::{ModelChoice, ModelRepeat};

/// Reads the clips of a file.
pub fn read_clips(data: &GltfData, names: &[String], warnings: &mut Warnings, faults: &mut Faults) -> Vec<Clip> {
    let animations = data.gltf.document.animations.iter().zip(names).enumerate();
    animations
        .map(|(index, (animation, name))| {
            let mut clip = Clip { name: name.clone(), channels: Vec::new() };
            for (number, channel) in animation.channels.iter().enumerate() {
                let at = format!("/animations/{index}/channels/{number}");
                match read_channel(data, animation, channel, &at, warnings) {
                    Ok(channel) => clip.channels.extend(channel),
                    Err(fault) => faults.add(fault),
                }
            }
            let repeated = clip.repeated_targets() as u64;
            warnings.add(
                format!("/animations/{index}"),
                "channels have the target of another; the later count",
                repeated,
            );
            clip
        })
        .collect()
}

/// Reads a channel; `None` if it has no effect.
fn read_channel(
    data: &GltfData,
    animation: &Animation,
    channel: &FileChannel,
    at: &str,
    warnings: &mut Warnings,
) -> Result<Option<Channel>, Fault> {
    let Some(target) = target(&data.gltf.document, channel) else { return Ok(None) };
    let Some(sampler) = animation.samplers.get(channel.sampler.get()) else { return Ok(None) };
    let (times, values) = (data.scalars(sampler.input)?, data.numbers(sampler.output)?);
    let interpolation = crate::gltf::pose::Interpolation::from(sampler.interpolation);
    let elements = times.len().saturating_mul(interpolation.elements_per_key());
    let components = values.len().checked_div(elements).unwrap_or_default();
    let curve = Curve::new(times, values, components, interpolation).map_err(|error| Fault::at(at, error))?;
    warnings.add(at, "keys have equal times; the later count", curve.equal_keys() as u64);
    let channel = Channel::new(target, curve).map_err(|error| Fault::at(at, error))?;
    warnings.add(at, "rotations have not the length 1; they are normalized", channel.unnormalized_rotations() as u64);
    Ok(Some(channel))
}

/// Target of a channel; `None` if the channel has no effect.
fn target(document: &Document, channel: &FileChannel) -> Option<ChannelTarget> {
    let target = match &channel.target.extensions.pointer {
        Some(target) if channel.target.path == "pointer" => ChannelTarget::from_pointer(&target.pointer),
        _ => ChannelTarget::from_path(channel.target.node?.get(), &channel.target.path)?,
    };
    // Channels of weights without morph targets have any number of components.
    let mesh = match &target {
        ChannelTarget::Node { node, property: NodeProperty::Weights | NodeProperty::Weight(_) } => {
            document.nodes.get(*node)?.mesh?.get()
        }
        ChannelTarget::Mesh { mesh, .. } => *mesh,
        _ => return Some(target),
    };
    (document.meshes.get(mesh)?.targets() > 0).then_some(target)
}

/// Pose of a clip at the time of a choice.
pub fn pose_of(clip: Option<&Clip>, choice: &ModelChoice) -> Pose {
    let repeat = match choice.repeat {
        ModelRepeat::Loop => Repeat::Loop,
        ModelRepeat::Once => Repeat::Once,
    };
    clip.map(|clip| clip.pose(clip.local_time(choice.seconds, repeat))).unwrap_or_default()
}
