//! The JSON snippets in the documentation of each kind must parse as that kind, since readers copy
//! them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{AnyMaterial, MaterialCompiler};
use juggler_texture::{AnyTexture, TextureTable};
use serde::de::DeserializeOwned;
use std::fs;
use std::path::Path;

/// JSON blocks in the documentation of each file of a folder of `crates`, except `lib.rs` and
/// `mod.rs`, with the file's name.
fn snippets(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder);
    let mut found = Vec::new();
    for file in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file()) {
        let name = file.file_stem().unwrap().to_str().unwrap().to_owned();
        let page: String =
            fs::read_to_string(&file).unwrap().lines().filter_map(|line| line.strip_prefix("//! ")).collect();
        let blocks = page.split("```json").skip(1).filter_map(|rest| rest.split("```").next());
        found.extend(
            blocks.filter(|_| !["lib", "mod"].contains(&name.as_str())).map(|block| (name.clone(), block.to_owned())),
        );
    }
    found
}

fn each<T: DeserializeOwned>(folder: &str, least: usize, check: impl Fn(&T) -> Result<(), String>) {
    let found = snippets(folder);
    assert!(found.len() >= least, "{folder} documents {} kinds", found.len());
    for (file, text) in found {
        assert!(text.contains(&format!("\"{file}\"")), "{folder}/{file}.rs shows another kind: {text}");
        let kind: T = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{folder}/{file}.rs: {error}\n{text}"));
        check(&kind).unwrap_or_else(|error| panic!("{folder}/{file}.rs: {error}\n{text}"));
    }
}

#[test]
fn json_examples_of_the_documentation_are_valid() {
    let text = |error: &dyn std::error::Error| error.to_string();
    each("camera/src", 3, |camera: &AnyCamera| camera.projection([4, 3].into()).map(|_| ()).map_err(|e| text(&e)));
    each("texture/src", 17, |texture: &AnyTexture| texture.check().map_err(|e| text(&e)));
    each("light/src", 4, |light: &AnyLight| light.check().map_err(|e| text(&e)));
    each("light/src/background", 3, |background: &AnyBackground| background.check().map_err(|e| text(&e)));
    each("material/src", 14, |material: &AnyMaterial| {
        match MaterialCompiler::new(TextureTable::default(), []).compile(material) {
            // Accept names of textures and materials, which a scene would define.
            Err(error) if !error.is_unknown_name() => Err(text(&error)),
            _ => Ok(()),
        }
    });
}
