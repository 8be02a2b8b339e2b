//! Objects of the nodes of a scene: one for each node that draws a mesh, with the node's transform
//! to world space as one matrix.

use super::Content;
use super::deformed::{Deformation, deformed_mesh, morph_weights};
use super::faults::Faults;
use super::instances::{Attribute, NodeInstances};
use super::materials::{MaterialSet, PrimitiveSurface};
use super::matrix::{matrix_rows, matrix_step};
use super::meshes::{Form, Geometry, have_area, pointer};
use super::rest_bounds::{diagonal, rest_bounds};
use super::select::Selection;
use super::thin::{local_radius, relative_radius, solids};
use super::tree::SceneNode;
use crate::gltf::document::Primitive;
use crate::gltf::error::Fault;
use crate::gltf::pose::Pose;
use crate::gltf::primitive::{Faces, PrimitiveArrays};
use crate::gltf::warning::Warnings;
use glam::DAffine3;
use indexmap::IndexMap;
use juggler_math::{BuildControl, Vec3};
use juggler_scene::{InstanceAttribute, Instances, Item, Object};
use juggler_shape::attribute::AttributeData;
use juggler_shape::{Mesh, MeshData};
use std::borrow::Cow;

/// What the objects of a scene are made of.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The file.
    pub content: &'a Content,
    /// Pose of the nodes.
    pub pose: &'a Pose,
    /// Transforms of all nodes to world space.
    pub worlds: &'a [DAffine3],
    /// Whether each node is visible.
    pub visible: &'a [bool],
    /// Nodes of the scene, depth first.
    pub nodes: &'a [SceneNode],
    /// What the choice selects.
    pub selection: Selection,
    /// Size of the picture in pixels, which determines the width of points and lines.
    pub picture_size: Option<[u32; 2]>,
    /// Beginning of the names of all parts.
    pub prefix: &'a str,
}

/// Objects and groups of a scene.
#[derive(Debug)]
pub struct Objects<'a> {
    view: View<'a>,
    pub materials: MaterialSet<'a>,
    /// Number of nodes of the scene that draw each mesh.
    uses: Vec<usize>,
    /// Whether the warnings about a distinct primitive were taken over.
    reported: Vec<bool>,
    /// Radius of points and lines in world space.
    pub radius: Option<f64>,
    /// Points and lines that may still be made.
    thin_left: u64,
    /// Instances that may still be placed.
    instances_left: u64,
    /// Bytes of deformed arrays that may still be made.
    bytes_left: u64,
    pub groups: IndexMap<String, Vec<Object>>,
    pub objects: Vec<Item<Object>>,
}

/// Problems that were found.
#[derive(Debug)]
pub struct Findings {
    /// Approximated, repaired and ignored content.
    pub warnings: Warnings,
    /// Errors.
    pub faults: Faults,
}

impl<'a> Objects<'a> {
    /// No objects yet.
    pub fn new(view: View<'a>, materials: MaterialSet<'a>) -> Self {
        let document = &view.content.data.gltf.document;
        let mut uses = vec![0_usize; document.meshes.len()];
        let drawn = view.nodes.iter().filter_map(|node| document.nodes.get(node.index)?.mesh);
        for mesh in drawn {
            if let Some(count) = uses.get_mut(mesh.get()) {
                *count = count.saturating_add(1);
            }
        }
        let limits = &view.content.data.gltf.limits;
        Self {
            view,
            materials,
            uses,
            reported: vec![false; view.content.meshes.distinct()],
            radius: None,
            thin_left: limits.points_and_lines,
            instances_left: limits.instances,
            bytes_left: view.content.data.decoded_limit(),
            groups: IndexMap::new(),
            objects: Vec::new(),
        }
    }

    /// Adds the objects of all nodes, not of all if `control` is cancelled.
    pub fn add_all(&mut self, findings: &mut Findings, control: &BuildControl) {
        for node in self.view.nodes.iter().take_while(|_| !control.is_cancelled()) {
            if let Err(fault) = self.add(node, findings) {
                findings.faults.add(fault);
            }
        }
    }

