//! Traversal stack: a fixed array that is large enough for every tree and is not initialized.
//!
//! An entry packs a distance and a word into one `u64`, so that entries with non-negative distances
//! compare as integers.

use std::mem::MaybeUninit;

/// Capacity: 72 levels with 7 waiting children each. A power of two, so that a bit mask keeps an
/// index in range.
pub(crate) const SIZE: usize = 512;
const MASK: usize = SIZE - 1;

/// Stack memory, reused between traversals and, for rays in flight, between steps. The first
/// `min(len, SIZE)` entries are initialized.
pub(crate) struct Stack {
    len: usize,
    entries: [MaybeUninit<u64>; SIZE],
}

/// A stack during a traversal, nearest entry on top. The length is a local variable here, which the
/// compiler keeps in a register, unlike the field of a [`Stack`]. Entries below `base` belong to
/// another traversal.
pub(crate) struct StackView<'a> {
    base: usize,
    len: usize,
    stack: &'a mut Stack,
}

/// Packs a distance and a word into an entry.
#[inline(always)]
pub(crate) fn entry(enter: f32, word: u32) -> u64 {
    u64::from(enter.to_bits()) << 32 | u64::from(word)
}

/// Distance of an entry.
#[inline(always)]
pub(crate) fn distance(entry: u64) -> f32 {
    f32::from_bits((entry >> 32) as u32)
}

impl Stack {
    #[inline(always)]
    pub fn new() -> Self {
        Self { len: 0, entries: [const { MaybeUninit::uninit() }; SIZE] }
    }

    /// Removes all entries.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// View of all entries.
    #[inline(always)]
    pub fn view(&mut self) -> StackView<'_> {
        StackView { base: 0, len: self.len, stack: self }
    }
}

impl StackView<'_> {
    /// An empty view on top of this one.
    #[inline(always)]
    pub fn above(&mut self) -> StackView<'_> {
        StackView { base: self.len, len: self.len, stack: self.stack }
    }

    #[inline(always)]
    pub fn push(&mut self, entry: u64) {
        // The builder proves that there is room (`BuildStats::stack`).
        debug_assert!(self.len < SIZE);
        self.stack.entries[self.len & MASK].write(entry);
        self.len += 1;
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<u64> {
        if self.len == self.base {
            return None;
        }
        let entry = self.read(self.len - 1);
        self.len -= 1;
        Some(entry)
    }

    /// Pushes an entry below the nearest ones among the top `sorted`, which are in order.
    #[inline(always)]
    pub fn insert(&mut self, sorted: usize, entry: u64) {
        let bottom = self.len - sorted.min(self.len);
        let mut at = self.len;
        while at > bottom && self.read(at - 1) < entry {
            let nearer = self.read(at - 1);
            self.stack.entries[at & MASK].write(nearer);
            at -= 1;
        }
        self.stack.entries[at & MASK].write(entry);
        self.len += 1;
    }

    /// The entry at a position below `len`.
    #[inline(always)]
    #[expect(
        unsafe_code,
        reason = "entries that are zeroed first, or checked, cost single rays 4 % of their instructions"
    )]
    fn read(&self, position: usize) -> u64 {
        debug_assert!(position < self.len);
        // SAFETY: only `push` and `insert` raise `len`, by one, and write the entry that this adds,
        // `insert` at the latest when all above it have moved up; so entries below `len` are
        // written. Callers read below `len`.
        unsafe { self.stack.entries[position & MASK].assume_init() }
    }

    /// Removes the entries of this view.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = self.base;
    }
}

impl Drop for StackView<'_> {
    #[inline(always)]
    fn drop(&mut self) {
        self.stack.len = self.len;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stack_pops_nearest_first_and_views_keep_lower_entries() {
        let mut stack = Stack::new();
        stack.view().push(entry(1.0, 10));
        let mut view = stack.view();
        view.push(entry(0.5, 11));
        {
            let mut above = view.above();
            assert_eq!(above.pop(), None);
            for (sorted, distance) in [3.0, 1.0, 2.0, 0.25, 4.0].into_iter().enumerate() {
                above.insert(sorted, entry(distance, 7));
            }
            let popped: Vec<f32> = std::iter::from_fn(|| above.pop()).map(distance).collect();
            assert_eq!(popped, [0.25, 1.0, 2.0, 3.0, 4.0]);
        }
        assert_eq!((view.pop(), view.pop(), view.pop()), (Some(entry(0.5, 11)), Some(entry(1.0, 10)), None));
    }

    #[test]
    fn stack_keeps_the_remaining_entries_of_a_view() {
        let mut stack = Stack::new();
        for i in 0..SIZE as u32 {
            stack.view().push(entry(0.0, i));
        }
        assert_eq!(stack.view().pop().map(|entry| entry as u32), Some(SIZE as u32 - 1));
        assert_eq!(stack.view().pop().map(|entry| entry as u32), Some(SIZE as u32 - 2));
        stack.view().clear();
        assert_eq!(stack.view().pop(), None);
        stack.view().push(3);
        stack.clear();
        assert_eq!(stack.view().pop(), None);
    }
}
