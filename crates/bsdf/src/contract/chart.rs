//! Adaptive map of directions, for chi-squared tests of lobes narrower than the cells of a uniform
//! grid.
//!
//! Directions around an axis are projected stereographically, scaled by the lobe's widths, and
//! taken in polar coordinates: v = ln(1 + s²) of the scaled radius s, and the angle. The map covers
//! the whole sphere but the point opposite the axis.

use juggler_math::{DVec3, Vec3, portable};
use std::f64::consts::TAU;

/// Numbers of rings, and of sectors of each ring.
const RINGS: usize = 20;
const SECTORS: usize = 16;
/// Cells of one side of the surface.
pub(super) const CELLS: usize = RINGS * SECTORS;

/// Map of directions on one side of the surface.
pub(super) struct Chart {
    /// 1 above, -1 below.
    side: f64,
    axis: DVec3,
    tangents: [DVec3; 2],
    widths: [f64; 2],
}

/// Median of the values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

impl Chart {
    /// Map fitted to directions of a lobe, of which those on its `side` count.
    pub fn fitted(side: f64, pilot: &[Vec3]) -> Self {
        let here: Vec<DVec3> = pilot.iter().map(|w| w.as_dvec3()).filter(|w| w.z * side > 0.0).collect();
        let around = |axis: DVec3, widths| {
            // The first tangent is in the plane of the axis and the normal, along which lobes are
            // longest.
            let across = DVec3::Z.cross(axis).try_normalize().unwrap_or(DVec3::Y);
            Self { side, axis, tangents: [across.cross(axis), across], widths }
        };
        if here.len() < 5 {
            return around(DVec3::Z * side, [1.0; 2]);
        }
        let middle = [0, 1, 2].map(|i| median(here.iter().map(|w| w[i]).collect()));
        let chart = around(DVec3::from_array(middle).normalize(), [1.0; 2]);
        let widths = [0, 1].map(|i| median(here.iter().map(|w| chart.projected(*w)[i].abs()).collect()).max(1e-9));
        Self { widths, ..chart }
    }

    fn projected(&self, w: DVec3) -> [f64; 2] {
        let scale = 1.0 / (1.0 + w.dot(self.axis)).max(1e-300);
        [0, 1].map(|i| w.dot(self.tangents[i]) * scale / self.widths[i])
    }

    /// Cell of a direction; `None` on the other side.
    pub fn cell(&self, w: Vec3) -> Option<usize> {
        let w = w.as_dvec3();
        if w.z * self.side <= 0.0 {
            return None;
        }
        let [a, b] = self.projected(w);
        let v = portable::ln_f64(1.0 + a * a + b * b);
        let turn = (portable::atan2_f64(b, a) / TAU).rem_euclid(1.0);
        let ring = (0..RINGS - 1).find(|ring| v < edge(ring + 1)).unwrap_or(RINGS - 1);
        Some(ring * SECTORS + ((turn * SECTORS as f64) as usize).min(SECTORS - 1))
    }

    /// Integral of a density over a cell by `steps` by `steps` midpoints.
    pub fn integral(&self, pdf: &impl Fn(Vec3) -> f32, cell: usize, steps: usize) -> f64 {
        let (ring, sector) = (cell / SECTORS, cell % SECTORS);
        let (start, end) = (edge(ring), edge(ring + 1));
        let part = |i: usize| (i as f64 + 0.5) / steps as f64;
        let mut sum = 0.0;
        for i in 0..steps {
            let grown = portable::exp_f64(start + (end - start) * part(i));
            let s = (grown - 1.0).sqrt();
            for j in 0..steps {
                let (sin, cos) = portable::sin_cos_f64((sector as f64 + part(j)) / SECTORS as f64 * TAU);
                let (a, b) = (s * cos * self.widths[0], s * sin * self.widths[1]);
                let far = 1.0 + a * a + b * b;
                let w = (self.axis * (2.0 - far) + (self.tangents[0] * a + self.tangents[1] * b) * 2.0) / far;
                if w.z * self.side > 0.0 {
                    sum += f64::from(pdf(w.as_vec3())) * grown / (far * far);
                }
            }
        }
        // dω = 4 da db / (1 + a² + b²)², and da db = widths · ½ exp v dv dφ.
        let area = (end - start) * TAU / (SECTORS * steps * steps) as f64;
        sum * area * 2.0 * self.widths[0] * self.widths[1]
    }
}

/// Inner edge of a ring in v: inner rings have about the same probability each, outer ones grow.
fn edge(ring: usize) -> f64 {
    const INNER: usize = 12;
    // s² / (1 + s²), the probability of GGX within s at normal incidence.
    let even = |ring: usize| -portable::ln_f64(1.0 - ring as f64 / (INNER + 1) as f64);
    match ring.checked_sub(INNER) {
        None | Some(0) => even(ring),
        // Beyond the last edge, opposite the axis of even the narrowest lobe, there are no
        // directions.
        Some(outer) => even(INNER) + [0.0, 1.0, 2.0, 3.5, 5.0, 7.0, 10.0, 15.0, 45.0][outer],
    }
}
