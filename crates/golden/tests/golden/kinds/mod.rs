//! Checks that a new kind of any family is one file and two lines: adds kinds to a copy of the
//! source, which must compile and render like the kinds that they were copied from.

mod families;

use families::{Addition, EDIT, FAMILIES, FLAG};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Number of lines that a new kind adds to existing files.
const LINES: usize = 2;
/// Maximum number of lines of a new flag, and of a new edit, beside their documentation.
const SMALL_LINES: usize = 4;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Folder of the copied source, below Cargo's folder for test files.
fn scratch() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("kinds")
}

/// Writes a file unless it has that content already, so that Cargo does not rebuild unchanged
/// files.
fn write(path: &Path, content: &[u8]) {
    if fs::read(path).is_ok_and(|old| old == content) {
        return;
    }
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, content).unwrap();
}

/// Collects the paths of all files below a folder, relative to `root`, except build output.
fn files(root: &Path, folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(root.join(folder)).unwrap() {
        let entry = entry.unwrap();
        let path = folder.join(entry.file_name());
        let is_built = ["target", "node_modules"].iter().any(|name| entry.file_name() == *name);
        match entry.file_type().unwrap() {
            kind if kind.is_dir() && !is_built => files(root, &path, found),
            kind if kind.is_file() => found.push(path),
            _ => {}
        }
    }
}

/// Copies the source to the scratch folder, adds kinds and further lines with their files. Removes
/// files of an earlier copy that are neither.
fn copy_with(additions: &[&Addition], lines: &[(&str, &str)]) {
    let mut paths: Vec<PathBuf> = ["Cargo.toml", "Cargo.lock"].map(PathBuf::from).to_vec();
    for folder in ["crates", "scenes", "schema"] {
        files(&root(), Path::new(folder), &mut paths);
    }
    remove_others(&paths.iter().cloned().chain(additions.iter().map(|addition| addition.new_file())).collect());
    let mut pages: Vec<(PathBuf, String)> = additions.iter().flat_map(|addition| addition.pages()).collect();
    pages.extend(lines.iter().map(|(file, line)| (PathBuf::from(file), (*line).to_owned())));
    for path in paths {
        let text = fs::read(root().join(&path)).unwrap();
        let added: Vec<&String> = pages.iter().filter(|(page, _)| *page == path).map(|(_, line)| line).collect();
        if added.is_empty() {
            write(&scratch().join(&path), &text);
            continue;
        }
        let mut text = String::from_utf8(text).unwrap();
        for line in added {
            insert(&mut text, line, &path);
        }
        write(&scratch().join(&path), text.as_bytes());
    }
    for addition in additions {
        write(&scratch().join(addition.new_file()), addition.source(&root()).as_bytes());
    }
}

/// Removes all other files of the scratch folder, and the folders that become empty.
fn remove_others(paths: &BTreeSet<PathBuf>) {
    let mut old = Vec::new();
    for folder in ["crates", "scenes", "schema"].map(Path::new).into_iter().filter(|f| scratch().join(f).exists()) {
        files(&scratch(), folder, &mut old);
    }
    for path in old.into_iter().filter(|path| !paths.contains(path)) {
        fs::remove_file(scratch().join(&path)).unwrap();
        let folders = path.ancestors().skip(1);
        folders.take_while(|folder| fs::remove_dir(scratch().join(folder)).is_ok()).for_each(drop);
    }
}

/// Inserts one line. `rule` consists of the line, ` <- `, and the text of the line that it follows.
fn insert(text: &mut String, rule: &str, page: &Path) {
    let (line, after) = rule.split_once(" <- ").unwrap();
    let at = text.find(after).unwrap_or_else(|| panic!("{} has no `{after}`", page.display()));
    let end = at + text[at..].find('\n').unwrap() + 1;
    text.insert_str(end, &format!("{line}\n"));
}

