//! Contract tests of all lights, and the soft shadows of lights with an extent.

use super::*;
use juggler_math::testing::{Random, chi_squared, chi_squared_directions, close, close3};
use juggler_math::warp;

/// Significance level of each test: 1e-3 for both tests of this file together.
const SIGNIFICANCE: f64 = 5e-4;

fn point(position: Vec3, extent: Extent) -> Point {
    Point { position, extent: Some(extent), ..Point::default() }
}

/// Point of the light that a sample hits.
fn sampled_point(from: Vec3, sample: &LightSample) -> Vec3 {
    from + sample.wi * sample.distance
}

#[test]
fn samples_are_finite_and_unit_at_any_point() {
    let mut random = Random::new(91);
    for light in prepared_examples() {
        light.check().unwrap();
        assert!(light.ambient().is_finite() && light.shadow_samples() >= 1);
        for size in [0.0, 1e-30, 1e-3, 1.0, 300.0, 1e6, 1e18, 1e30] {
            for _ in 0..100 {
                let from = random.point(size);
                let Some(sample) = light.sample(from, random.vec2()) else { continue };
                assert!(close(sample.wi.length(), 1.0, 1e-6), "{light:?} {from} {sample:?}");
                assert!(sample.radiance.is_finite() && !sample.radiance.is_black() && sample.distance > 0.0);
                if let Some((center, radius)) = light.bounding_sphere().filter(|_| size <= 300.0) {
                    let off = (sampled_point(from, &sample) - center).length();
                    assert!(off <= radius + 1e-5 * (size + 1000.0), "{light:?}: {off} from its center");
                }
            }
        }
    }
}

/// Examples after [`Light::prepare`], as a world stores them.
fn prepared_examples() -> Vec<AnyLight> {
    let mut lights = AnyLight::examples();
    lights.iter_mut().for_each(|light| light.prepare());
    lights
}

/// Luminance of the radiant flux, for a light with a given `power`.
fn watts(light: &AnyLight) -> Option<f32> {
    let (power, color) = match light {
        AnyLight::Point(point) => (point.power, point.color),
        AnyLight::Spot(spot) => (spot.power, spot.color),
        AnyLight::Area(area) => (area.power, area.color),
        _ => (None, Rgb::BLACK),
    };
    Some(power? * color.luminance())
}

#[test]
fn power_is_the_integral_over_directions() {
    let mut random = Random::new(92);
    for (mut light, center) in AnyLight::examples().into_iter().filter_map(|light| match &light {
        AnyLight::Point(point) => Some((light.clone(), point.position)),
        AnyLight::Spot(spot) => Some((light.clone(), spot.position)),
        AnyLight::Area(area) => Some((light.clone(), area.position)),
        _ => None,
    }) {
        let (radius, count, watts) = (50.0f32, 1_000_000, watts(&light));
        light.prepare();
        let (stated, mut sum) = (f64::from(light.power(radius)), 0.0);
        for _ in 0..count {
            let from = center + warp::uniform_sphere(random.vec2()) * radius;
            sum += light.sample(from, random.vec2()).map_or(0.0, |sample| f64::from(sample.radiance.luminance()));
        }
        let power = sum / f64::from(count) * f64::from(warp::UNIFORM_SPHERE_PDF.recip() * radius * radius);
        if let Some(watts) = watts {
            assert!((stated / f64::from(watts) - 1.0).abs() < 1e-3, "{light:?}: {stated}");
        }
        assert!((power / stated - 1.0).abs() < 0.02, "{light:?}: {power} {stated}");
    }
    assert_eq!(Directional::default().power(2.0), 4.0 * std::f32::consts::PI);
    assert_eq!(Ambient::default().power(2.0), 0.0);
}

#[test]
fn sphere_extent_is_sampled_uniformly_on_its_facing_hemisphere() {
    let (center, from) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, 40.0));
    let light = point(center, Extent::Sphere { radius: 5.0 });
    let direction = |u| {
        let offset = sampled_point(from, &light.sample(from, u)?) - center;
        assert!(close(offset.length(), 5.0, 1e-5) && offset.z > -1e-4, "{offset}");
        Some(offset / 5.0)
    };
    let half = |w: Vec3| if w.z >= 0.0 { warp::uniform_hemisphere_pdf(w) } else { 0.0 };
    chi_squared_directions(direction, half, 1_000_000, SIGNIFICANCE).unwrap();
    // Also from a point inside.
    let sample = light.sample(center + Vec3::X, Vec2::new(0.3, 0.8)).unwrap();
    assert!(close(sampled_point(center + Vec3::X, &sample).distance(center), 5.0, 1e-5));
}

