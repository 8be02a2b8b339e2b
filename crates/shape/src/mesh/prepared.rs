//! A validated mesh with its hierarchy, shared by all clones.

use super::MeshData;
use super::moving_mesh::MovingMesh;
use crate::triangle_geometry::TriangleGeometry;
use crate::{InvalidShape, check::invalid};
use juggler_bvh::{Quality, SimdLevel, TriangleBvh, TriangleHit};
use juggler_math::{Aabb, BuildControl, Ray, Vec2, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A validated mesh with its hierarchy.
pub struct PreparedMesh {
    /// Arrays at the opening of the shutter.
    arrays: Arc<MeshData>,
    tree: Tree,
    bounds: Aabb,
    area: f64,
    /// Number of triangles without area.
    degenerate: usize,
    /// Running sums of the triangles' areas, computed when the mesh is first sampled: few meshes
    /// are lights.
    areas: OnceLock<Vec<f64>>,
}

/// The hierarchy over a mesh's triangles.
enum Tree {
    Still(Box<TriangleBvh>),
    Moving(MovingMesh),
}

/// Bounds, area and number of degenerate triangles of a mesh.
struct MeshMeasures {
    bounds: Aabb,
    area: f64,
    degenerate: usize,
}

impl MeshMeasures {
    const NONE: Self = Self { bounds: Aabb::EMPTY, area: 0.0, degenerate: 0 };

    /// Sums in blocks of a fixed size, so that the result does not depend on threads. Blocks are left
    /// out after cancellation.
    fn from_data(data: &MeshData, control: &BuildControl) -> Self {
        const BLOCK: usize = 1 << 16;
        let blocks = (0..data.triangles.len().div_ceil(BLOCK)).into_par_iter();
        let blocks: Vec<Self> = blocks
            .map(|block| {
                if control.is_cancelled() {
                    return Self::NONE;
                }
                let triangles =
                    (block * BLOCK..(block + 1) * BLOCK).map_while(|triangle| data.triangle_geometry(triangle));
                triangles.fold(Self::NONE, |sum, triangle| match triangle.area() {
                    area if area > 0.0 => {
                        let bounds = triangle.corners.into_iter().fold(sum.bounds, Aabb::with_point);
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

impl PreparedMesh {
    /// Validates the arrays and builds the hierarchy.
    pub fn new(arrays: Arc<MeshData>, control: &BuildControl) -> Result<Self, InvalidShape> {
        let measures = checked(&arrays, control)?;
        let bvh = TriangleBvh::build_with_control(&arrays.positions, &arrays.triangles, Quality::Balanced, control)
            .map_err(|error| invalid("triangles", error.to_string()))?;
        Ok(Self::with(arrays, Tree::Still(Box::new(bvh)), measures))
    }

    /// Validates and prepares a mesh that moves linearly between keyframes at uniform times while
    /// the shutter is open, all with the same triangles.
    pub fn from_keyframes(keys: Vec<MeshData>, control: &BuildControl) -> Result<Self, InvalidShape> {
        for key in &keys {
            control.check()?;
            key.check()?;
        }
        let Some(data) = keys.first().cloned() else { return Self::new(Arc::default(), control) };
        let measures = checked(&data, control)?;
        // Only the first keyframe gives what does not move.
        let keys = keys.into_iter().map(|key| MeshData { uvs1: Vec::new(), attributes: BTreeMap::new(), ..key });
        let tree = MovingMesh::new(keys.collect(), control)?;
        let measures = MeshMeasures { bounds: tree.bounds(), ..measures };
        Ok(Self::with(Arc::new(data), Tree::Moving(tree), measures))
    }

    fn with(arrays: Arc<MeshData>, tree: Tree, MeshMeasures { bounds, area, degenerate }: MeshMeasures) -> Self {
        Self { arrays, tree, bounds, area, degenerate, areas: OnceLock::new() }
    }

    /// The same mesh for another SIMD level.
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

    /// The nearest hit at the ray's time that follows the distance and triangle `after`.
    pub fn closest_after(&self, ray: &Ray, after: (f32, Option<u32>)) -> Option<TriangleHit> {
        match &self.tree {
            Tree::Still(bvh) => bvh.filtered(|_, hit| hit.is_after(after)).closest(ray),
            Tree::Moving(tree) => tree.closest_after(ray, after),
        }
    }

    /// Whether the ray hits anything at its time.
    pub fn any(&self, ray: &Ray) -> bool {
        match &self.tree {
            Tree::Still(bvh) => bvh.any(ray),
            Tree::Moving(tree) => tree.any(ray),
        }
    }

    /// Triangle at a time.
    pub fn triangle_geometry(&self, triangle: usize, time: f32) -> Option<TriangleGeometry> {
        match &self.tree {
            Tree::Still(_) => self.arrays.triangle_geometry(triangle),
            Tree::Moving(tree) => tree.triangle_geometry(triangle, time),
        }
    }

    /// Tangent at a time, as [`MeshData::tangent`].
    pub fn tangent(&self, triangle: usize, at: Vec2, time: f32) -> Option<(Vec3, f32)> {
        match &self.tree {
            Tree::Still(_) => self.arrays.tangent(triangle, at),
            Tree::Moving(tree) => tree.tangent(triangle, at, time),
        }
    }

    /// The hierarchy; `None` for a mesh that moves.
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

    /// Bounding box of all triangles that have an area, at all times.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Area of all triangles; the mean over time if they move.
    pub fn area(&self) -> f32 {
        match &self.tree {
            Tree::Still(_) => self.area as f32,
            Tree::Moving(_) => self.running_areas().last().map_or(0.0, |area| *area as f32),
        }
    }

    /// Number of triangles without area.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// Running sums of the triangles' areas, which are means over time if they move.
    pub fn running_areas(&self) -> &[f64] {
        self.areas.get_or_init(|| {
            let mut sum = 0.0;
            let area = |triangle| match &self.tree {
                Tree::Still(_) => self.arrays.triangle_geometry(triangle).map(|triangle| triangle.area()),
                Tree::Moving(tree) => tree.mean_area(triangle),
            };
            let running = (0..self.arrays.triangles.len()).filter_map(area).map(|area| {
                sum += area;
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
        let arrays: usize = std::iter::once(&*self.arrays).chain(later).map(MeshData::bytes).sum();
        size_of::<Self>() + arrays + size_of_val(self.areas.get().map_or(&[][..], Vec::as_slice))
    }
}

/// Validates the arrays; some triangle must have an area.
fn checked(data: &MeshData, control: &BuildControl) -> Result<MeshMeasures, InvalidShape> {
    control.check()?;
    data.check()?;
    control.check()?;
    let measures = MeshMeasures::from_data(data, control);
    control.check()?;
    if measures.degenerate == data.triangles.len() {
        let message = format!("`triangles` must have an area, but all {} are degenerate", measures.degenerate);
        return Err(invalid("triangles", message));
    }
    Ok(measures)
}

impl PartialEq for PreparedMesh {
    fn eq(&self, other: &Self) -> bool {
        let keys = |prepared: &Self| match &prepared.tree {
            Tree::Still(_) => Vec::new(),
            Tree::Moving(tree) => tree.keys().to_vec(),
        };
        self.arrays == other.arrays && keys(self) == keys(other)
    }
}

impl fmt::Debug for PreparedMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles", self.arrays.triangles.len())
    }
}
