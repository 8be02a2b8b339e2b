//! Types of a scene file. The JSON format, its schema, its documentation and the Rust builder are
//! derived from these types and from the families of kinds (`juggler_shape`, `juggler_material`,
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
use std::cell::LazyCell;
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

mod animation;
mod bones;
#[cfg(test)]
mod constructors;
mod instance_array;
mod instance_attributes;
mod instance_file;
mod instance_points;
mod instances;
mod model;
mod object;
mod placement_error;
mod read;
mod render;
mod source_section;
mod spheres;
mod transform;

pub use animation::{Animation, Component, ScenePath, Variable};
pub use bones::Bones;
pub(crate) use bones::positive_items;
pub use instance_array::InstanceArray;
pub use instance_attributes::{InstanceAttribute, NamedAttributes};
pub use instance_file::InstanceFile;
pub use instances::Instances;
pub use model::Model;
pub use object::{GroupName, Object, Visible};
pub use placement_error::PlacementError;
pub(crate) use read::deserialize_scene;
pub use render::{CameraName, Render};
pub(crate) use source_section::SourceSection;
pub use spheres::{Chain, ChainSphere, ControlSphere, Limb};
pub use transform::{LookAt, Rotate, Rotation, ScaleFactors, TransformStep};

/// List of objects.
pub type Objects = Shared<Vec<Item<Object>>>;
/// Items by name, in insertion order.
pub type Named<T> = Shared<IndexMap<String, Item<T>>>;

/// Scene: everything that determines the rendered image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Scene")]
pub struct Description {
    /// Version of the format. Must be 1.
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// Title of the scene, for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Description of the scene in one sentence, for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Other scene files, relative to this one, whose textures, materials, groups, cameras,
    /// variables, paths, lights and objects are added to this scene. A file that is included twice
    /// is added once. A name that two files define is an error.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub include: Vec<String>,
    /// Length and frame rate of an animation.
    #[serde(default, skip_serializing_if = "Animation::is_still")]
    pub animation: Animation,
    /// Named numbers and vectors for expressions such as `"=2 * radius"`. A variable may refer to
    /// variables above it.
    #[serde(default, skip_serializing_if = "SourceSection::is_empty")]
    #[schemars(with = "IndexMap<String, Variable>")]
    pub(crate) variables: SourceSection,
    /// Named curves for the value form `along`. A scene that is saved at a single frame has no
    /// paths.
    #[serde(default, skip_serializing_if = "SourceSection::is_empty")]
    #[schemars(with = "IndexMap<String, ScenePath>")]
    pub(crate) paths: SourceSection,
    /// Render settings: image size, samples, shutter, integrator, sampler and filter.
    #[serde(default)]
    pub render: Item<Render>,
    /// Tone mapping from linear radiance to the pixel values of an image file.
    #[serde(default)]
    pub tone: Item<Tone>,
    /// Camera of a scene with a single camera. Without `camera` and `cameras`, a default camera
    /// sees all objects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Item<AnyCamera>>,
    /// Cameras by name, in place of `camera`. The first is used unless `render.camera` or the
    /// command line selects another.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub cameras: Named<AnyCamera>,
    /// Radiance of rays that leave the scene. Defaults to black, or to a uniform gray of 0.25 in a
    /// scene without lights and emissive materials.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background: Option<Item<BackgroundInput>>,
    /// Light group of the background; each light group is written to an AOV of its own. Without it,
    /// the background belongs to the group `rest`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub background_light_group: Option<String>,
    /// Textures by name.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub textures: Named<AnyTexture>,
    /// Materials by name.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub materials: Named<AnyMaterial>,
    /// Groups of objects by name, which objects place any number of times. Groups may place other
    /// groups. Large groups with many placements are stored once and instanced.
    #[serde(default, skip_serializing_if = "is_empty_map")]
    pub groups: Shared<IndexMap<String, Objects>>,
    /// Lights. A scene without lights, without emissive materials and without a background that
    /// lights it gets a default light above the camera. An `environment` and a `sky` light the
    /// scene; with the integrators `path` and `direct`, so does every other background that is not
    /// black.
    #[serde(default, skip_serializing_if = "is_empty_list")]
    pub lights: Shared<Vec<Item<AnyLight>>>,
    /// Objects of the scene, in world space.
    #[serde(default)]
    pub objects: Objects,
    /// Lists that are written as a single value form, with the form's value at the scene's frame.
    #[serde(skip)]
    pub(crate) list_forms: Shared<Vec<ListForm>>,
    /// Names of textures that value forms produce inline.
    #[serde(skip)]
    pub(crate) form_textures: Shared<BTreeSet<String>>,
    /// Compiled expressions, shared with the scene's other frames.
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
            variables: SourceSection::default(),
            paths: SourceSection::default(),
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

/// Background, or a color as shorthand for a uniform background.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Backdrop")]
pub enum BackgroundInput {
    /// Color of a uniform background: its linear radiance, the same in all directions.
    Color(#[schemars(extend("x-unit" = "W/(scene unit² sr)"))] Rgb),
    /// Background of any kind.
    Kind(AnyBackground),
}

impl From<BackgroundInput> for AnyBackground {
    fn from(backdrop: BackgroundInput) -> Self {
        match backdrop {
            BackgroundInput::Color(color) => Solid { color }.into(),
            BackgroundInput::Kind(kind) => kind,
        }
    }
}

impl From<Rgb> for BackgroundInput {
    fn from(color: Rgb) -> Self {
        Self::Color(color)
    }
}

impl From<AnyBackground> for BackgroundInput {
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
    /// Makes the scene static: values at its frame stay, while expressions, value forms, variables,
    /// paths and animation settings are removed.
    pub(crate) fn make_static(&mut self) {
        for source in self.templates(|_| true) {
            if let Some(item) = self.item_mut(&source.path) {
                item.set_template(None);
            }
        }
        (self.list_forms, self.form_textures) = Default::default();
        (self.variables, self.paths, self.animation) = Default::default();
    }

    /// Findings of schema validation outside of items.
    pub(crate) fn head_findings(&self) -> Vec<Finding> {
        let head = Self {
            version: self.version,
            animation: self.animation,
            background_light_group: self.background_light_group.clone(),
            ..Self::default()
        };
        validate(&serde_json::to_value(&head).unwrap_or_default().into()).all()
    }

    /// Findings of schema validation in the items that satisfy a predicate. Items that have passed
    /// before, in a scene with the same names, are not validated again.
    pub(crate) fn item_findings(&self, predicate: impl Fn(&dyn AnyItem) -> bool) -> Vec<Finding> {
        // Items read from a file need no hash.
        let (mut findings, names) = (Vec::new(), LazyCell::new(|| self.names_hash()));
        self.each_item(&mut |at, item| {
            if predicate(item) && !item.has_passed(*names) {
                let json = item.json_without_arrays().into();
                let names_of = NameScope::Scene(self);
                let found = validate::item(&json, &at.into(), at, names_of, findings.len()).all();
                if found.is_empty() {
                    item.set_passed(*names);
                }
                findings.extend(found);
            }
        });
        findings
    }

    /// Hash of the names that references are checked against; never 0.
    fn names_hash(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        for names in [
            self.materials.keys().collect::<Vec<_>>(),
            self.textures.keys().collect(),
            self.groups.keys().collect(),
            self.cameras.keys().collect(),
        ] {
            names.hash(&mut hasher);
        }
        hasher.finish().max(1)
    }
}
