//! Shapes in world space, including the contents of instances.

use super::{Content, Geometry};
use juggler_material::MaterialId;
use juggler_math::{Motion, Transform};
use juggler_shape::AnyShape;
use std::collections::BTreeMap;
use std::ptr;
use std::sync::Arc;

/// A shape in world space.
#[derive(Clone, Debug)]
pub struct WorldShape {
    /// Index of the shape, counting the contents of every instance.
    pub shape_index: u32,
    pub shape: Arc<AnyShape>,
    pub motion: Motion,
    pub material: MaterialId,
}

/// Collects up to `limit` shapes for which `predicate` returns true, given shape and material, from
/// a geometry and those below.
pub fn collect_shapes(
    top: &Geometry,
    limit: usize,
    predicate: &dyn Fn(&AnyShape, MaterialId) -> bool,
) -> Vec<WorldShape> {
    let mut search = Search { predicate, limit, found: Vec::new(), contains_match: BTreeMap::new() };
    search.collect(top, &InstanceContext { motion: Transform::IDENTITY.into(), first: 0, inherited: None });
    search.found
}

/// Transform, first shape index and inherited material of an instance.
struct InstanceContext {
    motion: Motion,
    first: u32,
    inherited: Option<MaterialId>,
}

struct Search<'a> {
    predicate: &'a dyn Fn(&AnyShape, MaterialId) -> bool,
    limit: usize,
    found: Vec<WorldShape>,
    /// Whether a geometry contains any matching shape, for each inherited material: a geometry may
    /// have many instances.
    contains_match: BTreeMap<(*const Geometry, Option<MaterialId>), bool>,
}

impl Search<'_> {
    fn collect(&mut self, geometry: &Geometry, context: &InstanceContext) {
        for (object_index, instance) in (0..).zip(&geometry.objects) {
            if self.found.len() >= self.limit {
                return;
            }
            let shape_index = context.first + geometry.first_shape(object_index);
            let material = instance.material.or(context.inherited);
            match &instance.content {
                Content::Shape(shape) => {
                    if let Some(material) = material.filter(|material| (self.predicate)(shape, *material)) {
                        let motion = instance.motion.then(&context.motion);
                        self.found.push(WorldShape { shape_index, shape: Arc::clone(shape), motion, material });
                    }
                }
                Content::Geometry(below) if self.has_any(below, material) => {
                    let motion = instance.motion.then(&context.motion);
                    self.collect(below, &InstanceContext { motion, first: shape_index, inherited: material });
                }
                Content::Geometry(_) => {}
            }
        }
    }

    /// Whether a geometry contains any matching shape.
    fn has_any(&mut self, geometry: &Geometry, inherited: Option<MaterialId>) -> bool {
        let key = (ptr::from_ref(geometry), inherited);
        if let Some(known) = self.contains_match.get(&key) {
            return *known;
        }
        let has_any = geometry.objects.iter().any(|instance| {
            let material = instance.material.or(inherited);
            match &instance.content {
                Content::Shape(shape) => material.is_some_and(|material| (self.predicate)(shape, material)),
                Content::Geometry(below) => self.has_any(below, material),
            }
        });
        self.contains_match.insert(key, has_any);
        has_any
    }
}
