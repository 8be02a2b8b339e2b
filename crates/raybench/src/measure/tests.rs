use super::*;
use crate::kernel::{self, Kernel};
use crate::meshes::MeshSpec;
use crate::rays::{self, RaySet};
use juggler_bvh::Quality;
use juggler_math::Vec3;
use std::sync::Mutex;
use std::time::Duration;

fn numbered(count: usize) -> Vec<Ray> {
    (0..count).map(|i| Ray::new(Vec3::splat(i as f32), Vec3::Z)).collect()
}

#[test]
fn every_ray_is_traced_equally_often_by_any_number_of_threads() {
    for (count, passes) in [(0, 3), (1000, 65), (4097, 15), (30_000, 2), (100_001, 1)] {
        for threads in [1, 2, 5] {
            let origins = Mutex::new(Vec::new());
            let trace = |rays: &[Ray], _: &mut Scratch| {
                origins.lock().unwrap().extend(rays.iter().map(|ray| ray.origin.x as usize));
                HitSummary { hits: rays.len() as u64, distance: rays.iter().map(|ray| f64::from(ray.origin.x)).sum() }
            };
            let (time, summary) = run(&numbered(count), &trace, threads, passes);
            let mut origins = origins.into_inner().unwrap();
            origins.sort_unstable();
            let expected: Vec<usize> = (0..count).flat_map(|ray| std::iter::repeat_n(ray, passes)).collect();
            assert!(origins == expected, "{count} rays, {threads} threads");
            assert_eq!(summary.hits, count as u64);
            let sum = (count * count.saturating_sub(1) / 2) as f64;
            assert!((summary.distance - sum).abs() <= 1e-9 * sum);
            assert!(time.wall > 0.0 && time.cpu >= 0.0);
        }
    }
}

#[test]
fn tracers_take_turns_and_each_comes_first() {
    let order = Mutex::new(Vec::new());
    let note = |name: char| {
        order.lock().unwrap().push(name);
        HitSummary::default()
    };
    let (a, b) = (|_: &[Ray], _: &mut Scratch| note('a'), |_: &[Ray], _: &mut Scratch| note('b'));
    let timings = measure_alternately(&numbered(CHUNK), &[&a, &b], 1, 3);
    assert_eq!(timings.iter().map(|timing| timing.repeats.len()).collect::<Vec<_>>(), [3, 3]);
    let order = order.into_inner().unwrap();
    let (warm_up, timed) = order.split_at(2);
    let passes = timed.len() / 6;
    assert!(passes > 1 && warm_up == ['a', 'b']);
    let turns: Vec<char> = timed.chunks(passes).map(|turn| turn[0]).collect();
    assert_eq!(turns, ['a', 'b', 'b', 'a', 'a', 'b']);
    assert!(timed.chunks(passes).all(|turn| turn.iter().all(|name| *name == turn[0])));
}

#[test]
fn slower_tracer_has_the_lower_rate() {
    let wait = |milliseconds| {
        move |_: &[Ray], _: &mut Scratch| {
            let start = Stopwatch::start(CpuClock::Thread);
            while start.elapsed().cpu < Duration::from_millis(milliseconds).as_secs_f64() {}
            HitSummary::default()
        }
    };
    let (fast, slow) = (wait(1), wait(4));
    let timings = measure_alternately(&numbered(CHUNK), &[&fast, &slow], 1, 3);
    let ratio = timings[0].speedup_over(&timings[1]);
    assert!((3.0..5.0).contains(&ratio), "{ratio}");
    let expected = CHUNK as f64 * 1e-3;
    assert!((0.85..1.03).contains(&(timings[0].cpu_rate() / expected)), "{}", timings[0].cpu_rate());
    assert!(timings[0].wall_rate() <= timings[0].cpu_rate() * 1.05);
}

#[test]
fn median_of_odd_even_and_empty_lists() {
    assert_eq!((median([3.0, 1.0, 2.0]), median([4.0, 1.0]), median([5.0])), (2.0, 2.5, 5.0));
    assert!(
        median([]).is_nan() && measure_alternately(&[], &[&|_, _| HitSummary::default()], 1, 1)[0].cpu_rate().is_nan()
    );
}

#[test]
fn hit_summaries_distinguish_tracers() {
    let summary = HitSummary::from_distances([Some(1.0), None, Some(2.5)].into_iter());
    assert_eq!(summary, HitSummary { hits: 2, distance: 3.5 });
    assert!(summary.agrees(&summary) && !summary.agrees(&HitSummary { hits: 3, ..summary }));
    assert!(
        !summary.agrees(&HitSummary { distance: 3.5001, ..summary })
            && summary.agrees(&HitSummary { distance: 3.5 + 1e-12, ..summary })
    );
    assert_eq!(HitSummary::from_occluded([true, false, true].into_iter()).hits, 2);
}

#[test]
fn all_kernels_agree_with_single_ray_queries() {
    let mesh = MeshSpec::parse("hall:3").unwrap().make();
    let trees = [Quality::Balanced, Quality::Best].map(|quality| kernel::build(&mesh, quality).unwrap());
    for (_, bvh) in trees.into_iter().flat_map(kernel::with_tests) {
        for RaySet { kind, rays } in rays::make(&mesh, &bvh, 12_000) {
            let hits = match kind.query() {
                rays::QueryKind::Closest => rays.iter().filter(|ray| bvh.closest(ray).is_some()).count(),
                rays::QueryKind::Any => rays.iter().filter(|ray| bvh.any(ray)).count(),
            };
            let summaries = Kernel::ALL.map(|kernel| {
                let trace = |rays: &[Ray], scratch: &mut Scratch| kernel.trace(&bvh, kind.query(), rays, scratch);
                run(&rays, &trace, 2, 1).1
            });
            assert_eq!(summaries[0].hits, hits as u64, "{kind:?}");
            assert!(summaries.iter().all(|other| other.agrees(&summaries[0])), "{kind:?}: {summaries:?}");
        }
    }
}
