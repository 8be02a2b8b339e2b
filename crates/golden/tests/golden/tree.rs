//! Rules of the source tree: short files, `unsafe` in few places, and free licenses.

use juggler_golden::rust_files;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Maximum number of lines of a source file, tests included.
const MAX_LINES: usize = 400;

/// Maximum size of a committed file, in bytes.
const MAX_BYTES: u64 = 1_500_000;

/// The only files that contain `unsafe`, relative to `crates`.
const UNSAFE: &[&str] =
    &["bvh/benches/embree/ffi.rs", "bvh/src/lanes.rs", "bvh/src/pages.rs", "bvh/src/stack.rs", "oidn/src/ffi.rs"];

/// Package and program that a plain `cargo run` runs, which is the README's first command.
const PROGRAM: [&str; 2] = ["juggler-cli", "juggler"];

/// Licenses that the project's users can accept (SPDX; of an expression with alternatives one
/// suffices).
const LICENSES: &[&str] = &[
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "0BSD",
    "CC0-1.0",
    "Unlicense",
    "Unicode-3.0",
    "BSL-1.0",
    "MIT-0",
    "IJG",
    "Apache-2.0 WITH LLVM-exception",
    // As permissive as the BSD licenses; used by a fuzzer that a dependency names and no build
    // includes.
    "NCSA",
    // For typefaces: they may be part of any program, but not be sold alone.
    "OFL-1.1",
    "Ubuntu-font-1.0",
];

/// Root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn no_source_file_is_long() {
    let files = rust_files(&root().join("crates"));
    assert!(files.len() > 50, "the source was not found");
    let long: Vec<String> = files
        .iter()
        .map(|path| (path, std::fs::read_to_string(path).unwrap().lines().count()))
        .filter(|(_, lines)| *lines > MAX_LINES)
        .map(|(path, lines)| format!("{}: {lines} lines", path.display()))
        .collect();
    assert!(long.is_empty(), "over {MAX_LINES} lines:\n{}", long.join("\n"));
}

#[test]
fn no_committed_file_is_large() {
    let list = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output().unwrap();
    let names = String::from_utf8(list.stdout).unwrap();
    let names: Vec<&str> = names.split_terminator('\0').collect();
    assert!(names.len() > 50, "git lists no files: {}", String::from_utf8_lossy(&list.stderr));
    for name in names {
        // A file that is deleted but not yet committed has no size.
        let bytes = std::fs::metadata(root().join(name)).map_or(0, |file| file.len());
        assert!(bytes <= MAX_BYTES, "{name}: {bytes} bytes, over {MAX_BYTES}");
    }
}

#[test]
fn unsafe_is_only_in_the_listed_files() {
    let crates = root().join("crates");
    let own = crates.join("golden/tests/golden/tree.rs");
    let lifted = |path: &Path| path != own && std::fs::read_to_string(path).unwrap().contains("unsafe_code");
    let mut found: Vec<String> = rust_files(&crates)
        .iter()
        .filter(|path| lifted(path))
        .map(|path| path.strip_prefix(&crates).unwrap().display().to_string())
        .collect();
    found.sort();
    assert_eq!(found, UNSAFE, "files that lift the lint");
    for entry in std::fs::read_dir(&crates).unwrap() {
        let folder = entry.unwrap().path();
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let strict = manifest.contains("[lints]\nworkspace = true\n");
        let denies = manifest.contains("[lints.rust]\nunsafe_code = \"deny\"\n");
        let lifts = folder.ends_with("bvh") || folder.ends_with("oidn");
        assert!(if lifts { denies } else { strict }, "lints of {}", folder.display());
    }
    let workspace = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    assert!(workspace.contains("[workspace.lints.rust]\nunsafe_code = \"forbid\"\n"));
}

/// Files that open other files directly: the module by which every reader opens its input, those
/// that read from the system or what the program itself wrote, tests and measurements.
const OPENERS: &[&str] = &[
    "bvh/benches/traverse.rs",
    "cli/src/command/render/folder.rs",
    "cli/src/interrupt.rs",
    "cli/src/output.rs",
    "cli/src/stats.rs",
    "denoise/examples/evaluate.rs",
    "fuzz/src/bombs/run.rs",
    "fuzz/src/seeds.rs",
    "imaging/src/regular.rs",
    "juggler/benches/edits.rs",
    "juggler/benches/instances.rs",
    "juggler/benches/models.rs",
];

