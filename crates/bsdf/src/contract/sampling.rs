//! Samples follow their densities and have the right weights.

use super::examples::Breadth;
use super::*;
use crate::{Conductor, Dielectric, Fresnel, ThinDielectric};
use juggler_math::testing::close;

/// Chance of a false alarm in the whole suite.
const SIGNIFICANCE: f64 = 1e-3;
const COUNT: u32 = 1_000_000;

/// Tests every `parts`th example from `part` on against its density, each from one of the views in
/// turn; the parts run in parallel.
fn follow_their_density(part: usize, parts: usize) {
    let all: Vec<Example> =
        examples().into_iter().filter(|e| e.breadth > Breadth::Needle && !e.bsdf.is_specular()).collect();
    for (number, Example { name, bsdf, both_sides, breadth, .. }) in all.iter().enumerate().skip(part).step_by(parts) {
        let mut views = views(*both_sides);
        views.retain(|wo| *breadth == Breadth::Broad || wo.z.abs() > 0.3);
        let wo = views[number * 3 % views.len()];
        let checked = follows_its_density(bsdf, wo, COUNT, SIGNIFICANCE / all.len() as f64);
        assert!(checked.is_ok(), "{name}, {wo}: {checked:?}");
    }
}

#[test]
fn directions_follow_their_density() {
    follow_their_density(0, 2);
}

#[test]
fn directions_of_the_other_half_follow_their_density() {
    follow_their_density(1, 2);
}

/// Samples of rough glass never gain energy: the sampled microfacet selects reflection or
/// refraction, and light that other microfacets block continues as multiple scattering.
#[test]
fn samples_of_rough_glass_never_gain_energy() {
    // The energy of a sample is at most 1 exactly: it is a ratio of shadowing terms, or 1 with the
    // multiple scattering. The slack is for rounding; with this seed the largest excess is 2e-6.
    const MOST: f32 = 1.0 + 1e-5;
    let mut random = Random::new(85);
    for ior in [1.1, 1.33, 1.5, 2.4] {
        for alpha in [0.05, 0.3, 1.0] {
            let alpha = Vec2::splat(alpha);
            let single = [Bsdf::from(Dielectric::new(ior, alpha)), ThinDielectric::new(ior, alpha).into()];
            let all = [Bsdf::from(Dielectric::compensated(ior, alpha)), ThinDielectric::compensated(ior, alpha).into()];
            for (number, bsdf) in single.iter().chain(&all).enumerate() {
                for wo in views(true).into_iter().flat_map(|wo| [wo; 1000]) {
                    let sample = bsdf.sample(wo, random.vec2(), random.f32());
                    let energy = sample.map_or(0.0, |sample| energy_of(&sample).g);
                    assert!(energy <= MOST, "{number} {ior} {alpha} {wo}: {energy}");
                }
            }
        }
    }
}

/// All light in a slab of rough glass leaves it on either side, with a small variance, because no
/// sample gains much energy.
#[test]
fn light_leaves_a_slab_of_rough_glass() {
    let mut random = Random::new(86);
    for (alpha, variance) in [(0.05, 1e-4), (0.3, 1e-4), (1.0, 1e-4)] {
        let bsdf = Bsdf::from(Dielectric::compensated(1.5, Vec2::splat(alpha)));
        let mut walk = || {
            let (mut wo, mut energy) = (Vec3::new(0.6, 0.0, 0.8), 1.0f64);
            loop {
                let Some(sample) = bsdf.sample(wo, random.vec2(), random.f32()) else { return 0.0 };
                energy *= f64::from(energy_of(&sample).g);
                if sample.wi.z > 0.0 {
                    return energy;
                }
                // Continue at the opposite interface, which is flipped.
                wo = Vec3::new(-sample.wi.x, -sample.wi.y, sample.wi.z);
            }
        };
        let energies: Vec<f64> = (0..40_000).map(|_| walk()).collect();
        let mean = energies.iter().sum::<f64>() / 4e4;
        let spread = energies.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / 4e4;
        assert!((mean - 1.0).abs() < 0.002 && spread < variance, "{alpha}: {mean}, {spread}");
    }
}

