//! Energy that single scattering loses at a rough dielectric interface: L(w) for either side, its
//! mean over the hemisphere, and directions in proportion to L(w) cos θ, for the compensation of
//! [`Dielectric`](super::super::Dielectric) (Kulla and Conty 2017).
//!
//! Tables hold L for isotropic surfaces and, coarser, for anisotropic surfaces and anisotropic
//! perfect mirrors. Interpolation is by cubic Lagrange polynomials along the larger alpha, the
//! index of refraction η and the ratio of both alphas, and linear along the direction. All of that
//! is linear in the entries, and the positions of entries along the direction depend neither on
//! alpha nor on η; so the tabulated means equal the means of [`InterfaceLoss::at`], except
//! where it clamps values near 0.
//!
//! Directions fall into three zones, each with entries of its own: those in the thinner medium, and
//! those in the denser one below and above the critical angle. Entries have the same positions for
//! any η in terms of A, in which cosine-weighted directions of a zone are uniform: cos² θ in the
//! thinner medium, cos² of the refracted direction in the denser one (1 - η² sin² θ), and cos² θ /
//! cos² θc beyond its critical angle θc. Features of L near the critical angle and near grazing
//! angles thus stay at their entries while η changes.

use super::super::ggx::Ggx;
use super::cells::Cells;
use super::interface_anisotropic as anisotropic;
use super::interface_isotropic as isotropic;
use super::mirror_anisotropic as mirror;
use super::sample_rng::SampleRng;
use super::zone::{Side, Zone};
use super::{STEEPEST, table_position};
use juggler_math::{Vec3, portable};

/// Numbers of entries of a table along each of its axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct TableSize {
    /// Along the square root of the smaller alpha over the larger one, from 0 to 1; 1 entry for
    /// isotropic surfaces.
    pub alpha_ratio: usize,
    /// Along the fourth root of the larger alpha, from [`Ggx::SMOOTH`] to 1.
    pub alpha: usize,
    /// Along √((η - 1) / (η + 1)), from 0 to [`STEEPEST`]; 1 entry for mirrors.
    pub ior: usize,
    /// From the smoother axis to the rougher one.
    pub azimuth: usize,
    /// Zones of directions: 3, or 1 for mirrors.
    pub zones: usize,
    /// Along the directions of a zone.
    pub cos: usize,
}

impl TableSize {
    /// Maximum number of entries along a zone.
    pub(super) const MAX_COS: usize = 47;
    /// Maximum number of entries along the azimuth.
    pub(super) const MAX_AZIMUTH: usize = 9;
    /// Totally reflected light hits grazing angles dozens of times. There, at alpha 0.04,
    /// interpolation between these entries is 2 % below the loss, and between half as many 5 %.
    pub(super) const ISOTROPIC: Self = Self { alpha_ratio: 1, alpha: 18, ior: 12, azimuth: 1, zones: 3, cos: 47 };
    pub(super) const ANISOTROPIC: Self = Self { alpha_ratio: 4, alpha: 10, ior: 6, azimuth: 5, zones: 3, cos: 14 };
    pub(super) const MIRROR: Self = Self { alpha_ratio: 11, alpha: 12, ior: 1, azimuth: 9, zones: 1, cos: 24 };
    /// The fourth root of [`Ggx::SMOOTH`].
    pub(super) const LEAST: f32 = 0.177_827_94;
}

/// Entries and means, in units of 1/65536.
struct Table {
    size: TableSize,
    loss: &'static [u16],
    means: &'static [u16],
}

static ISOTROPIC: Table = Table { size: TableSize::ISOTROPIC, loss: &isotropic::LOSS, means: &isotropic::MEANS };
static ANISOTROPIC: Table =
    Table { size: TableSize::ANISOTROPIC, loss: &anisotropic::LOSS, means: &anisotropic::MEANS };

static MIRROR: Table = Table { size: TableSize::MIRROR, loss: &mirror::LOSS, means: &mirror::MEANS };

const UNIT: f32 = 1.0 / 65_536.0;

/// Weights of up to four neighboring entries along an axis: a cubic Lagrange polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stencil {
    first: usize,
    count: usize,
    weights: [f32; 4],
}

impl Stencil {
    /// Stencil at position `x`, 0 to 1, among `entries`: one, or four and more.
    #[inline]
    fn new(x: f32, entries: usize) -> Self {
        if entries == 1 {
            return Self { first: 0, count: 1, weights: [1.0, 0.0, 0.0, 0.0] };
        }
        let at = x.clamp(0.0, 1.0) * (entries - 1) as f32;
        let first = (at as usize).saturating_sub(1).min(entries - 4);
        let t = at - first as f32;
        let (a, b, c) = (t - 1.0, t - 2.0, t - 3.0);
        let weights = [a * b * c * (-1.0 / 6.0), t * b * c * 0.5, t * a * c * -0.5, t * a * b * (1.0 / 6.0)];
        Self { first, count: 4, weights }
    }

    #[inline]
    fn entries(&self) -> impl Iterator<Item = (usize, f32)> {
        self.weights.iter().take(self.count).enumerate().map(|(i, weight)| (self.first + i, *weight))
    }
}

/// Loss of single scattering at one interface.
#[derive(Clone, Copy)]
pub struct InterfaceLoss {
    table: &'static Table,
    alpha_ratio: Stencil,
    alpha: Stencil,
    ior: Stencil,
    /// Whether x is the rougher axis.
    is_along_x: bool,
    /// Square of the larger index of refraction over the smaller one.
    squared_ior: f32,
    /// cos² of the critical angle.
    critical: f32,
}

