//! Importance sampling of directions from a table: cells of equal azimuth in rows between given
//! heights, uniform by solid angle within a cell (Pharr, Jakob, Humphreys, PBR 4th ed., section
//! 12.5). Rows are uniform in the sine of the elevation, so densities stay bounded at the poles.

use juggler_math::distribution::Distribution2D;
use juggler_math::{Vec2, Vec3, portable};
use std::f64::consts::{PI, TAU};

/// Table over the sphere with its top at +Y. Rows go down from the top, columns from -Z towards +X.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DirectionTable {
    distribution: Distribution2D,
    /// Heights of the row boundaries on the unit sphere, from 1 down to -1.
    row_heights: Vec<f64>,
}

impl DirectionTable {
    /// Creates a table from the brightness of each cell, row by row; `None` if there are no cells.
    pub fn new(width: usize, row_heights: Vec<f64>, brightness: &[f32]) -> Option<Self> {
        let rows = brightness.chunks(width.max(1)).zip(row_heights.windows(2));
        let weigh = |(row, height): (&[f32], &[f64])| {
            let size = (height[0] - height[1]) as f32;
            row.iter().map(|v| v * size).collect::<Vec<_>>()
        };
        let weights: Vec<f32> = rows.flat_map(weigh).collect();
        let complete = row_heights.len() == brightness.len() / width.max(1) + 1;
        complete.then(|| Distribution2D::new(width, &weights))?.map(|distribution| Self { distribution, row_heights })
    }

    /// Boundaries of rows of equal angle, as in an equirectangular image.
    pub fn equal_angles(rows: usize) -> Vec<f64> {
        (0..=rows).map(|row| portable::cos_f64(PI * row as f64 / rows as f64)).collect()
    }

    /// Boundaries of rows of equal solid angle.
    pub fn equal_heights(rows: usize) -> Vec<f64> {
        (0..=rows).map(|row| 1.0 - 2.0 * row as f64 / rows as f64).collect()
    }

    /// Height at a fractional row, linear within a row.
    pub fn row_height(row_heights: &[f64], row: f64) -> f64 {
        let index = (row as usize).min(row_heights.len().saturating_sub(2));
        row_heights[index] + (row_heights[index + 1] - row_heights[index]) * (row - index as f64)
    }

    fn rows(&self) -> usize {
        self.row_heights.len() - 1
    }

    /// Samples a direction and its density per steradian; `None` if all cells are dark.
    pub fn sample(&self, u: Vec2) -> Option<(Vec3, f32)> {
        let (point, density) = self.distribution.sample(u);
        let row = f64::from(point.y) * self.rows() as f64;
        let direction = direction(point.x, Self::row_height(&self.row_heights, row));
        let pdf = self.per_steradian(density, row as usize);
        (self.distribution.mean() > 0.0 && pdf > 0.0).then_some((direction, pdf))
    }

    /// Density per steradian of a unit direction.
    pub fn pdf(&self, direction: Vec3) -> f32 {
        if self.distribution.mean() == 0.0 {
            return 0.0;
        }
        let height = f64::from(direction.y);
        let row = self.row_heights.partition_point(|row_height| *row_height > height).clamp(1, self.rows()) - 1;
        let y = ((row as f64 + 0.5) / self.rows() as f64) as f32;
        self.per_steradian(self.distribution.pdf(Vec2::new(azimuth_turns(direction), y)), row)
    }

    fn per_steradian(&self, density: f32, row: usize) -> f32 {
        let row = row.min(self.rows() - 1);
        let size = self.row_heights[row] - self.row_heights[row + 1];
        (f64::from(density) / (TAU * size * self.rows() as f64)) as f32
    }
}

/// Azimuth of a direction in turns, from -Z towards +X, in [0, 1).
pub(super) fn azimuth_turns(direction: Vec3) -> f32 {
    let azimuth = portable::atan2(direction.x, -direction.z) * std::f32::consts::FRAC_1_PI * 0.5;
    if azimuth < 0.0 { (azimuth + 1.0).min(1f32.next_down()) } else { azimuth }
}

/// Unit direction with this azimuth in turns and this height.
pub(super) fn direction(azimuth: f32, height: f64) -> Vec3 {
    let (sin, cos) = portable::sin_cos_turns(azimuth);
    let ring = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt() as f32;
    Vec3::new(ring * sin, height as f32, -ring * cos)
}
