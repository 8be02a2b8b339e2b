//! Objects that stand together under one hierarchy: the world's own, or those of a group that is stored once
//! and placed many times.

use super::items::{Item, Placed};
use super::large::{self, Large, Order};
use super::merged::{self, Merged};
use super::{Content, Object, Vertex, WorldHit};
use juggler_bvh::{Bvh, Quality, SimdLevel};
use juggler_material::{MaterialId, MaterialTable};
use juggler_math::{Aabb, Ray, Transform, Vec3};
use juggler_shape::{AnyShape, Derivatives, Hit};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Most objects that a world may place, those of groups counted as often as they are placed: each has a number
/// of its own.
pub const MAX_OBJECTS: u64 = u32::MAX as u64;

/// Most levels on the way from the world to a shape: each is a step of recursion while tracing.
pub const MAX_DEPTH: u32 = 16;

/// Objects under one hierarchy, in a space of their own. A level may hold instances of other levels.
///
/// Its objects are numbered as if every instance were replaced by what it holds: an instance takes as many
/// numbers as its level has. So ties go the same way, and hits carry the same numbers, as if no level were
/// shared.
#[derive(Clone, Debug)]
pub struct Level {
    pub(super) objects: Vec<Placed>,
    /// Number of each object's first shape; nothing where an object's place is its number, because all are shapes.
    firsts: Vec<u32>,
    /// Bounded objects in the hierarchy's order.
    pub(super) items: Vec<Item>,
    pub(super) bvh: Bvh,
    /// Large meshes beside the hierarchy, in the world's own level only: others are met by a packet at most.
    pub(super) large: Vec<Large>,
    /// Small meshes beside the hierarchy as one, in the world's own level only.
    pub(super) merged: Option<Merged>,
    /// Places of the objects without an end.
    pub(super) unbounded: Vec<u32>,
    bounds: Aabb,
    moves: bool,
    totals: Totals,
}

/// What a level holds, shared levels counted as often as they stand in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Shapes.
    pub shapes: u64,
    /// Triangles of all meshes, polygons and triangles.
    pub triangles: u64,
    /// Instances of levels.
    pub instances: u64,
    /// Levels on the longest way down, this one counted.
    pub depth: u32,
}

