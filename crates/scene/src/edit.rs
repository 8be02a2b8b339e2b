//! Edits by JSON pointer, validated like documents.

use crate::animate::SceneSources;
use crate::description::{Description, Named, SourceSection, deserialize_scene};
use crate::document::{Member, Members, Node, Value as Json, set_at_pointer};
use crate::motion::{self, ItemSource};
use crate::path::{Path, PathRef, Step};
use crate::report::Finding;
use crate::validate::{self, NameScope};
use crate::{Scene, SceneError, animate};
use serde_json::Value;
use std::sync::Arc;

/// Scene sections that are lists of items.
pub(crate) const LISTS: [&str; 2] = ["objects", "lights"];
/// Scene sections that are maps of items.
pub(crate) const MAPS: [&str; 3] = ["cameras", "textures", "materials"];
/// Scene sections that are single items.
pub(crate) const SINGLE: [&str; 4] = ["render", "tone", "camera", "background"];

impl Scene {
    /// Returns the scene with `value` stored at a JSON pointer such as
    /// `/materials/red/phong/diffuse`. `null` removes the value. The value may be an expression or
    /// a value form. Missing objects on the way are created.
    pub fn with_value(&self, pointer: &str, value: Value) -> Result<Self, SceneError> {
        let mut scene = self.clone();
        scene.description = self.edits_merged().into_owned();
        let found = scene.set(pointer, value);
        match found {
            Ok(()) => Ok(scene),
            Err(findings) => Err(SceneError::Problems(self.report(findings))),
        }
    }

    fn set(&mut self, pointer: &str, value: Value) -> Result<(), Vec<Finding>> {
        let given = Path::from_pointer(pointer);
        let path = self.stored_path(&given, given.steps().len().saturating_sub(1));
        let stored = path.pointer();
        // Messages show what was given.
        let pointer = if path == given { pointer } else { &stored };
        let section = match path.steps().first() {
            Some(Step::Key(section)) => section.clone(),
            _ => String::new(),
        };
        let mut tree = edited_json(&self.description, &section, &path);
        set_at_pointer(&mut tree, pointer, value).map_err(|finding| vec![finding])?;
        let written = tree.get(&section);
        match section.as_str() {
            "variables" | "paths" => {
                let target =
                    if section == "paths" { &mut self.description.paths } else { &mut self.description.variables };
                *target = SourceSection::new(written);
                return self.resolve_again();
            }
            _ if has_items(&section) => {}
            _ => return self.set_plain(&section, &tree),
        }
        let removes = self.description.remove(&path, &section, written);
        let Some(written) = written else { return self.check_names(removes) };
        let items = edited_sources(written, &path, &section);
        let head = motion::head(&self.description);
        let (texts, asset_cache) = (self.sources().clone(), self.asset_cache.clone());
        let sources = SceneSources { texts: &texts, asset_cache: &asset_cache };
        let (stored, findings) = motion::replace_items(&mut self.description, &head, sources, self.frame, &items);
        if stored { self.check_names(removes) } else { Err(findings) }
    }

    /// Sets a section that is neither an item nor a list of items.
    fn set_plain(&mut self, section: &str, tree: &Node) -> Result<(), Vec<Finding>> {
        let mut findings = Vec::new();
        let found = deserialize_scene(tree, &mut findings);
        let Some((found, _)) = found.filter(|_| !findings.iter().any(Finding::is_error)) else { return Err(findings) };
        let own = &mut self.description;
        match section {
            "version" => own.version = found.version,
            "title" => own.title = found.title,
            "description" => own.description = found.description,
            "animation" => own.animation = found.animation,
            "background_light_group" => own.background_light_group = found.background_light_group,
            _ => {}
        }
        if section == "animation" { self.resolve_again() } else { Ok(()) }
    }

    /// Evaluates all templates again, after a change of variables, paths or animation settings.
    fn resolve_again(&mut self) -> Result<(), Vec<Finding>> {
        self.check_paths()?;
        let items = self.description.templates(|_| true);
        let head = motion::head(&self.description);
        let (parts, findings) = motion::read_items(&self.description, &head, self.scene_sources(), self.frame, &items);
        parts.ok_or(findings)?.into_iter().for_each(|(path, part)| self.description.put(&path, part));
        self.description.update_time_dependence(&head);
        Ok(())
    }

