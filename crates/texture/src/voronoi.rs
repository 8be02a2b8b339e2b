//! Cellular noise: distances to scattered feature points, for stones, scales and cracked ground
//! (Worley, A Cellular Texture Basis Function, 1996, with one point per lattice cell).
//!
//! ```json
//! {"voronoi": {"space": "local", "scale": 5, "feature": "f2_minus_f1",
//! "low": 0, "high": "#c0b090"}}
//! ```
//!
//! Over (u, v) the feature points lie in the plane, otherwise in space.

use super::CompiledTexture;
use super::compiled::ColorBlend;
use super::lattice::{cell, filter_amplitude, hash, unit_cube_point};
use super::mapping::CompiledMapping;
use super::{
    Input, InvalidTexture, Mapping, SharedTexture, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::hash::combine;
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Cellular noise around scattered feature points, one per unit cell of the pattern. Use it for
/// stones, scales and cracked ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Voronoi {
    /// Color where the feature is 0.
    pub low: Input<Rgb>,
    /// Color where the feature is 1 or more.
    pub high: Input<Rgb>,
    /// Feature that chooses the color.
    pub feature: Feature,
    /// Metric of distances to the feature points.
    pub metric: Metric,
    /// Random offset of the feature points in their cells: 0 forms a grid, 1 scatters them over
    /// whole cells.
    #[schemars(range(min = 0, max = 1))]
    pub jitter: f32,
    /// Seed of the feature points and cell colors.
    pub seed: u32,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Voronoi {
    /// Creates a Voronoi pattern between two colors.
    pub fn new(low: impl Into<Input<Rgb>>, high: impl Into<Input<Rgb>>) -> Self {
        Self { low: low.into(), high: high.into(), ..Self::default() }
    }
}

/// Feature of cellular noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Feature {
    /// F1: distance to the nearest feature point.
    #[default]
    F1,
    /// F2: distance to the second nearest feature point.
    F2,
    /// F2 - F1, which is 0 along the borders of cells.
    F2MinusF1,
    /// Random color per cell, between `low` and `high` in each channel independently.
    Cell,
}

/// Metric of distances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Metric {
    /// Euclidean distance.
    #[default]
    Euclidean,
    /// Sum of the distances along the axes.
    Manhattan,
    /// Largest of the distances along the axes.
    Chebyshev,
}

