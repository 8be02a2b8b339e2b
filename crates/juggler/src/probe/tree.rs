//! Tree of the paths of all samples of a pixel, merged by their vertices.

use super::names::{HitObject, LightOrigin, Namer, event_name};
use super::path::{self, PathEvent};
use super::shares::{Scale, add};
use juggler_integrator::ScatterEvent;
use juggler_math::Rgb;
use juggler_render::{InspectedSample, LightContribution, PathVertex};
use serde::Serialize;
use std::collections::BTreeMap;

/// Node of the tree: paths with the same vertices so far.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Branch {
    /// Last object or medium with the scattering event there; `None` at the camera and at lights.
    #[serde(flatten)]
    pub scattering: Option<PathEvent>,
    /// Light at which these paths end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_from: Option<String>,
    /// Number of samples with such a path.
    pub samples: u32,
    /// Contribution to the pixel, linear RGB.
    pub light: [f64; 3],
    /// Fraction of the pixel's light, by luminance.
    pub share: f64,
    /// Continuations, brightest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<Branch>,
    /// Smaller branches, and paths longer than the depth of the tree.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub others: Option<Others>,
}

/// Merged branches.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Others {
    /// Number of branches; 0 for paths longer than the depth of the tree.
    pub branches: usize,
    /// Contribution to the pixel, linear RGB.
    pub light: [f64; 3],
    /// Fraction of the pixel's light, by luminance.
    pub share: f64,
}

/// Continuation of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Vertex(Option<HitObject>, ScatterEvent),
    Light(LightOrigin),
}

/// Tree of paths.
pub struct PathTree {
    nodes: Vec<Node>,
    depth: u32,
}

#[derive(Default)]
struct Node {
    parent: usize,
    depth: u32,
    samples: u32,
    /// Last sample that was counted here, from 1.
    last: u32,
    light: [f64; 3],
    next: BTreeMap<Key, usize>,
}

impl PathTree {
    /// Creates a tree of at most `depth` vertices per path.
    pub fn new(depth: u32) -> Self {
        Self { nodes: vec![Node::default()], depth }
    }

    /// Returns the child of a node; the node itself at the maximum depth.
    fn next(&mut self, from: usize, key: Key, sample: u32) -> usize {
        let new = self.nodes.len();
        let Some(node) = self.nodes.get_mut(from) else { return 0 };
        let is_vertex = matches!(key, Key::Vertex(..));
        if is_vertex && node.depth >= self.depth {
            return from;
        }
        let (depth, to) = (node.depth + u32::from(is_vertex), *node.next.entry(key).or_insert(new));
        if to == new {
            self.nodes.push(Node { parent: from, depth, ..Node::default() });
        }
        self.count(to, sample);
        to
    }

    fn count(&mut self, at: usize, sample: u32) {
        if let Some(node) = self.nodes.get_mut(at)
            && node.last != sample
        {
            node.last = sample;
            node.samples += 1;
        }
    }

    /// Adds radiance to a node and all its ancestors.
    fn light(&mut self, mut at: usize, light: Rgb) {
        while let Some(node) = self.nodes.get_mut(at) {
            add(&mut node.light, light);
            if at == 0 {
                return;
            }
            at = node.parent;
        }
    }

    /// Adds the paths of a sample.
    pub fn add(&mut self, namer: &mut Namer, sample: &InspectedSample) {
        let number = sample.index + 1;
        self.count(0, number);
        let continued: std::collections::BTreeSet<u32> = sample.vertices.iter().filter_map(|v| v.parent).collect();
        let mut places: Vec<usize> = Vec::with_capacity(sample.vertices.len());
        for (place, vertex) in sample.vertices.iter().enumerate() {
            if let Some(hit) = &vertex.hit {
                namer.register(hit.material.0, hit.shape);
            }
            let before = vertex.parent.and_then(|parent| places.get(parent as usize).copied()).unwrap_or(0);
            let key = path::event_to(namer, sample, place).map(|(object, event)| Key::Vertex(object, event));
            let at = key.map_or(before, |key| self.next(before, key, number));
            places.push(at);
            if sample.radiance.is_finite() {
                vertex
                    .contributions
                    .iter()
                    .for_each(|contribution| self.contribution(namer, sample, (place, vertex), contribution, at));
            }
            if vertex.is_shaded && vertex.contributions.is_empty() && !continued.contains(&(place as u32)) {
                self.next(at, Key::Vertex(namer.hit_object(vertex), vertex.light_sample_event), number);
            }
        }
        if sample.radiance.is_finite() {
            self.light(0, sample.unrecorded);
        }
    }

    fn contribution(
        &mut self,
        namer: &Namer,
        sample: &InspectedSample,
        (place, vertex): (usize, &PathVertex),
        contribution: &LightContribution,
        from: usize,
    ) {
        let number = sample.index + 1;
        let mut at = from;
        for (object, event) in path::events_to_light(namer, sample, place, contribution) {
            at = self.next(at, Key::Vertex(object, event), number);
        }
        at = self.next(at, Key::Light(namer.origin(vertex, contribution)), number);
        self.light(at, contribution.radiance);
    }

    /// Returns the tree with at most `most` branches per node.
    pub fn report(&self, namer: &mut Namer, scale: &Scale, most: usize) -> Branch {
        self.branch(0, None, namer, scale, most)
    }

    fn branch(&self, at: usize, key: Option<Key>, namer: &mut Namer, scale: &Scale, most: usize) -> Branch {
        let empty = Node::default();
        let node = self.nodes.get(at).unwrap_or(&empty);
        let of = |place: &usize| self.nodes.get(*place).unwrap_or(&empty);
        let mut next: Vec<(Key, usize)> = node.next.iter().map(|(key, place)| (*key, *place)).collect();
        let size = |place: &usize| (scale.share(of(place).light).abs(), of(place).samples);
        next.sort_by(|(_, a), (_, b)| {
            let (a, b) = (size(a), size(b));
            b.0.total_cmp(&a.0).then(b.1.cmp(&a.1))
        });
        let rest = next.split_off(most.min(next.len()));
        let mut light = node.light;
        let mut take = |place: &usize| light.iter_mut().zip(of(place).light).for_each(|(sum, part)| *sum -= part);
        next.iter().for_each(|(_, place)| take(place));
        // The remainder is rounding, unless longer paths were cut off.
        let is_light = matches!(key, Some(Key::Light(_)));
        let has_more = !is_light && node.depth >= self.depth && scale.share(light).abs() > 1e-9;
        let others = (!rest.is_empty() || has_more).then(|| Others {
            branches: rest.len(),
            light: scale.light(light),
            share: scale.share(light),
        });
        Branch {
            scattering: match key {
                Some(Key::Vertex(object, event)) => Some(PathEvent::new(namer, object, event)),
                _ => None,
            },
            light_from: match key {
                Some(Key::Light(origin)) => Some(namer.origin_name(origin)),
                _ => None,
            },
            samples: node.samples,
            light: scale.light(node.light),
            share: scale.share(node.light),
            branches: next.into_iter().map(|(key, place)| self.branch(place, Some(key), namer, scale, most)).collect(),
            others,
        }
    }
}

impl PathEvent {
    pub(super) fn new(namer: &mut Namer, object: Option<HitObject>, event: ScatterEvent) -> Self {
        let named = object.map(|object| namer.hit_object_names(object));
        let (object, material) = named.unwrap_or_else(|| ("medium".into(), String::new()));
        Self { object, material, event: event_name(event) }
    }
}
