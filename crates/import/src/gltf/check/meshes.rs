//! Checks of meshes and their primitives.

use super::checker::{Checker, FINITE};
use crate::gltf::document::ComponentType::{self, F32, I8, I16, U8, U16, U32};
use crate::gltf::document::ElementType::{self, Scalar, Vec2, Vec3, Vec4};
use crate::gltf::document::{Attributes, Index, Mesh, Mode, Primitive, PrimitiveExtensions, Semantic};
use crate::gltf::location::Location;

/// Types of an attribute.
struct AttributeTypes {
    elements: &'static [ElementType],
    components: &'static [ComponentType],
    /// Whether integers must be normalized.
    normalized: bool,
}

/// Numbers and the integers of KHR_mesh_quantization.
const QUANTIZED: &[ComponentType] = &[F32, I8, U8, I16, U16];
const SIGNED: &[ComponentType] = &[F32, I8, I16];
const UNSIGNED: &[ComponentType] = &[F32, U8, U16];

/// Types of an attribute of a primitive, or of a morph target; `None` if it has no effect.
fn types(semantic: &Semantic, is_target: bool) -> Option<AttributeTypes> {
    let types = |elements, components, normalized| Some(AttributeTypes { elements, components, normalized });
    match semantic {
        Semantic::Position => types(&[Vec3], QUANTIZED, false),
        Semantic::Normal => types(&[Vec3], SIGNED, true),
        Semantic::Tangent if is_target => types(&[Vec3], SIGNED, true),
        Semantic::Tangent => types(&[Vec4], SIGNED, true),
        Semantic::TexCoord(_) => types(&[Vec2], QUANTIZED, false),
        Semantic::Color(_) if is_target => types(&[Vec3, Vec4], QUANTIZED, true),
        Semantic::Color(_) => types(&[Vec3, Vec4], UNSIGNED, true),
        Semantic::Joints(_) if !is_target => types(&[Vec4], &[U8, U16], false),
        Semantic::Weights(_) if !is_target => types(&[Vec4], UNSIGNED, true),
        _ => None,
    }
}

impl Checker<'_> {
    /// Checks the attributes, indices and morph targets of meshes.
    pub(super) fn meshes(&mut self) {
        let list = Location::root("meshes");
        for (position, mesh) in self.document.meshes.iter().enumerate() {
            let at = list.index(position);
            if mesh.primitives.is_empty() {
                self.warn(&at, "a mesh has no primitives");
            }
            self.weights(&at, mesh);
            let primitives = at.key("primitives");
            for (position, primitive) in mesh.primitives.iter().enumerate() {
                let at = primitives.index(position);
                self.index(&at.key("material"), primitive.material, self.document.materials.len(), "material");
                self.attributes(&at, primitive);
                self.targets(&at, primitive);
                self.primitive_extensions(&at.key("extensions"), &primitive.extensions);
            }
        }
    }

    /// Checks the number of default weights, and that all primitives have as many morph targets.
    fn weights(&mut self, at: &Location<'_>, mesh: &Mesh) {
        self.numbers(&at.key("weights"), &mesh.weights, &FINITE);
        let targets = mesh.targets();
        self.count(at, targets as u64, self.limits.targets as u64, "morph targets");
        if mesh.primitives.iter().any(|primitive| primitive.targets.len() != targets) {
            self.fault(&at.key("primitives"), format_args!("primitives have different numbers of morph targets"));
        }
        let weights = mesh.weights.len();
        if weights > 0 && weights != targets {
            self.fault(&at.key("weights"), format_args!("{weights} weights, there are {targets} morph targets"));
        }
    }

    /// Checks the attributes and indices of a primitive.
    fn attributes(&mut self, at: &Location<'_>, primitive: &Primitive) {
        let count = self.vertex_count(&primitive.attributes);
        self.attribute_types(&at.key("attributes"), &primitive.attributes, count, false);
        let vertices = count.unwrap_or(0);
        self.count(at, vertices, self.limits.vertices, "vertices");
        let mut corners = vertices;
        if let Some(indices) = primitive.indices {
            let key = at.key("indices");
            if let Some(accessor) = self.typed(&key, indices, &[Scalar], &[U8, U16, U32]) {
                corners = accessor.count.get();
            }
        }
        let triangles = match primitive.mode {
            Mode::Triangles => corners / 3,
            Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
            _ => 0,
        };
        self.count(at, triangles, self.limits.triangles, "triangles");
    }

    /// Number of positions.
    fn vertex_count(&self, attributes: &Attributes) -> Option<u64> {
        let accessor = self.document.accessors.get(attributes.find(&Semantic::Position)?.get())?;
        Some(accessor.count.get())
    }

    /// Checks the types and counts of attributes; warns of those without effect.
    fn attribute_types(&mut self, at: &Location<'_>, attributes: &Attributes, vertices: Option<u64>, is_target: bool) {
        for (semantic, index) in attributes.iter() {
            let name = semantic.to_string();
            let at = at.key(&name);
            let Some(types) = types(semantic, is_target) else {
                self.index(&at, index, self.document.accessors.len(), "accessor");
                if !name.starts_with('_') {
                    self.warn(&at, format_args!("the attribute `{name}` has no effect"));
                }
                continue;
            };
            let Some(accessor) = self.typed(&at, index, types.elements, types.components) else { continue };
            let count = accessor.count.get();
            if types.normalized {
                self.normalized(&at, index);
            }
            if let Some(vertices) = vertices
                && count != vertices
            {
                self.fault(&at, format_args!("accessor {index} has {count} elements, there are {vertices} vertices"));
            }
        }
    }

    /// Checks the morph targets of a primitive.
    fn targets(&mut self, at: &Location<'_>, primitive: &Primitive) {
        let count = self.vertex_count(&primitive.attributes);
        let list = at.key("targets");
        for (position, target) in primitive.targets.iter().enumerate() {
            self.attribute_types(&list.index(position), target, count, true);
        }
    }

    /// Checks compressed data and the materials of variants.
    fn primitive_extensions(&mut self, at: &Location<'_>, extensions: &PrimitiveExtensions) {
        let document = self.document;
        if let Some(draco) = &extensions.draco {
            let at = at.key("KHR_draco_mesh_compression");
            self.index(&at.key("bufferView"), draco.buffer_view, document.buffer_views.len(), "bufferView");
        }
        let Some(variants) = &extensions.variants else { return };
        let at = at.key("KHR_materials_variants");
        let list = at.key("mappings");
        let count = document.extensions.variants.as_ref().map_or(0, |variants| variants.variants.len());
        for (position, mapping) in variants.mappings.iter().enumerate() {
            let at = list.index(position);
            self.index(&at.key("material"), mapping.material, document.materials.len(), "material");
            let at = at.key("variants");
            for (position, variant) in mapping.variants.iter().enumerate() {
                self.index(&at.index(position), *variant, count, "variant");
            }
        }
    }

    /// Number of morph targets of a mesh; 0 if it does not exist.
    pub(super) fn target_count(&self, mesh: Option<Index>) -> usize {
        mesh.and_then(|mesh| self.document.meshes.get(mesh.get())).map_or(0, Mesh::targets)
    }
}