impl Default for Voronoi {
    fn default() -> Self {
        Self {
            low: Rgb::BLACK.into(),
            high: Rgb::WHITE.into(),
            feature: Feature::F1,
            metric: Metric::Euclidean,
            jitter: 1.0,
            seed: 0,
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Voronoi {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        check::in_range("jitter", self.jitter, 0.0, 1.0)?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let colors = ColorBlend { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        let flat = self.mapping.space_or(Space::Local) == Space::Uv;
        let points = FeaturePoints { metric: self.metric, jitter: self.jitter, seed: self.seed, flat };
        let (feature, map) = (self.feature, self.mapping.compile(Space::Local));
        // Estimate the mean from 512 points.
        let share = |i| points.nearest(unit_cube_point(combine(9, i)) * 64.0).feature(feature);
        let mean = (0..512).map(share).sum::<f32>() / 512.0;
        Ok(Arc::new(CompiledVoronoi { colors, feature, points, mean, map }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Local))
    }
}

/// Scattered feature points.
#[derive(Clone, Copy, Debug)]
struct FeaturePoints {
    metric: Metric,
    jitter: f32,
    seed: u32,
    /// Whether the points lie in the plane z = 0.
    flat: bool,
}

/// Distances to the two nearest feature points.
#[derive(Clone, Copy, Debug)]
struct NearestPoints {
    first: f32,
    second: f32,
    /// Hash of the nearest point's cell.
    hash: u32,
}

impl NearestPoints {
    /// Value of a feature, 0 to 1.
    fn feature(self, feature: Feature) -> f32 {
        match feature {
            Feature::F1 => self.first.min(1.0),
            Feature::F2 => self.second.min(1.0),
            Feature::F2MinusF1 => (self.second - self.first).min(1.0),
            Feature::Cell => 0.5,
        }
    }
}

impl FeaturePoints {
    fn nearest(&self, p: Vec3) -> NearestPoints {
        let (cell, at) = cell(if self.flat { p.with_z(0.0) } else { p });
        let mut nearest = NearestPoints { first: f32::MAX, second: f32::MAX, hash: 0 };
        let edge = at.min(1.0 - at);
        let edge = if self.flat { edge.x.min(edge.y) } else { edge.min_element() };
        for ring in 0..=4_i64 {
            // Stop once this ring of cells is farther away than the second nearest point.
            if ring > 0 && nearest.second <= ring as f32 - 1.0 + edge {
                break;
            }
            let depth = if self.flat { 0..=0 } else { -ring..=ring };
            for (z, y) in depth.flat_map(|z| (-ring..=ring).map(move |y| (z, y))) {
                let inside = z.abs() < ring && y.abs() < ring;
                let step = if inside { 2 * ring } else { 1 };
                for x in (-ring..=ring).step_by(step.max(1) as usize) {
                    self.visit(cell, [x, y, z], at, &mut nearest);
                }
            }
        }
        nearest
    }

    fn visit(&self, cell: [i64; 3], [x, y, z]: [i64; 3], at: Vec3, nearest: &mut NearestPoints) {
        let [i, j, k] = cell;
        let hash = hash([i.wrapping_add(x), j.wrapping_add(y), k.wrapping_add(z)], self.seed);
        let point = Vec3::new(x as f32, y as f32, z as f32) + 0.5 + (unit_cube_point(hash) - 0.5) * self.jitter;
        let offset = (point - at).abs();
        let offset = if self.flat { offset.with_z(0.0) } else { offset };
        let distance = match self.metric {
            Metric::Euclidean => offset.length(),
            Metric::Manhattan => offset.element_sum(),
            Metric::Chebyshev => offset.max_element(),
        };
        if distance < nearest.first {
            *nearest = NearestPoints { first: distance, second: nearest.first, hash };
        } else if distance < nearest.second {
            nearest.second = distance;
        }
    }
}

/// A [`Voronoi`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledVoronoi {
    colors: ColorBlend,
    feature: Feature,
    points: FeaturePoints,
    mean: f32,
    map: CompiledMapping,
}

impl CompiledTexture for CompiledVoronoi {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.pattern_point(at);
        let filter = filter_amplitude(pattern.width);
        if filter <= 0.0 {
            return self.colors.eval(self.mean, textures, at);
        }
        let nearest = self.points.nearest(pattern.point);
        if self.feature == Feature::Cell {
            let shares = (unit_cube_point(combine(nearest.hash, 3)) - 0.5) * filter + 0.5;
            let (low, high) = (textures.color(&self.colors.low, at), textures.color(&self.colors.high, at));
            return low + (high - low) * Rgb::from(shares.to_array());
        }
        self.colors.eval(self.mean + (nearest.feature(self.feature) - self.mean) * filter, textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Voronoi {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let features = [Feature::F1, Feature::F2, Feature::F2MinusF1, Feature::Cell];
        let metrics = [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev, Metric::Euclidean];
        let spaces = [Space::Uv, Space::Local, Space::World, Space::World];
        let mapping = spaces.map(Mapping::in_space);
        let high = || Rgb::new(0.5, 0.25, 0.75).into();
        let example = |i: usize| Self {
            feature: features[i],
            metric: metrics[i],
            mapping: mapping[i],
            high: high(),
            ..Self::default()
        };
        (0..4).map(example).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers as read_numbers, reader};
    use juggler_math::testing::Random;

    /// Reference: visits all cells of a large neighborhood.
    fn brute_force(points: &FeaturePoints, p: Vec3) -> NearestPoints {
        let (cell, at) = cell(if points.flat { p.with_z(0.0) } else { p });
        let mut nearest = NearestPoints { first: f32::MAX, second: f32::MAX, hash: 0 };
        let depth = if points.flat { 0 } else { 4 };
        for z in -depth..=depth {
            for y in -4..=4 {
                for x in -4..=4 {
                    points.visit(cell, [x, y, z], at, &mut nearest);
                }
            }
        }
        nearest
    }

    #[test]
    fn two_nearest_feature_points_equal_brute_force() {
        let mut random = Random::new(720);
        for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
            for flat in [false, true] {
                let points = FeaturePoints { metric, jitter: 1.0, seed: 4, flat };
                for _ in 0..400 {
                    let p = random.point(1e3);
                    let (fast, slow) = (points.nearest(p), brute_force(&points, p));
                    assert_eq!((fast.first, fast.second, fast.hash), (slow.first, slow.second, slow.hash));
                    assert!(fast.first <= fast.second);
                }
            }
        }
    }

    #[test]
    fn voronoi_distances_are_continuous_and_without_jitter_a_grid() {
        let read = read_numbers(r#"{"voronoi": {"space": "world", "feature": "f1"}}"#);
        for i in 0..4000 {
            let p = Vec3::new(i as f32 * 0.01, i as f32 * 0.003, 0.2);
            let step = Vec3::new(0.001, 0.0003, 0.0);
            assert!((read(p + step, 0.0) - read(p, 0.0)).abs() <= step.length() * 1.01 + 1e-6, "{p}");
        }
        let grid = read_numbers(r#"{"voronoi": {"space": "world", "jitter": 0}}"#);
        for (p, distance) in
            [(Vec3::splat(0.5), 0.0), (Vec3::new(3.0, -1.5, 8.5), 0.5), (Vec3::new(0.5, 0.7, 1.5), 0.2)]
        {
            assert!((grid(p, 0.0) - distance).abs() < 1e-6, "{p}");
        }
        for feature in ["f1", "f2", "f2_minus_f1", "cell"] {
            keeps_its_mean(&format!(r#"{{"voronoi": {{"space": "world", "feature": "{feature}"}}}}"#), 0.03);
        }
    }

    #[test]
    fn cells_are_of_one_color_each() {
        let read = reader(r#"{"voronoi": {"space": "world", "feature": "cell"}}"#);
        let points = FeaturePoints { metric: Metric::Euclidean, jitter: 1.0, seed: 0, flat: false };
        let mut random = Random::new(721);
        let mut colors = Vec::new();
        for _ in 0..300 {
            let world = random.point(3.0);
            let color = read(&TextureLookup { world, ..TextureLookup::default() });
            assert!(color.to_array().iter().all(|v| (0.0..=1.0).contains(v)));
            colors.push((points.nearest(world).hash, color));
        }
        colors.sort_by_key(|(hash, _)| *hash);
        assert!(colors.windows(2).all(|pair| (pair[0].0 == pair[1].0) == (pair[0].1 == pair[1].1)));
        assert!(colors.windows(2).any(|pair| pair[0].0 == pair[1].0));
    }

    #[test]
    fn invalid_fields_are_named() {
        let wrong: Voronoi = serde_json::from_str(r#"{"jitter": 1.5}"#).unwrap();
        assert_eq!(wrong.check().unwrap_err().field, "jitter");
    }
}
