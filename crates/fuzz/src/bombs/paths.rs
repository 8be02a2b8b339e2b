//! Bombs of paths that are no readable files: folders, named pipes, devices, links to themselves or
//! to nothing, and files without read permission, wherever the program reads a file.

use super::{Bomb, Content};

const CLASS: &str = "places";

fn contents() -> [(&'static str, Content); 7] {
    [
        ("folder", Content::Folder),
        ("pipe", Content::Pipe),
        ("zero", Content::Link("/dev/zero".to_owned())),
        ("random", Content::Link("/dev/urandom".to_owned())),
        ("round", Content::Link("round.EXT".to_owned())),
        ("dangling", Content::Link("nowhere".to_owned())),
        ("closed", Content::Closed),
    ]
}

/// Scenes that read a file `@`, with the file's extension.
const SCENES: [(&str, &str); 5] = [
    ("json", r#"{"version": 1, "include": ["@"]}"#),
    ("ply", r#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "@"}}}]}"#),
    ("png", r#"{"version": 1, "textures": {"a": {"image": {"file": "@"}}}, "objects": [{"shape": "sphere"}]}"#),
    ("exr", r#"{"version": 1, "background": {"environment": {"file": "@"}}, "objects": [{"shape": "sphere"}]}"#),
    ("ies", r#"{"version": 1, "lights": [{"point": {"ies": {"file": "@"}}}], "objects": [{"shape": "sphere"}]}"#),
];

/// Command lines that read a file `@`, with the file's extension.
const LINES: [(&str, &str); 8] = [
    ("json", "check @"),
    ("png", "info @"),
    ("jfilm", "info @"),
    ("obj", "info @"),
    ("png", "compare @ @"),
    ("jfilm", "merge @ -o a.png"),
    ("jfilm", "render good.json --size 8x8 --samples-from @ -o a.png"),
    ("jfilm", "render good.json --size 8x8 --samples 1 --checkpoint @ -o a.png"),
];

pub fn bombs() -> Vec<Bomb> {
    let mut found = Vec::new();
    for (kind, content) in contents() {
        let at = |ending: &str| {
            let content = match &content {
                Content::Link(target) => Content::Link(target.replace("EXT", ending)),
                other => other.clone(),
            };
            (format!("{kind}.{ending}"), content)
        };
        for (ending, text) in SCENES {
            let (name, content) = at(ending);
            found.push(
                Bomb::from_scene(CLASS, format!("{name} in a scene"), text.replace('@', &name), &name)
                    .with_file(&name, content),
            );
        }
        for (ending, line) in LINES {
            let (name, content) = at(ending);
            found.push(Bomb::from_command_line(CLASS, line.replace('@', &name), &name).with_file(&name, content));
        }
    }
    found
}
