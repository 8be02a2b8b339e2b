//! Assembly of the arrays of a primitive: vertices, joints, morph targets and faces (glTF 2.0,
//! section 3.7.2).
//!
//! - Texture coordinates become (u, 1 - v): v points upwards here.
//! - Colors are clamped to 0..1; without alpha it is 1.
//! - Without normals, tangents are ignored. A zero normal stands for a missing one.
//! - Joint weights whose sum is off 1 by more than 1e-3 are divided by it.
//! - Strips and fans become separate triangles; faces with two equal corners are dropped.
//! - The order of vertices and faces is that of the file.

mod attributes;
mod draco;
mod faces;
mod joints;
#[cfg(test)]
mod tests;

pub use draco::{DracoArrays, DracoStream};
pub use faces::{Faces, compressed_triangles, points_and_lines};
pub use joints::JointSet;

use super::accessor::Elements;
use super::data::GltfData;
use super::document::{Attributes, Index, Mode, Primitive, Semantic};
use super::error::Fault;
use super::pose::{MorphDeltas, Vertices};
use super::warning::Warnings;

/// Arrays of a primitive. All arrays of vertices have the same length or are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PrimitiveArrays {
    /// Vertices in object space. Normals have any length.
    pub vertices: Vertices,
    /// Joints and weights of the vertices.
    pub joints: Vec<JointSet>,
    /// Displacements of the morph targets.
    pub targets: Vec<MorphDeltas>,
    /// Faces, whose indices are less than the number of vertices; at least one.
    pub faces: Faces,
    /// Warnings of the assembly.
    pub warnings: Warnings,
}

impl PrimitiveArrays {
    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        let joints = self.joints.iter().map(|set| size_of_val(&*set.joints) + size_of_val(&*set.weights));
        let targets = self.targets.iter().map(MorphDeltas::bytes);
        self.vertices.bytes() + joints.chain(targets).sum::<usize>() + self.faces.bytes()
    }
}

/// Result of the assembly of a primitive.
#[derive(Clone, Debug, PartialEq)]
pub enum Assembly<'a> {
    /// The arrays.
    Arrays(Box<PrimitiveArrays>),
    /// The primitive is left out; the warnings say why.
    LeftOut(Warnings),
    /// The primitive is compressed. [`GltfData::assemble_draco`] assembles it from decoded arrays.
    Draco(DracoStream<'a>),
}

/// What determines the arrays of a primitive. Primitives with equal keys have equal arrays.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct GeometryKey {
    attributes: Attributes,
    indices: Option<Index>,
    mode: Mode,
    targets: Vec<Attributes>,
    draco: Option<Index>,
}

impl GeometryKey {
    /// Key of a primitive.
    pub fn new(primitive: &Primitive) -> Self {
        Self {
            attributes: primitive.attributes.clone(),
            indices: primitive.indices,
            mode: primitive.mode,
            targets: primitive.targets.clone(),
            draco: primitive.extensions.draco.as_ref().map(|draco| draco.buffer_view),
        }
    }
}

impl GltfData {
    /// Assembles the arrays of a primitive of a mesh.
    ///
    /// # Errors
    ///
    /// An array is not valid, an index is not less than the number of vertices, or the limit of
    /// decoded bytes is exceeded.
    pub fn assemble(&self, mesh: usize, primitive: usize) -> Result<Assembly<'_>, Fault> {
        let assembler = Assembler::new(self, mesh, primitive, None)?;
        match &assembler.primitive.extensions.draco {
            Some(draco) => Ok(Assembly::Draco(DracoStream::new(self, draco)?)),
            None => assembler.assemble(),
        }
    }

    /// Assembles the arrays of a compressed primitive. `decoded` has the contents of its
    /// [`DracoStream`].
    ///
    /// # Errors
    ///
    /// As [`GltfData::assemble`]; also if a decoded array has not the length of its accessor.
    pub fn assemble_draco(&self, mesh: usize, primitive: usize, decoded: &DracoArrays) -> Result<Assembly<'_>, Fault> {
        Assembler::new(self, mesh, primitive, Some(decoded))?.assemble()
    }
}

/// Assembly of a primitive.
struct Assembler<'a> {
    data: &'a GltfData,
    primitive: &'a Primitive,
    /// JSON pointer of the primitive.
    pointer: String,
    /// Decoded arrays in place of those of the accessors.
    draco: Option<&'a DracoArrays>,
    warnings: Warnings,
}

impl<'a> Assembler<'a> {
    fn new(data: &'a GltfData, mesh: usize, primitive: usize, draco: Option<&'a DracoArrays>) -> Result<Self, Fault> {
        let pointer = format!("/meshes/{mesh}/primitives/{primitive}");
        let found = data.gltf.document.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(primitive));
        let found = found.ok_or_else(|| Fault::at(&pointer, "there is no such primitive"))?;
        Ok(Self { data, primitive: found, pointer, draco, warnings: Warnings::default() })
    }

    fn assemble<'r>(mut self) -> Result<Assembly<'r>, Fault> {
        let Some(vertices) = self.vertices()? else {
            return Ok(self.left_out("has no `POSITION` and is left out"));
        };
        let faces = match self.faces(vertices.positions.len())? {
            Ok(faces) => faces,
            Err(reason) => return Ok(self.left_out(reason)),
        };
        let joints = self.joints()?;
        let targets = self.targets(&vertices)?;
        Ok(Assembly::Arrays(Box::new(PrimitiveArrays { vertices, joints, targets, faces, warnings: self.warnings })))
    }

    fn left_out<'r>(mut self, reason: &str) -> Assembly<'r> {
        self.warn(reason, 1);
        Assembly::LeftOut(self.warnings)
    }

    fn warn(&mut self, text: impl std::fmt::Display, count: u64) {
        self.warnings.add(&self.pointer, text, count);
    }

    /// Elements of an attribute; `None` if the primitive lacks it.
    fn attribute(&self, semantic: &Semantic) -> Result<Option<Elements<'a>>, Fault> {
        let Some(index) = self.primitive.attributes.find(semantic) else { return Ok(None) };
        let decoded = self.draco.and_then(|arrays| arrays.attributes.get(semantic));
        let elements = match decoded {
            Some(bytes) => Elements::from_packed(self.data, index, bytes),
            None => Elements::new(self.data, index),
        };
        elements.map(Some)
    }
}
