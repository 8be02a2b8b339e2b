//! Which module may use which: a station of the ray's journey looks back, never ahead.

#![expect(clippy::unwrap_used, reason = "a test")]

use std::fs;
use std::path::{Path, PathBuf};

/// Module → modules it may name after `crate::`.
const ALLOWED: &[(&str, &[&str])] = &[
    ("camera", &[]),
    ("sampler", &[]),
    ("film", &[]),
    ("layer", &[]),
    ("bsdf", &[]),
    ("emitter", &[]),
    ("medium", &[]),
    ("manifold", &[]),
    ("surface", &[]),
    ("background", &[]),
    ("shape", &["surface"]),
    ("texture", &["surface"]),
    ("light", &["emitter", "shape", "texture"]),
    ("material", &["surface", "texture", "bsdf", "medium"]),
    (
        "world",
        &["shape", "surface", "medium", "manifold", "material", "bsdf", "emitter", "light", "background", "layer"],
    ),
    ("frames", &["camera", "layer", "world"]),
    (
        "integrator",
        &["world", "surface", "manifold", "material", "medium", "bsdf", "light", "sampler", "film", "layer", "frames"],
    ),
    ("render", &["camera", "sampler", "integrator", "world", "film", "layer", "frames"]),
];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs"))
        .collect()
}

/// The modules named after `crate::` in a file.
fn named(text: &str) -> Vec<&str> {
    let name = |rest: &'_ str| rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
    text.split("crate::").skip(1).map(|rest| &rest[..name(rest)]).filter(|name| !name.is_empty()).collect()
}

#[test]
fn modules_use_only_what_comes_before_them() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for path in rust_files(&source) {
        let inside = path.strip_prefix(&source).unwrap();
        let module = inside.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == module) else {
            assert!(["lib", "closed_set"].contains(&module), "{module} is not in the list of layers");
            continue;
        };
        seen += 1;
        if inside.ends_with("tests.rs") {
            continue;
        }
        for used in named(&fs::read_to_string(&path).unwrap()) {
            let fine = used == module || allowed.contains(&used);
            assert!(fine, "{} uses `{used}`, which lies ahead of `{module}`", inside.display());
        }
    }
    assert!(seen > 30, "the source was not found");
}
