//! Attaches source locations and templates to the items of a scene that was read from text.

use super::{AnyItem, FormValue, ItemContent, ItemSource, ListForm, node_at, with_path_ref};
use crate::animate::{Programs, TimeDependence, has_expressions};
use crate::description::{Description, Named, Objects, SourceSection};
use crate::document::{Node, Value};
use crate::item::{Item, Template};
use crate::path::{Path, PathRef, Step};
use crate::{Object, animate};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;
use std::sync::Arc;

/// Attaches source locations and templates to all items of a scene. `tree` is the document with
/// unevaluated expressions; `inline_names` lists the names of inline textures.
pub(crate) fn attach(scene: &mut Description, tree: &Node, inline_names: &[String]) {
    scene.variables = SourceSection::new(tree.get("variables"));
    scene.paths = SourceSection::new(tree.get("paths"));
    let programs = scene.programs.clone();
    Attacher::new(tree, inline_names, &programs).scene(scene, tree);
}

/// Attaches source locations and templates to the given items only. `head` holds the scene's
/// variables and paths; `inline_names` lists the names of inline textures of these items.
pub(crate) fn attach_items(scene: &mut Description, head: &Node, items: &[ItemSource], inline_names: &[String]) {
    let programs = scene.programs.clone();
    let mut attacher = Attacher::new(head, inline_names, &programs);
    for ItemSource { path, template, .. } in items {
        with_path_ref(path.steps(), &PathRef::Root, &mut |at| attacher.at(scene, path, &template.node, at));
    }
    for name in inline_names {
        let path = Path::from_pointer(name);
        let outer = items.iter().find(|source| path.steps().starts_with(source.path.steps()));
        let rest = outer.and_then(|outer| path.steps().get(outer.path.steps().len()..));
        let inner = outer.zip(rest).and_then(|(outer, rest)| node_at(&outer.template.node, rest)).cloned();
        let node = attacher.moved_textures.get(name.as_str()).cloned().or(inner);
        if let (Some(node), Some(texture)) = (node, scene.textures.get_mut(name)) {
            scene.form_textures.remove(name);
            attacher.item(texture, Some(&node), &PathRef::Root.key("textures").key(name));
        }
    }
}

struct Attacher<'t> {
    time_dependence: TimeDependence<'t>,
    /// Names of inline textures.
    names: BTreeSet<&'t str>,
    /// Inline textures that were moved out of templates; the templates refer to them by name.
    moved_textures: BTreeMap<&'t str, Node>,
    programs: &'t Programs,
}

impl<'t> Attacher<'t> {
    fn new(head: &'t Node, inline_names: &'t [String], programs: &'t Programs) -> Self {
        let names = inline_names.iter().map(String::as_str).collect();
        Self {
            time_dependence: TimeDependence::from_tree(head, programs),
            names,
            moved_textures: BTreeMap::new(),
            programs,
        }
    }
}

