//! Meshes of primitives. Each distinct primitive is decoded once for all nodes and times, so meshes
//! that nothing deforms share their arrays.

use super::materials::{add_tangents, tangent_uv_set};
use crate::gltf::data::GltfData;
use crate::gltf::document::{Document, Mode, Primitive, Semantic};
use crate::gltf::draco::{self, DracoAttribute, DracoLimits};
use crate::gltf::error::Fault;
use crate::gltf::limits::Limits;
use crate::gltf::pose::Vertices;
use crate::gltf::primitive::{
    Assembly, DracoArrays, DracoStream, Faces, GeometryKey, PrimitiveArrays, compressed_triangles, points_and_lines,
};
use crate::gltf::warning::Warnings;
use juggler_math::{Aabb, Vec3};
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use juggler_shape::{Mesh, MeshData};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A decoded primitive.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// Surface, points or lines without deformation.
    pub form: Form,
    /// Whether the vertices have colors.
    pub has_color: bool,
    /// Whether the vertices have normals.
    pub has_normals: bool,
    /// Bounding box of the positions.
    pub bounds: Aabb,
    /// The arrays of a primitive that morph targets or joints may deform.
    pub deformable: Option<Box<PrimitiveArrays>>,
}

/// Form of a primitive.
#[derive(Clone, Debug)]
pub enum Form {
    /// Triangles. Clones share the arrays.
    Surface(Mesh),
    /// Points and lines; the vertices are those of `deformable`.
    Thin,
}

/// Decoded primitives of a file.
#[derive(Debug, Default)]
pub struct Meshes {
    /// Slot of each primitive of each mesh. Primitives with equal arrays share a slot.
    slots: Vec<Vec<usize>>,
    entries: Vec<Entry>,
}

/// A distinct primitive, decoded at its first use.
#[derive(Debug)]
struct Entry {
    mesh: usize,
    part: usize,
    /// Set of texture coordinates along which the material needs tangents.
    tangent_set: Option<u32>,
    /// Whether the file has too many points and lines before and in the primitive.
    is_excess: bool,
    decoded: OnceLock<Result<(Option<Geometry>, Warnings), Fault>>,
}

impl Meshes {
    /// Primitives of a document, none of them decoded.
    pub fn new(document: &Document, limits: &Limits) -> Self {
        let mut thin_left = limits.points_and_lines;
        let mut known = BTreeMap::new();
        let mut meshes = Self::default();
        for (mesh, found) in document.meshes.iter().enumerate() {
            let entries = &mut meshes.entries;
            let slots = found.primitives.iter().enumerate().map(|(part, primitive)| {
                let tangent_set = tangent_set(document, primitive);
                *known.entry((GeometryKey::new(primitive), tangent_set)).or_insert_with(|| {
                    let left = thin_left.checked_sub(points_and_lines(document, primitive));
                    thin_left = left.unwrap_or(thin_left);
                    let is_excess = left.is_none();
                    entries.push(Entry { mesh, part, tangent_set, is_excess, decoded: OnceLock::new() });
                    entries.len() - 1
                })
            });
            meshes.slots.push(slots.collect());
        }
        meshes
    }

    /// Largest number of spheres and cylinders of the file's points and lines: of distinct
    /// primitives that are not left out, without equal points and lines.
    pub fn solids(&self, document: &Document) -> u64 {
        let solids = |entry: &Entry| {
            let primitive = document.meshes.get(entry.mesh)?.primitives.get(entry.part)?;
            let positions = document.accessors.get(primitive.attributes.find(&Semantic::Position)?.get())?.count.get();
            let count = points_and_lines(document, primitive);
            Some(if primitive.mode == Mode::Points {
                count.min(positions)
            } else {
                let pairs = positions.saturating_mul(positions) / 2;
                count.saturating_mul(2).min(positions).saturating_add(count.min(pairs))
            })
        };
        self.entries.iter().filter(|entry| !entry.is_excess).filter_map(solids).fold(0, u64::saturating_add)
    }

    /// Distinct primitives that are not left out: indices of the mesh and of the primitive in it.
    pub fn primitives(&self) -> impl Iterator<Item = (usize, usize)> {
        self.entries.iter().filter(|entry| !entry.is_excess).map(|entry| (entry.mesh, entry.part))
    }

