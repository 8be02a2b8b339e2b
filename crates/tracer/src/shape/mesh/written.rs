//! A mesh as JSON: one that is prepared writes the arrays that it was prepared from, morphs blended in.

use super::{Mesh, Morph};
use juggler_math::{Vec2, Vec3};
use serde::{Serialize, Serializer};

#[derive(Serialize)]
#[serde(rename = "Mesh")]
struct Written<'m> {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'m str>,
    #[serde(skip_serializing_if = "<[Vec3]>::is_empty")]
    positions: &'m [Vec3],
    #[serde(skip_serializing_if = "<[[u32; 3]]>::is_empty")]
    triangles: &'m [[u32; 3]],
    #[serde(skip_serializing_if = "<[Vec3]>::is_empty")]
    normals: &'m [Vec3],
    #[serde(skip_serializing_if = "<[Vec2]>::is_empty")]
    uvs: &'m [Vec2],
    #[serde(skip_serializing_if = "Option::is_none")]
    crease_angle_degrees: Option<f32>,
    #[serde(skip_serializing_if = "<[Morph]>::is_empty")]
    morphs: &'m [Morph],
}

impl Serialize for Mesh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = Written {
            file: self.file.as_deref(),
            positions: &self.positions,
            triangles: &self.triangles,
            normals: &self.normals,
            uvs: &self.uvs,
            crease_angle_degrees: self.crease_angle_degrees,
            morphs: &self.morphs,
        };
        let written = match self.data().filter(|_| self.triangles.is_empty()) {
            // The arrays of a file are the file's.
            Some(data) if self.file.is_none() => Written {
                positions: &data.positions,
                triangles: &data.triangles,
                normals: &data.normals,
                uvs: &data.uvs,
                morphs: &[],
                ..own
            },
            _ => own,
        };
        written.serialize(serializer)
    }
}
