//! Texture sampling: wrap modes and filters.

use super::{MipMap, Texel};
use juggler_math::portable;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Continuation of an image beyond its borders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Wrap {
    /// Repeats the image.
    #[default]
    Repeat,
    /// Repeats the image, mirrored every other time.
    Mirror,
    /// Extends the texels at the border.
    Clamp,
    /// Black, with alpha 0.
    Black,
}

/// Filter of an image texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Filter {
    /// Nearest texel. Texels show as blocks at close range.
    Nearest,
    /// Bilinear interpolation of the four nearest texels.
    Bilinear,
    /// Trilinear interpolation: bilinear interpolation in the MIP map levels that fit the ray's
    /// footprint. Prevents aliasing at a distance.
    #[default]
    Trilinear,
}

impl Wrap {
    /// Reduces a coordinate, in units of the image, to small numbers: to the first period if the
    /// mode is periodic, otherwise to -4 to 4.
    fn reduce_coordinate(self, x: f32) -> f64 {
        let x = if x.is_finite() { f64::from(x) } else { 0.0 };
        match self {
            Self::Repeat => x - portable::floor_f64(x),
            Self::Mirror => x - 2.0 * portable::floor_f64(x * 0.5),
            Self::Clamp | Self::Black => x.clamp(-4.0, 4.0),
        }
    }

    /// Texel of a row of `size` at index `i`, less than five rows away; `None` beyond the border of
    /// [`Wrap::Black`].
    fn texel(self, i: i64, size: u32) -> Option<u32> {
        let (size, last) = (i64::from(size), i64::from(size) - 1);
        let found = match self {
            Self::Repeat => i.rem_euclid(size),
            Self::Mirror => {
                let at = i.rem_euclid(2 * size);
                at.min(2 * size - 1 - at)
            }
            Self::Clamp => i.clamp(0, last),
            Self::Black if i < 0 || i > last => return None,
            Self::Black => i,
        };
        u32::try_from(found).ok()
    }

    /// [`Wrap::texel`] at index `i` and the next one.
    #[inline]
    fn neighbors(self, i: i64, size: u32) -> [Option<u32>; 2] {
        match u32::try_from(i) {
            // Most footprints lie inside of the image.
            Ok(first) if first < size.saturating_sub(1) => [Some(first), Some(first + 1)],
            _ => [self.texel(i, size), self.texel(i + 1, size)],
        }
    }
}

impl MipMap {
    /// Filtered texel at (x, y), from (0, 0) at the top left to (1, 1) at the bottom right. `width`
    /// is the diameter of the footprint in the same units.
    pub fn sample(&self, [x, y]: [f32; 2], width: f32, wrap: [Wrap; 2], filter: Filter) -> Texel {
        let at = [wrap[0].reduce_coordinate(x), wrap[1].reduce_coordinate(y)];
        if filter == Filter::Nearest {
            return self.at(0, at, wrap);
        }
        let [wide, high] = self.size(0);
        let texels = width * wide.max(high) as f32;
        if filter == Filter::Bilinear || texels.is_nan() || texels <= 1.0 {
            return self.bilinear(0, at, wrap);
        }
        // Choose the level whose texels are as wide as the footprint.
        let level = portable::log2(texels.min(1e9));
        let last = self.levels() - 1;
        let lower = (level as usize).min(last);
        let share = if lower == last { 0.0 } else { level - lower as f32 };
        let fine = self.bilinear(lower, at, wrap);
        if share <= 0.0 {
            return fine;
        }
        let coarse = self.bilinear(lower + 1, at, wrap);
        std::array::from_fn(|i| fine[i] + (coarse[i] - fine[i]) * share)
    }

    /// Texel that contains a point.
    fn at(&self, level: usize, at: [f64; 2], wrap: [Wrap; 2]) -> Texel {
        let size = self.size(level);
        let index =
            |axis: usize| wrap[axis].texel(portable::floor_f64(at[axis] * f64::from(size[axis])) as i64, size[axis]);
        match (index(0), index(1)) {
            (Some(x), Some(y)) => self.texel(level, x, y),
            _ => [0.0; 4],
        }
    }

