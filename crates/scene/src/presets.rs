//! Scenes that are part of the program.

use crate::scene::{Scene, SceneError};
use crate::suggest::meant_or_all;

/// A scene that is part of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// What it is called on the command line.
    pub name: &'static str,
    /// What is to be seen, in a sentence.
    pub description: &'static str,
    /// The scene file.
    pub json: &'static str,
}

/// Every built-in scene, by name.
const BUILT_IN: &[BuiltIn] = &[
    BuiltIn {
        name: "juggler",
        description: "The Amiga's Juggler of 1986: three mirror balls juggled above a checkered plain, 30 frames",
        json: include_str!("../../../scenes/juggler.json"),
    },
    BuiltIn {
        name: "one-sphere",
        description: "The smallest scene: one object, everything else is a default",
        json: include_str!("../../../scenes/one-sphere.json"),
    },
];

/// The scenes that are part of the program.
pub fn built_in_scenes() -> &'static [BuiltIn] {
    BUILT_IN
}

impl Scene {
    /// One of [`built_in_scenes`].
    pub fn built_in(name: &str) -> Result<Self, SceneError> {
        let Some(scene) = BUILT_IN.iter().find(|scene| scene.name == name) else {
            let help = meant_or_all(name, BUILT_IN.iter().map(|scene| scene.name));
            return Err(SceneError::UnknownBuiltIn { name: name.to_owned(), help });
        };
        Self::from_json(scene.json, &format!("{name}.json"))
    }
}
