//! Scenes as people name them: a file, or a scene that is part of the program.

use crate::presets::built_in_scenes;
use crate::suggest::closest;
use crate::{Scene, SceneError};
use std::path::Path;

/// Most names of files that are looked through for what was meant.
const MAX_NAMES: usize = 10_000;

/// A name that leads to no file and to nothing built in.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Unknown {
    /// What to say of it.
    pub message: String,
    /// Whether a file was meant, which is missing; else the name is wrong.
    pub is_file: bool,
}

impl Scene {
    /// A scene file; what is no file may be the name of a built-in scene.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        let path = Path::new(name);
        // A link that leads nowhere is told as such.
        if (path.exists() || path.is_symlink()) && !path.is_dir() {
            return Self::load(path);
        }
        if built_in_scenes().iter().any(|scene| scene.name == name) {
            return Self::built_in(name);
        }
        if path.is_dir() {
            let message = format!("`{name}` is a folder, not a scene file");
            return Err(Unknown { message, is_file: false }.into());
        }
        Err(unknown(name, "scene", built_in_scenes().iter().map(|scene| scene.name)).into())
    }
}

/// What to say of a name that leads to no file and to nothing built in, of which there are these. Somebody who writes an
/// ending or a folder means a file.
pub fn unknown<'n>(name: &str, what: &str, built_in: impl IntoIterator<Item = &'n str>) -> Unknown {
    let path = Path::new(name);
    let folder = path.parent().unwrap_or(Path::new(""));
    let files = names_in(folder);
    let file_name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let near = |names: &[String]| closest(file_name, names.iter().map(String::as_str)).map(str::to_owned);
    if path.extension().is_some() || !folder.as_os_str().is_empty() {
        let meant = near(&files).map(|near| folder.join(near).display().to_string());
        return Unknown { message: format!("no file is called `{name}`{}", question(meant)), is_file: true };
    }
    // What follows a colon is the size of a built-in mesh.
    let bare = file_name.split(':').next().unwrap_or_default();
    let meant = closest(bare, built_in).map(str::to_owned).or_else(|| near(&files));
    let message = format!("no file and no built-in {what} is called `{name}`{}", question(meant));
    Unknown { message, is_file: false }
}

fn question(meant: Option<String>) -> String {
    meant.map(|meant| format!(", did you mean `{meant}`?")).unwrap_or_default()
}

fn names_in(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten().take(MAX_NAMES);
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect()
}
