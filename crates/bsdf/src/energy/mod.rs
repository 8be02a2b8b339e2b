//! Directional albedo of single scattering at GGX microfacets, and its loss to further bounces:
//! tables over the cosine of the angle and alpha, and for dielectric interfaces the relative index
//! of refraction.
//!
//! The loss of dielectric interfaces has tables of its own: [`InterfaceLoss`].
//!
//! The tables hold units of 1/10000 and are integrals of the lobes themselves; `tests.rs` says how.
//! Interpolation is linear in √alpha, in √((η - 1) / (η + 1)) and in √cos; for mirrors, whose loss
//! depends on cos / alpha alone when polished, in `√(cos (1 + alpha) / (cos + alpha))` instead.
//! Tables of the reflection of interfaces hold small corrections to a value that is exact for
//! polished ones. Each tabulated mean is the mean of the interpolated function over the
//! hemisphere, so that compensation adds exactly the energy that was lost.

mod anisotropic;
mod cells;
mod interface;
mod interface_anisotropic;
mod interface_isotropic;
mod interface_reflection;
mod mirror_anisotropic;
mod mirror_grazing;
mod mirror_loss;
mod sample_rng;
mod sheen_albedo;
mod zone;

#[cfg(test)]
mod interface_tests;
#[cfg(test)]
mod tests;

use super::fresnel;
pub use anisotropic::{mean_mirror_loss, mirror_loss, sample_mirror_loss};
pub use interface::InterfaceLoss;
use interface_reflection::{REFLECTION, REFLECTION_MEAN};
use mirror_grazing::MIRROR_GRAZING;
use mirror_loss::{MIRROR_LOSS, MIRROR_LOSS_MEAN};
pub use sample_rng::SampleRng;
use sheen_albedo::SHEEN;
pub use zone::Side;

/// Number of entries along the cosine's coordinate, from 0 to 1.
const COS: usize = 32;
/// Number of entries along √alpha, from 0 to 1.
const ALPHA: usize = 32;
/// Number of entries along √alpha in the tables of dielectrics.
const ALPHA_CLEAR: usize = 12;
/// Number of entries along √((η - 1) / (η + 1)), from 0 to [`STEEPEST`].
const IOR: usize = 10;
/// √0.6, the coordinate of η = 4; larger η are clamped to it.
const STEEPEST: f32 = 0.774_596_7;

/// Table by alpha, then √cos.
type Plane<const N: usize> = [[i16; COS]; N];
/// Table by side (light from the thinner medium, from the denser one), index of refraction, alpha
/// and √cos.
type Sides = [[Plane<ALPHA_CLEAR>; IOR]; 2];

/// Table by side, index of refraction and alpha.
type Means = [[[i16; ALPHA_CLEAR]; IOR]; 2];

const UNIT: f32 = 1e-4;

/// Index of the entry at or below `x`, 0 to 1, among `count`, and the fraction towards the next.
#[inline]
fn table_position(x: f32, count: usize) -> (usize, f32) {
    let at = x.clamp(0.0, 1.0) * (count - 1) as f32;
    let below = (at as usize).min(count - 2);
    (below, at - below as f32)
}

#[inline]
fn lerp_row<const N: usize>(row: &[i16; N], (i, t): (usize, f32)) -> f32 {
    let (a, b) = (f32::from(row[i]), f32::from(row[i + 1]));
    (a + (b - a) * t) * UNIT
}

#[inline]
fn lerp_table<const N: usize>(plane: &Plane<N>, (i, t): (usize, f32), cos: (usize, f32)) -> f32 {
    let (a, b) = (lerp_row(&plane[i], cos), lerp_row(&plane[i + 1], cos));
    a + (b - a) * t
}

/// Coordinate of a mirror's cosine, see above; 0 / 0 counts as 0.
#[inline]
fn coordinate(cos: f32, alpha: f32) -> f32 {
    (cos * (1.0 + alpha) / (cos + alpha).max(f32::MIN_POSITIVE)).sqrt()
}

/// 1 - E: fraction of light at an angle of cosine `cos` that a rough perfect mirror loses.
#[inline]
pub fn isotropic_mirror_loss(cos: f32, alpha: f32) -> f32 {
    lerp_table(&MIRROR_LOSS, table_position(alpha.sqrt(), ALPHA), table_position(coordinate(cos, alpha), COS))
}

/// Directional albedo, at an angle of cosine `cos`, of single scattering at microfacets of
/// reflectance (1 - cos θ)⁵: the weight of the grazing color in Schlick's curve. `lost` is
/// [`isotropic_mirror_loss`].
#[inline]
pub fn grazing_albedo(cos: f32, alpha: f32, lost: f32) -> f32 {
    let more = lerp_table(&MIRROR_GRAZING, table_position(alpha.sqrt(), ALPHA), table_position(cos.sqrt(), COS));
    (plain_grazing(cos, alpha, lost) + more).clamp(0.0, 1.0)
}

