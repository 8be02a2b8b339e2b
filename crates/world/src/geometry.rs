//! Geometry under one bounding volume hierarchy: the top level of the world, or a group of objects
//! that is stored once and instantiated many times.

use super::hierarchy_entries::HierarchyEntries;
use super::instance::{Instance, LeafItem};
use super::instance_attributes::ObjectAttributes;
use super::large_mesh::{self, LargeMesh, RayCoherence};
use super::merged_meshes::{self, MergedMeshes};
use super::{Content, Object, Vertex, WorldHit};
use juggler_bvh::{Bvh, Quality, SimdLevel};
use juggler_material::{MaterialId, MaterialTable};
use juggler_math::{Aabb, BuildControl, Cancelled, Ray, Transform, Vec2, Vec3};
use juggler_shape::surface::Surface;
use juggler_shape::{Hit, InstanceValues, MeshPoint, SurfaceDerivatives};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Maximum number of shapes in a world, counting the contents of every instance: each has an index
/// of its own.
pub const MAX_OBJECTS: u64 = u32::MAX as u64;

/// Maximum nesting of instances, since each level is one recursion of traversal.
pub const MAX_DEPTH: u32 = 16;

/// Objects under one hierarchy, in a space of their own. A geometry may hold instances of other
/// geometries.
///
/// Shapes are numbered as if every instance were replaced by copies of its contents: an instance
/// takes as many indices as its geometry has shapes. So ties and hits are the same as without
/// sharing.
#[derive(Clone, Debug)]
pub struct Geometry {
    pub(super) objects: Vec<Instance>,
    /// Index of each object's first shape; empty if all objects are shapes, whose index is their
    /// position.
    first_shapes: Vec<u32>,
    /// Bounded objects in the order of the hierarchy's leaves.
    pub(super) items: Vec<LeafItem>,
    pub(super) bvh: Bvh,
    /// Large meshes beside the hierarchy, in the top level only: in others at most a packet of rays
    /// traverses them together.
    pub(super) large_meshes: Vec<LargeMesh>,
    /// Small meshes merged into a hierarchy of their own, in the top level only.
    pub(super) merged_meshes: Option<MergedMeshes>,
    /// Whether the hierarchy holds a few static spheres alone, or nothing, so that it is not traversed.
    pub(super) has_few_spheres: bool,
    /// Indices of the unbounded objects.
    pub(super) unbounded: Vec<u32>,
    pub(super) attributes: ObjectAttributes,
    bounds: Aabb,
    moves: bool,
    /// Whether any object or mesh has attributes or a second set of surface coordinates.
    pub(super) has_mesh_attributes: bool,
    /// Whether any object, of a geometry below too, has attributes as an instance.
    has_instance_attributes: bool,
    totals: GeometryTotals,
}

/// Totals of a geometry, counting the contents of every instance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryTotals {
    /// Number of shapes.
    pub shapes: u64,
    /// Number of triangles, of meshes, polygons and triangle shapes.
    pub triangles: u64,
    /// Number of instances.
    pub instances: u64,
    /// Maximum nesting depth, including this level.
    pub depth: u32,
}

impl GeometryTotals {
    fn from_objects(objects: &[Object]) -> Self {
        objects.iter().fold(Self { depth: 1, ..Self::default() }, |sum, object| {
            let more = match &object.content {
                Content::Shape(shape) => Self { shapes: 1, triangles: shape.triangles() as u64, ..Self::default() },
                Content::Geometry(geometry) => {
                    let Self { instances, depth, .. } = geometry.totals;
                    Self { instances: instances.saturating_add(1), depth: depth + 1, ..geometry.totals }
                }
            };
            Self {
                shapes: sum.shapes.saturating_add(more.shapes),
                triangles: sum.triangles.saturating_add(more.triangles),
                instances: sum.instances.saturating_add(more.instances),
                depth: sum.depth.max(more.depth),
            }
        })
    }
}

impl Geometry {
    /// Builds the hierarchy over all bounded objects. The caller must ensure at most
    /// [`MAX_OBJECTS`] shapes and a nesting depth of at most [`MAX_DEPTH`].
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn new(objects: Vec<Object>, control: &BuildControl) -> Result<Self, Cancelled> {
        Self::with_separate_meshes(objects, &[], &[], control)
    }

