//! Reads items from JSON in batches: evaluates expressions for a frame, validates against the
//! schema, and deserializes all items of the batch together.

use super::{ItemValue, attach_items, with_path_ref};
use crate::animate::{Resolver, SceneSources};
use crate::description::{Description, Object, Objects};
use crate::document::{Node, SourceSpan};
use crate::item::{Item, Template};
use crate::path::{Path, PathRef, Step};
use crate::report::Finding;
use crate::validate::{self, NameScope, Plain};
use serde::Deserialize;
use std::borrow::Cow;
use std::sync::Arc;

/// JSON source of an item or of a list of items.
#[derive(Clone, Debug)]
pub(crate) struct ItemSource {
    /// Path of the item in the scene.
    pub path: Path,
    /// JSON of the item, with unevaluated expressions and value forms.
    pub template: Arc<Template>,
    /// Whether the item keeps its template.
    pub keeps_template: bool,
    /// Whether the scene holds the item's value at another time, so that setters suffice.
    pub value_is_known: bool,
    pub place: Option<SourceSpan>,
}

impl ItemSource {
    /// JSON of an item at a path that has not been read yet.
    pub fn unread(path: Path, node: Node) -> Self {
        let place = node.place;
        let template = Arc::new(Template { node, depends_on_time: true, setters: None });
        Self { path, template, keeps_template: false, value_is_known: false, place }
    }
}

/// Kind of an item, which decides where its JSON is stored in the batch.
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
    /// Number of lights in the list.
    Lights(usize),
    LightGroup,
    /// Object whose numbers were set.
    SetObject,
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
            ("background_light_group", []) => Self::LightGroup,
            _ => return None,
        })
    }
}

/// Value of each item with its path.
pub(crate) type ItemValues<'w> = Vec<(Cow<'w, Path>, ItemValue)>;

/// Reads items of `scene` for a frame. `head` holds the scene's `animation`, `variables` and
/// `paths`. Returns the values, or `None` after an error, and all findings.
pub(crate) fn read_items<'w>(
    scene: &Description,
    head: &Node,
    sources: SceneSources<'_>,
    frame: f64,
    items: &'w [ItemSource],
) -> (Option<ItemValues<'w>>, Vec<Finding>) {
    let mut reader = ItemReader::new(Resolver::new(head, sources, &scene.programs, frame), scene);
    items.iter().for_each(|source| reader.add(source));
    reader.finish()
}

/// Reads items that are new or were edited, stores them in the scene, and attaches their templates.
/// Returns whether the items were stored, and all findings.
pub(crate) fn replace_items(
    scene: &mut Description,
    head: &Node,
    sources: SceneSources<'_>,
    frame: f64,
    items: &[ItemSource],
) -> (bool, Vec<Finding>) {
    let (parts, findings) = read_items(scene, head, sources, frame, items);
    let Some(parts) = parts else { return (false, findings) };
    let inline_names: Vec<String> = parts.iter().filter_map(|(path, part)| part.inline_texture_name(path)).collect();
    parts.into_iter().for_each(|(path, part)| scene.put(&path, part));
    attach_items(scene, head, items, &inline_names);
    (true, findings)
}

struct ItemReader<'s, 'w> {
    resolver: Resolver<'s>,
    scene: &'s Description,
    findings: Vec<Finding>,
    /// Findings for items without a value, which other findings explain if there are any.
    unresolved: Vec<Finding>,
    /// Validated items so far: source, kind, JSON.
    read: Vec<(&'w ItemSource, Kind, Plain)>,
    /// Inline textures by name.
    textures: Vec<(String, Plain)>,
    /// Objects whose numbers were set, in order.
    set: Vec<Item<Object>>,
}

impl<'s, 'w> ItemReader<'s, 'w> {
    fn new(resolver: Resolver<'s>, scene: &'s Description) -> Self {
        Self {
            resolver,
            scene,
            findings: Vec::new(),
            unresolved: Vec::new(),
            read: Vec::new(),
            textures: Vec::new(),
            set: Vec::new(),
        }
    }

