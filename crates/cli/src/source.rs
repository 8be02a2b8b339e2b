//! Where scenes come from: a file, or the program itself.

use crate::failure::Failure;
use juggler::scene::suggest::closest;
use juggler::scene::{Scene, built_in_scenes};
use std::path::Path;

/// Most names of files that are looked through for what was meant.
const MAX_NAMES: usize = 10_000;

/// Reads a scene file; what is no file may be the name of a built-in scene.
pub fn load(name: &str) -> Result<Scene, Failure> {
    let path = Path::new(name);
    if path.exists() && !path.is_dir() {
        return Ok(Scene::load(path)?);
    }
    if built_in_scenes().iter().any(|scene| scene.name == name) {
        return Ok(Scene::built_in(name)?);
    }
    if path.is_dir() {
        return Err(Failure::Wrong(format!("`{name}` is a folder, not a scene file")));
    }
    Err(unknown(name))
}

/// The name without folder and ending.
pub fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("picture")
}

/// Somebody who writes an ending or a folder means a file, and the file is missing; else the name is wrong.
fn unknown(name: &str) -> Failure {
    let path = Path::new(name);
    let folder = path.parent().unwrap_or(Path::new(""));
    let files = names_in(folder);
    let file_name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let near = |names: &[String]| closest(file_name, names.iter().map(String::as_str)).map(str::to_owned);
    if path.extension().is_some() || !folder.as_os_str().is_empty() {
        let meant = near(&files).map(|near| folder.join(near).display().to_string());
        return Failure::System(format!("no file is called `{name}`{}", question(meant)));
    }
    let built_in: Vec<String> = built_in_scenes().iter().map(|scene| scene.name.to_owned()).collect();
    let meant = near(&built_in).or_else(|| near(&files));
    Failure::Wrong(format!("no file and no built-in scene is called `{name}`{}", question(meant)))
}

fn question(meant: Option<String>) -> String {
    meant.map(|meant| format!(", did you mean `{meant}`?")).unwrap_or_default()
}

fn names_in(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten().take(MAX_NAMES);
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stems() {
        assert_eq!((stem("juggler"), stem("a/b.scene.json"), stem("..")), ("juggler", "b.scene", "picture"));
    }
}