    /// Builds the top level of a world.
    pub(super) fn top_level(objects: Vec<Object>, control: &BuildControl) -> Result<Self, Cancelled> {
        let large_meshes = large_mesh::indices(&objects);
        let small_meshes = merged_meshes::indices(&objects, &large_meshes);
        Self::with_separate_meshes(objects, &large_meshes, &small_meshes, control)
    }

    /// Builds a geometry whose objects `large_meshes` stay beside the hierarchy, and whose meshes
    /// `small_meshes` are merged.
    fn with_separate_meshes(
        objects: Vec<Object>,
        large_meshes: &[u32],
        small_meshes: &[u32],
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let totals = GeometryTotals::from_objects(&objects);
        debug_assert!(totals.shapes <= MAX_OBJECTS && totals.depth <= MAX_DEPTH);
        let first_shapes = if totals.instances == 0 { Vec::new() } else { first_shapes(&objects) };
        let shape_index = |object_index: u32| first_shapes.get(object_index as usize).copied().unwrap_or(object_index);
        let merged_meshes = MergedMeshes::new(&objects, small_meshes, shape_index, control);
        let separate: BTreeSet<u32> = large_meshes.iter().chain(small_meshes).copied().collect();
        let indices = (0..objects.len() as u32).filter(|object_index| !separate.contains(object_index));
        let all_boxes: Vec<Aabb> = objects.iter().map(Object::bounds).collect();
        let bounds = all_boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
        let (bounded, unbounded): (Vec<u32>, Vec<u32>) =
            indices.partition(|i| objects[*i as usize].is_bounded_by(&all_boxes[*i as usize]));
        let mut entries = HierarchyEntries::new(&objects, bounded, all_boxes, control);
        let large_mesh = |i: &u32| LargeMesh::new(&objects[*i as usize], *i, shape_index(*i));
        let large_meshes = large_meshes.iter().map(large_mesh).collect();
        let moves = objects.iter().any(Object::moves);
        let attributes = ObjectAttributes::new(&objects);
        let [has_instance_attributes, has_mesh_attributes] = have_attributes(&objects, &attributes);
        // Free the descriptions of the objects before the hierarchy is built.
        let objects = Instance::from_objects(objects);
        control.check()?;
        let bvh = Bvh::build_with_control(std::mem::take(&mut entries.boxes), &Quality::Balanced.into(), control)?;
        let items = entries.items(bvh.order(), &objects, shape_index);
        Ok(Self {
            objects,
            first_shapes,
            has_few_spheres: LeafItem::are_few_spheres(&items),
            items,
            bvh,
            large_meshes,
            merged_meshes,
            unbounded,
            attributes,
            bounds,
            moves,
            has_mesh_attributes,
            has_instance_attributes,
            totals,
        })
    }

    /// Sets the SIMD instruction set of this geometry and all geometries below it.
    pub(super) fn at_simd_level(&self, simd: SimdLevel) -> Self {
        let mut geometry = self.clone();
        geometry.bvh = geometry.bvh.with_simd_level(simd);
        geometry.merged_meshes = geometry.merged_meshes.map(|merged_meshes| merged_meshes.with_simd_level(simd));
        for instance in &mut geometry.objects {
            match &mut instance.content {
                Content::Geometry(below) => *below = Arc::new(below.at_simd_level(simd)),
                Content::Shape(shape) => {
                    if let Some(mesh) = shape.mesh() {
                        *shape = Arc::new(mesh.with_simd_level(simd).into());
                    }
                }
            }
        }
        geometry
    }

    /// Bounding box of all bounded contents over the shutter interval; empty if there are none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Radius of a sphere around all bounded contents; 1 if there are none.
    pub fn radius(&self) -> f32 {
        let radius = 0.5 * self.bounds.extent().length();
        if radius > 0.0 && radius < f32::INFINITY { radius } else { 1.0 }
    }

    /// Whether any content moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// Whether any object, of a geometry below too, has attributes as an instance.
    pub(super) fn has_instance_attributes(&self) -> bool {
        self.has_instance_attributes
    }

