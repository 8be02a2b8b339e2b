//! What holds for every lobe, run over a list of examples.

mod chart;
mod energy;
mod examples;
mod grid;
mod horizon;
mod needles;
mod numbers;
mod principled;
mod sampling;
mod white;

use crate::testing::follows_its_density;
use crate::{Bsdf, BsdfSample, Scatter};
use examples::{Example, examples};
use juggler_math::testing::Random;
use juggler_math::{Rgb, Vec2, Vec3, fun, warp};

/// What tables and sampling may add to the light that there is.
const MORE: f32 = 0.02;

/// Directions towards the viewer, from straight above to grazing; from below too if `both` sides are to be seen.
fn views(both: bool) -> Vec<Vec3> {
    let above = [(0.0, 0.0, 1.0), (0.4, 0.3, 0.8), (0.5, -0.6, 0.4), (-0.9, 0.3, 0.12), (0.7, 0.7, 0.02)];
    let above = above.map(|(x, y, z)| Vec3::new(x, y, z).normalize());
    let below = above.map(|w| Vec3::new(w.x, w.y, -w.z));
    if both { above.into_iter().chain(below).collect() } else { above.to_vec() }
}

/// The weight of a sample without the scale of radiance that crosses a border: what light of one particle is left.
fn energy_of(sample: &BsdfSample) -> Rgb {
    sample.weight * (sample.ior * sample.ior)
}

/// The share of light sent in along `wo` that comes out again, by sampling over a grid with one random point a cell.
fn furnace(bsdf: &Bsdf, wo: Vec3, side: u32) -> Rgb {
    let mut random = Random::new(7);
    let mut sum = [0.0f64; 3];
    for i in 0..side * side {
        let cell = Vec2::new((i % side) as f32, (i / side) as f32);
        let u = (cell + random.vec2()) / side as f32;
        // The golden ratio's sequence is even in each row and column.
        let choice = (f64::from(i) * 0.618_033_988_749_894_8).fract() as f32;
        if let Some(sample) = bsdf.sample(wo, u.min(Vec2::splat(1f32.next_down())), choice.min(1f32.next_down())) {
            let energy = energy_of(&sample).to_array();
            sum.iter_mut().zip(energy).for_each(|(s, e)| *s += f64::from(e));
        }
    }
    let count = f64::from(side * side);
    Rgb::new((sum[0] / count) as f32, (sum[1] / count) as f32, (sum[2] / count) as f32)
}
