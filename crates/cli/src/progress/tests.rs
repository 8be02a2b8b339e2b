//! Tests of progress reports.

use super::*;

const SNAPSHOT: Snapshot =
    Snapshot { fraction: 0.255, rays: 7, rays_per_second: 1.5e6, eta: None, goal_progress: None, frame_progress: None };

#[test]
fn snapshots_as_text() {
    let snapshot = Snapshot { eta: Some(Duration::from_millis(61_400)), ..SNAPSHOT };
    assert_eq!(snapshot.text(), " 25.5 %, 1.50 million rays/s, 1m01s left");
    let last = Snapshot { fraction: 0.999, eta: Some(Duration::from_millis(4)), ..snapshot };
    assert_eq!(last.text(), " 99.9 %, 1.50 million rays/s");
    assert_eq!(Snapshot { fraction: 0.0, rays_per_second: 0.0, ..SNAPSHOT }.text(), "  0.0 %, 0 rays/s");
}

#[test]
fn limits_of_time_and_noise_are_reported() {
    let goal_progress = Some(GoalProgress::Time(Duration::from_millis(2_600), Duration::from_secs(10)));
    let timed = Snapshot { eta: Some(Duration::from_secs(7)), goal_progress, ..SNAPSHOT };
    assert_eq!(timed.text(), " 25.5 %, 3s of 10.0s, 1.50 million rays/s");
    assert_eq!(
        (timed.json()["elapsed_seconds"].as_f64(), timed.json()["limit_seconds"].as_f64()),
        (Some(2.6), Some(10.0))
    );
    let goal_progress = Some(GoalProgress::Noise(Some(0.034), 0.02));
    let noisy = Snapshot { eta: Some(Duration::from_secs(7)), goal_progress, ..SNAPSHOT };
    assert_eq!(noisy.text(), " 25.5 %, noise 0.0340, target 0.02, 1.50 million rays/s, 7s left");
    assert_eq!(noisy.json()["noise"].as_f64(), Some(0.034));
    let early = Snapshot { fraction: 0.0, goal_progress: Some(GoalProgress::Noise(None, 0.02)), ..SNAPSHOT };
    assert_eq!(early.text(), "  0.0 %, noise not known yet, target 0.02, 1.50 million rays/s");
    assert!(early.json()["noise"].is_null());
}

#[test]
fn progress_follows_the_time_limit() {
    let control = Control::default();
    let Some(start) = Instant::now().checked_sub(Duration::from_secs(4)) else { return };
    let snapshot = Snapshot::at(&control, &Goal::Time(Duration::from_secs(10), u64::MAX), start, None);
    assert!((0.4..0.5).contains(&snapshot.fraction), "{}", snapshot.fraction);
    assert!(snapshot.eta.is_some_and(|eta| (5.0..=6.0).contains(&eta.as_secs_f64())), "{:?}", snapshot.eta);
}

#[test]
fn remaining_time_is_estimated_over_all_frames() {
    let second = FrameProgress::new(4).after(Some(Duration::from_secs(10)));
    assert_eq!(second.left(0.5, Duration::from_secs(5)), Some(Duration::from_secs(25)));
    assert_eq!(second.fraction(0.5), 0.375);
    // An existing frame does not affect the estimate.
    let third = second.after(None);
    assert_eq!((third.number, third.left(0.5, Duration::from_secs(5))), (3, Some(Duration::from_secs(15))));
    assert_eq!(FrameProgress::new(4).left(0.0, Duration::ZERO), None);
    let frame_progress = Some((second, Some(Duration::from_secs(25))));
    let snapshot = Snapshot { fraction: 0.5, frame_progress, ..SNAPSHOT };
    assert_eq!(snapshot.text(), "frame 2 of 4,  37.5 %, 1.50 million rays/s, 25s left");
    assert_eq!((snapshot.whole(), snapshot.json()["film_eta_seconds"].as_f64()), (0.375, Some(25.0)));
}

#[test]
fn no_samples_give_no_estimate() {
    let snapshot = Snapshot::at(&Control::default(), &Goal::Samples(100), Instant::now(), None);
    assert!(snapshot.fraction == 0.0 && snapshot.eta.is_none());
}
