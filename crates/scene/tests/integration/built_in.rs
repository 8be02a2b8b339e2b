//! The built-in scenes.

use juggler_scene::{BuiltIn, Scene, SceneError, built_in_scenes};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The folder of the scene files.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");

#[test]
fn every_file_is_built_in_and_every_built_in_scene_is_a_file() {
    let files = fs::read_dir(FOLDER).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "json"));
    let files: BTreeSet<String> = files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let names: Vec<String> = built_in_scenes().iter().map(|scene| scene.name.to_owned()).collect();
    let known: BTreeSet<String> = names.iter().cloned().collect();
    assert_eq!(known.len(), names.len(), "a name stands twice in BUILT_IN");
    let missing: Vec<_> = files.difference(&known).collect();
    assert!(missing.is_empty(), "add a line for each of {missing:?} to BUILT_IN in crates/scene/src/presets.rs");
}

#[test]
fn every_built_in_scene_is_sound() {
    for BuiltIn { name, json } in built_in_scenes() {
        let scene = Scene::built_in(name).unwrap_or_else(|error| panic!("{name}\n{error}"));
        let problems = scene.check();
        assert!(problems.list().is_empty(), "{name}\n{problems}");
        let frames = scene.description.animation.frames;
        for frame in BTreeSet::from([0, frames / 3, frames - 1]) {
            let frame = scene.at_frame(f64::from(frame)).unwrap_or_else(|error| panic!("{name}\n{error}"));
            let compiled = frame.compile().unwrap_or_else(|error| panic!("{name}\n{error}"));
            assert!(compiled.warnings.list().is_empty(), "{name}\n{}", compiled.warnings);
            assert!(compiled.world.geometry_stats().shapes > 0, "{name} is empty");
        }
        assert!(json.ends_with("}\n"), "{name} must end with one newline");
    }
}

#[test]
fn every_built_in_scene_has_title_and_description() {
    for built_in in built_in_scenes() {
        let BuiltIn { name, .. } = built_in;
        let description = Scene::built_in(name).unwrap().description;
        assert_eq!(built_in.description(), description.description, "{name}");
        assert!(!description.title.is_empty(), "{name} has no title");
        let text = description.description;
        assert!((20..=140).contains(&text.chars().count()), "{name}: the description should be one line: {text}");
        assert!(!text.contains('\n') && !text.ends_with('.'), "{name}: a line without a full stop, not: {text}");
    }
}

/// Built-in scenes are rendered without a file system.
#[test]
fn no_built_in_scene_needs_another_file() {
    for BuiltIn { name, .. } in built_in_scenes() {
        let scene = Scene::built_in(name).unwrap();
        assert!(scene.description.include.is_empty(), "{name}");
        assert!(!scene.to_json().contains("\"file\""), "{name} names a file");
    }
}

#[test]
fn misspelled_built_in_name_gets_a_suggestion() {
    let error = Scene::built_in("jugler").unwrap_err();
    assert!(matches!(error, SceneError::UnknownBuiltIn { .. }));
    assert_eq!(error.to_string(), "no built-in scene is called `jugler`; did you mean `juggler`?");
}

#[test]
fn a_file_and_its_built_in_copy_are_the_same_scene() {
    for BuiltIn { name, .. } in built_in_scenes() {
        let file = Scene::load(Path::new(FOLDER).join(format!("{name}.json"))).unwrap();
        assert_eq!(file.fingerprint(), Scene::built_in(name).unwrap().fingerprint(), "{name}");
    }
}
