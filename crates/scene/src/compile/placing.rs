//! Places objects: expands or shares groups, composes transforms and inherits materials.

use super::count::Counts;
use super::materials::Materials;
use super::meshes::Files;
use super::prepared_instances::PreparedInstances;
use super::times::Times;
use super::transform_motion;
use crate::description::{ChainSphere, Description, Instances, Object, TransformStep};
use crate::item::Item;
use crate::motion::{ListForm, ListTracks, Tracks};
use crate::path::{Path, PathRef};
use crate::report::Finding;
use juggler_material::MaterialId;
use juggler_math::{Motion, Transform, Vec3};
use juggler_shape::{AnyShape, Mesh, Sphere};
use juggler_world::{Content as WorldContent, Geometry};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Places all objects of a scene whose groups are counted. Returns them with the index of the first
/// shape of each scene entry. Objects with `tracks` move.
pub fn place(
    scene: &Description,
    tracks: &Tracks,
    counts: &Counts<'_>,
    files: Files<'_>,
    materials: &mut Materials,
    findings: &mut Vec<Finding>,
) -> (Vec<juggler_world::Object>, Vec<u32>) {
    let mut preparer = Preparer { scene, files, materials, findings, is_animated: false };
    let groups = PathRef::Root.key("groups");
    let still = ListTracks::new();
    let groups = scene.groups.iter().map(|(name, objects)| {
        let tracks = tracks.groups.get(name).unwrap_or(&still);
        (name.as_str(), preparer.objects(objects, Times::Tracks(tracks), &groups.key(name)))
    });
    let groups = groups.collect();
    let top = preparer.objects(&scene.objects, Times::Tracks(&tracks.objects), &PathRef::Root.key("objects"));
    let default_material = preparer.materials.default_material();
    let mut placer = Placer { groups, levels: BTreeMap::new() };
    // Build inner groups first, which precede the groups that place them.
    for (name, _) in counts.iter().filter(|(_, count)| count.is_shared) {
        let objects = placer.objects(placer.groups.get(name).map(Vec::as_slice).unwrap_or_default(), None);
        placer.levels.insert(name, Arc::new(Geometry::new(objects)));
    }
    placer.entries(&top, scene.objects.len(), default_material)
}

/// Object with prepared shapes and resolved names.
struct Prepared<'s> {
    /// Index in its list.
    index: usize,
    motion: Motion,
    /// `None` for an object without instances.
    instances: Option<PreparedInstances<'s>>,
    material: Option<MaterialId>,
    content: Content<'s>,
}

enum Content<'s> {
    Shapes(Vec<(Motion, Arc<AnyShape>)>),
    Group(&'s str),
    Objects(Vec<Prepared<'s>>),
}

struct Preparer<'m> {
    scene: &'m Description,
    files: Files<'m>,
    materials: &'m mut Materials,
    findings: &'m mut Vec<Finding>,
    /// Whether an enclosing object depends on time.
    is_animated: bool,
}

/// Whether the JSON of an object depends on time.
fn depends_on_time(object: &Item<Object>) -> bool {
    object.template().is_some_and(|template| template.depends_on_time)
}

