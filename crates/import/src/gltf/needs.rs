//! Memory to open a file and to translate it to parts of a scene, from its document alone. Pictures
//! count as they are encoded.

use super::document::{Document, Image, Primitive, Semantic};
use super::ktx2_head::read_head;
use super::open::Gltf;
use super::summary::triangles;
use super::translate::Meshes;
use super::uri::Uri;
use juggler_scene::model::{Files, ModelNeeds};

/// Bytes of a node in the document.
const NODE: u64 = 400;
/// Bytes of an object, with its name and its transform.
const OBJECT: u64 = 700;
/// Bytes in the document and in the scene for each byte of JSON, without nodes and objects.
const JSON: u64 = 2;
/// Bytes of an instance of a node.
const INSTANCE: u64 = 160;

/// Memory that a file needs; `files` has the files that it names.
pub fn needs(gltf: &Gltf, files: &dyn Files) -> ModelNeeds {
    let document = &gltf.document;
    let meshes = Meshes::new(document, &gltf.limits);
    let distinct = meshes.primitives().filter_map(|(mesh, part)| primitive(document, mesh, part));
    let arrays = distinct.map(|primitive| ArrayBytes::new(document, primitive).in_file()).fold(0, u64::saturating_add);
    let encoded = encoded_bytes(gltf, files).saturating_add(replacement_bytes(gltf, files));
    let parts = [gltf.length, encoded, arrays, objects_bytes(document)];
    let bytes = parts.into_iter().fold(gltf.json_length.saturating_mul(JSON), u64::saturating_add);
    ModelNeeds { bytes, solids: meshes.solids(document) }
}

fn primitive(document: &Document, mesh: usize, part: usize) -> Option<&Primitive> {
    document.meshes.get(mesh)?.primitives.get(part)
}

/// Bytes of buffers and pictures beside the file, of copies of the pictures in it, and of decoded
/// buffer views.
fn encoded_bytes(gltf: &Gltf, files: &dyn Files) -> u64 {
    let document = &gltf.document;
    let buffers = document.buffers.iter().filter(|buffer| buffer.uri.is_some() && !buffer.is_fallback());
    let buffers = buffers.map(|buffer| buffer.byte_length.get());
    let length = |view: usize| document.buffer_views.get(view).map(|view| view.byte_length.get());
    let images = document.images.iter().filter_map(|image| match (image.uri.as_deref(), image.buffer_view) {
        (Some(uri), _) => match Uri::parse(uri).ok()? {
            Uri::Data { .. } => Some(uri.len() as u64),
            Uri::File(names) => names.iter().find_map(|name| files.length(name)),
        },
        (None, Some(view)) => length(view.get()),
        (None, None) => None,
    });
    let views = document.buffer_views.iter().filter_map(|view| view.compressed());
    let views = views.map(|(_, view)| view.count.get().saturating_mul(view.byte_stride.get() as u64));
    buffers.chain(images).chain(views).fold(0, u64::saturating_add)
}

/// Bytes of the pictures that take the place of KTX2 pictures, and to decode one of these.
fn replacement_bytes(gltf: &Gltf, files: &dyn Files) -> u64 {
    let is_ktx2 = |image: &&Image| {
        let named = image.uri.as_deref().is_some_and(|uri| uri.ends_with(".ktx2"));
        named || image.mime_type.as_deref() == Some("image/ktx2")
    };
    let head = |image: &Image| match (image.uri.as_deref(), image.buffer_view) {
        (Some(uri), _) => match Uri::parse(uri).ok()? {
            Uri::File(names) => names.iter().find_map(|name| read_head(&files.read(name, u64::MAX).ok()?).ok()),
            Uri::Data { .. } => None,
        },
        (None, view) => read_head(embedded(gltf, view?.get())?).ok(),
    };
    let heads = gltf.document.images.iter().filter(is_ktx2).filter_map(head);
    let (sum, largest) = heads.fold((0_u64, 0), |(sum, largest), head| {
        let pixels = 4 * u64::from(head.width) * u64::from(head.height);
        (sum.saturating_add(pixels), pixels.max(largest))
    });
    sum.saturating_add(largest)
}

/// Bytes of a view of the chunk BIN.
fn embedded(gltf: &Gltf, view: usize) -> Option<&[u8]> {
    let view = gltf.document.buffer_views.get(view)?;
    let buffer = gltf.document.buffers.get(view.buffer.get()).filter(|buffer| buffer.uri.is_none());
    let binary = buffer.and_then(|_| gltf.bytes.get(gltf.binary.clone()?))?;
    let start = usize::try_from(view.byte_offset.get()).ok()?;
    binary.get(start..)?.get(..usize::try_from(view.byte_length.get()).ok()?)
}

