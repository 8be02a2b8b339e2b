//! Reconstruction filters on the film: an edge has the profile of the filter's integral.

use super::*;
use juggler_camera::film::AnyFilter;
use juggler_integrator::Path;

/// ∫ f(x) dx from 0 to `end` of the filter of Mitchell and Netravali with B = C = 1/3 (1988,
/// equation 8), for 0 <= `end` <= 2.
fn mitchell_integral(end: f64) -> f64 {
    let inner = |x: f64| (7.0 / 4.0 * x.powi(4) - 4.0 * x.powi(3) + 16.0 / 3.0 * x) / 6.0;
    let outer = |x: f64| (-7.0 / 12.0 * x.powi(4) + 4.0 * x.powi(3) - 10.0 * x * x + 32.0 / 3.0 * x) / 6.0;
    if end < 1.0 { inner(end) } else { inner(1.0) + outer(end) - outer(1.0) }
}

/// The negative lobes of the filter overshoot by 1.4 % on both sides of an edge.
#[test]
fn mitchell_filter_rings_at_an_edge() {
    let (size, samples, edge) = (UVec2::new(12, 1), 4096, 0.45);
    let emitter = r#"{"emissive": {"radiance": 1, "sides": "both"}}"#;
    let world = world(&[(r#"{"rectangle": {"size": [100, 100]}}"#, Vec3::X * (50.0 + edge), emitter)], &[], Rgb::BLACK);
    // One pixel per unit, x to the right.
    let camera = r#"{"orthographic": {"eye": [0, 9, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "height": 1}}"#;
    let camera = read::<AnyCamera>(camera).projection(size).unwrap().into();
    let integrator = Path::default().into();
    let filter = read::<AnyFilter>(r#"{"mitchell": {}}"#).sampler(samples);
    let job = Job { filter, ..job(&world, &camera, &integrator, samples) };
    let work = Work::first(Rect { x: 0, y: 0, width: size.x, height: size.y }, samples);
    let found = job.render(&work, &Control::default()).unwrap().means();
    for (pixel, found) in (0u8..).zip(&found) {
        let center = f64::from(pixel) + 0.5 - 6.0 - f64::from(edge);
        let expected = 0.5 + mitchell_integral(center.abs().min(2.0)).copysign(center);
        assert!((f64::from(found.r) - expected).abs() < 2e-3, "pixel {pixel}: {found:?} for {expected}");
    }
    let [low, high] = [f32::min, f32::max].map(|pick| found.iter().map(|pixel| pixel.r).fold(0.5, pick));
    assert!(low < -0.01 && high > 1.01, "{low} to {high}");
}