impl Preparer<'_> {
    fn objects<'s>(&mut self, objects: &'s [Item<Object>], times: Times<'_>, path: &PathRef<'_>) -> Vec<Prepared<'s>> {
        let times = times.fitting(objects.len());
        let mut prepared = Vec::with_capacity(objects.len());
        for (i, object) in objects.iter().enumerate() {
            if !object.is_visible() {
                self.check_flat(object, &path.index(i));
                continue;
            }
            let (at, inner) = times.object(i);
            let at = if at.iter().all(|other| **other == **object) { &[] } else { at.as_slice() };
            let outer = self.is_animated;
            self.is_animated = outer || depends_on_time(object);
            let own = self.object(object, at, inner, &path.index(i));
            self.is_animated = outer;
            prepared.extend(own.map(|own| Prepared { index: i, ..own }));
        }
        prepared
    }

    /// Reports a scale of 0 that is not animated.
    fn check_flat(&mut self, object: &Item<Object>, path: &PathRef<'_>) {
        let path_steps = Path::from(path);
        let contains = |form: &Path| path_steps.steps().starts_with(form.steps());
        let is_form = |form: &ListForm| form.template.depends_on_time && contains(&form.path);
        let is_animated =
            self.is_animated || depends_on_time(object) || self.files.scene.list_forms.iter().any(is_form);
        if bool::from(object.visible) && !is_animated {
            self.transform(&object.transform, &path.key("transform"));
        }
    }

    /// Prepares an object, which equals the objects `at` at even times and has child objects at the
    /// times `inner`.
    fn object<'s>(
        &mut self,
        object: &'s Object,
        at: &[&Object],
        inner: Times<'_>,
        path: &PathRef<'_>,
    ) -> Option<Prepared<'s>> {
        let motion = self.motion(&object.transform, at, &path.key("transform"));
        let material = object.material.as_ref();
        let material = material.map(|m| self.materials.get(m, &path.key("material"), self.findings));
        let instances = match &object.instances {
            Some(instances) => Some(self.instances(instances, at, &path.key("instances"))?),
            None => None,
        };
        let content = self.content(object, at, inner, path)?;
        self.warn_of_missing_coordinates(object, &content, path);
        Some(Prepared { index: 0, motion: motion?, instances, material, content })
    }

    /// Warns of a mesh without surface coordinates if the object's material needs them.
    fn warn_of_missing_coordinates(&mut self, object: &Object, content: &Content<'_>, path: &PathRef<'_>) {
        let lacks = |shape: &AnyShape| shape.mesh().is_some_and(Mesh::lacks_surface_coordinates);
        let Content::Shapes(shapes) = content else { return };
        if shapes.iter().any(|(_, shape)| lacks(shape))
            && object.material.as_ref().is_some_and(|material| self.materials.over_uv.contains(material, self.scene))
        {
            let message = "the mesh has no surface coordinates: use space `local` or `triplanar`";
            self.findings.push(Finding::warning(message).at(&path.key("shape")));
        }
    }

    /// Prepares the content of an object. Validation ensures that there is exactly one.
    fn content<'s>(
        &mut self,
        object: &'s Object,
        at: &[&Object],
        inner: Times<'_>,
        path: &PathRef<'_>,
    ) -> Option<Content<'s>> {
        if let Some(shape) = &object.shape {
            let others = collect_all(at, |at| at.shape.as_ref());
            let prepared = self.shape(shape, &others, &path.key("shape"))?;
            Some(Content::Shapes(vec![(transform_motion::sphere_scaling(shape, others), Arc::new(prepared))]))
        } else if let Some(group) = &object.group {
            Some(Content::Group(&group.0))
        } else if let Some(objects) = &object.objects {
            let lists = collect_all(at, |at| at.objects.as_ref().map(|objects| objects.as_slice()));
            let times = if lists.is_empty() { inner } else { Times::Lists(lists) };
            Some(Content::Objects(self.objects(objects, times, &path.key("objects"))))
        } else if let Some(chain) = &object.chain {
            let at = collect_all(at, |at| Some(at.chain.as_ref()?.spheres().collect()));
            Some(self.spheres(chain.spheres().collect(), at, &path.key("chain")))
        } else if let Some(limb) = &object.limb {
            let at = collect_all(at, |at| at.limb.as_ref()?.spheres().ok());
            match limb.spheres() {
                Ok(spheres) => Some(self.spheres(spheres, at, &path.key("limb"))),
                Err(wrong) => self.fail(wrong.message, path.key("limb").join(wrong.field)),
            }
        } else {
            None
        }
    }

    /// Prepares a shape. A mesh that differs `at` other times deforms; a changing radius of a
    /// sphere is part of its motion.
    fn shape(&mut self, shape: &AnyShape, at: &[&AnyShape], path: &PathRef<'_>) -> Option<AnyShape> {
        let mut shape = match shape.mesh() {
            Some(mesh) => self.mesh(mesh, at, &path.key("mesh"))?.into(),
            None => shape.clone(),
        };
        match shape.prepare() {
            Ok(()) => Some(shape),
            Err(invalid) => {
                let path = path.key(&crate::kind::name_of(&shape)).join(&invalid.field);
                self.fail(invalid.message, &path)
            }
        }
    }

    fn mesh(&mut self, mesh: &Mesh, at: &[&AnyShape], path: &PathRef<'_>) -> Option<Mesh> {
        let moments: Option<Vec<&Mesh>> = at.iter().map(|shape| shape.mesh()).collect();
        match self.files.moving(&moments.unwrap_or_default(), path, self.findings) {
            None => self.files.mesh(mesh, path, self.findings),
            Some(Ok(moving)) => Some(moving),
            Some(Err(invalid)) => self.fail(invalid.message, Path::from(path).join(&invalid.field)),
        }
    }

    /// Prepares spheres in a row, which move if there are as many `at` all other times.
    fn spheres<'s>(&mut self, spheres: Vec<ChainSphere>, at: Vec<Vec<ChainSphere>>, path: &PathRef<'_>) -> Content<'s> {
        let at = if at.iter().all(|other| other.len() == spheres.len()) { at } else { Vec::new() };
        let mut shapes = Vec::new();
        for (i, ChainSphere { center, radius }) in spheres.into_iter().enumerate() {
            let Some(shape) = self.shape(&Sphere { radius }.into(), &[], path) else { continue };
            let key = |sphere: &ChainSphere| {
                let grown = Transform::scale(Vec3::splat(sphere.radius / radius)).unwrap_or(Transform::IDENTITY);
                grown.then(&Transform::translation(sphere.center))
            };
            let keys = at.iter().filter_map(|spheres| spheres.get(i)).map(key).collect();
            let still = Transform::translation(center).into();
            shapes.push((Motion::from_keys(keys).unwrap_or(still), Arc::new(shape)));
        }
        Content::Shapes(shapes)
    }

    /// Motion of an object from its transform steps at the frame and `at` other times.
    fn motion(&mut self, steps: &[TransformStep], at: &[&Object], path: &PathRef<'_>) -> Option<Motion> {
        let still = self.transform(steps, path)?;
        let moves = at.iter().any(|at| at.transform != steps);
        let keys: Vec<&[TransformStep]> = at.iter().map(|at| at.transform.as_slice()).collect();
        let motion = if moves { transform_motion::motion(&keys) } else { None };
        Some(motion.unwrap_or(still.into()))
    }

    /// Instances of an object. They move if there are as many `at` all other times.
    fn instances<'s>(
        &mut self,
        still: &'s Instances,
        at: &[&Object],
        path: &PathRef<'_>,
    ) -> Option<PreparedInstances<'s>> {
        if let Err(wrong) = still.check() {
            return self.fail(wrong.message, path.join(wrong.field));
        }
        let others = collect_all(at, |at| at.instances.as_ref());
        let moves = others.iter().any(|other| *other != still);
        let keys = if moves { collect_all(at, |at| at.instances.as_ref()?.transforms().ok()) } else { Vec::new() };
        let keys = if keys.iter().all(|list| list.len() == still.count()) { keys } else { Vec::new() };
        Some(PreparedInstances::new(still, keys))
    }

    fn transform(&mut self, steps: &[TransformStep], path: &PathRef<'_>) -> Option<Transform> {
        let mut whole = Transform::IDENTITY;
        let mut is_valid = true;
        for (i, step) in steps.iter().enumerate() {
            match step.transform() {
                Ok(next) => whole = whole.then(&next),
                Err(wrong) => {
                    is_valid = false;
                    self.fail::<()>(wrong.message, path.index(i).join(wrong.field));
                }
            }
        }
        is_valid.then_some(whole)
    }

    fn fail<T>(&mut self, message: String, path: impl Into<Path>) -> Option<T> {
        self.findings.push(Finding::error(message).at(path));
        None
    }
}

