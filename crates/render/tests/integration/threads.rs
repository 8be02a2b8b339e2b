//! Results are bit-identical for any number of threads and any schedule.

use crate::probe::{Scene, path, read};
use juggler_camera::aov;
use juggler_camera::film::{AnyFilter, Rect};
use juggler_camera::sampler::AnySampler;
use juggler_camera::{AnyCamera, ShutterCamera};
use juggler_math::{NamedKind, Rgb, Transform, UVec2, Vec3};
use juggler_render::{CameraRays, Cancelled, Control, Job, Schedule, Scheduler, Work, render};
use juggler_world::World;
use std::time::{Duration, Instant};

const SIZE: UVec2 = UVec2::new(30, 22);
const SAMPLES: u32 = 6;

/// Glass, fog, textures, all kinds of lights, and a sky.
fn world() -> World {
    let textures = r#"{"tiles": {"checker": {"size": 0.5, "even": [0.9, 0.5, 0.2], "odd": [0.1, 0.3, 0.8]}},
        "clouds": {"fbm": {}}}"#;
    let tilt = Transform::rotation(Vec3::new(1.0, 0.3, 0.2), 2.6).unwrap();
    Scene::textured(textures)
        .with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": "tiles"}}"#)
        .with(
            r#"{"sphere": {"radius": 1}}"#,
            Vec3::new(-1.2, 1.0, 0.0),
            r#"{"dielectric": {"ior": 1.5, "medium": {"color": [0.5, 0.9, 0.7]}}}"#,
        )
        .with(
            r#"{"sphere": {"radius": 0.9}}"#,
            Vec3::new(1.2, 1.0, 0.0),
            r#"{"boundary": {"medium": {"scattering": [2, 1, 0.5], "anisotropy": 0.4}}}"#,
        )
        .with(r#"{"cuboid": {}}"#, Vec3::new(0.5, 0.3, 2.0), r#"{"dielectric": {"ior": 1.33, "roughness": 0.3}}"#)
        .with(
            r#"{"sphere": {"radius": 0.5}}"#,
            Vec3::new(0.0, 0.5, -1.5),
            r#"{"mask": {"opacity": "clouds", "material": {"conductor": {"metal": "gold", "roughness": 0.4}}}}"#,
        )
        .placed(
            r#"{"rectangle": {"size": [2, 2]}}"#,
            tilt.then(&Transform::translation(Vec3::Y * 4.0)),
            r#"{"emissive": {"radiance": "tiles", "scale": 5}}"#,
        )
        .lit(r#"{"point": {"position": [3, 3, 3], "intensity": 4}}"#)
        .in_light(0.2)
        .world()
}

fn camera() -> ShutterCamera {
    let json = r#"{"thin_lens": {"eye": [0, 2, 6], "look_at": [0, 0.8, 0], "lens_radius": 0.05, "focus_distance": 6}}"#;
    read::<AnyCamera>(json).projection(SIZE).unwrap().into()
}

fn bits(pixels: &[Rgb]) -> Vec<[u32; 3]> {
    pixels.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect()
}

fn with_job<T>(check: impl FnOnce(&Job) -> T) -> T {
    let (world, camera, integrator) = (world(), camera(), path(""));
    let (filter, pattern) = (read::<AnyFilter>(r#"{"box": {}}"#), read::<AnySampler>(r#"{"sobol": {}}"#));
    check(&Job {
        world: &world,
        camera: &camera,
        integrator: &*integrator,
        filter: filter.sampler(SAMPLES),
        pattern: pattern.point_set(SAMPLES),
        samples: SAMPLES,
        seed: 7,
        camera_rays: &CameraRays::default(),
        aovs: &aov::NO_AOVS,
        frames: None,
    })
}

const REGION: Rect = Rect { x: 0, y: 0, width: SIZE.x, height: SIZE.y };

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn pixels_do_not_depend_on_threads_and_tiles() {
    with_job(check_threads_and_tiles);
}

fn check_threads_and_tiles(job: &Job) {
    let whole = bits(&job.render(&Work::first(REGION, SAMPLES), &Control::default()).unwrap().means());
    for threads in [1, 2, 3] {
        for scheduler in Scheduler::ALL.iter().copied() {
            let mut rows = Vec::new();
            let schedule = Schedule { scheduler, band_pixels: 300 };
            on_threads(threads, || {
                render::<Cancelled>(job, REGION, schedule, &Control::default(), |band| {
                    rows.extend(band);
                    Ok(())
                })
            })
            .unwrap();
            assert_eq!(bits(&rows), whole, "{threads} threads, {scheduler:?}");
        }
    }
    for (x, y, width, height) in [(0, 0, 1, 1), (7, 3, 5, 9), (13, 20, 17, 2)] {
        let part = Rect { x, y, width, height };
        let pixels = bits(&job.render(&Work::first(part, SAMPLES), &Control::default()).unwrap().means());
        for (i, pixel) in (0u32..).zip(&pixels) {
            let (column, row) = (x + i % width, y + i / width);
            assert_eq!(*pixel, whole[(row * SIZE.x + column) as usize], "{column}, {row} of {part:?}");
        }
    }
    assert!(whole.iter().collect::<std::collections::BTreeSet<_>>().len() > 500, "a picture, not a color");
}

/// A region of several bands of the least height, and the schedule with these bands.
fn in_bands() -> (Rect, Schedule) {
    (Rect { height: 100, ..REGION }, Schedule { band_pixels: 1, ..Schedule::default() })
}

#[test]
fn a_band_is_rendered_while_the_one_before_is_passed_on() {
    let (region, schedule) = in_bands();
    let whole = region.area() * u64::from(SAMPLES);
    let (control, mut finished, mut bands) = (Control::default(), 0, 0);
    let pass_on = |rows: Vec<Rgb>| {
        (bands, finished) = (bands + 1, finished + rows.len() as u64 * u64::from(SAMPLES));
        let start = Instant::now();
        while finished < whole && control.samples() <= finished {
            assert!(start.elapsed() < Duration::from_secs(60), "nothing is rendered after band {bands}");
            std::thread::yield_now();
        }
        Ok(())
    };
    with_job(|job| on_threads(2, || render::<Cancelled>(job, region, schedule, &control, pass_on))).unwrap();
    assert_eq!((bands, finished), (4, whole));
}

#[test]
fn a_render_ends_when_its_rows_cannot_be_passed_on() {
    #[derive(Debug, PartialEq)]
    enum Failure {
        Full,
        Cancelled,
    }
    impl From<Cancelled> for Failure {
        fn from(_: Cancelled) -> Self {
            Self::Cancelled
        }
    }
    with_job(|job| {
        for threads in [1, 2] {
            let (control, (region, schedule)) = (Control::default(), in_bands());
            let result = on_threads(threads, || render(job, region, schedule, &control, |_| Err(Failure::Full)));
            assert_eq!(result.err(), Some(Failure::Full));
            // At most two bands of 32 rows were entered.
            assert!(control.samples() <= u64::from(2 * 32 * SIZE.x * SAMPLES), "{}", control.samples());
        }
    });
}