    /// Applies the setters of an animated object; `None` if the item must be read.
    fn set(&mut self, source: &ItemSource) -> Option<Item<Object>> {
        let setters = source.template.setters.as_ref().filter(|_| source.value_is_known)?;
        setters.apply(self.scene.object_at(&source.path)?, &mut self.resolver)
    }

    /// Evaluates and validates an item.
    fn add(&mut self, source: &'w ItemSource) {
        if let Some(object) = self.set(source) {
            self.set.push(object);
            self.read.push((source, Kind::SetObject, Plain::Null));
            return;
        }
        let Some(kind) = Kind::of(&source.path) else { return };
        let message_path = message_path(&source.path);
        let before = self.findings.len();
        let checked = with_path_ref(message_path.steps(), &PathRef::Root, &mut |at: &PathRef<'_>| {
            let node = self.resolver.value(&source.template.node, at);
            validate::item(&node, &source.path, at, NameScope::Scene(self.scene), before)
        });
        self.textures.extend(checked.textures);
        self.findings.extend(checked.findings);
        self.findings.extend(checked.warnings);
        match checked.json {
            Some(Plain::Array(list)) if kind == Kind::Lights(0) => {
                self.read.push((source, Kind::Lights(list.len()), Plain::Array(list)));
            }
            Some(json) => self.read.push((source, kind, json)),
            None if self.findings.len() == before => {
                let message = "this value is not defined at all requested times";
                self.unresolved.push(Finding::error(message).at(&*message_path).on(source.place));
            }
            None => {}
        }
    }

    /// Deserializes the batch. Returns the items with their paths, or `None` after an error, and
    /// all findings.
    fn finish(self) -> (Option<ItemValues<'w>>, Vec<Finding>) {
        let mut findings = self.resolver.finish();
        if findings.is_empty() {
            findings.extend(self.unresolved);
        }
        findings.extend(self.findings);
        if findings.iter().any(Finding::is_error) {
            return (None, findings);
        }
        let read: Vec<(&'w ItemSource, Kind)> = self.read.iter().map(|(source, kind, _)| (*source, *kind)).collect();
        let json = combine(self.read, self.textures);
        match Description::deserialize(&json) {
            Ok(scene) => (Some(split(scene, &read, self.set)), findings),
            // The types reject what the schema accepts: a bug of this program.
            Err(error) => {
                findings.push(Finding::error(error.to_string()));
                (None, findings)
            }
        }
    }
}

/// Path of an item for messages; an inline texture is reported where it is written.
fn message_path(path: &Path) -> Cow<'_, Path> {
    match path.steps() {
        [Step::Key(section), Step::Key(name)] if section == "textures" && name.starts_with('/') => {
            Cow::Owned(Path::from_pointer(name))
        }
        _ => Cow::Borrowed(path),
    }
}

