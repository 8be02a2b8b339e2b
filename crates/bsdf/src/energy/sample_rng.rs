//! More random numbers, derived from those of a sample, for events that need more than it has.

use juggler_math::Vec2;

/// Stream of random numbers (SplitMix64: Steele, Lea and Flood 2014) seeded by the numbers of one
/// sample, the same on every machine.
#[derive(Clone, Copy, Debug)]
pub struct SampleRng {
    state: u64,
}

impl SampleRng {
    /// Stream seeded by the bits of a point in the unit square and of one more number.
    #[inline]
    pub fn new(u: Vec2, u_choice: f32) -> Self {
        let [x, y, u_choice] = [u.x, u.y, u_choice].map(|number| u64::from(number.to_bits()));
        let mut seeded = Self { state: (x << 32) | y };
        seeded.state = seeded.bits() ^ (u_choice << 17);
        seeded
    }

    #[inline]
    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number in [0, 1).
    #[inline]
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 * (1.0 / 16_777_216.0)
    }
}