#[test]
fn square_extent_is_sampled_uniformly() {
    let mut random = Random::new(93);
    let (center, from) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.0, 7.0, 1.0));
    let light = point(center, Extent::Square { side: 2.0 });
    let axis = (center - from).normalize();
    let frame = juggler_math::Frame::around(-axis);
    let mut observed = [0.0; 64];
    for _ in 0..1_000_000 {
        let offset = sampled_point(from, &light.sample(from, random.vec2()).unwrap()) - center;
        assert!(offset.dot(axis).abs() < 1e-5);
        let cell = |v: f32| (((v + 1.0) * 4.0) as usize).min(7);
        observed[cell(offset.dot(frame.tangent)) * 8 + cell(offset.dot(frame.bitangent))] += 1.0;
    }
    chi_squared(&observed, &[15_625.0; 64], SIGNIFICANCE).unwrap();
}

#[test]
fn light_extent_changes_directions_but_not_irradiance() {
    let mut random = Random::new(94);
    let hard = Point { position: Vec3::new(0.0, 9.0, 0.0), intensity: Some(7.0), ..Point::default() };
    for extent in [Extent::Sphere { radius: 2.0 }, Extent::Square { side: 3.0 }] {
        let soft = Point { extent: Some(extent), ..hard.clone() };
        let from = random.point(3.0);
        let (a, b) = (hard.sample(from, Vec2::ZERO).unwrap(), soft.sample(from, random.vec2()).unwrap());
        assert!(a.radiance == b.radiance && a.wi != b.wi);
    }
    let none = Point { extent: Some(Extent::Sphere { radius: 0.0 }), ..hard.clone() };
    let (a, b) = (hard.sample(Vec3::X, Vec2::ZERO).unwrap(), none.sample(Vec3::X, random.vec2()).unwrap());
    assert!(close3(a.wi, b.wi, 1e-6) && close(a.distance, b.distance, 1e-6));
}

/// Visible fraction of a light ten units above the origin, behind a half-plane five units up that
/// covers all x below `edge`.
fn visible_fraction(extent: Extent, edge: f32) -> f64 {
    let light = point(Vec3::new(0.0, 10.0, 0.0), extent);
    let mut random = Random::new(95);
    let count = 40_000;
    let passes = (0..count).filter(|_| {
        let sample = light.sample(Vec3::ZERO, random.vec2()).unwrap();
        sample.wi.x * 5.0 / sample.wi.y >= edge
    });
    passes.count() as f64 / f64::from(count)
}

#[test]
fn penumbra_of_a_square_is_linear() {
    for (edge, expected) in [(-1.1f32, 1.0), (-0.5, 0.75), (0.0, 0.5), (0.25, 0.375), (0.9, 0.05), (1.1, 0.0)] {
        // The projection of the edge onto the square of side 4 lies at twice the edge's x.
        let visible = visible_fraction(Extent::Square { side: 4.0 }, edge);
        assert!((visible - expected).abs() < 0.01, "{edge}: {visible}");
    }
}

#[test]
fn penumbra_of_a_sphere_is_a_cap() {
    // A point c + r h, with h in the lower hemisphere, is visible where 5 h_x - edge h_y >= edge 10
    // / r. These points form a cap with the fraction 1 - τ of the hemisphere, if the cap does not
    // cross the rim, where τ = 2.5 edge / √(25 + edge²).
    let tau = |edge: f64| 2.5 * edge / (25.0 + edge * edge).sqrt();
    for (edge, expected) in [(0.0, 0.5), (2.1, 1.0 - tau(2.1)), (-2.1, tau(2.1)), (2.2, 0.0), (-2.2, 1.0)] {
        let visible = visible_fraction(Extent::Sphere { radius: 4.0 }, edge as f32);
        assert!((visible - expected).abs() < 0.01, "{edge}: {visible} {expected}");
    }
}

/// Light arrives only where the bounds allow it, with no more than the power of the bounds.
#[test]
fn bounds_hold_all_light() {
    use crate::emitter::LightTree;
    let mut random = Random::new(96);
    for light in prepared_examples() {
        assert_eq!(light.bounds(9.0).is_some(), light.bounding_sphere().is_some());
        let Some(bounds) = light.bounds(9.0) else { continue };
        let tree = LightTree::build(&[bounds]);
        for _ in 0..2000 {
            let from = bounds.bounds.center() + random.unit_vector() * 9.0 + random.point(0.5);
            let Some(sample) = light.sample(from, random.vec2()) else { continue };
            assert!(
                bounds
                    .bounds
                    .grown(1e-3 + bounds.bounds.center().length() * 1e-6)
                    .contains(sampled_point(from, &sample))
            );
            assert!(tree.probability(from, Vec3::ZERO, 0) > 0.0, "{light:?} {from}");
            assert!(tree.probability(from, sample.wi, 0) > 0.0, "{light:?} {from}");
        }
        // The largest irradiance at that radius, times 4π radius², equals the power of the bounds.
        let arrives = |_| {
            let from = bounds.bounds.center() + random.unit_vector() * 9.0;
            light.sample(from, random.vec2()).map_or(0.0, |sample| sample.radiance.luminance())
        };
        let max_power = (0..20_000).map(arrives).fold(0.0, f32::max) * 81.0 * 4.0 * std::f32::consts::PI;
        assert!((max_power / bounds.power - 1.0).abs() < 0.05, "{light:?}: {max_power} {}", bounds.power);
    }
}

