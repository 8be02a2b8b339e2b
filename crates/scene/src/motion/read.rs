//! Items read from their JSON, as many at once as are wanted: expressions are worked out for a frame, values held
//! against the schema, then all become types together.

use super::{Given, with_trail};
use crate::animate::Resolver;
use crate::description::{Backdrop, Description, Object, Objects, Render};
use crate::document::{Node, Place, Sources};
use crate::item::{Item, Template};
use crate::path::{Path, Step, Trail};
use crate::report::Finding;
use crate::shared::Shared;
use crate::validate::{self, Known};
use juggler_imaging::Tone;
use juggler_tracer::camera::AnyCamera;
use juggler_tracer::light::AnyLight;
use juggler_tracer::material::AnyMaterial;
use juggler_tracer::texture::AnyTexture;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::sync::Arc;

/// An item, or a list of items, that is to be read.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    /// Where it belongs.
    pub path: Path,
    /// Its JSON, with expressions and forms.
    pub template: Arc<Template>,
    /// Whether the item moves: it keeps its template.
    pub moves: bool,
    pub place: Option<Place>,
}

/// An item that was read, or a list of items.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Part {
    Render(Item<Render>),
    Tone(Item<Tone>),
    Background(Item<Backdrop>),
    Camera(Item<AnyCamera>),
    Texture(Item<AnyTexture>),
    /// One that a value form gave in place.
    FormTexture(Item<AnyTexture>),
    Material(Item<AnyMaterial>),
    Light(Item<AnyLight>),
    Object(Item<Object>),
    Objects(Objects),
    Lights(Shared<Vec<Item<AnyLight>>>),
    Label(String),
}

/// Where an item stands among those that are read together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Render,
    Tone,
    Background,
    Camera,
    Texture,
    Material,
    Light,
    Object,
    Objects,
    /// So many.
    Lights(usize),
    Label,
}

impl Kind {
    fn of(path: &Path) -> Option<Self> {
        let (Step::Key(section), rest) = path.steps().split_first()? else { return None };
        Some(match (section.as_str(), rest) {
            ("render", []) => Self::Render,
            ("tone", []) => Self::Tone,
            ("background", []) => Self::Background,
            ("camera", []) | ("cameras", [_]) => Self::Camera,
            ("textures", [_]) => Self::Texture,
            ("materials", [_]) => Self::Material,
            ("lights", [_]) => Self::Light,
            ("lights", []) => Self::Lights(0),
            ("objects", []) | ("groups", [_]) => Self::Objects,
            ("objects", _) | ("groups", [_, ..]) => Self::Object,
            ("background_light_group", []) => Self::Label,
            _ => return None,
        })
    }
}

/// Reads items of a scene for one frame.
pub(crate) struct Reader<'s> {
    resolver: Resolver<'s>,
    known: Known<'s>,
    findings: Vec<Finding>,
    /// What was read so far: the wanted item, what it is, its JSON.
    read: Vec<(&'s Wanted, Kind, Value)>,
    /// Textures that were written in place by value forms.
    textures: Vec<(String, Value)>,
}

impl<'s> Reader<'s> {
    /// For a frame of the scene whose `animation`, `variables` and `paths` `head` holds.
    pub fn new(head: &'s Node, sources: &'s Sources, frame: f64, known: Known<'s>) -> Self {
        let resolver = Resolver::new(head, sources, frame);
        Self { resolver, known, findings: Vec::new(), read: Vec::new(), textures: Vec::new() }
    }

    /// Reads an item.
    pub fn add(&mut self, wanted: &'s Wanted) {
        let Some(kind) = Kind::of(&wanted.path) else { return };
        let stands = written_at(&wanted.path);
        let before = self.findings.len();
        let checked = with_trail(stands.steps(), &Trail::Root, &mut |at: &Trail<'_>| {
            let node = self.resolver.value(&wanted.template.node, at);
            validate::item(&node, &wanted.path, at, self.known)
        });
        self.textures.extend(checked.textures);
        self.findings.extend(checked.findings);
        self.findings.extend(checked.warnings);
        match checked.json {
            Some(Value::Array(list)) if kind == Kind::Lights(0) => {
                self.read.push((wanted, Kind::Lights(list.len()), Value::Array(list)));
            }
            Some(json) => self.read.push((wanted, kind, json)),
            // The resolver has said what is wrong, or says nothing where something else is wrong that it needs.
            None if self.findings.len() == before => {
                let message = "this has no value at every time that is asked for";
                self.findings.push(Finding::error(message).at(&stands).on(wanted.place));
            }
            None => {}
        }
    }

    /// The items with their paths, unless something is wrong, and all that is to be said.
    pub fn finish(self) -> (Option<Vec<(Path, Part)>>, Vec<Finding>) {
        let mut findings = self.resolver.finish();
        // That an item has no value follows from what is wrong with what it is worked out from.
        let known = !findings.is_empty();
        findings.extend(self.findings.into_iter().filter(|finding| !(known && finding.says("has no value at every"))));
        if findings.iter().any(Finding::is_error) {
            return (None, findings);
        }
        let read: Vec<(&Wanted, Kind)> = self.read.iter().map(|(wanted, kind, _)| (*wanted, *kind)).collect();
        let json = together(self.read, self.textures);
        match Description::deserialize(&json) {
            Ok(scene) => (Some(taken(scene, &read)), findings),
            // The schema allows what the types refuse: only a slip of ours can bring us here.
            Err(error) => {
                findings.push(Finding::error(error.to_string()));
                (None, findings)
            }
        }
    }
}

