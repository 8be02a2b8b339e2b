//! Objects of the nodes of a scene: one for each node that draws a mesh, depth first, with the
//! node's transform to world space as one matrix.

use super::Source;
use super::deformed::{deformed_mesh, joint_matrices, morph_weights};
use super::geometry::Geometry;
use super::instances::instance_transforms;
use super::materials::{MaterialSet, PrimitiveSurface};
use crate::gltf::document::{Document, Mode, Node, Primitive};
use crate::gltf::error::Fault;
use crate::gltf::pose::{Hierarchy, NodeTransform, Pose, is_invertible};
use crate::gltf::primitive::Faces;
use crate::gltf::warning::Warnings;
use glam::DAffine3;
use indexmap::IndexMap;
use juggler_scene::model::ModelParts;
use juggler_scene::{Object, TransformStep};
use juggler_shape::Mesh;
use std::sync::Arc;

/// Transforms of all nodes to world space in a pose.
///
/// # Errors
///
/// A transform is not valid.
pub fn world_transforms(document: &Document, pose: &Pose) -> Result<Vec<DAffine3>, Fault> {
    let (hierarchy, locals) = (hierarchy(document)?, local_transforms(document)?);
    Ok(hierarchy.world_transforms(|node| {
        locals.get(node).map_or(DAffine3::IDENTITY, |local| local.to_parent(pose.nodes.get(&node)))
    }))
}

fn hierarchy(document: &Document) -> Result<Hierarchy, Fault> {
    let mut parents = vec![None; document.nodes.len()];
    for (parent, node) in document.nodes.iter().enumerate() {
        for child in &node.children {
            if let Some(slot) = parents.get_mut(child.get()) {
                *slot = Some(parent);
            }
        }
    }
    Hierarchy::new(&parents).map_err(|error| Fault::at("/nodes", error))
}

fn local_transforms(document: &Document) -> Result<Vec<NodeTransform>, Fault> {
    let local = |(index, node): (usize, &Node)| {
        let transform = match &node.matrix {
            Some(columns) => NodeTransform::from_matrix(columns),
            None => NodeTransform::from_parts(
                node.translation.unwrap_or_default(),
                node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
                node.scale.unwrap_or([1.0; 3]),
            ),
        };
        transform.map_err(|error| Fault::at(format!("/nodes/{index}"), error))
    };
    document.nodes.iter().enumerate().map(local).collect()
}

/// Root nodes of a scene, or all roots of a file without scenes.
pub fn roots(document: &Document, scene: Option<usize>) -> Vec<usize> {
    if let Some(scene) = scene.and_then(|scene| document.scenes.get(scene)) {
        return scene.nodes.iter().map(|node| node.get()).collect();
    }
    let mut is_child = vec![false; document.nodes.len()];
    for child in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(slot) = is_child.get_mut(child.get()) {
            *slot = true;
        }
    }
    (0..document.nodes.len()).filter(|node| !is_child.get(*node).copied().unwrap_or_default()).collect()
}

/// Nodes of a scene, depth first, each with the path of names that leads to it.
pub fn nodes_of_scene(source: &Source<'_>, scene: Option<usize>) -> Vec<(usize, String)> {
    let document = &source.data.gltf.document;
    let name = |node: usize| source.names.nodes.get(node).map(String::as_str).unwrap_or_default();
    let mut found = Vec::new();
    let mut stack: Vec<(usize, String)> =
        roots(document, scene).into_iter().rev().map(|root| (root, name(root).to_owned())).collect();
    // The loop ends: the structure of a valid document is a forest.
    while let Some((index, path)) = stack.pop() {
        let Some(node) = document.nodes.get(index) else { continue };
        for child in node.children.iter().rev() {
            stack.push((child.get(), format!("{path}/{}", name(child.get()))));
        }
        found.push((index, path));
    }
    found
}

/// Translation of the nodes of a scene.
pub struct Walk<'a> {
    source: &'a Source<'a>,
    materials: MaterialSet<'a>,
    pose: &'a Pose,
    variant: Option<usize>,
    prefix: &'a str,
    worlds: Vec<DAffine3>,
    visible: Vec<bool>,
    /// Number of nodes that draw each mesh.
    uses: Vec<usize>,
    groups: IndexMap<String, Vec<Object>>,
    objects: Vec<Object>,
}

