//! Attaches source locations and templates to the items of a scene that was read from text.

use super::{AnyItem, FormValue, ItemContent, ItemSource, ListForm, inside, with_trail};
use crate::animate::{Programs, TimeDependence, has_expressions};
use crate::description::{Description, Named, Objects, Written};
use crate::document::{Node, Value};
use crate::item::{Item, Template};
use crate::path::{Path, Step, Trail};
use crate::{Object, animate};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;
use std::sync::Arc;

/// Attaches source locations and templates to all items of a scene. `tree` is the document with unevaluated
/// expressions; `in_place` lists the names of inline textures.
pub(crate) fn attach(scene: &mut Description, tree: &Node, in_place: &[String]) {
    scene.variables = Written::new(tree.get("variables"));
    scene.paths = Written::new(tree.get("paths"));
    let programs = scene.programs.clone();
    Attaching::new(tree, in_place, &programs).scene(scene, tree);
}

/// Attaches source locations and templates to the given items only. `head` holds the scene's variables and
/// paths; `in_place` lists the names of inline textures of these items.
pub(crate) fn attach_items(scene: &mut Description, head: &Node, wanted: &[ItemSource], in_place: &[String]) {
    let programs = scene.programs.clone();
    let mut attaching = Attaching::new(head, in_place, &programs);
    for ItemSource { path, template, .. } in wanted {
        with_trail(path.steps(), &Trail::Root, &mut |at| attaching.at(scene, path, &template.node, at));
    }
    for name in in_place {
        let path = Path::from_pointer(name);
        let outer = wanted.iter().find(|wanted| path.steps().starts_with(wanted.path.steps()));
        let rest = outer.and_then(|outer| path.steps().get(outer.path.steps().len()..));
        let inside = outer.zip(rest).and_then(|(outer, rest)| inside(&outer.template.node, rest)).cloned();
        let node = attaching.taken.get(name.as_str()).cloned().or(inside);
        if let (Some(node), Some(texture)) = (node, scene.textures.get_mut(name)) {
            scene.form_textures.remove(name);
            attaching.item(texture, Some(&node), &Trail::Root.key("textures").key(name));
        }
    }
}

struct Attaching<'t> {
    changing: TimeDependence<'t>,
    /// Names of inline textures.
    names: BTreeSet<&'t str>,
    /// Inline textures that were moved out of templates; the templates refer to them by name.
    taken: BTreeMap<&'t str, Node>,
    programs: &'t Programs,
}

impl<'t> Attaching<'t> {
    fn new(head: &'t Node, in_place: &'t [String], programs: &'t Programs) -> Self {
        let names = in_place.iter().map(String::as_str).collect();
        Self { changing: TimeDependence::of(head, programs), names, taken: BTreeMap::new(), programs }
    }
}

impl Attaching<'_> {
    fn scene(&mut self, scene: &mut Description, tree: &Node) {
        let root = Trail::Root;
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

    fn item(&mut self, item: &mut dyn AnyItem, node: Option<&Node>, at: &Trail<'_>) {
        let template = node.and_then(|node| self.template(node, at));
        item.set_source(node.and_then(|node| node.place), template);
    }

    /// Attaches `node`, the JSON of the item or list at `path`.
    fn at(&mut self, scene: &mut Description, path: &Path, node: &Node, at: &Trail<'_>) {
        if let Some((objects, i)) = scene.list_mut(path) {
            objects.get_mut(i).into_iter().for_each(|object| self.object(object, Some(node), at));
        } else if let Some(item) = scene.item_mut(path) {
            self.item(item, Some(node), at);
        } else {
            self.list_form(scene, path.clone(), node);
        }
    }

    fn named<T: ItemContent>(&mut self, map: &mut Named<T>, node: Option<&Node>, at: &Trail<'_>) {
        for (name, item) in map.iter_mut() {
            self.item(item, node.and_then(|node| node.get(name)), &at.key(name));
        }
    }

    fn objects(&mut self, objects: &mut Objects, node: Option<&Node>, at: &Trail<'_>) {
        let nodes = node.map(Node::elements).unwrap_or_default();
        for (i, object) in objects.iter_mut().enumerate() {
            self.object(object, nodes.get(i), &at.index(i));
        }
    }

    /// Attaches an object. An animated object's template includes its child objects; otherwise each child may have
    /// a template of its own.
    fn object(&mut self, object: &mut Item<Object>, node: Option<&Node>, at: &Trail<'_>) {
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
    fn template(&mut self, node: &Node, at: &Trail<'_>) -> Option<Arc<Template>> {
        if !has_expressions(node, self.programs) {
            return None;
        }
        let mut node = node.clone();
        let own = Path::from(at);
        let pointer = own.pointer() + "/";
        let from = (Bound::Included(pointer.as_str()), Bound::Unbounded);
        let inside = self.names.range::<str, _>(from).take_while(|name| name.starts_with(&pointer));
        let mut names: Vec<&str> = inside.copied().collect();
        // Textures within textures come first.
        names.sort_by_key(|name| std::cmp::Reverse(name.len()));
        for name in names {
            let path = Path::from_pointer(name);
            let rest = path.steps().get(own.steps().len()..).unwrap_or_default();
            self.taken.extend(take_texture(&mut node, rest, name).map(|texture| (name, texture)));
        }
        let depends_on_time = self.changing.holds(&node);
        has_expressions(&node, self.programs).then(|| Arc::new(Template::new(node, depends_on_time, self.programs)))
    }

    /// Attaches textures, which are written in the scene's `textures` or inline.
    fn textures(&mut self, scene: &mut Description, tree: &Node) {
        let at = Trail::Root.key("textures");
        for (name, texture) in scene.textures.iter_mut() {
            let named = tree.get("textures").and_then(|textures| textures.get(name));
            let taken = self.taken.get(name.as_str()).cloned();
            let in_place = || inside(tree, Path::from_pointer(name).steps()).filter(|_| name.starts_with('/')).cloned();
            let node = taken.or_else(|| named.cloned()).or_else(in_place);
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
            _ => scene.background_light_group.clone().map(FormValue::Label),
        };
        let template = Template::new(node.clone(), self.changing.holds(node), self.programs);
        scene.list_forms.extend(given.map(|given| ListForm { path, template: Arc::new(template), given }));
    }
}

/// Replaces the inline texture at a path by its name and returns the texture's JSON; `None` if a value form
/// produces the texture.
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
