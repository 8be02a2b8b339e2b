//! Expansion of a scene's models to objects, materials, textures, lights and cameras, and of its files
//! of instances to arrays.
//!
//! Each `model` of the scene becomes an object with child objects in its place, so that the indices
//! of all other objects stay. Models that move while the shutter is open are expanded at each
//! sampled time too, which gives the tracks of their objects, lights and cameras.

use super::instance::{ModelNames, Place, SharedCopies};
use super::{FileDigest, find_camera};
use crate::compile::{AssetCache, Files};
use crate::description::{BackgroundInput, CameraName, Description, Instances, Object, Objects};
use crate::item::Item;
use crate::motion::{ListTracks, ObjectTrack, Tracks};
use crate::path::{Path, PathRef};
use crate::report::Finding;
use crate::shared::Shared;
use crate::suggest::did_you_mean_or_list;
use indexmap::IndexMap;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_math::Transform;
use juggler_math::range::format_number;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A scene whose models and files of instances are expanded.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// The scene without models.
    pub description: Description,
    /// Motion of all objects while the shutter is open, those of models included.
    pub tracks: Arc<Tracks>,
    /// Files of the scene, with the pictures of models as assets.
    pub asset_cache: AssetCache,
    /// Errors and warnings about models.
    pub findings: Vec<Finding>,
    /// What determines the contents of the models, for fingerprints.
    pub identities: Vec<ModelIdentity>,
    /// Memory in bytes that the opened model files hold.
    pub model_bytes: u64,
}

/// What determines the content of a model of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelIdentity {
    /// The file and the files that it names; copies of the model share the list.
    pub files: Arc<[FileDigest]>,
    /// Times in seconds; the size of the picture too if points and lines depend on it.
    pub times: Vec<f64>,
}

/// Time of a scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneTime {
    /// Frame; fractions lie between frames.
    pub frame: f64,
    /// Frames while the shutter is open, relative to `frame`.
    pub shutter: [f64; 2],
    /// Frames per second.
    pub frames_per_second: f64,
}

/// Number of times at which models are expanded while the shutter is open, as for tracks.
const SHUTTER_SAMPLES: usize = 17;

impl SceneTime {
    /// Time of the scene in seconds.
    fn seconds(&self) -> f64 {
        self.frame / self.frames_per_second
    }

    /// Even times in seconds from the opening to the closing of the shutter; none if it is closed.
    fn moments(&self) -> Vec<f64> {
        let [open, close] = self.shutter;
        if !(open < close && open.is_finite() && close.is_finite()) {
            return Vec::new();
        }
        let share = |moment: usize| moment as f64 / (SHUTTER_SAMPLES - 1) as f64;
        let frame = |moment: usize| self.frame + open + (close - open) * share(moment);
        (0..SHUTTER_SAMPLES).map(|moment| frame(moment) / self.frames_per_second).collect()
    }
}

/// Whether a scene contains models.
pub fn has_models(scene: &Description) -> bool {
    fn contains(objects: &[Item<Object>]) -> bool {
        objects.iter().any(|object| object_has_models(object))
    }
    contains(&scene.objects) || scene.groups.values().any(|objects| contains(objects))
}

fn object_has_models(object: &Object) -> bool {
    object.model.is_some() || object.inner().iter().any(|inner| object_has_models(inner))
}

/// Whether a scene contains files of instances.
pub fn has_instance_files(scene: &Description) -> bool {
    let contains = |objects: &[Item<Object>]| objects.iter().any(|object| object.has_instance_file());
    contains(&scene.objects) || scene.groups.values().any(|objects| contains(objects))
}

/// Whether an object contains a model or a file of instances.
fn needs_expansion(object: &Object) -> bool {
    object_has_models(object) || object.has_instance_file()
}

/// Expands the models and files of instances of a scene.
pub fn expand(files: Files<'_>, tracks: &Tracks, time: SceneTime) -> Expansion {
    expand_with(files, tracks, time, InstanceSource::Content)
}

/// Where the instances of files come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InstanceSource {
    /// The contents of the files.
    Content,
    /// Their heads, which declare how many there are.
    Head,
}

/// Expands the models of a scene, and reads of its files of instances only how many there are.
pub fn expand_heads(files: Files<'_>, tracks: &Tracks, time: SceneTime) -> Expansion {
    expand_with(files, tracks, time, InstanceSource::Head)
}

