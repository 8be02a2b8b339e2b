//! Models: scenes of other formats as objects.
//!
//! ```json
//! {"model": {"file": "fox.glb", "animation": "Run"}, "transform": [{"scale": 0.01}]}
//! ```

use crate::model::{AnimationChoice, ModelChoice, ModelRepeat, NameOrIndex};
use indexmap::IndexMap;
use juggler_material::MaterialRef;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scene of a model file (glTF), placed as one object. Its materials, textures, lights and cameras
/// belong to the scene too, under names that begin with the name of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Model {
    /// Model file, relative to the scene file.
    pub file: String,
    /// Scene of the file, by name or index. Defaults to the file's own choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<NameOrIndex>,
    /// Variant of the materials, by name or index. Defaults to the materials without a variant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<NameOrIndex>,
    /// Animation clip, by name or index; `"none"` shows the rest pose. Defaults to the first clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub animation: Option<NameOrIndex>,
    /// Time in the clip. Defaults to the time of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "seconds"))]
    pub at: Option<f64>,
    /// What happens after the end of the clip.
    #[serde(default)]
    pub repeat: ModelRepeat,
    /// Materials that replace those of the file, by the names of the file's materials.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub materials: IndexMap<String, MaterialRef>,
    /// Names of nodes. If there are any, only these nodes are placed, with the nodes below them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nodes: Vec<String>,
    /// Names of nodes that are not placed, nor the nodes below them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hide: Vec<String>,
    /// Whether the lights of the file belong to the scene.
    #[serde(default = "yes")]
    pub lights: bool,
    /// Whether light intensities of the file are photometric (candela, lux). They are then divided
    /// by 683 lm/W.
    #[serde(default)]
    pub photometric: bool,
}

fn yes() -> bool {
    true
}

impl Model {
    /// Model of a file, otherwise with defaults.
    pub fn new(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            scene: None,
            variant: None,
            animation: None,
            at: None,
            repeat: ModelRepeat::default(),
            materials: IndexMap::new(),
            nodes: Vec::new(),
            hide: Vec::new(),
            lights: true,
            photometric: false,
        }
    }

    /// What the model shows of its file in a scene at a time in seconds.
    pub fn choice(&self, scene_seconds: f64) -> ModelChoice {
        ModelChoice {
            scene: self.scene.clone(),
            variant: self.variant.clone(),
            animation: AnimationChoice::from_setting(self.animation.as_ref()),
            seconds: self.at.unwrap_or(scene_seconds),
            repeat: self.repeat,
            photometric: self.photometric,
            picture_size: None,
        }
    }
}