    /// Adds the objects of a node.
    fn add(&mut self, node: &SceneNode, findings: &mut Findings) -> Result<(), Fault> {
        let (content, index) = (self.view.content, node.index);
        let document = &content.data.gltf.document;
        let Some(found) = document.nodes.get(index) else { return Ok(()) };
        let Some(mesh) = found.mesh.map(|mesh| mesh.get()) else { return Ok(()) };
        let world = self.view.worlds.get(index).copied().unwrap_or_default();
        let joints = found.skin.map(|skin| content.skins.joint_matrices(&content.data, skin.get(), self.view.worlds));
        let deformation =
            Deformation { joints: joints.transpose()?, weights: morph_weights(document, index, mesh, self.view.pose) };
        let Some(object) = self.content(index, mesh, &deformation, &world, findings)? else { return Ok(()) };
        // The transform of a node with a skin has no effect.
        let world = if deformation.joints.is_some() { DAffine3::IDENTITY } else { world };
        let is_visible = object.is_visible() && self.view.visible.get(index).copied().unwrap_or(true);
        let object = object.named(format!("{}{}", self.view.prefix, node.path)).visible(is_visible);
        let Some(instances) = content.instances.of_node(&content.data, index)? else {
            self.place(object, &world, index, findings);
            return Ok(());
        };
        let count = instances.transforms.len() as u64;
        self.instances_left = self.instances_left.checked_sub(count).ok_or_else(|| {
            let limit = content.data.gltf.limits.instances;
            Fault::at(format_args!("/nodes/{index}"), format!("the scene has more than {limit} instances, the limit"))
        })?;
        self.place_instances(object, &world, instances, index, findings);
        Ok(())
    }

    /// Places the instances of an object in world space. Singular transforms are left out.
    fn place_instances(
        &mut self,
        object: Object,
        world: &DAffine3,
        instances: &NodeInstances,
        node: usize,
        findings: &mut Findings,
    ) {
        let rows: Vec<Option<[f32; 12]>> =
            instances.transforms.iter().map(|instance| matrix_rows(&(*world * *instance))).collect();
        let hidden = rows.iter().filter(|rows| rows.is_none()).count();
        let text = "has instances with a scale of 0 or a transform out of range, which are left out";
        findings.warnings.add(format_args!("/nodes/{node}"), text, hidden as u64);
        if hidden < rows.len() {
            let attribute = |(name, Attribute { channels, numbers }): &(String, Attribute)| {
                let values = rows.iter().zip(numbers.chunks_exact((*channels).max(1)));
                let kept = values.filter(|(rows, _)| rows.is_some()).flat_map(|(_, numbers)| numbers).copied();
                let data = AttributeData::F32(kept.collect());
                (name.clone(), InstanceAttribute::new(u32::try_from(*channels).unwrap_or_default(), data))
            };
            let attributes = instances.attributes.iter().map(attribute).collect();
            let placed = Instances::from_matrices(rows.iter().flatten().copied());
            self.objects.push(object.instances(Instances { attributes, ..placed }).into());
        }
    }

    /// Places an object in world space. A singular transform hides it.
    fn place(&mut self, mut object: Object, world: &DAffine3, node: usize, findings: &mut Findings) {
        match matrix_step(world) {
            Some(_) if *world == DAffine3::IDENTITY => {}
            Some(step) => object = object.transformed(step),
            None => {
                let text = "has a scale of 0 or a transform out of range, so its mesh is hidden";
                findings.warnings.add(format_args!("/nodes/{node}"), text, 1);
                object = object.visible(false);
            }
        }
        self.objects.push(object.into());
    }

    /// Object of a mesh: its only primitive if one node draws it, else a group; `None` if nothing of
    /// it is left.
    fn content(
        &mut self,
        node: usize,
        mesh: usize,
        deformation: &Deformation,
        world: &DAffine3,
        findings: &mut Findings,
    ) -> Result<Option<Object>, Fault> {
        let content = self.view.content;
        let Some(found) = content.data.gltf.document.meshes.get(mesh) else { return Ok(None) };
        let may_deform = deformation.joints.is_some() || !deformation.weights.is_empty();
        let is_shared = !may_deform
            && (found.primitives.len() > 1
                || content.instances.has(node)
                || self.uses.get(mesh).is_some_and(|n| *n > 1));
        let name = format!("{}mesh {}", self.view.prefix, content.names.meshes.get(mesh).map_or("", String::as_str));
        if is_shared && let Some(known) = self.groups.get(&name) {
            return Ok((!known.is_empty()).then(|| Object::group(name)));
        }
        let mut parts = Vec::new();
        for (part, primitive) in found.primitives.iter().enumerate() {
            let object = self.primitive(mesh, part, primitive, deformation, world, findings);
            parts.extend(findings.faults.take(object).flatten());
        }
        if is_shared {
            let object = (!parts.is_empty()).then(|| Object::group(name.clone()));
            self.groups.insert(name, parts);
            return Ok(object);
        }
        Ok(if parts.len() > 1 { Some(Object::several(parts)) } else { parts.pop() })
    }