/// A perfect mirror keeps the energy of each path, whatever the error of its tabulated loss.
#[test]
fn samples_of_white_metal_have_weight_one() {
    let mut random = Random::new(105);
    for alpha in [(0.05, 0.05), (0.3, 0.3), (1.0, 1.0), (0.6, 0.3), (0.5, 0.05)].map(Vec2::from) {
        let metal = Bsdf::from(Conductor::compensated(Fresnel::WHITE, alpha));
        for wo in views(false).into_iter().flat_map(|wo| [wo; 500]) {
            let sample = metal.sample(wo, random.vec2(), 0.0).unwrap();
            assert!(close(sample.weight.g, 1.0, 1e-5), "{alpha} {wo}: {sample:?}");
        }
    }
}

/// A clear pane keeps the energy of each path from either side, whatever the error of its tabulated
/// loss.
#[test]
fn samples_of_a_clear_pane_have_weight_one() {
    let mut random = Random::new(106);
    for alpha in [(0.05, 0.05), (0.3, 0.3), (1.0, 1.0), (0.6, 0.3), (0.5, 0.05)].map(Vec2::from) {
        for ior in [1.0, 1.5, 2.4] {
            let pane = Bsdf::from(ThinDielectric::compensated(ior, alpha));
            for wo in views(true).into_iter().flat_map(|wo| [wo; 200]) {
                let sample = pane.sample(wo, random.vec2(), random.f32()).unwrap();
                assert!(close(sample.weight.g, 1.0, 1e-5), "{ior} {alpha} {wo}: {sample:?}");
            }
        }
    }
}

#[test]
fn sample_weights_equal_value_over_density() {
    let mut random = Random::new(81);
    for Example { name, bsdf, both_sides, .. } in examples() {
        for wo in views(both_sides) {
            for _ in 0..200 {
                let Some(sample) = bsdf.sample(wo, random.vec2(), random.f32()) else { continue };
                let BsdfSample { wi, weight, pdf, scatter, ior } = sample;
                assert!(close(wi.length(), 1.0, 1e-5) && pdf > 0.0 && weight.is_finite(), "{name} {wo} {sample:?}");
                assert!(ior == 1.0 || sample.is_transmitted(wo), "{name} {wo} {sample:?}");
                if scatter == Scatter::Specular {
                    assert!(bsdf.has_specular() && pdf <= 1.0 + 1e-6, "{name} {wo} {sample:?}");
                    continue;
                }
                assert!(!bsdf.is_specular());
                let (value, density) = bsdf.eval_pdf(wo, wi);
                // Rounding errors of directions are as large as the width of barely rough lobes.
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
fn eval_and_pdf_equal_eval_pdf() {
    let mut random = Random::new(82);
    for Example { name, bsdf, .. } in examples() {
        for _ in 0..100 {
            let (wo, wi) = (random.unit_vector(), random.unit_vector());
            assert_eq!((bsdf.eval(wo, wi), bsdf.pdf(wo, wi)), bsdf.eval_pdf(wo, wi), "{name}");
        }
    }
}

#[test]
fn deltas_match_sampled_specular_directions() {
    let mut random = Random::new(83);
    for Example { name, bsdf, both_sides, .. } in examples() {
        for wo in views(both_sides) {
            let deltas = bsdf.deltas(wo);
            assert!(bsdf.has_specular() || deltas.is_empty(), "{name}");
            for _ in 0..if bsdf.has_specular() { 200 } else { 0 } {
                let Some(sample) =
                    bsdf.sample(wo, random.vec2(), random.f32()).filter(|s| s.scatter == Scatter::Specular)
                else {
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
