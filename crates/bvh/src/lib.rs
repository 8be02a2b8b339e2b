//! Bounding volume hierarchies over boxes and over triangles. Knows no shading and no shapes: boxes in,
//! ranges of items out.
//!
//! [`Bvh`] is a tree eight wide over anything that has a box; a [`Leaf`] visitor tests the items.
//! [`TriangleBvh`] holds triangles and tests them itself, watertight. [`MovingBvh`] and [`MovingTriangleBvh`] are the same
//! for what moves while the shutter is open. The crate's `README.md` explains the
//! layout and the three ways to trace: one ray, a batch of unrelated rays, a packet of coherent ones.
//!
//! ```
//! use juggler_bvh::{Bvh, Leaf, Quality};
//! use juggler_math::{Aabb, Ray, Vec3};
//! use std::ops::Range;
//!
//! /// Boxes that are themselves the shapes.
//! struct Boxes { shapes: Vec<Aabb>, nearest: Option<u32> }
//!
//! impl Leaf for Boxes {
//!     fn closest(&mut self, _lane: usize, ray: &mut Ray, items: Range<u32>) {
//!         for item in items {
//!             if let Some((enter, _)) = self.shapes[item as usize].clip(ray) {
//!                 ray.t_max = enter;
//!                 self.nearest = Some(item);
//!             }
//!         }
//!     }
//!     fn any(&mut self, _lane: usize, ray: &Ray, mut items: Range<u32>) -> bool {
//!         items.any(|item| self.shapes[item as usize].clip(ray).is_some())
//!     }
//! }
//!
//! let boxes: Vec<Aabb> = (0..100u8).map(|i| Aabb::from_points([Vec3::X * f32::from(i)]).grown(0.25)).collect();
//! let bvh = Bvh::build(&boxes, Quality::Balanced);
//! let shapes = bvh.order().iter().map(|&item| boxes[item as usize]).collect();
//! let mut leaf = Boxes { shapes, nearest: None };
//! let mut ray = Ray::new(Vec3::new(40.0, 1.0, 0.0), -Vec3::Y);
//! bvh.closest(&mut ray, &mut leaf);
//! assert_eq!(ray.t_max, 0.75);
//! assert_eq!(leaf.nearest.map(|item| bvh.order()[item as usize]), Some(40));
//! ```

mod build;
mod inspect;
mod lanes;
mod moving;
mod node;
mod packet;
mod pages;
mod ray_lanes;
mod single;
mod slabs;
mod stack;
mod triangle;
mod triangles;

pub use build::{BuildOptions, BuildStats, MAX_ITEMS, Quality, RefitError};
pub use inspect::Visits;
pub use moving::MovingBvh;
pub use packet::PACKET;
pub use triangle::{TriangleTest, intersect_triangle};
pub use triangles::{Filtered, MovingTriangleBvh, TriangleBvh, TriangleError, TriangleHit};

/// A kind of vector unit, known to be there.
pub use fearless_simd::Level as SimdLevel;

use juggler_math::{Aabb, Ray};
use node::Node;
use pages::Pages;
use std::ops::Range;

/// A tree of boxes, eight wide.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// The root is node 0; there is always one.
    nodes: Pages<Node>,
    order: Vec<u32>,
    bounds: Aabb,
    stats: BuildStats,
    /// The vector unit that the kernels use.
    level: SimdLevel,
}

/// Every kind of vector unit that this machine has and the kernels are made for, the best last. All give the same
/// bits.
pub fn simd_levels() -> Vec<SimdLevel> {
    let best = SimdLevel::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let lesser = [
        best.as_sse2().map(SimdLevel::Sse2),
        best.as_sse4_2().map(SimdLevel::Sse4_2),
        best.as_avx2().map(SimdLevel::Avx2),
    ];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let lesser = [Some(SimdLevel::baseline())];
    lesser.into_iter().flatten().chain([best]).collect()
}

/// What happens at the leaves: the owner of the items tests them.
pub trait Leaf {
    /// Tests the items at the positions `items` (of [`Bvh::order`]) with ray number `lane` of the call;
    /// shortens `ray.t_max` on a hit.
    ///
    /// A leaf is shown whenever its box is entered at or before `t_max`, so that of hits at equal distance
    /// the implementor can keep the one with the smallest item number, whatever the order of the visits.
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>);

    /// [`Leaf::closest`] for several rays of a packet: those whose bit in `active` is set. Ray `i` of the slice is
    /// lane `first + i`. Says whether one of them may end earlier now.
    #[inline(always)]
    fn closest_many(&mut self, first: usize, active: u32, rays: &mut [Ray], items: Range<u32>) -> bool {
        for lane in lanes::Bits(active) {
            self.closest(first + lane, &mut rays[lane], items.clone());
        }
        true
    }

    /// The ends of the eight rays from number `first` on, in [`Ray::t_max`]'s unit, where the visitor keeps them side by
    /// side; the rays themselves need not be shortened then. By default `None`: the rays are read.
    #[inline(always)]
    fn packet_t_max(&self, _first: usize) -> Option<&[f32; PACKET]> {
        None
    }

    /// [`Leaf::any`] for several rays of a packet: a bit for each that is occluded.
    #[inline(always)]
    fn any_many(&mut self, first: usize, active: u32, rays: &[Ray], items: Range<u32>) -> u32 {
        let mut found = 0;
        for lane in lanes::Bits(active) {
            found |= u32::from(self.any(first + lane, &rays[lane], items.clone())) << lane;
        }
        found
    }

    /// Whether one of the items is hit between `ray.t_min` and `ray.t_max`.
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool;
}

impl Bvh {
    /// The items in the order of the leaves: position `p` of a leaf's range is item `order()[p]`. Store what
    /// the leaves need in this order.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The box of everything in the tree; empty when nothing is.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The same tree for another vector unit than the best of this machine: for tests and measurements.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.level = level;
        self
    }

    /// What the build made.
    pub fn stats(&self) -> &BuildStats {
        &self.stats
    }

    /// Bytes of memory that the tree holds, without the items.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.nodes.bytes() + self.order.capacity() * size_of::<u32>()
    }
}
