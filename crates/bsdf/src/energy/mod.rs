//! How much light single scattering at GGX microfacets gives back, and how much it loses to further bounces: tables
//! by the cosine of the angle and alpha, and the relative index of refraction for borders of clear media.
//!
//! What borders of clear media lose is a matter of its own: [`InterfaceLoss`].
//!
//! The tables hold 1/10000ths and are made by integrating our own lobes; `tests.rs` says how. Between entries values are
//! linear in √alpha, in √((η - 1) / (η + 1)) and in √cos; for mirrors in √(cos (1 + alpha) / (cos + alpha)) instead, since
//! what a polished mirror loses depends on cos / alpha alone. Of what borders mirror they hold what to add to a value that is right
//! for polished ones, which is little. Means over the hemisphere are those of these very
//! functions, so that what compensation puts back is what was lost.

mod border_mirrored;
mod cells;
mod interface;
mod interface_round;
mod interface_stretched;
mod mirror_grazing;
mod mirror_lost;
mod mirror_stretched;
mod scramble;
mod sheen_albedo;
mod stretched;
mod zone;

#[cfg(test)]
mod interface_tests;
#[cfg(test)]
mod tests;

use super::fresnel;
use border_mirrored::{MIRRORED, MIRRORED_MEAN};
pub use interface::InterfaceLoss;
use mirror_grazing::MIRROR_GRAZING;
use mirror_lost::{MIRROR_LOST, MIRROR_LOST_MEAN};
pub use scramble::Scramble;
use sheen_albedo::SHEEN;
pub use stretched::{mirror_lost, mirror_lost_average, sample_mirror_lost};
pub use zone::Side;

/// Entries along the cosine's coordinate, from 0 to 1.
const COS: usize = 32;
/// Entries along √alpha, from 0 to 1.
const ALPHA: usize = 32;
/// The same for the tables of dielectrics.
const ALPHA_CLEAR: usize = 12;
/// Entries along √((η - 1) / (η + 1)), from 0 to [`STEEPEST`].
const IOR: usize = 10;
/// √0.6: η = 4. Beyond, 4 stands for all.
const STEEPEST: f32 = 0.774_596_7;

/// By alpha, then √cos.
type Plane<const N: usize> = [[i16; COS]; N];
/// By index of refraction, then alpha, then √cos; for each side: light from the thinner medium, from the denser one.
type Sides = [[Plane<ALPHA_CLEAR>; IOR]; 2];

/// The same without √cos.
type Means = [[[i16; ALPHA_CLEAR]; IOR]; 2];

const UNIT: f32 = 1e-4;

/// The entry below `x` in 0..=1, as one of `count`, and how far on to the next.
#[inline]
fn place(x: f32, count: usize) -> (usize, f32) {
    let at = x.clamp(0.0, 1.0) * (count - 1) as f32;
    let below = (at as usize).min(count - 2);
    (below, at - below as f32)
}

#[inline]
fn along<const N: usize>(row: &[i16; N], (i, t): (usize, f32)) -> f32 {
    let (a, b) = (f32::from(row[i]), f32::from(row[i + 1]));
    (a + (b - a) * t) * UNIT
}

#[inline]
fn across<const N: usize>(plane: &Plane<N>, (i, t): (usize, f32), cos: (usize, f32)) -> f32 {
    let (a, b) = (along(&plane[i], cos), along(&plane[i + 1], cos));
    a + (b - a) * t
}

/// The coordinate of a mirror's cosine, see above; 0 / 0 counts as 0.
#[inline]
fn coordinate(cos: f32, alpha: f32) -> f32 {
    (cos * (1.0 + alpha) / (cos + alpha).max(f32::MIN_POSITIVE)).sqrt()
}

/// 1 - E: what a rough perfect mirror loses of light at an angle of cosine `cos`.
#[inline]
pub fn mirror_loss(cos: f32, alpha: f32) -> f32 {
    across(&MIRROR_LOST, place(alpha.sqrt(), ALPHA), place(coordinate(cos, alpha), COS))
}

/// What a rough mirror gives back of light at an angle of cosine `cos` were its microfacets' share (1 - cos θ)⁵: what
/// Schlick's curve adds at grazing angles, in single scattering.
#[inline]
pub fn mirror_grazing(cos: f32, alpha: f32) -> f32 {
    let more = across(&MIRROR_GRAZING, place(alpha.sqrt(), ALPHA), place(cos.sqrt(), COS));
    (plain_grazing(cos, alpha) + more).clamp(0.0, 1.0)
}

