//! Reprojection of a point of a shape from one frame to another.

use super::AnyShape;
use super::triangle_geometry::TriangleGeometry;
use juggler_math::Vec3;

impl AnyShape {
    /// Position of `point`, object space, once the shape has become `other`: spheres scale,
    /// triangles keep the barycentrics of their points. `primitive` and `time` are those of the
    /// hit. The point stays if the kind or other parameters of the shape differ.
    pub fn reproject(&self, other: &Self, primitive: u32, point: Vec3, time: f32) -> Vec3 {
        let triangles = match (self, other) {
            (Self::Sphere(here), Self::Sphere(there)) if here.radius != there.radius => {
                return point * (there.radius / here.radius);
            }
            (Self::Mesh(here), Self::Mesh(there)) => {
                (here.triangle_geometry(primitive, time), there.triangle_geometry(primitive, time))
            }
            _ => return point,
        };
        let (Some(here), Some(there)) = triangles else { return point };
        if here.corners == there.corners { point } else { reproject(&here, &there, point) }
    }
}

/// Moves a point of a triangle to the same barycentrics of another.
fn reproject(here: &TriangleGeometry, there: &TriangleGeometry, point: Vec3) -> Vec3 {
    let [a, b, c] = here.corners.map(|corner| corner.as_dvec3());
    let (normal, offset) = (here.area_normal(), point.as_dvec3() - a);
    let square = normal.length_squared();
    if square == 0.0 {
        return point;
    }
    let (to_b, to_c) = (offset.cross(c - a).dot(normal) / square, (b - a).cross(offset).dot(normal) / square);
    let [a, b, c] = there.corners.map(|corner| corner.as_dvec3());
    (a + (b - a) * to_b + (c - a) * to_c).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh, MeshData, Shape, Sphere};
    use juggler_math::testing::close3;

    fn mesh(positions: [[f32; 3]; 3]) -> AnyShape {
        let positions = positions.map(Vec3::from).to_vec();
        let mut mesh = Mesh::from(MeshData { positions, triangles: vec![[0, 1, 2]], ..MeshData::default() });
        mesh.prepare().unwrap();
        mesh.into()
    }

    #[test]
    fn points_keep_their_barycentrics_on_deforming_shapes() {
        let sphere = |radius| AnyShape::from(Sphere { radius });
        let point = Vec3::new(0.0, 1.2, 1.6);
        assert!(close3(sphere(2.0).reproject(&sphere(3.0), 0, point, 0.0), Vec3::new(0.0, 1.8, 2.4), 1e-6));
        assert_eq!(sphere(2.0).reproject(&sphere(2.0), 0, point, 0.0), point);
        let (flat, bent) = (
            mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            mesh([[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 2.0, 5.0]]),
        );
        let found = flat.reproject(&bent, 0, Vec3::new(0.25, 0.5, 0.0), 0.0);
        assert!(close3(found, Vec3::new(1.0, 1.0, 3.0), 1e-6), "{found}");
        assert_eq!(flat.reproject(&flat, 0, point, 0.0), point);
        assert_eq!(flat.reproject(&sphere(1.0), 0, point, 0.0), point);
    }
}
