//! The traversal's stack: a fixed array whose size the builder proves to be enough.
//!
//! An entry is a distance and a word in one `u64`, so that for distances of at least zero the order of the
//! entries is the order of the numbers. Indices are masked, which costs no branch; the stack of a tree never
//! grows beyond `BuildStats::stack`, and the kernels are made for three sizes, so that small trees do not pay
//! for clearing a large stack at every ray.

/// Enough for the tree of a few hundred items.
pub(crate) const SMALL: usize = 32;
/// Enough for most trees.
pub(crate) const MEDIUM: usize = 128;
/// Enough for every tree: 72 levels of 7 waiting children.
pub(crate) const LARGE: usize = 512;

/// Pending work, nearest on top.
pub(crate) struct Stack<const SIZE: usize> {
    entries: [u64; SIZE],
    len: usize,
}

impl<const SIZE: usize> Stack<SIZE> {
    const MASK: usize = {
        assert!(SIZE.is_power_of_two());
        SIZE - 1
    };

    #[inline(always)]
    pub fn new() -> Self {
        Self { entries: [0; SIZE], len: 0 }
    }

    #[inline(always)]
    pub fn push(&mut self, enter: f32, word: u32) {
        debug_assert!(self.len < SIZE);
        self.entries[self.len & Self::MASK] = u64::from(enter.to_bits()) << 32 | u64::from(word);
        self.len += 1;
    }

    /// Pushes so that the entries above `base` stay sorted, the nearest on top.
    #[inline(always)]
    pub fn insert(&mut self, base: usize, enter: f32, word: u32) {
        debug_assert!(self.len < SIZE);
        let entry = u64::from(enter.to_bits()) << 32 | u64::from(word);
        let mut at = self.len;
        while at > base && self.entries[(at - 1) & Self::MASK] < entry {
            self.entries[at & Self::MASK] = self.entries[(at - 1) & Self::MASK];
            at -= 1;
        }
        self.entries[at & Self::MASK] = entry;
        self.len += 1;
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<(f32, u32)> {
        self.len = self.len.checked_sub(1)?;
        let entry = self.entries[self.len & Self::MASK];
        Some((f32::from_bits((entry >> 32) as u32), entry as u32))
    }

    /// Forgets what lies above `len`.
    #[inline(always)]
    pub fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }
}
