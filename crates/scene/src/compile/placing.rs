//! Objects in their places: groups expanded, transforms joined, materials inherited.

use super::materials::Materials;
use super::meshes::Files;
use crate::description::{Bead, Description, Object, TransformStep};
use crate::path::{Path, Trail};
use crate::report::Finding;
use juggler_math::Transform;
use juggler_tracer::material::MaterialId;
use juggler_tracer::shape::{AnyShape, Sphere};
use juggler_tracer::world;
use std::collections::BTreeMap;

/// All objects of a scene that [`super::count::check`] found finite and small enough.
pub fn place(
    scene: &Description,
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
    let mut placing = Placing { groups: &groups, placed: Vec::new() };
    placing.all(&top, &Transform::IDENTITY, plain);
    placing.placed
}

/// An object whose shapes are prepared and whose names are looked up.
struct Prepared<'s> {
    transform: Transform,
    material: Option<MaterialId>,
    content: Content<'s>,
}

enum Content<'s> {
    Shapes(Vec<(Transform, AnyShape)>),
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
        objects.iter().enumerate().filter_map(|(i, object)| self.object(object, &path.index(i))).collect()
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
            Some(Content::Shapes(vec![(Transform::IDENTITY, shape)]))
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
                shapes.push((Transform::translation(center), shape));
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

struct Placing<'p, 's> {
    groups: &'p BTreeMap<&'s str, Vec<Prepared<'s>>>,
    placed: Vec<world::Object>,
}

impl Placing<'_, '_> {
    fn all(&mut self, objects: &[Prepared<'_>], parent: &Transform, inherited: MaterialId) {
        for object in objects {
            let transform = object.transform.then(parent);
            let material = object.material.unwrap_or(inherited);
            match &object.content {
                Content::Shapes(shapes) => self.placed.extend(shapes.iter().map(|(place, shape)| world::Object {
                    shape: shape.clone(),
                    transform: place.then(&transform),
                    material,
                })),
                Content::Objects(objects) => self.all(objects, &transform, material),
                Content::Group(name) => {
                    let groups = self.groups;
                    self.all(groups.get(name).map(Vec::as_slice).unwrap_or_default(), &transform, material);
                }
            }
        }
    }
}
