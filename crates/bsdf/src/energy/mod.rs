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
use super::lanes::lanes;
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
#[inline(always)]
fn table_position(x: f32, count: usize) -> (usize, f32) {
    let at = x.clamp(0.0, 1.0) * (count - 1) as f32;
    // Conversions to 16 bits take few instructions.
    let below = (at as u16).min(count as u16 - 2);
    (usize::from(below), at - f32::from(below))
}

#[inline(always)]
fn lerp_row<const N: usize>(row: &[i16; N], (i, t): (usize, f32)) -> f32 {
    let (a, b) = (f32::from(row[i]), f32::from(row[i + 1]));
    (a + (b - a) * t) * UNIT
}

/// Interpolates a table in a row at coordinates of several cosines, 0 to 1.
#[inline(always)]
fn lerp_table<const ROWS: usize, const N: usize>(
    plane: &Plane<ROWS>,
    (i, t): (usize, f32),
    coordinates: [f32; N],
) -> [f32; N] {
    let (below, above) = (&plane[i], &plane[i + 1]);
    lanes(|lane| {
        let at = table_position(coordinates[lane], COS);
        let (a, b) = (lerp_row(below, at), lerp_row(above, at));
        a + (b - a) * t
    })
}

/// Square roots of several numbers.
#[inline(always)]
fn roots<const N: usize>(numbers: [f32; N]) -> [f32; N] {
    lanes(|lane| numbers[lane].sqrt())
}

/// Coordinate of a mirror's cosine, see above; 0 / 0 counts as 0.
#[inline]
fn coordinate(cos: f32, alpha: f32) -> f32 {
    (cos * (1.0 + alpha) / (cos + alpha).max(f32::MIN_POSITIVE)).sqrt()
}

/// 1 - E: fraction of light at angles of these cosines that a rough perfect mirror loses.
#[inline(always)]
pub fn isotropic_mirror_losses<const N: usize>(cos: [f32; N], alpha: f32) -> [f32; N] {
    lerp_table(&MIRROR_LOSS, table_position(alpha.sqrt(), ALPHA), lanes(|lane| coordinate(cos[lane], alpha)))
}

/// [`isotropic_mirror_losses`] at a single cosine.
#[inline]
pub fn isotropic_mirror_loss(cos: f32, alpha: f32) -> f32 {
    let [lost] = isotropic_mirror_losses([cos], alpha);
    lost
}

/// Directional albedos, at angles of these cosines, of single scattering at microfacets of
/// reflectance (1 - cos θ)⁵: the weights of the grazing color in Schlick's curve. `lost` is
/// [`isotropic_mirror_losses`].
#[inline(always)]
pub fn grazing_albedos<const N: usize>(cos: [f32; N], alpha: f32, lost: [f32; N]) -> [f32; N] {
    let row = table_position(alpha.sqrt(), ALPHA);
    let more = lerp_table(&MIRROR_GRAZING, row, roots(cos));
    lanes(|lane| (plain_grazing(cos[lane], alpha, lost[lane]) + more[lane]).clamp(0.0, 1.0))
}

/// Value for polished mirrors, to which the table adds corrections.
#[inline(always)]
fn plain_grazing(cos: f32, alpha: f32, lost: f32) -> f32 {
    let m = 1.0 - cos;
    polish(alpha) * m * m * m * m * m * (1.0 - lost)
}

/// Directional albedos of white [`Sheen`](super::Sheen) at angles of these cosines.
#[inline(always)]
pub fn sheen_albedos<const N: usize>(cos: [f32; N], alpha: f32) -> [f32; N] {
    lerp_table(&SHEEN, table_position(alpha.sqrt(), ALPHA), roots(cos))
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

#[inline(always)]
fn lerp_interface_table<const N: usize>(sides: &Sides, cos: [f32; N], alpha: f32, ior: f32) -> [f32; N] {
    let (side, (i, t)) = interface_position(ior);
    let (row, coordinates) = (table_position(alpha.sqrt(), ALPHA_CLEAR), roots(cos));
    let below = lerp_table(&sides[side][i], row, coordinates);
    let above = lerp_table(&sides[side][i + 1], row, coordinates);
    lanes(|lane| below[lane] + (above[lane] - below[lane]) * t)
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
#[inline(always)]
fn plain_reflection<const N: usize>(cos: [f32; N], alpha: f32, ior: f32, lost: [f32; N]) -> [f32; N] {
    let polish = polish(alpha);
    let reflectances = if polish > 0.0 { fresnel::dielectric_reflectances(cos, ior) } else { [0.0; N] };
    lanes(|lane| polish * reflectances[lane] * (1.0 - lost[lane]))
}

/// Directional albedos, at angles of these cosines, of single reflection at a rough interface.
/// `lost` is [`isotropic_mirror_losses`].
#[inline(always)]
pub fn dielectric_reflection_albedos<const N: usize>(cos: [f32; N], alpha: f32, ior: f32, lost: [f32; N]) -> [f32; N] {
    let (plain, more) = (plain_reflection(cos, alpha, ior, lost), lerp_interface_table(&REFLECTION, cos, alpha, ior));
    lanes(|lane| (plain[lane] + more[lane]).clamp(0.0, 1.0))
}

/// [`dielectric_reflection_albedos`] at a single cosine.
#[inline]
pub fn dielectric_reflection_albedo(cos: f32, alpha: f32, ior: f32, lost: f32) -> f32 {
    let [albedo] = dielectric_reflection_albedos([cos], alpha, ior, [lost]);
    albedo
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
