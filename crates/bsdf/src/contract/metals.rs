//! Rough metals. Isotropic ones are reciprocal. Brushed ones scale single scattering by the viewer's
//! side alone (Turquin 2019), so that their highlights keep their shape; no reciprocal lobe does.

use super::*;
use crate::{Conductor, Fresnel};

/// Surfaces of which one alpha is at most half of the other.
const BRUSHED: [(f32, f32); 7] =
    [(0.2, 0.02), (0.2575, 0.01), (0.5, 0.05), (0.6, 0.3), (1.0, 0.01), (0.1, 1.0), (1.0, 0.5)];
/// Surfaces between isotropic and brushed ones.
const BETWEEN: [(f32, f32); 4] = [(0.3, 0.2), (0.7, 0.9), (1.0, 0.6), (0.99, 1.0)];

/// Ratios of both alphas.
const RATIOS: [f32; 8] = [0.01, 0.03, 0.1, 0.25, 0.4, 0.6, 0.85, 0.95];

/// Directions above the surface: across the grooves, between, and along.
fn directions() -> Vec<Vec3> {
    let cosines = [0.03f32, 0.15, 0.5, 0.8, 1.0];
    let at = |cos: f32, turn: f32| {
        let (along, (sin, cosine)) = ((1.0 - cos * cos).max(0.0).sqrt(), portable::sin_cos_turns(turn));
        Vec3::new(along * cosine, along * sin, cos)
    };
    cosines.into_iter().flat_map(|cos| [0.0, 0.1, 0.22, 0.25].map(|turn| at(cos, turn))).collect()
}

/// Integral of the values over the hemisphere, by visible normals in proportion to single
/// scattering and by cosine-weighted directions (balance heuristic), which is what light sampling
/// finds.
fn integral(metal: Conductor, alpha: Vec2, wo: Vec3, count: u32) -> f64 {
    let once = Bsdf::from(Conductor::new(Fresnel::WHITE, alpha));
    let metal = Bsdf::from(metal);
    let mut sum = 0.0;
    for i in 0..count {
        let u = Vec2::new(
            (f64::from(i) * 0.754_877_666_246_692_8 + 0.5).fract() as f32,
            (f64::from(i) * 0.569_840_290_998_053_3 + 0.5).fract() as f32,
        );
        for wi in [once.sample(wo, u, 0.0).map(|sample| sample.wi), Some(warp::cosine_hemisphere(u))] {
            let Some(wi) = wi.filter(|wi| wi.z > 0.0) else { continue };
            let density = once.pdf(wo, wi) + wi.z * std::f32::consts::FRAC_1_PI;
            sum += f64::from(metal.eval(wo, wi).g / density);
        }
    }
    sum / f64::from(count)
}

/// White furnace of the values, which light sampling uses, at any roughness, ratio of both alphas
/// and angle. At the roughest, the tabulated loss of 0.7 is within 0.005.
#[test]
fn values_of_brushed_white_metal_conserve_energy() {
    for (x, ratio) in [0.05, 0.15, 0.45, 0.8, 1.0].into_iter().flat_map(|x| RATIOS.map(|ratio| (x, ratio))) {
        let alpha = Vec2::new(x, x * ratio);
        for wo in directions() {
            let energy = integral(Conductor::compensated(Fresnel::WHITE, alpha), alpha, wo, 1024);
            assert!((energy - 1.0).abs() < 0.02, "{alpha} {wo}: {energy}");
        }
    }
}

/// Samples keep all light of a perfect mirror, whatever the roughness, the ratio of both alphas and
/// the angle.
#[test]
fn samples_of_brushed_white_metal_have_weight_one() {
    let mut random = Random::new(107);
    for alpha in BRUSHED.into_iter().chain(BETWEEN).map(Vec2::from) {
        let metal = Bsdf::from(Conductor::compensated(Fresnel::WHITE, alpha));
        for wo in directions().into_iter().flat_map(|wo| [wo; 100]) {
            let weight = metal.sample(wo, random.vec2(), 0.0).map_or(0.0, |sample| sample.weight.g);
            assert!((weight - 1.0).abs() < 1e-5, "{alpha} {wo}: {weight}");
        }
    }
}

/// Light of further bounces has the directions of single scattering: the ratio of the values is one
/// over the albedo of single scattering in all directions, also across the grooves.
#[test]
fn brushed_metal_scales_single_scattering() {
    for alpha in BRUSHED.map(Vec2::from) {
        let once = Conductor::new(Fresnel::WHITE, alpha);
        let [single, metal] = [once, Conductor::compensated(Fresnel::WHITE, alpha)].map(Bsdf::from);
        for wo in directions().into_iter().filter(|wo| wo.z > 0.04) {
            let expected = 1.0 / integral(once, alpha, wo, 4096);
            for wi in directions() {
                let (there, scaled) = (f64::from(single.eval(wo, wi).g), f64::from(metal.eval(wo, wi).g));
                assert!((scaled - expected * there).abs() <= 0.025 * scaled, "{alpha} {wo} {wi}: {there} {scaled}");
            }
        }
    }
}

/// The scale depends on the viewer's side: exchanged directions differ by the ratio of both scales.
#[test]
fn brushed_metal_is_not_reciprocal_by_its_scale_alone() {
    let mut random = Random::new(108);
    for alpha in BRUSHED.map(Vec2::from) {
        let [once, metal] =
            [Conductor::new(Fresnel::WHITE, alpha), Conductor::compensated(Fresnel::WHITE, alpha)].map(Bsdf::from);
        // 1 / E by any direction in which the lobe is bright.
        let mut scale = |wo: Vec3| {
            let wi = once.sample(wo, random.vec2(), 0.0).map_or(wo, |sample| sample.wi);
            metal.eval(wo, wi).g / once.eval(wo, wi).g
        };
        for (o, i) in directions().into_iter().zip(directions().into_iter().skip(4)) {
            let (there, back) = (metal.eval(o, i).g / i.z / scale(o), metal.eval(i, o).g / o.z / scale(i));
            assert!((there - back).abs() <= 2e-3 * there.max(back), "{alpha} {o} {i}: {there} {back}");
        }
    }
}

/// Energy and values pass from isotropic to brushed metal without a seam.
#[test]
fn anisotropy_begins_without_a_seam() {
    let gold = crate::metals::Metal::named("gold").unwrap().fresnel();
    for (fresnel, alpha) in [(Fresnel::WHITE, 0.2), (gold, 0.5), (gold, 1.0)] {
        let metal = |ratio: f32| Bsdf::from(Conductor::compensated(fresnel, Vec2::new(alpha, alpha * ratio)));
        for (wo, wi) in directions().into_iter().zip(directions().into_iter().skip(3)) {
            let near = |a: f32, b: f32, most: f32| assert!((a - b).abs() <= most, "{alpha} {wo} {wi}: {a} {b}");
            let [isotropic, barely] = [metal(1.0), metal(0.9999)];
            // The tables of isotropic and anisotropic losses are within 0.01 of each other.
            near(barely.eval(wo, wi).g, isotropic.eval(wo, wi).g, 0.02 * isotropic.eval(wo, wi).g + 0.002);
            near(barely.albedo(wo).g, isotropic.albedo(wo).g, 0.015);
            for ratio in (10..=50u8).map(|percent| f32::from(percent) * 0.02) {
                let [before, after] = [metal(ratio - 0.01), metal(ratio)].map(|metal| metal.albedo(wo).g);
                near(before, after, 0.03);
            }
        }
    }
}
