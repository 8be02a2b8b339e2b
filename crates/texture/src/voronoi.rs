//! Cells about scattered points: stones, scales, cracked ground (Worley, A Cellular Texture Basis Function, 1996, with
//! one point a cell of the lattice).
//!
//! ```json
//! {"voronoi": {"space": "local", "scale": 5, "feature": "f2_minus_f1", "low": 0, "high": "#c0b090"}}
//! ```
//!
//! Over (u, v) the points lie in the plane, otherwise in space.

use super::CompiledTexture;
use super::compiled::Pair;
use super::lattice::{cell, hash, kept, numbers};
use super::mapping::Map;
use super::{
    Compiled, Input, InvalidTexture, Lookup, Mapping, Resolver, Space, Texture, TextureError, TextureTable, check,
};
use juggler_math::hash::combine;
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Cells about scattered points, one a unit of the pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Voronoi {
    /// Colour where the feature is 0.
    pub low: Input<Rgb>,
    /// Colour where the feature is 1 or more.
    pub high: Input<Rgb>,
    /// What is measured.
    pub feature: Feature,
    /// How distances are measured.
    pub metric: Metric,
    /// How far points are scattered: at 0 they form a grid.
    #[schemars(range(min = 0, max = 1))]
    pub jitter: f32,
    /// Another number, other points.
    pub seed: u32,
    /// Where the pattern lies.
    #[serde(flatten)]
    pub mapping: Mapping,
}

/// What is measured of the points about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Feature {
    /// Distance to the nearest.
    #[default]
    F1,
    /// Distance to the second nearest.
    F2,
    /// How much farther the second nearest is: 0 along the borders of cells.
    F2MinusF1,
    /// A colour for each cell, between `low` and `high` in each channel by itself.
    Cell,
}

/// How distances are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// As the crow flies.
    #[default]
    Euclidean,
    /// Along the axes, all ways added up.
    Manhattan,
    /// The longest way along an axis.
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

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        let colors = Pair { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        let flat = self.mapping.space_or(Space::Local) == Space::Uv;
        let points = Points { metric: self.metric, jitter: self.jitter, seed: self.seed, flat };
        let (feature, map) = (self.feature, self.mapping.compile(Space::Local));
        // Any 512 places will do for the mean.
        let share = |i| points.near(numbers(combine(9, i)) * 64.0).feature(feature);
        let mean = (0..512).map(share).sum::<f32>() / 512.0;
        Ok(Arc::new(CompiledVoronoi { colors, feature, points, mean, map }))
    }
}

/// Where the points lie.
#[derive(Clone, Copy, Debug)]
struct Points {
    metric: Metric,
    jitter: f32,
    seed: u32,
    /// Whether they lie in the plane z = 0.
    flat: bool,
}

/// The two nearest points.
#[derive(Clone, Copy, Debug)]
struct Near {
    first: f32,
    second: f32,
    /// Belongs to the first.
    hash: u32,
}

impl Near {
    /// A number from 0 to 1.
    fn feature(self, feature: Feature) -> f32 {
        match feature {
            Feature::F1 => self.first.min(1.0),
            Feature::F2 => self.second.min(1.0),
            Feature::F2MinusF1 => (self.second - self.first).min(1.0),
            Feature::Cell => 0.5,
        }
    }
}

impl Points {
    fn near(&self, p: Vec3) -> Near {
        let (cell, at) = cell(if self.flat { p.with_z(0.0) } else { p });
        let mut near = Near { first: f32::MAX, second: f32::MAX, hash: 0 };
        let edge = at.min(1.0 - at);
        let edge = if self.flat { edge.x.min(edge.y) } else { edge.min_element() };
        for ring in 0..=4_i64 {
            // What lies in this ring is at least as far away as its inner border.
            if ring > 0 && near.second <= ring as f32 - 1.0 + edge {
                break;
            }
            let depth = if self.flat { 0..=0 } else { -ring..=ring };
            for (z, y) in depth.flat_map(|z| (-ring..=ring).map(move |y| (z, y))) {
                let inside = z.abs() < ring && y.abs() < ring;
                let step = if inside { 2 * ring } else { 1 };
                for x in (-ring..=ring).step_by(step.max(1) as usize) {
                    self.visit(cell, [x, y, z], at, &mut near);
                }
            }
        }
        near
    }

