//! A mesh as JSON.

use super::{Mesh, MeshData, Morph};
use juggler_math::{Vec2, Vec3};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize, Serializer};
use std::borrow::Cow;
use std::sync::Arc;

/// A surface of triangles: from a file, or given here. Its front is where the corners of a triangle run
/// counter-clockwise.
///
/// Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the corners of each triangle.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "Mesh")]
pub struct MeshDescription {
    /// A model file (PLY, OBJ, STL), relative to the scene file, instead of the arrays below.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// Corner positions in scene units.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>")]
    positions: Vec<Vec3>,
    /// Three numbers a triangle, each the place of a corner in `positions`, counted from 0.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    triangles: Vec<[u32; 3]>,
    /// Shading normals, blended over each triangle: none, or one per position. A zero one counts as missing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>")]
    normals: Vec<Vec3>,
    /// Surface coordinates: none, or one per position.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 2]>")]
    uvs: Vec<Vec2>,
    /// Greatest angle between the normals of two neighboring triangles whose edge is shaded smoothly, in degrees, 0 to 180:
    /// 30 to 60 for machine parts, 180 for a wholly smooth surface. Without it a mesh without `normals` is shaded flat. It has
    /// no effect on a mesh with `normals`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 180))]
    crease_angle_degrees: Option<f32>,
    /// Other places that its corners go to, each as far as its weight says.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    morphs: Vec<Morph>,
}

impl From<MeshDescription> for Mesh {
    fn from(described: MeshDescription) -> Self {
        let MeshDescription { file, positions, triangles, normals, uvs, crease_angle_degrees, morphs } = described;
        let arrays = Arc::new(MeshData { positions, triangles, normals, uvs });
        Self { file, arrays, crease_angle_degrees, morphs, prepared: None }
    }
}

impl JsonSchema for Mesh {
    fn schema_name() -> Cow<'static, str> {
        MeshDescription::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        MeshDescription::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        MeshDescription::json_schema(generator)
    }
}

/// The same to be written. Morphs that have been blended into the arrays are left out.
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
        let MeshData { positions, triangles, normals, uvs } = &*self.arrays;
        let blended = self.prepared.is_some() && !triangles.is_empty();
        Written {
            file: self.file.as_deref(),
            positions,
            triangles,
            normals,
            uvs,
            crease_angle_degrees: self.crease_angle_degrees,
            morphs: if blended { &[] } else { &self.morphs },
        }
        .serialize(serializer)
    }
}