/// The part of polished mirrors.
#[inline]
fn plain_grazing(cos: f32, alpha: f32) -> f32 {
    let m = 1.0 - cos;
    polish(alpha) * m * m * m * m * m * (1.0 - mirror_loss(cos, alpha))
}

/// What [`Sheen`](super::Sheen) of white fibres gives back of light at an angle of cosine `cos`.
#[inline]
pub fn sheen(cos: f32, alpha: f32) -> f32 {
    across(&SHEEN, place(alpha.sqrt(), ALPHA), place(cos.sqrt(), COS))
}

/// The mean of [`mirror_loss`] over all directions, each weighted by its cosine.
#[inline]
pub fn mirror_loss_average(alpha: f32) -> f32 {
    along(&MIRROR_LOST_MEAN, place(alpha.sqrt(), ALPHA))
}

/// Which side's table, and the place along its indices of refraction.
#[inline]
fn medium(ior: f32) -> (usize, (usize, f32)) {
    let (side, dense) = if ior < 1.0 { (1, 1.0 / ior) } else { (0, ior) };
    (side, place(((dense - 1.0) / (dense + 1.0)).sqrt() / STEEPEST, IOR))
}

#[inline]
fn through(sides: &Sides, cos: f32, alpha: f32, ior: f32) -> f32 {
    let (side, (i, t)) = medium(ior);
    let (alpha, cos) = (place(alpha.sqrt(), ALPHA_CLEAR), place(cos.sqrt(), COS));
    let (a, b) = (across(&sides[side][i], alpha, cos), across(&sides[side][i + 1], alpha, cos));
    a + (b - a) * t
}

/// How far the surface's own angle tells what its microfacets do: not at all once they blur the critical angle by more
/// than the table's entries are apart.
#[inline]
fn polish(alpha: f32) -> f32 {
    let rest = (1.0 - 4.0 * alpha).max(0.0);
    let squared = rest * rest;
    squared * squared
}

/// What is mirrored if Fresnel's share were that of the surface itself: right for polished borders.
#[inline]
fn plain_mirrored(cos: f32, alpha: f32, ior: f32) -> f32 {
    polish(alpha) * fresnel::dielectric(cos, ior) * (1.0 - mirror_loss(cos, alpha))
}

/// What a rough border mirrors in single scattering of light at an angle of cosine `cos`.
#[inline]
pub fn dielectric_mirrored(cos: f32, alpha: f32, ior: f32) -> f32 {
    (plain_mirrored(cos, alpha, ior) + through(&MIRRORED, cos, alpha, ior)).clamp(0.0, 1.0)
}

/// The mean of [`dielectric_mirrored`] over all directions, each weighted by its cosine.
#[inline]
pub fn dielectric_mirrored_average(alpha: f32, ior: f32) -> f32 {
    let (side, (i, t)) = medium(ior);
    let alpha = place(alpha.sqrt(), ALPHA_CLEAR);
    let (a, b) = (along(&MIRRORED_MEAN[side][i], alpha), along(&MIRRORED_MEAN[side][i + 1], alpha));
    a + (b - a) * t
}

/// How often to pick the mirrored half of microfacets' light seen at an angle of cosine `cos`: the mean of the share
/// `mirrored` at the angle itself and at two by which microfacets are tilted, never quite 0 or 1 where it is rough,
/// since single microfacets may be tilted further.
#[inline]
pub(crate) fn mirrored_share(cos: f32, alpha: f32, mirrored: impl Fn(f32) -> f32) -> f32 {
    if alpha == 0.0 {
        return mirrored(cos);
    }
    // A slope of 0.7 alpha, without angles.
    let (slope, sin) = (0.7 * alpha, (1.0 - cos * cos).max(0.0).sqrt());
    let scale = 1.0 / (1.0 + slope * slope).sqrt();
    let (towards, away) = (((cos + sin * slope) * scale).min(1.0), ((cos - sin * slope) * scale).abs());
    let mean = (mirrored(cos) + mirrored(towards) + mirrored(away)) * (1.0 / 3.0);
    let margin = 0.1 * (4.0 * alpha).min(1.0);
    mean.clamp(margin, 1.0 - margin)
}
