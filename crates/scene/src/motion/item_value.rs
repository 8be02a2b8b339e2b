//! Value of an item of a scene, of any kind, to be stored in the scene or serialized.

use super::FormValue;
use crate::description::{BackgroundInput, Description, Object, Objects, Render};
use crate::item::Item;
use crate::path::{Path, Step};
use crate::shared::Shared;
use juggler_camera::AnyCamera;
use juggler_imaging::Tone;
use juggler_light::AnyLight;
use juggler_material::AnyMaterial;
use juggler_texture::AnyTexture;
use serde_json::Value;

/// Value of an item or of a list of items.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ItemValue {
    Render(Item<Render>),
    Tone(Item<Tone>),
    Background(Item<BackgroundInput>),
    Camera(Item<AnyCamera>),
    Texture(Item<AnyTexture>),
    /// Inline texture that a value form produces.
    FormTexture(Item<AnyTexture>),
    Material(Item<AnyMaterial>),
    Light(Item<AnyLight>),
    Object(Item<Object>),
    Objects(Objects),
    Lights(Shared<Vec<Item<AnyLight>>>),
    LightGroup(String),
}

impl ItemValue {
    /// Name of the inline texture, if the value is one.
    pub fn inline_texture_name(&self, path: &Path) -> Option<String> {
        match (self, path.steps()) {
            (Self::FormTexture(_), [_, Step::Key(name)]) => Some(name.clone()),
            _ => None,
        }
    }

    /// JSON of the value.
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
            Self::LightGroup(label) => serde_json::to_value(label),
        };
        json.unwrap_or_default()
    }
}

impl Description {
    /// Stores a value at its path.
    pub(crate) fn put(&mut self, path: &Path, part: ItemValue) {
        let steps = path.steps();
        match part {
            ItemValue::Render(item) => self.render = item,
            ItemValue::Tone(item) => self.tone = item,
            ItemValue::Background(item) => self.background = Some(item),
            ItemValue::Camera(item) => match steps {
                [_, Step::Key(name)] => drop(self.cameras.insert(name.clone(), item)),
                _ => self.camera = Some(item),
            },
            ItemValue::Texture(item) => insert(&mut self.textures, steps, item),
            ItemValue::FormTexture(item) => {
                if let [_, Step::Key(name)] = steps {
                    self.form_textures.insert(name.clone());
                }
                insert(&mut self.textures, steps, item);
            }
            ItemValue::Material(item) => insert(&mut self.materials, steps, item),
            ItemValue::Light(item) => {
                if let [_, Step::Index(i)] = steps {
                    set(&mut self.lights, *i, item);
                }
            }
            ItemValue::Object(item) => {
                if let Some((objects, i)) = self.list_mut(path) {
                    set(objects, i, item);
                }
            }
            ItemValue::Objects(_) | ItemValue::Lights(_) | ItemValue::LightGroup(_) => self.put_list_value(path, part),
        }
    }

    /// Stores the value of a list form.
    fn put_list_value(&mut self, path: &Path, part: ItemValue) {
        let given = match part {
            ItemValue::Objects(objects) => {
                match path.steps() {
                    [_, Step::Key(name)] => drop(self.groups.insert(name.clone(), objects.clone())),
                    _ => self.objects = objects.clone(),
                }
                FormValue::Objects(objects)
            }
            ItemValue::Lights(lights) => {
                self.lights = lights.clone();
                FormValue::Lights(lights)
            }
            ItemValue::LightGroup(label) => {
                self.background_light_group = Some(label.clone());
                FormValue::LightGroup(label)
            }
            _ => return,
        };
        if let Some(form) = self.list_forms.iter_mut().find(|form| form.path == *path) {
            form.given = given;
        }
    }
}

/// Replaces the item at a position, or appends it.
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
