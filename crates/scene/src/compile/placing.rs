//! Objects in their places: groups expanded or shared, transforms joined, materials inherited.

use super::count::Counts;
use super::materials::Materials;
use super::meshes::Files;
use crate::description::{Bead, Description, Object, TransformStep};
use crate::item::Item;
use crate::motion::{ListTracks, ObjectTrack, Tracks};
use crate::path::{Path, Trail};
use crate::report::Finding;
use juggler_material::MaterialId;
use juggler_math::{Motion, Transform, Vec3};
use juggler_shape::{AnyShape, Mesh, Sphere};
use juggler_world::{Content as Placed, Level};
use std::collections::BTreeMap;
use std::sync::Arc;

/// All objects of a scene whose groups were counted, and of each entry of the scene the number of its first shape. Objects
/// that have `tracks` move.
pub fn place(
    scene: &Description,
    tracks: &Tracks,
    counts: &Counts<'_>,
    files: Files<'_>,
    materials: &mut Materials,
    findings: &mut Vec<Finding>,
) -> (Vec<juggler_world::Object>, Vec<u32>) {
    let mut preparing = Preparing { files, materials, findings };
    let groups = Trail::Root.key("groups");
    let still = ListTracks::new();
    let groups = scene.groups.iter().map(|(name, objects)| {
        let tracks = tracks.groups.get(name).unwrap_or(&still);
        (name.as_str(), preparing.objects(objects, Times::Tracks(tracks), &groups.key(name)))
    });
    let groups = groups.collect();
    let top = preparing.objects(&scene.objects, Times::Tracks(&tracks.objects), &Trail::Root.key("objects"));
    let plain = preparing.materials.plain();
    let mut placing = Placing { groups, levels: BTreeMap::new() };
    // Groups come after those that they place: a shared one finds its own levels built.
    for (name, _) in counts.iter().filter(|(_, count)| count.is_shared) {
        let objects = placing.objects(placing.groups.get(name).map(Vec::as_slice).unwrap_or_default(), None);
        placing.levels.insert(name, Arc::new(Level::new(objects)));
    }
    placing.entries(&top, scene.objects.len(), plain)
}

/// An object whose shapes are prepared and whose names are looked up.
struct Prepared<'s> {
    /// Its place in its list.
    index: usize,
    motion: Motion,
    material: Option<MaterialId>,
    content: Content<'s>,
}