/// Opening a named pipe blocks until another program writes to it, so readers open their input by
/// `imaging::regular::open`.
#[test]
fn input_is_opened_in_one_place() {
    let crates = root().join("crates");
    let opens = |path: &Path| {
        let text = std::fs::read_to_string(path).unwrap();
        let code = text.split("\n#[cfg(test)]").next().unwrap_or_default();
        ["File::open(", "fs::read(", "fs::read_to_string("].iter().any(|call| code.contains(call))
    };
    let name = |path: &PathBuf| path.strip_prefix(&crates).unwrap().display().to_string();
    let is_test = |name: &str| name.contains("/tests/") || name.ends_with("tests.rs");
    let files = rust_files(&crates).into_iter().filter(|path| opens(path));
    let mut found: Vec<String> = files.map(|path| name(&path)).filter(|name| !is_test(name)).collect();
    found.sort();
    assert_eq!(found, OPENERS, "files that open files");
}

#[test]
fn every_dependency_has_an_accepted_license() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 20);
    let unfit: Vec<String> = packages
        .iter()
        .filter(|package| !is_accepted(package["license"].as_str().unwrap_or_default()))
        .map(|package| format!("{} {}: {}", package["name"], package["version"], package["license"]))
        .collect();
    assert!(unfit.is_empty(), "licenses that are not on the list:\n{}", unfit.join("\n"));
}

#[test]
fn cargo_run_runs_the_program() {
    let manifests = std::fs::read_dir(root().join("crates")).unwrap().map(|entry| entry.unwrap().path());
    let declared = manifests.filter_map(|folder| {
        let text = std::fs::read_to_string(folder.join("Cargo.toml")).ok()?;
        let value = |key: &str| {
            text.lines().find_map(|line| line.strip_prefix(key)?.trim().strip_prefix("= ").map(str::to_owned))
        };
        value("default-run").map(|run| [value("name").unwrap_or_default(), run].map(|word| word.replace('"', "")))
    });
    let declared: Vec<[String; 2]> = declared.collect();
    assert_eq!(declared, [PROGRAM.map(str::to_owned)], "one default-run, for `cargo run` takes no other");
}

/// A package that the release profile does not list is hardly optimized.
#[test]
fn the_release_profile_lists_every_package() {
    let workspace = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let profile = workspace.split("[profile.release.package]\n").nth(1).unwrap().split("\n[").next().unwrap();
    for entry in std::fs::read_dir(root().join("crates")).unwrap() {
        let manifest = std::fs::read_to_string(entry.unwrap().path().join("Cargo.toml")).unwrap();
        let name = manifest.lines().find_map(|line| line.strip_prefix("name = ")).unwrap().trim_matches('"');
        assert!(profile.lines().any(|line| line.starts_with(&format!("{name} = "))), "{name}");
    }
}

/// Whether a license expression is acceptable: one of its alternatives, or all of its requirements.
fn is_accepted(expression: &str) -> bool {
    let expression = expression.replace('/', " OR ");
    split(&expression, " OR ").iter().any(|all| {
        split(all, " AND ").iter().all(|one| {
            let one = one.trim();
            match one.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')) {
                Some(inner) => is_accepted(inner),
                None => LICENSES.contains(&one),
            }
        })
    })
}

/// Splits at a word outside of parentheses.
fn split<'a>(text: &'a str, word: &str) -> Vec<&'a str> {
    let (mut parts, mut start, mut depth) = (Vec::new(), 0, 0);
    for (at, character) in text.char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ if depth == 0 && text[at..].starts_with(word) => {
                parts.push(&text[start..at]);
                start = at + word.len();
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

#[test]
fn the_license_check_can_fail() {
    assert!(is_accepted("MIT OR GPL-3.0-only") && is_accepted("MIT/Apache-2.0") && is_accepted("MIT AND ISC"));
    assert!(is_accepted("(MIT OR Apache-2.0) AND Unicode-3.0") && !is_accepted("(MIT OR Apache-2.0) AND GPL-3.0-only"));
    assert!(!is_accepted("GPL-3.0-only") && !is_accepted("MIT AND AGPL-3.0-only") && !is_accepted(""));
}
