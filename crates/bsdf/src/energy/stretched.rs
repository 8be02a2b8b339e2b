//! What mirrors lose that may be rougher along one axis than along the other, and directions in proportion to it.

use super::{
    ALPHA, COS, InterfaceLoss, MIRROR_LOST, Scramble, Side, coordinate, mirror_loss, mirror_loss_average, place,
};
use crate::ggx::Ggx;
use juggler_math::{Vec3, fun};

/// What a mirror loses of light along `w`, above or below.
#[inline]
pub fn mirror_lost(ggx: Ggx, w: Vec3) -> f32 {
    if ggx.is_round() {
        mirror_loss(w.z.abs(), ggx.mean_alpha())
    } else {
        InterfaceLoss::of_mirror(ggx).at(Side::Thin, w)
    }
}

/// The mean of [`mirror_lost`] over all directions, each weighted by its cosine.
#[inline]
pub fn mirror_lost_average(ggx: Ggx) -> f32 {
    if ggx.is_round() { mirror_loss_average(ggx.mean_alpha()) } else { InterfaceLoss::of_mirror(ggx).mean(Side::Thin) }
}

/// Draws a direction above the surface with density L(w) cos θ / (π L̄) per steradian, where L is
/// [`mirror_lost`] and L̄ its mean.
pub fn sample_mirror_lost(ggx: Ggx, random: &mut Scramble) -> Vec3 {
    if !ggx.is_round() {
        return InterfaceLoss::of_mirror(ggx).sample(Side::Thin, random);
    }
    let cos = sample_cosine(ggx.mean_alpha(), random);
    let (sin, turn) = fun::sin_cos_turns(random.unit());
    let along = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(along * turn, along * sin, cos)
}

/// Largest number of attempts at a direction; each succeeds with a probability of more than one
/// half.
const MAX_TRIES: u32 = 64;

/// The cosine of a direction that [`sample_mirror_lost`] draws on a round surface, by rejection:
/// the table is linear in the coordinate x between its entries, so an interval is picked by a bound
/// on the integral of L, cos² evenly within the interval, and the direction is taken with
/// probability L over the larger entry of the interval.
fn sample_cosine(alpha: f32, random: &mut Scramble) -> f32 {
    let (i, t) = place(alpha.sqrt(), ALPHA);
    let entry = |k: usize| {
        let (a, b) = (f32::from(MIRROR_LOST[i][k]), f32::from(MIRROR_LOST[i + 1][k]));
        a + (b - a) * t
    };
    let (mut lost, mut squares, mut sums) = ([0.0; COS], [0.0; COS], [0.0; COS]);
    for k in 0..COS {
        let cos = cosine(k as f32 / (COS - 1) as f32, alpha);
        (lost[k], squares[k]) = (entry(k), cos * cos);
        if k > 0 {
            sums[k] = sums[k - 1] + lost[k].max(lost[k - 1]) * (squares[k] - squares[k - 1]);
        }
    }
    let mut square = 1f32;
    for _ in 0..MAX_TRIES {
        let at = random.unit() * sums[COS - 1];
        let k = (1..COS - 1).find(|k| at < sums[*k]).unwrap_or(COS - 1);
        square = squares[k - 1] + (squares[k] - squares[k - 1]) * random.unit();
        let x = coordinate(square.sqrt(), alpha) * (COS - 1) as f32 - (k - 1) as f32;
        let value = lost[k - 1] + (lost[k] - lost[k - 1]) * x.clamp(0.0, 1.0);
        if random.unit() * lost[k].max(lost[k - 1]) < value {
            break;
        }
    }
    square.sqrt().max(1e-6)
}

/// The cosine at a coordinate x: cos (1 + α) = x² (cos + α).
fn cosine(x: f32, alpha: f32) -> f32 {
    let square = x * x;
    (square * alpha / (1.0 + alpha - square)).min(1.0)
}
