//! The brightest path of one sample, vertex by vertex.

use super::luminance;
use super::names::{HitObject, LightOrigin, Namer, event_name};
use juggler_integrator::{ScatterEvent, Scattering};
use juggler_math::Rgb;
use juggler_render::{InspectedSample, LightContribution};
use serde::Serialize;

/// Scattering event at a vertex of a path.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PathEvent {
    /// Entry of the scene's objects.
    pub object: String,
    /// Name of the material.
    pub material: String,
    /// Kind of the scattering event.
    pub event: &'static str,
}

/// Light contribution that a path gathers at a vertex.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contribution {
    /// Name of the light.
    pub light: String,
    /// Sampling strategy: `BSDF-sampled`, `light-sampled`, or `light-sampled through` and an object
    /// if light sampling found the light through a specular sphere.
    pub how: String,
    /// Contribution to the sample, linear RGB.
    pub radiance: [f32; 3],
}

/// Vertex of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbeVertex {
    /// Surface or medium with the scattering event; `None` where the path escaped.
    #[serde(flatten)]
    pub scattering: Option<PathEvent>,
    /// Position, in world space.
    pub point: Option<[f32; 3]>,
    /// Path throughput at this vertex, RGB.
    pub throughput: [f32; 3],
    /// Light contributions gathered here.
    pub lights: Vec<Contribution>,
}

/// One sample with its brightest path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleProbe {
    /// Index of the sample in its pixel, from 0.
    pub sample: u32,
    /// Radiance of the sample, linear RGB; the pixel is the mean of its samples.
    pub radiance: [f32; 3],
    /// Fraction of the pixel's light, by luminance; `None` if it is not finite.
    pub share: Option<f64>,
    /// Radiance removed by clamping, the mean of the channels.
    pub clamped: f32,
    /// Brightest path in one line: `floor diffuse > glass specular transmission > light`.
    pub path: String,
    /// Brightest path without names, by which similar paths are grouped.
    pub kind: String,
    /// Vertices of the path.
    #[serde(rename = "places")]
    pub vertices: Vec<ProbeVertex>,
}

/// Collection of the brightest samples.
pub struct Brightest {
    most: usize,
    samples: Vec<InspectedSample>,
}

/// Returns the sort key of a sample; radiance that is not finite comes first.
fn brightness(sample: &InspectedSample) -> f32 {
    let luminance = sample.radiance.luminance();
    if luminance.is_finite() { luminance } else { f32::INFINITY }
}

impl Brightest {
    pub fn new(most: usize) -> Self {
        Self { most, samples: Vec::new() }
    }

    pub fn add(&mut self, sample: InspectedSample) {
        let place = self.samples.partition_point(|other| brightness(other) >= brightness(&sample));
        if place < self.most {
            self.samples.truncate(self.most - 1);
            self.samples.insert(place, sample);
        }
    }

    /// Returns the samples, brightest first; `total` is the sum of all radiance.
    pub fn report(&self, namer: &mut Namer, total: [f64; 3]) -> Vec<SampleProbe> {
        self.samples.iter().map(|sample| report_sample(namer, sample, luminance(total))).collect()
    }
}

/// Returns the scattering event between a vertex and its parent; `None` at the camera and where the
/// path passed through an opacity mask.
pub fn event_to(namer: &Namer, sample: &InspectedSample, place: usize) -> Option<(Option<HitObject>, ScatterEvent)> {
    let vertex = sample.vertices.get(place)?;
    let (parent, event) = (vertex.parent? as usize, vertex.event?);
    match event.scattering {
        Scattering::PassThrough => None,
        Scattering::Volume => Some((namer.medium(sample, parent), event)),
        _ => Some((namer.hit_object(sample.vertices.get(parent)?), event)),
    }
}

/// Returns the scattering events from a vertex to a light-sampled emitter; empty for emission of
/// the vertex itself.
pub fn events_to_light(
    namer: &Namer,
    sample: &InspectedSample,
    place: usize,
    contribution: &LightContribution,
) -> Vec<(Option<HitObject>, ScatterEvent)> {
    let Some(vertex) = sample.vertices.get(place).filter(|_| contribution.is_light_sample) else { return Vec::new() };
    let is_volume = vertex.light_sample_event.scattering == Scattering::Volume;
    let object = if is_volume { namer.medium(sample, place) } else { namer.hit_object(vertex) };
    let mut events = vec![(object, vertex.light_sample_event)];
    if let Some((sphere, is_mirror)) = &contribution.sphere {
        let sphere = Some(namer.hit_object_of(sphere));
        let event = if *is_mirror { ScatterEvent::REFLECTED } else { ScatterEvent::REFRACTED };
        events.extend(std::iter::repeat_n((sphere, event), if *is_mirror { 1 } else { 2 }));
    }
    events
}

/// Returns vertex and index of the brightest contribution.
fn brightest(sample: &InspectedSample) -> Option<(usize, usize)> {
    let size = |contribution: &LightContribution| {
        let luminance = contribution.radiance.luminance().abs();
        if luminance.is_finite() { luminance } else { f32::INFINITY }
    };
    let all = sample.vertices.iter().enumerate();
    let all = all.flat_map(|(place, v)| {
        v.contributions.iter().enumerate().map(move |(number, contribution)| (place, number, size(contribution)))
    });
    let most = all.reduce(|a, b| if b.2 > a.2 { b } else { a });
    most.map(|(place, number, _)| (place, number))
}

