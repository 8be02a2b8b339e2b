//! The generated files in the repository are up to date.

use juggler_python_types::generate;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The published schema.
pub fn schema() -> Value {
    serde_json::from_str(&fs::read_to_string(root().join("schema/scene.schema.json")).unwrap()).unwrap()
}

#[test]
fn the_files_of_the_package_are_current() {
    let package = root().join("crates/python/python/juggler");
    for file in generate(&schema()).unwrap() {
        let path = package.join(&file.name);
        if std::env::var_os("JUGGLER_BLESS").is_some() {
            fs::write(&path, &file.text).unwrap();
        }
        let current = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n") == file.text;
        let name = &file.name;
        assert!(current, "{name} is out of date; to write it anew: JUGGLER_BLESS=1 cargo test -p juggler-python-types");
    }
}

/// No file of a class that the schema no longer has stays behind.
#[test]
fn every_generated_file_of_the_package_belongs_to_the_schema() {
    let names: Vec<String> = generate(&schema()).unwrap().into_iter().map(|file| file.name).collect();
    for entry in fs::read_dir(root().join("crates/python/python/juggler")).unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap_or_default();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(!text.starts_with("# Generated from schema/") || names.contains(&name), "{name}");
    }
}