/// Where messages say that an item stands: a texture that is written in place stands there.
fn written_at(path: &Path) -> Path {
    match path.steps() {
        [Step::Key(section), Step::Key(name)] if section == "textures" && name.starts_with('/') => {
            Path::from_pointer(name)
        }
        _ => path.clone(),
    }
}

/// One scene of all that was read. Items of maps are numbered in order; so are lists of objects, as groups.
fn together(read: Vec<(&Wanted, Kind, Value)>, textures: Vec<(String, Value)>) -> Value {
    let mut sections: [Map<String, Value>; 4] = Default::default();
    let (mut lights, mut objects, mut scene) = (Vec::new(), Vec::new(), Map::new());
    let [cameras, named, materials, groups] = &mut sections;
    for (i, (_, kind, json)) in read.into_iter().enumerate() {
        let number = |map: &mut Map<String, Value>, json: Value| drop(map.insert(i.to_string(), json));
        match kind {
            Kind::Camera => number(cameras, json),
            Kind::Texture => number(named, json),
            Kind::Material => number(materials, json),
            Kind::Objects => number(groups, json),
            Kind::Light => lights.push(json),
            Kind::Lights(_) => lights.extend(if let Value::Array(list) = json { list } else { Vec::new() }),
            Kind::Object => objects.push(json),
            Kind::Render => drop(scene.insert("render".into(), json)),
            Kind::Tone => drop(scene.insert("tone".into(), json)),
            Kind::Background => drop(scene.insert("background".into(), json)),
            Kind::Label => drop(scene.insert("background_light_group".into(), json)),
        }
    }
    named.extend(textures);
    scene.insert("version".into(), 1.into());
    for (key, map) in ["cameras", "textures", "materials", "groups"].into_iter().zip(sections) {
        scene.insert(key.into(), Value::Object(map));
    }
    scene.insert("lights".into(), Value::Array(lights));
    scene.insert("objects".into(), Value::Array(objects));
    Value::Object(scene)
}

/// The items of a scene that was put together, each in its place.
fn taken(scene: Description, read: &[(&Wanted, Kind)]) -> Vec<(Path, Part)> {
    let Description { render, tone, mut background, background_light_group, cameras, textures, .. } = scene;
    let (mut cameras, mut textures) = (cameras.into_inner(), textures.into_inner());
    let (mut materials, mut groups) = (scene.materials.into_inner(), scene.groups.into_inner());
    let (mut lights, mut objects) = (scene.lights.into_inner().into_iter(), scene.objects.into_inner().into_iter());
    let mut parts = Vec::with_capacity(read.len());
    for (i, (wanted, kind)) in read.iter().enumerate() {
        let key = i.to_string();
        let part = match kind {
            Kind::Render => Some(Part::Render(wanted.item(render.clone()))),
            Kind::Tone => Some(Part::Tone(wanted.item(tone.clone()))),
            Kind::Background => background.take().map(|item| Part::Background(wanted.item(item))),
            Kind::Camera => cameras.swap_remove(&key).map(|item| Part::Camera(wanted.item(item))),
            Kind::Texture => textures.shift_remove(&key).map(|item| Part::Texture(wanted.item(item))),
            Kind::Material => materials.swap_remove(&key).map(|item| Part::Material(wanted.item(item))),
            Kind::Light => lights.next().map(|item| Part::Light(wanted.item(item))),
            Kind::Lights(count) => {
                let items = lights.by_ref().take(*count).map(|light| light.learned(wanted.place, None));
                Some(Part::Lights(items.collect()))
            }
            Kind::Object => objects.next().map(|item| Part::Object(wanted.object(item))),
            Kind::Objects => groups.swap_remove(&key).map(|list| Part::Objects(wanted.list(list))),
            Kind::Label => background_light_group.clone().map(Part::Label),
        };
        parts.extend(part.map(|part| (wanted.path.clone(), part)));
    }
    // What is left are textures that value forms have written in place.
    for (name, texture) in textures {
        parts.push((Path::root().key("textures").key(name), Part::FormTexture(texture.learned(None, None))));
    }
    parts
}