    /// Number of distinct primitives.
    pub fn distinct(&self) -> usize {
        self.entries.len()
    }

    /// Bytes of the arrays that are kept for deformations.
    pub fn deformable_bytes(&self) -> u64 {
        let decoded = self.entries.iter().filter_map(|entry| entry.decoded.get()?.as_ref().ok()?.0.as_ref());
        let arrays = decoded.filter_map(|geometry| geometry.deformable.as_deref());
        arrays.map(|arrays| arrays.bytes() as u64).fold(0, u64::saturating_add)
    }

    /// Slot of a primitive: equal for primitives with equal arrays.
    pub fn slot(&self, mesh: usize, part: usize) -> Option<usize> {
        self.slots.get(mesh)?.get(part).copied()
    }

    /// A decoded primitive with the warnings about it; `None` if it is left out.
    ///
    /// # Errors
    ///
    /// An array of the primitive is not valid.
    pub fn get(&self, data: &GltfData, slot: usize) -> Result<(Option<&Geometry>, Option<&Warnings>), Fault> {
        let Some(entry) = self.entries.get(slot) else { return Ok((None, None)) };
        match entry.decoded.get_or_init(|| decode(data, entry)) {
            Ok((geometry, warnings)) => Ok((geometry.as_ref(), Some(warnings))),
            Err(fault) => Err(fault.clone()),
        }
    }
}

/// Decodes a primitive.
fn decode(data: &GltfData, entry: &Entry) -> Result<(Option<Geometry>, Warnings), Fault> {
    let Entry { mesh, part, tangent_set, is_excess, .. } = *entry;
    if is_excess {
        let limit = data.gltf.limits.points_and_lines;
        let text = format!("is left out: the file has more than {limit} points and lines, the limit");
        let mut warnings = Warnings::default();
        warnings.add(pointer(mesh, part), text, 1);
        return Ok((None, warnings));
    }
    let assembly = match data.assemble(mesh, part)? {
        Assembly::Draco(stream) => data.assemble_draco(mesh, part, &decompress(data, mesh, part, &stream)?)?,
        assembly => assembly,
    };
    match assembly {
        Assembly::Arrays(mut arrays) => {
            let mut warnings = std::mem::take(&mut arrays.warnings);
            if is_without_area(&arrays) {
                warnings.add(pointer(mesh, part), "has no triangle with an area and is left out", 1);
                return Ok((None, warnings));
            }
            if let Some(set) = tangent_set {
                add_tangents(&mut arrays, set);
            }
            Ok((Some(geometry(arrays)), warnings))
        }
        Assembly::LeftOut(warnings) => Ok((None, warnings)),
        Assembly::Draco(_) => Err(Fault::at(pointer(mesh, part), "the compressed data cannot be read")),
    }
}

/// Whether a primitive has only degenerate triangles and nothing deforms them.
fn is_without_area(arrays: &PrimitiveArrays) -> bool {
    let is_rigid = arrays.targets.is_empty() && arrays.joints.is_empty();
    match &arrays.faces {
        Faces::Triangles(triangles) => is_rigid && !have_area(&arrays.vertices.positions, triangles),
        Faces::Points(_) | Faces::Lines(_) => false,
    }
}

/// Whether some triangle has an area.
pub fn have_area(positions: &[Vec3], triangles: &[[u32; 3]]) -> bool {
    let corner = |index: u32| positions.get(index as usize).map(|corner| corner.as_dvec3());
    let normal = |[a, b, c]: [u32; 3]| {
        let (a, b, c) = (corner(a)?, corner(b)?, corner(c)?);
        Some((b - a).cross(c - a))
    };
    triangles.iter().any(|triangle| normal(*triangle).is_some_and(|normal| normal.length() > 0.0))
}

/// Set of texture coordinates along which a material of a primitive, in any variant, needs tangents.
fn tangent_set(document: &Document, primitive: &Primitive) -> Option<u32> {
    let mappings = primitive.extensions.variants.iter().flat_map(|variants| &variants.mappings);
    let materials = primitive.material.into_iter().chain(mappings.map(|mapping| mapping.material));
    materials.into_iter().find_map(|material| tangent_uv_set(document, material.get()))
}

