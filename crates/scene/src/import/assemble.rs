//! From what a reader collected to a mesh: polygons cut, missing normals and surface coordinates settled.

use super::error::Fault;
use super::faces::Faces;
use super::{Imported, Limits};
use juggler_math::{Vec2, Vec3};
use juggler_tracer::shape::MeshData;

/// What a reader collected. Indices of `faces` are in range.
#[derive(Default)]
pub(super) struct Parts {
    /// Finite positions.
    pub positions: Vec<Vec3>,
    /// None at all, or one per position; one that is zero or not finite counts as missing.
    pub normals: Vec<Vec3>,
    /// None at all, or one per position.
    pub uvs: Vec<Vec2>,
    /// The faces.
    pub faces: Faces,
    /// What was left out, in words.
    pub warnings: Vec<String>,
}

impl Parts {
    /// The mesh.
    pub fn assemble(self, limits: &Limits) -> Result<Imported, Fault> {
        let mut warnings = self.warnings;
        let triangles = self.faces.settle(&self.positions, &mut warnings);
        if triangles.is_empty() {
            let note = if warnings.is_empty() { String::new() } else { format!(" ({})", warnings.join("; ")) };
            return Err(Fault::NoTriangles { note });
        }
        let mut mesh = MeshData { positions: self.positions, triangles, normals: self.normals, uvs: self.uvs };
        let usable = mesh.normals.iter().filter(|normal| is_direction(**normal)).count();
        if usable == 0 {
            mesh.normals = Vec::new();
        } else if usable < mesh.normals.len() {
            let flat = flatten(&mut mesh, limits)?;
            if flat > 0 {
                warnings.push(format!("{flat} triangles have no usable normals and are shaded flat"));
            }
        }
        Ok(Imported { mesh, warnings })
    }
}

fn is_direction(normal: Vec3) -> bool {
    normal.is_finite() && normal != Vec3::ZERO
}

/// Gives each triangle with a missing normal three vertices of its own, with the triangle's normal.
/// Returns how many there were.
fn flatten(mesh: &mut MeshData, limits: &Limits) -> Result<u64, Fault> {
    let mut count = 0;
    for triangle in &mut mesh.triangles {
        let old = triangle.map(|corner| corner as usize);
        let lacks = |index: &usize| mesh.normals.get(*index).is_none_or(|normal| !is_direction(*normal));
        if !old.iter().any(lacks) {
            continue;
        }
        count += 1;
        let corners = old.map(|index| mesh.positions.get(index).copied().unwrap_or_default());
        let normal = flat_normal(corners);
        for ((corner, position), index) in triangle.iter_mut().zip(corners).zip(old) {
            *corner = limits.next_vertex(mesh.positions.len())?;
            mesh.positions.push(position);
            mesh.normals.push(normal);
            if let Some(uv) = mesh.uvs.get(index).copied() {
                mesh.uvs.push(uv);
            }
        }
    }
    // Vertices that no triangle uses any more must not carry a length of zero either.
    for normal in mesh.normals.iter_mut().filter(|normal| !is_direction(**normal)) {
        *normal = Vec3::Y;
    }
    Ok(count)
}

/// Unit normal of a triangle; upwards when it has none.
fn flat_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let [a, b, c] = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
    (b - a).cross(c - a).try_normalize().map_or(Vec3::Y, |normal| normal.as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::vec3;

    fn two_triangles(normals: Vec<Vec3>) -> Parts {
        let limits = Limits::default();
        let mut faces = Faces::default();
        faces.push_triangle([0, 1, 2], &limits).unwrap();
        faces.push_triangle([0, 2, 3], &limits).unwrap();
        let positions = vec![Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), Vec3::Y];
        let uvs = positions.iter().map(|p| p.truncate()).collect();
        Parts { positions, normals, uvs, faces, warnings: Vec::new() }
    }

    #[test]
    fn complete_normals_stay_and_useless_ones_go() {
        let tilted = vec3(0.0, 3.0, 4.0);
        let kept = two_triangles(vec![tilted; 4]).assemble(&Limits::default()).unwrap();
        assert_eq!(kept.mesh.normals, [tilted; 4]);
        let none = two_triangles(vec![Vec3::ZERO, Vec3::NAN, Vec3::ZERO, Vec3::INFINITY]);
        let none = none.assemble(&Limits::default()).unwrap();
        assert!(none.mesh.normals.is_empty() && none.warnings.is_empty());
    }

    #[test]
    fn a_triangle_without_normals_is_split_off_and_flat() {
        let tilted = vec3(0.0, 0.6, 0.8);
        let parts = two_triangles(vec![tilted, tilted, tilted, Vec3::NAN]);
        let Imported { mesh, warnings } = parts.assemble(&Limits::default()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [4, 5, 6]]);
        assert_eq!(mesh.positions[4..], [Vec3::ZERO, vec3(1.0, 1.0, 0.0), Vec3::Y]);
        assert_eq!(mesh.normals, [tilted, tilted, tilted, Vec3::Y, Vec3::Z, Vec3::Z, Vec3::Z]);
        assert_eq!(mesh.uvs[4..], [Vec2::ZERO, Vec2::ONE, Vec2::Y]);
        assert_eq!(warnings, ["1 triangles have no usable normals and are shaded flat"]);
        let tight = Limits { vertices: 6, ..Limits::default() };
        let parts = two_triangles(vec![tilted, tilted, tilted, Vec3::NAN]);
        assert!(matches!(parts.assemble(&tight), Err(Fault::TooMany { quantity: "vertices", found: 7, .. })));
    }

    #[test]
    fn nothing_to_show_is_a_fault_that_says_what_was_left_out() {
        let mut parts = Parts { warnings: vec!["2 lines".into()], ..Parts::default() };
        parts.faces.push(&[1], &Limits::default()).unwrap();
        let fault = parts.assemble(&Limits::default()).unwrap_err();
        assert_eq!(fault.to_string(), "holds no triangle (2 lines; 1 faces with fewer than 3 corners left out)");
    }
}
