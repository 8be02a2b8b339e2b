//! Bounding volume hierarchies over boxes and over triangles. The crate knows neither shading nor
//! shapes: it takes boxes and reports ranges of items.
//!
//! [`Bvh`] is an eight-wide hierarchy over items of any kind that have bounding boxes; a [`Leaf`]
//! visitor intersects the items. [`TriangleBvh`] stores triangles and intersects them watertight.
//! [`MovingBvh`] and [`MovingTriangleBvh`] add linear motion blur. The crate's `README.md` explains
//! the layout and the three ways to trace: a single ray, a batch of incoherent rays, a packet of
//! coherent rays.
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
//! let boxes: Vec<Aabb> =
//!     (0..100u8).map(|i| Aabb::from_points([Vec3::X * f32::from(i)]).grown(0.25)).collect();
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

/// SIMD instruction set that the machine supports.
pub use fearless_simd::Level as SimdLevel;

use juggler_math::{Aabb, Ray};
use node::Node;
use pages::Pages;
use std::ops::Range;

/// An eight-wide bounding volume hierarchy over boxes.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Nodes in depth-first order. The root is node 0 and always exists.
    nodes: Pages<Node>,
    order: Vec<u32>,
    bounds: Aabb,
    stats: BuildStats,
    /// SIMD level of the kernels.
    level: SimdLevel,
}

/// Returns the SIMD levels that the machine supports and the kernels are compiled for, the best one
/// last. All levels give the same bits.
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

/// Visitor that intersects the items of a leaf.
pub trait Leaf {
    /// Intersects the items at the positions `items` of [`Bvh::order`] with a ray and shortens
    /// `ray.t_max` on a hit. `lane` is the ray's index in the call.
    ///
    /// Every leaf whose box is entered at or before `t_max` is visited. So among hits at equal
    /// distance the implementor can keep the smallest item index, independent of the traversal
    /// order.
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>);

    /// [`Leaf::closest`] for the rays of a packet whose bits are set in `active`. `rays[i]` has
    /// lane `first + i`. Returns whether any `t_max` may have shrunk.
    #[inline(always)]
    fn closest_many(&mut self, first: usize, active: u32, rays: &mut [Ray], items: Range<u32>) -> bool {
        for lane in lanes::Bits(active) {
            self.closest(first + lane, &mut rays[lane], items.clone());
        }
        true
    }

    /// Current `t_max` of the eight rays from lane `first` on, if the visitor stores them
    /// contiguously; it then need not shorten the rays themselves. The default `None` reads them
    /// from the rays.
    #[inline(always)]
    fn packet_t_max(&self, _first: usize) -> Option<&[f32; PACKET]> {
        None
    }

    /// [`Leaf::any`] for the rays of a packet whose bits are set in `active`; returns a bit mask of
    /// the occluded rays.
    #[inline(always)]
    fn any_many(&mut self, first: usize, active: u32, rays: &[Ray], items: Range<u32>) -> u32 {
        let mut found = 0;
        for lane in lanes::Bits(active) {
            found |= u32::from(self.any(first + lane, &rays[lane], items.clone())) << lane;
        }
        found
    }

    /// Whether the ray hits any of the items between `ray.t_min` and `ray.t_max`.
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool;
}

impl Bvh {
    /// Items in leaf order: position `p` of a leaf's range is item `order()[p]`. Store per-item
    /// data in this order for locality.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Bounds of all items; empty for an empty hierarchy.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Selects another SIMD level than the machine's best one, for tests and benchmarks.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.level = level;
        self
    }

    /// Statistics of the build.
    pub fn stats(&self) -> &BuildStats {
        &self.stats
    }

    /// Memory of the hierarchy in bytes, without the items.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.nodes.bytes() + self.order.capacity() * size_of::<u32>()
    }
}
