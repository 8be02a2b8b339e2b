//! Prepares objects, with their shapes, materials and motion, and places them.

use super::count::Counts;
use super::materials::Materials;
use super::meshes::Files;
use super::placer::{Content, Placer, Prepared};
use super::prepared_instances::PreparedInstances;
use super::times::Times;
use super::transform_motion;
use crate::description::{ChainSphere, Description, Instances, Object, TransformStep};
use crate::item::Item;
use crate::motion::{ListForm, ListTracks, Tracks};
use crate::path::{Path, PathRef};
use crate::report::Finding;
use juggler_math::{Motion, Transform, Vec3};
use juggler_shape::{AnyShape, Mesh, Sphere};
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
    let mut preparer = Preparer { scene, files, materials, findings, is_animated: false, moving: BTreeMap::new() };
    let groups = PathRef::Root.key("groups");
    let still = ListTracks::new();
    let groups = scene.groups.iter().map(|(name, objects)| {
        let tracks = tracks.groups.get(name).unwrap_or(&still);
        (name.as_str(), preparer.objects(objects, Times::Tracks(tracks), &groups.key(name)))
    });
    let groups = groups.collect();
    let top = preparer.objects(&scene.objects, Times::Tracks(&tracks.objects), &PathRef::Root.key("objects"));
    let default_material = preparer.materials.default_material();
    let shared = counts.iter().filter(|(_, count)| count.is_shared).map(|(name, _)| *name);
    Placer::new(groups, shared, files.control).entries(&top, scene.objects.len(), default_material)
}

struct Preparer<'m> {
    scene: &'m Description,
    files: Files<'m>,
    materials: &'m mut Materials,
    findings: &'m mut Vec<Finding>,
    /// Whether an enclosing object depends on time.
    is_animated: bool,
    /// Meshes that deform while the shutter is open, by the addresses of their arrays at all times.
    moving: BTreeMap<Vec<usize>, Mesh>,
}

/// Address of the arrays of a mesh, which copies of a model share.
fn address(mesh: &Mesh) -> usize {
    Arc::as_ptr(mesh.arrays()).addr()
}

/// Whether the JSON of an object depends on time.
fn depends_on_time(object: &Item<Object>) -> bool {
    object.template().is_some_and(|template| template.depends_on_time)
}

impl Preparer<'_> {
    fn objects<'s>(&mut self, objects: &'s [Item<Object>], times: Times<'_>, path: &PathRef<'_>) -> Vec<Prepared<'s>> {
        let times = times.fitting(objects.len());
        let mut prepared = Vec::with_capacity(objects.len());
        for (i, object) in objects.iter().enumerate().take_while(|_| !self.files.control.is_cancelled()) {
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
        match shape.prepare_with_control(self.files.control) {
            Ok(()) => Some(shape),
            Err(invalid) => {
                let path = path.key(shape.name()).join(&invalid.field);
                self.fail(invalid.message, &path)
            }
        }
    }

    fn mesh(&mut self, mesh: &Mesh, at: &[&AnyShape], path: &PathRef<'_>) -> Option<Mesh> {
        let moments: Option<Vec<&Mesh>> = at.iter().map(|shape| shape.mesh()).collect();
        let moments = moments.unwrap_or_default();
        let is_plain =
            |mesh: &&Mesh| mesh.file.is_none() && mesh.morphs.is_empty() && mesh.crease_angle_degrees.is_none();
        let arrays: Vec<usize> = moments.iter().filter(|mesh| is_plain(mesh)).map(|mesh| address(mesh)).collect();
        let arrays = Some(arrays).filter(|arrays| !arrays.is_empty() && arrays.len() == moments.len());
        if let Some(known) = arrays.as_ref().and_then(|arrays| self.moving.get(arrays)) {
            return Some(known.clone());
        }
        match self.files.moving(&moments, path, self.findings) {
            None => self.files.mesh(mesh, path, self.findings),
            Some(Ok(moving)) => {
                arrays.into_iter().for_each(|arrays| drop(self.moving.insert(arrays, moving.clone())));
                Some(moving)
            }
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
        let others = collect_all(at, |at| at.instances.as_deref());
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
