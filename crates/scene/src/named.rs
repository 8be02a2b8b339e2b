//! Scenes by name: a file or a built-in scene.

use crate::compile::NEVER_CANCELLED;
use crate::presets::built_in_scenes;
use crate::suggest::closest;
use crate::{Loader, Scene, SceneError};
use juggler_math::BuildControl;
use std::path::Path;

/// Maximum number of file names of a folder that are searched for suggestions.
const MAX_NAMES: usize = 10_000;

/// A name that leads to no file and to nothing built in.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct UnknownName {
    /// Message for the user.
    pub message: String,
    /// Whether the name denotes a missing file; otherwise it is an unknown name.
    pub is_file: bool,
}

impl Scene {
    /// Loads a scene file, or the built-in scene of this name if there is no such file.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        Loader::default().named(name)
    }
}

impl Loader {
    /// Loads a file, or the built-in scene of this name if there is no such file.
    pub fn named(self, name: &str) -> Result<Scene, SceneError> {
        self.named_with_control(name, &NEVER_CANCELLED)
    }

    /// [`Loader::named`], which ends early if `control` is cancelled, and reports its progress to it.
    pub fn named_with_control(self, name: &str, control: &BuildControl) -> Result<Scene, SceneError> {
        let path = Path::new(name);
        // A dangling link gets the error of loading it.
        if (path.exists() || path.is_symlink()) && !path.is_dir() {
            return self.load_with_control(path, control);
        }
        if built_in_scenes().iter().any(|scene| scene.name == name) {
            return Scene::built_in(name);
        }
        if path.is_dir() {
            let message = format!("`{name}` is a folder, not a scene file");
            return Err(UnknownName { message, is_file: false }.into());
        }
        Err(unknown(name, "scene", built_in_scenes().iter().map(|scene| scene.name)).into())
    }
}

/// Creates the error for a name of neither a file nor one of the `built_in` items. A name with an
/// extension or a folder counts as a file.
pub fn unknown<'n>(name: &str, what: &str, built_in: impl IntoIterator<Item = &'n str>) -> UnknownName {
    if name.is_empty() {
        return UnknownName { message: format!("the name of the {what} is empty"), is_file: false };
    }
    let path = Path::new(name);
    let folder = path.parent().unwrap_or(Path::new(""));
    let near = || similar_file(path, MAX_NAMES);
    if path.extension().is_some() || !folder.as_os_str().is_empty() {
        let meant = near().map(|near| folder.join(near).display().to_string());
        return UnknownName { message: format!("file not found: `{name}`{}", question(meant)), is_file: true };
    }
    // A colon precedes the size of a built-in mesh.
    let bare = name.split(':').next().unwrap_or_default();
    let meant = closest(bare, built_in).map(str::to_owned).or_else(near);
    let message = format!("unknown {what} `{name}`: neither a file nor a built-in {what}{}", question(meant));
    UnknownName { message, is_file: false }
}

/// Name of the file in the folder of a missing file that resembles its name most, among the first
/// `most` files of the folder.
pub(crate) fn similar_file(path: &Path, most: usize) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().take(most);
    let names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    closest(path.file_name()?.to_str()?, names.iter().map(String::as_str)).map(str::to_owned)
}

/// Name of a file without its folder, with `/` in place of `\`; `None` if it has no `\`.
pub(crate) fn with_slashes(path: &Path) -> Option<String> {
    path.file_name()?.to_str().filter(|name| name.contains('\\')).map(|name| name.replace('\\', "/"))
}

/// Question that follows a message: "; did you mean `wood.png`?".
pub(crate) fn question(meant: Option<String>) -> String {
    meant.map(|meant| format!("; did you mean `{meant}`?")).unwrap_or_default()
}