impl<'a> Walk<'a> {
    /// Prepares the translation of a file in a pose.
    ///
    /// # Errors
    ///
    /// A transform is not valid.
    pub fn new(
        source: &'a Source<'a>,
        materials: MaterialSet<'a>,
        pose: &'a Pose,
        variant: Option<usize>,
        prefix: &'a str,
    ) -> Result<Self, Fault> {
        let document = &source.data.gltf.document;
        let own = |index: usize| {
            let animated = pose.nodes.get(&index).and_then(|pose| pose.visible);
            let node = document.nodes.get(index).and_then(|node| node.extensions.as_deref());
            animated.unwrap_or_else(|| node.and_then(|e| e.visibility).is_none_or(|visibility| visibility.visible))
        };
        let mut uses = vec![0; document.meshes.len()];
        for mesh in document.nodes.iter().filter_map(|node| node.mesh) {
            if let Some(count) = uses.get_mut(mesh.get()) {
                *count += 1;
            }
        }
        let (worlds, visible) = (world_transforms(document, pose)?, hierarchy(document)?.visibility(own));
        let (groups, objects) = (IndexMap::new(), Vec::new());
        Ok(Self { source, materials, pose, variant, prefix, worlds, visible, uses, groups, objects })
    }

    /// Translates the nodes of a scene.
    ///
    /// # Errors
    ///
    /// An array is not valid.
    pub fn scene(&mut self, scene: Option<usize>, warnings: &mut Warnings) -> Result<(), Fault> {
        for (index, path) in nodes_of_scene(self.source, scene) {
            self.node(index, path, warnings)?;
        }
        Ok(())
    }

    /// The parts of the scene so far, without cameras and lights.
    pub fn finish(self, warnings: &mut Warnings) -> ModelParts {
        let materials = self.materials.finish();
        warnings.append(materials.warnings);
        ModelParts {
            assets: materials.assets,
            textures: materials.textures,
            materials: materials.materials,
            groups: self.groups,
            objects: self.objects,
            ..ModelParts::default()
        }
    }

    fn node(&mut self, index: usize, path: String, warnings: &mut Warnings) -> Result<(), Fault> {
        let document = &self.source.data.gltf.document;
        let Some(node) = document.nodes.get(index) else { return Ok(()) };
        let Some(mesh) = node.mesh.map(|mesh| mesh.get()) else { return Ok(()) };
        let joints = joint_matrices(self.source, node, &self.worlds)?;
        let weights = morph_weights(document, index, mesh, self.pose);
        let is_deformed = joints.is_some() || !weights.is_empty();
        let place = Placement { joints: joints.as_deref(), weights: &weights, is_deformed };
        let is_shared = !is_deformed && (self.uses.get(mesh).is_some_and(|uses| *uses > 1) || is_instanced(node));
        let Some(object) = self.content(mesh, &place, is_shared, warnings)? else { return Ok(()) };
        let world = match joints {
            Some(_) => DAffine3::IDENTITY,
            None => self.worlds.get(index).copied().unwrap_or(DAffine3::IDENTITY),
        };
        let visible = self.visible.get(index).copied().unwrap_or(true);
        let instancing = node.extensions.as_deref().and_then(|extensions| extensions.instancing.as_ref());
        let instances = match instancing {
            Some(instancing) => instance_transforms(self.source.data, index, instancing)?,
            None => vec![DAffine3::IDENTITY],
        };
        for instance in instances {
            self.place(&object, world * instance, visible, &path, index, warnings);
        }
        Ok(())
    }

    fn place(
        &mut self,
        object: &Object,
        world: DAffine3,
        visible: bool,
        path: &str,
        node: usize,
        warnings: &mut Warnings,
    ) {
        let is_flat = !is_invertible(&world.matrix3);
        warnings.add(format!("/nodes/{node}"), "is scaled by 0 and not shown", u64::from(is_flat));
        let matrix = if is_flat { DAffine3::IDENTITY } else { world };
        let mut placed = object.clone().named(path).visible(visible && !is_flat);
        if matrix != DAffine3::IDENTITY {
            placed = placed.transformed(matrix_step(&matrix));
        }
        self.objects.push(placed);
    }

