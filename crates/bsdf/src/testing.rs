//! Checks of a BSDF that contract tests of other crates share.

use crate::{Bsdf, Scatter};
use juggler_math::Vec3;
use juggler_math::testing::{Random, chi_squared_directions};

/// Chi-squared test of directions sampled for `wo`, without deltas, against their density.
pub fn follows_its_density(bsdf: &Bsdf, wo: Vec3, count: u32, significance: f64) -> Result<(), String> {
    let mut random = Random::new(84);
    // Rotate the normal away from z, around which the test's cells are longest.
    let sample = |u| {
        let sample = bsdf.sample(wo, u, random.f32()).filter(|sample| sample.scatter != Scatter::Specular)?;
        Some(Vec3::new(sample.wi.z, sample.wi.x, sample.wi.y))
    };
    // Features narrower than the integration steps must not have zero probability.
    let pdf = |wi: Vec3| bsdf.pdf(wo, Vec3::new(wi.y, wi.z, wi.x)) + 1e-7;
    chi_squared_directions(sample, pdf, count, significance)
}
