//! Retired words: names and phrases that gave way to the field's terms do not come back.
//! CONTRIBUTING lists the terms.
//!
//! A phrase is a sequence of words; `a|b` matches either word, and `*` matches any one word.
//! Capitals do not matter. Line breaks, comment marks, hyphens and underscores separate words, so
//! that a phrase is also found in `snake_case`; other punctuation ends a phrase. Words that are
//! plain English elsewhere are retired together with their context.

use crate::tree::root;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::process::Command;

/// A retired name or phrase and its replacement.
struct Retired {
    pattern: &'static str,
    instead: &'static str,
    /// Parts of the paths of the files for which the rule holds; all files if empty.
    within: &'static [&'static str],
    /// Parts of the paths of the files in which the word means something else.
    except: &'static [&'static str],
}

impl Retired {
    const fn within(self, within: &'static [&'static str]) -> Self {
        Self { within, ..self }
    }

    const fn except(self, except: &'static [&'static str]) -> Self {
        Self { except, ..self }
    }

    fn holds_for(&self, file: &str) -> bool {
        let named = |parts: &[&str]| parts.iter().any(|part| file.contains(part));
        (self.within.is_empty() || named(self.within)) && !named(self.except)
    }
}

const fn retired(pattern: &'static str, instead: &'static str) -> Retired {
    Retired { pattern, instead, within: &[], except: &[] }
}

/// The page that lists the retired words.
const LIST: &[&str] = &["CONTRIBUTING.md"];

/// That page, and the one that names values of JSON that changed.
const HISTORY: &[&str] = &["CONTRIBUTING.md", "CHANGELOG.md"];

/// Crates and pages about light transport.
const TRANSPORT: &[&str] = &[
    "crates/bsdf/",
    "crates/integrator/",
    "crates/light/",
    "crates/material/",
    "crates/render/",
    "crates/world/",
    "docs/decisions/",
    "docs/light-sampling.md",
    "docs/aovs.md",
    "docs/probe.md",
];

/// Identifiers that code does not use.
const NAMES: &[Retired] = &[
    retired("Trail", "PathHistory, PathRef"),
    // A row of spheres in a scene keeps the name.
    retired("Chain", "CausticState").except(&["crates/scene/", "/prelude.rs"]),
    retired("Emit", "VertexOutput"),
    retired("Harvest", "PathBuffers"),
    // The factor of a light group in an editing session keeps the name.
    retired("Gain", "ShadowContribution").within(TRANSPORT),
    retired("Bent", "BentShadowRay"),
    retired("Seen", "ShadingPoint"),
    retired("Sight", "SurfaceHit, FirstHit"),
    retired("Shade", "Shading"),
    retired("Lighting", "EmitterSample"),
    // One end of a channel between threads has the name in the standard library.
    retired("Receiver", "LightSampleContext").within(TRANSPORT),
    retired("Prospect", "VisibleCasters"),
    retired("Caster", "CausticCaster"),
    retired("Way", "PathKind, SpecularPath"),
    retired("way", "direction, distance, path"),
    retired("ways", "paths, directions"),
    retired("Facing", "EmissionProfile"),
    retired("Finder", "WorldToFilm"),
    retired("Shot", "ShutterCamera"),
    retired("shot", "camera"),
    retired("carried", "reproject"),
    retired("expose", "render_film"),
    retired("Level", "Geometry").within(&["crates/world/", "crates/render/", "crates/integrator/"]),
    retired("Placed", "Instance"),
    retired("Standing", "WorldShape"),
    retired("measure", "ray_differentials").within(&["crates/world/src/differential"]),
    retired("fades_patterns", "filters_textures"),
    retired("agree", "same_hemisphere"),
    retired("fun", "portable"),
    retired("Studio", "FrameCache").except(&[
        "light/src/background/",
        "scene/src/",
        "juggler/src/stage.rs",
        "juggler/tests/integration/stage.rs",
        "cli/src/",
    ]),
    retired("Reel", "Movie"),
    retired("Take", "FrameRender"),
    retired("Moment", "RenderStart"),
    retired("Course", "FrameProgress"),
    retired("Draft", "Preview"),
    retired("Toner", "DisplayTransform"),
    retired("Desk", "Mailbox"),
    retired("Board", "Compositor"),
    retired("Sheet", "Framebuffer"),
    retired("Lamp", "SceneLight"),
    retired("worth", "weight"),
];

/// Names of modules that say too little about their content.
const MODULES: &[Retired] = &[
    retired("trail", "path_history"),
    retired("emit", "vertex_output"),
    retired("carried", "reproject"),
    retired("finder", "world_to_film"),
    retired("shot", "shutter_camera"),
    retired("expose", "camera_rays"),
    retired("exposed", "tile_samples"),
    // Levels of the MP4 format.
    retired("level", "geometry").except(&["animation/mp4/"]),
    retired("items", "the content"),
    retired("standing", "the content"),
    retired("large", "the content"),
    retired("merged", "the content"),
    retired("fun", "portable"),
    retired("studio", "frame_cache").except(&["light/src/background/"]),
    retired("reel", "movie"),
    retired("board", "compositor"),
    retired("glue", "framebuffer"),
    retired("films", "movies"),
    retired("layers", "aovs"),
];