    /// Whether all contents are bounded.
    pub fn is_bounded(&self) -> bool {
        self.unbounded.is_empty()
    }

    /// Totals of the contents.
    pub fn totals(&self) -> &GeometryTotals {
        &self.totals
    }

    /// Index of the first shape of the object of index `object_index`.
    #[inline]
    pub(super) fn first_shape(&self, object_index: u32) -> u32 {
        self.first_shapes.get(object_index as usize).copied().unwrap_or(object_index)
    }

    /// Object that contains the shape `shape_index`, and the index of the shape within the object.
    #[inline(always)]
    pub(super) fn find(&self, shape_index: u32) -> (&Instance, u32) {
        if self.first_shapes.is_empty() {
            return (&self.objects[shape_index as usize], 0);
        }
        let object_index = self.object_index(shape_index) as usize;
        (&self.objects[object_index], shape_index - self.first_shapes[object_index])
    }

    /// Material of the shape `shape_index`. `inherited` is the material of objects that have none.
    pub(super) fn material(&self, shape_index: u32, inherited: Option<MaterialId>) -> MaterialId {
        let (instance, shape_index) = self.find(shape_index);
        let material = instance.material().or(inherited);
        match &instance.content {
            Content::Shape(_) => material.unwrap_or(MaterialId::NONE),
            Content::Geometry(geometry) => geometry.material(shape_index, material),
        }
    }

    /// Surface at a hit of the shape `shape_index`, in this geometry's space. `inherited` is the
    /// material of objects that have none.
    #[inline(always)]
    pub(super) fn vertex(
        &self,
        ray: &Ray,
        hit: &WorldHit,
        shape_index: u32,
        inherited: Option<MaterialId>,
        materials: &MaterialTable,
    ) -> Vertex {
        let (instance, shape_index) = self.find(shape_index);
        let material = instance.material().or(inherited);
        match &instance.content {
            Content::Shape(shape) => {
                let material = material.unwrap_or(MaterialId::NONE);
                let surface = instance.surface(shape, ray, &hit.hit, !materials.is_textured(material));
                Vertex { surface, material, shape: hit.shape, primitive: hit.hit.primitive, tangents: None }
            }
            Content::Geometry(geometry) => {
                geometry.instance_vertex(&instance.motion.at(ray.time), ray, hit, shape_index, material, materials)
            }
        }
    }

    /// [`Geometry::vertex`] through the transform of an instance.
    #[inline(never)]
    fn instance_vertex(
        &self,
        transform: &Transform,
        ray: &Ray,
        hit: &WorldHit,
        shape_index: u32,
        inherited: Option<MaterialId>,
        materials: &MaterialTable,
    ) -> Vertex {
        let vertex = self.vertex(&transform.ray_to_local(ray), hit, shape_index, inherited, materials);
        Vertex { surface: vertex.surface.to_world(transform), ..vertex }
    }

    /// Derivatives ∂p/∂u and ∂p/∂v at a hit, in this geometry's space and in object space. `local`
    /// is the object-space point of the vertex.
    pub(super) fn derivatives(
        &self,
        local: Vec3,
        hit: &Hit,
        shape_index: u32,
        time: f32,
    ) -> Option<[SurfaceDerivatives; 2]> {
        let (instance, shape_index) = self.find(shape_index);
        let [derivatives, object_derivatives] = match &instance.content {
            Content::Shape(shape) => [shape.derivatives(local, hit, time)?; 2],
            Content::Geometry(geometry) => geometry.derivatives(local, hit, shape_index, time)?,
        };
        Some([derivatives.transformed(&instance.motion.at(time)), object_derivatives])
    }

    /// Tangent and bitangent that a mesh gives at a surface of the shape `shape_index`, in this
    /// geometry's space and in object space. Both are transformed as vectors, not as normals.
    pub(super) fn tangent_frame(
        &self,
        surface: &Surface,
        hit: &Hit,
        shape_index: u32,
        time: f32,
    ) -> Option<[SurfaceDerivatives; 2]> {
        let (instance, shape_index) = self.find(shape_index);
        let [frame, object_frame] = match &instance.content {
            Content::Shape(shape) => [shape.tangent_frame(hit.primitive, surface, time)?; 2],
            Content::Geometry(geometry) => geometry.tangent_frame(surface, hit, shape_index, time)?,
        };
        Some([frame.transformed(&instance.motion.at(time)), object_frame])
    }

