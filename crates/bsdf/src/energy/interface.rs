//! Energy that single scattering loses at a rough interface of two clear media: L(w) for either side, its mean over the
//! hemisphere, and directions in proportion to L(w) cos θ, as the compensation of [`Dielectric`](super::super::Dielectric)
//! needs them (Kulla and Conty 2017).
//!
//! Tables hold L for surfaces that are alike in all directions and, coarser, for stretched ones, also for stretched perfect
//! mirrors. Along the larger alpha, the index of refraction η and the ratio of both alphas they are interpolated by cubic
//! Lagrange polynomials, along the direction linearly. All of that is linear in the entries, and the places of entries along
//! the direction depend neither on alpha nor on η; so the tabulated means are those of what [`InterfaceLoss::at`] interpolates,
//! but where it cuts off what is hardly above 0.
//!
//! Directions fall into three zones, each with entries of its own: those in the thinner medium, and those in the denser one
//! below and above the critical angle. Entries of the three zones have the same places for any η, in terms of A, which is
//! even over cosine-weighted directions of a zone: cos² θ in the thinner medium, cos² of the refracted direction in the
//! denser one (1 - η² sin² θ), and cos² θ / cos² θc beyond its critical angle θc. Features of L near the critical angle and
//! near grazing angles stay at their entries while η changes.

use super::super::ggx::Ggx;
use super::cells::Cells;
use super::interface_round as round;
use super::interface_stretched as stretched;
use super::mirror_stretched as mirror;
use super::scramble::Scramble;
use super::zone::{Side, Zone};
use super::{STEEPEST, place};
use juggler_math::{Vec3, fun};

/// Numbers of entries of a table, along each of its axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Along the root of the smaller alpha over the larger one, from 0 to 1; 1 entry where both are the same.
    pub roundness: usize,
    /// Along the fourth root of the larger alpha, from [`Ggx::SMOOTH`] to 1.
    pub alpha: usize,
    /// Along √((η - 1) / (η + 1)), from 0 to [`STEEPEST`]; 1 entry for mirrors.
    pub ior: usize,
    /// From the smoother axis to the rougher one.
    pub azimuth: usize,
    /// 3 zones of directions, of a mirror 1.
    pub zones: usize,
    /// Along a zone.
    pub cos: usize,
}

impl Grid {
    /// The most entries along a zone.
    pub(super) const MAX_COS: usize = 47;
    /// The most entries along the azimuth.
    pub(super) const MAX_AZIMUTH: usize = 5;
    /// Light that total reflection keeps inside meets grazing angles dozens of times, where half as many entries along a
    /// zone are 5 % below the loss of alpha 0.04, and linear interpolation between these entries 2 %.
    pub(super) const ROUND: Self = Self { roundness: 1, alpha: 18, ior: 12, azimuth: 1, zones: 3, cos: 47 };
    pub(super) const STRETCHED: Self = Self { roundness: 4, alpha: 10, ior: 6, azimuth: 5, zones: 3, cos: 14 };
    pub(super) const MIRROR: Self = Self { roundness: 6, alpha: 12, ior: 1, azimuth: 5, zones: 1, cos: 24 };
    /// The fourth root of [`Ggx::SMOOTH`].
    pub(super) const LEAST: f32 = 0.177_827_94;
}

/// Entries and means, in units of 1/65536.
struct Table {
    grid: Grid,
    lost: &'static [u16],
    means: &'static [u16],
}

static ROUND: Table = Table { grid: Grid::ROUND, lost: &round::LOST, means: &round::MEANS };
static STRETCHED: Table = Table { grid: Grid::STRETCHED, lost: &stretched::LOST, means: &stretched::MEANS };

static MIRROR: Table = Table { grid: Grid::MIRROR, lost: &mirror::LOST, means: &mirror::MEANS };

const UNIT: f32 = 1.0 / 65_536.0;

/// The weights of up to four neighboring entries along an axis: a cubic Lagrange polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stencil {
    first: usize,
    count: usize,
    weights: [f32; 4],
}

impl Stencil {
    /// For the place `x`, 0 to 1, of `entries`: one, or four and more.
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

/// The loss of one interface.
#[derive(Clone, Copy)]
pub struct InterfaceLoss {
    table: &'static Table,
    roundness: Stencil,
    alpha: Stencil,
    ior: Stencil,
    /// Whether x is the rougher axis.
    is_along_x: bool,
    /// The larger index over the smaller one, squared.
    squared_ior: f32,
    /// cos² of the critical angle.
    critical: f32,
}

impl InterfaceLoss {
    /// `ior` is the index on one side over that on the other.
    #[inline]
    pub fn new(ggx: Ggx, ior: f32) -> Self {
        let dense = if ior < 1.0 { 1.0 / ior } else { ior };
        Self::looked_up(ggx, dense, if ggx.is_round() { &ROUND } else { &STRETCHED })
    }

