//! The paths of all samples of a pixel, merged by what they met.

use super::chain::{self, Step};
use super::names::{Namer, Origin, Thing, event_name};
use super::shares::{Scale, add};
use juggler_integrator::Event;
use juggler_math::Rgb;
use juggler_render::{Inspected, LightGain, PathVertex};
use serde::Serialize;
use std::collections::BTreeMap;

/// Paths that met the same things on their way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Branch {
    /// What they met last, and what they did there; nothing at the camera, and of light.
    #[serde(flatten)]
    pub step: Option<Step>,
    /// The light that they came to, where they end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_from: Option<String>,
    /// How many samples came so far.
    pub samples: u32,
    /// What of the pixel's light came along here, linear RGB.
    pub light: [f64; 3],
    /// Of all light, by luminance.
    pub share: f64,
    /// Where they went on to, those with most light first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<Branch>,
    /// Smaller branches, and longer paths than are told.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub others: Option<Others>,
}

/// Branches that are not told one by one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Others {
    /// How many; 0 where paths are longer than is told.
    pub branches: usize,
    /// What of the pixel's light came along them, linear RGB.
    pub light: [f64; 3],
    /// Of all light, by luminance.
    pub share: f64,
}

/// Where a path goes on to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Place(Option<Thing>, Event),
    Light(Origin),
}

/// All paths.
pub struct Tree {
    nodes: Vec<Node>,
    depth: u32,
}

#[derive(Default)]
struct Node {
    parent: usize,
    depth: u32,
    samples: u32,
    /// The last sample that came here, counted from 1.
    last: u32,
    light: [f64; 3],
    next: BTreeMap<Key, usize>,
}

impl Tree {
    /// Of so many places in a row.
    pub fn new(depth: u32) -> Self {
        Self { nodes: vec![Node::default()], depth }
    }

    /// The place after another one; the same where paths are told no further.
    fn next(&mut self, from: usize, key: Key, sample: u32) -> usize {
        let new = self.nodes.len();
        let Some(node) = self.nodes.get_mut(from) else { return 0 };
        let is_place = matches!(key, Key::Place(..));
        if is_place && node.depth >= self.depth {
            return from;
        }
        let (depth, to) = (node.depth + u32::from(is_place), *node.next.entry(key).or_insert(new));
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

    /// Light that came along a branch came along all that it hangs on.
    fn light(&mut self, mut at: usize, light: Rgb) {
        while let Some(node) = self.nodes.get_mut(at) {
            add(&mut node.light, light);
            if at == 0 {
                return;
            }
            at = node.parent;
        }
    }

    /// Takes in a sample.
    pub fn add(&mut self, namer: &mut Namer, sample: &Inspected) {
        let number = sample.index + 1;
        self.count(0, number);
        let goes_on: std::collections::BTreeSet<u32> = sample.vertices.iter().filter_map(|v| v.parent).collect();
        let mut places: Vec<usize> = Vec::with_capacity(sample.vertices.len());
        for (place, vertex) in sample.vertices.iter().enumerate() {
            if let Some(met) = &vertex.met {
                namer.note(met.material.0, met.object);
            }
            let before = vertex.parent.and_then(|parent| places.get(parent as usize).copied()).unwrap_or(0);
            let key = chain::before(namer, sample, place).map(|(thing, event)| Key::Place(thing, event));
            let at = key.map_or(before, |key| self.next(before, key, number));
            places.push(at);
            if sample.radiance.is_finite() {
                vertex.lights.iter().for_each(|gain| self.gain(namer, sample, (place, vertex), gain, at));
            }
            if vertex.is_seen && vertex.lights.is_empty() && !goes_on.contains(&(place as u32)) {
                self.next(at, Key::Place(namer.thing(vertex), vertex.lit), number);
            }
        }
        if sample.radiance.is_finite() {
            self.light(0, sample.untold);
        }
    }

    fn gain(
        &mut self,
        namer: &Namer,
        sample: &Inspected,
        (place, vertex): (usize, &PathVertex),
        gain: &LightGain,
        from: usize,
    ) {
        let number = sample.index + 1;
        let mut at = from;
        for (thing, event) in chain::to_light(namer, sample, place, gain) {
            at = self.next(at, Key::Place(thing, event), number);
        }
        at = self.next(at, Key::Light(namer.origin(vertex, gain)), number);
        self.light(at, gain.radiance);
    }

    /// The tree with at most so many branches of each place.
    pub fn told(&self, namer: &mut Namer, scale: &Scale, most: usize) -> Branch {
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
        // What is left over without a branch is rounding, unless paths go on further.
        let is_light = matches!(key, Some(Key::Light(_)));
        let has_more = !is_light && node.depth >= self.depth && scale.share(light).abs() > 1e-9;
        let others = (!rest.is_empty() || has_more).then(|| Others {
            branches: rest.len(),
            light: scale.light(light),
            share: scale.share(light),
        });
        Branch {
            step: match key {
                Some(Key::Place(thing, event)) => Some(Step::new(namer, thing, event)),
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

impl Step {
    pub(super) fn new(namer: &mut Namer, thing: Option<Thing>, event: Event) -> Self {
        let named = thing.map(|thing| namer.thing_name(thing));
        let (object, material) = named.unwrap_or_else(|| ("medium".into(), String::new()));
        Self { object, material, event: event_name(event) }
    }
}
