//! Picking directions by a table of how bright they are: cells of equal turn in rows between given heights, each cell
//! even by solid angle (Pharr, Jakob, Humphreys, PBR 4th ed., section 12.5; with rows even by the sine of the
//! elevation within, there is no pole where densities grow without end).

use juggler_math::distribution::Distribution2D;
use juggler_math::{Vec2, Vec3, fun};
use std::f64::consts::{PI, TAU};

/// A table over the sphere, its top at +Y. Rows go down from there, columns from -Z over +X.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Directions {
    distribution: Distribution2D,
    /// Heights of the rows' borders on the unit sphere, from 1 down to -1.
    borders: Vec<f64>,
}

impl Directions {
    /// From how bright each cell is, row by row; `None` for no cells at all.
    pub fn new(width: usize, borders: Vec<f64>, brightness: &[f32]) -> Option<Self> {
        let rows = brightness.chunks(width.max(1)).zip(borders.windows(2));
        let weigh = |(row, height): (&[f32], &[f64])| {
            let size = (height[0] - height[1]) as f32;
            row.iter().map(|v| v * size).collect::<Vec<_>>()
        };
        let weights: Vec<f32> = rows.flat_map(weigh).collect();
        let complete = borders.len() == brightness.len() / width.max(1) + 1;
        complete.then(|| Distribution2D::new(width, &weights))?.map(|distribution| Self { distribution, borders })
    }

    /// Borders of rows of equal angle, as those of a picture of the whole sphere.
    pub fn equal_angles(rows: usize) -> Vec<f64> {
        (0..=rows).map(|row| fun::cos_f64(PI * row as f64 / rows as f64)).collect()
    }

    /// Borders of rows of equal solid angle.
    pub fn equal_heights(rows: usize) -> Vec<f64> {
        (0..=rows).map(|row| 1.0 - 2.0 * row as f64 / rows as f64).collect()
    }

    /// The row's middle height, when cells are looked at one by one.
    pub fn row_height(borders: &[f64], row: f64) -> f64 {
        let index = (row as usize).min(borders.len().saturating_sub(2));
        borders[index] + (borders[index + 1] - borders[index]) * (row - index as f64)
    }

    fn rows(&self) -> usize {
        self.borders.len() - 1
    }

    /// A direction and its density per steradian; `None` when nothing is bright.
    pub fn sample(&self, u: Vec2) -> Option<(Vec3, f32)> {
        let (place, density) = self.distribution.sample(u);
        let row = f64::from(place.y) * self.rows() as f64;
        let direction = direction(place.x, Self::row_height(&self.borders, row));
        let pdf = self.per_steradian(density, row as usize);
        (self.distribution.mean() > 0.0 && pdf > 0.0).then_some((direction, pdf))
    }

    /// Density per steradian of a unit direction.
    pub fn pdf(&self, direction: Vec3) -> f32 {
        if self.distribution.mean() == 0.0 {
            return 0.0;
        }
        let height = f64::from(direction.y);
        let row = self.borders.partition_point(|border| *border > height).clamp(1, self.rows()) - 1;
        let y = ((row as f64 + 0.5) / self.rows() as f64) as f32;
        self.per_steradian(self.distribution.pdf(Vec2::new(turn(direction), y)), row)
    }

    fn per_steradian(&self, density: f32, row: usize) -> f32 {
        let row = row.min(self.rows() - 1);
        let size = self.borders[row] - self.borders[row + 1];
        (f64::from(density) / (TAU * size * self.rows() as f64)) as f32
    }
}

/// How far a direction is turned from -Z over +X, as a share of a whole turn in [0, 1).
pub(super) fn turn(direction: Vec3) -> f32 {
    let turn = fun::atan2(direction.x, -direction.z) * std::f32::consts::FRAC_1_PI * 0.5;
    if turn < 0.0 { (turn + 1.0).min(1f32.next_down()) } else { turn }
}

/// The unit direction with this turn and height.
pub(super) fn direction(turn: f32, height: f64) -> Vec3 {
    let (sin, cos) = fun::sin_cos_turns(turn);
    let ring = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt() as f32;
    Vec3::new(ring * sin, height as f32, -ring * cos)
}