impl Attacher<'_> {
    fn scene(&mut self, scene: &mut Description, tree: &Node) {
        let root = PathRef::Root;
        let part = |key: &str| tree.get(key);
        self.item(&mut scene.render, part("render"), &root.key("render"));
        self.item(&mut scene.tone, part("tone"), &root.key("tone"));
        if let Some(camera) = &mut scene.camera {
            self.item(camera, part("camera"), &root.key("camera"));
        }
        if let Some(background) = &mut scene.background {
            self.item(background, part("background"), &root.key("background"));
        }
        self.named(&mut scene.cameras, part("cameras"), &root.key("cameras"));
        self.named(&mut scene.materials, part("materials"), &root.key("materials"));
        let at = root.key("groups");
        for (name, objects) in scene.groups.iter_mut() {
            self.objects(objects, part("groups").and_then(|groups| groups.get(name)), &at.key(name));
        }
        let lights = part("lights").map(Node::elements).unwrap_or_default();
        let at = root.key("lights");
        for (i, light) in scene.lights.iter_mut().enumerate() {
            self.item(light, lights.get(i), &at.index(i));
        }
        self.objects(&mut scene.objects, part("objects"), &root.key("objects"));
        self.textures(scene, tree);
        self.list_forms(scene, tree);
    }

    fn item(&mut self, item: &mut dyn AnyItem, node: Option<&Node>, at: &PathRef<'_>) {
        let template = node.and_then(|node| self.template(node, at));
        item.set_source(node.and_then(|node| node.place), template);
    }

    /// Attaches `node`, the JSON of the item or list at `path`.
    fn at(&mut self, scene: &mut Description, path: &Path, node: &Node, at: &PathRef<'_>) {
        if let Some((objects, i)) = scene.list_mut(path) {
            objects.get_mut(i).into_iter().for_each(|object| self.object(object, Some(node), at));
        } else if let Some(item) = scene.item_mut(path) {
            self.item(item, Some(node), at);
        } else {
            self.list_form(scene, path.clone(), node);
        }
    }

    fn named<T: ItemContent>(&mut self, map: &mut Named<T>, node: Option<&Node>, at: &PathRef<'_>) {
        for (name, item) in map.iter_mut() {
            self.item(item, node.and_then(|node| node.get(name)), &at.key(name));
        }
    }

    fn objects(&mut self, objects: &mut Objects, node: Option<&Node>, at: &PathRef<'_>) {
        let nodes = node.map(Node::elements).unwrap_or_default();
        for (i, object) in objects.iter_mut().enumerate() {
            self.object(object, nodes.get(i), &at.index(i));
        }
    }

    /// Attaches an object. An animated object's template includes its child objects; otherwise each
    /// child may have a template of its own.
    fn object(&mut self, object: &mut Item<Object>, node: Option<&Node>, at: &PathRef<'_>) {
        let own = |node: &Node| match &node.value {
            Value::Object(members) if !animate::is_form(members) => members.iter().any(|(key, member)| {
                let is_list = key == "objects" && matches!(member.node.value, Value::Array(_));
                !is_list && has_expressions(&member.node, self.programs)
            }),
            _ => has_expressions(node, self.programs),
        };
        let moves = node.is_some_and(own);
        if let Some(inner) = &mut object.value_mut_unmarked().objects {
            let node = node.and_then(|node| node.get("objects")).filter(|_| !moves);
            self.objects(inner, node, &at.key("objects"));
        }
        match moves {
            true => self.item(object, node, at),
            false => object.set_source(node.and_then(|node| node.place), None),
        }
    }

    /// Template of an item with this JSON; `None` for JSON without expressions and value forms.
    fn template(&mut self, node: &Node, at: &PathRef<'_>) -> Option<Arc<Template>> {
        if !has_expressions(node, self.programs) {
            return None;
        }
        let mut node = node.clone();
        let own = Path::from(at);
        let pointer = own.pointer() + "/";
        let from = (Bound::Included(pointer.as_str()), Bound::Unbounded);
        let node_at = self.names.range::<str, _>(from).take_while(|name| name.starts_with(&pointer));
        let mut names: Vec<&str> = node_at.copied().collect();
        // Textures within textures come first.
        names.sort_by_key(|name| std::cmp::Reverse(name.len()));
        for name in names {
            let path = Path::from_pointer(name);
            let rest = path.steps().get(own.steps().len()..).unwrap_or_default();
            self.moved_textures.extend(take_texture(&mut node, rest, name).map(|texture| (name, texture)));
        }
        let depends_on_time = self.time_dependence.depends_on_time(&node);
        has_expressions(&node, self.programs).then(|| Arc::new(Template::new(node, depends_on_time, self.programs)))
    }

    /// Attaches textures, which are written in the scene's `textures` or inline.
    fn textures(&mut self, scene: &mut Description, tree: &Node) {
        let at = PathRef::Root.key("textures");
        for (name, texture) in scene.textures.iter_mut() {
            let named = tree.get("textures").and_then(|textures| textures.get(name));
            let moved_textures = self.moved_textures.get(name.as_str()).cloned();
            let inline_names =
                || node_at(tree, Path::from_pointer(name).steps()).filter(|_| name.starts_with('/')).cloned();
            let node = moved_textures.or_else(|| named.cloned()).or_else(inline_names);
            if node.is_none() {
                scene.form_textures.insert(name.clone());
            }
            self.item(texture, node.as_ref(), &at.key(name));
        }
    }

    fn list_forms(&mut self, scene: &mut Description, tree: &Node) {
        let groups = tree.get("groups").into_iter().flat_map(Node::members);
        let groups = groups.map(|(name, member)| (Path::root().key("groups").key(name), &member.node));
        let single = ["objects", "lights", "background_light_group"];
        let single = single.iter().filter_map(|key| Some((Path::root().key(*key), tree.get(key)?)));
        groups.chain(single).for_each(|(path, node)| self.list_form(scene, path, node));
    }

    fn list_form(&mut self, scene: &mut Description, path: Path, node: &Node) {
        if matches!(node.value, Value::Array(_)) || !has_expressions(node, self.programs) {
            return;
        }
        let given = match path.steps() {
            [_, Step::Key(group)] => scene.groups.get(group).cloned().map(FormValue::Objects),
            [Step::Key(key)] if key == "objects" => Some(FormValue::Objects(scene.objects.clone())),
            [Step::Key(key)] if key == "lights" => Some(FormValue::Lights(scene.lights.clone())),
            _ => scene.background_light_group.clone().map(FormValue::LightGroup),
        };
        let template = Template::new(node.clone(), self.time_dependence.depends_on_time(node), self.programs);
        scene.list_forms.extend(given.map(|given| ListForm { path, template: Arc::new(template), given }));
    }
}

/// Replaces the inline texture at a path by its name and returns the texture's JSON; `None` if a
/// value form produces the texture.
fn take_texture(node: &mut Node, steps: &[Step], name: &str) -> Option<Node> {
    let Some((step, rest)) = steps.split_first() else {
        let is_texture = matches!(&node.value, Value::Object(members) if !animate::is_form(members));
        let named = Node { place: node.place, value: Value::String(name.to_owned()) };
        return is_texture.then(|| std::mem::replace(node, named));
    };
    match (&mut node.value, step) {
        (Value::Object(members), _) if animate::is_form(members) => None,
        (Value::Object(members), Step::Key(key)) => {
            take_texture(&mut Arc::make_mut(members).get_mut(key)?.node, rest, name)
        }
        (Value::Array(elements), Step::Index(i)) => take_texture(Arc::make_mut(elements).get_mut(*i)?, rest, name),
        _ => None,
    }
}
