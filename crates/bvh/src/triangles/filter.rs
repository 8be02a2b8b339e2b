//! Which hits count: all, or those that a caller's function lets pass. For cut-outs, masks of rays and of
//! triangles, whatever a hit can be refused by.

use super::TriangleHit;

/// What decides about hits. Kernels are made for each; [`All`] leaves nothing behind in them.
pub(super) trait Filter: Copy {
    /// Whether every hit counts.
    const ALL: bool;

    /// Whether the hit of a ray counts.
    fn accepts(&self, ray: usize, hit: &TriangleHit) -> bool;
}

/// Every hit counts.
#[derive(Clone, Copy)]
pub(super) struct All;

impl Filter for All {
    const ALL: bool = true;

    #[inline(always)]
    fn accepts(&self, _ray: usize, _hit: &TriangleHit) -> bool {
        true
    }
}

/// Hits count where the function says so.
#[derive(Clone, Copy)]
pub(super) struct Where<F>(pub F);

impl<F: Fn(usize, &TriangleHit) -> bool + Copy> Filter for Where<F> {
    const ALL: bool = false;

    #[inline(always)]
    fn accepts(&self, ray: usize, hit: &TriangleHit) -> bool {
        (self.0)(ray, hit)
    }
}
