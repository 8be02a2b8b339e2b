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
        sobol::Sobol, stratified::Stratified, independent::Independent, blue_noise::BlueNoise,
    }
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
    /// Owen-scrambled Sobol points that neighbouring pixels share.
    BlueNoise {
        /// 2 to the power of this many samples a pixel are planned.
        bits: u8,
        /// Where the pixel comes among those that it shares the points with; 0 for a picture.
        place: u16,
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
        if let Pattern::BlueNoise { bits, .. } = self.pattern {
            let (block, place) = (pixel / blue_noise::BLOCK_EDGE, blue_noise::place(pixel));
            let seed = hash::combine(hash::combine(self.seed, block.x), block.y);
            return Self { seed, pattern: Pattern::BlueNoise { bits, place }, ..*self };
        }
        Self { seed: hash::combine(hash::combine(self.seed, pixel.x), pixel.y), ..*self }
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
        match self.pattern {
            Pattern::Sobol => {
                let seed = self.next_seed();
                sobol::first_coordinate(self.index, seed)
            }
            _ => self.next_2d().x,
        }
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
        match self.pattern {
            Pattern::Sobol => sobol::point(self.index, seed),
            Pattern::Stratified { side } => stratified::point(self.index, self.dimension == 1, seed, side),
            Pattern::Independent => independent::point(self.index, seed),
            Pattern::BlueNoise { bits, place } => blue_noise::point(self.index, place, bits, seed),
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
            Pattern::BlueNoise { bits, place } => {
                fill(points, first, |index| blue_noise::point(index, place, bits, seed));
            }
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
mod tests;
