//! Bombs of strings: names of a million bytes, invalid UTF-8, and terminal control characters.

use super::{Bomb, Content, objects};

const CLASS: &str = "strings";

fn scene(name: &str, text: impl Into<Vec<u8>>, must_name: &str) -> Bomb {
    Bomb::from_scene(CLASS, name, text, must_name)
}

fn material(name: &str) -> String {
    objects(&format!(r#"{{"shape": "sphere", "material": "{name}"}}"#))
}

fn mesh(file: &str) -> String {
    objects(&format!(r#"{{"shape": {{"mesh": {{"file": "{file}"}}}}}}"#))
}

fn radius(written: &str) -> String {
    objects(&format!(r#"{{"shape": {{"sphere": {{"radius": {written}}}}}}}"#))
}

fn titled(title: &str) -> String {
    format!(r#"{{"version": 1, "title": "{title}", "objects": [{{"shape": "sphere"}}]}}"#)
}

/// Names, numbers and words of up to a million bytes.
fn long() -> Vec<Bomb> {
    let long = "x".repeat(1_000_000);
    let expression = radius(&format!("\"{}1\"", "1 + ".repeat(250_000)));
    vec![
        scene("a title of a million bytes", titled(&long), "title"),
        scene("a material that is named by a million bytes", material(&long), "material"),
        scene("a material that is named by 500,000 words", material(&"x ".repeat(500_000)), "material"),
        scene("a key of a million bytes", format!(r#"{{"version": 1, "{long}": 1}}"#), "bomb.json"),
        scene("a file that is named by a million bytes", mesh(&format!("{long}.ply")), "file"),
        scene("a number of a million digits", radius(&"1".repeat(1_000_000)), "radius"),
        scene("an expression of a million bytes without its `=`", expression, "radius"),
        scene("a comment of a million bytes", format!("// {long}\n{}", titled("a")), ""),
        Bomb::from_command_line(CLASS, format!("render {} -o a.png", "y".repeat(100_000)), "error"),
        Bomb::from_command_line(CLASS, format!("render good.json -o a.png --size {}", "y".repeat(100_000)), "--size"),
    ]
}

/// Terminal control characters, and bytes that are not UTF-8.
fn odd() -> Vec<Bomb> {
    let no_text = [titled("a").as_bytes(), b"\xff\xfe\x00"].concat();
    let broken = |name: &str, bytes: &[u8]| {
        scene(&format!("a mesh {name} with characters for terminals"), mesh(name), name)
            .with_file(name, Content::Bytes(bytes.to_vec()))
    };
    let info = |name: &str, bytes: Vec<u8>| {
        Bomb::from_command_line(CLASS, format!("info {name}"), name).with_file(name, Content::Bytes(bytes))
    };
    let picture = [b"#?RADIANCE\nCommand=\x1b[31mred\x07\n\n-Y 1 +X 1\n".as_slice(), &[1; 4]].concat();
    vec![
        scene("a name of escapes", material("\\u001b[31m\\u0007\\u0000"), "material"),
        scene("a key of escapes", r#"{"version": 1, "\u001b[2J\u0007": 1}"#, "bomb.json"),
        scene("a key of plain control characters", "{\"version\": 1, \"\u{1b}[2J\u{7}\": 1}", "bomb.json"),
        scene("a file's name with a zero in it", mesh("a\\u0000b.ply"), "file"),
        scene("half of a pair", titled("\\ud800"), "bomb.json"),
        scene("what is no UTF-8", no_text, "bomb.json"),
        scene("a text of zeros", vec![0; 100_000], "bomb.json"),
        scene("right to left", material("\u{202e}gnp.exe"), "material"),
        broken("bell.obj", b"v 0 0 \x1b[31m\x07\n"),
        broken("bell.ply", b"ply\nformat ascii 1.0\nelement \x1b[31m\x07 x\nend_header\n"),
        broken("bell.stl", b"solid a\nfacet \x1b[31m\x07\n"),
        info("bell.hdr", picture),
        info("title.json", titled("\\u001b[31m\\u0007").into_bytes()),
    ]
}

pub fn bombs() -> Vec<Bomb> {
    [long(), odd()].concat()
}
