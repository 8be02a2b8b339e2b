//! What progress says.

use super::*;

const LOOK: Look = Look { fraction: 0.255, rays: 7, rays_per_second: 1.5e6, eta: None, toward: None, course: None };

#[test]
fn looks_in_words() {
    let look = Look { eta: Some(Duration::from_millis(61_400)), ..LOOK };
    assert_eq!(look.words(), " 25.5 %, 1.50 million rays/s, 1m01s left");
    let last = Look { fraction: 0.999, eta: Some(Duration::from_millis(4)), ..look };
    assert_eq!(last.words(), " 99.9 %, 1.50 million rays/s");
    assert_eq!(Look { fraction: 0.0, rays_per_second: 0.0, ..LOOK }.words(), "  0.0 %, 0 rays/s");
}

#[test]
fn limits_of_time_and_noise_are_told() {
    let toward = Some(Toward::Time(Duration::from_millis(2_600), Duration::from_secs(10)));
    let timed = Look { eta: Some(Duration::from_secs(7)), toward, ..LOOK };
    assert_eq!(timed.words(), " 25.5 %, 3s of 10.0s, 1.50 million rays/s");
    assert_eq!(
        (timed.json()["elapsed_seconds"].as_f64(), timed.json()["limit_seconds"].as_f64()),
        (Some(2.6), Some(10.0))
    );
    let toward = Some(Toward::Noise(Some(0.034), 0.02));
    let noisy = Look { eta: Some(Duration::from_secs(7)), toward, ..LOOK };
    assert_eq!(noisy.words(), " 25.5 %, noise 0.0340, to become 0.02, 1.50 million rays/s, 7s left");
    assert_eq!(noisy.json()["noise"].as_f64(), Some(0.034));
    let early = Look { fraction: 0.0, toward: Some(Toward::Noise(None, 0.02)), ..LOOK };
    assert_eq!(early.words(), "  0.0 %, noise not known yet, to become 0.02, 1.50 million rays/s");
    assert!(early.json()["noise"].is_null());
}

#[test]
fn a_time_limit_is_what_a_render_goes_by() {
    let control = Control::default();
    let Some(start) = Instant::now().checked_sub(Duration::from_secs(4)) else { return };
    let look = Look::at(&control, &Goal::Time(Duration::from_secs(10), u64::MAX), start, None);
    assert!((0.4..0.5).contains(&look.fraction), "{}", look.fraction);
    assert!(look.eta.is_some_and(|eta| (5.0..=6.0).contains(&eta.as_secs_f64())), "{:?}", look.eta);
}

#[test]
fn frames_have_their_time_together() {
    let second = Course::new(4).after(Some(Duration::from_secs(10)));
    assert_eq!(second.left(0.5, Duration::from_secs(5)), Some(Duration::from_secs(25)));
    assert_eq!(second.fraction(0.5), 0.375);
    // What was there already tells nothing of how long the others take.
    let third = second.after(None);
    assert_eq!((third.number, third.left(0.5, Duration::from_secs(5))), (3, Some(Duration::from_secs(15))));
    assert_eq!(Course::new(4).left(0.0, Duration::ZERO), None);
    let course = Some((second, Some(Duration::from_secs(25))));
    let look = Look { fraction: 0.5, course, ..LOOK };
    assert_eq!(look.words(), "frame 2 of 4,  37.5 %, 1.50 million rays/s, 25s left");
    assert_eq!((look.whole(), look.json()["film_eta_seconds"].as_f64()), (0.375, Some(25.0)));
}

#[test]
fn nothing_rendered_is_nothing_known() {
    let look = Look::at(&Control::default(), &Goal::Samples(100), Instant::now(), None);
    assert!(look.fraction == 0.0 && look.eta.is_none());
}
