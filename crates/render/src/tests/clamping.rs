//! Tests of clamping: the remaining and the removed radiance add up, for any division of the work.

use super::*;
use juggler_camera::film::{ClampedRadiance, Film, Mitchell, Tiling};
use juggler_integrator::Path;
use rayon::ThreadPoolBuilder;
use std::convert::Infallible;

const SIZE: UVec2 = UVec2::new(23, 18);
const REGION: Rect = Rect { x: 0, y: 0, width: SIZE.x, height: SIZE.y };

/// A bright sphere in a corner of glossy surfaces.
fn corner() -> World {
    let floor = r#"{"disk": {"radius": 6}}"#;
    let lambert = r#"{"diffuse": {"reflectance": [0.8, 0.6, 0.3]}}"#;
    let metal = r#"{"conductor": {"roughness": 0.3}}"#;
    let bright = r#"{"phong": {"emission": [30, 20, 5]}}"#;
    let objects = [
        (floor, Vec3::new(0.0, -1.0, 0.0), lambert),
        (r#"{"sphere": {"radius": 0.9}}"#, Vec3::new(-0.8, 0.0, 0.0), metal),
        (r#"{"sphere": {"radius": 0.7}}"#, Vec3::new(0.8, -0.3, 0.3), lambert),
        (r#"{"sphere": {"radius": 0.3}}"#, Vec3::new(0.3, 1.2, 0.6), bright),
    ];
    world(&objects, &[], Rgb::splat(0.2))
}

fn path(direct: Option<f32>, indirect: Option<f32>) -> AnyIntegrator {
    Path { max_depth: 6, clamp_direct: direct, clamp_indirect: indirect, ..Path::default() }.into()
}

/// Runs `test` with a filter that has positive and negative weights.
fn with_job<T>(integrator: &AnyIntegrator, samples: u32, test: impl FnOnce(&Job) -> T) -> T {
    let (world, camera) = (corner(), look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", SIZE));
    let filter = Mitchell::default().sampler(samples);
    test(&Job { filter, ..job(&world, &camera, integrator, samples) })
}

fn tile(integrator: &AnyIntegrator, samples: u32) -> Tile {
    with_job(integrator, samples, |job| job.render(&Work::first(REGION, samples), &Control::default()).unwrap())
}

fn light(tile: &Tile) -> f64 {
    tile.means().iter().map(|Rgb { r, g, b }| (f64::from(*r) + f64::from(*g) + f64::from(*b)) / 3.0).sum()
}

#[test]
fn clamped_and_remaining_radiance_sum_to_the_unclamped() {
    for samples in [1, 37] {
        let all = light(&tile(&path(None, None), samples));
        let mut taken = vec![];
        for (direct, indirect) in [(Some(1.5), None), (None, Some(0.05)), (Some(1.5), Some(0.05))] {
            let tile = tile(&path(direct, indirect), samples);
            taken.push(tile.clamped().total());
            let sum = light(&tile) + tile.clamped().total();
            assert!((sum / all - 1.0).abs() < 1e-5, "{direct:?}, {indirect:?}: {sum} instead of {all}");
        }
        assert!(taken.iter().all(|taken| *taken > 0.001 * all), "{taken:?} of {all}");
        assert!((taken[0] + taken[1] - taken[2]).abs() < 1e-6 * all, "each light is one or the other: {taken:?}");
    }
}

#[test]
fn clamping_limits_above_all_contributions_change_no_bit() {
    let (plain, clamped) = (tile(&path(None, None), 20), tile(&path(Some(1e9), Some(1e9)), 20));
    assert_eq!(plain, clamped);
    assert_eq!(clamped.clamped(), ClampedRadiance::default());
    assert_eq!(path(None, Some(f32::INFINITY)).clamp(), None);
}

#[test]
fn clamped_contributions_stay_below_the_limit() {
    // With a single sample: at most one light sample and one emission at each of six vertices.
    let means = tile(&path(Some(0.5), Some(0.5)), 1).means();
    let brightest = means.iter().map(|mean| mean.max_channel()).fold(0.0, f32::max);
    assert!(brightest > 0.5 && brightest <= 0.5 * 12.0, "{brightest}");
}

#[test]
fn clamped_sum_does_not_depend_on_threads_or_shards() {
    let integrator = path(Some(1.5), Some(0.05));
    let whole = tile(&integrator, 40).clamped();
    for threads in [1, 2, 4] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            with_job(&integrator, 40, |job| {
                let schedule = Schedule { band_pixels: 1 << (4 * threads), ..Schedule::default() };
                let control = Control::default();
                let rows = |_| Ok::<(), Cancelled>(());
                assert_eq!(render(job, REGION, schedule, &control, rows), Ok(whole), "{threads} threads");
                // Render in parts, the first of which ends within a block.
                let film = Film::new(Tiling::new(REGION), 0..7);
                render_progressive(job, &film, StopCriterion::Samples, &control).unwrap();
                let rest = Film::new(Tiling::new(REGION), 0..40);
                film.tiles().for_each(|(number, tile)| assert_eq!(rest.add(number, tile), Ok(true)));
                render_progressive(job, &rest, StopCriterion::Evenly, &control).unwrap();
                assert_eq!(rest.clamped(), whole, "{threads} threads, in parts");
                let developed: Result<(), Infallible> = rest.develop(|_| Ok(()));
                assert_eq!(developed, Ok(()));
            });
        });
    }
}
