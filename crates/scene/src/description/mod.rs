//! What stands in a scene file, as types: JSON, its schema, its documentation and the Rust builder all come
//! from here and from the families of `juggler_tracer`.

use indexmap::IndexMap;
use juggler_imaging::Tone;
use juggler_math::Rgb;
use juggler_tracer::background::{AnyBackground, Solid};
use juggler_tracer::camera::AnyCamera;
use juggler_tracer::light::AnyLight;
use juggler_tracer::material::AnyMaterial;
use juggler_tracer::texture::AnyTexture;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod animation;
mod bones;
mod object;
mod render;
mod spheres;
mod transform;

pub use animation::{Animation, Component, ScenePath, Variable};
pub use bones::Bones;
pub(crate) use bones::positive_items;
pub use object::{GroupName, Object, Visible};
pub use render::{CameraName, Render};
pub use spheres::{Bead, Chain, ControlSphere, Limb};
pub use transform::{Axes, LookAt, Rotate, TransformStep};

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
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub variables: IndexMap<String, Variable>,
    /// Curves by name, for the value form `along`. A scene that is written at one frame has none any more.
    #[serde(default, skip_serializing)]
    pub paths: IndexMap<String, ScenePath>,
    /// How the picture is made.
    #[serde(default)]
    pub render: Render,
    /// How linear light becomes the levels of a picture file.
    #[serde(default)]
    pub tone: Tone,
    /// The camera, when there is one. Without any, one is placed that sees all objects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<AnyCamera>,
    /// Cameras by name; the first is used unless `render.camera` or the command line names another.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub cameras: IndexMap<String, AnyCamera>,
    /// What rays see that leave the world. Black, or a soft sky when the scene has no light of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background: Option<Backdrop>,
    /// The group of lights that the background's light is kept apart with in layers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background_light_group: Option<String>,
    /// Textures by name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub textures: IndexMap<String, AnyTexture>,
    /// Materials by name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub materials: IndexMap<String, AnyMaterial>,
    /// Groups of objects by name, to be placed any number of times, groups within groups too. What repeats often is
    /// stored once.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub groups: IndexMap<String, Vec<Object>>,
    /// The lights. A scene without lights, without emissive materials and without a background that lights it (an
    /// `environment`, a `sky`, and under `path` every other) gets a soft light above the camera.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<AnyLight>,
    /// What is to be seen.
    #[serde(default)]
    pub objects: Vec<Object>,
}

impl Default for Description {
    fn default() -> Self {
        Self {
            version: 1,
            title: String::new(),
            description: String::new(),
            include: Vec::new(),
            animation: Animation::default(),
            variables: IndexMap::new(),
            paths: IndexMap::new(),
            render: Render::default(),
            tone: Tone::default(),
            camera: None,
            cameras: IndexMap::new(),
            background: None,
            background_light_group: None,
            textures: IndexMap::new(),
            materials: IndexMap::new(),
            groups: IndexMap::new(),
            lights: Vec::new(),
            objects: Vec::new(),
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
