//! Samples follow their densities where lobes are narrower than the cells of a uniform grid: barely
//! rough, between nearly equal media, at grazing views.

use super::chart::{CELLS, Chart};
use super::examples::Breadth;
use super::*;
use crate::{Conductor, Dielectric, Fresnel};
use juggler_math::testing::chi_squared;

/// Chance of a false alarm in the whole suite.
const SIGNIFICANCE: f64 = 1e-3;
const COUNT: u32 = 1_000_000;

/// Expected number of samples in a cell that received `observed`: integrated in ever finer steps until a
/// step changes little. Features between the steps show in `observed`, so refinement continues while it
/// disagrees with the density.
fn expected_in(chart: &Chart, pdf: &impl Fn(Vec3) -> f32, cell: usize, observed: f64) -> f64 {
    let count = f64::from(COUNT);
    let (mut steps, mut last) = (7, chart.integral(pdf, cell, 4) * count);
    loop {
        let next = chart.integral(pdf, cell, steps) * count;
        let is_steady = (next - last) * (next - last) <= 0.02 * next.max(5.0);
        let agrees = (observed - next) * (observed - next) <= 9.0 * next.max(1.0);
        if steps >= 350 || is_steady && agrees {
            // The horizon may cut off a corner of a cell that no midpoint lies in.
            return next.max(1e-3);
        }
        (steps, last) = (steps * 5 / 3, next);
    }
}

/// Directions to fit a map to: few, and more of a side that is rarely sampled.
fn pilot(mut sample: impl FnMut() -> Option<Vec3>) -> Vec<Vec3> {
    let mut pilot: Vec<Vec3> = (0..4000).filter_map(|_| sample()).collect();
    for side in [1.0, -1.0] {
        if pilot.iter().filter(|wi| wi.z * side > 0.0).count() < 50 {
            pilot.extend((0..400_000).filter_map(|_| sample()).filter(|wi| wi.z * side > 0.0).take(200));
        }
    }
    pilot
}

/// Chi-squared test of directions sampled for `wo`, without deltas, against a density, on maps
/// fitted to the lobes.
fn follows(bsdf: &Bsdf, wo: Vec3, pdf: impl Fn(Vec3) -> f32, significance: f64) -> Result<(), String> {
    let mut random = Random::new(87);
    let mut sample = || {
        let sample = bsdf.sample(wo, random.vec2(), random.f32())?;
        (sample.scatter != Scatter::Specular).then_some(sample.wi)
    };
    let pilot = pilot(&mut sample);
    let charts = [1.0, -1.0].map(|side| Chart::fitted(side, &pilot));
    // The last cell counts samples without a direction.
    let mut observed = vec![0.0; 2 * CELLS + 1];
    for _ in 0..COUNT {
        let cell = sample().and_then(|wi| {
            let [above, below] = &charts;
            above.cell(wi).or_else(|| below.cell(wi).map(|cell| CELLS + cell))
        });
        observed[cell.unwrap_or(2 * CELLS)] += 1.0;
    }
    // Features narrower than the integration steps must not have zero probability.
    let pdf = |wi: Vec3| pdf(wi) + 1e-7;
    let cells = observed[..2 * CELLS].iter().enumerate();
    let mut expected: Vec<f64> =
        cells.map(|(cell, observed)| expected_in(&charts[cell / CELLS], &pdf, cell % CELLS, *observed)).collect();
    let (total, count) = (expected.iter().sum::<f64>(), f64::from(COUNT));
    if total > count * 1.003 {
        return Err(format!("the density integrates to {}", total / count));
    }
    // Leave out the last cell if everything is scattered up to rounding.
    let (lost, rest) = (observed[2 * CELLS], count - total);
    if lost < count * 1e-4 && rest.abs() < count * 3e-3 {
        observed.pop();
    } else {
        expected.push(rest.max(0.0));
    }
    chi_squared(&observed, &expected, significance)
}

/// Lobes too narrow for the uniform grid of [`follows_its_density`], each with a view: any view for
/// needles, a grazing one for lobes that are narrow at grazing angles.
fn needles() -> Vec<(Example, Vec3)> {
    let of = |(number, example): (usize, Example)| {
        let mut views = views(example.both_sides);
        views.retain(|wo| example.breadth == Breadth::Needle || wo.z.abs() <= 0.3);
        let wo = views[number * 3 % views.len()];
        (example, wo)
    };
    let is_fine = |example: &Example| example.breadth < Breadth::Broad && !example.bsdf.is_specular();
    examples().into_iter().filter(is_fine).enumerate().map(of).collect()
}

/// Tests every `parts`th lobe from `part` on; the parts run in parallel.
fn follow_their_density(part: usize, parts: usize) {
    let all = needles();
    assert!(all.iter().filter(|(example, _)| example.name.contains("0.001")).count() > 10);
    assert!(all.iter().filter(|(example, _)| example.name.contains(" 1.01 ")).count() > 10);
    assert!(all.iter().filter(|(example, wo)| example.breadth == Breadth::Narrow && wo.z.abs() < 0.2).count() > 10);
    // Significance of each test for that of the whole suite (Šidák 1967).
    let significance = 1.0 - portable::pow_f64(1.0 - SIGNIFICANCE, 1.0 / all.len() as f64);
    for (Example { name, bsdf, .. }, wo) in all.iter().skip(part).step_by(parts) {
        let checked = follows(bsdf, *wo, |wi| bsdf.pdf(*wo, wi), significance);
        assert!(checked.is_ok(), "{name}, {wo}: {checked:?}");
    }
}

#[test]
fn half_of_the_narrow_lobes_follow_their_density() {
    follow_their_density(0, 2);
}

#[test]
fn other_half_of_the_narrow_lobes_follow_their_density() {
    follow_their_density(1, 2);
}

/// A change of alpha, or of the index's distance from 1, by 2 % is detected.
#[test]
fn wrong_densities_of_narrow_lobes_are_detected() {
    let wo = Vec3::new(0.5, -0.6, 0.4).normalize();
    let [bsdf, wider] = [0.001, 0.00102].map(|alpha| Bsdf::from(Conductor::new(Fresnel::WHITE, Vec2::splat(alpha))));
    follows(&bsdf, wo, |wi| bsdf.pdf(wo, wi), 1e-3).unwrap();
    follows(&bsdf, wo, |wi| wider.pdf(wo, wi), 1e-9).unwrap_err();
    let [bsdf, denser] = [1.01, 1.0102].map(|ior| Bsdf::from(Dielectric::new(ior, Vec2::splat(0.05))));
    follows(&bsdf, wo, |wi| bsdf.pdf(wo, wi), 1e-3).unwrap();
    follows(&bsdf, wo, |wi| denser.pdf(wo, wi), 1e-9).unwrap_err();
}
