//! Samplers: where in the film, the lens, a light a sample goes.
//!
//! A number is a pure function of (seed, pixel, sample index, branch, dimension). Nothing is stored between
//! samples, so any thread, tile, shard or resumed run draws the same numbers.

use juggler_math::{UVec2, Vec2, hash};

mod independent;
mod sobol;
mod stratified;

/// A way to spread samples, as the scene describes it.
pub trait Spread: Send + Sync {
    /// The pattern for pictures of `samples` samples a pixel.
    fn pattern(&self, samples: u32) -> Pattern;
}

closed_set! {
    /// Every sampler. In JSON: `{"sobol": {}}`, or short `"sobol"`.
    pub enum AnySampler: Spread { sobol::Sobol, stratified::Stratified, independent::Independent }
}

impl Default for AnySampler {
    fn default() -> Self {
        Sobol::default().into()
    }
}

/// How the samples of one pixel and dimension are spread, ready to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Hashes without any structure.
    Independent,
    /// Owen-scrambled Sobol points.
    Sobol,
    /// One point in each cell of a `side` × `side` grid, grid after grid.
    Stratified {
        /// Cells along an edge, at least 1.
        side: u32,
    },
}

/// The stream of numbers of one sample of one pixel. Copy it freely: it holds an address, not a state
/// worth saving.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    seed: u32,
    index: u32,
    dimension: u32,
    pattern: Pattern,
}

impl Sampler {
    /// Of a whole picture; its pixels have [streams of their own](Self::pixel).
    pub fn new(pattern: Pattern, seed: u64) -> Self {
        Self { seed: hash::combine(seed as u32, (seed >> 32) as u32), index: 0, dimension: 0, pattern }
    }

    /// The numbers of sample 0 of a pixel of this picture.
    #[inline]
    pub fn pixel(&self, pixel: UVec2) -> Self {
        Self { seed: hash::combine(hash::combine(self.seed, pixel.x), pixel.y), ..*self }
    }

    /// The numbers of sample `index` of the same pixel, from the first dimension on.
    pub fn sample(&self, index: u32) -> Self {
        Self { index, dimension: 0, ..*self }
    }

    /// The numbers of the `child`-th ray that leaves a vertex: a stream of its own.
    pub fn branch(&self, child: u32) -> Self {
        Self { seed: hash::combine(self.seed, child.wrapping_add(1)), dimension: 0, ..*self }
    }

    /// The `part`-th of `parts` streams that together sample one thing well (the rays of a soft shadow).
    pub fn part(&self, part: u32, parts: u32) -> Self {
        Self { index: self.index.wrapping_mul(parts).wrapping_add(part), ..*self }
    }

    /// The next number in [0, 1).
    pub fn next_1d(&mut self) -> f32 {
        self.next_2d().x
    }

    /// The next point in [0, 1)².
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        let seed = self.seed ^ hash::mix(self.dimension.wrapping_mul(0x9e37_79b9));
        self.dimension += 1;
        match self.pattern {
            Pattern::Sobol => sobol::point(self.index, seed),
            Pattern::Stratified { side } => stratified::point(self.index, self.dimension == 1, seed, side),
            Pattern::Independent => independent::point(self.index, seed),
        }
    }

    /// What [`Sampler::next_2d`] gives first for the samples from `first` on of this pixel: their places on
    /// the film.
    pub fn first_points(&self, first: u32, points: &mut [Vec2]) {
        let seed = self.seed ^ hash::mix(0);
        match self.pattern {
            Pattern::Sobol => fill(points, first, |index| sobol::point(index, seed)),
            Pattern::Stratified { side } => stratified::points_in_order(first, seed, side, points),
            Pattern::Independent => fill(points, first, |index| independent::point(index, seed)),
        }
    }

    /// The numbers from `count` dimensions further on.
    #[inline]
    #[must_use]
    pub fn at(&self, count: u32) -> Self {
        Self { dimension: self.dimension + count, ..*self }
    }

    /// Leaves out `count` dimensions.
    pub fn skip(&mut self, count: u32) {
        self.dimension += count;
    }
}

