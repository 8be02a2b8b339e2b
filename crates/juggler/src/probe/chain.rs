//! One sample: what its brightest path met, place by place.

use super::luminance;
use super::names::{Namer, Origin, Thing, event_name};
use juggler_integrator::{Event, Scattering};
use juggler_math::Rgb;
use juggler_render::{Inspected, LightGain};
use serde::Serialize;

/// A place of a path.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Step {
    /// What was met: the entry of the scene's objects.
    pub object: String,
    /// Its material.
    pub material: String,
    /// What the path did there.
    pub event: &'static str,
}

/// Light that was added at a place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contribution {
    /// The light.
    pub light: String,
    /// `met`, `asked`, or `asked by` and the polished ball by whose way.
    pub how: String,
    /// What it adds to the sample, linear RGB.
    pub radiance: [f32; 3],
}

/// A place on the way of a sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// What was met, and what the path did there; nothing where it left the world.
    #[serde(flatten)]
    pub step: Option<Step>,
    /// Where, world space.
    pub point: Option<[f32; 3]>,
    /// What radiance from here is worth to the sample, RGB.
    pub throughput: [f32; 3],
    /// Light that was added here.
    pub lights: Vec<Contribution>,
}

/// A sample, and what its brightest path did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleProbe {
    /// Which of the pixel's samples, from 0 on.
    pub sample: u32,
    /// What it is, linear RGB. The pixel is the mean of all.
    pub radiance: [f32; 3],
    /// Of all light of the pixel, by luminance; nothing where it is no finite number.
    pub share: Option<f64>,
    /// What clamping took off it: the mean of its channels.
    pub clamped: f32,
    /// Its brightest path in one line: `floor diffuse > glass specular transmission > lamp`.
    pub path: String,
    /// The same without names: what paths of this kind have in common.
    pub kind: String,
    /// The path's places.
    pub places: Vec<Place>,
}

/// The brightest samples.
pub struct Brightest {
    most: usize,
    samples: Vec<Inspected>,
}

/// Samples that are no numbers first.
fn brightness(sample: &Inspected) -> f32 {
    let luminance = sample.radiance.luminance();
    if luminance.is_finite() { luminance } else { f32::INFINITY }
}

impl Brightest {
    pub fn new(most: usize) -> Self {
        Self { most, samples: Vec::new() }
    }

    pub fn add(&mut self, sample: Inspected) {
        let place = self.samples.partition_point(|other| brightness(other) >= brightness(&sample));
        if place < self.most {
            self.samples.truncate(self.most - 1);
            self.samples.insert(place, sample);
        }
    }

    /// The brightest first; `total` is the sum of all.
    pub fn told(&self, namer: &mut Namer, total: [f64; 3]) -> Vec<SampleProbe> {
        self.samples.iter().map(|sample| told(namer, sample, luminance(total))).collect()
    }
}

/// What stands between a place and the one before it: what the path did there. Nothing for holes, and at the camera.
pub fn before(namer: &Namer, sample: &Inspected, place: usize) -> Option<(Option<Thing>, Event)> {
    let vertex = sample.vertices.get(place)?;
    let (parent, event) = (vertex.parent? as usize, vertex.came?);
    match event.scattering {
        Scattering::Passed => None,
        Scattering::Volume => Some((namer.medium(sample, parent), event)),
        _ => Some((namer.thing(sample.vertices.get(parent)?), event)),
    }
}

/// What light that was added at a place met from there on: nothing where the place itself shines.
pub fn to_light(namer: &Namer, sample: &Inspected, place: usize, gain: &LightGain) -> Vec<(Option<Thing>, Event)> {
    let Some(vertex) = sample.vertices.get(place).filter(|_| gain.asked) else { return Vec::new() };
    let is_volume = vertex.lit.scattering == Scattering::Volume;
    let thing = if is_volume { namer.medium(sample, place) } else { namer.thing(vertex) };
    let mut steps = vec![(thing, vertex.lit)];
    if let Some((ball, is_mirror)) = &gain.by {
        let ball = Some(namer.thing_of(ball));
        let event = if *is_mirror { Event::MIRRORED } else { Event::REFRACTED };
        steps.extend(std::iter::repeat_n((ball, event), if *is_mirror { 1 } else { 2 }));
    }
    steps
}

/// The place and the number of the brightest light of a sample.
fn brightest(sample: &Inspected) -> Option<(usize, usize)> {
    let size = |gain: &LightGain| {
        let luminance = gain.radiance.luminance().abs();
        if luminance.is_finite() { luminance } else { f32::INFINITY }
    };
    let all = sample.vertices.iter().enumerate();
    let all =
        all.flat_map(|(place, v)| v.lights.iter().enumerate().map(move |(number, gain)| (place, number, size(gain))));
    let most = all.reduce(|a, b| if b.2 > a.2 { b } else { a });
    most.map(|(place, number, _)| (place, number))
}