/// Phrases that no name, comment, page or message uses.
const PHRASES: &[Retired] = &[
    // A key of `juggler info --json` keeps the name.
    retired("far light|lights", "infinite lights").except(&[
        "CONTRIBUTING.md",
        "command/info.rs",
        "program/answers.rs",
    ]),
    retired("glow|glows|glowing|shine|shines|shining|shone", "emit, emitting").except(HISTORY),
    // Furniture, the light source of a measured luminaire, and objects of a scene.
    retired("lamp|lamps", "light, emitter").except(&[
        "CONTRIBUTING.md",
        "meshes/classroom.rs",
        "photometry.rs",
        "docs/probe.md",
    ]),
    retired("asked", "light-sampled, requested").except(HISTORY),
    retired("path|paths ask|asks", "sample"),
    retired("ask|asks for light|lights", "sample"),
    // Criteria and targets are met.
    retired("met", "BSDF-sampled, hit").except(&[
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "render/src/progressive.rs",
        "docs/benchmarks.md",
        "docs/notes/",
    ]),
    retired("told", "reported"),
    retired("worth little|of|more|less", "weight, throughput"),
    retired("what * is worth", "weight"),
    // A key of `juggler probe --json`, and the verb.
    retired("stretches", "segments").except(&[
        "probe/shares.rs",
        "juggler/_probe.py",
        "texture/src/triplanar.rs",
        "docs/benchmarks.md",
    ]),
    retired("stretch of a|the path|light", "segment"),
    retired("by way of", "through, by"),
    retired("way|ways of the|a light|path", "path"),
    retired("ways to the|a light", "paths"),
    retired("both|all ways", "paths, techniques, directions"),
    retired("thing|things", "object").except(&["CONTRIBUTING.md", "README.md"]),
    retired("gap|gaps|hole|holes", "opacity").within(TRANSPORT),
    retired("border|borders", "interface").within(TRANSPORT),
    retired("film of * frames|seconds|minutes", "movie"),
    retired("film's length|frames|encoder|frame", "movie"),
    retired("frame|frames|length of a|the film", "movie"),
    retired("films as|into|with|in", "movies"),
    retired("moving picture|pictures", "movie").except(LIST),
    retired("film part|parts", "partial render"),
    retired("part|parts of a|the picture|pictures|image", "partial render, shard").except(LIST),
    retired("layer|layers beside|of the|a picture", "AOVs"),
    retired("aov layer|layers", "AOVs"),
    retired("looks of", "display looks"),
    retired("historic look|looks", "display look"),
    // Objects of a scene.
    retired("ball|balls", "specular sphere, sphere").within(TRANSPORT).except(&["docs/probe.md"]),
    retired("polished ball|balls", "specular sphere"),
    // The matte of Cryptomatte, and an author's name.
    retired("matte|matt", "diffuse").except(&["CONTRIBUTING.md", "cryptomatte.rs", "tone/aces.rs"]),
    retired("mirrored light|radiance|ray|rays|direction|path|paths|color|share|shares", "reflected"),
    retired("give|gives|gave off", "emit").except(LIST),
    retired("throw|throws|thrown|threw light|caustic|caustics|shadow|shadows|its|soft|nothing|at|onto", "cast"),
    retired("what shines", "emitting").except(HISTORY),
    retired("kept apart with", "light group"),
    retired("what lies between", "the subject's noun"),
    retired("is told that", "receives"),
];

/// A line without the raw strings that end in it.
fn without_raw_strings(line: &str) -> String {
    let mut pieces = line.split("r#\"");
    let first = pieces.next().unwrap_or_default().to_owned();
    pieces.fold(first, |code, rest| code + rest.split_once("\"#").map_or("", |(_, after)| after))
}

