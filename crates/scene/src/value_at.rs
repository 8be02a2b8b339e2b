//! Values of a scene by path.

use crate::Scene;
use crate::document::{Node, Value as Json};
use crate::edit::{LISTS, MAPS, SINGLE, edited_json};
use crate::path::{Path, Step};
use crate::suggest::did_you_mean_or_list;
use serde_json::Value;

/// Sections of a scene that are neither lists, nor maps, nor single items.
const OTHERS: [&str; 8] =
    ["version", "title", "description", "variables", "paths", "animation", "groups", "background_light_group"];

/// A path that leads to no value of the scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.message())]
pub struct UnknownPath {
    /// Longest part of the path that leads to a value.
    pub parent: Path,
    /// Step that this value does not have.
    pub step: Step,
    /// Whether `step` is the last step of the path.
    pub is_last: bool,
    /// Keys of the value at `parent`; empty for an array.
    pub known: Vec<String>,
    /// Number of elements of the value at `parent`, if it is an array.
    pub count: Option<usize>,
}

impl UnknownPath {
    fn message(&self) -> String {
        let parent = if self.parent == Path::root() { "the scene".to_owned() } else { format!("`{}`", self.parent) };
        match (&self.step, self.count) {
            (Step::Index(index), Some(count)) => format!("{parent} has no element {index}: it has {count}"),
            (Step::Key(key), Some(count)) => format!("{parent} has no element `{key}`: it is an array of {count}"),
            (Step::Index(index), None) => format!("{parent} is no array, so it has no element {index}"),
            (Step::Key(key), None) => {
                let help = did_you_mean_or_list(key, self.known.iter().map(String::as_str));
                let help = help.map(|help| format!("; {help}")).unwrap_or_default();
                format!("{parent} has no `{key}`{help}")
            }
        }
    }
}

impl Scene {
    /// The value at a path, as the scene file would have it: with expressions and value forms. A
    /// value that the scene leaves to its default counts as unknown.
    ///
    /// ```
    /// use juggler_scene::{Object, Scene, path::Path};
    /// use juggler_shape::Sphere;
    ///
    /// let scene = Scene::new().add(Object::new(Sphere::default()).named("ball"));
    /// let path = Path::root().key("objects").index(0).key("name");
    /// assert_eq!(scene.value_at(&path).unwrap(), "ball");
    /// let unknown = scene.value_at(&Path::root().key("object")).unwrap_err();
    /// assert_eq!(unknown.to_string(), "the scene has no `object`; did you mean `objects`?");
    /// ```
    pub fn value_at(&self, path: &Path) -> Result<Value, UnknownPath> {
        self.stored_value_at(&self.stored_path(path, path.steps().len()))
    }

    /// The value at a path, where a texture that was written inline is its name.
    fn stored_value_at(&self, path: &Path) -> Result<Value, UnknownPath> {
        let Some(Step::Key(section)) = path.steps().first() else {
            return match path.steps().first() {
                None => Ok(self.to_value()),
                Some(step) => Err(self.unknown(&Node::from(Value::Null), &Path::root(), step, path)),
            };
        };
        let tree = match section.as_str() {
            "version" | "title" | "description" | "background_light_group" => Node::from(self.to_value()),
            _ if path.steps().len() == 1 => Node::from(self.to_value()),
            _ => edited_json(&self.edits_merged(), section, path),
        };
        let (mut node, mut at) = (&tree, Path::root());
        for step in path.steps() {
            let next = match step {
                Step::Key(key) => node.get(key),
                Step::Index(index) => node.elements().get(*index),
            };
            match next {
                Some(next) => node = next,
                None => return Err(self.unknown(node, &at, step, path)),
            }
            at.push(step.clone());
        }
        Ok(node.to_json())
    }

    /// Path of the value to which `path` leads through a texture that was written inline: such a
    /// texture is one of the section `textures`, named by its pointer. Only the first `most` steps of
    /// `path` may be that pointer.
    pub(crate) fn stored_path(&self, path: &Path, most: usize) -> Path {
        let steps = path.steps();
        for length in (1..=most.min(steps.len())).rev() {
            let (place, rest) = steps.split_at(length);
            let place = place.iter().fold(Path::root(), with_step);
            let pointer = place.pointer();
            // A value that replaced the texture hides it.
            let stored = || self.stored_value_at(&self.stored_path(&place, length - 1));
            let is_texture = || stored().is_ok_and(|value| value == pointer.as_str());
            if self.description.textures.contains_key(&pointer) && is_texture() {
                return rest.iter().fold(Path::root().key("textures").key(pointer), with_step);
            }
        }
        path.clone()
    }