/// JSON pointer of a primitive.
pub fn pointer(mesh: usize, part: usize) -> String {
    format!("/meshes/{mesh}/primitives/{part}")
}

/// Geometry of the arrays of a primitive, which are kept only where a deformation needs them.
fn geometry(arrays: Box<PrimitiveArrays>) -> Geometry {
    let has_color = !arrays.vertices.colors.is_empty();
    let has_normals = !arrays.vertices.normals.is_empty();
    let bounds = Aabb::from_points(arrays.vertices.positions.iter().copied());
    let may_deform = !arrays.targets.is_empty() || !arrays.joints.is_empty();
    let (form, deformable) = match (arrays.faces, may_deform) {
        (Faces::Triangles(triangles), false) => (Form::Surface(mesh(arrays.vertices, triangles)), None),
        (Faces::Triangles(triangles), true) => {
            let form = Form::Surface(mesh(arrays.vertices.clone(), triangles.clone()));
            (form, Some(Box::new(PrimitiveArrays { faces: Faces::Triangles(triangles), ..*arrays })))
        }
        (faces, true) => (Form::Thin, Some(Box::new(PrimitiveArrays { faces, ..*arrays }))),
        (faces, false) => {
            let Vertices { positions, colors, .. } = arrays.vertices;
            let vertices = Vertices { positions, colors, ..Vertices::default() };
            (Form::Thin, Some(Box::new(PrimitiveArrays { vertices, faces, ..PrimitiveArrays::default() })))
        }
    };
    Geometry { form, has_color, has_normals, bounds, deformable }
}

/// Mesh of vertices and triangles, without copies.
pub fn mesh(vertices: Vertices, triangles: Vec<[u32; 3]>) -> Mesh {
    mesh_data(vertices, triangles).into()
}

/// Arrays of a mesh. The only place where attributes of vertices become those of a mesh.
fn mesh_data(vertices: Vertices, triangles: Vec<[u32; 3]>) -> MeshData {
    let Vertices { positions, normals, tangents, texcoords, colors } = vertices;
    let mut sets = texcoords.into_iter();
    let (uvs, uvs1) = (sets.next().unwrap_or_default(), sets.next().unwrap_or_default());
    let attributes = (!colors.is_empty()).then(|| {
        let data = AttributeData::F32(colors.into_flattened());
        ("color".to_owned(), MeshAttribute { domain: AttributeDomain::Vertex, channels: 4, data })
    });
    MeshData { positions, triangles, normals, uvs, uvs1, tangents, attributes: attributes.into_iter().collect() }
}

/// Decodes the Draco stream of a primitive.
fn decompress(data: &GltfData, mesh: usize, part: usize, stream: &DracoStream<'_>) -> Result<DracoArrays, Fault> {
    let document = &data.gltf.document;
    let primitive = document.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(part));
    let at = format!("{}/extensions/KHR_draco_mesh_compression", pointer(mesh, part));
    let accessor = |semantic: &Semantic| {
        let accessor = primitive?.attributes.find(semantic)?;
        document.accessors.get(accessor.get())
    };
    let wanted: Vec<_> =
        stream.attributes.iter().filter_map(|(semantic, id)| Some((semantic, id, accessor(semantic)?))).collect();
    let names: Vec<String> = wanted.iter().map(|(semantic, ..)| semantic.to_string()).collect();
    let attributes = wanted.iter().zip(&names).map(|((_, id, accessor), name)| DracoAttribute {
        name,
        unique_id: u32::try_from(id.get()).unwrap_or(u32::MAX),
        component: accessor.component_type,
        components: accessor.element_type.components(),
    });
    let attributes: Vec<DracoAttribute<'_>> = attributes.collect();
    let limits = DracoLimits {
        triangles: primitive.map_or(0, |primitive| compressed_triangles(document, primitive)),
        bytes: data.gltf.limits.decoded_bytes_of(stream.data.len() as u64),
    };
    let decoded = draco::decode(stream.data, &attributes, &limits).map_err(|error| Fault::at(&at, error))?;
    data.reserve(&at, decoded.attributes.iter().map(|bytes| bytes.len() as u64).sum())?;
    let semantics = wanted.iter().map(|(semantic, ..)| (*semantic).clone());
    Ok(DracoArrays { attributes: semantics.zip(decoded.attributes).collect(), indices: decoded.indices })
}
