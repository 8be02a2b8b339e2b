//! Shapes that shine as surfaces that can be sampled by solid angle, in the world's space.

use juggler_light::emitter::{AreaEmitter, DiskEmitter, RectangleEmitter, SphereEmitter, TriangleEmitter};
use juggler_math::{Transform, Vec3};
use juggler_shape::{AnyShape, Disk, MeshData, Rectangle};

/// Meshes of more triangles than this shine as a whole, their places picked by area.
const MOST_TRIANGLES: usize = 1 << 22;

/// A part that belongs to no surface: it has no area.
pub const NOWHERE: u32 = u32::MAX;

/// The surfaces of a shape.
pub struct Areas {
    /// Each of them.
    pub surfaces: Vec<AreaEmitter>,
    /// Of each part of the shape (a triangle of a mesh) which surface it belongs to; nothing where there is only one.
    pub parts: Vec<u32>,
}

impl Areas {
    /// Of a shape in its place; `None` for one that must be sampled as it is.
    pub fn of(shape: &AnyShape, transform: &Transform) -> Option<Self> {
        let one = |surface: AreaEmitter| Some(Self { surfaces: vec![surface], parts: Vec::new() });
        match shape {
            AnyShape::Sphere(sphere) => {
                let radius = sphere.radius * transform.uniform_scale()?;
                one(SphereEmitter::new(transform.origin(), radius)?.into())
            }
            AnyShape::Disk(Disk { radius, inner_radius: 0.0 }) => {
                let radius = radius * transform.uniform_scale()?;
                one(DiskEmitter::new(transform.origin(), transform.normal(Vec3::Y), radius)?.into())
            }
            AnyShape::Rectangle(rectangle) => one(placed(rectangle, transform)?.into()),
            AnyShape::Triangle(triangle) => one(TriangleEmitter::new(turned(triangle.vertices, transform))?.into()),
            AnyShape::Mesh(mesh) => Self::of_mesh(mesh.data()?, transform),
            _ => None,
        }
    }

    /// Pairs of triangles in a row that make a rectangle are one surface.
    fn of_mesh(mesh: &MeshData, transform: &Transform) -> Option<Self> {
        if mesh.triangles.len() > MOST_TRIANGLES {
            return None;
        }
        let (mut surfaces, mut parts) = (Vec::new(), Vec::new());
        let corners = |part: usize| {
            let triangle = mesh.triangles.get(part)?.map(|corner| mesh.positions.get(corner as usize).copied());
            let [a, b, c] = triangle;
            Some(turned([a?, b?, c?], transform))
        };
        while let Some(triangle) = corners(parts.len()) {
            let number = surfaces.len() as u32;
            if let Some(rectangle) = corners(parts.len() + 1).and_then(|next| rectangle(triangle, next)) {
                surfaces.push(rectangle.into());
                parts.extend([number, number]);
            } else if let Some(triangle) = TriangleEmitter::new(triangle) {
                surfaces.push(triangle.into());
                parts.push(number);
            } else {
                parts.push(NOWHERE);
            }
        }
        Some(Self { surfaces, parts })
    }
}

/// Corners in the world, in the order in which the front is seen there.
fn turned(corners: [Vec3; 3], transform: &Transform) -> [Vec3; 3] {
    let [a, b, c] = corners.map(|corner| transform.point(corner));
    // A transform that mirrors turns corners round, and leaves normals where they are.
    if transform.matrix().determinant() < 0.0 { [a, c, b] } else { [a, b, c] }
}

fn placed(rectangle: &Rectangle, transform: &Transform) -> Option<RectangleEmitter> {
    let [width, depth] = rectangle.size;
    let corner = transform.point(Vec3::new(-0.5 * width, 0.0, 0.5 * depth));
    let edges = [transform.vector(Vec3::X * width), transform.vector(Vec3::NEG_Z * depth)];
    let facing = edges[0].cross(edges[1]).dot(transform.normal(Vec3::Y)) >= 0.0;
    RectangleEmitter::new(corner, if facing { edges } else { [edges[1], edges[0]] })
}

/// The rectangle that two triangles make which share their longest side, `None` if they do not.
fn rectangle(first: [Vec3; 3], second: [Vec3; 3]) -> Option<RectangleEmitter> {
    let at = first.iter().position(|corner| !second.contains(corner))?;
    let [next, last] = [first[(at + 1) % 3], first[(at + 2) % 3]];
    let across = *second.iter().find(|corner| !first.contains(corner))?;
    // The other one runs along the shared side the other way.
    let other = second.iter().position(|corner| *corner == across)?;
    if (second[(other + 1) % 3], second[(other + 2) % 3]) != (last, next) {
        return None;
    }
    let edges = [next - first[at], last - first[at]];
    let size = edges[0].length() + edges[1].length();
    ((first[at] + edges[0] + edges[1]) - across).length().le(&(1e-6 * size)).then_some(())?;
    RectangleEmitter::new(first[at], edges)
}