/// Returns the vertices from the camera to `end`, and on while the path does not branch.
fn path_indices(sample: &InspectedSample, end: usize) -> Vec<usize> {
    let mut indices = vec![end];
    while let Some(parent) = indices.last().and_then(|at| sample.vertices.get(*at)?.parent) {
        indices.push(parent as usize);
    }
    indices.reverse();
    loop {
        let last = indices.last().map_or(0, |last| *last as u32);
        let mut next = sample.vertices.iter().enumerate().filter(|(_, vertex)| vertex.parent == Some(last));
        match (next.next(), next.next()) {
            (Some((only, _)), None) => indices.push(only),
            _ => return indices,
        }
    }
}

fn report_sample(namer: &mut Namer, sample: &InspectedSample, total: f64) -> SampleProbe {
    for vertex in sample.vertices.iter().filter_map(|vertex| vertex.hit.as_ref()) {
        namer.register(vertex.material.0, vertex.shape);
    }
    let light = brightest(sample);
    let line = light.map(|(place, number)| line(namer, sample, place, number));
    let (path, kind) = line.unwrap_or_else(|| ("no light".into(), "no light".into()));
    let end = light.map_or(sample.vertices.len().saturating_sub(1), |(place, _)| place);
    let indices = if sample.vertices.is_empty() { Vec::new() } else { path_indices(sample, end) };
    let after = indices.iter().skip(1).copied().map(Some).chain([None]);
    let share = f64::from(sample.radiance.luminance()) / total;
    SampleProbe {
        sample: sample.index,
        radiance: sample.radiance.to_array(),
        share: Some(share).filter(|share| share.is_finite()),
        clamped: sample.clamped,
        path,
        kind,
        vertices: indices.iter().zip(after).map(|(at, next)| probe_vertex(namer, sample, *at, next)).collect(),
    }
}

/// Returns the path from the camera to a light in one line, with names and without.
fn line(namer: &mut Namer, sample: &InspectedSample, end: usize, number: usize) -> (String, String) {
    let mut events = Vec::new();
    let mut at = Some(end);
    while let Some(place) = at {
        events.extend(event_to(namer, sample, place));
        at = sample.vertices.get(place).and_then(|vertex| vertex.parent).map(|parent| parent as usize);
    }
    events.reverse();
    let vertex = sample.vertices.get(end);
    let contribution = vertex.and_then(|vertex| vertex.contributions.get(number));
    let mut origin = LightOrigin::Others;
    if let (Some(vertex), Some(contribution)) = (vertex, contribution) {
        events.extend(events_to_light(namer, sample, end, contribution));
        origin = namer.origin(vertex, contribution);
    }
    let mut names: Vec<String> = Vec::new();
    for (object, event) in &events {
        let PathEvent { object, event, .. } = PathEvent::new(namer, *object, *event);
        names.push(format!("{object} {event}"));
    }
    names.push(namer.origin_name(origin));
    let kinds = events.iter().map(|(_, event)| event_name(*event).to_owned()).chain([namer.origin_kind(origin)]);
    (collapse_repetitions(names).join(" > "), collapse_repetitions(kinds).join(" > "))
}

/// Collapses repetitions: `mirror specular reflection ×7`.
fn collapse_repetitions(names: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut runs: Vec<(String, usize)> = Vec::new();
    for name in names {
        match runs.last_mut() {
            Some((last, count)) if *last == name => *count += 1,
            _ => runs.push((name, 1)),
        }
    }
    runs.into_iter().map(|(name, count)| if count > 1 { format!("{name} ×{count}") } else { name }).collect()
}

/// Describes a vertex of a path that continues to `next`.
fn probe_vertex(namer: &mut Namer, sample: &InspectedSample, at: usize, next: Option<usize>) -> ProbeVertex {
    let Some(vertex) = sample.vertices.get(at) else {
        return ProbeVertex { scattering: None, point: None, throughput: [0.0; 3], lights: Vec::new() };
    };
    let event_after = next.and_then(|next| sample.vertices.get(next)?.event);
    let is_light_sampled = vertex.contributions.iter().any(|contribution| contribution.is_light_sample);
    let event = event_after.or((vertex.is_shaded || is_light_sampled).then_some(vertex.light_sample_event));
    let is_volume = event == Some(ScatterEvent::VOLUME);
    let object = if is_volume { namer.medium(sample, at) } else { namer.hit_object(vertex) };
    let scattering = (vertex.hit.is_some() || is_volume)
        .then(|| PathEvent::new(namer, object, event.unwrap_or(ScatterEvent::PASS_THROUGH)));
    let surface = vertex.hit.as_ref().map(|vertex| vertex.surface.point);
    let point = vertex.scattered_at.or(surface).map(|point| point.to_array());
    let lights = vertex.contributions.iter().map(|contribution| {
        let how = match (&contribution.sphere, contribution.is_light_sample) {
            (Some((sphere, _)), _) => format!("light-sampled through {}", namer.object_of(sphere.shape)),
            (None, true) => "light-sampled".to_owned(),
            (None, false) => "BSDF-sampled".to_owned(),
        };
        Contribution {
            light: namer.origin_name(namer.origin(vertex, contribution)),
            how,
            radiance: contribution.radiance.to_array(),
        }
    });
    ProbeVertex {
        scattering,
        point,
        throughput: divide_by_filter(vertex.weight, sample.weight),
        lights: lights.collect(),
    }
}

/// Divides a path's throughput by the filter weight.
fn divide_by_filter(weight: Rgb, filter: f32) -> [f32; 3] {
    if filter == 0.0 { weight.to_array() } else { (weight / filter).to_array() }
}
