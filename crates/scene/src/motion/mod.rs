//! Animation of a scene's items. An animated item has a template: its JSON with unevaluated
//! expressions and value forms. For another frame, only items with time-dependent templates are
//! read again; all other items are shared between frames.
//!
//! 1. [`attach`] attaches templates and source locations after a document was read; [`lists`] reads
//!    long lists.
//! 2. [`merge_edits`] merges edits by programs into templates.
//! 3. [`item_reader`] evaluates templates at a frame and returns [`item_value`]s. [`setters`]
//!    replace reading for numbers of transforms.
//! 4. [`tracks`] samples animated items at even times while the shutter is open.
//! 5. [`write`](mod@write) writes a scene with its animation as JSON.

mod attach;
mod item_reader;
mod item_value;
mod lists;
mod merge_edits;
mod setters;
mod tracks;
mod write;

pub(crate) use attach::attach;
use attach::attach_items;
use item_reader::ItemValues;
pub(crate) use item_reader::{ItemSource, read_items, replace_items};
pub(crate) use item_value::ItemValue;
pub(crate) use lists::read_list;
pub(crate) use merge_edits::{animated_values, edits_merged};
pub(crate) use setters::TransformSetters;
pub use tracks::{ListTracks, ObjectTrack, Tracks};
pub(crate) use write::{head, node, object_node, written};

use crate::Object;
use crate::description::{BackgroundInput, Description, Instances, Objects, Render};
use crate::document::{Node, SourceSpan};
use crate::item::{Item, Template};
use crate::path::{Path, PathRef, Step};
use crate::shared::Shared;
use juggler_camera::AnyCamera;
use juggler_imaging::Tone;
use juggler_light::AnyLight;
use juggler_material::AnyMaterial;
use juggler_texture::AnyTexture;
use serde::Serialize;
use std::sync::Arc;

/// Value form in place of a whole list of objects or lights, or of a light group's name.
#[derive(Clone, Debug)]
pub(crate) struct ListForm {
    /// Path of the form: `objects`, `lights`, `groups.NAME` or `background_light_group`.
    pub path: Path,
    /// JSON of the form.
    pub template: Arc<Template>,
    /// Value of the form at the scene's frame. If the scene holds another value, a program has
    /// replaced it, and the replacement stays.
    pub given: FormValue,
}

/// Value of a list form.
#[derive(Clone, Debug)]
pub(crate) enum FormValue {
    /// Objects.
    Objects(Objects),
    /// Lights.
    Lights(Shared<Vec<Item<AnyLight>>>),
    /// The name of a group of lights.
    LightGroup(String),
}

impl PartialEq for ListForm {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path && self.template.node.to_json() == other.template.node.to_json()
    }
}

/// Common interface of items of all kinds.
pub(crate) trait AnyItem {
    /// As [`Item::template`].
    fn template(&self) -> Option<&Arc<Template>>;
    /// As [`Item::place`].
    fn place(&self) -> Option<SourceSpan>;
    /// As [`Item::is_changed`].
    fn is_changed(&self) -> bool;
    /// As [`Item::has_passed`].
    fn has_passed(&self, names: u64) -> bool;
    /// As [`Item::set_passed`].
    fn set_passed(&self, names: u64);
    /// JSON of the value.
    fn json(&self) -> serde_json::Value;
    /// JSON of the value without the arrays of meshes and instances, for validation; arrays are checked
    /// when an object is prepared.
    fn json_without_arrays(&self) -> serde_json::Value;
    /// As [`Item::set_source`].
    fn set_source(&mut self, place: Option<SourceSpan>, template: Option<Arc<Template>>);
    /// As [`Item::set_template`].
    fn set_template(&mut self, template: Option<Arc<Template>>);
}

/// Value types of items.
pub(crate) trait ItemContent: Serialize + Clone {
    /// As [`AnyItem::json_without_arrays`].
    fn json_without_arrays(&self) -> serde_json::Value {
        serde_json::to_value(self).unwrap_or_default()
    }
}

impl ItemContent for Render {}
impl ItemContent for Tone {}
impl ItemContent for BackgroundInput {}
impl ItemContent for AnyCamera {}
impl ItemContent for AnyTexture {}
impl ItemContent for AnyMaterial {}
impl ItemContent for AnyLight {}

impl ItemContent for Object {
    fn json_without_arrays(&self) -> serde_json::Value {
        let mut json_without_arrays = self.clone();
        if let Some(mesh) = json_without_arrays.shape.as_mut().and_then(|shape| shape.mesh_mut()) {
            mesh.clear_arrays();
        }
        if let Some(instances) = &mut json_without_arrays.instances {
            **instances = Instances { file: instances.file.take(), ..Instances::default() };
        }
        // Child objects are validated by themselves.
        json_without_arrays.objects = json_without_arrays.objects.map(|_| Objects::default());
        serde_json::to_value(json_without_arrays).unwrap_or_default()
    }
}