/// A property of all objects; empty if one object lacks it, so that times stay even.
fn collect_all<'o, T>(objects: &[&'o Object], part: impl Fn(&'o Object) -> Option<T>) -> Vec<T> {
    let parts: Option<Vec<T>> = objects.iter().map(|object| part(object)).collect();
    parts.unwrap_or_default()
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

struct Placer<'s> {
    groups: BTreeMap<&'s str, Vec<Prepared<'s>>>,
    /// Levels of shared groups built so far.
    levels: BTreeMap<&'s str, Arc<Geometry>>,
}

impl Placer<'_> {
    /// Objects of the top level, and the index of the first shape of each of `count` scene entries.
    fn entries(
        &self,
        objects: &[Prepared<'_>],
        count: usize,
        default_material: MaterialId,
    ) -> (Vec<juggler_world::Object>, Vec<u32>) {
        let (mut found, mut firsts, mut shapes) = (Vec::new(), Vec::with_capacity(count), 0u64);
        let number = |shapes: u64| u32::try_from(shapes).unwrap_or(u32::MAX);
        for object in objects {
            firsts.resize(firsts.len().max(object.index + 1), number(shapes));
            let before = found.len();
            self.place(std::slice::from_ref(object), &Transform::IDENTITY.into(), Some(default_material), &mut found);
            let new = found.get(before..).unwrap_or_default();
            shapes = new.iter().map(juggler_world::Object::shapes).fold(shapes, u64::saturating_add);
        }
        firsts.resize(count.max(firsts.len()), number(shapes));
        (found, firsts)
    }

    /// Objects of one level; objects without a material inherit `inherited`.
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
            match &object.instances {
                None => self.place_content(&object.content, motion, material, found),
                Some(instances) => {
                    found.reserve(instances.count());
                    for index in 0..instances.count() {
                        let (before, instance) = (found.len(), instances.motion(index));
                        self.place_content(&object.content, instance.then(&motion), material, found);
                        let attributes = instances.attributes(index);
                        let without = found.iter_mut().skip(before).filter(|object| object.attributes.is_none());
                        without.for_each(|object| object.attributes.clone_from(&attributes));
                    }
                }
            }
        }
    }

    fn place_content(
        &self,
        content: &Content<'_>,
        motion: Motion,
        material: Option<MaterialId>,
        found: &mut Vec<juggler_world::Object>,
    ) {
        match content {
            Content::Shapes(shapes) => objects_of(shapes, &motion, material, found),
            Content::Objects(objects) => self.place(objects, &motion, material, found),
            Content::Group(name) => match self.levels.get(name) {
                Some(level) => add(new_object(WorldContent::Geometry(Arc::clone(level)), motion, material), found),
                None => {
                    let objects = self.groups.get(name).map(Vec::as_slice).unwrap_or_default();
                    self.place(objects, &motion, material, found);
                }
            },
        }
    }
}

fn objects_of(
    shapes: &[(Motion, Arc<AnyShape>)],
    motion: &Motion,
    material: Option<MaterialId>,
    found: &mut Vec<juggler_world::Object>,
) {
    for (place, shape) in shapes {
        add(new_object(WorldContent::Shape(Arc::clone(shape)), place.then(motion), material), found);
    }
}

/// Adds an object, which shares the linear part of its transform with the one before if they are equal.
fn add(object: juggler_world::Object, found: &mut Vec<juggler_world::Object>) {
    let motion = match found.last() {
        Some(previous) => object.motion.sharing(&previous.motion),
        None => object.motion,
    };
    found.push(juggler_world::Object { motion, ..object });
}