/// Combines all items of a batch into the JSON of one scene. Items of maps are keyed by their
/// number in the batch; a list of objects becomes a group.
fn combine(read: Vec<(&ItemSource, Kind, Plain)>, textures: Vec<(String, Plain)>) -> Plain {
    let mut sections: [Vec<(Cow<'static, str>, Plain)>; 4] = Default::default();
    let (mut lights, mut objects) = (Vec::new(), Vec::new());
    let mut scene = vec![("version".into(), Plain::Number(1.into()))];
    let [cameras, named, materials, groups] = &mut sections;
    for (i, (_, kind, json)) in read.into_iter().enumerate() {
        match kind {
            Kind::Camera => cameras.push((i.to_string().into(), json)),
            Kind::Texture => named.push((i.to_string().into(), json)),
            Kind::Material => materials.push((i.to_string().into(), json)),
            Kind::Objects => groups.push((i.to_string().into(), json)),
            Kind::Light => lights.push(json),
            Kind::Lights(_) => lights.extend(if let Plain::Array(list) = json { list } else { Vec::new() }),
            Kind::Object => objects.push(json),
            Kind::Render => scene.push(("render".into(), json)),
            Kind::Tone => scene.push(("tone".into(), json)),
            Kind::Background => scene.push(("background".into(), json)),
            Kind::LightGroup => scene.push(("background_light_group".into(), json)),
            Kind::SetObject => {}
        }
    }
    named.extend(textures.into_iter().map(|(name, texture)| (name.into(), texture)));
    for (key, map) in ["cameras", "textures", "materials", "groups"].into_iter().zip(sections) {
        scene.push((key.into(), Plain::Object(map)));
    }
    scene.push(("lights".into(), Plain::Array(lights)));
    scene.push(("objects".into(), Plain::Array(objects)));
    Plain::Object(scene)
}

/// Splits the deserialized scene of a batch into items with their paths.
fn split<'w>(scene: Description, read: &[(&'w ItemSource, Kind)], set: Vec<Item<Object>>) -> ItemValues<'w> {
    let Description { render, tone, mut background, background_light_group, cameras, textures, .. } = scene;
    let (mut cameras, mut textures) = (cameras.into_inner(), textures.into_inner());
    let (mut materials, mut groups) = (scene.materials.into_inner(), scene.groups.into_inner());
    let (mut lights, mut objects) = (scene.lights.into_inner().into_iter(), scene.objects.into_inner().into_iter());
    let mut set = set.into_iter();
    let mut parts = Vec::with_capacity(read.len());
    for (i, (source, kind)) in read.iter().enumerate() {
        let key = || i.to_string();
        let part = match kind {
            Kind::Render => Some(ItemValue::Render(source.item(render.clone()))),
            Kind::Tone => Some(ItemValue::Tone(source.item(tone.clone()))),
            Kind::Background => background.take().map(|item| ItemValue::Background(source.item(item))),
            Kind::Camera => cameras.swap_remove(&key()).map(|item| ItemValue::Camera(source.item(item))),
            Kind::Texture => textures.shift_remove(&key()).map(|item| ItemValue::Texture(source.item(item))),
            Kind::Material => materials.swap_remove(&key()).map(|item| ItemValue::Material(source.item(item))),
            Kind::Light => lights.next().map(|item| ItemValue::Light(source.item(item))),
            Kind::Lights(count) => {
                let items = lights.by_ref().take(*count).map(|light| light.with_source(source.place, None));
                Some(ItemValue::Lights(items.collect()))
            }
            Kind::Object => objects.next().map(|item| ItemValue::Object(source.object(item))),
            Kind::Objects => groups.swap_remove(&key()).map(|list| ItemValue::Objects(source.list(list))),
            Kind::LightGroup => background_light_group.clone().map(ItemValue::LightGroup),
            Kind::SetObject => set.next().map(ItemValue::Object),
        };
        parts.extend(part.map(|part| (Cow::Borrowed(&source.path), part)));
    }
    // The remaining textures are inline textures that value forms produced.
    for (name, texture) in textures {
        let path = Path::root().key("textures").key(name);
        parts.push((Cow::Owned(path), ItemValue::FormTexture(texture.with_source(None, None))));
    }
    parts
}

impl ItemSource {
    fn item<T: Clone>(&self, item: Item<T>) -> Item<T> {
        item.with_source(self.place, self.keeps_template.then(|| Arc::clone(&self.template)))
    }

    fn object(&self, item: Item<Object>) -> Item<Object> {
        self.item(mark_children_read(item, &self.template.node, self.place))
    }

    fn list(&self, list: Objects) -> Objects {
        let item = |item: Item<Object>| {
            mark_children_read(item, &self.template.node, self.place).with_source(self.place, None)
        };
        list.into_inner().into_iter().map(item).collect()
    }
}

/// Marks the child objects of an object as read; they have no templates of their own.
fn mark_children_read(mut object: Item<Object>, node: &Node, place: Option<SourceSpan>) -> Item<Object> {
    if object.objects.is_none() {
        return object;
    }
    let nodes = node.get("objects").map(Node::elements).unwrap_or_default();
    let inner = |(i, item): (usize, Item<Object>)| {
        let node = nodes.get(i);
        let place = node.and_then(|node| node.place).or(place);
        let item = if let Some(node) = node { mark_children_read(item, node, place) } else { item };
        item.with_source(place, None)
    };
    let objects = object.value_mut_unmarked().objects.take();
    object.value_mut_unmarked().objects =
        objects.map(|list| list.into_inner().into_iter().enumerate().map(inner).collect());
    object
}