    fn visit(&self, cell: [i64; 3], [x, y, z]: [i64; 3], at: Vec3, near: &mut Near) {
        let [i, j, k] = cell;
        let hash = hash([i.wrapping_add(x), j.wrapping_add(y), k.wrapping_add(z)], self.seed);
        let point = Vec3::new(x as f32, y as f32, z as f32) + 0.5 + (numbers(hash) - 0.5) * self.jitter;
        let way = (point - at).abs();
        let way = if self.flat { way.with_z(0.0) } else { way };
        let distance = match self.metric {
            Metric::Euclidean => way.length(),
            Metric::Manhattan => way.element_sum(),
            Metric::Chebyshev => way.max_element(),
        };
        if distance < near.first {
            *near = Near { first: distance, second: near.first, hash };
        } else if distance < near.second {
            near.second = distance;
        }
    }
}

/// A [`Voronoi`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledVoronoi {
    colors: Pair,
    feature: Feature,
    points: Points,
    mean: f32,
    map: Map,
}

impl CompiledTexture for CompiledVoronoi {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        let place = self.map.place(at);
        let kept = kept(place.width);
        if kept <= 0.0 {
            return self.colors.at(self.mean, textures, at);
        }
        let near = self.points.near(place.point);
        if self.feature == Feature::Cell {
            let shares = (numbers(combine(near.hash, 3)) - 0.5) * kept + 0.5;
            let (low, high) = (textures.color(&self.colors.low, at), textures.color(&self.colors.high, at));
            return low + (high - low) * Rgb::from(shares.to_array());
        }
        self.colors.at(self.mean + (near.feature(self.feature) - self.mean) * kept, textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Voronoi {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let features = [Feature::F1, Feature::F2, Feature::F2MinusF1, Feature::Cell];
        let metrics = [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev, Metric::Euclidean];
        let spaces = [Space::Uv, Space::Local, Space::World, Space::World];
        let mapping = spaces.map(Mapping::of);
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

    /// By looking at all points far around.
    fn brute_force(points: &Points, p: Vec3) -> Near {
        let (cell, at) = cell(if points.flat { p.with_z(0.0) } else { p });
        let mut near = Near { first: f32::MAX, second: f32::MAX, hash: 0 };
        let depth = if points.flat { 0 } else { 4 };
        for z in -depth..=depth {
            for y in -4..=4 {
                for x in -4..=4 {
                    points.visit(cell, [x, y, z], at, &mut near);
                }
            }
        }
        near
    }

    #[test]
    fn the_nearest_two_are_those_of_a_brute_force() {
        let mut random = Random::new(720);
        for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
            for flat in [false, true] {
                let points = Points { metric, jitter: 1.0, seed: 4, flat };
                for _ in 0..400 {
                    let p = random.point(1e3);
                    let (fast, slow) = (points.near(p), brute_force(&points, p));
                    assert_eq!((fast.first, fast.second, fast.hash), (slow.first, slow.second, slow.hash));
                    assert!(fast.first <= fast.second);
                }
            }
        }
    }

    #[test]
    fn distances_are_continuous_and_a_grid_is_a_grid() {
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
    fn cells_are_of_one_colour_each() {
        let read = reader(r#"{"voronoi": {"space": "world", "feature": "cell"}}"#);
        let points = Points { metric: Metric::Euclidean, jitter: 1.0, seed: 0, flat: false };
        let mut random = Random::new(721);
        let mut colors = Vec::new();
        for _ in 0..300 {
            let world = random.point(3.0);
            let color = read(&Lookup { world, ..Lookup::default() });
            assert!(color.to_array().iter().all(|v| (0.0..=1.0).contains(v)));
            colors.push((points.near(world).hash, color));
        }
        colors.sort_by_key(|(hash, _)| *hash);
        assert!(colors.windows(2).all(|pair| (pair[0].0 == pair[1].0) == (pair[0].1 == pair[1].1)));
        assert!(colors.windows(2).any(|pair| pair[0].0 == pair[1].0));
    }

    #[test]
    fn says_what_is_wrong() {
        let wrong: Voronoi = serde_json::from_str(r#"{"jitter": 1.5}"#).unwrap();
        assert_eq!(wrong.check().unwrap_err().field, "jitter");
    }
}
