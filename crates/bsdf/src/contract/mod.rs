//! Properties of every lobe, tested over a list of examples.

mod chart;
mod energy;
mod examples;
mod grid;
mod horizon;
mod lanes;
mod metals;
mod needles;
mod numbers;
mod principled;
mod sampling;
mod white;

use crate::testing::follows_its_density;
use crate::{Bsdf, BsdfSample, Scatter};
use examples::{Example, examples};
use juggler_math::testing::Random;
use juggler_math::{Rgb, Vec2, Vec3, portable, warp};

/// Energy that errors of tables and sampling may add.
const ENERGY_TOLERANCE: f32 = 0.02;

/// Directions towards the viewer, from the normal to grazing; with `both_sides`, also from below.
fn views(both_sides: bool) -> Vec<Vec3> {
    let above = [(0.0, 0.0, 1.0), (0.4, 0.3, 0.8), (0.5, -0.6, 0.4), (-0.9, 0.3, 0.12), (0.7, 0.7, 0.02)];
    let above = above.map(|(x, y, z)| Vec3::new(x, y, z).normalize());
    let below = above.map(|w| Vec3::new(w.x, w.y, -w.z));
    if both_sides { above.into_iter().chain(below).collect() } else { above.to_vec() }
}

/// Weight of a sample without the scale of radiance that crosses an interface: the energy that a
/// particle keeps.
fn energy_of(sample: &BsdfSample) -> Rgb {
    sample.weight * (sample.ior * sample.ior)
}

/// Directional albedo of light along `wo`, by stratified sampling with one random point in each
/// cell of a grid.
fn furnace(bsdf: &Bsdf, wo: Vec3, side: u32) -> Rgb {
    let mut random = Random::new(7);
    let mut sum = [0.0f64; 3];
    for i in 0..side * side {
        let cell = Vec2::new((i % side) as f32, (i / side) as f32);
        let u = (cell + random.vec2()) / side as f32;
        // The sequence of the golden ratio is uniform in each row and column.
        let u_choice = (f64::from(i) * 0.618_033_988_749_894_8).fract() as f32;
        if let Some(sample) = bsdf.sample(wo, u.min(Vec2::splat(1f32.next_down())), u_choice.min(1f32.next_down())) {
            let energy = energy_of(&sample).to_array();
            sum.iter_mut().zip(energy).for_each(|(s, e)| *s += f64::from(e));
        }
    }
    let count = f64::from(side * side);
    Rgb::new((sum[0] / count) as f32, (sum[1] / count) as f32, (sum[2] / count) as f32)
}
