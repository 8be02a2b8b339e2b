//! Tangents of meshes that have none, by MikkTSpace (Mikkelsen, Simulation of Wrinkled Surfaces
//! Revisited, 2008), as glTF 2.0 demands (section 3.7.2.1).
//!
//! The surface coordinates have v upwards. The sign of the bitangent then is that of glTF.

use crate::gltf::pose::Vertices;
use crate::gltf::primitive::{Faces, PrimitiveArrays};
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use indexmap::IndexMap;
use juggler_math::{Vec2, Vec3, portable};

/// Tangents, with a vertex for each distinct tangent of a vertex of the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tangents {
    /// Vertex of the mesh that each vertex is a copy of.
    pub sources: Vec<u32>,
    /// Tangent of each vertex, with the sign of the bitangent.
    pub tangents: Vec<[f32; 4]>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Tangents {
    /// Values for each vertex, from those of the vertices of the mesh.
    pub fn of_sources<T: Clone>(&self, values: &[T]) -> Vec<T> {
        self.sources.iter().filter_map(|source| values.get(*source as usize).cloned()).collect()
    }
}

/// Adds tangents to a primitive of triangles that has normals and none, along a set of texture
/// coordinates. Vertices with several tangents are divided.
pub fn add_tangents(arrays: &mut PrimitiveArrays, set: u32) {
    let Vertices { positions, normals, tangents: known, texcoords, .. } = &arrays.vertices;
    let (Faces::Triangles(triangles), Some(uvs), true) =
        (&arrays.faces, texcoords.get(set as usize), known.is_empty() && !normals.is_empty())
    else {
        return;
    };
    let Some(made) = tangents(positions, normals, uvs, triangles) else { return };
    let vertices = &arrays.vertices;
    arrays.vertices = Vertices {
        positions: made.of_sources(&vertices.positions),
        normals: made.of_sources(&vertices.normals),
        texcoords: vertices.texcoords.iter().map(|set| made.of_sources(set)).collect(),
        colors: made.of_sources(&vertices.colors),
        tangents: made.tangents.clone(),
    };
    for set in &mut arrays.joints {
        (set.joints, set.weights) = (made.of_sources(&set.joints), made.of_sources(&set.weights));
    }
    for target in &mut arrays.targets {
        target.positions = made.of_sources(&target.positions);
        target.normals = made.of_sources(&target.normals);
        target.colors = made.of_sources(&target.colors);
        target.texcoords.iter_mut().for_each(|set| *set = made.of_sources(set));
    }
    arrays.faces = Faces::Triangles(made.triangles);
}

/// Computes tangents. `None` if the numbers of normals or coordinates differ from that of positions,
/// or a triangle has a vertex that does not exist.
pub fn tangents(positions: &[Vec3], normals: &[Vec3], uvs: &[Vec2], triangles: &[[u32; 3]]) -> Option<Tangents> {
    let count = positions.len();
    let has_all = triangles.iter().flatten().all(|vertex| (*vertex as usize) < count);
    if normals.len() != count || uvs.len() != count || !has_all {
        return None;
    }
    let corners = vec![[[1.0, 0.0, 0.0, 1.0]; 3]; triangles.len()];
    let mut mesh = Corners { positions, normals, uvs, triangles, corners };
    generate_tangents::<_, Portable>(&mut mesh).ok()?;
    weld(triangles, &mesh.corners)
}

/// Joins the corners of a vertex that have the same tangent. The first tangent of each vertex keeps
/// the vertex's number.
fn weld(triangles: &[[u32; 3]], corners: &[[[f32; 4]; 3]]) -> Option<Tangents> {
    let mut vertices: IndexMap<(u32, [u32; 4]), u32> = IndexMap::new();
    let mut welded = Tangents::default();
    for (triangle, corners) in triangles.iter().zip(corners) {
        let mut joined = [0; 3];
        for (joined, (source, tangent)) in joined.iter_mut().zip(triangle.iter().zip(corners)) {
            let next = u32::try_from(welded.sources.len()).ok()?;
            *joined = *vertices.entry((*source, tangent.map(f32::to_bits))).or_insert(next);
            if *joined == next {
                welded.sources.push(*source);
                welded.tangents.push(*tangent);
            }
        }
        welded.triangles.push(joined);
    }
    Some(welded)
}