/// Code of a file without comments and strings.
fn code(text: &str) -> String {
    let line = |line: &str| {
        let line = without_raw_strings(line).replace("\\\"", "");
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

/// Uses of retired names in the code of a Rust file.
fn names_in(file: &str, text: &str) -> Vec<String> {
    let code = code(text);
    let words: HashSet<&str> = code.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let used = NAMES.iter().filter(|name| words.contains(name.pattern) && name.holds_for(file));
    used.map(|name| format!("{file}: `{}`, instead of {}", name.pattern, name.instead)).collect()
}

/// Use of a retired name by a module.
fn module_in(file: &str) -> Option<String> {
    let parts = file.trim_end_matches(".rs").split('/');
    let module = MODULES.iter().find(|module| parts.clone().any(|part| part == module.pattern))?;
    module.holds_for(file).then(|| format!("{file}: module `{}`, instead of {}", module.pattern, module.instead))
}

/// Words of a text in lower case with their lines. Punctuation that ends a phrase is a word, too.
fn words(text: &str) -> Vec<(usize, String)> {
    let mut words = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut word = String::new();
        for c in line.chars().chain([' ']) {
            if c.is_alphanumeric() || c == '\'' && !word.is_empty() {
                word.extend(c.to_lowercase());
                continue;
            }
            if !word.is_empty() {
                words.push((number + 1, std::mem::take(&mut word)));
            }
            if ".,;:?!(){}[]\"|".contains(c) {
                words.push((number + 1, c.to_string()));
            }
        }
    }
    words
}

/// Whether words begin with a phrase.
fn begins_with(words: &[(usize, String)], phrase: &str) -> bool {
    let mut words = words.iter().map(|(_, word)| word.trim_end_matches('\''));
    let is_match = |pattern: &str, word: &str| pattern == "*" || pattern.split('|').any(|other| other == word);
    phrase.split(' ').all(|pattern| words.next().is_some_and(|word| is_match(pattern, word)))
}

/// Uses of retired phrases in a text.
fn phrases_in(file: &str, text: &str) -> Vec<String> {
    let mut by_first = HashMap::<&str, Vec<&Retired>>::new();
    for phrase in PHRASES.iter().filter(|phrase| phrase.holds_for(file)) {
        for first in phrase.pattern.split(' ').next().unwrap_or_default().split('|') {
            by_first.entry(first).or_default().push(phrase);
        }
    }
    let words = words(text);
    let mut found = Vec::new();
    for (place, (line, word)) in words.iter().enumerate() {
        let phrases = by_first.get(word.trim_end_matches('\'')).into_iter().flatten();
        for phrase in phrases.filter(|phrase| begins_with(&words[place..], phrase.pattern)) {
            found.push(format!("{file}:{line}: \"{}\", instead of {}", phrase.pattern, phrase.instead));
        }
    }
    found
}

/// Comments, title and description of a scene file; names of its objects are free.
fn scene_prose(text: &str) -> String {
    let prose = |line: &str| {
        let is_prose =
            ["//", "\"title\":", "\"description\":"].iter().any(|start| line.trim_start().starts_with(start));
        if is_prose { line.to_owned() } else { String::new() }
    };
    text.lines().map(prose).collect::<Vec<_>>().join("\n")
}

/// Files of the project with prose or code, relative to the root.
fn files(root: &Path) -> Vec<String> {
    let list = ["ls-files", "--cached", "--others", "--exclude-standard", "-z"];
    let list = Command::new("git").args(list).current_dir(root).output().unwrap();
    let names = String::from_utf8(list.stdout).unwrap();
    let endings = ["rs", "md", "sh", "py", "mjs", "js", "html", "json"];
    let is_text = |name: &str| {
        let ending = name.rsplit_once('.').map(|(_, ending)| ending);
        name == ".ci/run" || ending.is_some_and(|ending| endings.contains(&ending))
    };
    // The list of retired words itself, lists of other programs' words, what is generated from
    // the code, and packages of others.
    let others = ["golden/words.rs", "docs/names.md", "docs/scene-format.md", "schema/", "package-lock.json"];
    let is_own = |name: &str| !others.iter().any(|other| name.contains(other));
    names.split_terminator('\0').filter(|name| is_text(name) && is_own(name)).map(str::to_owned).collect()
}

#[test]
fn retired_words_do_not_come_back() {
    let root = root();
    let files = files(&root);
    assert!(files.len() > 500, "git lists {} files", files.len());
    let mut found = Vec::new();
    for file in &files {
        // A file that is deleted but not yet committed has no text.
        let Ok(text) = std::fs::read_to_string(root.join(file)) else { continue };
        if file.ends_with(".rs") {
            found.extend(names_in(file, &text));
            found.extend(module_in(file));
        }
        let prose = if file.ends_with(".json") { scene_prose(&text) } else { text };
        found.extend(phrases_in(file, &prose));
    }
    assert!(found.is_empty(), "{} retired words:\n{}", found.len(), found.join("\n"));
}

#[test]
fn the_search_finds_names_and_phrases() {
    let text = "fn way() {} // A far\n// light, worth\n// little. \"worth\"\nlet s = \"Trail\";";
    assert_eq!(names_in("a.rs", text), ["a.rs: `way`, instead of direction, distance, path"]);
    let light = "a.rs:1: \"far light|lights\", instead of infinite lights";
    let weight = "a.rs:2: \"worth little|of|more|less\", instead of weight, throughput";
    assert_eq!(phrases_in("a.rs", text), [light, weight]);
    assert_eq!(phrases_in("a.rs", "a far, light; a film of 30 frames").len(), 1);
    assert_eq!(
        module_in("crates/a/src/items/mod.rs").unwrap(),
        "crates/a/src/items/mod.rs: module `items`, instead of the content"
    );
    assert_eq!(scene_prose("// a\n  \"lamp\": 1,\n  \"title\": \"b\","), "// a\n\n  \"title\": \"b\",");
}

#[test]
fn every_rule_can_match() {
    for rule in PHRASES {
        let example = rule.pattern.split(' ').map(|word| word.split('|').next().unwrap().replace('*', "some"));
        let example = example.collect::<Vec<_>>().join(" ");
        assert!(begins_with(&words(&example), rule.pattern), "{}", rule.pattern);
    }
}
