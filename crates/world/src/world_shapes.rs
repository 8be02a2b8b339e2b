//! Shapes in world space, including the contents of instances.

use super::{Content, Geometry, InstanceAttributes};
use juggler_material::MaterialId;
use juggler_math::{Aabb, Motion, Transform};
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
    pub motion: WorldMotion,
    /// Motion without rotation of a sphere that moves.
    pub sphere_motion: Option<Box<WorldMotion>>,
    pub material: MaterialId,
    /// Attributes of the shape's instances, the innermost first.
    pub attributes: Option<InstanceAttributes>,
}

/// Transform of a shape to world space as a function of shutter time. It equals the transforms that
/// ray queries apply one after another.
#[derive(Clone, Debug)]
pub enum WorldMotion {
    /// One motion.
    Single(Motion),
    /// Motions of nested instances, the innermost first. Products of moving transforms are not
    /// linear between keys, so a single motion cannot replace them.
    Nested(Arc<[Motion]>),
}

impl WorldMotion {
    /// Motion of an object whose instance has the motion `outer`.
    fn of_instance(inner: &Motion, outer: &Self) -> Self {
        match outer {
            Self::Single(outer) if !(inner.moves() && outer.moves()) => Self::Single(inner.then(outer)),
            Self::Single(outer) => Self::Nested([inner.clone(), outer.clone()].into()),
            Self::Nested(outer) => Self::Nested(std::iter::once(inner).chain(outer.iter()).cloned().collect()),
        }
    }

    /// Transform to world space; `None` if the shape moves.
    pub fn static_transform(&self) -> Option<Transform> {
        match self {
            Self::Single(motion) => motion.still(),
            Self::Nested(_) => None,
        }
    }

    /// Transform at a time, which is clamped to 0 to 1.
    pub fn at(&self, time: f32) -> Transform {
        match self {
            Self::Single(motion) => motion.at(time),
            Self::Nested(all) => all.iter().fold(Transform::IDENTITY, |inner, outer| inner.then(&outer.at(time))),
        }
    }

    /// Bounds of a local box over the whole shutter interval.
    pub fn aabb(&self, local: &Aabb) -> Aabb {
        match self {
            Self::Single(motion) => motion.aabb(local),
            Self::Nested(all) => all.iter().fold(*local, |bounds, motion| motion.aabb(&bounds)),
        }
    }

    /// Upper bound of [`Transform::max_scale`] over the whole shutter interval.
    pub fn max_scale(&self) -> f32 {
        let largest = |motion: &Motion| motion.keys().iter().map(Transform::max_scale).fold(0.0, f32::max);
        match self {
            Self::Single(motion) => largest(motion),
            Self::Nested(all) => all.iter().map(largest).product(),
        }
    }
}

/// Collects up to `limit` shapes for which `predicate` returns true, given shape and material, from
/// a geometry and those below.
pub fn collect_shapes(
    top: &Geometry,
    limit: usize,
    predicate: &dyn Fn(&AnyShape, MaterialId) -> bool,
) -> Vec<WorldShape> {
    let mut search = Search { predicate, limit, found: Vec::new(), contains_match: BTreeMap::new() };
    let motion = WorldMotion::Single(Transform::IDENTITY.into());
    search.collect(top, &InstanceContext { motion, first: 0, inherited: None, attributes: None });
    search.found
}

/// Transform, first shape index and inherited material of an instance.
struct InstanceContext {
    motion: WorldMotion,
    first: u32,
    inherited: Option<MaterialId>,
    attributes: Option<InstanceAttributes>,
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
            let material = instance.material().or(context.inherited);
            let attributes = || match (geometry.attributes.of_object(object_index), &context.attributes) {
                (Some(own), Some(outer)) => Some(own.within(outer)),
                (own, outer) => own.or_else(|| outer.clone()),
            };
            match &instance.content {
                Content::Shape(shape) => {
                    if let Some(material) = material.filter(|material| (self.predicate)(shape, *material)) {
                        let to_world = |motion: &Motion| WorldMotion::of_instance(motion, &context.motion);
                        let sphere_motion = instance.sphere_motion(shape).map(|motion| Box::new(to_world(&motion)));
                        let (motion, shape) = (to_world(&instance.motion), Arc::clone(shape));
                        let attributes = attributes();
                        self.found.push(WorldShape { shape_index, shape, motion, sphere_motion, material, attributes });
                    }
                }
                Content::Geometry(below) if self.has_any(below, material) => {
                    let motion = WorldMotion::of_instance(&instance.motion, &context.motion);
                    let (inherited, attributes) = (material, attributes());
                    self.collect(below, &InstanceContext { motion, first: shape_index, inherited, attributes });
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
            let material = instance.material().or(inherited);
            match &instance.content {
                Content::Shape(shape) => material.is_some_and(|material| (self.predicate)(shape, material)),
                Content::Geometry(below) => self.has_any(below, material),
            }
        });
        self.contains_match.insert(key, has_any);
        has_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Vec3;
    use juggler_math::testing::{Random, close3};

    /// A motion between two random transforms.
    fn motion(random: &mut Random) -> Motion {
        Motion::from_keys(vec![random.transform(), random.transform()]).unwrap()
    }

    #[test]
    fn nested_motions_equal_one_motion_after_another() {
        let mut random = Random::new(71);
        let still = Motion::from(random.transform());
        let all = [motion(&mut random), still, motion(&mut random), motion(&mut random)];
        let top = WorldMotion::Single(Transform::IDENTITY.into());
        let nested = all.iter().rev().fold(top, |outer, inner| WorldMotion::of_instance(inner, &outer));
        assert!(nested.static_transform().is_none());
        let local = Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE };
        let bounds = nested.aabb(&local);
        for _ in 0..200 {
            let (time, point) = (random.f32(), local.min + local.extent() * random.vec3());
            let expected = all.iter().fold(point, |point, motion| motion.at(time).point(point));
            let found = nested.at(time).point(point);
            assert!(close3(found, expected, 1e-3 * expected.length().max(1.0)) && bounds.contains(found), "{time}");
            assert!(nested.at(time).max_scale() <= nested.max_scale() * 1.001);
        }
    }
}
