//! Built-in scenes, which are part of the program.

use crate::document::{FileId, parse};
use crate::suggest::did_you_mean_or_list;
use crate::{Scene, SceneError};

/// A built-in scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// Name on the command line.
    pub name: &'static str,
    /// Text of the scene file.
    pub json: &'static str,
}

/// Includes files of `scenes/` by name, in the order of their listing.
macro_rules! built_in {
    ($($name:literal),+ $(,)?) => {
        &[$(BuiltIn { name: $name, json: include_str!(concat!("../../../scenes/", $name, ".json")) }),+]
    };
}

/// All built-in scenes, a line for each file.
const BUILT_IN: &[BuiltIn] = built_in! {
    "blossom",
    "chess",
    "chess-daylight",
    "chess-opening",
    "cornell-box",
    "cornell-cube",
    "depth-of-field",
    "evening-cradle",
    "first-render",
    "four-spheres-mirrors",
    "furnace",
    "glass-caustics",
    "glossy-plates",
    "graham",
    "juggler",
    "juggler-daylight",
    "many-lights-room",
    "marbles",
    "material-balls",
    "one-sphere",
    "red-cube",
    "scalablitz-ice-cream",
    "scalablitz-nice-light",
    "scalablitz-planet-moon",
    "scalablitz-pool",
    "scalablitz-random",
    "scalablitz-sphere-pyramid",
    "scalablitz-triangles-and-spheres",
    "six-mirror-spheres",
    "sphere-lights",
    "sphere-triangle-shadow",
    "step-08",
    "step-09",
    "step-10",
    "step-11",
    "step-12",
    "step-12b",
    "step-13",
    "step-13-mirror",
    "step-13c",
    "transparent-shadow",
    "triangle-lights",
    "two-spheres-mirrored",
    "two-spheres-refraction",
};

/// Returns all built-in scenes.
pub fn built_in_scenes() -> &'static [BuiltIn] {
    BUILT_IN
}

impl BuiltIn {
    /// One sentence about the picture: the scene file's `description`.
    pub fn description(&self) -> String {
        let tree = parse(self.json, FileId::MAIN).ok();
        let text = tree.as_ref().and_then(|(tree, _)| tree.get("description")?.as_str());
        text.unwrap_or_default().to_owned()
    }
}

impl Scene {
    /// Loads one of the [`built_in_scenes`].
    pub fn built_in(name: &str) -> Result<Self, SceneError> {
        let Some(scene) = BUILT_IN.iter().find(|scene| scene.name == name) else {
            let help = did_you_mean_or_list(name, BUILT_IN.iter().map(|scene| scene.name));
            return Err(SceneError::UnknownBuiltIn { name: name.to_owned(), help });
        };
        Self::from_json(scene.json, &format!("{name}.json"))
    }
}
