//! Placement of prepared objects: expands or shares groups, composes transforms, and inherits materials
//! and attributes.

use super::prepared_instances::PreparedInstances;
use juggler_material::MaterialId;
use juggler_math::{BuildControl, Motion, Transform};
use juggler_shape::AnyShape;
use juggler_world::{Content as WorldContent, Geometry, InstanceAttributes};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Object with prepared shapes and resolved names.
pub struct Prepared<'s> {
    /// Index in its list.
    pub index: usize,
    pub motion: Motion,
    /// `None` for an object without instances.
    pub instances: Option<PreparedInstances<'s>>,
    pub material: Option<MaterialId>,
    pub content: Content<'s>,
}

/// Content of an object.
pub enum Content<'s> {
    Shapes(Vec<(Motion, Arc<AnyShape>)>),
    Group(&'s str),
    Objects(Vec<Prepared<'s>>),
}

/// Diameter of the bounding box after a motion; 1 for unbounded content.
fn size(motion: &Motion, content: &WorldContent) -> f32 {
    let bounds = match content {
        WorldContent::Shape(shape) => shape.bounds(),
        WorldContent::Geometry(geometry) => geometry.bounds(),
    };
    let size = motion.at(0.0).aabb(&bounds).extent().length();
    if size.is_finite() { size } else { 1.0 }
}

/// Creates an object of the world. Resamples its motion so that rotations follow arcs.
pub fn new_object(content: WorldContent, motion: Motion, material: Option<MaterialId>) -> juggler_world::Object {
    let motion = if motion.moves() { motion.clone().smoothed(size(&motion, &content)) } else { motion };
    juggler_world::Object { content, motion, material, attributes: None }
}

/// Prepared objects of all groups, and the levels that are built of them.
pub struct Placer<'s> {
    groups: BTreeMap<&'s str, Vec<Prepared<'s>>>,
    /// Levels of shared groups built so far.
    levels: BTreeMap<&'s str, Arc<Geometry>>,
    control: &'s BuildControl,
}

impl<'s> Placer<'s> {
    /// Builds the levels of the `shared` groups, each of which follows the groups that it places. Once
    /// `control` is cancelled, levels and objects are missing.
    pub fn new(
        groups: BTreeMap<&'s str, Vec<Prepared<'s>>>,
        shared: impl Iterator<Item = &'s str>,
        control: &'s BuildControl,
    ) -> Self {
        let mut placer = Self { groups, levels: BTreeMap::new(), control };
        for name in shared {
            let objects = placer.objects(placer.groups.get(name).map(Vec::as_slice).unwrap_or_default());
            let Ok(level) = Geometry::new(objects, control) else { break };
            placer.levels.insert(name, Arc::new(level));
        }
        placer
    }

    /// Objects of the top level, and the index of the first shape of each of `count` scene entries.
    pub fn entries(
        &self,
        objects: &[Prepared<'_>],
        count: usize,
        default_material: MaterialId,
    ) -> (Vec<juggler_world::Object>, Vec<u32>) {
        let (mut found, mut firsts, mut shapes) = (Vec::new(), Vec::with_capacity(count), 0u64);
        let number = |shapes: u64| u32::try_from(shapes).unwrap_or(u32::MAX);
        for object in objects.iter().take_while(|_| !self.control.is_cancelled()) {
            firsts.resize(firsts.len().max(object.index + 1), number(shapes));
            let before = found.len();
            let inherited = Inherited { material: Some(default_material), attributes: None };
            self.place(std::slice::from_ref(object), &Transform::IDENTITY.into(), &inherited, &mut found);
            let new = found.get(before..).unwrap_or_default();
            shapes = new.iter().map(juggler_world::Object::shapes).fold(shapes, u64::saturating_add);
        }
        firsts.resize(count.max(firsts.len()), number(shapes));
        (found, firsts)
    }

    /// Objects of a level that is shared; objects without a material inherit that of each placement.
    fn objects(&self, objects: &[Prepared<'_>]) -> Vec<juggler_world::Object> {
        let mut found = Vec::new();
        let inherited = Inherited { material: None, attributes: None };
        self.place(objects, &Transform::IDENTITY.into(), &inherited, &mut found);
        found
    }

    fn place(
        &self,
        objects: &[Prepared<'_>],
        parent: &Motion,
        inherited: &Inherited,
        found: &mut Vec<juggler_world::Object>,
    ) {
        for object in objects.iter().take_while(|_| !self.control.is_cancelled()) {
            let motion = object.motion.then(parent);
            let Inherited { material, attributes } = inherited.clone();
            let inherited = Inherited { material: object.material.or(material), attributes };
            match &object.instances {
                None => self.place_content(&object.content, motion, &inherited, found),
                Some(instances) => self.place_instances(instances, &object.content, &motion, inherited, found),
            }
        }
    }

    fn place_instances(
        &self,
        instances: &PreparedInstances<'_>,
        content: &Content<'_>,
        parent: &Motion,
        mut inherited: Inherited,
        found: &mut Vec<juggler_world::Object>,
    ) {
        found.reserve(instances.count());
        let attributes = instances.attributes(inherited.attributes.as_ref());
        for index in (0..instances.count()).take_while(|_| !self.control.is_cancelled()) {
            if let (Some(list), Ok(index)) = (&attributes, u32::try_from(index)) {
                inherited.attributes = Some(InstanceAttributes { list: Arc::clone(list), index });
            }
            self.place_content(content, instances.motion(index).then(parent), &inherited, found);
        }
    }

    fn place_content(
        &self,
        content: &Content<'_>,
        motion: Motion,
        inherited: &Inherited,
        found: &mut Vec<juggler_world::Object>,
    ) {
        match content {
            Content::Shapes(shapes) => objects_of(shapes, &motion, inherited, found),
            Content::Objects(objects) => self.place(objects, &motion, inherited, found),
            Content::Group(name) => match self.levels.get(name) {
                Some(level) => {
                    let object = new_object(WorldContent::Geometry(Arc::clone(level)), motion, inherited.material);
                    add(object, inherited, found);
                }
                None => {
                    let objects = self.groups.get(name).map(Vec::as_slice).unwrap_or_default();
                    self.place(objects, &motion, inherited, found);
                }
            },
        }
    }
}

/// Material and attributes of objects that have none of their own.
#[derive(Clone)]
struct Inherited {
    material: Option<MaterialId>,
    attributes: Option<InstanceAttributes>,
}

fn objects_of(
    shapes: &[(Motion, Arc<AnyShape>)],
    motion: &Motion,
    inherited: &Inherited,
    found: &mut Vec<juggler_world::Object>,
) {
    for (place, shape) in shapes {
        let content = WorldContent::Shape(Arc::clone(shape));
        add(new_object(content, place.then(motion), inherited.material), inherited, found);
    }
}

/// Adds an object, which shares the linear part of its transform with the one before if they are equal.
fn add(object: juggler_world::Object, inherited: &Inherited, found: &mut Vec<juggler_world::Object>) {
    let motion = match found.last() {
        Some(previous) => object.motion.sharing(&previous.motion),
        None => object.motion,
    };
    found.push(juggler_world::Object { motion, attributes: inherited.attributes.clone(), ..object });
}
