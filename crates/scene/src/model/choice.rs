//! What of a model file is used: scene, variant, animation and time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Choice of what a model file shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelChoice {
    /// Scene of the file. Defaults to the file's own choice.
    pub scene: Option<NameOrIndex>,
    /// Variant of the materials. Defaults to the materials without a variant.
    pub variant: Option<NameOrIndex>,
    /// Animation clip.
    pub animation: AnimationChoice,
    /// Time in the clip, in seconds.
    pub seconds: f64,
    /// What happens after the end of the clip.
    pub repeat: ModelRepeat,
    /// Whether light intensities are photometric (candela, lux) and are divided by 683 lm/W.
    pub photometric: bool,
    /// Width and height of the picture in pixels. Points and lines get a width that it shows.
    pub picture_size: Option<[u32; 2]>,
}

/// Name of a part of a file, or its index, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NameOrIndex {
    /// Index, counted from 0.
    Index(u32),
    /// Name, as written in the file.
    Name(String),
}

/// A number is an index, any other text a name.
impl From<&str> for NameOrIndex {
    fn from(text: &str) -> Self {
        text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Index)
    }
}

/// Animation clip of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum AnimationChoice {
    /// First clip of the file, if it has one.
    #[default]
    First,
    /// No clip: the rest pose.
    None,
    /// Clip by name or index.
    Clip(NameOrIndex),
}

impl AnimationChoice {
    /// Choice by a setting: a clip, or the name `none` for the rest pose. Defaults to the first
    /// clip.
    pub fn from_setting(setting: Option<&NameOrIndex>) -> Self {
        match setting {
            None => Self::First,
            Some(NameOrIndex::Name(name)) if name == "none" => Self::None,
            Some(clip) => Self::Clip(clip.clone()),
        }
    }
}

/// What happens after the end of a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelRepeat {
    /// The clip starts again.
    #[default]
    Loop,
    /// The last pose stays.
    Once,
}