impl<T: ItemContent> AnyItem for Item<T> {
    fn template(&self) -> Option<&Arc<Template>> {
        self.template()
    }

    fn place(&self) -> Option<SourceSpan> {
        self.place()
    }

    fn is_changed(&self) -> bool {
        self.is_changed()
    }

    fn has_passed(&self, names: u64) -> bool {
        self.has_passed(names)
    }

    fn set_passed(&self, names: u64) {
        self.set_passed(names);
    }

    fn json(&self) -> serde_json::Value {
        serde_json::to_value(&**self).unwrap_or_default()
    }

    fn json_without_arrays(&self) -> serde_json::Value {
        ItemContent::json_without_arrays(&**self)
    }

    fn set_source(&mut self, place: Option<SourceSpan>, template: Option<Arc<Template>>) {
        self.set_source(place, template);
    }

    fn set_template(&mut self, template: Option<Arc<Template>>) {
        self.set_template(template);
    }
}

impl Description {
    /// Visits every item with its path, child objects before their parents.
    pub(crate) fn each_item(&self, visit: &mut dyn FnMut(&PathRef<'_>, &dyn AnyItem)) {
        let root = PathRef::Root;
        visit(&root.key("render"), &self.render);
        visit(&root.key("tone"), &self.tone);
        self.camera.iter().for_each(|camera| visit(&root.key("camera"), camera));
        self.background.iter().for_each(|background| visit(&root.key("background"), background));
        let at = root.key("cameras");
        self.cameras.iter().for_each(|(name, camera)| visit(&at.key(name), camera));
        let at = root.key("textures");
        self.textures.iter().for_each(|(name, texture)| visit(&at.key(name), texture));
        let at = root.key("materials");
        self.materials.iter().for_each(|(name, material)| visit(&at.key(name), material));
        let at = root.key("groups");
        self.groups.iter().for_each(|(name, objects)| each_object(objects, &at.key(name), visit));
        let at = root.key("lights");
        self.lights.iter().enumerate().for_each(|(i, light)| visit(&at.index(i), light));
        each_object(&self.objects, &root.key("objects"), visit);
    }

    /// Innermost item on a path, and the number of steps from the root to the item.
    pub(crate) fn innermost_item(&self, path: &Path) -> Option<(&dyn AnyItem, usize)> {
        fn any<T: ItemContent>(item: &Item<T>) -> &dyn AnyItem {
            item
        }
        let (Step::Key(section), rest) = path.steps().split_first()? else { return None };
        match (section.as_str(), rest) {
            ("render", _) => Some((&self.render, 1)),
            ("tone", _) => Some((&self.tone, 1)),
            ("camera", _) => Some((any(self.camera.as_ref()?), 1)),
            ("background", _) => Some((any(self.background.as_ref()?), 1)),
            ("cameras", [Step::Key(name), ..]) => Some((any(self.cameras.get(name)?), 2)),
            ("textures", [Step::Key(name), ..]) => Some((any(self.textures.get(name)?), 2)),
            ("materials", [Step::Key(name), ..]) => Some((any(self.materials.get(name)?), 2)),
            ("lights", [Step::Index(i), ..]) => Some((any(self.lights.get(*i)?), 2)),
            ("objects", rest) => object_of(&self.objects, rest, 1).map(|(object, depth)| (any(object), depth)),
            ("groups", [Step::Key(name), rest @ ..]) => {
                object_of(self.groups.get(name)?, rest, 2).map(|(object, depth)| (any(object), depth))
            }
            _ => None,
        }
    }

    /// Item at a path, for changes of its template or source location.
    pub(crate) fn item_mut(&mut self, path: &Path) -> Option<&mut dyn AnyItem> {
        fn any<T: ItemContent>(item: Option<&mut Item<T>>) -> Option<&mut dyn AnyItem> {
            Some(item?)
        }
        let (Step::Key(section), rest) = path.steps().split_first()? else { return None };
        match (section.as_str(), rest) {
            ("render", []) => Some(&mut self.render),
            ("tone", []) => Some(&mut self.tone),
            ("camera", []) => any(self.camera.as_mut()),
            ("background", []) => any(self.background.as_mut()),
            ("cameras", [Step::Key(name)]) => any(self.cameras.get_mut(name)),
            ("textures", [Step::Key(name)]) => any(self.textures.get_mut(name)),
            ("materials", [Step::Key(name)]) => any(self.materials.get_mut(name)),
            ("lights", [Step::Index(i)]) => any(self.lights.get_mut(*i)),
            _ => {
                let (objects, i) = self.list_mut(path)?;
                any(objects.get_mut(i))
            }
        }
    }

    /// List that contains the object at a path, and the object's index.
    pub(crate) fn list_mut(&mut self, path: &Path) -> Option<(&mut Objects, usize)> {
        match path.steps() {
            [Step::Key(section), rest @ ..] if section == "objects" => list_among(&mut self.objects, rest),
            [Step::Key(section), Step::Key(name), rest @ ..] if section == "groups" => {
                list_among(self.groups.get_mut(name)?, rest)
            }
            _ => None,
        }
    }

    /// Object at a path.
    pub(crate) fn object_at(&self, path: &Path) -> Option<&Item<Object>> {
        let (object, depth) = match path.steps() {
            [Step::Key(section), rest @ ..] if section == "objects" => object_of(&self.objects, rest, 1),
            [Step::Key(section), Step::Key(name), rest @ ..] if section == "groups" => {
                object_of(self.groups.get(name)?, rest, 2)
            }
            _ => None,
        }?;
        (depth == path.steps().len()).then_some(object)
    }

    /// Whether both scenes share all animated items (by pointer) and have the same shutter times.
    pub(crate) fn has_same_motion(&self, other: &Self) -> bool {
        fn same<T>(a: Option<&Item<T>>, b: Option<&Item<T>>) -> bool {
            match (a, b) {
                (Some(a), Some(b)) => a.is_same(b),
                (None, None) => true,
                _ => false,
            }
        }
        self.render.shutter == other.render.shutter
            && same(self.camera.as_ref(), other.camera.as_ref())
            && self.cameras.is_same(&other.cameras)
            && self.textures.is_same(&other.textures)
            && self.materials.is_same(&other.materials)
            && self.groups.is_same(&other.groups)
            && self.lights.is_same(&other.lights)
            && self.objects.is_same(&other.objects)
            && self.list_forms.is_same(&other.list_forms)
            && self.variables.is_same(&other.variables)
            && self.paths.is_same(&other.paths)
            && self.animation == other.animation
    }
}

fn each_object(objects: &[Item<Object>], at: &PathRef<'_>, visit: &mut dyn FnMut(&PathRef<'_>, &dyn AnyItem)) {
    for (i, object) in objects.iter().enumerate() {
        let at = at.index(i);
        if let Some(inner) = &object.objects {
            each_object(inner, &at.key("objects"), visit);
        }
        visit(&at, object);
    }
}