    /// Describes that `node`, which is at `at`, has no such step.
    fn unknown(&self, node: &Node, at: &Path, step: &Step, path: &Path) -> UnknownPath {
        let is_last = at.steps().len() + 1 == path.steps().len();
        let count = if let Json::Array(elements) = &node.value { Some(elements.len()) } else { None };
        let known = match at.steps() {
            [] => LISTS.iter().chain(&MAPS).chain(&SINGLE).chain(&OTHERS).map(|name| (*name).to_owned()).collect(),
            [Step::Key(section)] => self.names_in(section, node),
            _ => keys(node),
        };
        UnknownPath { parent: at.clone(), step: step.clone(), is_last, known, count }
    }

    /// Names in a section, of which `node` may hold only one.
    fn names_in(&self, section: &str, node: &Node) -> Vec<String> {
        let own = &self.description;
        match section {
            "cameras" => own.cameras.keys().cloned().collect(),
            "textures" => own.textures.keys().cloned().collect(),
            "materials" => own.materials.keys().cloned().collect(),
            "groups" => own.groups.keys().cloned().collect(),
            _ => keys(node),
        }
    }
}

fn with_step(mut path: Path, step: &Step) -> Path {
    path.push(step.clone());
    path
}

fn keys(node: &Node) -> Vec<String> {
    node.members().map(|(key, _)| key.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const SCENE: &str = r##"{"version": 1, "title": "two", "render": {"size": [8, 8]},
        "materials": {"red": {"diffuse": {"reflectance": "#f00"}}, "blue": {"diffuse": {"reflectance": "#00f"}}},
        "objects": [{"shape": "sphere", "material": "red"}, {"shape": "sphere"}]}"##;

    fn value(path: &str) -> Result<Value, UnknownPath> {
        Scene::from_json(SCENE, "scene.json").unwrap().value_at(&Path::parse(path).unwrap())
    }

    #[test]
    fn values_are_found_by_path_and_by_pointer() {
        assert_eq!(value("materials.red.diffuse.reflectance").unwrap(), json!([1.0, 0.0, 0.0]));
        assert_eq!(value("/objects/1/shape/sphere/radius").unwrap(), json!(1.0));
        assert_eq!((value("title").unwrap(), value("render.size[1]").unwrap()), (json!("two"), json!(8)));
        assert_eq!(value("objects").unwrap().as_array().map(Vec::len), Some(2));
    }

    #[test]
    fn paths_lead_through_textures_that_are_written_inline() {
        let text = r##"{"version": 1, "objects": [{"shape": "sphere", "material": {"diffuse": {"reflectance":
            {"checker": {"size": 2, "even": {"checker": {"size": 3}}}}}}}]}"##;
        let scene = Scene::from_json(text, "scene.json").unwrap();
        let value = |scene: &Scene, path: &str| scene.value_at(&Path::parse(path).unwrap()).unwrap();
        let reflectance = "objects[0].material.diffuse.reflectance";
        assert_eq!(value(&scene, &format!("{reflectance}.checker.size")), json!(2.0));
        assert_eq!(value(&scene, &format!("{reflectance}.checker.even.checker.size")), json!(3.0));
        assert_eq!(value(&scene, reflectance)["checker"]["size"], json!(2.0));
        let pointer = "/objects/0/material/diffuse/reflectance";
        let edited = scene.with_value(&format!("{pointer}/checker/even/checker/size"), json!(5)).unwrap();
        assert_eq!(value(&edited, &format!("{reflectance}.checker.even.checker.size")), json!(5.0));
        let plain = edited.with_value(pointer, json!("#fff")).unwrap();
        assert_eq!(value(&plain, "objects[0].material.diffuse.reflectance"), json!([1.0, 1.0, 1.0]));
    }

    #[test]
    fn unknown_paths_name_the_nearest_step() {
        let message = |path: &str| value(path).unwrap_err().to_string();
        assert_eq!(message("material.red"), "the scene has no `material`; did you mean `materials`?");
        assert_eq!(message("materials.rde.diffuse"), "`materials` has no `rde`; did you mean `red`?");
        assert_eq!(message("objects[2]"), "`objects` has no element 2: it has 2");
        assert_eq!(message("objects.first"), "`objects` has no element `first`: it is an array of 2");
        assert_eq!(message("render.sizes"), "`render` has no `sizes`; did you mean `size`?");
        let absent = value("objects[1].material").unwrap_err();
        assert!(absent.is_last && !value("objects[1].material.phong").unwrap_err().is_last);
    }
}
