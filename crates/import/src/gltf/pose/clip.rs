//! Animation clips: channels that are evaluated at one time (glTF 2.0, section 3.11).

use super::channel::Channel;
use super::target::{ChannelTarget, NodeProperty};
use super::weights::AnimatedWeights;
use glam::{DQuat, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Behavior of a clip before its start and after its end. The names are those of the scene format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repeat {
    /// Holds the first and the last pose.
    #[default]
    Once,
    /// Repeats the clip. The end of each cycle shows the end of the clip, not its start.
    Loop,
    /// Alternates between forward and backward playback.
    PingPong,
}

/// An animation: channels with a common time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// Name in the file; may be empty.
    pub name: String,
    /// Channels. Of two channels with one target, the later counts.
    pub channels: Vec<Channel>,
}

/// Animated properties of a node; `None` where the clip has no channel for the property.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodePose {
    /// Translation in the parent's space.
    pub translation: Option<DVec3>,
    /// Rotation, a unit quaternion.
    pub rotation: Option<DQuat>,
    /// Scale factors along the node's axes.
    pub scale: Option<DVec3>,
    /// Weights of the morph targets of the node's mesh.
    pub weights: AnimatedWeights,
    /// Visibility of the node and its descendants (KHR_node_visibility).
    pub visible: Option<bool>,
}

/// Values of all animated properties at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Animated nodes by index.
    pub nodes: BTreeMap<usize, NodePose>,
    /// Default weights of animated meshes by index.
    pub meshes: BTreeMap<usize, AnimatedWeights>,
    /// Numbers of other properties by JSON pointer.
    pub properties: BTreeMap<String, Vec<f64>>,
}

impl Clip {
    /// Duration in seconds: time of the last key of all channels, at least 0.
    pub fn duration(&self) -> f64 {
        self.channels.iter().map(|channel| channel.curve().last_time()).fold(0.0, f64::max)
    }

    /// Maps a time in seconds to the interval from 0 to the duration.
    pub fn local_time(&self, seconds: f64, repeat: Repeat) -> f64 {
        let duration = self.duration();
        if seconds.is_nan() || duration <= 0.0 {
            return 0.0;
        }
        match repeat {
            Repeat::Once => seconds.max(0.0).min(duration),
            _ if seconds.is_infinite() => 0.0,
            Repeat::Loop => {
                // Times come from frame numbers, whose rounding may miss the end.
                let (time, rounding) = (seconds.rem_euclid(duration), 1e-9 * duration);
                let is_end = time <= rounding && seconds > rounding;
                if is_end { duration } else { time }
            }
            Repeat::PingPong => {
                let time = seconds.rem_euclid(2.0 * duration);
                if time > duration { 2.0 * duration - time } else { time }
            }
        }
    }

    /// Evaluates all channels at a [local time](Self::local_time) in seconds. Each curve is
    /// constant outside its own keys.
    pub fn pose(&self, seconds: f64) -> Pose {
        let mut pose = Pose::default();
        for channel in &self.channels {
            pose.set(channel, seconds);
        }
        pose
    }

    /// Number of channels whose target an earlier channel has too.
    pub fn repeated_targets(&self) -> usize {
        let mut targets = BTreeSet::new();
        self.channels.iter().filter(|channel| !targets.insert(channel.target())).count()
    }
}

impl Pose {
    fn set(&mut self, channel: &Channel, seconds: f64) {
        match channel.target() {
            ChannelTarget::Node { node, property } => {
                self.nodes.entry(*node).or_default().set(*property, channel, seconds);
            }
            ChannelTarget::Mesh { mesh, morph_target } => {
                let values = channel.curve().evaluate(seconds);
                self.meshes.entry(*mesh).or_default().set(*morph_target, values);
            }
            ChannelTarget::Pointer(pointer) => {
                self.properties.insert(pointer.clone(), channel.curve().evaluate(seconds));
            }
        }
    }
}

