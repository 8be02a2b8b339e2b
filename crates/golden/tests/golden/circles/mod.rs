//! Circles: files of a crate that use each other, directly or through others, so that none of them
//! can be understood without all others.
//!
//! A file uses the files that define the names in its `use` lines and paths; a re-export counts as
//! the file that it leads to. `mod` lines, methods and tests do not count.

mod resolve;
mod source;

use crate::tree::root;
use juggler_golden::rust_files;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Crates whose files form no circles.
const WITHOUT_CIRCLES: &[&str] = &["cli", "mesh", "session"];

/// Files of `scene` that form circles. The list may only become shorter.
const SCENE: &str = include_str!("scene.txt");

/// Largest share of the source that a crate has, in percent, and the crates that have more.
const MAX_PERCENT: usize = 12;
const LARGE: &[&str] = &["import", "scene"];

/// Circles among the files of a folder `src`, as paths relative to it.
fn circles_in(folder: &Path) -> Vec<Vec<String>> {
    let modules = source::modules(&folder.join("lib.rs"));
    let name = |path: &PathBuf| path.strip_prefix(folder).unwrap().display().to_string();
    let circles = resolve::circles(&resolve::dependencies(&modules));
    circles.iter().map(|circle| circle.iter().map(name).collect()).collect()
}

fn crate_folder(name: &str) -> PathBuf {
    root().join("crates").join(name)
}

#[test]
fn files_of_these_crates_form_no_circles() {
    for name in WITHOUT_CIRCLES {
        let circles = circles_in(&crate_folder(name).join("src"));
        assert!(circles.is_empty(), "{name}: {circles:#?}");
    }
}

#[test]
fn circles_of_the_scene_format_only_shrink() {
    let circles = circles_in(&crate_folder("scene").join("src"));
    let found: BTreeSet<&str> = circles.iter().flatten().map(String::as_str).collect();
    let known: BTreeSet<&str> = SCENE.lines().collect();
    let new: Vec<&&str> = found.difference(&known).collect();
    assert!(new.is_empty(), "these files now form circles with others: {new:#?}");
    let gone: Vec<&&str> = known.difference(&found).collect();
    assert!(gone.is_empty(), "remove these files from circles/scene.txt: {gone:#?}");
}

/// Circles among files of a small crate, by name and text.
fn circles_of(files: &[(&str, &str)]) -> Vec<Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let file = folder.path().join(name);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, text).unwrap();
    }
    circles_in(folder.path())
}

#[test]
fn names_lead_through_re_exports_to_their_files() {
    let circle = vec![vec!["a.rs".to_owned(), "b/mod.rs".to_owned()]];
    let root = "mod a;\nmod b;\npub use a::*;\npub use b::inner::{B as C};\npub use b::b;";
    let b = "pub mod inner { pub struct B; }\npub fn b() -> u32 { super::a::A::default() }";
    for uses in ["use crate::C;", "use super::b::inner;\nfn f(_: inner::B) {}", "fn f() { let x = crate::b(); }"] {
        let a = format!("{uses}\npub struct A(u32);");
        assert_eq!(circles_of(&[("lib.rs", root), ("a.rs", &a), ("b/mod.rs", b)]), circle, "{uses}");
    }
    for uses in [
        "mod c { }",
        "use std::b;",
        "#[cfg(test)]\nmod tests { use crate::b; }",
        "fn f(x: X) { x.b(); }",
        "// use crate::b;\nconst TEXT: &str = \"crate::b\";",
    ] {
        let a = format!("{uses}\npub struct A(u32);");
        assert_eq!(circles_of(&[("lib.rs", root), ("a.rs", &a), ("b/mod.rs", b)]), Vec::<Vec<String>>::new(), "{uses}");
    }
}

#[test]
fn no_crate_is_large() {
    let lines = |name: &str| -> usize {
        let files = rust_files(&crate_folder(name));
        files.iter().map(|file| std::fs::read_to_string(file).unwrap().lines().count()).sum()
    };
    let names = std::fs::read_dir(root().join("crates")).unwrap().map(|entry| entry.unwrap().file_name());
    let crates: Vec<(String, usize)> =
        names.map(|name| name.into_string().unwrap()).map(|name| (name.clone(), lines(&name))).collect();
    let all: usize = crates.iter().map(|(_, lines)| lines).sum();
    assert!(crates.len() > 20, "the crates were not found");
    for (name, lines) in crates.iter().filter(|(name, _)| !LARGE.contains(&name.as_str())) {
        assert!(lines * 100 <= all * MAX_PERCENT, "{name} has {lines} of {all} lines");
    }
}