/// The places from the camera to one, and on as long as there is only one way.
fn places(sample: &Inspected, end: usize) -> Vec<usize> {
    let mut places = vec![end];
    while let Some(parent) = places.last().and_then(|at| sample.vertices.get(*at)?.parent) {
        places.push(parent as usize);
    }
    places.reverse();
    loop {
        let last = places.last().map_or(0, |last| *last as u32);
        let mut next = sample.vertices.iter().enumerate().filter(|(_, vertex)| vertex.parent == Some(last));
        match (next.next(), next.next()) {
            (Some((only, _)), None) => places.push(only),
            _ => return places,
        }
    }
}

fn told(namer: &mut Namer, sample: &Inspected, total: f64) -> SampleProbe {
    for met in sample.vertices.iter().filter_map(|vertex| vertex.met.as_ref()) {
        namer.note(met.material.0, met.object);
    }
    let light = brightest(sample);
    let line = light.map(|(place, number)| line(namer, sample, place, number));
    let (path, kind) = line.unwrap_or_else(|| ("no light".into(), "no light".into()));
    let end = light.map_or(sample.vertices.len().saturating_sub(1), |(place, _)| place);
    let places = if sample.vertices.is_empty() { Vec::new() } else { places(sample, end) };
    let after = places.iter().skip(1).copied().map(Some).chain([None]);
    let share = f64::from(sample.radiance.luminance()) / total;
    SampleProbe {
        sample: sample.index,
        radiance: sample.radiance.to_array(),
        share: Some(share).filter(|share| share.is_finite()),
        clamped: sample.clamped,
        path,
        kind,
        places: places.iter().zip(after).map(|(at, next)| place(namer, sample, *at, next)).collect(),
    }
}

/// A path from the camera to a light, with names and without.
fn line(namer: &mut Namer, sample: &Inspected, end: usize, number: usize) -> (String, String) {
    let mut steps = Vec::new();
    let mut at = Some(end);
    while let Some(place) = at {
        steps.extend(before(namer, sample, place));
        at = sample.vertices.get(place).and_then(|vertex| vertex.parent).map(|parent| parent as usize);
    }
    steps.reverse();
    let vertex = sample.vertices.get(end);
    let gain = vertex.and_then(|vertex| vertex.lights.get(number));
    let mut origin = Origin::Others;
    if let (Some(vertex), Some(gain)) = (vertex, gain) {
        steps.extend(to_light(namer, sample, end, gain));
        origin = namer.origin(vertex, gain);
    }
    let mut names: Vec<String> = Vec::new();
    for (thing, event) in &steps {
        let Step { object, event, .. } = Step::new(namer, *thing, *event);
        names.push(format!("{object} {event}"));
    }
    names.push(namer.origin_name(origin));
    let kinds = steps.iter().map(|(_, event)| event_name(*event).to_owned()).chain([namer.origin_kind(origin)]);
    (runs(names).join(" > "), runs(kinds).join(" > "))
}

/// The same again and again is told once: `mirror specular reflection ×7`.
fn runs(names: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut runs: Vec<(String, usize)> = Vec::new();
    for name in names {
        match runs.last_mut() {
            Some((last, count)) if *last == name => *count += 1,
            _ => runs.push((name, 1)),
        }
    }
    runs.into_iter().map(|(name, count)| if count > 1 { format!("{name} ×{count}") } else { name }).collect()
}

/// A place of a path that goes on to `next`.
fn place(namer: &mut Namer, sample: &Inspected, at: usize, next: Option<usize>) -> Place {
    let Some(vertex) = sample.vertices.get(at) else {
        return Place { step: None, point: None, throughput: [0.0; 3], lights: Vec::new() };
    };
    let came = next.and_then(|next| sample.vertices.get(next)?.came);
    let asked = vertex.lights.iter().any(|gain| gain.asked);
    let event = came.or((vertex.is_seen || asked).then_some(vertex.lit));
    let is_volume = event == Some(Event::VOLUME);
    let thing = if is_volume { namer.medium(sample, at) } else { namer.thing(vertex) };
    let step = (vertex.met.is_some() || is_volume).then(|| Step::new(namer, thing, event.unwrap_or(Event::PASSED)));
    let surface = vertex.met.as_ref().map(|met| met.surface.point);
    let point = vertex.scattered_at.or(surface).map(|point| point.to_array());
    let lights = vertex.lights.iter().map(|gain| {
        let how = match (&gain.by, gain.asked) {
            (Some((ball, _)), _) => format!("asked by {}", namer.object_of(ball.object)),
            (None, true) => "asked".to_owned(),
            (None, false) => "met".to_owned(),
        };
        Contribution { light: namer.origin_name(namer.origin(vertex, gain)), how, radiance: gain.radiance.to_array() }
    });
    Place { step, point, throughput: over(vertex.weight, sample.weight), lights: lights.collect() }
}

/// A path's weight without the filter's.
fn over(weight: Rgb, filter: f32) -> [f32; 3] {
    if filter == 0.0 { weight.to_array() } else { (weight / filter).to_array() }
}
