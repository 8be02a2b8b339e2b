//! Retired words: names and phrases that gave way to the field's terms do not come back.
//! CONTRIBUTING lists the terms.

use crate::tree::root;
use juggler_golden::rust_files;
use std::path::{Path, PathBuf};

/// A retired word, its replacement, and the files in which the word means something else.
type Retired = (&'static str, &'static str, &'static [&'static str]);

/// Names that code does not use; each stands for a whole identifier.
const NAMES: &[Retired] = &[
    ("Trail", "PathHistory, PathRef", &[]),
    // Rows of spheres in scenes keep the name.
    (
        "Chain",
        "CausticState",
        &[
            "scene/src/description/mod.rs",
            "scene/src/description/object.rs",
            "scene/src/description/spheres.rs",
            "scene/src/lib.rs",
        ],
    ),
    ("Emit", "VertexOutput", &[]),
    ("Harvest", "PathBuffers", &[]),
    // So does the factor of a light group.
    (
        "Gain",
        "ShadowContribution",
        &[
            "cli/src/command/relight.rs",
            "serve/src/edits.rs",
            "session/src/edit.rs",
            "session/src/subject.rs",
            "session/tests/integration/lights.rs",
            "viewer/src/lights.rs",
        ],
    ),
    ("Bent", "BentShadowRay", &[]),
    ("Seen", "ShadingPoint", &[]),
    ("Sight", "SurfaceHit, FirstHit", &[]),
    ("Shade", "Shading", &[]),
    ("Lighting", "EmitterSample", &[]),
    // And one end of a channel between threads.
    (
        "Receiver",
        "LightSampleContext",
        &[
            "cli/src/command/render/movie.rs",
            "serve/src/socket/sender.rs",
            "serve/src/state.rs",
            "viewer/src/saving.rs",
        ],
    ),
    ("Prospect", "VisibleCasters", &[]),
    // A dimension of the sampler has the name.
    ("Caster", "CausticCaster", &["integrator/src/path/"]),
    ("Way", "PathKind, SpecularPath", &[]),
    ("Facing", "EmissionProfile", &[]),
    ("Finder", "WorldToFilm", &[]),
    ("Shot", "ShutterCamera", &[]),
    ("carried", "reproject", &[]),
    ("Placed", "Instance", &[]),
    ("fades_patterns", "filters_textures", &[]),
    ("agree", "same_hemisphere", &[]),
    ("fun", "portable", &[]),
    ("Studio", "FrameCache", &[]),
    ("Reel", "Movie", &[]),
    ("Take", "FrameRender", &[]),
    ("Moment", "RenderStart", &[]),
    ("Course", "FrameProgress", &[]),
    ("Draft", "Preview", &[]),
    ("Toner", "DisplayTransform", &[]),
    ("Desk", "Mailbox", &[]),
    ("Board", "Compositor", &[]),
    ("Sheet", "Framebuffer", &[]),
    ("Lamp", "SceneLight", &[]),
    ("Standing", "WorldShape", &[]),
    ("glowing", "emissive", &[]),
    ("shining", "emissive", &[]),
    ("asked", "light_sampled", &[]),
    ("told", "reported", &[]),
    ("worth", "weight", &[]),
];

/// Phrases that no comment, page or message uses.
const PHRASES: &[Retired] = &[
    ("far light", "infinite light", &["CONTRIBUTING.md"]),
    ("gives off", "emits", &["CONTRIBUTING.md"]),
    ("what shines", "emitting", &[]),
    ("asked light", "light-sampled", &[]),
    ("kept apart with", "light group", &[]),
    ("moving picture", "movie", &["CONTRIBUTING.md"]),
    ("what lies between", "the subject's noun", &[]),
    ("stretches of a path", "path segments", &[]),
    ("is told that", "receives", &[]),
    ("polished ball", "specular sphere", &[]),
];

/// Code of a file without comments and strings.
fn code(text: &str) -> String {
    let line = |line: &str| {
        let mut code = String::new();
        let mut is_string = false;
        for part in line.split("//").next().unwrap_or_default().split('"') {
            code.push_str(if is_string { " " } else { part });
            is_string = !is_string;
        }
        code
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

fn is_exempt(file: &str, exempt: &[&str]) -> bool {
    exempt.iter().any(|part| file.contains(part))
}

/// Uses of retired names in the code of a file.
fn names_in(file: &str, text: &str) -> Vec<String> {
    let code = code(text);
    let words: Vec<&str> = code.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let used = NAMES.iter().filter(|(name, _, exempt)| words.contains(name) && !is_exempt(file, exempt));
    used.map(|(name, instead, _)| format!("{file}: `{name}`, instead of {instead}")).collect()
}

/// Uses of retired phrases in a file, in which line breaks and comment marks count as spaces.
fn phrases_in(file: &str, text: &str) -> Vec<String> {
    let words = text.split(|c: char| c.is_whitespace() || c == '/' || c == '!').filter(|word| !word.is_empty());
    let text = words.collect::<Vec<_>>().join(" ").to_lowercase();
    let used = PHRASES.iter().filter(|(phrase, _, exempt)| text.contains(phrase) && !is_exempt(file, exempt));
    used.map(|(phrase, instead, _)| format!("{file}: \"{phrase}\", instead of {instead}")).collect()
}

/// Markdown pages in a folder and the folders in it, but the history of the project.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_history = |path: &Path| path.ends_with("notes") || path.ends_with("CHANGELOG.md");
    let found = entries.filter(|path| !is_history(path)).flat_map(|path| match path.is_dir() {
        true => pages(&path),
        false => Some(path).filter(|path| path.extension().is_some_and(|end| end == "md")).into_iter().collect(),
    });
    found.collect()
}

#[test]
fn retired_words_do_not_come_back() {
    let root = root();
    let name = |path: &Path| path.strip_prefix(&root).unwrap().display().to_string();
    let mut found = Vec::new();
    for path in rust_files(&root.join("crates")) {
        let (file, text) = (name(&path), std::fs::read_to_string(&path).unwrap());
        if !file.ends_with("golden/words.rs") {
            found.extend(names_in(&file, &text));
            found.extend(phrases_in(&file, &text));
        }
    }
    let own = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(|page| root.join(page));
    for path in pages(&root.join("docs")).into_iter().chain(own) {
        found.extend(phrases_in(&name(&path), &std::fs::read_to_string(&path).unwrap()));
    }
    assert!(found.is_empty(), "{} retired words:\n{}", found.len(), found.join("\n"));
}

#[test]
fn the_search_finds_names_and_phrases() {
    let text = "fn told() {} // A far\n// light. \"worth\"\nlet s = \"Trail\";";
    assert_eq!(names_in("a.rs", text), ["a.rs: `told`, instead of reported"]);
    assert_eq!(phrases_in("a.rs", text), ["a.rs: \"far light\", instead of infinite light"]);
}