/// Runs Cargo in the scratch folder.
fn cargo(arguments: &[&str]) {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(scratch()).args(arguments).args(["--offline", "--locked", "--quiet"]);
    command.env("CARGO_TARGET_DIR", scratch().join("target")).env_remove("RUSTFLAGS");
    let output = command.output().unwrap();
    assert!(output.status.success(), "cargo {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_new_kind_is_one_file_and_two_lines() {
    for addition in FAMILIES {
        assert_eq!(addition.pages().len(), LINES, "{}", addition.family);
    }
    assert!(FLAG.len() <= SMALL_LINES && EDIT.len() <= SMALL_LINES);
    if std::env::var("JUGGLER_KINDS").as_deref() == Ok("all") {
        copy_with(&FAMILIES.iter().collect::<Vec<_>>(), &[FLAG, EDIT].concat());
        cargo(&["build", "-p", "juggler-cli", "--no-default-features"]);
        new_kinds_render_as_the_old_ones();
        new_flags_act();
        cargo(&["check", "-p", "juggler-serve"]);
    } else {
        let two = ["lobe", "shape"].map(|family| FAMILIES.iter().find(|a| a.family == family).unwrap());
        copy_with(&two, &[]);
        cargo(&["check", "-p", "juggler-bsdf", "-p", "juggler-shape"]);
    }
}

/// The new flag silences a render, and a merge refuses it.
fn new_flags_act() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| {
        let mut command = Command::new(scratch().join("target/debug/juggler"));
        command.current_dir(folder.path()).args(words).output().unwrap()
    };
    let render = ["render", "juggler", "--size", "8x6", "--samples", "1", "-o", "a.png"];
    let output = run(&[&render[..], &["--calm"]].concat());
    assert!(output.status.success() && output.stdout.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!run(&render).stdout.is_empty());
    assert_eq!(run(&["merge", "a.jfilm", "-o", "b.png", "--calm"]).status.code(), Some(2));
}

/// Writes the mesh and the model of the scenes in an old and in a new format.
fn write_meshes(folder: &Path) {
    let mesh = "0 0 0  0 0 1  1 0 0\n0 0 1  1 0 1  1 0 0\n";
    let wavefront = "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\nv 1 0 1\nf 2 4 3\n";
    write(&folder.join("mesh.tri"), mesh.as_bytes());
    write(&folder.join("mesh.obj"), wavefront.as_bytes());
    let facet = |x: u32| {
        let corners = format!("vertex {x} 0 0\nvertex {} 0 0\nvertex {x} 0 1\n", x + 1);
        format!("solid {x}\nfacet normal 0 1 0\nouter loop\n{corners}endloop\nendfacet\nendsolid\n")
    };
    let solids = format!("{}{}", facet(0), facet(2));
    for name in ["two.stl", "two.solids"] {
        write(&folder.join(name), solids.as_bytes());
    }
}

/// Renders a scene of old kinds and one of new kinds; the pictures must be bit for bit the same.
fn new_kinds_render_as_the_old_ones() {
    let folder = tempfile::tempdir().unwrap();
    write_meshes(folder.path());
    let old = families::SCENE;
    let mut new = old.to_owned();
    for addition in FAMILIES {
        if let Some((before, after)) = addition.in_json {
            assert!(new.contains(before), "{before}");
            new = new.replace(before, after);
        }
    }
    assert!(!FAMILIES.iter().filter_map(|a| a.in_json).any(|(before, _)| new.contains(before)), "{new}");
    let picture = |name: &str, scene: &str| {
        write(&folder.path().join(format!("{name}.json")), scene.as_bytes());
        let mut command = Command::new(scratch().join("target/debug/juggler"));
        command.current_dir(folder.path()).args([
            "render",
            &format!("{name}.json"),
            "-o",
            &format!("{name}.pfm"),
            "-q",
        ]);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        fs::read(folder.path().join(format!("{name}.pfm"))).unwrap()
    };
    for integrator in ["\"path\"", "\"albedo\""] {
        let integrated = |scene: &str| scene.replace("INTEGRATOR", integrator);
        let flat = |scene: &str| integrated(scene).replace("\"albedo\"", "\"flat\"");
        let (old, new) = (picture("old", &integrated(old)), picture("new", &flat(&new)));
        assert!(old == new, "the new kinds render another picture");
        assert!(old.iter().skip(64).any(|byte| *byte != 0), "a black picture shows nothing");
    }
}
