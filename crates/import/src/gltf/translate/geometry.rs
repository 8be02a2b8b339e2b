//! Meshes of primitives. Each distinct primitive is decoded once for all nodes, times and copies of
//! a scene.

use crate::gltf::data::GltfData;
use crate::gltf::document::{Primitive, Semantic};
use crate::gltf::draco::{self, DracoAttribute};
use crate::gltf::error::Fault;
use crate::gltf::pose::Vertices;
use crate::gltf::primitive::{Assembly, DracoArrays, DracoStream, Faces, GeometryKey, PrimitiveArrays};
use crate::gltf::warning::Warnings;
use juggler_shape::{Mesh, MeshData};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A decoded primitive.
#[derive(Debug)]
pub struct Geometry {
    /// Arrays as the file has them.
    pub arrays: PrimitiveArrays,
    /// Mesh of the triangles without deformation; `None` for points and lines.
    pub mesh: Option<Mesh>,
}

impl Geometry {
    /// Triangles of the primitive; none for points and lines.
    pub fn triangles(&self) -> &[[u32; 3]] {
        match &self.arrays.faces {
            Faces::Triangles(triangles) => triangles,
            Faces::Points(_) | Faces::Lines(_) => &[],
        }
    }
}

/// Decoded primitives by the accessors that determine them.
#[derive(Debug, Default)]
pub struct GeometryCache {
    entries: Mutex<BTreeMap<GeometryKey, Decoded>>,
}

/// Result of decoding: the warnings say why a primitive is left out.
type Decoded = Result<(Option<Arc<Geometry>>, Warnings), Fault>;

impl GeometryCache {
    /// Decoded primitive of a mesh; `None` if it is left out.
    ///
    /// # Errors
    ///
    /// An array of the primitive is not valid.
    pub fn get(
        &self,
        data: &GltfData,
        [mesh, part]: [usize; 2],
        primitive: &Primitive,
        warnings: &mut Warnings,
    ) -> Result<Option<Arc<Geometry>>, Fault> {
        let key = GeometryKey::new(primitive);
        let known = self.entries.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        let decoded = known.unwrap_or_else(|| {
            let decoded = decode(data, mesh, part);
            let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
            entries.entry(key).or_insert(decoded).clone()
        });
        let (geometry, found) = decoded?;
        warnings.append(found);
        Ok(geometry)
    }
}

fn decode(data: &GltfData, mesh: usize, part: usize) -> Decoded {
    let assembly = match data.assemble(mesh, part)? {
        Assembly::Draco(stream) => {
            let arrays = decompress(data, [mesh, part], &stream)?;
            data.assemble_draco(mesh, part, &arrays)?
        }
        assembly => assembly,
    };
    match assembly {
        Assembly::Arrays(mut arrays) => {
            let warnings = std::mem::take(&mut arrays.warnings);
            let mesh = match &arrays.faces {
                Faces::Triangles(triangles) => Some(Arc::new(mesh_data(&arrays.vertices, triangles)).into()),
                Faces::Points(_) | Faces::Lines(_) => None,
            };
            Ok((Some(Arc::new(Geometry { arrays: *arrays, mesh })), warnings))
        }
        Assembly::LeftOut(warnings) => Ok((None, warnings)),
        Assembly::Draco(_) => Err(Fault::at(pointer([mesh, part]), "its compressed data cannot be read")),
    }
}

fn pointer([mesh, part]: [usize; 2]) -> String {
    format!("/meshes/{mesh}/primitives/{part}")
}

/// Decodes the Draco stream of a primitive.
fn decompress(data: &GltfData, place: [usize; 2], stream: &DracoStream<'_>) -> Result<DracoArrays, Fault> {
    let [mesh, part] = place;
    let document = &data.gltf.document;
    let primitive = document.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(part));
    let at = || format!("{}/extensions/KHR_draco_mesh_compression", pointer(place));
    let mut semantics: Vec<Semantic> = Vec::new();
    let names: Vec<String> = stream.attributes.iter().map(|(semantic, _)| semantic.to_string()).collect();
    let mut attributes = Vec::new();
    for ((semantic, id), name) in stream.attributes.iter().zip(&names) {
        let accessor = primitive.and_then(|primitive| primitive.attributes.find(semantic));
        let accessor = accessor.and_then(|index| document.accessors.get(index.get()));
        let Some(accessor) = accessor else { continue };
        semantics.push(semantic.clone());
        let (component, components) = (accessor.component_type, accessor.element_type.components());
        attributes.push(DracoAttribute { name, unique_id: id.get() as u32, component, components });
    }
    let limit = data.gltf.limits.decoded_bytes_of(stream.data.len() as u64);
    let decoded = draco::decode(stream.data, &attributes, limit).map_err(|error| Fault::at(at(), error))?;
    data.reserve(&at(), decoded.attributes.iter().map(|bytes| bytes.len() as u64).sum())?;
    Ok(DracoArrays { attributes: semantics.into_iter().zip(decoded.attributes).collect(), indices: decoded.indices })
}

/// Arrays of a mesh from vertices and triangles.
pub fn mesh_data(vertices: &Vertices, triangles: &[[u32; 3]]) -> MeshData {
    MeshData {
        positions: vertices.positions.clone(),
        triangles: triangles.to_vec(),
        normals: vertices.normals.clone(),
        uvs: vertices.texcoords.first().cloned().unwrap_or_default(),
    }
}
