//! Loss of perfect mirrors that may be anisotropic, and directions sampled in proportion to it.

use super::{
    ALPHA, COS, InterfaceLoss, MIRROR_LOSS, SampleRng, Side, coordinate, isotropic_mirror_loss,
    mean_isotropic_mirror_loss, table_position,
};
use crate::ggx::Ggx;
use juggler_math::{Vec3, portable};

/// Fraction of light along `w`, above or below, that a perfect mirror loses.
#[inline]
pub fn mirror_loss(ggx: Ggx, w: Vec3) -> f32 {
    if ggx.is_isotropic() {
        isotropic_mirror_loss(w.z.abs(), ggx.mean_alpha())
    } else {
        InterfaceLoss::for_mirror(ggx).at(Side::Thin, w)
    }
}

/// Cosine-weighted mean of [`mirror_loss`] over all directions.
#[inline]
pub fn mean_mirror_loss(ggx: Ggx) -> f32 {
    if ggx.is_isotropic() {
        mean_isotropic_mirror_loss(ggx.mean_alpha())
    } else {
        InterfaceLoss::for_mirror(ggx).mean(Side::Thin)
    }
}

/// Draws a direction above the surface with density L(w) cos θ / (π L̄) per steradian, where L is
/// [`mirror_loss`] and L̄ its mean.
pub fn sample_mirror_loss(ggx: Ggx, random: &mut SampleRng) -> Vec3 {
    if !ggx.is_isotropic() {
        return InterfaceLoss::for_mirror(ggx).sample(Side::Thin, random);
    }
    let cos = sample_cosine(ggx.mean_alpha(), random);
    let (sin, turn) = portable::sin_cos_turns(random.unit());
    let along = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(along * turn, along * sin, cos)
}

/// Largest number of attempts at a direction; each succeeds with a probability of more than one
/// half.
const MAX_TRIES: u32 = 64;

/// Samples the cosine of [`sample_mirror_loss`] on an isotropic surface by rejection. The table is
/// linear in the coordinate x between its entries, so an interval is selected by a bound on the
/// integral of L, cos² uniformly within the interval, and the direction is accepted with
/// probability L over the larger entry of the interval.
fn sample_cosine(alpha: f32, random: &mut SampleRng) -> f32 {
    let (i, t) = table_position(alpha.sqrt(), ALPHA);
    let entry = |k: usize| {
        let (a, b) = (f32::from(MIRROR_LOSS[i][k]), f32::from(MIRROR_LOSS[i + 1][k]));
        a + (b - a) * t
    };
    let (mut losses, mut squares, mut sums) = ([0.0; COS], [0.0; COS], [0.0; COS]);
    for k in 0..COS {
        let cos = cosine(k as f32 / (COS - 1) as f32, alpha);
        (losses[k], squares[k]) = (entry(k), cos * cos);
        if k > 0 {
            sums[k] = sums[k - 1] + losses[k].max(losses[k - 1]) * (squares[k] - squares[k - 1]);
        }
    }
    let mut square = 1f32;
    for _ in 0..MAX_TRIES {
        let at = random.unit() * sums[COS - 1];
        let k = (1..COS - 1).find(|k| at < sums[*k]).unwrap_or(COS - 1);
        square = squares[k - 1] + (squares[k] - squares[k - 1]) * random.unit();
        let x = coordinate(square.sqrt(), alpha) * (COS - 1) as f32 - (k - 1) as f32;
        let value = losses[k - 1] + (losses[k] - losses[k - 1]) * x.clamp(0.0, 1.0);
        if random.unit() * losses[k].max(losses[k - 1]) < value {
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
