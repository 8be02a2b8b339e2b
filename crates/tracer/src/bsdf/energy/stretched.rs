//! What mirrors lose that may be rougher along one axis than along the other.

use super::{InterfaceLoss, Side, mirror_loss, mirror_loss_average};
use crate::bsdf::ggx::Ggx;
use juggler_math::Vec3;

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