    fn check_paths(&self) -> Result<(), Vec<Finding>> {
        let head = motion::head(&self.description);
        let (resolved, mut findings) =
            animate::resolve_with(&head, self.scene_sources(), &self.description.programs, self.frame);
        let at = PathRef::Root.key("paths");
        let paths = resolved.get("paths");
        findings.extend(paths.into_iter().flat_map(|paths| {
            validate::item(paths, &Path::from(&at), &at, NameScope::Scene(&self.description), 0).findings
        }));
        if findings.iter().any(Finding::is_error) { Err(findings) } else { Ok(()) }
    }

    /// Checks that no item refers to a removed name.
    fn check_names(&self, removes: bool) -> Result<(), Vec<Finding>> {
        let findings = if removes { self.description.item_findings(|_| true) } else { Vec::new() };
        if findings.iter().any(Finding::is_error) { Err(findings) } else { Ok(()) }
    }
}

fn has_items(section: &str) -> bool {
    LISTS.contains(&section) || MAPS.contains(&section) || SINGLE.contains(&section) || section == "groups"
}

/// JSON of the part of a scene that an edit at `path` can reach; other list elements are null.
pub(crate) fn edited_json(scene: &Description, section: &str, path: &Path) -> Node {
    let steps = path.steps().get(1..).unwrap_or_default();
    let at = |steps: &[Step]| match steps.first() {
        Some(Step::Index(i)) => Some(*i),
        _ => None,
    };
    let name = match steps.first() {
        Some(Step::Key(name)) => name.as_str(),
        _ => "",
    };
    let item = |path: &Path| scene.innermost_item(path).map(|(item, _)| motion::node(item));
    let form = scene.list_forms.iter().find(|form| path.steps().starts_with(form.path.steps()));
    let content = match section {
        _ if form.is_some_and(|form| form.path.steps().len() == 1) => form.map(|form| form.template.node.clone()),
        "objects" => Some(list(scene.objects.iter().map(motion::object_node), scene.objects.len(), at(steps))),
        "lights" => Some(list(scene.lights.iter().map(|light| motion::node(light)), scene.lights.len(), at(steps))),
        "groups" => {
            let rest = steps.get(1..).unwrap_or_default();
            let objects = scene.groups.get(name).map(|objects| match form {
                Some(form) => form.template.node.clone(),
                None => list(objects.iter().map(motion::object_node), objects.len(), at(rest)),
            });
            Some(map(name, objects))
        }
        _ if MAPS.contains(&section) => Some(map(name, item(&Path::root().key(section).key(name)))),
        _ if SINGLE.contains(&section) => item(&Path::root().key(section)),
        "variables" => scene.variables.node().cloned(),
        "paths" => scene.paths.node().cloned(),
        "animation" => Some(serde_json::to_value(scene.animation).unwrap_or_default().into()),
        _ => None,
    };
    let version = Some(Node::from(Value::from(scene.version)));
    object([("version", version.filter(|_| section != "version")), (section, content)])
}

fn object<'k>(members: impl IntoIterator<Item = (&'k str, Option<Node>)>) -> Node {
    let member = |(key, node): (&str, Option<Node>)| Some((key.to_owned(), Member { key_place: None, node: node? }));
    let members: Members = members.into_iter().filter_map(member).collect();
    Node { place: None, value: Json::Object(Arc::new(members)) }
}

fn map(name: &str, node: Option<Node>) -> Node {
    object([(name, node)])
}

/// JSON of a list in which only the element `at` is not null; all elements for `None`.
fn list(mut nodes: impl Iterator<Item = Node>, count: usize, at: Option<usize>) -> Node {
    let null = || Node { place: None, value: Json::Null };
    let elements = match at {
        None => nodes.collect(),
        Some(at) => {
            let mut elements: Vec<Node> = (0..count).map(|_| null()).collect();
            if let (Some(element), Some(node)) = (elements.get_mut(at), nodes.nth(at)) {
                *element = node;
            }
            elements
        }
    };
    Node { place: None, value: Json::Array(Arc::new(elements)) }
}