impl NodePose {
    fn set(&mut self, property: NodeProperty, channel: &Channel, seconds: f64) {
        let curve = channel.curve();
        match property {
            NodeProperty::Translation => self.translation = Some(curve.vector(seconds)),
            NodeProperty::Rotation => self.rotation = curve.rotation(seconds),
            NodeProperty::Scale => self.scale = Some(curve.vector(seconds)),
            NodeProperty::Weights => self.weights.set(None, curve.evaluate(seconds)),
            NodeProperty::Weight(target) => self.weights.set(Some(target), curve.evaluate(seconds)),
            NodeProperty::Visible => self.visible = Some(curve.is_on(seconds)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::curve::{Curve, Interpolation};
    use super::*;

    fn channel(pointer: &str, times: &[f32], values: &[f32]) -> Channel {
        let components = values.len() / times.len();
        let curve = Curve::new(times.to_vec(), values.to_vec(), components, Interpolation::Linear).unwrap();
        Channel::new(ChannelTarget::from_pointer(pointer), curve).unwrap()
    }

    fn clip(channels: Vec<Channel>) -> Clip {
        Clip { name: "Run".into(), channels }
    }

    #[test]
    fn the_longest_curve_determines_the_duration() {
        let short = channel("/nodes/0/translation", &[0.5, 1.0], &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0]);
        let long = channel("/nodes/1/scale", &[1.0, 4.0], &[1.0, 1.0, 1.0, 4.0, 4.0, 4.0]);
        let clip = clip(vec![short, long]);
        assert_eq!(clip.duration(), 4.0);
        for (seconds, once, repeated, alternating) in [
            (-1.0, 0.0, 3.0, 1.0),
            (0.0, 0.0, 0.0, 0.0),
            (3.5, 3.5, 3.5, 3.5),
            (4.0, 4.0, 4.0, 4.0),
            (4.0 + 1e-15, 4.0, 4.0, 8.0 - (4.0 + 1e-15)),
            (8.0, 4.0, 4.0, 0.0),
            (5.0, 4.0, 1.0, 3.0),
            (9.5, 4.0, 1.5, 1.5),
            (f64::NAN, 0.0, 0.0, 0.0),
            (f64::INFINITY, 4.0, 0.0, 0.0),
        ] {
            let found = [Repeat::Once, Repeat::Loop, Repeat::PingPong].map(|repeat| clip.local_time(seconds, repeat));
            assert_eq!(found, [once, repeated, alternating], "{seconds}");
        }
        // The short curve holds its own ends.
        let translation = |seconds| clip.pose(seconds).nodes[&0].translation.unwrap();
        assert_eq!(translation(0.0), DVec3::ZERO);
        assert_eq!(translation(0.75), DVec3::new(0.5, 1.0, 1.5));
        assert_eq!(translation(3.0), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(clip.pose(2.0).nodes[&1].scale, Some(DVec3::splat(2.0)));
    }

    #[test]
    fn every_target_has_its_place_in_the_pose() {
        let clip = clip(vec![
            channel("/nodes/2/rotation", &[0.0], &[0.0, 0.0, 0.0, 2.0]),
            channel("/nodes/2/weights", &[0.0, 1.0], &[0.0, 1.0, 1.0, 3.0]),
            channel("/nodes/2/weights/1", &[0.0], &[7.0]),
            channel("/nodes/2/extensions/KHR_node_visibility/visible", &[0.0, 1.0], &[1.0, 0.0]),
            channel("/meshes/5/weights", &[0.0], &[0.25]),
            channel(
                "/materials/0/pbrMetallicRoughness/baseColorFactor",
                &[0.0, 1.0],
                &[0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0],
            ),
        ]);
        let pose = clip.pose(0.5);
        let node = &pose.nodes[&2];
        assert_eq!((node.translation, node.rotation, node.scale), (None, Some(DQuat::IDENTITY), None));
        assert_eq!(node.weights, AnimatedWeights { all: Some(vec![0.5, 2.0]), single: vec![(1, 7.0)] });
        assert_eq!((node.visible, clip.pose(1.0).nodes[&2].visible), (Some(true), Some(false)));
        assert_eq!(pose.meshes[&5].all, Some(vec![0.25]));
        let color = &pose.properties["/materials/0/pbrMetallicRoughness/baseColorFactor"];
        assert_eq!(color, &[0.5, 0.5, 0.0, 1.0]);
        assert_eq!((pose.nodes.len(), pose.meshes.len(), pose.properties.len()), (1, 1, 1));
    }

    #[test]
    fn the_later_of_two_channels_counts() {
        let twice = |value| channel("/nodes/0/scale", &[0.0], &[value; 3]);
        let clip = clip(vec![twice(2.0), twice(3.0)]);
        assert_eq!((clip.repeated_targets(), clip.pose(0.0).nodes[&0].scale), (1, Some(DVec3::splat(3.0))));
    }

    #[test]
    fn empty_clips_have_an_empty_pose() {
        let clip = Clip::default();
        assert_eq!((clip.duration(), clip.pose(1.0)), (0.0, Pose::default()));
        assert!([Repeat::Once, Repeat::Loop, Repeat::PingPong].iter().all(|r| clip.local_time(3.0, *r) == 0.0));
    }
}
