//! A checked mesh with its hierarchy, shared by all clones.

use super::MeshData;
use super::deforming::Deforming;
use crate::facet::Facet;
use crate::{InvalidShape, check::invalid};
use juggler_bvh::{Quality, SimdLevel, TriangleBvh, TriangleHit};
use juggler_math::{Aabb, Ray};
use rayon::prelude::*;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A checked mesh with its hierarchy.
pub struct Prepared {
    /// As it is when the shutter opens.
    arrays: Arc<MeshData>,
    tree: Tree,
    bounds: Aabb,
    area: f64,
    /// Triangles without area.
    degenerate: usize,
    /// Running sums of the triangles' areas, made when the mesh is first sampled: few meshes are lamps.
    areas: OnceLock<Vec<f64>>,
}

/// The hierarchy over a mesh's triangles.
enum Tree {
    Still(Box<TriangleBvh>),
    Moving(Deforming),
}

/// What all triangles are together.
struct Extent {
    bounds: Aabb,
    area: f64,
    degenerate: usize,
}

impl Extent {
    const NONE: Self = Self { bounds: Aabb::EMPTY, area: 0.0, degenerate: 0 };

    /// Summed in blocks of a fixed size, so that the threads do not show.
    fn of(data: &MeshData) -> Self {
        const BLOCK: usize = 1 << 16;
        let blocks = (0..data.triangles.len().div_ceil(BLOCK)).into_par_iter();
        let blocks: Vec<Self> = blocks
            .map(|block| {
                let facets = (block * BLOCK..(block + 1) * BLOCK).map_while(|triangle| data.facet(triangle));
                facets.fold(Self::NONE, |sum, facet| match facet.area() {
                    area if area > 0.0 => {
                        let bounds = facet.corners.into_iter().fold(sum.bounds, Aabb::with_point);
                        Self { bounds, area: sum.area + area, ..sum }
                    }
                    _ => Self { degenerate: sum.degenerate + 1, ..sum },
                })
            })
            .collect();
        blocks.into_iter().fold(Self::NONE, |sum, block| Self {
            bounds: sum.bounds.union(block.bounds),
            area: sum.area + block.area,
            degenerate: sum.degenerate + block.degenerate,
        })
    }
}

impl Prepared {
    /// Checks the arrays and builds the hierarchy.
    pub fn new(arrays: Arc<MeshData>) -> Result<Self, InvalidShape> {
        let extent = checked(&arrays)?;
        let bvh = TriangleBvh::build(&arrays.positions, &arrays.triangles, Quality::Balanced)
            .map_err(|error| invalid("triangles", error.to_string()))?;
        Ok(Self::with(arrays, Tree::Still(Box::new(bvh)), extent))
    }

    /// The same for a mesh that is as these say at even times while the shutter is open, all with the same triangles.
    pub fn moving(keys: Vec<MeshData>) -> Result<Self, InvalidShape> {
        for key in &keys {
            key.check()?;
        }
        let Some(data) = keys.first().cloned() else { return Self::new(Arc::default()) };
        let extent = checked(&data)?;
        let tree = Deforming::new(keys)?;
        let extent = Extent { bounds: tree.bounds(), ..extent };
        Ok(Self::with(Arc::new(data), Tree::Moving(tree), extent))
    }

    fn with(arrays: Arc<MeshData>, tree: Tree, Extent { bounds, area, degenerate }: Extent) -> Self {
        Self { arrays, tree, bounds, area, degenerate, areas: OnceLock::new() }
    }

    /// The same for another vector unit.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let tree = match &self.tree {
            Tree::Still(bvh) => Tree::Still(Box::new(TriangleBvh::clone(bvh).with_simd_level(level))),
            Tree::Moving(tree) => Tree::Moving(tree.with_simd_level(level)),
        };
        Self { arrays: Arc::clone(&self.arrays), tree, areas: OnceLock::new(), ..*self }
    }

    /// The nearest hit at the ray's time.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        match &self.tree {
            Tree::Still(bvh) => bvh.closest(ray),
            Tree::Moving(tree) => tree.closest(ray),
        }
    }

    /// Whether anything is hit at the ray's time.
    pub fn any(&self, ray: &Ray) -> bool {
        match &self.tree {
            Tree::Still(bvh) => bvh.any(ray),
            Tree::Moving(tree) => tree.any(ray),
        }
    }

    /// A triangle as it is at a time.
    pub fn facet(&self, triangle: usize, time: f32) -> Option<Facet> {
        match &self.tree {
            Tree::Still(_) => self.arrays.facet(triangle),
            Tree::Moving(tree) => tree.facet(triangle, time),
        }
    }

    /// The hierarchy, of a mesh that keeps its shape.
    pub fn bvh(&self) -> Option<&TriangleBvh> {
        match &self.tree {
            Tree::Still(bvh) => Some(bvh),
            Tree::Moving(_) => None,
        }
    }

    /// Bytes of the hierarchy.
    pub fn bvh_bytes(&self) -> usize {
        match &self.tree {
            Tree::Still(bvh) => bvh.bytes(),
            Tree::Moving(tree) => tree.bvh_bytes(),
        }
    }

    /// The arrays.
    pub fn arrays(&self) -> &Arc<MeshData> {
        &self.arrays
    }

    /// A box around every triangle that has an area, wherever it comes.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Area of all triangles.
    pub fn area(&self) -> f32 {
        self.area as f32
    }

    /// How many triangles have no area.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// Running sums of the triangles' areas.
    pub fn running_areas(&self) -> &[f64] {
        self.areas.get_or_init(|| {
            let mut sum = 0.0;
            let facets = (0..self.arrays.triangles.len()).filter_map(|triangle| self.arrays.facet(triangle));
            let running = facets.map(|facet| {
                sum += facet.area();
                sum
            });
            running.collect()
        })
    }

    /// Bytes on the heap without the hierarchy.
    pub fn heap_bytes(&self) -> usize {
        let later = match &self.tree {
            Tree::Still(_) => &[],
            Tree::Moving(tree) => tree.keys(),
        };
        let arrays: usize = std::iter::once(&*self.arrays).chain(later).map(bytes).sum();
        size_of::<Self>() + arrays + size_of_val(self.areas.get().map_or(&[][..], Vec::as_slice))
    }
}

fn bytes(MeshData { positions, triangles, normals, uvs }: &MeshData) -> usize {
    let arrays = size_of_val(positions.as_slice()) + size_of_val(triangles.as_slice());
    arrays + size_of_val(normals.as_slice()) + size_of_val(uvs.as_slice())
}

/// Checks the arrays; some triangle must have an area.
fn checked(data: &MeshData) -> Result<Extent, InvalidShape> {
    data.check()?;
    let extent = Extent::of(data);
    if extent.degenerate == data.triangles.len() {
        let message = format!("`triangles` must have an area, but all {} are degenerate", extent.degenerate);
        return Err(invalid("triangles", message));
    }
    Ok(extent)
}

impl PartialEq for Prepared {
    fn eq(&self, other: &Self) -> bool {
        let keys = |prepared: &Self| match &prepared.tree {
            Tree::Still(_) => Vec::new(),
            Tree::Moving(tree) => tree.keys().to_vec(),
        };
        self.arrays == other.arrays && keys(self) == keys(other)
    }
}

impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles", self.arrays.triangles.len())
    }
}
