//! Emissive shapes as surfaces in world space that can be sampled by solid angle.

use juggler_light::emitter::{AreaEmitter, DiskEmitter, RectangleEmitter, SphereEmitter, TriangleEmitter};
use juggler_math::{Transform, Vec3};
use juggler_shape::{AnyShape, MeshData, SolidAngleShape};

/// Maximum number of triangles for a mesh that is sampled per surface. Larger ones are one emitter,
/// whose points are sampled by area.
const MAX_TRIANGLES: usize = 1 << 22;

/// Marks a triangle without area, which belongs to no surface.
pub const NO_SURFACE: u32 = u32::MAX;

/// Emissive surfaces of a shape.
pub struct EmissiveSurfaces {
    /// Surfaces that can be sampled by solid angle.
    pub surfaces: Vec<AreaEmitter>,
    /// Index of the surface of each triangle of a mesh; empty for other shapes.
    pub surface_indices: Vec<u32>,
}

impl EmissiveSurfaces {
    /// Splits a shape into surfaces; `None` if it can only be sampled as a whole.
    pub fn from_shape(shape: &AnyShape, transform: &Transform) -> Option<Self> {
        let one = |surface: AreaEmitter| Some(Self { surfaces: vec![surface], surface_indices: Vec::new() });
        if let Some(mesh) = shape.mesh() {
            return Self::from_mesh(mesh.data()?, transform);
        }
        match shape.solid_angle_shape()? {
            SolidAngleShape::Sphere { radius } => {
                let radius = radius * transform.uniform_scale()?;
                one(SphereEmitter::new(transform.origin(), radius)?.into())
            }
            SolidAngleShape::Disk { radius } => {
                let radius = radius * transform.uniform_scale()?;
                one(DiskEmitter::new(transform.origin(), transform.normal(Vec3::Y), radius)?.into())
            }
            SolidAngleShape::Rectangle { size } => one(rectangle_to_world(size, transform)?.into()),
            SolidAngleShape::Triangle { vertices } => {
                one(TriangleEmitter::new(corners_to_world(vertices, transform))?.into())
            }
        }
    }

    /// Splits a mesh. Two consecutive triangles that form a rectangle become one surface.
    fn from_mesh(mesh: &MeshData, transform: &Transform) -> Option<Self> {
        if mesh.triangles.len() > MAX_TRIANGLES {
            return None;
        }
        let (mut surfaces, mut surface_indices) = (Vec::new(), Vec::new());
        let corners = |triangle_index: usize| {
            let triangle =
                mesh.triangles.get(triangle_index)?.map(|corner| mesh.positions.get(corner as usize).copied());
            let [a, b, c] = triangle;
            Some(corners_to_world([a?, b?, c?], transform))
        };
        while let Some(triangle) = corners(surface_indices.len()) {
            let index = surfaces.len() as u32;
            if let Some(rectangle) = corners(surface_indices.len() + 1).and_then(|next| join_triangles(triangle, next))
            {
                surfaces.push(rectangle.into());
                surface_indices.extend([index, index]);
            } else if let Some(triangle) = TriangleEmitter::new(triangle) {
                surfaces.push(triangle.into());
                surface_indices.push(index);
            } else {
                surface_indices.push(NO_SURFACE);
            }
        }
        Some(Self { surfaces, surface_indices })
    }
}

/// Transforms the corners of a triangle to world space, in the order that keeps the front side in
/// front.
fn corners_to_world(corners: [Vec3; 3], transform: &Transform) -> [Vec3; 3] {
    let [a, b, c] = corners.map(|corner| transform.point(corner));
    // A reflection reverses the winding order but not the direction of normals.
    if transform.matrix().determinant() < 0.0 { [a, c, b] } else { [a, b, c] }
}

fn rectangle_to_world([width, depth]: [f32; 2], transform: &Transform) -> Option<RectangleEmitter> {
    let corner = transform.point(Vec3::new(-0.5 * width, 0.0, 0.5 * depth));
    let edges = [transform.vector(Vec3::X * width), transform.vector(Vec3::NEG_Z * depth)];
    let is_front = edges[0].cross(edges[1]).dot(transform.normal(Vec3::Y)) >= 0.0;
    RectangleEmitter::new(corner, if is_front { edges } else { [edges[1], edges[0]] })
}

/// Joins two triangles with a common longest side to a rectangle; `None` if they form none.
fn join_triangles(first: [Vec3; 3], second: [Vec3; 3]) -> Option<RectangleEmitter> {
    let at = first.iter().position(|corner| !second.contains(corner))?;
    let [next, last] = [first[(at + 1) % 3], first[(at + 2) % 3]];
    let across = *second.iter().find(|corner| !first.contains(corner))?;
    // The second triangle has the common side in the opposite direction.
    let other = second.iter().position(|corner| *corner == across)?;
    if (second[(other + 1) % 3], second[(other + 2) % 3]) != (last, next) {
        return None;
    }
    let edges = [next - first[at], last - first[at]];
    let size = edges[0].length() + edges[1].length();
    ((first[at] + edges[0] + edges[1]) - across).length().le(&(1e-6 * size)).then_some(())?;
    RectangleEmitter::new(first[at], edges)
}
