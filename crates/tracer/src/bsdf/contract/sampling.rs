//! Samples follow their densities and carry what they should.

use super::*;
use crate::bsdf::Scatter;
use juggler_math::testing::{chi_squared_directions, close};

/// Chance of a false alarm in the whole suite.
const SIGNIFICANCE: f64 = 1e-3;
const COUNT: u32 = 40_000;

#[test]
fn directions_follow_their_density() {
    let all: Vec<Example> = examples().into_iter().filter(|e| e.is_broad && !e.bsdf.is_specular()).collect();
    let tests: usize = all.iter().map(|e| views(e.both_sides).len()).sum();
    for Example { name, bsdf, both_sides, .. } in &all {
        for (i, wo) in views(*both_sides).into_iter().enumerate() {
            // A fifth of the views of each, others for others: enough for what they share.
            if (i + name.len()) % 5 > 0 {
                continue;
            }
            // Turned over, since the test's cells are longest around its z.
            let sample = |u| {
                bsdf.sample(wo, u).filter(|s| s.scatter != Scatter::Specular).map(|s| Vec3::new(s.wi.z, s.wi.x, s.wi.y))
            };
            // Strips thinner than the steps of its integral are not impossible either.
            let pdf = |wi: Vec3| bsdf.pdf(wo, Vec3::new(wi.y, wi.z, wi.x)) + 1e-5;
            let checked = chi_squared_directions(sample, pdf, COUNT, SIGNIFICANCE / tests as f64);
            assert!(checked.is_ok(), "{name}, {wo}: {checked:?}");
        }
    }
}

#[test]
fn samples_carry_value_over_density() {
    let mut random = Random::new(81);
    for Example { name, bsdf, both_sides, .. } in examples() {
        for wo in views(both_sides) {
            for _ in 0..200 {
                let Some(sample) = bsdf.sample(wo, random.vec2()) else { continue };
                let BsdfSample { wi, weight, pdf, scatter, ior } = sample;
                assert!(close(wi.length(), 1.0, 1e-5) && pdf > 0.0 && weight.is_finite(), "{name} {wo} {sample:?}");
                assert!(ior == 1.0 || sample.is_transmitted(wo), "{name} {wo} {sample:?}");
                if scatter == Scatter::Specular {
                    assert!(bsdf.has_specular() && pdf <= 1.0 + 1e-6, "{name} {wo} {sample:?}");
                    continue;
                }
                assert!(!bsdf.is_specular());
                let (value, density) = bsdf.eval_pdf(wo, wi);
                // Rounded directions miss the peak of hardly rough lobes by as much as they are wide.
                if name.contains("0.001") {
                    continue;
                }
                let near = |a: f32, b: f32| (a - b).abs() <= 0.02 * a.abs().max(b.abs()) + 1e-6;
                assert!(near(density, pdf), "{name} {wo} {sample:?}: density {density}");
                for (v, w) in value.to_array().into_iter().zip(weight.to_array()) {
                    assert!(near(v, w * pdf), "{name} {wo} {sample:?}: value {value:?}");
                }
            }
        }
    }
}

#[test]
fn value_and_density_are_those_of_both_in_one_go() {
    let mut random = Random::new(82);
    for Example { name, bsdf, .. } in examples() {
        for _ in 0..100 {
            let (wo, wi) = (random.unit_vector(), random.unit_vector());
            assert_eq!((bsdf.eval(wo, wi), bsdf.pdf(wo, wi)), bsdf.eval_pdf(wo, wi), "{name}");
        }
    }
}

#[test]
fn deltas_are_what_sampling_finds() {
    let mut random = Random::new(83);
    for Example { name, bsdf, both_sides, .. } in examples() {
        for wo in views(both_sides) {
            let deltas = bsdf.deltas(wo);
            assert!(bsdf.has_specular() || deltas.is_empty(), "{name}");
            for _ in 0..if bsdf.has_specular() { 200 } else { 0 } {
                let Some(sample) = bsdf.sample(wo, random.vec2()).filter(|s| s.scatter == Scatter::Specular) else {
                    continue;
                };
                let same = deltas.iter().filter(|d| d.wi.distance(sample.wi) < 1e-5);
                let full = same.fold(Rgb::BLACK, |sum, delta| sum + delta.weight);
                let found = sample.weight * sample.pdf;
                let near = full.to_array().into_iter().zip(found.to_array()).all(|(a, b)| b <= a + 1e-4);
                assert!(near, "{name} {wo} {sample:?} {deltas:?}");
            }
        }
    }
}