fn list_among<'s>(objects: &'s mut Objects, steps: &[Step]) -> Option<(&'s mut Objects, usize)> {
    match steps {
        [Step::Index(i)] => Some((objects, *i)),
        [Step::Index(i), Step::Key(_), rest @ ..] => {
            list_among(objects.get_mut(*i)?.value_mut_unmarked().objects.as_mut()?, rest)
        }
        _ => None,
    }
}

/// Innermost object on a path that begins in a list, and the number of steps from the root to the
/// object; `depth` steps lead to the list.
fn object_of<'s>(objects: &'s [Item<Object>], steps: &[Step], depth: usize) -> Option<(&'s Item<Object>, usize)> {
    let [Step::Index(i), rest @ ..] = steps else { return None };
    let object = objects.get(*i)?;
    let inner = match rest {
        [Step::Key(key), rest @ ..] if key == "objects" => {
            object.objects.as_ref().and_then(|objects| object_of(objects, rest, depth + 2))
        }
        _ => None,
    };
    Some(inner.unwrap_or((object, depth + 1)))
}

/// Calls `visit` with the borrowed path of `steps`.
pub(crate) fn with_path_ref<R>(steps: &[Step], at: &PathRef<'_>, visit: &mut dyn FnMut(&PathRef<'_>) -> R) -> R {
    match steps.split_first() {
        None => visit(at),
        Some((Step::Key(key), rest)) => with_path_ref(rest, &at.key(key), visit),
        Some((Step::Index(i), rest)) => with_path_ref(rest, &at.index(*i), visit),
    }
}

/// Node at a relative path; `None` if the path leads through a value form.
pub(crate) fn node_at<'n>(node: &'n Node, steps: &[Step]) -> Option<&'n Node> {
    use crate::document::Value;
    let Some((step, rest)) = steps.split_first() else { return Some(node) };
    let next = match (&node.value, step) {
        (Value::Object(members), _) if crate::animate::is_form(members) => None,
        (Value::Object(members), Step::Key(key)) => members.get(key).map(|member| &member.node),
        // A single element may replace an array of one element.
        (Value::Object(_), Step::Index(0)) => return node_at(node, rest),
        (Value::Array(elements), Step::Index(i)) => elements.get(*i),
        _ => None,
    };
    node_at(next?, rest)
}