fn expand_with(files: Files<'_>, tracks: &Tracks, time: SceneTime, instance_source: InstanceSource) -> Expansion {
    let scene = files.scene;
    let mut expander = Expander {
        files,
        description: scene.clone(),
        asset_cache: files.asset_cache.clone(),
        instance_source,
        moments: time.moments(),
        seconds: time.seconds(),
        names: ModelNames::default(),
        copies: SharedCopies::default(),
        model_bytes: BTreeMap::new(),
        findings: Vec::new(),
        identities: Vec::new(),
        lights: IndexMap::new(),
        cameras: IndexMap::new(),
    };
    let mut all_tracks = tracks.clone();
    let groups = PathRef::Root.key("groups");
    for (name, objects) in scene.groups.iter().filter(|(_, objects)| objects.iter().any(|o| needs_expansion(o))) {
        let own = all_tracks.groups.entry(name.clone()).or_default();
        let (objects, moved) = expander.list(objects, own, &groups.key(name), Place::default());
        *own = moved;
        expander.description.groups.insert(name.clone(), objects);
    }
    all_tracks.groups.retain(|_, tracks| !tracks.is_empty());
    let place = Place { transform: Some(Transform::IDENTITY), ..Place::default() };
    let (objects, moved) = expander.list(&scene.objects, &all_tracks.objects, &PathRef::Root.key("objects"), place);
    (expander.description.objects, all_tracks.objects) = (objects, moved);
    expander.finish(all_tracks)
}

/// A light or camera of a model: its value at the frame, and at each sampled time if it moves.
pub(super) struct InModel<T> {
    pub value: T,
    pub keys: Vec<T>,
}

impl<T: PartialEq> InModel<T> {
    /// The values at the sampled times; `None` if the value is the same at all times.
    fn moving(&self) -> Option<&[T]> {
        let moves = self.keys.len() == SHUTTER_SAMPLES && self.keys.iter().any(|key| *key != self.value);
        moves.then_some(self.keys.as_slice())
    }
}

pub(super) struct Expander<'s> {
    pub files: Files<'s>,
    pub description: Description,
    pub asset_cache: AssetCache,
    instance_source: InstanceSource,
    /// Sampled times while the shutter is open, in seconds.
    moments: Vec<f64>,
    /// Time of the frame in seconds.
    seconds: f64,
    pub names: ModelNames,
    /// Parts of the models that were expanded so far.
    pub copies: SharedCopies,
    /// Memory in bytes of the opened model files.
    pub model_bytes: BTreeMap<PathBuf, u64>,
    pub findings: Vec<Finding>,
    pub identities: Vec<ModelIdentity>,
    /// Lights of models, by the path of the model and their index there.
    pub lights: IndexMap<(String, usize), InModel<AnyLight>>,
    /// Cameras of models, by the path of the model and their index there, with their names.
    pub cameras: IndexMap<(String, usize), (String, InModel<AnyCamera>)>,
}