impl Totals {
    fn of(objects: &[Object]) -> Self {
        objects.iter().fold(Self { depth: 1, ..Self::default() }, |sum, object| {
            let more = match &object.content {
                Content::Shape(shape) => Self { shapes: 1, triangles: shape.triangles() as u64, ..Self::default() },
                Content::Level(level) => {
                    let Self { instances, depth, .. } = level.totals;
                    Self { instances: instances.saturating_add(1), depth: depth + 1, ..level.totals }
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

impl Level {
    /// Builds the hierarchy over all bounded objects. At most [`MAX_OBJECTS`] shapes and [`MAX_DEPTH`] levels below
    /// each other, which whoever makes levels from files must see to.
    pub fn new(objects: Vec<Object>) -> Self {
        Self::beside(objects, &[], &[])
    }

    /// The world's own level.
    pub(super) fn top(objects: Vec<Object>) -> Self {
        let large = large::places(&objects);
        let small = merged::places(&objects, &large);
        Self::beside(objects, &large, &small)
    }

    /// The objects at the places `large` stand beside the hierarchy, and the meshes at `small` as one.
    fn beside(objects: Vec<Object>, large: &[u32], small: &[u32]) -> Self {
        let totals = Totals::of(&objects);
        debug_assert!(totals.shapes <= MAX_OBJECTS && totals.depth <= MAX_DEPTH);
        let firsts = if totals.instances == 0 { Vec::new() } else { firsts(&objects) };
        let number = |place: u32| firsts.get(place as usize).copied().unwrap_or(place);
        let merged = Merged::new(&objects, small, number);
        let apart: BTreeSet<u32> = large.iter().chain(small).copied().collect();
        let places = (0..objects.len() as u32).filter(|place| !apart.contains(place));
        let (bounded, unbounded): (Vec<u32>, Vec<u32>) = places.partition(|i| objects[*i as usize].is_bounded());
        let boxes: Vec<Aabb> = bounded.iter().map(|place| objects[*place as usize].bounds()).collect();
        let bvh = Bvh::build(&boxes, Quality::Balanced);
        let order = bvh.order().iter().map(|position| bounded[*position as usize]);
        let items = order.map(|place| Item::new(&objects[place as usize], place, number(place))).collect();
        let large = large.iter().map(|place| Large::new(&objects[*place as usize], *place, number(*place))).collect();
        let bounds = objects.iter().map(Object::bounds).fold(Aabb::EMPTY, Aabb::union);
        let moves = objects.iter().any(Object::moves);
        let objects = objects.into_iter().map(Placed::new).collect();
        Self { objects, firsts, items, bvh, large, merged, unbounded, bounds, moves, totals }
    }

    /// The same level and all below it for another vector unit than the best of this machine.
    pub(super) fn at_simd_level(&self, simd: SimdLevel) -> Self {
        let mut level = self.clone();
        level.bvh = level.bvh.with_simd_level(simd);
        level.merged = level.merged.map(|merged| merged.with_simd_level(simd));
        for placed in &mut level.objects {
            match &mut placed.content {
                Content::Level(below) => *below = Arc::new(below.at_simd_level(simd)),
                Content::Shape(shape) => {
                    if let AnyShape::Mesh(mesh) = &**shape {
                        *shape = Arc::new(mesh.with_simd_level(simd).into());
                    }
                }
            }
        }
        level
    }

    /// A box around everything in it that has an end, wherever it comes; empty when nothing has.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Whether anything in it moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// Whether everything in it has an end.
    pub fn is_bounded(&self) -> bool {
        self.unbounded.is_empty()
    }

    /// What it holds.
    pub fn totals(&self) -> &Totals {
        &self.totals
    }

    /// Number of the first shape of the object at `place`.
    #[inline]
    pub(super) fn first(&self, place: u32) -> u32 {
        self.firsts.get(place as usize).copied().unwrap_or(place)
    }

    /// The object that the shape `number` belongs to, and the shape's number in it.
    #[inline(always)]
    pub(super) fn find(&self, number: u32) -> (&Placed, u32) {
        if self.firsts.is_empty() {
            return (&self.objects[number as usize], 0);
        }
        let place = self.firsts.partition_point(|first| *first <= number) - 1;
        (&self.objects[place], number - self.firsts[place])
    }

    /// What a ray met, in this level's space, by the shape's `number` in it; made of `inherited` where nothing says.
    #[inline(always)]
    pub(super) fn vertex(
        &self,
        ray: &Ray,
        hit: &WorldHit,
        number: u32,
        inherited: Option<MaterialId>,
        materials: &MaterialTable,
    ) -> Vertex {
        let (placed, number) = self.find(number);
        let material = placed.material.or(inherited);
        match &placed.content {
            Content::Shape(shape) => {
                let material = material.unwrap_or(MaterialId::NONE);
                let surface = placed.surface(shape, ray, &hit.hit, !materials.is_textured(material));
                Vertex { surface, material, object: hit.object, part: hit.hit.part, tangents: None }
            }
            Content::Level(level) => {
                level.instanced(&placed.motion.at(ray.time), ray, hit, number, material, materials)
            }
        }
    }

    /// [`Level::vertex`] seen through the transform of an instance.
    #[inline(never)]
    fn instanced(
        &self,
        transform: &Transform,
        ray: &Ray,
        hit: &WorldHit,
        number: u32,
        inherited: Option<MaterialId>,
        materials: &MaterialTable,
    ) -> Vertex {
        let vertex = self.vertex(&transform.ray_to_local(ray), hit, number, inherited, materials);
        Vertex { surface: vertex.surface.to_world(transform), ..vertex }
    }

    /// How the surface at a hit runs along its coordinates, in this level's space and in object space. `local` is that of
    /// the vertex there.
    pub(super) fn derivatives(&self, local: Vec3, hit: &Hit, number: u32, time: f32) -> Option<[Derivatives; 2]> {
        let (placed, number) = self.find(number);
        let [found, own] = match &placed.content {
            Content::Shape(shape) => [shape.derivatives(local, hit, time)?; 2],
            Content::Level(level) => level.derivatives(local, hit, number, time)?,
        };
        Some([found.through(&placed.motion.at(time)), own])
    }

    /// A box around the shape `number`, in this level's space; empty when it has no end.
    pub(super) fn shape_bounds(&self, number: u32) -> Aabb {
        let (placed, number) = self.find(number);
        let bounds = match &placed.content {
            Content::Shape(shape) => shape.bounds(),
            Content::Level(level) => level.shape_bounds(number),
        };
        let bounds = placed.motion.aabb(&bounds);
        if bounds.is_finite() { bounds } else { Aabb::EMPTY }
    }

    /// The nearest hit of one ray that goes through an instance of this level, which keeps it if it is better than
    /// `best`. `first` is the number of the level's first shape.
    #[inline(never)]
    pub(super) fn closest(&self, ray: &mut Ray, first: u32, best: &mut WorldHit) {
        self.improve(std::slice::from_mut(ray), Order::Any, first, std::slice::from_mut(best));
    }
}

/// Number of each object's first shape.
fn firsts(objects: &[Object]) -> Vec<u32> {
    let mut next = 0_u32;
    let first = |object: &Object| {
        let first = next;
        next = next.wrapping_add(object.shapes() as u32);
        first
    };
    objects.iter().map(first).collect()
}
