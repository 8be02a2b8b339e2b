//! Meshes and their primitives (glTF 2.0, section 3.7), Draco compression
//! (KHR_draco_mesh_compression) and variants of materials (KHR_materials_variants).

use super::attributes::Attributes;
use super::number::Index;
use serde::Deserialize;

/// A mesh.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Mesh {
    /// Parts of the mesh, each with one material.
    pub primitives: Vec<Primitive>,
    /// Default weights of the morph targets.
    #[serde(default)]
    pub weights: Vec<f64>,
    /// Name for people.
    pub name: Option<String>,
}

impl Mesh {
    /// Number of morph targets.
    pub fn targets(&self) -> usize {
        self.primitives.first().map_or(0, |primitive| primitive.targets.len())
    }
}

/// Part of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Primitive {
    /// Accessors of the vertex attributes.
    pub attributes: Attributes,
    /// Accessor of the vertex indices; without, the vertices are in order.
    pub indices: Option<Index>,
    /// Index of the material; without, the default material.
    pub material: Option<Index>,
    /// Topology.
    #[serde(default)]
    pub mode: Mode,
    /// Morph targets: accessors of displacements.
    #[serde(default)]
    pub targets: Vec<Attributes>,
    /// Extensions.
    #[serde(default)]
    pub extensions: PrimitiveExtensions,
}

/// Topology of a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(try_from = "Index")]
pub enum Mode {
    /// Points.
    Points,
    /// Separate line segments.
    Lines,
    /// A closed line.
    LineLoop,
    /// A line.
    LineStrip,
    /// Separate triangles.
    #[default]
    Triangles,
    /// A strip of triangles; each shares an edge with the triangle before it.
    TriangleStrip,
    /// Triangles around the first vertex.
    TriangleFan,
}

impl Mode {
    /// All modes, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::Points,
        Self::Lines,
        Self::LineLoop,
        Self::LineStrip,
        Self::Triangles,
        Self::TriangleStrip,
        Self::TriangleFan,
    ];
}

impl TryFrom<Index> for Mode {
    type Error = String;

    fn try_from(number: Index) -> Result<Self, String> {
        let mode = Self::ALL.get(number.get()).copied();
        mode.ok_or_else(|| format!("there is no mode {number}, expected 0 to 6"))
    }
}

/// Extensions of a primitive.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct PrimitiveExtensions {
    /// Compressed attributes and indices.
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub draco: Option<Box<DracoExtension>>,
    /// Materials of variants.
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Option<Box<VariantMappings>>,
}

/// Compressed attributes and indices of a primitive.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct DracoExtension {
    /// Index of the buffer view of the compressed data.
    pub buffer_view: Index,
    /// Identifiers of the attributes in the compressed data.
    pub attributes: Attributes,
}

/// Materials of a primitive in the variants of the document.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct VariantMappings {
    /// The materials.
    pub mappings: Vec<VariantMapping>,
}

/// Material of a primitive in some variants.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct VariantMapping {
    /// Indices of the variants.
    pub variants: Vec<Index>,
    /// Index of the material.
    pub material: Index,
}
