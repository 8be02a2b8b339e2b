//! What moves while the shutter is open: the items that change meanwhile, at even times from opening to closing.

use super::{Part, Reader, Wanted, write};
use crate::Object;
use crate::animate::Changing;
use crate::description::Description;
use crate::document::{Node, Sources};
use crate::item::{Item, Template};
use crate::path::{Path, Step};
use crate::report::Finding;
use crate::validate::Known;
use juggler_tracer::camera::AnyCamera;
use juggler_tracer::light::AnyLight;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Times that are looked at. What moves goes straight between them, and round where it turns.
const MOMENTS: usize = 17;

/// What moves while the shutter is open, each at 17 even times from opening to closing. What is not in here stands still.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tracks {
    /// The scene's own objects.
    pub objects: ListTracks,
    /// Those of groups.
    pub groups: BTreeMap<String, ListTracks>,
    /// Lights by their numbers.
    pub lights: BTreeMap<usize, Vec<Item<AnyLight>>>,
    /// The single camera, by the empty name, and the others by theirs.
    pub cameras: BTreeMap<String, Vec<Item<AnyCamera>>>,
}

/// The objects of a list that move, by their numbers.
pub type ListTracks = BTreeMap<usize, ObjectTrack>;

/// How an object moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ObjectTrack {
    /// The object with all that it holds, at each time.
    Whole(Vec<Item<Object>>),
    /// Some of the objects that it holds.
    Inner(ListTracks),
}

impl Tracks {
    /// Of a scene whose shutter opens and closes at these frames from the scene's own, and what is wrong with it meanwhile.
    pub(crate) fn of(scene: &Description, sources: &Sources, frame: f64) -> (Self, Vec<Finding>) {
        let [open, close] = scene.render.shutter;
        let is_open = open < close && open.is_finite() && close.is_finite();
        let wanted = if is_open { moving(scene) } else { Vec::new() };
        if wanted.is_empty() {
            return Default::default();
        }
        let head = write::head(scene);
        let mut moments: Vec<Vec<(Path, Part)>> = Vec::with_capacity(MOMENTS);
        for moment in 0..MOMENTS {
            let share = moment as f64 / (MOMENTS - 1) as f64;
            let time = frame + open + (close - open) * share;
            let mut reader = Reader::new(&head, sources, time, Known::Scene(scene));
            wanted.iter().for_each(|wanted| reader.add(wanted));
            match reader.finish() {
                (Some(parts), _) => moments.push(parts),
                // What is wrong at one time is likely to be so at the next: once is enough.
                (None, findings) => return (Self::default(), findings),
            }
        }
        (Self::through(scene, &wanted, moments), Vec::new())
    }

    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Puts the moments of each item together.
    fn through(scene: &Description, wanted: &[Wanted], moments: Vec<Vec<(Path, Part)>>) -> Self {
        let mut tracks = Self::default();
        let mut moments: Vec<_> = moments.into_iter().map(Vec::into_iter).collect();
        for Wanted { path, .. } in wanted {
            let keys: Vec<Part> = moments.iter_mut().filter_map(|parts| parts.next().map(|(_, part)| part)).collect();
            if keys.len() == MOMENTS {
                tracks.add(scene, path.steps(), keys);
            }
        }
        tracks
    }

    fn add(&mut self, scene: &Description, steps: &[Step], keys: Vec<Part>) {
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
                let keys = all(keys, |part| if let Part::Camera(camera) = part { Some(camera) } else { None });
                if keys.iter().any(|key| Some(key) != known) {
                    self.cameras.insert(name, keys);
                }
            }
            _ => {}
        }
    }

    fn add_lights(&mut self, scene: &Description, steps: &[Step], keys: Vec<Part>) {
        let mut insert = |i: usize, keys: Vec<Item<AnyLight>>| {
            if keys.iter().any(|key| Some(key) != scene.lights.get(i)) {
                self.lights.insert(i, keys);
            }
        };
        match steps {
            [Step::Index(i)] => insert(*i, all(keys, |part| if let Part::Light(l) = part { Some(l) } else { None })),
            _ => {
                let lists = all(keys, |part| if let Part::Lights(lights) = part { Some(lights) } else { None });
                if lists.iter().all(|list| list.len() == scene.lights.len()) {
                    (0..scene.lights.len())
                        .for_each(|i| insert(i, lists.iter().filter_map(|list| list.get(i).cloned()).collect()));
                }
            }
        }
    }
}

fn add_objects(tracks: &mut ListTracks, objects: &[Item<Object>], steps: &[Step], keys: Vec<Part>) {
    let mut insert = |i: usize, keys: Vec<Item<Object>>| {
        if keys.iter().any(|key| Some(key) != objects.get(i)) {
            tracks.insert(i, ObjectTrack::Whole(keys));
        }
    };
    match steps {
        // A list that is a form.
        [] => {
            let lists = all(keys, |part| if let Part::Objects(objects) = part { Some(objects) } else { None });
            if lists.iter().all(|list| list.len() == objects.len()) {
                (0..objects.len())
                    .for_each(|i| insert(i, lists.iter().filter_map(|list| list.get(i).cloned()).collect()));
            }
        }
        [Step::Index(i)] => insert(*i, all(keys, |part| if let Part::Object(o) = part { Some(o) } else { None })),
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

/// The same kind of part of all keys.
fn all<T>(keys: Vec<Part>, part: impl Fn(Part) -> Option<T>) -> Vec<T> {
    keys.into_iter().filter_map(part).collect()
}

/// What may move while the shutter is open: objects, lights and cameras whose templates depend on time.
fn moving(scene: &Description) -> Vec<Wanted> {
    let moves = |path: &[Step]| matches!(path.first(), Some(Step::Key(s)) if ["objects", "groups", "lights", "camera", "cameras"].contains(&s.as_str()));
    scene.timed().into_iter().filter(|wanted| moves(wanted.path.steps())).collect()
}

impl Description {
    /// Everything that is another thing at another time.
    pub(crate) fn timed(&self) -> Vec<Wanted> {
        self.worked_out(|template| template.depends_on_time)
    }

    /// Every item and list whose template is wanted.
    pub(crate) fn worked_out(&self, is_wanted: impl Fn(&Template) -> bool) -> Vec<Wanted> {
        let mut found = Vec::new();
        self.each_item(&mut |at, item| {
            if let Some(template) = item.template().filter(|template| is_wanted(template)) {
                found.push(Wanted {
                    path: at.into(),
                    template: Arc::clone(template),
                    moves: true,
                    place: item.place(),
                });
            }
        });
        let forms = self.list_forms.iter().filter(|form| is_wanted(&form.template));
        found.extend(forms.map(|form| Wanted {
            path: form.path.clone(),
            template: Arc::clone(&form.template),
            moves: true,
            place: form.template.node.place,
        }));
        found
    }

    /// Finds anew which templates depend on time, by what `head` holds.
    pub(crate) fn time_again(&mut self, head: &Node) {
        let mut changing = Changing::of(head);
        for Wanted { path, template, .. } in self.worked_out(|_| true) {
            let depends_on_time = changing.holds(&template.node);
            if depends_on_time != template.depends_on_time {
                let template = Arc::new(Template { node: template.node.clone(), depends_on_time });
                if let Some(item) = self.item_mut(&path) {
                    item.set_template(Some(template));
                }
            }
        }
    }
}