    /// Object of a primitive; `None` if it is left out.
    fn primitive(
        &mut self,
        mesh: usize,
        part: usize,
        primitive: &Primitive,
        deformation: &Deformation,
        world: &DAffine3,
        findings: &mut Findings,
    ) -> Result<Option<Object>, Fault> {
        let content = self.view.content;
        let Some(slot) = content.meshes.slot(mesh, part) else { return Ok(None) };
        let (geometry, warnings) = content.meshes.get(&content.data, slot)?;
        if let Some(reported) = self.reported.get_mut(slot).filter(|reported| !**reported) {
            *reported = true;
            findings.warnings.append(warnings.cloned().unwrap_or_default());
        }
        let Some(geometry) = geometry else { return Ok(None) };
        let at = pointer(mesh, part);
        let object = match (&geometry.form, geometry.deformable.as_deref()) {
            (Form::Surface(mesh), None) => Object::new(mesh.clone()),
            (Form::Surface(mesh), Some(arrays)) if !deformation.moves(arrays) => {
                with_area(mesh.clone(), &at, &mut findings.warnings)
            }
            (Form::Surface(_), Some(arrays)) => self.deformed(arrays, deformation, &at, &mut findings.warnings)?,
            (Form::Thin, Some(arrays)) => match self.thin(arrays, deformation, world, &at, findings)? {
                Some(object) => object,
                None => return Ok(None),
            },
            (Form::Thin, None) => return Ok(None),
        };
        let material = self.material_of(primitive);
        let surface = surface_of(geometry);
        Ok(Some(object.material_named(self.materials.material(material, &surface)?)))
    }

    /// Material of a primitive in the chosen variant.
    fn material_of(&self, primitive: &Primitive) -> Option<usize> {
        let mappings = primitive.extensions.variants.as_ref().map(|variants| variants.mappings.as_slice());
        let chosen = self.view.selection.variant.and_then(|wanted| {
            let mut mappings = mappings.unwrap_or_default().iter();
            mappings.find(|mapping| mapping.variants.iter().any(|variant| variant.get() == wanted))
        });
        chosen.map(|mapping| mapping.material).or(primitive.material).map(|material| material.get())
    }

    /// Object of a deformed surface.
    fn deformed(
        &mut self,
        arrays: &PrimitiveArrays,
        deformation: &Deformation,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Object, Fault> {
        let Faces::Triangles(triangles) = &arrays.faces else { return Ok(Object::default()) };
        self.reserve(arrays, at)?;
        let deformed = deformation.apply(arrays, at)?;
        warnings.add(at, "vertices without joint weights stay in place", deformed.unweighted as u64);
        Ok(with_area(deformed_mesh(deformed, triangles), at, warnings))
    }

    /// Counts the bytes of deformed arrays.
    fn reserve(&mut self, arrays: &PrimitiveArrays, at: &str) -> Result<(), Fault> {
        let vertices = arrays.vertices.positions.len() as u64;
        let bytes = vertices.saturating_mul(64).saturating_add((arrays.faces.len() as u64).saturating_mul(12));
        let limit = self.view.content.data.decoded_limit();
        let text = || format!("the deformed meshes of the scene need more than {limit} bytes, the limit");
        self.bytes_left = self.bytes_left.checked_sub(bytes).ok_or_else(|| Fault::at(at, text()))?;
        Ok(())
    }

    /// Object of points or lines; `None` if they are too many.
    fn thin(
        &mut self,
        arrays: &PrimitiveArrays,
        deformation: &Deformation,
        world: &DAffine3,
        at: &str,
        findings: &mut Findings,
    ) -> Result<Option<Object>, Fault> {
        let count = arrays.faces.len() as u64;
        let Some(left) = self.thin_left.checked_sub(count) else {
            findings.warnings.add(at, "the scene has too many points and lines; these are left out", 1);
            return Ok(None);
        };
        self.thin_left = left;
        let is_skinned = deformation.joints.is_some();
        let radius = match self.radius {
            Some(radius) => radius,
            None => relative_radius(self.view.picture_size) * diagonal(&rest_bounds(&self.view, &mut findings.faults)),
        };
        self.radius = Some(radius);
        let vertices = if deformation.moves(arrays) {
            self.reserve(arrays, at)?;
            Cow::Owned(deformation.apply(arrays, at)?.vertices)
        } else {
            Cow::Borrowed(&arrays.vertices)
        };
        let radius = local_radius(radius, if is_skinned { &DAffine3::IDENTITY } else { world });
        Ok(Some(Object::several(solids(&vertices, &arrays.faces, radius))))
    }
}

/// Object of a mesh that deforms. In a pose without area, a hidden triangle takes its place, so that
/// the objects of all times correspond.
fn with_area(mesh: Mesh, at: &str, warnings: &mut Warnings) -> Object {
    let arrays = mesh.arrays();
    if have_area(&arrays.positions, &arrays.triangles) {
        return Object::new(mesh);
    }
    warnings.add(at, "the pose leaves no triangle with an area, so the primitive is hidden", 1);
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let hidden = Mesh::from(MeshData { positions: corners, triangles: vec![[0, 1, 2]], ..MeshData::default() });
    Object::new(hidden).visible(false)
}

/// What the material of a primitive depends on.
fn surface_of(geometry: &Geometry) -> PrimitiveSurface {
    let is_surface = matches!(geometry.form, Form::Surface(_));
    PrimitiveSurface { has_color: geometry.has_color, is_lit: is_surface || geometry.has_normals }
}