    /// Object of a mesh: its only primitive, its primitives, or a group of them.
    fn content(
        &mut self,
        mesh: usize,
        place: &Placement<'_>,
        is_shared: bool,
        warnings: &mut Warnings,
    ) -> Result<Option<Object>, Fault> {
        let name = self.source.names.meshes.get(mesh).map(String::as_str).unwrap_or_default();
        let name = format!("{}mesh {name}", self.prefix);
        if is_shared && self.groups.contains_key(&name) {
            return Ok(Some(Object::group(name)));
        }
        let mut parts = self.primitives(mesh, place, warnings)?;
        if parts.is_empty() {
            return Ok(None);
        }
        if is_shared {
            self.groups.insert(name.clone(), parts);
            return Ok(Some(Object::group(name)));
        }
        Ok(Some(if parts.len() == 1 { parts.remove(0) } else { Object::several(parts) }))
    }

    fn primitives(
        &mut self,
        mesh: usize,
        place: &Placement<'_>,
        warnings: &mut Warnings,
    ) -> Result<Vec<Object>, Fault> {
        let Some(found) = self.source.data.gltf.document.meshes.get(mesh) else { return Ok(Vec::new()) };
        let mut parts = Vec::new();
        for (part, primitive) in found.primitives.iter().enumerate() {
            let geometry = self.source.geometry.get(self.source.data, [mesh, part], primitive, warnings)?;
            let Some(geometry) = geometry else { continue };
            let at = format!("/meshes/{mesh}/primitives/{part}");
            let Some(shape) = self.shape(&geometry, place, &at, warnings)? else { continue };
            let surface = PrimitiveSurface {
                has_color: !geometry.arrays.vertices.colors.is_empty(),
                is_lit: !geometry.arrays.vertices.normals.is_empty() || is_surface(primitive.mode),
            };
            let material = self.materials.material(self.material_index(primitive), &surface)?;
            parts.push(Object::new(shape).material_named(material));
        }
        Ok(parts)
    }

    /// Mesh of a primitive; `None` for points and lines, which are left out.
    fn shape(
        &self,
        geometry: &Arc<Geometry>,
        place: &Placement<'_>,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Mesh>, Fault> {
        if !matches!(geometry.arrays.faces, Faces::Triangles(_)) {
            warnings.add(at, "points and lines are left out", 1);
            return Ok(None);
        }
        if !place.is_deformed {
            return Ok(geometry.mesh.clone());
        }
        deformed_mesh(geometry, place.weights, place.joints, at).map(Some)
    }

    /// Material of a primitive in the chosen variant.
    fn material_index(&self, primitive: &Primitive) -> Option<usize> {
        let mappings = primitive.extensions.variants.iter().flat_map(|variants| &variants.mappings);
        let uses =
            |variants: &[crate::gltf::document::Index], wanted: usize| variants.iter().any(|v| v.get() == wanted);
        let chosen = self.variant.and_then(|wanted| mappings.into_iter().find(|m| uses(&m.variants, wanted)));
        chosen.map(|mapping| mapping.material).or(primitive.material).map(|material| material.get())
    }
}

/// How a node deforms its mesh.
struct Placement<'p> {
    joints: Option<&'p [DAffine3]>,
    weights: &'p [f64],
    is_deformed: bool,
}

fn is_surface(mode: Mode) -> bool {
    matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

fn is_instanced(node: &Node) -> bool {
    node.extensions.as_deref().is_some_and(|extensions| extensions.instancing.is_some())
}

/// Transform step of an affine map, rounded to single precision once.
pub fn matrix_step(map: &DAffine3) -> TransformStep {
    let (m, t) = (map.matrix3, map.translation);
    let row = |i: usize| [m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]];
    TransformStep::Matrix((0..3).flat_map(row).map(|number| number as f32).collect())
}
