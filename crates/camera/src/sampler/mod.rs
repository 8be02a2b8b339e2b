//! Samplers: where in the film, the lens, a light a sample goes.
//!
//! A number is a pure function of (seed, pixel, sample index, branch, dimension). Nothing is stored between
//! samples, so any thread, tile, shard or resumed run draws the same numbers.

use juggler_math::{UVec2, Vec2, hash};

mod blue_noise;
mod independent;
mod sobol;
mod stratified;

/// A way to spread samples, as the scene describes it.
pub trait Spread: Send + Sync {
    /// The pattern for pictures of `samples` samples a pixel.
    fn pattern(&self, samples: u32) -> Pattern;
}

juggler_math::closed_set! {
    /// Every sampler. In JSON: `{"sobol": {}}`, or short `"sobol"`.
    pub enum AnySampler: Spread {
        sobol::Sobol => SobolPoints,
        stratified::Stratified => StratifiedPoints,
        independent::Independent => IndependentPoints,
        blue_noise::BlueNoise => BlueNoisePoints,
    }
    /// Pattern of the samples of one pixel and dimension, ready to draw.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Pattern: static PointSet;
    fn pixel_seed(&self, seed: u32, pixel: UVec2) -> u32;
    fn at_pixel(&self, pixel: UVec2) -> Pattern;
    fn first_coordinate(&self, index: u32, is_first: bool, seed: u32) -> f32;
    fn point(&self, index: u32, is_first: bool, seed: u32) -> Vec2;
    fn fill(&self, first: u32, seed: u32, points: &mut [Vec2]);
}

/// Points in [0, 1)² for the samples of a pixel, a set a dimension: pure functions.
pub trait PointSet: Copy + Into<Pattern> {
    /// Seed of a pixel in a picture of this `seed`.
    #[inline]
    fn pixel_seed(&self, seed: u32, pixel: UVec2) -> u32 {
        hash::combine(hash::combine(seed, pixel.x), pixel.y)
    }

    /// Pattern of a pixel.
    #[inline]
    fn at_pixel(&self, _pixel: UVec2) -> Pattern {
        (*self).into()
    }

    /// Point of sample `index` in the dimension `seed`; `is_first` for the place on the film.
    fn point(&self, index: u32, is_first: bool, seed: u32) -> Vec2;

    /// x of [`point`](Self::point).
    #[inline]
    fn first_coordinate(&self, index: u32, is_first: bool, seed: u32) -> f32 {
        self.point(index, is_first, seed).x
    }

    /// Points of the samples from `first` on, of the first dimension.
    #[inline]
    fn fill(&self, first: u32, seed: u32, points: &mut [Vec2]) {
        for (i, point) in points.iter_mut().enumerate() {
            *point = self.point(first.wrapping_add(i as u32), true, seed);
        }
    }
}

impl Default for AnySampler {
    fn default() -> Self {
        Sobol::default().into()
    }
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
        let seed = self.pattern.pixel_seed(self.seed, pixel);
        Self { seed, pattern: self.pattern.at_pixel(pixel), ..*self }
    }

    /// The numbers of sample `index` of the same pixel, from the first dimension on.
    #[inline]
    pub fn sample(&self, index: u32) -> Self {
        Self { index, dimension: 0, ..*self }
    }

    /// The numbers of the `child`-th ray that leaves a vertex: a stream of its own.
    #[inline]
    pub fn branch(&self, child: u32) -> Self {
        Self { seed: hash::combine(self.seed, child.wrapping_add(1)), dimension: 0, ..*self }
    }

    /// The `part`-th of `parts` streams that together sample one thing well (the rays of a soft shadow).
    #[inline]
    pub fn part(&self, part: u32, parts: u32) -> Self {
        Self { index: self.index.wrapping_mul(parts).wrapping_add(part), ..*self }
    }

    /// The next number in [0, 1): the first coordinate of [`Sampler::next_2d`].
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let seed = self.next_seed();
        self.pattern.first_coordinate(self.index, self.dimension == 1, seed)
    }

    /// Seed of the next dimension.
    #[inline]
    fn next_seed(&mut self) -> u32 {
        let seed = self.seed ^ hash::mix(self.dimension.wrapping_mul(0x9e37_79b9));
        self.dimension += 1;
        seed
    }

    /// The next point in [0, 1)².
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        let seed = self.next_seed();
        self.pattern.point(self.index, self.dimension == 1, seed)
    }

    /// What [`Sampler::next_2d`] gives first for the samples from `first` on of this pixel: their places on
    /// the film.
    pub fn first_points(&self, first: u32, points: &mut [Vec2]) {
        self.pattern.fill(first, self.seed ^ hash::mix(0), points);
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

#[cfg(test)]
mod tests;
