//! JSON form of a mesh.

use super::{Mesh, MeshData, MorphTarget};
use crate::attribute::MeshAttribute;
use juggler_math::{Vec2, Vec3};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize, Serializer};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A triangle mesh, from a file or from the arrays given here. The corners of a triangle run
/// counter-clockwise seen from the front.
///
/// Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the corners of
/// each triangle.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "Mesh")]
pub struct MeshDescription {
    /// Model file (PLY, OBJ, STL), relative to the scene file, instead of the arrays below. A PLY
    /// file may have all of these arrays: attributes of its elements `vertex` and `face` are columns
    /// `attribute.NAME`, or `attribute.NAME.0` to `attribute.NAME.3` of several numbers per value, of
    /// type `uchar`, `ushort` or `float`.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// Corner positions in scene units.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>", extend("x-unit" = "scene units"))]
    positions: Vec<Vec3>,
    /// Three indices into `positions` for each triangle, counted from 0.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    triangles: Vec<[u32; 3]>,
    /// Shading normals, interpolated over each triangle: none, or one per position, of any length.
    /// A zero normal counts as missing. Without normals, `crease_angle_degrees` decides the
    /// shading.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>")]
    normals: Vec<Vec3>,
    /// Surface coordinates, interpolated over each triangle: none, or one per position.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 2]>")]
    uvs: Vec<Vec2>,
    /// Second set of surface coordinates, for textures with `uv_set` 1: none, or one per position.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 2]>")]
    uvs1: Vec<Vec2>,
    /// Tangents x, y, z of any length, along which normal maps and anisotropic highlights lie, and
    /// the sign of the bitangent, 1 or -1: none, or one per position. Without tangents they follow
    /// the surface coordinates. A zero tangent counts as missing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    tangents: Vec<[f32; 4]>,
    /// Named attributes of the vertices or triangles, such as `color`, for the texture `attribute`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    attributes: BTreeMap<String, MeshAttribute>,
    /// Largest angle between the normals of two neighboring triangles whose edge is shaded
    /// smoothly, in degrees, 0 to 180: 30 to 60 for machine parts, 180 for a wholly smooth surface.
    /// Without it, a mesh without `normals` is shaded flat. It has no effect on a mesh with
    /// `normals`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 180), extend("x-unit" = "degrees"))]
    crease_angle_degrees: Option<f32>,
    /// Morph targets (blend shapes), each added in proportion to its weight: position = base + Σ
    /// weight · (target - base).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    morphs: Vec<MorphTarget>,
}

impl From<MeshDescription> for Mesh {
    fn from(description: MeshDescription) -> Self {
        let MeshDescription { file, crease_angle_degrees, morphs, positions, triangles, normals, uvs, .. } =
            description;
        let MeshDescription { uvs1, tangents, attributes, .. } = description;
        let arrays = Arc::new(MeshData { positions, triangles, normals, uvs, uvs1, tangents, attributes });
        Self { file, arrays, crease_angle_degrees, morphs, ..Self::default() }
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

/// Mesh to be serialized. Morphs that are already blended into the arrays are left out.
#[derive(Serialize)]
#[serde(rename = "Mesh")]
struct SerializedMesh<'m> {
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
    #[serde(skip_serializing_if = "<[Vec2]>::is_empty")]
    uvs1: &'m [Vec2],
    #[serde(skip_serializing_if = "<[[f32; 4]]>::is_empty")]
    tangents: &'m [[f32; 4]],
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    attributes: &'m BTreeMap<String, MeshAttribute>,
    #[serde(skip_serializing_if = "Option::is_none")]
    crease_angle_degrees: Option<f32>,
    #[serde(skip_serializing_if = "<[MorphTarget]>::is_empty")]
    morphs: &'m [MorphTarget],
}

impl Serialize for Mesh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let MeshData { positions, triangles, normals, uvs, uvs1, tangents, attributes } = &*self.arrays;
        let blended = self.prepared.is_some() && !triangles.is_empty();
        SerializedMesh {
            file: self.file.as_deref(),
            positions,
            triangles,
            normals,
            uvs,
            uvs1,
            tangents,
            attributes,
            crease_angle_degrees: self.crease_angle_degrees,
            morphs: if blended { &[] } else { &self.morphs },
        }
        .serialize(serializer)
    }
}
