//! Relocation of file names in a scene that is written to another folder.

use crate::compile::Files;
use crate::path::{Path as ScenePath, Step};
use serde_json::Value;
use std::path::{Component, Path, PathBuf};

/// Rewrites the relative names of mesh, image, environment and photometric files in a scene so that
/// they lead to the same files from `folder`. Nothing changes if the scene already lies in that
/// folder.
pub fn relocate(scene: &mut Value, files: &Files<'_>, folder: &Path) {
    walk(scene, &mut ScenePath::root(), files, folder);
}

fn walk(value: &mut Value, at: &mut ScenePath, files: &Files<'_>, folder: &Path) {
    match value {
        Value::Object(members) => {
            for (key, member) in members.iter_mut() {
                at.push(Step::Key(key.clone()));
                match member {
                    Value::String(name) if key == "file" => rename(name, at, files, folder),
                    member => walk(member, at, files, folder),
                }
                at.pop();
            }
        }
        Value::Array(elements) => {
            for (i, element) in elements.iter_mut().enumerate().filter(|(_, element)| !element.is_number()) {
                at.push(Step::Index(i));
                walk(element, at, files, folder);
                at.pop();
            }
        }
        _ => {}
    }
}

fn rename(name: &mut String, at: &ScenePath, files: &Files<'_>, folder: &Path) {
    // A variable may be called `file` too, but it is a number or a vector.
    let is_variable = matches!(at.steps(), [Step::Key(first), _] if first == "variables");
    let is_asset = files.asset_cache.store().assets.path_of(name).is_some();
    if is_variable || is_asset || Path::new(name.as_str()).is_absolute() {
        return;
    }
    let (Some(from), Some(to)) = (canonical_folder(&files.locate(at, "")), canonical_folder(folder)) else { return };
    if from == to {
        return;
    }
    let moved = relative(&to, &from.join(name.as_str()));
    // Scene files use slashes on every system.
    let parts: Option<Vec<&str>> = moved.components().map(|part| part.as_os_str().to_str()).collect();
    match parts {
        Some(parts) if moved.is_relative() => *name = parts.join("/"),
        _ => {
            if let Some(moved) = moved.to_str() {
                moved.clone_into(name);
            }
        }
    }
}

fn canonical_folder(folder: &Path) -> Option<PathBuf> {
    let named = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    std::fs::canonicalize(named).ok()
}

/// Relative path from a folder to a file; the absolute path if they have no common root. Both must
/// be absolute.
fn relative(folder: &Path, file: &Path) -> PathBuf {
    // Resolve `..` in the file's folder first.
    let parent = file.parent().and_then(|parent| std::fs::canonicalize(parent).ok());
    let file = match (parent, file.file_name()) {
        (Some(parent), Some(name)) => parent.join(name),
        _ => file.to_owned(),
    };
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return file;
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(file.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_paths_from_a_folder_to_a_file() {
        let path = |folder: &str, file: &str| relative(Path::new(folder), Path::new(file));
        assert_eq!(path("/none/a", "/none/a/b/c.obj"), Path::new("b/c.obj"));
        assert_eq!(path("/none/a/d/e", "/none/a/b/c.obj"), Path::new("../../b/c.obj"));
        assert_eq!(path("/none/a", "/other/c.obj"), Path::new("../../other/c.obj"));
    }
}
