//! Tracks of animated items, sampled at even times from the opening to the closing of the shutter.

use super::{ItemSource, ItemValue, ItemValues, read_items, write};
use crate::Object;
use crate::animate::{SceneSources, TimeDependence};
use crate::description::Description;
use crate::document::Node;
use crate::item::{Item, Template};
use crate::path::Step;
use crate::report::Finding;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_math::BuildControl;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Number of sampled times. Motion is linear between samples; rotations are subdivided further.
const SHUTTER_SAMPLES: usize = 17;

/// Animated items at 17 even times while the shutter is open. Items without a track are static.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tracks {
    /// Tracks of top-level objects.
    pub objects: ListTracks,
    /// Tracks of objects in groups, by group name.
    pub groups: BTreeMap<String, ListTracks>,
    /// Tracks of lights, by index.
    pub lights: BTreeMap<usize, Vec<Item<AnyLight>>>,
    /// Tracks of cameras, by name; the single `camera` has the empty name.
    pub cameras: BTreeMap<String, Vec<Item<AnyCamera>>>,
}

/// Tracks of the objects of a list, by index.
pub type ListTracks = BTreeMap<usize, ObjectTrack>;

/// Track of an object.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ObjectTrack {
    /// The whole object at each time.
    Whole(Vec<Item<Object>>),
    /// Tracks of child objects only.
    Inner(ListTracks),
}

impl Tracks {
    /// Samples all animated items of a scene at `frame` over its shutter interval. Returns empty
    /// tracks and the findings if a sample is invalid, and empty tracks if `control` is cancelled.
    pub(crate) fn sample(
        scene: &Description,
        sources: SceneSources<'_>,
        frame: f64,
        control: &BuildControl,
    ) -> (Self, Vec<Finding>) {
        let [open, close] = scene.render.shutter;
        let is_open = open < close && open.is_finite() && close.is_finite();
        let items = if is_open { moving_items(scene) } else { Vec::new() };
        if items.is_empty() {
            return Default::default();
        }
        let head = write::head(scene);
        let mut moments: Vec<ItemValues<'_>> = Vec::with_capacity(SHUTTER_SAMPLES);
        for moment in 0..SHUTTER_SAMPLES {
            if control.is_cancelled() {
                return Default::default();
            }
            let share = moment as f64 / (SHUTTER_SAMPLES - 1) as f64;
            let time = frame + open + (close - open) * share;
            match read_items(scene, &head, sources, time, &items) {
                (Some(parts), _) => moments.push(parts),
                // Report the findings of the first invalid sample only.
                (None, findings) => return (Self::default(), findings),
            }
        }
        (Self::from_samples(scene, &items, moments), Vec::new())
    }

    /// Collects the samples of each item.
    fn from_samples(scene: &Description, items: &[ItemSource], moments: Vec<ItemValues<'_>>) -> Self {
        let mut tracks = Self::default();
        let mut moments: Vec<_> = moments.into_iter().map(Vec::into_iter).collect();
        for ItemSource { path, .. } in items {
            let keys: Vec<ItemValue> =
                moments.iter_mut().filter_map(|parts| parts.next().map(|(_, part)| part)).collect();
            if keys.len() == SHUTTER_SAMPLES {
                tracks.add(scene, path.steps(), keys);
            }
        }
        tracks
    }

    fn add(&mut self, scene: &Description, steps: &[Step], keys: Vec<ItemValue>) {
        match steps {
            [Step::Key(section), rest @ ..] if section == "objects" => {
                add_objects(&mut self.objects, &scene.objects, rest, keys);
            }
            [Step::Key(section), Step::Key(name), rest @ ..] if section == "groups" => {
                if let Some(objects) = scene.groups.get(name) {
                    add_objects(self.groups.entry(name.clone()).or_default(), objects, rest, keys);
                }
            }
            [Step::Key(section), rest @ ..] if section == "lights" => self.add_lights(scene, rest, keys),
            [Step::Key(_), rest @ ..] => {
                let name = match rest {
                    [Step::Key(name)] => name.clone(),
                    _ => String::new(),
                };
                let known = if rest.is_empty() { scene.camera.as_ref() } else { scene.cameras.get(&name) };
                let keys = all(keys, |part| if let ItemValue::Camera(camera) = part { Some(camera) } else { None });
                if keys.iter().any(|key| Some(key) != known) {
                    self.cameras.insert(name, keys);
                }
            }
            _ => {}
        }
    }