#[test]
fn json_round_trips() {
    for mut light in AnyLight::examples() {
        // The JSON does not contain the photometric data of the file.
        if let Some(ies) = light.ies() {
            *ies = Ies::from_file("luminaire.ies");
        }
        let text = serde_json::to_string(&light).unwrap();
        assert_eq!(serde_json::from_str::<AnyLight>(&text).unwrap(), light, "{text}");
        assert!(text.starts_with(&format!("{{\"{}\":", light.name())), "{text}");
    }
}

#[test]
fn invalid_fields_are_named() {
    for (json, field) in [
        (r#"{"point": {"position": [0, 1e39, 0]}}"#, "position"),
        (r#"{"point": {"color": [-1, 0, 0]}}"#, "color"),
        (r#"{"point": {"intensity": -1}}"#, "intensity"),
        (r#"{"point": {"intensity": 1e20, "color": [1e20, 0, 0]}}"#, "intensity"),
        (r#"{"point": {"color": [2e30, 0, 0]}}"#, "color"),
        (r#"{"point": {"samples": 0}}"#, "samples"),
        (r#"{"point": {"attenuation": {}}}"#, "attenuation"),
        (r#"{"point": {"attenuation": {"linear": -1}}}"#, "attenuation.linear"),
        (r#"{"point": {"extent": {"sphere": {"radius": -1}}}}"#, "extent.sphere.radius"),
        (r#"{"spot": {"extent": {"square": {"side": 1e39}}}}"#, "extent.square.side"),
        (r#"{"point": {"power": -1}}"#, "power"),
        (r#"{"point": {"power": 5, "intensity": 1}}"#, "power"),
        (r#"{"point": {"power": 1e20, "color": [1e20, 0, 0]}}"#, "power"),
        (r#"{"spot": {"power": 5, "intensity": 1}}"#, "power"),
        (r#"{"area": {"power": 5, "radiance": 1}}"#, "power"),
        (r#"{"area": {"power": 1e38, "shape": {"disk": {"radius": 1e-10}}}}"#, "power"),
        (r#"{"area": {"look_at": [0, 1, 0], "direction": [0, 1, 0]}}"#, "look_at"),
        (r#"{"area": {"position": [0, 1, 0], "look_at": [0, 1, 0]}}"#, "look_at"),
        (r#"{"area": {"direction": [0, 0, 0]}}"#, "direction"),
        (r#"{"area": {"shape": {"rectangle": {"size": [1, 0]}}}}"#, "shape.rectangle.size"),
        (r#"{"area": {"shape": {"sphere": {"radius": 1e39}}}}"#, "shape.sphere.radius"),
        (r#"{"area": {"radiance": -1}}"#, "radiance"),
        (r#"{"spot": {"beam_degrees": 40}}"#, "cutoff_degrees"),
        (r#"{"spot": {"cutoff_degrees": 200}}"#, "cutoff_degrees"),
        (r#"{"spot": {"beam_exponent": -1}}"#, "beam_exponent"),
        (r#"{"spot": {"direction": [0, 0, 0]}}"#, "direction"),
        (r#"{"directional": {"direction": [0, 1e39, 0]}}"#, "direction"),
        (r#"{"directional": {"angle_degrees": 181}}"#, "angle_degrees"),
        (r#"{"directional": {"samples": 0}}"#, "samples"),
        (r#"{"point": {"ies": {"file": "a", "direction": [0, 0, 0]}}}"#, "ies.direction"),
        (r#"{"spot": {"ies": {"file": "a", "rotation_degrees": 1e9}}}"#, "ies.rotation_degrees"),
        (r#"{"ambient": {"intensity": 1e39}}"#, "intensity"),
    ] {
        let error = serde_json::from_str::<AnyLight>(json).unwrap().check().unwrap_err();
        assert_eq!(error.field, field, "{json} {error}");
    }
}
