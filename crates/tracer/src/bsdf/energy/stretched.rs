//! What surfaces lose that may be rougher along one axis than along the other, by the tables of those that are not.
//!
//! Masking depends on slopes alone: where the surface is stretched until both alphas are their mean, slopes along a
//! direction are what they were, at [another cosine](Ggx::round_cos). Of mirrors that leaves an error of up to 0.04 at
//! alphas of 1 and 0.1, mostly of too much, for which [`mirror_lost`] takes off a share.
//!
//! Borders also care for the true angle, as Fresnel's equations do. From the thinner side the smaller of what both
//! cosines say is taken. From the denser side light at grazing angles is mirrored wholly by microfacets that stand across, and
//! only those along the rougher axis open a way out: there the loss is that of a mirror and, near that axis, what a
//! border loses beyond. Rather too little is given back than too much. Measured over alphas from 0.02 to 1 and
//! indices from 1.1 to 4: a furnace shows mirrors from 0.95 to 1.02, borders from without from 0.81 to 1.02, from within up to 1.05,
//! and little at grazing angles (0.2 and more), but no less than 0.9 on average over directions.

use super::{dielectric_average, dielectric_loss, mirror_loss, mirror_loss_average};
use crate::bsdf::ggx::Ggx;
use juggler_math::Vec3;

/// What a mirror loses of light along `w`, above or below.
#[inline]
pub fn mirror_lost(ggx: Ggx, w: Vec3) -> f32 {
    kept(ggx) * mirror_loss(ggx.round_cos(w), ggx.mean_alpha())
}

/// The mean of [`mirror_lost`] over all directions, each weighted by its cosine.
#[inline]
pub fn mirror_lost_average(ggx: Ggx) -> f32 {
    kept(ggx) * mirror_loss_average(ggx.mean_alpha())
}

/// One less what is taken off.
#[inline]
fn kept(ggx: Ggx) -> f32 {
    if ggx.is_round() {
        return 1.0;
    }
    let (alpha, apart) = (ggx.alpha(), 1.0 - ggx.roundness());
    1.0 - 0.12 * alpha.max_element() * apart * apart
}

/// What a border loses of light along `w`, above or below; `ior` is the index behind it over that in front.
#[inline]
pub fn border_lost(ggx: Ggx, w: Vec3, ior: f32) -> f32 {
    let (round, alpha) = (ggx.round_cos(w), ggx.mean_alpha());
    let lost = dielectric_loss(round, alpha, ior);
    if ggx.is_round() {
        return lost;
    }
    let cos = w.z.abs();
    let least = if ior < 1.0 {
        let along = ggx.alpha_towards(w);
        let opened = (dielectric_loss(cos, along, ior) - mirror_loss(cos, along)).max(0.0);
        let most = ggx.alpha().max_element();
        (1.0 - 0.1 * most * most * most * most) * lost.min(mirror_loss(round, alpha) + ggx.along_rougher(w) * opened)
    } else {
        dielectric_loss(cos, alpha, ior)
    };
    // Nearly round ones in between.
    lost + (least.min(lost) - lost) * (3.0 * (1.0 - ggx.roundness())).min(1.0)
}

/// At least the mean of [`border_lost`], and that of what goes through, of even light that comes from the side of `ior`.
#[inline]
pub fn border_average(ggx: Ggx, ior: f32) -> super::Average {
    dielectric_average(ggx.mean_alpha(), ior)
}
