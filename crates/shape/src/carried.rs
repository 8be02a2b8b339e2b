//! Where a point of a shape goes when the shape becomes another.

use super::AnyShape;
use super::facet::Facet;
use juggler_math::Vec3;

impl AnyShape {
    /// Where a point of it is, object space, when it has become `other`: spheres grow, triangles take their points along. `part`
    /// and `time` are those of the hit. Points of what is another kind or has other numbers stay.
    pub fn carried(&self, other: &Self, part: u32, point: Vec3, time: f32) -> Vec3 {
        let facets = match (self, other) {
            (Self::Sphere(here), Self::Sphere(there)) if here.radius != there.radius => {
                return point * (there.radius / here.radius);
            }
            (Self::Mesh(here), Self::Mesh(there)) => (here.facet(part, time), there.facet(part, time)),
            _ => return point,
        };
        let (Some(here), Some(there)) = facets else { return point };
        if here.corners == there.corners { point } else { carried(&here, &there, point) }
    }
}

/// A point of a triangle in another, at the same barycentrics.
fn carried(here: &Facet, there: &Facet, point: Vec3) -> Vec3 {
    let [a, b, c] = here.corners.map(|corner| corner.as_dvec3());
    let (normal, way) = (here.winding(), point.as_dvec3() - a);
    let square = normal.length_squared();
    if square == 0.0 {
        return point;
    }
    let (to_b, to_c) = (way.cross(c - a).dot(normal) / square, (b - a).cross(way).dot(normal) / square);
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
    fn points_keep_their_places_on_what_grows_and_bends() {
        let ball = |radius| AnyShape::from(Sphere { radius });
        let point = Vec3::new(0.0, 1.2, 1.6);
        assert!(close3(ball(2.0).carried(&ball(3.0), 0, point, 0.0), Vec3::new(0.0, 1.8, 2.4), 1e-6));
        assert_eq!(ball(2.0).carried(&ball(2.0), 0, point, 0.0), point);
        let (flat, bent) = (
            mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            mesh([[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 2.0, 5.0]]),
        );
        let found = flat.carried(&bent, 0, Vec3::new(0.25, 0.5, 0.0), 0.0);
        assert!(close3(found, Vec3::new(1.0, 1.0, 3.0), 1e-6), "{found}");
        assert_eq!(flat.carried(&flat, 0, point, 0.0), point);
        assert_eq!(flat.carried(&ball(1.0), 0, point, 0.0), point);
    }
}
