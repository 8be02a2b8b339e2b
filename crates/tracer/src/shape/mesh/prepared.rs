//! A checked mesh with its hierarchy, shared by all clones.

use super::MeshData;
use crate::shape::{InvalidShape, check::invalid};
use juggler_bvh::{Quality, TriangleBvh};
use juggler_math::Aabb;
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

impl Prepared {
    /// Checks the arrays and builds the hierarchy.
    pub fn new(data: MeshData) -> Result<Self, InvalidShape> {
        data.check()?;
        let mut bounds = Aabb::EMPTY;
        let (mut area, mut degenerate) = (0.0, 0);
        for facet in (0..data.triangles.len()).filter_map(|triangle| data.facet(triangle)) {
            if facet.area() > 0.0 {
                area += facet.area();
                bounds = facet.corners.into_iter().fold(bounds, Aabb::with_point);
            } else {
                degenerate += 1;
            }
        }
        if degenerate == data.triangles.len() {
            let message = format!("`triangles` must have an area, but all {degenerate} are degenerate");
            return Err(invalid("triangles", message));
        }
        let bvh = TriangleBvh::build(&data.positions, &data.triangles, Quality::Balanced)
            .map_err(|error| invalid("triangles", error.to_string()))?;
        Ok(Self { data, bvh, bounds, area, degenerate, areas: OnceLock::new() })
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

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        let MeshData { positions, triangles, normals, uvs } = &self.data;
        let arrays = size_of_val(positions.as_slice()) + size_of_val(triangles.as_slice());
        let optional = size_of_val(normals.as_slice()) + size_of_val(uvs.as_slice());
        size_of::<Self>() + arrays + optional + self.bvh.bytes()
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