    /// Offset from a surface of the shape `shape_index` to the smooth surface that its shading normals
    /// describe, in this geometry's space; see [`Surface::lifted`]. The ray hits the surface.
    pub(super) fn lift(&self, ray: &Ray, surface: &Surface, shape_index: u32, primitive: u32) -> Option<Vec3> {
        let (instance, shape_index) = self.find(shape_index);
        let local = instance.ray_to_object(ray);
        let lift = match &instance.content {
            Content::Shape(shape) => shape.lift(primitive, surface, &local)?,
            Content::Geometry(geometry) => geometry.lift(&local, surface, shape_index, primitive)?,
        };
        Some(instance.motion.at(ray.time).vector(lift))
    }

    /// Point of a mesh with attributes or a second set of surface coordinates, or of instances with
    /// attributes, at a surface of the shape `shape_index`; `None` on all other surfaces.
    #[inline(never)]
    pub(super) fn mesh_point(&self, surface: &Surface, shape_index: u32, primitive: u32) -> Option<MeshPoint<'_>> {
        let (instance, inner_index) = self.find(shape_index);
        let point = match &instance.content {
            Content::Shape(shape) => shape.mesh_point(primitive, surface),
            Content::Geometry(geometry) => geometry.mesh_point(surface, inner_index, primitive),
        };
        if !self.has_instance_attributes {
            return point;
        }
        Some(point.unwrap_or_default().with_instances(self, shape_index, surface.uv.y))
    }

    /// Index of the object that contains the shape `shape_index`.
    #[inline(always)]
    fn object_index(&self, shape_index: u32) -> u32 {
        if self.first_shapes.is_empty() {
            return shape_index;
        }
        self.first_shapes.partition_point(|first| *first <= shape_index) as u32 - 1
    }

    /// Bounding box of the shape `shape_index`, in this geometry's space; empty if it is unbounded.
    pub(super) fn shape_bounds(&self, shape_index: u32) -> Aabb {
        let (instance, shape_index) = self.find(shape_index);
        let bounds = match &instance.content {
            Content::Shape(shape) => shape.bounds(),
            Content::Geometry(geometry) => geometry.shape_bounds(shape_index),
        };
        let bounds = instance.motion.aabb(&bounds);
        if bounds.is_finite() { bounds } else { Aabb::EMPTY }
    }

    /// Intersects one ray with an instance of this geometry and replaces `best` by a nearer hit.
    /// `first` is the index of the geometry's first shape.
    #[inline(never)]
    pub(super) fn closest(&self, ray: &mut Ray, first: u32, best: &mut WorldHit) {
        self.intersect_rays(std::slice::from_mut(ray), RayCoherence::Incoherent, first, std::slice::from_mut(best));
    }
}

impl InstanceValues for Geometry {
    fn value(&self, shape_index: u32, name: &str, at: Vec2) -> Option<[f32; 4]> {
        let (instance, inner_index) = self.find(shape_index);
        let inner = match &instance.content {
            Content::Geometry(geometry) if geometry.has_instance_attributes => geometry.value(inner_index, name, at),
            _ => None,
        };
        inner.or_else(|| self.attributes.value(self.object_index(shape_index), name, at))
    }
}

/// Index of each object's first shape.
fn first_shapes(objects: &[Object]) -> Vec<u32> {
    let mut next = 0_u32;
    let first = |object: &Object| {
        let first = next;
        next = next.wrapping_add(object.shapes() as u32);
        first
    };
    objects.iter().map(first).collect()
}

/// Whether objects, or those below them, have attributes of instances, and attributes at all.
fn have_attributes(objects: &[Object], attributes: &ObjectAttributes) -> [bool; 2] {
    let of_instances = !attributes.is_empty() || objects.iter().any(|object| object.content.has_instance_attributes());
    [of_instances, of_instances || objects.iter().any(|object| object.content.has_mesh_attributes())]
}
