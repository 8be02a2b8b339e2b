//! Objects in their places: groups expanded or shared, transforms joined, materials inherited.

use super::count::Counts;
use super::materials::Materials;
use super::meshes::Files;
use crate::description::{Bead, Description, Object, TransformStep};
use crate::path::{Path, Trail};
use crate::report::Finding;
use juggler_math::Transform;
use juggler_tracer::material::MaterialId;
use juggler_tracer::shape::{AnyShape, Sphere};
use juggler_tracer::world::{self, Content as Placed, Level};
use std::collections::BTreeMap;
use std::sync::Arc;

/// All objects of a scene whose groups were counted.
pub fn place(
    scene: &Description,
    counts: &Counts<'_>,
    files: Files<'_>,
    materials: &mut Materials,
    findings: &mut Vec<Finding>,
) -> Vec<world::Object> {
    let mut preparing = Preparing { files, materials, findings };
    let groups = Trail::Root.key("groups");
    let groups = scene
        .groups
        .iter()
        .map(|(name, objects)| (name.as_str(), preparing.objects(objects, &groups.key(name))))
        .collect();
    let top = preparing.objects(&scene.objects, &Trail::Root.key("objects"));
    let plain = preparing.materials.plain();
    let mut placing = Placing { groups, levels: BTreeMap::new() };
    // Groups come after those that they place: a shared one finds its own levels built.
    for (name, _) in counts.iter().filter(|(_, count)| count.is_shared) {
        let objects = placing.objects(placing.groups.get(name).map(Vec::as_slice).unwrap_or_default(), None);
        placing.levels.insert(name, Arc::new(Level::new(objects)));
    }
    placing.objects(&top, Some(plain))
}

/// An object whose shapes are prepared and whose names are looked up.
struct Prepared<'s> {
    transform: Transform,
    material: Option<MaterialId>,
    content: Content<'s>,
}

enum Content<'s> {
    Shapes(Vec<(Transform, Arc<AnyShape>)>),
    Group(&'s str),
    Objects(Vec<Prepared<'s>>),
}

struct Preparing<'m> {
    files: Files<'m>,
    materials: &'m mut Materials,
    findings: &'m mut Vec<Finding>,
}

impl Preparing<'_> {
    fn objects<'s>(&mut self, objects: &'s [Object], path: &Trail<'_>) -> Vec<Prepared<'s>> {
        let visible = objects.iter().enumerate().filter(|(_, object)| object.is_visible());
        visible.filter_map(|(i, object)| self.object(object, &path.index(i))).collect()
    }

    fn object<'s>(&mut self, object: &'s Object, path: &Trail<'_>) -> Option<Prepared<'s>> {
        let transform = self.transform(&object.transform, &path.key("transform"));
        let material = object.material.as_ref();
        let material = material.map(|m| self.materials.get(m, &path.key("material"), self.findings));
        let content = self.content(object, path)?;
        Some(Prepared { transform: transform?, material, content })
    }

    /// The one thing that an object is. That it is exactly one has been checked before.
    fn content<'s>(&mut self, object: &'s Object, path: &Trail<'_>) -> Option<Content<'s>> {
        if let Some(shape) = &object.shape {
            let shape = self.shape(shape, &path.key("shape"))?;
            Some(Content::Shapes(vec![(Transform::IDENTITY, Arc::new(shape))]))
        } else if let Some(group) = &object.group {
            Some(Content::Group(&group.0))
        } else if let Some(objects) = &object.objects {
            Some(Content::Objects(self.objects(objects, &path.key("objects"))))
        } else if let Some(chain) = &object.chain {
            Some(self.beads(chain.beads(), &path.key("chain")))
        } else if let Some(limb) = &object.limb {
            match limb.beads() {
                Ok(beads) => Some(self.beads(beads, &path.key("limb"))),
                Err(wrong) => self.fail(wrong.message, path.key("limb").join(wrong.field)),
            }
        } else {
            None
        }
    }

    fn shape(&mut self, shape: &AnyShape, path: &Trail<'_>) -> Option<AnyShape> {
        let mut shape = match shape {
            AnyShape::Mesh(mesh) => self.files.mesh(mesh, &path.key("mesh"), self.findings)?.into(),
            shape => shape.clone(),
        };
        match shape.prepare() {
            Ok(()) => Some(shape),
            Err(invalid) => {
                let path = path.key(&crate::kind::name_of(&shape)).join(&invalid.field);
                self.fail(invalid.message, &path)
            }
        }
    }

    fn beads<'s>(&mut self, beads: impl IntoIterator<Item = Bead>, path: &Trail<'_>) -> Content<'s> {
        let mut shapes = Vec::new();
        for Bead { center, radius } in beads {
            let sphere = Sphere { radius };
            if let Some(shape) = self.shape(&sphere.into(), path) {
                shapes.push((Transform::translation(center), Arc::new(shape)));
            }
        }
        Content::Shapes(shapes)
    }

    fn transform(&mut self, steps: &[TransformStep], path: &Trail<'_>) -> Option<Transform> {
        let mut whole = Transform::IDENTITY;
        let mut sound = true;
        for (i, step) in steps.iter().enumerate() {
            match step.transform() {
                Ok(next) => whole = whole.then(&next),
                Err(wrong) => {
                    sound = false;
                    self.fail::<()>(wrong.message, path.index(i).join(wrong.field));
                }
            }
        }
        sound.then_some(whole)
    }

    fn fail<T>(&mut self, message: String, path: impl Into<Path>) -> Option<T> {
        self.findings.push(Finding::error(message).at(path));
        None
    }
}

struct Placing<'s> {
    groups: BTreeMap<&'s str, Vec<Prepared<'s>>>,
    /// Groups that are shared, as far as they are built.
    levels: BTreeMap<&'s str, Arc<Level>>,
}

impl Placing<'_> {
    /// The objects of one level; those that say nothing are made of `inherited`.
    fn objects(&self, objects: &[Prepared<'_>], inherited: Option<MaterialId>) -> Vec<world::Object> {
        let mut placed = Vec::new();
        self.place(objects, &Transform::IDENTITY, inherited, &mut placed);
        placed
    }

    fn place(
        &self,
        objects: &[Prepared<'_>],
        parent: &Transform,
        inherited: Option<MaterialId>,
        placed: &mut Vec<world::Object>,
    ) {
        for object in objects {
            let transform = object.transform.then(parent);
            let material = object.material.or(inherited);
            match &object.content {
                Content::Shapes(shapes) => placed.extend(shapes.iter().map(|(place, shape)| world::Object {
                    content: Placed::Shape(Arc::clone(shape)),
                    transform: place.then(&transform),
                    material,
                })),
                Content::Objects(objects) => self.place(objects, &transform, material, placed),
                Content::Group(name) => match self.levels.get(name) {
                    Some(level) => {
                        let content = Placed::Level(Arc::clone(level));
                        placed.push(world::Object { content, transform, material });
                    }
                    None => {
                        let objects = self.groups.get(name).map(Vec::as_slice).unwrap_or_default();
                        self.place(objects, &transform, material, placed);
                    }
                },
            }
        }
    }
}
