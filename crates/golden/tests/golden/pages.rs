//! Paths in Markdown: every file that a page names exists. Dated notes and the changelog tell of
//! the past and are left out.

use crate::tree::root;
use std::path::Path;
use std::process::Command;

/// Pages that tell of the past.
const HISTORY: &[&str] = &["docs/notes/", "docs/benchmarks.md", "CHANGELOG.md"];

/// Extensions of files that the project has and its users have not.
const OWN: &[&str] = &["rs", "toml", "sh", "txt", "md"];

/// Names of files that stand for any name.
const PLACEHOLDERS: &[&str] = &["NAME", "FILE", "N", "torus"];

/// Names of all files that Git knows.
fn tracked() -> Vec<String> {
    let list = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output().unwrap();
    String::from_utf8(list.stdout).unwrap().split_terminator('\0').map(str::to_owned).collect()
}

/// Code spans of a page that look like paths of files of the project.
fn paths(text: &str) -> Vec<&str> {
    let is_path = |span: &&str| {
        let is_name = span.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c));
        let is_own = Path::new(span).extension().is_some_and(|ending| OWN.iter().any(|own| ending == *own));
        let stem = Path::new(span).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let is_example = PLACEHOLDERS.contains(&stem);
        is_name && is_own && !is_example && !stem.is_empty()
    };
    let spans = text.split('`').skip(1).step_by(2).map(|span| span.strip_prefix("./").unwrap_or(span));
    spans.filter(is_path).collect()
}

/// Targets of a page's links to files, without the parts of pages.
fn links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let targets = targets.map(|target| target.split('#').next().unwrap_or_default());
    targets.filter(|target| !target.is_empty() && !target.contains(':')).collect()
}

#[test]
fn pages_name_files_that_exist() {
    let files = tracked();
    let pages = files.iter().filter(|file| file.ends_with(".md") && !HISTORY.iter().any(|past| file.starts_with(past)));
    let (mut wrong, mut count) = (Vec::new(), 0);
    for page in pages {
        let Ok(text) = std::fs::read_to_string(root().join(page)) else { continue };
        // The parts of the reference are joined to a page of `docs`.
        let is_part = page.starts_with("crates/scene/src/schema/reference");
        let folder = if is_part { Path::new("docs") } else { Path::new(page).parent().unwrap() };
        for link in links(&text) {
            count += 1;
            if !root().join(folder).join(link).exists() {
                wrong.push(format!("{page}: the link to {link}"));
            }
        }
        for path in paths(&text) {
            count += 1;
            let is_end =
                |file: &&String| file.strip_suffix(path).is_some_and(|rest| rest.is_empty() || rest.ends_with('/'));
            if !files.iter().any(|file| is_end(&file)) {
                wrong.push(format!("{page}: {path}"));
            }
        }
    }
    assert!(count > 300, "the pages were not found");
    assert!(wrong.is_empty(), "no such files:\n{}", wrong.join("\n"));
}

#[test]
fn paths_of_a_page_are_code_spans_with_the_extension_of_a_source() {
    let text = "See `render/src/wavefront.rs`, `src/NAME.rs` and `models/cow.ply`, and `cargo test`; `a.rs`.";
    assert_eq!(paths(text), ["render/src/wavefront.rs", "a.rs"]);
    assert_eq!(links("[a](b/c.md#d) [e](https://f) [g](#h)"), ["b/c.md"]);
}