enum Content<'s> {
    Shapes(Vec<(Motion, Arc<AnyShape>)>),
    Group(&'s str),
    Objects(Vec<Prepared<'s>>),
}

/// The objects of a list at even times while the shutter is open.
enum Times<'t> {
    /// Those that move, one by one.
    Tracks(&'t ListTracks),
    /// The whole list at each time.
    Lists(Vec<&'t [Item<Object>]>),
    /// They stand still.
    Still,
}

impl<'t> Times<'t> {
    /// The same for a list of so many objects: where there are not as many at each time, none moves.
    fn fitting(self, count: usize) -> Self {
        match self {
            Self::Lists(lists) if lists.iter().any(|list| list.len() != count) => Self::Still,
            times => times,
        }
    }

    /// An object at the times, when it moves as a whole, and the objects within it.
    fn of(&self, i: usize) -> (Vec<&'t Object>, Times<'t>) {
        match self {
            Self::Tracks(tracks) => match tracks.get(&i) {
                Some(ObjectTrack::Whole(keys)) => (keys.iter().map(|key| &**key).collect(), Times::Still),
                Some(ObjectTrack::Inner(inner)) => (Vec::new(), Times::Tracks(inner)),
                None => (Vec::new(), Times::Still),
            },
            Self::Lists(lists) => (lists.iter().filter_map(|list| list.get(i).map(|o| &**o)).collect(), Times::Still),
            Self::Still => (Vec::new(), Times::Still),
        }
    }
}

struct Preparing<'m> {
    files: Files<'m>,
    materials: &'m mut Materials,
    findings: &'m mut Vec<Finding>,
}

impl Preparing<'_> {
    fn objects<'s>(&mut self, objects: &'s [Item<Object>], times: Times<'_>, path: &Trail<'_>) -> Vec<Prepared<'s>> {
        let times = times.fitting(objects.len());
        let object = |(i, object): (usize, &'s Item<Object>)| {
            let (at, inner) = times.of(i);
            let at = if at.iter().all(|other| **other == **object) { &[] } else { at.as_slice() };
            Some(Prepared { index: i, ..self.object(object, at, inner, &path.index(i))? })
        };
        let visible = objects.iter().enumerate().filter(|(_, object)| object.is_visible());
        visible.filter_map(object).collect()
    }

    /// An object that is another one `at` even times, or that holds such objects.
    fn object<'s>(
        &mut self,
        object: &'s Object,
        at: &[&Object],
        inner: Times<'_>,
        path: &Trail<'_>,
    ) -> Option<Prepared<'s>> {
        let motion = self.motion(&object.transform, at, &path.key("transform"));
        let material = object.material.as_ref();
        let material = material.map(|m| self.materials.get(m, &path.key("material"), self.findings));
        let content = self.content(object, at, inner, path)?;
        Some(Prepared { index: 0, motion: motion?, material, content })
    }

    /// The one thing that an object is. That it is exactly one has been checked before.
    fn content<'s>(
        &mut self,
        object: &'s Object,
        at: &[&Object],
        inner: Times<'_>,
        path: &Trail<'_>,
    ) -> Option<Content<'s>> {
        if let Some(shape) = &object.shape {
            let others = all(at, |at| at.shape.as_ref());
            let prepared = self.shape(shape, &others, &path.key("shape"))?;
            Some(Content::Shapes(vec![(growth(shape, others), Arc::new(prepared))]))
        } else if let Some(group) = &object.group {
            Some(Content::Group(&group.0))
        } else if let Some(objects) = &object.objects {
            let lists = all(at, |at| at.objects.as_ref().map(|objects| objects.as_slice()));
            let times = if lists.is_empty() { inner } else { Times::Lists(lists) };
            Some(Content::Objects(self.objects(objects, times, &path.key("objects"))))
        } else if let Some(chain) = &object.chain {
            let at = all(at, |at| Some(at.chain.as_ref()?.beads().collect()));
            Some(self.beads(chain.beads().collect(), at, &path.key("chain")))
        } else if let Some(limb) = &object.limb {
            let at = all(at, |at| at.limb.as_ref()?.beads().ok());
            match limb.beads() {
                Ok(beads) => Some(self.beads(beads, at, &path.key("limb"))),
                Err(wrong) => self.fail(wrong.message, path.key("limb").join(wrong.field)),
            }
        } else {
            None
        }
    }

    /// The shape ready to be placed. Of those that are not the same `at` other times, meshes move; the size of a sphere
    /// is part of its motion.
    fn shape(&mut self, shape: &AnyShape, at: &[&AnyShape], path: &Trail<'_>) -> Option<AnyShape> {
        let mut shape = match shape {
            AnyShape::Mesh(mesh) => self.mesh(mesh, at, &path.key("mesh"))?.into(),
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

    fn mesh(&mut self, mesh: &Mesh, at: &[&AnyShape], path: &Trail<'_>) -> Option<Mesh> {
        let moment = |at: &&'_ AnyShape| if let AnyShape::Mesh(mesh) = at { Some(mesh.clone()) } else { None };
        let moments: Option<Vec<Mesh>> = at.iter().map(moment).collect();
        let moments = moments.unwrap_or_default();
        match self.files.moving(&moments.iter().collect::<Vec<_>>(), path, self.findings) {
            None => self.files.mesh(mesh, path, self.findings),
            Some(Ok(moving)) => Some(moving),
            Some(Err(invalid)) => self.fail(invalid.message, Path::from(path).join(&invalid.field)),
        }
    }

    /// Spheres in a row, `at` other times too; where there are not as many, none moves.
    fn beads<'s>(&mut self, beads: Vec<Bead>, at: Vec<Vec<Bead>>, path: &Trail<'_>) -> Content<'s> {
        let at = if at.iter().all(|other| other.len() == beads.len()) { at } else { Vec::new() };
        let mut shapes = Vec::new();
        for (i, Bead { center, radius }) in beads.into_iter().enumerate() {
            let Some(shape) = self.shape(&Sphere { radius }.into(), &[], path) else { continue };
            let key = |bead: &Bead| {
                let grown = Transform::scale(Vec3::splat(bead.radius / radius)).unwrap_or(Transform::IDENTITY);
                grown.then(&Transform::translation(bead.center))
            };
            let keys = at.iter().filter_map(|beads| beads.get(i)).map(key).collect();
            let still = Transform::translation(center).into();
            shapes.push((Motion::through(keys).unwrap_or(still), Arc::new(shape)));
        }
        Content::Shapes(shapes)
    }

    /// The steps of an object, and what they are at other times.
    fn motion(&mut self, steps: &[TransformStep], at: &[&Object], path: &Trail<'_>) -> Option<Motion> {
        let still = self.transform(steps, path)?;
        let keys: Option<Vec<Transform>> = match at.iter().all(|at| at.transform == steps) {
            true => None,
            false => at.iter().map(|at| joined(&at.transform)).collect(),
        };
        Some(keys.and_then(Motion::through).unwrap_or(still.into()))
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

/// What all objects have; nothing where one of them has it not, so that times stay even.
fn all<'o, T>(objects: &[&'o Object], part: impl Fn(&'o Object) -> Option<T>) -> Vec<T> {
    let parts: Option<Vec<T>> = objects.iter().map(|object| part(object)).collect();
    parts.unwrap_or_default()
}