/// Value for polished mirrors, to which the table adds corrections.
#[inline]
fn plain_grazing(cos: f32, alpha: f32, lost: f32) -> f32 {
    let m = 1.0 - cos;
    polish(alpha) * m * m * m * m * m * (1.0 - lost)
}

/// Directional albedo of white [`Sheen`](super::Sheen) at an angle of cosine `cos`.
#[inline]
pub fn sheen_albedo(cos: f32, alpha: f32) -> f32 {
    lerp_table(&SHEEN, table_position(alpha.sqrt(), ALPHA), table_position(cos.sqrt(), COS))
}

/// Cosine-weighted mean of [`isotropic_mirror_loss`] over all directions.
#[inline]
pub fn mean_isotropic_mirror_loss(alpha: f32) -> f32 {
    lerp_row(&MIRROR_LOSS_MEAN, table_position(alpha.sqrt(), ALPHA))
}

/// Side of the tables, and the position along their indices of refraction.
#[inline]
fn interface_position(ior: f32) -> (usize, (usize, f32)) {
    let (side, dense) = if ior < 1.0 { (1, 1.0 / ior) } else { (0, ior) };
    (side, table_position(((dense - 1.0) / (dense + 1.0)).sqrt() / STEEPEST, IOR))
}

#[inline]
fn lerp_interface_table(sides: &Sides, cos: f32, alpha: f32, ior: f32) -> f32 {
    let (side, (i, t)) = interface_position(ior);
    let (alpha, cos) = (table_position(alpha.sqrt(), ALPHA_CLEAR), table_position(cos.sqrt(), COS));
    let (a, b) = (lerp_table(&sides[side][i], alpha, cos), lerp_table(&sides[side][i + 1], alpha, cos));
    a + (b - a) * t
}

/// Weight of the surface's own angle: 1 if smooth, 0 once microfacets blur the critical angle by
/// more than the spacing of the table's entries.
#[inline]
fn polish(alpha: f32) -> f32 {
    let rest = (1.0 - 4.0 * alpha).max(0.0);
    let squared = rest * rest;
    squared * squared
}

/// Reflection with Fresnel reflectance at the surface's own angle: exact for polished interfaces.
#[inline]
fn plain_reflection(cos: f32, alpha: f32, ior: f32, lost: f32) -> f32 {
    polish(alpha) * fresnel::dielectric_reflectance(cos, ior) * (1.0 - lost)
}

/// Directional albedo, at an angle of cosine `cos`, of single reflection at a rough interface.
/// `lost` is [`isotropic_mirror_loss`].
#[inline]
pub fn dielectric_reflection_albedo(cos: f32, alpha: f32, ior: f32, lost: f32) -> f32 {
    (plain_reflection(cos, alpha, ior, lost) + lerp_interface_table(&REFLECTION, cos, alpha, ior)).clamp(0.0, 1.0)
}

/// Cosine-weighted mean of [`dielectric_reflection_albedo`] over all directions.
#[inline]
pub fn mean_dielectric_reflection_albedo(alpha: f32, ior: f32) -> f32 {
    let (side, (i, t)) = interface_position(ior);
    let alpha = table_position(alpha.sqrt(), ALPHA_CLEAR);
    let (a, b) = (lerp_row(&REFLECTION_MEAN[side][i], alpha), lerp_row(&REFLECTION_MEAN[side][i + 1], alpha));
    a + (b - a) * t
}

/// Mean reflectance of microfacets seen at an angle of cosine `cos`: the mean of `reflectance` at
/// the angle itself and at two angles of tilted microfacets. Kept away from 0 and 1 on rough
/// surfaces, since single microfacets may tilt further.
#[inline]
pub(crate) fn mean_microfacet_reflectance(cos: f32, alpha: f32, reflectance: impl Fn(f32) -> f32) -> f32 {
    if alpha == 0.0 {
        return reflectance(cos);
    }
    // Tilt microfacets by a slope of 0.7 alpha.
    let (slope, sin) = (0.7 * alpha, (1.0 - cos * cos).max(0.0).sqrt());
    let scale = 1.0 / (1.0 + slope * slope).sqrt();
    let (towards, away) = (((cos + sin * slope) * scale).min(1.0), ((cos - sin * slope) * scale).abs());
    let mean = (reflectance(cos) + reflectance(towards) + reflectance(away)) * (1.0 / 3.0);
    let margin = 0.1 * (4.0 * alpha).min(1.0);
    mean.clamp(margin, 1.0 - margin)
}