/// Functions with the same bits on every platform.
struct Portable;

impl Ops for Portable {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        portable::acos_f64(f64::from(x)) as f32
    }
}

/// A mesh with the tangents of its corners.
struct Corners<'m> {
    positions: &'m [Vec3],
    normals: &'m [Vec3],
    uvs: &'m [Vec2],
    triangles: &'m [[u32; 3]],
    corners: Vec<[[f32; 4]; 3]>,
}

impl Corners<'_> {
    /// Value of a corner.
    fn at<T: Copy + Default>(&self, values: &[T], face: usize, corner: usize) -> T {
        let vertex = self.triangles.get(face).and_then(|triangle| triangle.get(corner));
        vertex.and_then(|vertex| values.get(*vertex as usize)).copied().unwrap_or_default()
    }
}

impl Geometry<Portable> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.at(self.positions, face, corner).to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.at(self.normals, face, corner).to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.at(self.uvs, face, corner).to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let place = self.corners.get_mut(face).and_then(|corners| corners.get_mut(corner));
        if let Some((place, space)) = place.zip(space) {
            *place = space.tangent_encoded();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn of_square(uv: impl Fn(Vec3) -> Vec2) -> Tangents {
        tangents(&SQUARE, &[Vec3::Z; 4], &SQUARE.map(uv), &TRIANGLES).unwrap()
    }

    #[test]
    fn tangent_follows_u_and_sign_tells_mirrored_coordinates() {
        let plain = of_square(|p| Vec2::new(p.x, p.y));
        assert_eq!(plain.tangents, [[1.0, 0.0, 0.0, 1.0]; 4]);
        assert_eq!((plain.sources.as_slice(), plain.triangles.as_slice()), (&[0, 1, 2, 3][..], &TRIANGLES[..]));
        let mirrored = of_square(|p| Vec2::new(1.0 - p.x, p.y));
        assert_eq!(mirrored.tangents, [[-1.0, 0.0, 0.0, -1.0]; 4]);
        let turned = of_square(|p| Vec2::new(p.y, -p.x));
        assert!(turned.tangents.iter().all(|tangent| *tangent == [0.0, 1.0, 0.0, 1.0]), "{turned:?}");
    }

    #[test]
    fn vertex_between_mirrored_halves_becomes_two() {
        // The right triangle continues the left one with mirrored u.
        let positions = [Vec3::NEG_X, Vec3::ZERO, Vec3::Y, Vec3::X];
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::ZERO];
        let split = tangents(&positions, &[Vec3::Z; 4], &uvs, &[[0, 1, 2], [1, 3, 2]]).unwrap();
        assert_eq!(split.sources, [0, 1, 2, 1, 3, 2]);
        assert_eq!(split.triangles, [[0, 1, 2], [3, 4, 5]]);
        assert!(split.tangents.iter().take(3).all(|tangent| tangent[0] > 0.5 && tangent[3] == 1.0), "{split:?}");
        assert!(split.tangents.iter().skip(3).all(|tangent| tangent[0] < -0.5 && tangent[3] == -1.0), "{split:?}");
        assert_eq!(split.of_sources(&["a", "b", "c", "d"]), ["a", "b", "c", "b", "d", "c"]);
    }

    #[test]
    fn incomplete_meshes_have_no_tangents() {
        assert_eq!(tangents(&SQUARE, &[Vec3::Z; 3], &[Vec2::ZERO; 4], &TRIANGLES), None);
        assert_eq!(tangents(&SQUARE, &[Vec3::Z; 4], &[Vec2::ZERO; 4], &[[0, 1, 4]]), None);
        assert_eq!(tangents(&[], &[], &[], &[]), Some(Tangents::default()));
        // Coordinates without extent: any tangent, but a finite one.
        let flat = of_square(|_| Vec2::ZERO);
        assert!(flat.tangents.iter().flatten().all(|number| number.is_finite()), "{flat:?}");
    }
}