fn fill(points: &mut [Vec2], first: u32, point: impl Fn(u32) -> Vec2) {
    for (i, place) in points.iter_mut().enumerate() {
        *place = point(first.wrapping_add(i as u32));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(pattern: Pattern, count: u32) -> Vec<Vec2> {
        let pixel = Sampler::new(pattern, 7).pixel(UVec2::new(3, 5));
        (0..count)
            .map(|i| {
                let mut sampler = pixel.sample(i);
                sampler.skip(3);
                sampler.next_2d()
            })
            .collect()
    }

    fn cells(points: &[Vec2], x: u32, y: u32) -> Vec<u32> {
        let mut counts = vec![0; (x * y) as usize];
        for p in points {
            counts[((p.x * x as f32) as u32 * y + (p.y * y as f32) as u32) as usize] += 1;
        }
        counts
    }

    #[test]
    fn sobol_fills_every_elementary_interval_once() {
        let points = points(Pattern::Sobol, 256);
        for bits in 0..=8 {
            let counts = cells(&points, 1 << bits, 1 << (8 - bits));
            assert!(counts.iter().all(|c| *c == 1), "2^{bits} columns");
        }
    }

    #[test]
    fn stratified_fills_every_cell_once_a_set() {
        for side in [1, 3, 8] {
            let pixel = Sampler::new(Pattern::Stratified { side }, 1).pixel(UVec2::new(9, 9));
            for dimension in 0..3 {
                let draw = |i: u32| {
                    let mut sampler = pixel.sample(i);
                    sampler.skip(dimension);
                    sampler.next_2d()
                };
                let set: Vec<Vec2> = (side * side..2 * side * side).map(draw).collect();
                assert!(cells(&set, side, side).iter().all(|c| *c == 1), "side {side}, dimension {dimension}");
            }
        }
    }

    #[test]
    fn points_in_a_row_are_the_points_one_by_one() {
        for pattern in [Pattern::Independent, Pattern::Sobol, Pattern::Stratified { side: 5 }] {
            let pixel = Sampler::new(pattern, 5).pixel(UVec2::new(8, 1));
            for first in [0, 3, 24, 70] {
                let mut points = [Vec2::ZERO; 60];
                pixel.first_points(first, &mut points);
                let expected: Vec<Vec2> = (first..first + 60).map(|i| pixel.sample(i).next_2d()).collect();
                assert_eq!(points.to_vec(), expected, "{pattern:?} from {first}");
            }
        }
    }

    #[test]
    fn streams_are_uniform_and_unlike_each_other() {
        for pattern in [Pattern::Independent, Pattern::Sobol, Pattern::Stratified { side: 8 }] {
            let all: Vec<Vec2> = (0..64)
                .flat_map(|x| {
                    let pixel = Sampler::new(pattern, 3).pixel(UVec2::new(x, 1));
                    (0..64).map(move |i| pixel.sample(i).branch(2).next_2d())
                })
                .collect();
            assert!(all.iter().all(|p| p.cmpge(Vec2::ZERO).all() && p.cmplt(Vec2::ONE).all()));
            let counts = cells(&all, 8, 8);
            let chi: f32 = counts.iter().map(|c| (*c as f32 - 64.0).powi(2) / 64.0).sum();
            assert!(chi < 110.0, "{pattern:?}: chi squared {chi} for 63 degrees of freedom");
            let mean: Vec2 = all.iter().sum::<Vec2>() / all.len() as f32;
            let covariance: f32 = all.iter().map(|p| (p.x - mean.x) * (p.y - mean.y)).sum::<f32>() / all.len() as f32;
            assert!(covariance.abs() < 0.004, "{pattern:?}: covariance {covariance}");
        }
    }

    #[test]
    fn a_sample_depends_on_its_address_alone() {
        let pixel = Sampler::new(Pattern::Sobol, 11).pixel(UVec2::new(4, 2));
        let mut first = pixel.sample(5);
        first.next_2d();
        let second = first.next_2d();
        let mut again = pixel.sample(5);
        again.skip(1);
        assert_eq!(again.next_2d(), second);
        assert_ne!(pixel.sample(6).next_2d(), pixel.sample(5).next_2d());
        assert_ne!(pixel.sample(5).branch(0).next_2d(), pixel.sample(5).branch(1).next_2d());
        assert_ne!(
            Sampler::new(Pattern::Sobol, 1 << 32).pixel(UVec2::ZERO),
            Sampler::new(Pattern::Sobol, 0).pixel(UVec2::ZERO)
        );
    }
}