    /// Bilinear interpolation of the four texels nearest to a point.
    fn bilinear(&self, level: usize, at: [f64; 2], wrap: [Wrap; 2]) -> Texel {
        let size = self.size(level);
        let neighbors = |axis: usize| {
            let x = at[axis] * f64::from(size[axis]) - 0.5;
            let floor = portable::floor_f64(x);
            (wrap[axis].neighbors(floor as i64, size[axis]), (x - floor) as f32)
        };
        let ((columns, across), (rows, down)) = (neighbors(0), neighbors(1));
        let [a, b, c, d] = match (columns, rows) {
            ([Some(left), Some(right)], [Some(top), Some(bottom)]) => self.quad(level, [left, right], [top, bottom]),
            ([left, right], [top, bottom]) => {
                [(left, top), (right, top), (left, bottom), (right, bottom)].map(|texel| match texel {
                    (Some(x), Some(y)) => self.texel(level, x, y),
                    _ => [0.0; 4],
                })
            }
        };
        std::array::from_fn(|i| {
            let upper = a[i] * (1.0 - across) + b[i] * across;
            let lower = c[i] * (1.0 - across) + d[i] * across;
            upper * (1.0 - down) + lower * down
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    const ALL: [Wrap; 4] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Black];

    fn random_picture(width: u32, height: u32, random: &mut Random) -> MipMap {
        let numbers = (0..width * height * 3).map(|_| random.f32()).collect();
        MipMap::from_floats([width, height], 3, numbers).unwrap()
    }

    /// Texel of an image that is continued to an infinite plane.
    fn endless(picture: &MipMap, x: i64, y: i64, wrap: [Wrap; 2]) -> Texel {
        let [width, height] = picture.size(0).map(i64::from);
        let turn = |i: i64, size: i64, wrap: Wrap| match wrap {
            Wrap::Repeat => Some(i - size * i.div_euclid(size)),
            Wrap::Mirror if i.div_euclid(size) % 2 == 0 => Some(i.rem_euclid(size)),
            Wrap::Mirror => Some(size - 1 - i.rem_euclid(size)),
            Wrap::Clamp => Some(i.max(0).min(size - 1)),
            Wrap::Black => (0..size).contains(&i).then_some(i),
        };
        match (turn(x, width, wrap[0]), turn(y, height, wrap[1])) {
            (Some(x), Some(y)) => picture.texel(0, x as u32, y as u32),
            _ => [0.0; 4],
        }
    }

    #[test]
    fn bilinear_and_nearest_filters_match_the_reference() {
        let mut random = Random::new(740);
        let picture = random_picture(5, 3, &mut random);
        for _ in 0..3000 {
            let wrap = [ALL[random.below(4)], ALL[random.below(4)]];
            let (x, y) = (random.range(-3.5, 3.5), random.range(-3.5, 3.5));
            let (column, row) = (f64::from(x) * 5.0, f64::from(y) * 3.0);
            let nearest = endless(&picture, column.floor() as i64, row.floor() as i64, wrap);
            assert_eq!(picture.sample([x, y], 0.0, wrap, Filter::Nearest), nearest, "{x} {y} {wrap:?}");
            let (left, top) = ((column - 0.5).floor(), (row - 0.5).floor());
            let mut mixed = [0.0; 4];
            for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let texel = endless(&picture, left as i64 + i, top as i64 + j, wrap);
                let weight =
                    (1.0 - (column - 0.5 - left - i as f64).abs()) * (1.0 - (row - 0.5 - top - j as f64).abs());
                (0..4).for_each(|k| mixed[k] += f64::from(texel[k]) * weight);
            }
            for filter in [Filter::Bilinear, Filter::Trilinear] {
                let found = picture.sample([x, y], 0.0, wrap, filter);
                assert!(
                    (0..4).all(|k| (f64::from(found[k]) - mixed[k]).abs() < 1e-5),
                    "{x} {y} {wrap:?}: {found:?} {mixed:?}"
                );
            }
        }
    }

    #[test]
    fn huge_coordinates_and_footprints_give_finite_colors() {
        let picture = random_picture(7, 4, &mut Random::new(741));
        for far in [1e6, -1e9, 1e30, f32::MAX, f32::MIN, f32::INFINITY, f32::NAN] {
            for (wrap, filter) in
                ALL.into_iter().zip([Filter::Nearest, Filter::Bilinear, Filter::Trilinear, Filter::Trilinear])
            {
                for width in [0.0, 1e30, f32::INFINITY, f32::NAN] {
                    let texel = picture.sample([far, -far], width, [wrap; 2], filter);
                    assert!(texel.iter().all(|v| (0.0..=1.0).contains(v)), "{far} {wrap:?}: {texel:?}");
                }
            }
        }
        assert_eq!(picture.sample([1e9, 0.5], 0.0, [Wrap::Black; 2], Filter::Bilinear), [0.0; 4]);
        assert_eq!(picture.sample([-1e9, 0.125], 0.0, [Wrap::Clamp; 2], Filter::Nearest), picture.texel(0, 0, 0));
    }

    /// Stripes of one texel along the longer edge: the level whose texels are as wide as two of them
    /// is gray.
    #[test]
    fn longer_edge_determines_the_mip_level() {
        let stripes: Vec<f32> = (0..64 * 2).map(|i| (i % 2) as f32).collect();
        let wide = MipMap::from_floats([64, 2], 1, stripes).unwrap();
        let high = MipMap::from_floats([2, 64], 1, (0..64 * 2).map(|i| (i / 2 % 2) as f32).collect()).unwrap();
        for (picture, along) in [(&wide, 0), (&high, 1)] {
            for (texels, contrast) in [(1.0, 1.0), (2.0, 0.0), (5.0, 0.0)] {
                let at = |texel: f32| if along == 0 { [texel / 64.0, 0.25] } else { [0.25, texel / 64.0] };
                let values = [10.5, 11.5]
                    .map(|texel| picture.sample(at(texel), texels / 64.0, [Wrap::Repeat; 2], Filter::Trilinear)[0]);
                assert_eq!(values[1] - values[0], contrast, "axis {along}, {texels} texels: {values:?}");
            }
        }
    }

    #[test]
    fn wide_footprints_see_the_mean() {
        let mut random = Random::new(742);
        let picture = random_picture(64, 64, &mut random);
        let mean = picture.texel(6, 0, 0);
        let sample = |x: f32, width: f32| picture.sample([x, 0.4], width, [Wrap::Repeat; 2], Filter::Trilinear);
        assert_eq!((sample(0.3, 1.0), sample(0.9, 100.0)), (mean, mean));
        // In between, the variance falls as the footprint grows.
        let spread = |width: f32| {
            let values: Vec<f32> = (0..500).map(|i| sample(i as f32 * 0.002, width)[0]).collect();
            let mean = values.iter().sum::<f32>() / 500.0;
            values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 500.0
        };
        let spreads = [0.0, 0.02, 0.05, 0.1, 0.3].map(spread);
        assert!(spreads.windows(2).all(|pair| pair[1] < 0.8 * pair[0]), "{spreads:?}");
        // Neighboring levels blend without a jump.
        for i in 1..2000 {
            let (a, b) = (sample(0.31, i as f32 * 0.0005), sample(0.31, (i + 1) as f32 * 0.0005));
            assert!((a[0] - b[0]).abs() < 0.03, "{i}");
        }
    }
}