impl Part {
    /// The name of a texture that was written in place.
    pub fn name_in_place(&self, path: &Path) -> Option<String> {
        match (self, path.steps()) {
            (Self::FormTexture(_), [_, Step::Key(name)]) => Some(name.clone()),
            _ => None,
        }
    }

    /// The value as JSON.
    pub fn json(&self) -> Value {
        let json = match self {
            Self::Render(item) => serde_json::to_value(item),
            Self::Tone(item) => serde_json::to_value(item),
            Self::Background(item) => serde_json::to_value(item),
            Self::Camera(item) => serde_json::to_value(item),
            Self::Texture(item) | Self::FormTexture(item) => serde_json::to_value(item),
            Self::Material(item) => serde_json::to_value(item),
            Self::Light(item) => serde_json::to_value(item),
            Self::Object(item) => serde_json::to_value(item),
            Self::Objects(list) => serde_json::to_value(list),
            Self::Lights(list) => serde_json::to_value(list),
            Self::Label(label) => serde_json::to_value(label),
        };
        json.unwrap_or_default()
    }
}

impl Wanted {
    fn item<T: Clone>(&self, item: Item<T>) -> Item<T> {
        item.learned(self.place, self.moves.then(|| Arc::clone(&self.template)))
    }

    fn object(&self, item: Item<Object>) -> Item<Object> {
        self.item(within(item, &self.template.node, self.place))
    }

    fn list(&self, list: Objects) -> Objects {
        let item = |item: Item<Object>| within(item, &self.template.node, self.place).learned(self.place, None);
        list.into_inner().into_iter().map(item).collect()
    }
}

/// An object whose inner objects were read with it, and do not move by themselves.
fn within(mut object: Item<Object>, node: &Node, place: Option<Place>) -> Item<Object> {
    if object.objects.is_none() {
        return object;
    }
    let nodes = node.get("objects").map(Node::elements).unwrap_or_default();
    let inner = |(i, item): (usize, Item<Object>)| {
        let node = nodes.get(i);
        let place = node.and_then(|node| node.place).or(place);
        let item = if let Some(node) = node { within(item, node, place) } else { item };
        item.learned(place, None)
    };
    let objects = object.quietly().objects.take();
    object.quietly().objects = objects.map(|list| list.into_inner().into_iter().enumerate().map(inner).collect());
    object
}

impl Description {
    /// Puts what was read where it belongs.
    pub(crate) fn put(&mut self, path: &Path, part: Part) {
        let steps = path.steps();
        match part {
            Part::Render(item) => self.render = item,
            Part::Tone(item) => self.tone = item,
            Part::Background(item) => self.background = Some(item),
            Part::Camera(item) => match steps {
                [_, Step::Key(name)] => drop(self.cameras.insert(name.clone(), item)),
                _ => self.camera = Some(item),
            },
            Part::Texture(item) => insert(&mut self.textures, steps, item),
            Part::FormTexture(item) => {
                if let [_, Step::Key(name)] = steps {
                    self.form_textures.insert(name.clone());
                }
                insert(&mut self.textures, steps, item);
            }
            Part::Material(item) => insert(&mut self.materials, steps, item),
            Part::Light(item) => {
                if let [_, Step::Index(i)] = steps {
                    set(&mut self.lights, *i, item);
                }
            }
            Part::Object(item) => {
                if let Some((objects, i)) = self.list_mut(path) {
                    set(objects, i, item);
                }
            }
            Part::Objects(_) | Part::Lights(_) | Part::Label(_) => self.put_given(path, part),
        }
    }

    /// Puts what the form of a list gave.
    fn put_given(&mut self, path: &Path, part: Part) {
        let given = match part {
            Part::Objects(objects) => {
                match path.steps() {
                    [_, Step::Key(name)] => drop(self.groups.insert(name.clone(), objects.clone())),
                    _ => self.objects = objects.clone(),
                }
                Given::Objects(objects)
            }
            Part::Lights(lights) => {
                self.lights = lights.clone();
                Given::Lights(lights)
            }
            Part::Label(label) => {
                self.background_light_group = Some(label.clone());
                Given::Label(label)
            }
            _ => return,
        };
        if let Some(form) = self.list_forms.iter_mut().find(|form| form.path == *path) {
            form.given = given;
        }
    }
}

/// Puts an item in place of that at a position, or behind the last.
fn set<T>(list: &mut Shared<Vec<Item<T>>>, at: usize, item: Item<T>) {
    match list.get_mut(at) {
        Some(place) => *place = item,
        None => list.push(item),
    }
}

fn insert<T>(map: &mut Shared<indexmap::IndexMap<String, Item<T>>>, steps: &[Step], item: Item<T>) {
    if let [_, Step::Key(name)] = steps {
        map.insert(name.clone(), item);
    }
}
