//! A checked mesh with its hierarchy, shared by all clones.

use super::MeshData;
use crate::shape::{InvalidShape, check::invalid};
use juggler_bvh::{Quality, SimdLevel, TriangleBvh};
use juggler_math::Aabb;
use rayon::prelude::*;
use std::fmt;
use std::sync::OnceLock;

/// A checked mesh with its hierarchy.
pub struct Prepared {
    data: MeshData,
    bvh: TriangleBvh,
    bounds: Aabb,
    area: f64,
    /// Triangles without area.
    degenerate: usize,
    /// Running sums of the triangles' areas, made when the mesh is first sampled: few meshes are lamps.
    areas: OnceLock<Vec<f64>>,
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
    pub fn new(data: MeshData) -> Result<Self, InvalidShape> {
        data.check()?;
        let Extent { bounds, area, degenerate } = Extent::of(&data);
        if degenerate == data.triangles.len() {
            let message = format!("`triangles` must have an area, but all {degenerate} are degenerate");
            return Err(invalid("triangles", message));
        }
        let bvh = TriangleBvh::build(&data.positions, &data.triangles, Quality::Balanced)
            .map_err(|error| invalid("triangles", error.to_string()))?;
        Ok(Self { data, bvh, bounds, area, degenerate, areas: OnceLock::new() })
    }

    /// The same for another vector unit.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let bvh = self.bvh.clone().with_simd_level(level);
        Self { data: self.data.clone(), bvh, areas: OnceLock::new(), ..*self }
    }

    /// The arrays.
    pub fn data(&self) -> &MeshData {
        &self.data
    }

    /// The hierarchy.
    pub fn bvh(&self) -> &TriangleBvh {
        &self.bvh
    }

    /// A box around every triangle that has an area.
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
            let facets = (0..self.data.triangles.len()).filter_map(|triangle| self.data.facet(triangle));
            let running = facets.map(|facet| {
                sum += facet.area();
                sum
            });
            running.collect()
        })
    }

    /// Bytes on the heap without the hierarchy.
    pub fn heap_bytes(&self) -> usize {
        let MeshData { positions, triangles, normals, uvs } = &self.data;
        let arrays = size_of_val(positions.as_slice()) + size_of_val(triangles.as_slice());
        let optional = size_of_val(normals.as_slice()) + size_of_val(uvs.as_slice());
        size_of::<Self>() + arrays + optional + size_of_val(self.areas.get().map_or(&[][..], Vec::as_slice))
    }
}

impl PartialEq for Prepared {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data
    }
}

impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles", self.data.triangles.len())
    }
}
