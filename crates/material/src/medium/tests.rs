//! Media against closed forms.

use super::*;
use juggler_math::Vec3;
use juggler_math::testing::{Random, chi_squared, chi_squared_directions, close};

fn medium(json: &str) -> Medium {
    let medium: Medium = serde_json::from_str(json).unwrap();
    medium.check().unwrap();
    medium.resolved()
}

#[test]
fn medium_color_at_a_distance_becomes_absorption() {
    let green = medium(r#"{"color": [0.25, 1, 0.5], "distance": 2, "absorption": [0, 0.1, 0]}"#);
    let transmittance = green.transmittance(4.0);
    assert!(
        close(transmittance.r, 0.0625, 1e-6)
            && close(transmittance.g, (-0.4f32).exp(), 1e-6)
            && close(transmittance.b, 0.25, 1e-6)
    );
    assert_eq!(medium("{}").transmittance(f32::INFINITY), Rgb::WHITE);
    assert!(medium(r#"{"color": 0}"#).transmittance(10.0).max_channel() < 1e-30);
}

#[test]
fn weights_agree_with_the_beer_lambert_law() {
    let fog = medium(r#"{"scattering": [0.2, 0.5, 1.5], "absorption": [0.1, 0, 0.3]}"#);
    let (mut random, count, distance) = (Random::new(81), 400_000, 1.3);
    let (mut through, mut scattered) = ([0.0; 3], [0.0; 3]);
    for _ in 0..count {
        let flight = fog.sample(distance, Rgb::new(0.2, 1.0, 0.5), random.f32(), random.f32());
        let sum = if flight.scattered_at.is_some() { &mut scattered } else { &mut through };
        for (sum, weight) in sum.iter_mut().zip(flight.weight.to_array()) {
            *sum += f64::from(weight) / f64::from(count);
        }
    }
    for (channel, (s, a)) in [(0.2f64, 0.1f64), (0.5, 0.0), (1.5, 0.3)].into_iter().enumerate() {
        let transmittance = (-(s + a) * f64::from(distance)).exp();
        assert!(
            (through[channel] / transmittance - 1.0).abs() < 0.01,
            "{channel}: {} {transmittance}",
            through[channel]
        );
        let expected = (1.0 - transmittance) * s / (s + a);
        assert!((scattered[channel] / expected - 1.0).abs() < 0.01, "{channel}: {} {expected}", scattered[channel]);
    }
}

#[test]
fn scattering_distances_follow_the_exponential() {
    let fog = medium(r#"{"scattering": 0.7}"#);
    let mut random = Random::new(82);
    let (mut observed, count) = ([0.0; 20], 1_000_000);
    for _ in 0..count {
        let at = fog.sample(f32::INFINITY, Rgb::WHITE, random.f32(), random.f32()).scattered_at.unwrap();
        observed[((at * 5.0) as usize).min(19)] += 1.0;
    }
    let below = |x: f64| (-0.7 * x / 5.0).exp();
    let chance = |i: usize| below(i as f64) - if i == 19 { 0.0 } else { below(i as f64 + 1.0) };
    let expected: Vec<f64> = (0..20).map(|i| chance(i) * f64::from(count)).collect();
    chi_squared(&observed, &expected, 1e-3).unwrap();
}

#[test]
fn phase_functions_follow_their_density_and_sum_to_one() {
    for anisotropy in [-0.7, -1e-4, 0.0, 0.3, 0.85] {
        let phase = HenyeyGreenstein { anisotropy };
        let pdf = |w: Vec3| phase.eval(w.z);
        chi_squared_directions(|u| Some(phase.sample(Vec3::Z, u)), pdf, 1_000_000, 1e-3 / 5.0).unwrap();
        let steps = 20_000;
        let cosine = |i: u32| (f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0;
        let value = |i: u32| f64::from(phase.eval(cosine(i) as f32));
        let total: f64 = (0..steps).map(value).sum::<f64>() * 4.0 * std::f64::consts::PI / f64::from(steps);
        let mean: f64 =
            (0..steps).map(|i| value(i) * cosine(i)).sum::<f64>() * 4.0 * std::f64::consts::PI / f64::from(steps);
        assert!((total - 1.0).abs() < 1e-3 && (mean - f64::from(anisotropy)).abs() < 1e-3, "{anisotropy}");
    }
}

#[test]
fn interior_of_highest_priority_wins() {
    let interior = |ior: f32, priority: i32| Interior { ior, dispersion: 0.0, priority, medium: Medium::default() };
    let table = [interior(1.5, 0), interior(1.33, -1), interior(2.4, 0)];
    let id = |place| InteriorId::new(place).unwrap();
    let top = |interiors: Interiors| interiors.top(&table).map(|interior| interior.ior);
    let (glass, water, diamond) = (id(0), id(1), id(2));
    let in_glass = Interiors::NONE.entered(glass);
    assert_eq!((top(Interiors::NONE), top(in_glass)), (None, Some(1.5)));
    // The glass hides the water where both overlap; outside of the glass there is water.
    assert_eq!((top(in_glass.entered(water)), top(in_glass.entered(water).exited(glass))), (Some(1.5), Some(1.33)));
    // Among equals, the solid of the lowest id, in whatever order they were entered.
    let both = [in_glass.entered(diamond), Interiors::NONE.entered(diamond).entered(glass)];
    for inside in both {
        assert_eq!(top(inside), Some(1.5));
        assert_eq!(top(inside.exited(diamond)), Some(1.5));
        assert_eq!(top(inside.exited(glass)), Some(2.4));
    }
    // It hides the interfaces of the other, and those of another solid of the same material.
    let hides = |inside: Interiors, id, inwards| inside.hides_interface(id, inwards, &table);
    assert!(hides(in_glass, diamond, true) && hides(both[0], diamond, false) && hides(in_glass, glass, true));
    assert!(hides(in_glass.entered(glass), glass, false) && !hides(in_glass, glass, false));
    let in_diamond = Interiors::NONE.entered(diamond);
    assert!(!hides(in_diamond, glass, true) && !hides(both[1], glass, false) && hides(in_glass, water, true));
    assert_eq!(in_glass.exited(water), in_glass);
    let full = (0..9).fold(Interiors::NONE, |inside, _| inside.entered(water));
    assert_eq!((0..MAX_INTERIORS).fold(full, |inside, _| inside.exited(water)), Interiors::NONE);
}