impl Expander<'_> {
    fn finish(mut self, mut tracks: Tracks) -> Expansion {
        self.findings.extend(self.dimmed_studio());
        for (name, camera) in self.cameras.into_values() {
            if let Some(keys) = camera.moving() {
                tracks.cameras.insert(name.clone(), keys.iter().cloned().map(Item::from).collect());
            }
            self.description.cameras.insert(name, camera.value.into());
        }
        self.findings.extend(choose_camera(&mut self.description));
        for light in self.lights.into_values() {
            if let Some(keys) = light.moving() {
                let index = self.description.lights.len();
                tracks.lights.insert(index, keys.iter().cloned().map(Item::from).collect());
            }
            self.description.lights.push(light.value.into());
        }
        Expansion {
            description: self.description,
            tracks: Arc::new(tracks),
            asset_cache: self.asset_cache,
            findings: self.findings,
            identities: self.identities,
            model_bytes: self.model_bytes.into_values().fold(0, u64::saturating_add),
        }
    }

    /// Tells of the studio around a file with lights.
    fn dimmed_studio(&self) -> Option<Finding> {
        let scene = self.files.scene;
        let is_around_model = self.files.sources.names().next().is_none();
        let Some(BackgroundInput::Kind(AnyBackground::Studio(studio))) = scene.background.as_deref() else {
            return None;
        };
        if !is_around_model || self.lights.is_empty() || studio.scale == 1.0 {
            return None;
        }
        let scale = format_number(studio.scale);
        let message = format!("the file has lights of its own, so the studio around it is dimmed to {scale}");
        let finding = Finding::warning(message).at(Path::root().key("background"));
        Some(finding.help("`juggler convert` writes a scene, whose `background` you can change"))
    }

    /// Expands the objects of a list, and their tracks.
    fn list<'p>(
        &mut self,
        objects: &'p Objects,
        tracks: &ListTracks,
        path: &PathRef<'_>,
        place: Place<'p>,
    ) -> (Objects, ListTracks) {
        let (mut expanded, mut moved) = (objects.clone(), tracks.clone());
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| needs_expansion(object)) {
            let path = path.index(i);
            let place = Place { light_group: object.light_group.as_deref(), ..place };
            let at_frame = self.object(object, self.seconds, &path, place);
            let track = tracks.get(&i);
            if track.is_some() || !self.moments.is_empty() && self.moves(object, &path) {
                let moments = self.moments.clone();
                let key = |(moment, seconds): (usize, &f64)| {
                    let object = track_object(object, track, moment);
                    self.object(&object, *seconds, &path, Place { light_group: place.light_group, ..place.at_moment() })
                };
                let keys: Vec<Object> = moments.iter().enumerate().map(key).collect();
                if keys.iter().any(|key| *key != at_frame) {
                    moved.insert(i, ObjectTrack::Whole(keys.into_iter().map(Item::from).collect()));
                }
            }
            if let Some(slot) = expanded.get_mut(i) {
                *slot.value_mut_unmarked() = at_frame;
            }
        }
        (expanded, moved)
    }

    /// Whether a model in an object shows a clip at the scene's time.
    fn moves(&self, object: &Object, path: &PathRef<'_>) -> bool {
        let own = object.model.as_ref().is_some_and(|model| {
            let file = self.files.locate(&Path::from(&path.key("model").key("file")), &model.file);
            let opened = self.asset_cache.model_with_control(&file, self.files.control);
            model.at.is_none() && opened.file.as_ref().is_ok_and(|file| file.moves(&model.choice(self.seconds)))
        });
        let path = path.key("objects");
        own || object.inner().iter().enumerate().any(|(i, inner)| self.moves(inner, &path.index(i)))
    }

    /// Expands the models and instances of an object at a time in seconds. At the frame, adds the other
    /// parts of models to the scene.
    fn object(&mut self, object: &Object, seconds: f64, path: &PathRef<'_>, place: Place<'_>) -> Object {
        let mut expanded = object.clone();
        // Lights and cameras of a model with several instances have no single place.
        let outer = place.transform.filter(|_| object.instances.is_none());
        let transform = outer.and_then(|outer| Some(composed(object)?.then(&outer)));
        let place = Place { transform, is_hidden: place.is_hidden || !object.is_visible(), ..place };
        if let Some(objects) = &object.objects {
            let inner = objects.iter().enumerate().map(|(i, inner)| match needs_expansion(inner) {
                true => Item::from(self.object(inner, seconds, &path.key("objects").index(i), place)),
                false => inner.clone(),
            });
            expanded.objects = Some(inner.collect());
        }
        if let Some(instances) = &object.instances {
            expanded.instances = Some(self.instances(instances, &path.key("instances"), place).into());
        }
        if let Some(model) = &object.model {
            expanded.model = None;
            let replaced = object.material.is_some();
            expanded.objects = Some(self.model(model, replaced, seconds, &path.key("model"), place));
        }
        expanded
    }

    /// Instances with those of their file.
    fn instances(&mut self, instances: &Instances, path: &PathRef<'_>, place: Place<'_>) -> Instances {
        if self.instance_source == InstanceSource::Head {
            return self.files.declared_instances(instances, path);
        }
        let mut findings = Vec::new();
        let expanded = self.files.instances(instances, path, &mut findings);
        if !place.is_moment {
            self.findings.extend(findings);
        }
        expanded
    }

    /// Reports an error or warning about a model, once for all times.
    pub fn report(&mut self, finding: Finding, path: Path, place: Place<'_>) {
        if !place.is_moment {
            self.findings.push(finding.at(path));
        }
    }
}

/// Writes the whole name of the camera that `render.camera` selects. Returns an error if there is none.
fn choose_camera(scene: &mut Description) -> Option<Finding> {
    let chosen = scene.render.camera.as_ref()?.0.clone();
    let single = scene.camera.iter().map(|_| "camera");
    let names = single.chain(scene.cameras.keys().map(String::as_str));
    if let Some(name) = find_camera(names.clone(), &chosen).map(str::to_owned) {
        scene.render.value_mut_unmarked().camera = Some(CameraName(name));
        return None;
    }
    let help = did_you_mean_or_list(&chosen, names).unwrap_or_else(|| "the scene has no cameras".to_owned());
    let missing = Finding::error(format!("no camera is called `{chosen}`")).help(help);
    Some(missing.at(Path::root().key("render").key("camera")))
}

/// Object at a moment of its track.
fn track_object(object: &Object, track: Option<&ObjectTrack>, moment: usize) -> Object {
    match track {
        None => object.clone(),
        Some(ObjectTrack::Whole(keys)) => keys.get(moment).map_or_else(|| object.clone(), |key| (**key).clone()),
        Some(ObjectTrack::Inner(tracks)) => {
            let inner = object.inner().iter().enumerate();
            let inner = inner.map(|(i, inner)| Item::from(track_object(inner, tracks.get(&i), moment)));
            Object { objects: Some(inner.collect::<Shared<Vec<_>>>()), ..object.clone() }
        }
    }
}

/// Transform of an object; `None` if a step is degenerate, which placing reports.
fn composed(object: &Object) -> Option<Transform> {
    let next = |whole: Transform, step: &crate::TransformStep| Some(whole.then(&step.transform().ok()?));
    object.transform.iter().try_fold(Transform::IDENTITY, next)
}