/// Sources of the items that an edit at `path` has changed.
fn edited_sources(section: &Node, path: &Path, key: &str) -> Vec<ItemSource> {
    let root = Path::root().key(key);
    let mut items = Vec::new();
    let mut want = |path: Path, node: &Node| items.push(ItemSource::unread(path, node.clone()));
    let is_list = |node: &Node| matches!(node.value, Json::Array(_));
    let mut each = |root: &Path, list: &Node, step: Option<&Step>| match step {
        _ if !is_list(list) => want(root.clone(), list),
        Some(Step::Index(i)) => {
            // Skip null: elements beside the edited one, or the element that the edit removes.
            let element = list.elements().get(*i).filter(|node| !matches!(node.value, Json::Null));
            element.into_iter().for_each(|node| want(root.index(*i), node));
        }
        _ => list.elements().iter().enumerate().for_each(|(i, node)| want(root.index(i), node)),
    };
    let steps = path.steps();
    match key {
        _ if LISTS.contains(&key) => each(&root, section, steps.get(1)),
        "groups" => section.members().for_each(|(name, member)| each(&root.key(name), &member.node, steps.get(2))),
        _ if MAPS.contains(&key) => section.members().for_each(|(name, member)| want(root.key(name), &member.node)),
        _ => want(root, section),
    }
    items
}

impl Description {
    /// Removes the values that an edit at `path` removes or replaces; `written` is the edited
    /// section. Returns whether names were removed.
    fn remove(&mut self, path: &Path, section: &str, written: Option<&Node>) -> bool {
        let steps = path.steps();
        self.list_forms.retain(|form| !path.steps().starts_with(form.path.steps()));
        let whole = steps.len() == 1;
        let name = if let Some(Step::Key(name)) = steps.get(1) { name.as_str() } else { "" };
        let is_gone = written.is_none_or(|section| section.get(name).is_none());
        let count = written.map_or(0, |section| section.elements().len());
        let at = |step: Option<&Step>| if let Some(Step::Index(i)) = step { Some(*i) } else { None };
        match section {
            "camera" if written.is_none() => self.camera = None,
            "background" if written.is_none() => self.background = None,
            "render" if written.is_none() => self.render = Default::default(),
            "tone" if written.is_none() => self.tone = Default::default(),
            "cameras" if whole || is_gone => remove_named(&mut self.cameras, (!whole).then_some(name)),
            "textures" if whole || is_gone => remove_named(&mut self.textures, (!whole).then_some(name)),
            "materials" if whole || is_gone => remove_named(&mut self.materials, (!whole).then_some(name)),
            "objects" => shorten(&mut self.objects, at(steps.get(1)), whole, count),
            "lights" => shorten(&mut self.lights, at(steps.get(1)), whole, count),
            "groups" if whole => self.groups.clear(),
            "groups" if is_gone => drop(self.groups.shift_remove(name)),
            "groups" => {
                let objects = self.groups.entry(name.to_owned()).or_default();
                let count = written.and_then(|section| section.get(name)).map_or(0, |list| list.elements().len());
                shorten(objects, at(steps.get(2)), steps.len() == 2, count);
            }
            _ => {}
        }
        let is_map = section == "groups" || MAPS.contains(&section);
        is_map && (whole || is_gone)
    }
}

/// Removes the item with a name, or all items.
fn remove_named<T: Clone>(map: &mut Named<T>, name: Option<&str>) {
    match name {
        None => map.clear(),
        Some(name) => drop(map.shift_remove(name)),
    }
}

/// Removes the element at a position if the edited list has become shorter, or all elements.
fn shorten<T: Clone>(list: &mut crate::Shared<Vec<T>>, at: Option<usize>, whole: bool, count: usize) {
    match at {
        _ if whole => list.clear(),
        Some(at) if count < list.len() && at < list.len() => drop(list.remove(at)),
        _ => {}
    }
}
