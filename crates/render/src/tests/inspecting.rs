//! Tests of pixel inspection: the radiance is bit-identical to the picture's, and all of it is
//! accounted for.

use super::*;
use juggler_camera::film::{AnyFilter, Mitchell, Tent};
use juggler_integrator::{Direct, Path, PathKind, ScatterEvent, Scattering};
use juggler_world::{LightSource, SeparateLights};
use std::collections::BTreeSet;

/// A room with a point light, a directional light, an emissive sphere, glass, rough metal and a
/// medium.
fn room() -> World {
    let diffuse = r#"{"diffuse": {"reflectance": [0.7, 0.6, 0.5]}}"#;
    let objects = [
        (r#"{"plane": {}}"#, Vec3::new(0.0, -1.0, 0.0), diffuse),
        (r#"{"sphere": {"radius": 0.9}}"#, Vec3::new(-1.2, 0.0, 0.0), r#"{"dielectric": {"ior": 1.5}}"#),
        (r#"{"sphere": {"radius": 0.8}}"#, Vec3::new(1.2, 0.0, -0.5), r#"{"conductor": {"roughness": 0.3}}"#),
        (r#"{"sphere": {"radius": 0.3}}"#, Vec3::new(0.0, 2.0, 0.5), r#"{"emissive": {"radiance": 1, "scale": 6}}"#),
        (
            r#"{"sphere": {"radius": 0.6}}"#,
            Vec3::new(0.2, -0.2, 1.2),
            r#"{"dielectric": {"ior": 1.3, "medium": {"scattering": 2, "absorption": 0.3}}}"#,
        ),
    ];
    let lights = [
        r#"{"point": {"position": [2, 4, 3], "intensity": 30}}"#,
        r#"{"directional": {"direction": [-1, -1, 0], "intensity": 0.3}}"#,
    ];
    world(&objects, &lights, Rgb::new(0.3, 0.4, 0.6))
}

fn difference(a: Rgb, b: Rgb) -> f32 {
    (a - b).map(f32::abs).max_channel() / (1e-3 + a.max_channel())
}

#[test]
fn inspected_pixel_equals_the_rendered_pixel_and_the_sum_of_its_contributions() {
    let size = UVec2::new(9, 7);
    let camera = look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", size);
    let clamped = Path { clamp_direct: Some(2.0), clamp_indirect: Some(0.3), ..Path::default() };
    let classic = Classic { max_depth: 3, min_weight: 1e-4, occlusion_distance: Some(2.0) };
    let clamped_rays = Path { camera_rays: Some(4), ..clamped.clone() };
    let cases: [(World, AnyIntegrator, AnyFilter, u32); 8] = [
        (room(), Path::default().into(), BoxFilter {}.into(), 40),
        (room(), Path { camera_rays: Some(3), ..Path::default() }.into(), BoxFilter {}.into(), 20),
        (room(), clamped_rays.into(), Mitchell::default().into(), 18),
        (room(), clamped.into(), Mitchell::default().into(), 21),
        (room(), Path { light_samples: Some(3), ..Path::default() }.into(), Tent { radius: 1.0 }.into(), 5),
        (room(), Direct {}.into(), BoxFilter {}.into(), 1),
        (room(), Classic::default().into(), BoxFilter {}.into(), 4),
        (busy(), classic.into(), BoxFilter {}.into(), 3),
    ];
    for (world, integrator, filter, samples) in cases {
        let (world, _) = world.with_separate_lights();
        let job = Job { filter: filter.sampler(samples), ..job(&world, &camera, &integrator, samples) };
        let whole = job.render(&Work::first(Rect { x: 0, y: 0, width: 9, height: 7 }, samples), &Control::default());
        let (whole, name) = (whole.unwrap(), integrator.name());
        for pixel in [[0, 0], [3, 3], [4, 4], [6, 3], [8, 6], [4, 1]] {
            let (mut sum, mut total) = (Rgb::BLACK, Rgb::BLACK);
            let (mean, statistics) = inspect(&job, pixel, &Control::default(), |sample| {
                sum += sample.radiance;
                let lights = sample.vertices.iter().flat_map(|vertex| &vertex.contributions);
                total += lights.fold(sample.unrecorded, |sum, contribution| sum + contribution.radiance);
            })
            .unwrap();
            let place = (pixel[1] * 9 + pixel[0]) as usize;
            assert_eq!(mean, whole.means()[place], "{name}, pixel {pixel:?}");
            assert_eq!(statistics, whole.statistics(place));
            assert!(difference(sum, total) < 1e-4, "{name}, pixel {pixel:?}: {sum:?} {total:?}");
            assert!(difference(mean, sum / samples as f32) < 1e-4);
        }
    }
}

/// Summary of the recorded samples.
#[derive(Default)]
struct Summary {
    events: BTreeSet<(Scattering, bool)>,
    sources: BTreeSet<LightSource>,
    by_spheres: u32,
    by_path_kind: [u32; 3],
}

impl Summary {
    /// Checks a vertex against its parent.
    fn place(&mut self, sample: &InspectedSample, number: usize) {
        let vertex = &sample.vertices[number];
        assert_eq!(vertex.parent.is_none(), number == 0);
        let Some(parent) = vertex.parent.map(|parent| &sample.vertices[parent as usize]) else { return };
        let event = vertex.event.unwrap();
        self.events.insert((event.scattering, event.transmitted));
        assert!(vertex.parent < Some(number as u32));
        assert_eq!(vertex.depth, parent.depth + u32::from(event.scattering != Scattering::PassThrough));
        let from = parent.scattered_at.unwrap_or_else(|| parent.hit.unwrap().surface.point);
        assert_eq!(parent.scattered_at.is_some(), event == ScatterEvent::VOLUME);
        assert!((vertex.ray.origin - from).length() < 1e-3, "{vertex:?} {from}");
    }

    /// Checks a contribution against its vertex.
    fn contribution(&mut self, vertex: &PathVertex, contribution: &LightContribution, apart: &SeparateLights) {
        self.sources.insert(apart.source(contribution.group).0);
        self.by_path_kind[contribution.path_kind as usize] += 1;
        let more = if contribution.is_light_sample { 2 } else { 1 };
        assert!(contribution.sphere.is_some() || contribution.segments == vertex.depth + more);
        assert_eq!(contribution.path_kind, PathKind::from_segments(contribution.segments));
        if let Some((sphere, is_mirror)) = &contribution.sphere {
            self.by_spheres += 1;
            assert!([1, 4].contains(&sphere.shape));
            assert_eq!(contribution.segments, vertex.depth + if *is_mirror { 3 } else { 4 });
        }
    }
}

#[test]
fn inspected_vertices_are_consecutive_and_classified() {
    let size = UVec2::new(15, 11);
    let camera = look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", size);
    let (world, apart) = room().with_separate_lights();
    let integrator = Path::default().into();
    let job = job(&world, &camera, &integrator, 64);
    let mut summary = Summary::default();
    for y in 0..size.y {
        let check = |sample: InspectedSample| {
            (0..sample.vertices.len()).for_each(|number| summary.place(&sample, number));
            for vertex in &sample.vertices {
                vertex.contributions.iter().for_each(|contribution| summary.contribution(vertex, contribution, &apart));
            }
        };
        inspect(&job, [7, y], &Control::default(), check).unwrap();
    }
    let Summary { events, sources, by_spheres, by_path_kind } = summary;
    let expected = [LightSource::Background, LightSource::Light(0), LightSource::Light(1), LightSource::Entry(0)];
    assert!(expected.iter().all(|source| sources.contains(source)), "{sources:?}");
    let expected = [
        (Scattering::Diffuse, false),
        (Scattering::Specular, true),
        (Scattering::Specular, false),
        (Scattering::Volume, false),
    ];
    assert!(expected.iter().all(|event| events.contains(event)), "{events:?}");
    assert!(by_spheres > 0 && by_path_kind.iter().all(|count| *count > 0), "{by_spheres} {by_path_kind:?}");
}

#[test]
fn cancelled_inspection_ends() {
    let camera = look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", PIXEL);
    let (world, integrator) = (room(), Path::default().into());
    let control = Control::default();
    control.cancel();
    assert_eq!(inspect(&job(&world, &camera, &integrator, 4), [0, 0], &control, |_| {}), Err(Cancelled));
}
