//! Hit filters: all hits count, or those that a caller's function accepts, for example for opacity
//! and for masks of rays or triangles.

use super::TriangleHit;

/// Decides which hits count. Kernels are monomorphized for each filter; [`All`] adds no code.
pub(super) trait Filter: Copy {
    /// Whether the filter accepts every hit.
    const ALL: bool;

    /// Whether the filter accepts a ray's hit.
    fn accepts(&self, ray: usize, hit: &TriangleHit) -> bool;
}

/// Accepts every hit.
#[derive(Clone, Copy)]
pub(super) struct All;

impl Filter for All {
    const ALL: bool = true;

    #[inline(always)]
    fn accepts(&self, _ray: usize, _hit: &TriangleHit) -> bool {
        true
    }
}

/// Accepts the hits for which the function returns `true`.
#[derive(Clone, Copy)]
pub(super) struct FilterFn<F>(pub F);

impl<F: Fn(usize, &TriangleHit) -> bool + Copy> Filter for FilterFn<F> {
    const ALL: bool = false;

    #[inline(always)]
    fn accepts(&self, ray: usize, hit: &TriangleHit) -> bool {
        (self.0)(ray, hit)
    }
}
