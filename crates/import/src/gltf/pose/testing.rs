//! Random inputs of tests.

use super::Vertices;
use glam::{DAffine3, DQuat, DVec3};
use juggler_math::testing::Random;
use juggler_math::{Vec2, Vec3, quaternion};

/// A uniform number in [low, high), in double precision.
pub fn random_f64(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * ((random.bits64() >> 11) as f64 / (1_u64 << 53) as f64)
}

/// A vector in the cube of half edge `radius`.
pub fn random_vector(random: &mut Random, radius: f64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| random_f64(random, -radius, radius)))
}

/// A unit quaternion.
pub fn random_rotation(random: &mut Random) -> DQuat {
    let axis = random.unit_vector().as_dvec3();
    quaternion::from_axis_degrees(axis, random_f64(random, -180.0, 180.0)).unwrap()
}

/// An affine map with shear whose determinant exceeds 0.2; half of the maps are reflections.
pub fn random_affine(random: &mut Random) -> DAffine3 {
    loop {
        let [x, y, z] = [(); 3].map(|()| random_vector(random, 1.5));
        let map = DAffine3::from_cols(x, y, z, random_vector(random, 5.0));
        if map.matrix3.determinant().abs() > 0.2 {
            return map;
        }
    }
}

/// Largest distance between elements of two maps.
pub fn difference(a: &DAffine3, b: &DAffine3) -> f64 {
    let (a, b) = (a.to_cols_array(), b.to_cols_array());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Height z = f(x, y) over a grid of `cells` × `cells` squares of the unit square, with two
/// triangles each, without normals.
pub fn height_field(cells: u32, height: impl Fn(f64, f64) -> f64) -> (Vertices, Vec<[u32; 3]>) {
    let mut vertices = Vertices::default();
    let mut triangles = Vec::new();
    for row in 0..=cells {
        for column in 0..=cells {
            let [x, y] = [column, row].map(|i| f64::from(i) / f64::from(cells));
            vertices.positions.push(DVec3::new(x, y, height(x, y)).as_vec3());
            if row < cells && column < cells {
                let corner = row * (cells + 1) + column;
                let [right, above] = [corner + 1, corner + cells + 1];
                triangles.extend([[corner, right, above], [right, above + 1, above]]);
            }
        }
    }
    (vertices, triangles)
}

/// Vertices with random attributes: unit normals, unit tangents, two sets of texture coordinates,
/// and colors.
pub fn random_vertices(random: &mut Random, count: usize) -> Vertices {
    let mut vertices = Vertices { texcoords: vec![Vec::new(); 2], ..Vertices::default() };
    for _ in 0..count {
        vertices.positions.push(random.point(2.0));
        vertices.normals.push(random.unit_vector());
        let [x, y, z] = random.unit_vector().to_array();
        vertices.tangents.push([x, y, z, if random.f32() < 0.5 { -1.0 } else { 1.0 }]);
        vertices.texcoords.iter_mut().for_each(|set| set.push(Vec2::new(random.f32(), random.f32())));
        vertices.colors.push([(); 4].map(|()| random.f32()));
    }
    vertices
}

/// Whether two vectors differ by no more than a few roundings to single precision.
pub fn is_rounded(found: Vec3, exact: DVec3) -> bool {
    (found.as_dvec3() - exact).abs().max_element() <= 1e-7 * exact.abs().max_element().max(1e-3)
}
