//! From what a reader collected to a mesh: polygons cut, missing normals and surface coordinates settled.

use super::Imported;
use super::error::Fault;
use super::faces::Faces;
use juggler_math::{Vec2, Vec3};
use juggler_shape::MeshData;

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
    pub fn assemble(self) -> Result<Imported, Fault> {
        let mut warnings = self.warnings;
        let triangles = self.faces.settle(&self.positions, &mut warnings);
        if triangles.is_empty() {
            let note = if warnings.is_empty() { String::new() } else { format!(" ({})", warnings.join("; ")) };
            return Err(Fault::NoTriangles { note });
        }
        let normals = settle_normals(self.normals, &mut warnings);
        let mesh = MeshData { positions: self.positions, triangles, normals, uvs: self.uvs };
        Ok(Imported { mesh, warnings })
    }
}

/// Normals that are not finite become zero, which means none; when none is left there are no normals at all.
fn settle_normals(mut normals: Vec<Vec3>, warnings: &mut Vec<String>) -> Vec<Vec3> {
    for normal in normals.iter_mut().filter(|normal| !normal.is_finite()) {
        *normal = Vec3::ZERO;
    }
    let missing = normals.iter().filter(|normal| **normal == Vec3::ZERO).count();
    if missing == normals.len() {
        return Vec::new();
    }
    if missing > 0 {
        warnings.push(format!("{missing} vertices have no normal and are shaded flat"));
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::super::Limits;
    use super::*;

    fn triangle(normals: [Vec3; 3]) -> Imported {
        let mut faces = Faces::default();
        faces.push_triangle([0, 1, 2], &Limits::default()).unwrap();
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        Parts { positions, normals: normals.to_vec(), faces, ..Parts::default() }.assemble().unwrap()
    }

    #[test]
    fn complete_normals_stay_and_useless_ones_go() {
        let tilted = Vec3::new(0.0, 3.0, 4.0);
        assert_eq!(triangle([tilted; 3]).mesh.normals, [tilted; 3]);
        let none = triangle([Vec3::ZERO, Vec3::NAN, Vec3::INFINITY]);
        assert!(none.mesh.normals.is_empty() && none.warnings.is_empty());
        let part = triangle([tilted, Vec3::NAN, Vec3::ZERO]);
        assert_eq!(part.mesh.normals, [tilted, Vec3::ZERO, Vec3::ZERO]);
        assert_eq!(part.warnings, ["2 vertices have no normal and are shaded flat"]);
    }

    #[test]
    fn nothing_to_show_is_a_fault_that_says_what_was_left_out() {
        let mut parts = Parts { warnings: vec!["2 lines".into()], ..Parts::default() };
        parts.faces.push(&[1], &Limits::default()).unwrap();
        let fault = parts.assemble().unwrap_err();
        assert_eq!(fault.to_string(), "holds no triangle (2 lines; 1 faces with fewer than 3 corners left out)");
    }
}
