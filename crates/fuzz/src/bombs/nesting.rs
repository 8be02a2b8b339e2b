//! Bombs of deep nesting: groups, objects, materials, textures, includes, expressions and plain
//! JSON.

use super::{Bomb, Content, objects};

const CLASS: &str = "nesting";

fn scene(name: &str, text: impl Into<Vec<u8>>, must_name: &str) -> Bomb {
    Bomb::from_scene(CLASS, name, text, must_name)
}

/// `depth` groups, each of which places the next one `times` times.
fn tower(depth: usize, times: usize) -> String {
    let member = |number: usize| match number + 1 {
        next if next == depth => r#"{"shape": "sphere"}"#.to_owned(),
        next => format!(r#"{{"group": "g{next}"}}"#),
    };
    let groups = (0..depth).map(|number| format!(r#""g{number}": [{}]"#, vec![member(number); times].join(",")));
    let groups = groups.collect::<Vec<_>>().join(",");
    format!(r#"{{"version": 1, "groups": {{{groups}}}, "objects": [{{"group": "g0"}}]}}"#)
}

fn nested(open: &str, inner: &str, close: &str, depth: usize) -> String {
    format!("{}{inner}{}", open.repeat(depth), close.repeat(depth))
}

pub fn bombs() -> Vec<Bomb> {
    let deep = |depth| nested(r#"{"objects": ["#, r#"{"shape": "sphere"}"#, "]}", depth);
    let radius = |text: &str| objects(&format!(r#"{{"shape": {{"sphere": {{"radius": "={text}"}}}}}}"#));
    let material = nested(r#"{"checkerboard": {"odd": {"phong": {}}, "even": "#, r#"{"phong": {}}"#, "}}", 60);
    let texture = (0..100).map(|n| format!(r#""t{n}": {{"scale": {{"input": "t{}", "factor": 1}}}}"#, n + 1));
    let texture = texture.collect::<Vec<_>>().join(",");
    let mut found = vec![
        scene("groups 70 deep", tower(70, 1), "group"),
        scene("groups 10,000 deep", tower(10_000, 1), "group"),
        scene("groups of ten times groups, 12 deep", tower(12, 10), "objects"),
        scene("groups of groups, 63 deep, twice each", tower(63, 2), "objects"),
        scene("objects within objects, 25 deep", objects(&deep(25)), "deep"),
        scene("objects within objects, 10,000 deep", objects(&deep(10_000)), "deep"),
        scene("a million brackets", "[".repeat(1_000_000), "bomb.json"),
        scene("a million objects that are open", "{\"a\":".repeat(1_000_000), "bomb.json"),
        scene("materials 60 deep", objects(&format!(r#"{{"shape": "sphere", "material": {material}}}"#)), "material"),
        scene(
            "textures 100 deep",
            format!(r#"{{"version": 1, "textures": {{{texture}}}, "objects": []}}"#),
            "textures",
        ),
        scene("1,000 parentheses", radius(&nested("(", "1", ")", 1_000)), "radius"),
        scene("1,000 signs", radius(&nested("-", "1", "", 1_000)), "radius"),
        scene("500 powers", radius(&nested("2^", "2", "", 500)), "radius"),
        scene("500 functions", radius(&nested("sin(", "1", ")", 500)), "radius"),
        scene("an expression of a million bytes", radius(&nested("1+", "1", "", 500_000)), "radius"),
        scene(
            "a group of itself",
            r#"{"version": 1, "groups": {"a": [{"group": "a"}]}, "objects": [{"group": "a"}]}"#,
            "a",
        ),
        scene("a scene that includes itself", r#"{"version": 1, "include": ["bomb.json"]}"#, "bomb.json"),
    ];
    let mut chain = scene("2,000 includes in a chain", r#"{"version": 1, "include": ["0.json"]}"#, "include");
    for number in 0..2_000 {
        let text = format!(r#"{{"version": 1, "include": ["{}.json"]}}"#, number + 1);
        chain = chain.with_file(&format!("{number}.json"), Content::Bytes(text.into()));
    }
    found.push(chain);
    found
}
