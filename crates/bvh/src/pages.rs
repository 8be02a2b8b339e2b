//! Large arrays that ask the system for huge pages: beyond the cache a lookup in a tree then costs one miss
//! instead of two, for the translation of its address stays in the processor's table.

use bytemuck::Pod;
use memmap2::MmapMut;
use std::fmt;
use std::ops::{Deref, DerefMut};

/// Arrays below this many bytes live in a plain vector.
const SMALL: usize = 1 << 20;
/// Size of a huge page, to which the array is aligned.
const HUGE: usize = 1 << 21;

/// An array of fixed length, on huge pages when it is large and the system has them.
pub(crate) struct Pages<T> {
    memory: Memory<T>,
}

enum Memory<T> {
    /// `len` elements from byte `start` of the map: inside of it and aligned.
    Map {
        map: MmapMut,
        start: usize,
        len: usize,
    },
    Plain(Vec<T>),
}

impl<T: Pod> Pages<T> {
    /// `len` elements whose bytes are all zero.
    pub fn zeroed(len: usize) -> Self {
        let memory = Self::map(len).unwrap_or_else(|| Memory::Plain(vec![T::zeroed(); len]));
        Self { memory }
    }

    /// Anonymous memory comes zeroed. `None` where the array is small or there is no such memory.
    fn map(len: usize) -> Option<Memory<T>> {
        let bytes = len.checked_mul(size_of::<T>()).filter(|&bytes| bytes >= SMALL)?;
        let map = MmapMut::map_anon(bytes.checked_add(HUGE)?).ok()?;
        let start = map.as_ptr().align_offset(HUGE);
        let fits = start.checked_add(bytes).is_some_and(|end| end <= map.len());
        // A wish: where it is refused, small pages do.
        #[cfg(target_os = "linux")]
        let _ = map.advise(memmap2::Advice::HugePage);
        (fits && align_of::<T>() <= HUGE).then_some(Memory::Map { map, start, len })
    }

    /// Bytes of memory that the elements take.
    pub fn bytes(&self) -> usize {
        self.len() * size_of::<T>()
    }
}

impl<T: Pod> Deref for Pages<T> {
    type Target = [T];

    #[inline(always)]
    #[expect(unsafe_code, reason = "checked casts cost every single ray 9 % more instructions")]
    fn deref(&self) -> &[T] {
        match &self.memory {
            // SAFETY: `Pages::map` has checked that the elements lie inside of the map, aligned; the map lives as
            // long as `self`, is never resized, came zeroed, and every pattern of bits is a `T: Pod`.
            Memory::Map { map, start, len } => unsafe {
                std::slice::from_raw_parts(map.as_ptr().wrapping_add(*start).cast(), *len)
            },
            Memory::Plain(elements) => elements,
        }
    }
}

impl<T: Pod> DerefMut for Pages<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.memory {
            Memory::Map { map, start, len } => {
                let bytes = *start..*start + *len * size_of::<T>();
                bytemuck::cast_slice_mut(&mut map[bytes])
            }
            Memory::Plain(elements) => elements,
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
    /// Copies the elements where the array is large.
    fn from(elements: Vec<T>) -> Self {
        match Self::map(elements.len()) {
            Some(memory) => {
                let mut pages = Self { memory };
                pages.copy_from_slice(&elements);
                pages
            }
            None => Self { memory: Memory::Plain(elements) },
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
        if let Memory::Map { .. } = pages.memory {
            assert_eq!(pages.as_ptr().align_offset(HUGE), 0);
        }
        assert_eq!(format!("{:?}", Pages::from(vec![Line([3; 16])])), format!("{:?}", [Line([3; 16])]));
    }
}