/// Bytes of the nodes, and of the objects that they become; of meshes that deform, each node has
/// its own.
fn objects_bytes(document: &Document) -> u64 {
    let groups = document.meshes.iter().map(|mesh| mesh.primitives.len() as u64);
    let groups = groups.fold(0, u64::saturating_add).saturating_mul(OBJECT);
    document.nodes.iter().fold(groups, |sum, node| {
        let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh.get()));
        let primitives = mesh.map(|mesh| mesh.primitives.as_slice()).unwrap_or_default();
        let deforms = node.skin.is_some() || primitives.iter().any(|primitive| !primitive.targets.is_empty());
        let deformed = primitives
            .iter()
            .filter(|_| deforms)
            .map(|primitive| OBJECT.saturating_add(ArrayBytes::new(document, primitive).mesh));
        let instancing = node.extensions.as_deref().and_then(|extensions| extensions.instancing.as_ref());
        let accessor = instancing.and_then(|instancing| instancing.attributes.iter().next());
        let count = accessor.and_then(|(_, accessor)| document.accessors.get(accessor.get()));
        let instances = count.map_or(0, |accessor| accessor.count.get()).saturating_mul(INSTANCE);
        let own = if primitives.is_empty() { NODE } else { NODE + OBJECT };
        deformed.fold(sum.saturating_add(own).saturating_add(instances), u64::saturating_add)
    })
}

/// Bytes of the arrays of a primitive, by the counts of its accessors.
struct ArrayBytes {
    /// Mesh of the vertices and triangles.
    mesh: u64,
    /// Joints and morph targets; `None` for a primitive that nothing deforms.
    deforming: Option<u64>,
}

impl ArrayBytes {
    fn new(document: &Document, primitive: &Primitive) -> Self {
        let position = primitive.attributes.find(&Semantic::Position);
        let vertices = position.and_then(|index| document.accessors.get(index.get()));
        let vertices = vertices.map_or(0, |accessor| accessor.count.get());
        // Tangents may be computed.
        let tangents = if primitive.attributes.find(&Semantic::Tangent).is_some() { 0 } else { 16 };
        let attributes = primitive.attributes.iter().map(|(semantic, _)| match semantic {
            Semantic::Position | Semantic::Normal => 12,
            Semantic::Tangent | Semantic::Color(0) => 16,
            Semantic::TexCoord(0 | 1) => 8,
            _ => 0,
        });
        let of_vertices = |bytes: u64| vertices.saturating_mul(bytes);
        let mesh = of_vertices(attributes.sum::<u64>() + tangents);
        let mesh = mesh.saturating_add(triangles(document, primitive).saturating_mul(12));
        let joints = primitive.attributes.iter().filter(|(semantic, _)| matches!(semantic, Semantic::Joints(_)));
        let joints = joints.count() as u64 * 24;
        let targets = primitive.targets.iter().map(|target| target.iter().count() as u64 * 12);
        let deforming = joints.saturating_add(targets.fold(0, u64::saturating_add));
        Self { mesh, deforming: (deforming > 0).then(|| of_vertices(deforming)) }
    }

    /// Bytes of the decoded arrays, which are kept twice if something deforms them.
    fn in_file(&self) -> u64 {
        self.deforming.map_or(self.mesh, |deforming| self.mesh.saturating_mul(2).saturating_add(deforming))
    }
}

#[cfg(test)]
mod tests {
    use crate::gltf::GltfFormat;
    use crate::gltf::testing::Builder;
    use juggler_scene::model::{ModelFormat, ModelNeeds};
    use std::collections::BTreeMap;

    fn needs(builder: &Builder) -> ModelNeeds {
        GltfFormat::default().needs(builder.glb(), &BTreeMap::new())
    }

    #[test]
    fn nodes_vertices_and_morph_targets_count() {
        let model = |vertices: usize, more: &str, nodes: usize| {
            let mut builder = Builder::default();
            builder.floats("VEC3", 3, &vec![1.0; 3 * vertices]);
            builder.member(format!(
                r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}} {more}}}]}}], "nodes": [{}]"#,
                vec![r#"{"mesh": 0}"#; nodes].join(", ")
            ));
            needs(&builder).bytes
        };
        let more_nodes = (model(30, "", 2000) - model(30, "", 1000)) / 1000;
        assert!((800..=1300).contains(&more_nodes), "{more_nodes}");
        // A vertex takes its positions in the file and decoded, a third of a triangle, and
        // tangents.
        let more_vertices = (model(60_000, "", 1) - model(30_000, "", 1)) / 30_000;
        assert_eq!(more_vertices, 12 + 12 + 4 + 16);
        let targets = r#", "targets": [{"POSITION": 0}]"#;
        let more_targets = (model(60_000, targets, 1) - model(30_000, targets, 1)) / 30_000;
        assert_eq!(more_targets, 12 + 3 * (12 + 4 + 16) + 12);
    }
}
