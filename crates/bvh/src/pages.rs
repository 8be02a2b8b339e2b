//! Large arrays on huge pages. Beyond the cache, a lookup then costs one miss in place of two,
//! since the address translation stays in the TLB.

use bytemuck::Pod;
use memmap2::MmapMut;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::ptr::NonNull;

/// Size in bytes below which an array lives in a plain vector.
const SMALL: usize = 1 << 20;
/// Size of a huge page in bytes; large arrays are aligned to it.
const HUGE: usize = 1 << 21;

/// An array of fixed length, on huge pages if it is large and the system supports them.
pub(crate) struct Pages<T> {
    /// Elements: inside `map`, or else a leaked boxed slice that the array owns. A single pointer
    /// serves both, since every ray follows it.
    elements: NonNull<[T]>,
    map: Option<MmapMut>,
}

#[expect(unsafe_code, reason = "an array owns its elements, which a pointer does not say")]
// SAFETY: `elements` aliases nothing but `map`, which nobody else reads or writes; as a `Vec<T>`.
unsafe impl<T: Send> Send for Pages<T> {}
#[expect(unsafe_code, reason = "an array owns its elements, which a pointer does not say")]
// SAFETY: as above; only `&mut self` writes.
unsafe impl<T: Sync> Sync for Pages<T> {}

impl<T: Pod> Pages<T> {
    /// `len` elements whose bytes are all zero.
    pub fn zeroed(len: usize) -> Self {
        Self::mapped(len).unwrap_or_else(|| Self::boxed(vec![T::zeroed(); len]))
    }

    fn boxed(elements: Vec<T>) -> Self {
        Self { elements: NonNull::from(Box::leak(elements.into_boxed_slice())), map: None }
    }

    /// Zeroed elements on pages of their own; `None` if the array is small or the mapping fails.
    fn mapped(len: usize) -> Option<Self> {
        let bytes = len.checked_mul(size_of::<T>()).filter(|&bytes| bytes >= SMALL)?;
        // Anonymous mappings are zeroed.
        let mut map = MmapMut::map_anon(bytes.checked_add(HUGE)?).ok()?;
        let start = map.as_ptr().align_offset(HUGE);
        let fits = start.checked_add(bytes).is_some_and(|end| end <= map.len());
        if !fits || align_of::<T>() > HUGE {
            return None;
        }
        // Only advice: without huge pages, small ones serve. A rest of less than half a huge page would
        // waste the other half.
        #[cfg(target_os = "linux")]
        let huge = ((bytes + HUGE / 2) / HUGE * HUGE).min(map.len() - start);
        #[cfg(target_os = "linux")]
        let _ = map.advise_range(memmap2::Advice::HugePage, start, huge);
        let first = NonNull::new(map.as_mut_ptr().wrapping_add(start).cast())?;
        Some(Self { elements: NonNull::slice_from_raw_parts(first, len), map: Some(map) })
    }

    /// Memory of the elements in bytes.
    pub fn bytes(&self) -> usize {
        self.len() * size_of::<T>()
    }
}

impl<T: Pod> Deref for Pages<T> {
    type Target = [T];

    #[inline(always)]
    #[expect(unsafe_code, reason = "checked casts cost every single ray 9 % more instructions, an enum 3 %")]
    fn deref(&self) -> &[T] {
        // SAFETY: `elements` is a leaked box, or lies aligned inside `map`, as `mapped` has
        // checked; `map` lives as long as `self`, is never resized and was zeroed, and every bit
        // pattern is a valid `T: Pod`.
        unsafe { self.elements.as_ref() }
    }
}

impl<T: Pod> DerefMut for Pages<T> {
    #[inline]
    #[expect(unsafe_code, reason = "as above")]
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as above; `&mut self` makes the access exclusive.
        unsafe { self.elements.as_mut() }
    }
}

impl<T> Drop for Pages<T> {
    #[expect(unsafe_code, reason = "a boxed slice is freed by who owns it")]
    fn drop(&mut self) {
        if self.map.is_none() {
            // SAFETY: without a map, `boxed` leaked `elements` from a box, and this is its only
            // owner.
            drop(unsafe { Box::from_raw(self.elements.as_ptr()) });
        }
    }
}

impl<T: Pod> Clone for Pages<T> {
    fn clone(&self) -> Self {
        let mut clone = Self::zeroed(self.len());
        clone.copy_from_slice(self);
        clone
    }
}

impl<T: Pod> From<Vec<T>> for Pages<T> {
    /// Copies the elements if the array is large.
    fn from(elements: Vec<T>) -> Self {
        match Self::mapped(elements.len()) {
            Some(mut pages) => {
                pages.copy_from_slice(&elements);
                pages
            }
            None => Self::boxed(elements),
        }
    }
}

impl<T: Pod + fmt::Debug> fmt::Debug for Pages<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;

    #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
    #[repr(C, align(64))]
    struct Line([u32; 16]);

    #[test]
    fn elements_start_as_zero_and_keep_what_is_written() {
        for len in [0, 1, 100, SMALL / 64 - 1, SMALL / 64, SMALL / 64 + 7, 100_000] {
            let mut pages = Pages::<Line>::zeroed(len);
            assert_eq!((pages.len(), pages.bytes()), (len, len * 64));
            assert!(pages.iter().all(|line| *line == Line([0; 16])));
            for (i, line) in pages.iter_mut().enumerate() {
                line.0[i % 16] = i as u32 + 1;
            }
            let clone = pages.clone();
            drop(pages);
            assert!(clone.iter().enumerate().all(|(i, line)| line.0.iter().sum::<u32>() == i as u32 + 1));
            assert_eq!(*Pages::from(clone.to_vec()), *clone);
        }
    }

    #[test]
    fn large_arrays_are_aligned_to_huge_pages() {
        let pages = Pages::<Line>::zeroed(SMALL);
        if pages.map.is_some() {
            assert_eq!(pages.as_ptr().align_offset(HUGE), 0);
        }
        assert_eq!(format!("{:?}", Pages::from(vec![Line([3; 16])])), format!("{:?}", [Line([3; 16])]));
    }
}