    /// What a stretched perfect mirror loses; its only side is [`Side::Thin`].
    #[inline]
    pub fn of_mirror(ggx: Ggx) -> Self {
        Self::looked_up(ggx, 1.0, &MIRROR)
    }

    #[inline]
    fn looked_up(ggx: Ggx, dense: f32, table: &'static Table) -> Self {
        let (alpha, squared_ior) = (ggx.alpha(), dense * dense);
        let root = alpha.max_element().sqrt().sqrt();
        Self {
            table,
            roundness: Stencil::new(ggx.roundness().sqrt(), table.grid.roundness),
            alpha: Stencil::new((root - Grid::LEAST) / (1.0 - Grid::LEAST), table.grid.alpha),
            ior: Stencil::new(((dense - 1.0) / (dense + 1.0)).sqrt() / STEEPEST, table.grid.ior),
            is_along_x: alpha.x >= alpha.y,
            squared_ior,
            critical: 1.0 - 1.0 / squared_ior,
        }
    }

    pub(super) fn grid(&self) -> Grid {
        self.table.grid
    }

    pub(super) fn entries(&self) -> &'static [u16] {
        self.table.lost
    }

    /// cos² of the critical angle.
    pub(super) fn critical(&self) -> f32 {
        self.critical
    }

    /// Visits the surfaces of the table with their weights.
    #[inline]
    pub(super) fn visit(&self, mut visit: impl FnMut(usize, f32)) {
        let grid = self.table.grid;
        for (r, by_roundness) in self.roundness.entries() {
            for (a, by_alpha) in self.alpha.entries() {
                let (row, weight) = ((r * grid.alpha + a) * grid.ior, by_roundness * by_alpha);
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

    /// Entry and fraction of the azimuth of a direction with these coordinates along x and y.
    #[inline]
    fn azimuth(&self, x: f32, y: f32) -> (usize, f32) {
        if self.table.grid.azimuth == 1 {
            return (0, 0.0);
        }
        let (x, y) = (x.abs(), y.abs());
        let along = if self.is_along_x { x } else { y };
        place(along / (x + y).max(f32::MIN_POSITIVE), self.table.grid.azimuth)
    }

    /// The share of light along `w`, on `side`, that single scattering loses.
    pub fn at(&self, side: Side, w: Vec3) -> f32 {
        let grid = self.table.grid;
        let (zone, area) = self.zone(side, w.z * w.z);
        let (k, t) = place(zone.coordinate(area), grid.cos);
        let (p, s) = self.azimuth(w.x, w.y);
        let along = |start: usize| {
            let pair = self.table.lost.get(start..start + 2).unwrap_or(&[0, 0]);
            let (a, b) = (f32::from(pair[0]), f32::from(pair[1]));
            a + (b - a) * t
        };
        let mut sum = 0.0;
        self.visit(|surface, weight| {
            let start = ((surface * grid.azimuth + p) * grid.zones + zone as usize) * grid.cos + k;
            let here = along(start);
            let value = if s == 0.0 { here } else { here + (along(start + grid.zones * grid.cos) - here) * s };
            sum += value * weight;
        });
        (sum * UNIT).clamp(1e-6, 0.999)
    }

    /// The mean of [`InterfaceLoss::at`] over all directions on `side`, each weighted by its cosine.
    pub fn mean(&self, side: Side) -> f32 {
        let grid = self.table.grid;
        let of = |zone: Zone| {
            let mut sum = 0.0;
            self.visit(|surface, weight| {
                let mean = self.table.means.get(surface * grid.zones + zone as usize);
                sum += weight * f32::from(mean.copied().unwrap_or(0));
            });
            sum
        };
        side.zones().iter().map(|zone| of(*zone) * zone.share(self.critical)).sum::<f32>().max(0.0) * UNIT
    }

    /// A direction on `side`, turned up, with the density L(w) cos θ / (π L̄) per steradian: by rejection from the entries
    /// around it.
    pub fn sample(&self, side: Side, random: &mut Scramble) -> Vec3 {
        let cells = Cells::new(self, side);
        let most = cells.sums.iter().copied().fold(0.0, f32::max);
        let mut w = Vec3::Z;
        for _ in 0..MAX_TRIES {
            let (sin, cos) = fun::sin_cos_turns(random.unit());
            let azimuth = self.azimuth(cos, sin);
            let Some((zone, area, is_taken)) = cells.pick(azimuth, random, most) else { continue };
            let squared = zone.squared_cos(area, self.critical).clamp(1e-12, 1.0);
            let along = (1.0 - squared).sqrt();
            w = Vec3::new(along * cos, along * sin, squared.sqrt());
            if is_taken {
                break;
            }
        }
        w
    }
}

/// Attempts at a direction, of which more than half succeed.
const MAX_TRIES: u32 = 64;