/// All steps as one; `None` where one of them cannot be.
fn joined(steps: &[TransformStep]) -> Option<Transform> {
    let next = |whole: Transform, step: &TransformStep| Some(whole.then(&step.transform().ok()?));
    steps.iter().try_fold(Transform::IDENTITY, next)
}

/// A sphere whose radius changes is one that is scaled.
fn growth(shape: &AnyShape, others: Vec<&AnyShape>) -> Motion {
    let AnyShape::Sphere(sphere) = shape else { return Transform::IDENTITY.into() };
    let keys = others.into_iter().map(|other| match other {
        AnyShape::Sphere(other) => Transform::scale(Vec3::splat(other.radius / sphere.radius)),
        _ => None,
    });
    let keys: Option<Vec<Transform>> = keys.collect();
    keys.and_then(Motion::through).unwrap_or(Transform::IDENTITY.into())
}

/// How large something is after a motion, if it has a size.
fn size(motion: &Motion, content: &Placed) -> f32 {
    let bounds = match content {
        Placed::Shape(shape) => shape.bounds(),
        Placed::Level(level) => level.bounds(),
    };
    let size = motion.at(0.0).aabb(&bounds).extent().length();
    if size.is_finite() { size } else { 1.0 }
}

/// An object in its place, its turns round.
pub fn placed(content: Placed, motion: Motion, material: Option<MaterialId>) -> juggler_world::Object {
    let motion = if motion.moves() { motion.clone().smoothed(size(&motion, &content)) } else { motion };
    juggler_world::Object { content, motion, material }
}

struct Placing<'s> {
    groups: BTreeMap<&'s str, Vec<Prepared<'s>>>,
    /// Groups that are shared, as far as they are built.
    levels: BTreeMap<&'s str, Arc<Level>>,
}

impl Placing<'_> {
    /// The objects of the world's own level, and of each of `count` entries the number of its first shape.
    fn entries(
        &self,
        objects: &[Prepared<'_>],
        count: usize,
        plain: MaterialId,
    ) -> (Vec<juggler_world::Object>, Vec<u32>) {
        let (mut found, mut firsts, mut shapes) = (Vec::new(), Vec::with_capacity(count), 0u64);
        let number = |shapes: u64| u32::try_from(shapes).unwrap_or(u32::MAX);
        for object in objects {
            firsts.resize(firsts.len().max(object.index + 1), number(shapes));
            let before = found.len();
            self.place(std::slice::from_ref(object), &Transform::IDENTITY.into(), Some(plain), &mut found);
            let new = found.get(before..).unwrap_or_default();
            shapes = new.iter().map(juggler_world::Object::shapes).fold(shapes, u64::saturating_add);
        }
        firsts.resize(count.max(firsts.len()), number(shapes));
        (found, firsts)
    }

    /// The objects of one level; those that say nothing are made of `inherited`.
    fn objects(&self, objects: &[Prepared<'_>], inherited: Option<MaterialId>) -> Vec<juggler_world::Object> {
        let mut found = Vec::new();
        self.place(objects, &Transform::IDENTITY.into(), inherited, &mut found);
        found
    }

    fn place(
        &self,
        objects: &[Prepared<'_>],
        parent: &Motion,
        inherited: Option<MaterialId>,
        found: &mut Vec<juggler_world::Object>,
    ) {
        for object in objects {
            let motion = object.motion.then(parent);
            let material = object.material.or(inherited);
            match &object.content {
                Content::Shapes(shapes) => objects_of(shapes, &motion, material, found),
                Content::Objects(objects) => self.place(objects, &motion, material, found),
                Content::Group(name) => match self.levels.get(name) {
                    Some(level) => found.push(placed(Placed::Level(Arc::clone(level)), motion, material)),
                    None => {
                        let objects = self.groups.get(name).map(Vec::as_slice).unwrap_or_default();
                        self.place(objects, &motion, material, found);
                    }
                },
            }
        }
    }
}

fn objects_of(
    shapes: &[(Motion, Arc<AnyShape>)],
    motion: &Motion,
    material: Option<MaterialId>,
    found: &mut Vec<juggler_world::Object>,
) {
    let object = |(place, shape): &(Motion, Arc<AnyShape>)| {
        placed(Placed::Shape(Arc::clone(shape)), place.then(motion), material)
    };
    found.extend(shapes.iter().map(object));
}
