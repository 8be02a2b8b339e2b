//! Cells between a table's entries, from which [`InterfaceLoss`] samples directions: L is linear in
//! each cell, and a bound on its integral is known.

use super::interface::{InterfaceLoss, TableSize};
use super::sample_rng::SampleRng;
use super::zone::{Side, Zone};

/// Interpolated loss of one interface on one side.
pub(super) struct Cells {
    zones: &'static [Zone],
    azimuths: usize,
    cos: usize,
    /// L by azimuth, zone and cosine.
    values: [[[f32; TableSize::MAX_COS]; 2]; TableSize::MAX_AZIMUTH],
    /// Bound on the integral of L over each cell, by azimuth, zone and cosine.
    bounds: [[[f32; TableSize::MAX_COS]; 2]; TableSize::MAX_AZIMUTH],
    /// Sums of `bounds` by azimuth.
    pub sums: [f32; TableSize::MAX_AZIMUTH],
}

impl Cells {
    pub fn new(loss: &InterfaceLoss, side: Side) -> Self {
        let size = loss.size();
        let empty = [[[0.0; TableSize::MAX_COS]; 2]; TableSize::MAX_AZIMUTH];
        let (zones, azimuths, cos) = (side.zones(), size.azimuth, size.cos);
        let mut cells =
            Self { zones, azimuths, cos, values: empty, bounds: empty, sums: [0.0; TableSize::MAX_AZIMUTH] };
        loss.visit(|surface, weight| {
            for (p, by_zone) in cells.values.iter_mut().enumerate().take(azimuths) {
                for (row, zone) in by_zone.iter_mut().zip(zones) {
                    let start = ((surface * azimuths + p) * size.zones + *zone as usize) * cos;
                    let entries = loss.entries().iter().skip(start).take(cos);
                    row.iter_mut().zip(entries).for_each(|(value, entry)| *value += weight * f32::from(*entry));
                }
            }
        });
        cells.bound(loss.critical());
        cells
    }

    fn bound(&mut self, critical: f32) {
        let step = 1.0 / (self.cos - 1) as f32;
        for p in 0..self.azimuths {
            for (z, zone) in self.zones.iter().enumerate() {
                for k in 0..self.cos - 1 {
                    let measure = zone.area((k + 1) as f32 * step) - zone.area(k as f32 * step);
                    let bound = self.values[p][z][k].max(self.values[p][z][k + 1]).max(0.0);
                    self.bounds[p][z][k] = bound * measure * zone.fraction(critical);
                    self.sums[p] += self.bounds[p][z][k];
                }
            }
        }
    }

    /// Interpolates a quantity between two neighboring azimuths.
    #[inline]
    fn between(&self, (p, s): (usize, f32), of: impl Fn(usize) -> f32) -> f32 {
        let here = of(p);
        if self.azimuths == 1 { here } else { here + (of(p + 1) - here) * s }
    }

    /// Samples a zone and A in it, and whether rejection accepts the direction; `None` where it
    /// rejects the azimuth.
    pub fn sample(&self, azimuth: (usize, f32), random: &mut SampleRng, max: f32) -> Option<(Zone, f32, bool)> {
        let mut rest = random.unit() * max;
        let step = 1.0 / (self.cos - 1) as f32;
        for (z, zone) in self.zones.iter().enumerate() {
            for k in 0..self.cos - 1 {
                let bound = self.between(azimuth, |p| self.bounds[p][z][k]);
                if rest >= bound || bound <= 0.0 {
                    rest -= bound;
                    continue;
                }
                let (start, end) = (zone.area(k as f32 * step), zone.area((k + 1) as f32 * step));
                let area = start + (end - start) * random.unit();
                let t = (zone.coordinate(area) / step - k as f32).clamp(0.0, 1.0);
                let value = self.between(azimuth, |p| {
                    let row = &self.values[p][z];
                    row[k] + (row[k + 1] - row[k]) * t
                });
                let highest = self.between(azimuth, |p| self.values[p][z][k].max(self.values[p][z][k + 1]).max(0.0));
                return Some((*zone, area, random.unit() * highest <= value));
            }
        }
        None
    }
}
