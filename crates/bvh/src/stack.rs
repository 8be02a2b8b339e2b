//! The traversal's stack: a fixed array, large enough for every tree, of which only what is used is touched.
//!
//! An entry is a distance and a word in one `u64`, so that for distances of at least zero the order of the
//! entries is the order of the numbers.

use arrayvec::ArrayVec;

/// 72 levels of 7 waiting children.
pub(crate) const SIZE: usize = 512;

/// Pending work, nearest on top.
pub(crate) struct Stack(ArrayVec<u64, SIZE>);

/// Distance and word in one number.
#[inline(always)]
pub(crate) fn entry(enter: f32, word: u32) -> u64 {
    u64::from(enter.to_bits()) << 32 | u64::from(word)
}

/// The distance of an entry.
#[inline(always)]
pub(crate) fn distance(entry: u64) -> f32 {
    f32::from_bits((entry >> 32) as u32)
}

impl Stack {
    #[inline(always)]
    pub fn new() -> Self {
        Self(ArrayVec::new_const())
    }

    #[inline(always)]
    pub fn push(&mut self, entry: u64) {
        // The builder proves that there is room (`BuildStats::stack`).
        let pushed = self.0.try_push(entry);
        debug_assert!(pushed.is_ok());
    }

    /// Pushes so that the entries above `base` stay sorted, the nearest on top.
    #[inline(always)]
    pub fn insert(&mut self, base: usize, entry: u64) {
        self.push(entry);
        let above = &mut self.0[base..];
        let mut at = above.len() - 1;
        while at > 0 && above[at - 1] < entry {
            above[at] = above[at - 1];
            at -= 1;
        }
        above[at] = entry;
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<u64> {
        self.0.pop()
    }

    /// Forgets what lies above `len`.
    #[inline(always)]
    pub fn truncate(&mut self, len: usize) {
        self.0.truncate(len);
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.0.len()
    }
}