    fn add_lights(&mut self, scene: &Description, steps: &[Step], keys: Vec<ItemValue>) {
        let mut insert = |i: usize, keys: Vec<Item<AnyLight>>| {
            if keys.iter().any(|key| Some(key) != scene.lights.get(i)) {
                self.lights.insert(i, keys);
            }
        };
        match steps {
            [Step::Index(i)] => {
                insert(*i, all(keys, |part| if let ItemValue::Light(l) = part { Some(l) } else { None }));
            }
            _ => {
                let lists = all(keys, |part| if let ItemValue::Lights(lights) = part { Some(lights) } else { None });
                if lists.iter().all(|list| list.len() == scene.lights.len()) {
                    (0..scene.lights.len())
                        .for_each(|i| insert(i, lists.iter().filter_map(|list| list.get(i).cloned()).collect()));
                }
            }
        }
    }
}

fn add_objects(tracks: &mut ListTracks, objects: &[Item<Object>], steps: &[Step], keys: Vec<ItemValue>) {
    let mut insert = |i: usize, keys: Vec<Item<Object>>| {
        if keys.iter().any(|key| Some(key) != objects.get(i)) {
            tracks.insert(i, ObjectTrack::Whole(keys));
        }
    };
    match steps {
        // The list is a single value form.
        [] => {
            let lists = all(keys, |part| if let ItemValue::Objects(objects) = part { Some(objects) } else { None });
            if lists.iter().all(|list| list.len() == objects.len()) {
                (0..objects.len())
                    .for_each(|i| insert(i, lists.iter().filter_map(|list| list.get(i).cloned()).collect()));
            }
        }
        [Step::Index(i)] => insert(*i, all(keys, |part| if let ItemValue::Object(o) = part { Some(o) } else { None })),
        [Step::Index(i), Step::Key(_), rest @ ..] => {
            let Some(inner) = objects.get(*i).and_then(|object| object.objects.as_ref()) else { return };
            let entry = tracks.entry(*i).or_insert_with(|| ObjectTrack::Inner(ListTracks::new()));
            if let ObjectTrack::Inner(tracks) = entry {
                add_objects(tracks, inner, rest, keys);
            }
        }
        _ => {}
    }
}

/// Extracts the values of one kind.
fn all<T>(keys: Vec<ItemValue>, part: impl Fn(ItemValue) -> Option<T>) -> Vec<T> {
    keys.into_iter().filter_map(part).collect()
}

/// Objects, lights and cameras with time-dependent templates.
fn moving_items(scene: &Description) -> Vec<ItemSource> {
    let moves = |path: &[Step]| matches!(path.first(), Some(Step::Key(s)) if ["objects", "groups", "lights", "camera", "cameras"].contains(&s.as_str()));
    scene.time_dependent().into_iter().filter(|source| moves(source.path.steps())).collect()
}

impl Description {
    /// Sources of all items and lists that depend on time, to be read at other times of the same
    /// scene.
    pub(crate) fn time_dependent(&self) -> Vec<ItemSource> {
        let sources = self.templates(|template| template.depends_on_time).into_iter();
        sources.map(|source| ItemSource { value_is_known: true, ..source }).collect()
    }

    /// Sources of all items and lists whose templates satisfy a predicate.
    pub(crate) fn templates(&self, predicate: impl Fn(&Template) -> bool) -> Vec<ItemSource> {
        let mut found = Vec::new();
        self.each_item(&mut |at, item| {
            if let Some(template) = item.template().filter(|template| predicate(template)) {
                found.push(ItemSource {
                    path: at.into(),
                    template: Arc::clone(template),
                    keeps_template: true,
                    value_is_known: false,
                    place: item.place(),
                });
            }
        });
        let forms = self.list_forms.iter().filter(|form| predicate(&form.template));
        found.extend(forms.map(|form| ItemSource {
            path: form.path.clone(),
            template: Arc::clone(&form.template),
            keeps_template: true,
            value_is_known: false,
            place: form.template.node.place,
        }));
        found
    }

    /// Updates the time dependence of all templates; `head` holds the scene's variables and paths.
    pub(crate) fn update_time_dependence(&mut self, head: &Node) {
        let programs = self.programs.clone();
        let mut time_dependence = TimeDependence::from_tree(head, &programs);
        for form in self.list_forms.iter_mut() {
            let depends_on_time = time_dependence.depends_on_time(&form.template.node);
            form.template = Arc::new(Template::new(form.template.node.clone(), depends_on_time, &programs));
        }
        for ItemSource { path, template, .. } in self.templates(|_| true) {
            let depends_on_time = time_dependence.depends_on_time(&template.node);
            if depends_on_time != template.depends_on_time {
                let template = Arc::new(Template::new(template.node.clone(), depends_on_time, &programs));
                if let Some(item) = self.item_mut(&path) {
                    item.set_template(Some(template));
                }
            }
        }
    }
}
