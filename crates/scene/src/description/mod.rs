//! What stands in a scene file, as types: JSON, its schema, its documentation and the Rust builder
//! all come from here and from the families of kinds (`juggler_shape`, `juggler_material`,
//! `juggler_light`, ...).

use crate::animate::Programs;
use crate::item::Item;
use crate::motion::{AnyItem, ListForm};
use crate::report::Finding;
use crate::shared::Shared;
use crate::validate::{self, NameScope, validate};
use indexmap::IndexMap;
use juggler_camera::AnyCamera;
use juggler_imaging::Tone;
use juggler_light::AnyLight;
use juggler_light::background::{AnyBackground, Solid};
use juggler_material::AnyMaterial;
use juggler_math::Rgb;
use juggler_texture::AnyTexture;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

mod animation;
mod bones;
mod object;
mod read;
mod render;
mod spheres;
mod transform;
mod written;

pub use animation::{Animation, Component, ScenePath, Variable};
pub use bones::Bones;
pub(crate) use bones::positive_items;
pub use object::{GroupName, Object, Visible};
pub(crate) use read::described;
pub use render::{CameraName, Render};
pub use spheres::{Bead, Chain, ControlSphere, Limb};
pub use transform::{Axes, LookAt, Rotate, TransformStep};
pub(crate) use written::Written;

/// Objects in order.
pub type Objects = Shared<Vec<Item<Object>>>;
/// Items by name, in the order in which they were added.
pub type Named<T> = Shared<IndexMap<String, Item<T>>>;

/// A scene: everything that decides a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Scene")]
pub struct Description {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// Name of the scene.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// What is to be seen, in a sentence.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Other scene files, relative to this one, whose textures, materials, groups, cameras, variables, paths, lights
    /// and objects belong to this scene too. Each file comes in once; the same name twice is an error.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub include: Vec<String>,
    /// Length and pace of an animation.
    #[serde(default, skip_serializing_if = "Animation::is_still")]
    pub animation: Animation,
    /// Named numbers and vectors for `"=expressions"`, in order: each may use those before it.
    #[serde(default, skip_serializing_if = "Written::is_empty")]
    #[schemars(with = "IndexMap<String, Variable>")]
    pub(crate) variables: Written,
    /// Curves by name, for the value form `along`. A scene that is written at one frame has none any more.
    #[serde(default, skip_serializing_if = "Written::is_empty")]
    #[schemars(with = "IndexMap<String, ScenePath>")]
    pub(crate) paths: Written,
    /// How the picture is made.
    #[serde(default)]
    pub render: Item<Render>,
    /// How linear light becomes the levels of a picture file.
    #[serde(default)]
    pub tone: Item<Tone>,
    /// The camera, when there is one. Without any, one is placed that sees all objects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Item<AnyCamera>>,
    /// Cameras by name; the first is used unless `render.camera` or the command line names another.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub cameras: Named<AnyCamera>,
    /// What rays see that leave the world. Black, or a soft sky when the scene has no light of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background: Option<Item<Backdrop>>,
    /// The group of lights that the background's light is kept apart with in layers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background_light_group: Option<String>,
    /// Textures by name.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub textures: Named<AnyTexture>,
    /// Materials by name.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub materials: Named<AnyMaterial>,
    /// Groups of objects by name, to be placed any number of times, groups within groups too. What repeats often is
    /// stored once.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub groups: Shared<IndexMap<String, Objects>>,
    /// The lights. A scene without lights, without emissive materials and without a background that lights it (an
    /// `environment`, a `sky`, and under `path` every other) gets a soft light above the camera.
    #[serde(default, skip_serializing_if = "is_empty_list")]
    pub lights: Shared<Vec<Item<AnyLight>>>,
    /// What is to be seen.
    #[serde(default)]
    pub objects: Objects,
    /// Lists that are written as one value form, with what the form gives at the scene's frame.
    #[serde(skip)]
    pub(crate) list_forms: Shared<Vec<ListForm>>,
    /// Names of textures that value forms give in place.
    #[serde(skip)]
    pub(crate) form_textures: Shared<BTreeSet<String>>,
    /// Compiled expressions, for the scene's other frames.
    #[serde(skip)]
    pub(crate) programs: Programs,
}

impl Default for Description {
    fn default() -> Self {
        Self {
            version: 1,
            title: String::new(),
            description: String::new(),
            include: Vec::new(),
            animation: Animation::default(),
            variables: Written::default(),
            paths: Written::default(),
            render: Item::default(),
            tone: Item::default(),
            camera: None,
            cameras: Named::default(),
            background: None,
            background_light_group: None,
            textures: Named::default(),
            materials: Named::default(),
            groups: Shared::default(),
            lights: Shared::default(),
            objects: Objects::default(),
            list_forms: Shared::default(),
            form_textures: Shared::default(),
            programs: Programs::default(),
        }
    }
}

/// Why something cannot be placed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Misplaced {
    /// Path of the field at fault, as in the scene file; empty when several are.
    pub field: &'static str,
    /// What is wrong.
    pub message: String,
}

impl Misplaced {
    fn new(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, message: message.into() }
    }
}

/// A background, or a colour that is short for the same colour everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Backdrop {
    /// The same colour everywhere.
    Color(Rgb),
    /// A background.
    Kind(AnyBackground),
}

impl From<Backdrop> for AnyBackground {
    fn from(backdrop: Backdrop) -> Self {
        match backdrop {
            Backdrop::Color(color) => Solid { color }.into(),
            Backdrop::Kind(kind) => kind,
        }
    }
}

impl From<Rgb> for Backdrop {
    fn from(color: Rgb) -> Self {
        Self::Color(color)
    }
}

impl From<AnyBackground> for Backdrop {
    fn from(kind: AnyBackground) -> Self {
        match kind {
            AnyBackground::Solid(Solid { color }) => Self::Color(color),
            kind => Self::Kind(kind),
        }
    }
}

fn is_empty_map<T>(map: &Shared<IndexMap<String, T>>) -> bool {
    map.is_empty()
}

fn is_empty_list<T>(list: &Shared<Vec<T>>) -> bool {
    list.is_empty()
}

impl Description {
    /// Lets everything stand as it is.
    pub(crate) fn stand_still(&mut self) {
        for wanted in self.templates(|_| true) {
            if let Some(item) = self.item_mut(&wanted.path) {
                item.set_template(None);
            }
        }
        (self.list_forms, self.form_textures) = Default::default();
        (self.variables, self.paths, self.animation) = Default::default();
    }

    /// What does not fit the schema beside items.
    pub(crate) fn head_findings(&self) -> Vec<Finding> {
        let head = Self {
            version: self.version,
            animation: self.animation,
            background_light_group: self.background_light_group.clone(),
            ..Self::default()
        };
        validate(&serde_json::to_value(&head).unwrap_or_default().into()).all()
    }

    /// What does not fit the schema in the items that are to be looked at.
    pub(crate) fn item_findings(&self, is_wanted: impl Fn(&dyn AnyItem) -> bool) -> Vec<Finding> {
        let mut findings = Vec::new();
        self.each_item(&mut |at, item| {
            if is_wanted(item) {
                findings.extend(
                    validate::item(&item.json_without_arrays().into(), &at.into(), at, NameScope::Scene(self)).all(),
                );
            }
        });
        findings
    }
}