impl InterfaceLoss {
    /// Loss of a dielectric interface; `ior` is the index of refraction on one side over that on
    /// the other.
    #[inline]
    pub fn new(ggx: Ggx, ior: f32) -> Self {
        let dense = if ior < 1.0 { 1.0 / ior } else { ior };
        Self::from_table(ggx, dense, if ggx.is_isotropic() { &ISOTROPIC } else { &ANISOTROPIC })
    }

    /// Loss of an anisotropic perfect mirror; its only side is [`Side::Thin`].
    #[inline]
    pub fn for_mirror(ggx: Ggx) -> Self {
        Self::from_table(ggx, 1.0, &MIRROR)
    }

    #[inline]
    fn from_table(ggx: Ggx, dense: f32, table: &'static Table) -> Self {
        let (alpha, squared_ior) = (ggx.alpha(), dense * dense);
        let root = alpha.max_element().sqrt().sqrt();
        Self {
            table,
            alpha_ratio: Stencil::new(ggx.alpha_ratio().sqrt(), table.size.alpha_ratio),
            alpha: Stencil::new((root - TableSize::LEAST) / (1.0 - TableSize::LEAST), table.size.alpha),
            ior: Stencil::new(((dense - 1.0) / (dense + 1.0)).sqrt() / STEEPEST, table.size.ior),
            is_along_x: alpha.x >= alpha.y,
            squared_ior,
            critical: 1.0 - 1.0 / squared_ior,
        }
    }

    pub(super) fn size(&self) -> TableSize {
        self.table.size
    }

    pub(super) fn entries(&self) -> &'static [u16] {
        self.table.loss
    }

    /// cos² of the critical angle.
    pub(super) fn critical(&self) -> f32 {
        self.critical
    }

    /// Visits the surfaces of the table with their interpolation weights.
    #[inline]
    pub(super) fn visit(&self, mut visit: impl FnMut(usize, f32)) {
        let size = self.table.size;
        for (r, by_alpha_ratio) in self.alpha_ratio.entries() {
            for (a, by_alpha) in self.alpha.entries() {
                let (row, weight) = ((r * size.alpha + a) * size.ior, by_alpha_ratio * by_alpha);
                for (i, by_ior) in self.ior.entries() {
                    visit(row + i, weight * by_ior);
                }
            }
        }
    }

    /// Zone and A of a direction of this squared cosine.
    #[inline]
    fn zone(&self, side: Side, squared_cos: f32) -> (Zone, f32) {
        if side == Side::Thin {
            return (Zone::Thin, squared_cos);
        }
        let refracted = 1.0 - self.squared_ior * (1.0 - squared_cos);
        if refracted >= 0.0 {
            (Zone::Partial, refracted)
        } else {
            (Zone::Total, squared_cos / self.critical.max(f32::MIN_POSITIVE))
        }
    }

    /// Entry and fraction of the azimuth of a direction with these components along x and y.
    #[inline]
    fn azimuth(&self, x: f32, y: f32) -> (usize, f32) {
        if self.table.size.azimuth == 1 {
            return (0, 0.0);
        }
        let (x, y) = (x.abs(), y.abs());
        let along = if self.is_along_x { x } else { y };
        table_position(along / (x + y).max(f32::MIN_POSITIVE), self.table.size.azimuth)
    }

    /// Fraction of light along `w`, on `side`, that single scattering loses.
    pub fn at(&self, side: Side, w: Vec3) -> f32 {
        let size = self.table.size;
        let (zone, area) = self.zone(side, w.z * w.z);
        let (k, t) = table_position(zone.coordinate(area), size.cos);
        let (p, s) = self.azimuth(w.x, w.y);
        let along = |start: usize| {
            let pair = self.table.loss.get(start..start + 2).unwrap_or(&[0, 0]);
            let (a, b) = (f32::from(pair[0]), f32::from(pair[1]));
            a + (b - a) * t
        };
        let mut sum = 0.0;
        self.visit(|surface, weight| {
            let start = ((surface * size.azimuth + p) * size.zones + zone as usize) * size.cos + k;
            let here = along(start);
            let value = if s == 0.0 { here } else { here + (along(start + size.zones * size.cos) - here) * s };
            sum += value * weight;
        });
        (sum * UNIT).clamp(1e-6, 0.999)
    }

    /// Cosine-weighted mean of [`InterfaceLoss::at`] over all directions on `side`.
    pub fn mean(&self, side: Side) -> f32 {
        let size = self.table.size;
        let of = |zone: Zone| {
            let mut sum = 0.0;
            self.visit(|surface, weight| {
                let mean = self.table.means.get(surface * size.zones + zone as usize);
                sum += weight * f32::from(mean.copied().unwrap_or(0));
            });
            sum
        };
        side.zones().iter().map(|zone| of(*zone) * zone.fraction(self.critical)).sum::<f32>().max(0.0) * UNIT
    }

    /// Samples a direction on `side`, flipped to be above, with the density L(w) cos θ / (π L̄) per
    /// steradian, by rejection from the entries around it.
    pub fn sample(&self, side: Side, random: &mut SampleRng) -> Vec3 {
        let cells = Cells::new(self, side);
        let max = cells.sums.iter().copied().fold(0.0, f32::max);
        let mut w = Vec3::Z;
        for _ in 0..MAX_TRIES {
            let (sin, cos) = portable::sin_cos_turns(random.unit());
            let azimuth = self.azimuth(cos, sin);
            let Some((zone, area, is_accepted)) = cells.sample(azimuth, random, max) else { continue };
            let squared = zone.squared_cos(area, self.critical).clamp(1e-12, 1.0);
            let along = (1.0 - squared).sqrt();
            w = Vec3::new(along * cos, along * sin, squared.sqrt());
            if is_accepted {
                break;
            }
        }
        w
    }
}

/// Maximum number of attempts at a direction, of which more than half succeed.
const MAX_TRIES: u32 = 64;
