//! Samplers: sample points for film, lens, time and scattering.
//!
//! Each number is a pure function of (seed, pixel, sample index, branch, dimension). Samplers store
//! no state between samples, so any thread, tile, shard or resumed run draws the same numbers.

use juggler_math::{UVec2, Vec2, hash};

mod blue_noise;
mod independent;
mod sobol;
mod stratified;

/// Sampler as the scene describes it.
pub trait SamplerDescription: Send + Sync {
    /// Sample pattern for pictures with `samples` samples per pixel.
    fn point_set(&self, samples: u32) -> AnyPointSet;
}

juggler_math::closed_set! {
    /// Sampler of any kind. In JSON: `{"sobol": {}}`, or short `"sobol"`.
    pub enum AnySampler: SamplerDescription, kind SamplerKind {
        sobol::Sobol => SobolPoints,
        stratified::Stratified => StratifiedPoints,
        independent::Independent => IndependentPoints,
        blue_noise::BlueNoise => BlueNoisePoints,
    }
    /// Sample pattern of one pixel and dimension, ready to draw.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum AnyPointSet: static PointSet;
    fn pixel_seed(&self, seed: u32, pixel: UVec2) -> u32;
    fn at_pixel(&self, pixel: UVec2) -> AnyPointSet;
    fn address(&self, index: u32) -> u32;
    fn first_coordinate(&self, address: u32, is_first_dimension: bool, seed: u32) -> f32;
    fn point(&self, address: u32, is_first_dimension: bool, seed: u32) -> Vec2;
    fn finer_point(&self, address: u32, part: u32, parts: u32, seed: u32) -> Option<Vec2>;
    fn fill(&self, first: u32, seed: u32, points: &mut [Vec2]);
}

/// Points in [0, 1)² for the samples of a pixel, one set per dimension; all methods are pure
/// functions.
pub trait PointSet: Copy + Into<AnyPointSet> {
    /// Seed of a pixel in a picture with this `seed`.
    #[inline]
    fn pixel_seed(&self, seed: u32, pixel: UVec2) -> u32 {
        hash::combine(hash::combine(seed, pixel.x), pixel.y)
    }

    /// Pattern of a pixel.
    #[inline]
    fn at_pixel(&self, _pixel: UVec2) -> AnyPointSet {
        (*self).into()
    }

    /// Address of sample `index`: the form of the index by which points are drawn, so that what the
    /// points of all dimensions share is computed once. The function is its own inverse.
    #[inline]
    fn address(&self, index: u32) -> u32 {
        index
    }

    /// Point of the sample at `address` in the dimension `seed`; `is_first_dimension` is true for the
    /// film position.
    fn point(&self, address: u32, is_first_dimension: bool, seed: u32) -> Vec2;

    /// Coordinate x of [`point`](Self::point).
    #[inline]
    fn first_coordinate(&self, address: u32, is_first_dimension: bool, seed: u32) -> f32 {
        self.point(address, is_first_dimension, seed).x
    }

    /// Point `part` of the `parts` points of the sample at `address`, in the first dimension. All parts of
    /// all samples together are one well-distributed set, and so are the parts 0. `None` if the kind
    /// has no such set.
    #[inline]
    fn finer_point(&self, _address: u32, _part: u32, _parts: u32, _seed: u32) -> Option<Vec2> {
        None
    }

    /// Points of consecutive samples from `first` on, in the first dimension.
    #[inline]
    fn fill(&self, first: u32, seed: u32, points: &mut [Vec2]) {
        for (i, point) in points.iter_mut().enumerate() {
            *point = self.point(self.address(first.wrapping_add(i as u32)), true, seed);
        }
    }
}

impl Default for AnySampler {
    fn default() -> Self {
        Sobol::default().into()
    }
}

/// Stream of random numbers of one sample of one pixel. Copies are cheap and independent: a sampler
/// holds an address, not a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    seed: u32,
    /// Address of the sample: see [`PointSet::address`].
    address: u32,
    dimension: u32,
    pattern: AnyPointSet,
}

impl Sampler {
    /// Creates the sampler of a picture; [`pixel`](Self::pixel) gives the streams of its pixels.
    pub fn new(pattern: AnyPointSet, seed: u64) -> Self {
        let seed = hash::combine(seed as u32, (seed >> 32) as u32);
        Self { seed, address: pattern.address(0), dimension: 0, pattern }
    }

    /// Stream of sample 0 of a pixel.
    #[inline]
    pub fn pixel(&self, pixel: UVec2) -> Self {
        let seed = self.pattern.pixel_seed(self.seed, pixel);
        Self { seed, pattern: self.pattern.at_pixel(pixel), ..*self }
    }

    /// Stream of sample `index` of the same pixel, from the first dimension on.
    #[inline]
    pub fn sample(&self, index: u32) -> Self {
        Self { address: self.pattern.address(index), dimension: 0, ..*self }
    }

    /// Independent stream of ray `child` that leaves a vertex.
    #[inline]
    pub fn branch(&self, child: u32) -> Self {
        Self { seed: hash::combine(self.seed, child.wrapping_add(1)), dimension: 0, ..*self }
    }

    /// Stream `index` of `count` streams that together form one well-distributed set, such as the
    /// shadow rays of one light.
    #[inline]
    pub fn subsequence(&self, index: u32, count: u32) -> Self {
        if count == 1 { *self } else { self.subsequence_of_several(index, count) }
    }

    #[inline(never)]
    fn subsequence_of_several(&self, index: u32, count: u32) -> Self {
        let own = self.pattern.address(self.address);
        Self { address: self.pattern.address(own.wrapping_mul(count).wrapping_add(index)), ..*self }
    }

    /// Next number in [0, 1): the first coordinate of [`Sampler::next_2d`].
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let seed = self.next_seed();
        self.pattern.first_coordinate(self.address, self.dimension == 1, seed)
    }

    /// Seed of the next dimension.
    #[inline]
    fn next_seed(&mut self) -> u32 {
        let seed = self.seed ^ hash::mix(self.dimension.wrapping_mul(0x9e37_79b9));
        self.dimension += 1;
        seed
    }

    /// Next point in [0, 1)².
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        let seed = self.next_seed();
        self.pattern.point(self.address, self.dimension == 1, seed)
    }

    /// Film positions of consecutive samples of this pixel from `first` on: the first
    /// [`Sampler::next_2d`] of each.
    pub fn first_points(&self, first: u32, points: &mut [Vec2]) {
        self.pattern.fill(first, self.seed ^ hash::mix(0), points);
    }

    /// Film position of camera ray `ray` of `rays` of this sample, if the sampler has a finer set
    /// of points for that number: see [`PointSet::finer_point`].
    pub fn film_point(&self, ray: u32, rays: u32) -> Option<Vec2> {
        self.pattern.finer_point(self.address, ray, rays, self.seed ^ hash::mix(0))
    }

    /// Same stream `count` dimensions further on.
    #[inline]
    #[must_use]
    pub fn skipped(&self, count: u32) -> Self {
        Self { dimension: self.dimension + count, ..*self }
    }

    /// Skips `count` dimensions.
    pub fn skip(&mut self, count: u32) {
        self.dimension += count;
    }
}

#[cfg(test)]
mod tests;
