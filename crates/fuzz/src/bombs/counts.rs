//! Bombs of huge counts: objects, instances, emitters, lights, frames, samples and pixels.

use super::{Bomb, objects};

const CLASS: &str = "counts";

fn scene(name: &str, text: impl Into<Vec<u8>>, must_name: &str) -> Bomb {
    Bomb::from_scene(CLASS, name, text, must_name)
}

/// A chain of 1,000 spheres in nested groups of ten members, `depth` levels deep.
fn emitters(depth: usize, material: &str) -> String {
    let chain = r#"{"chain": {"from": {"center": [0,0,0], "radius": 1}, "to": {"center": [0,9,0], "radius": 1}, "count": 1000}"#;
    let mut groups = vec![format!(r#""g0": [{chain}, "material": {material}}}]"#)];
    for number in 1..=depth {
        let member =
            |at: usize| format!(r#"{{"group": "g{}", "transform": [{{"translate": [{at}, 0, 0]}}]}}"#, number - 1);
        groups.push(format!(r#""g{number}": [{}]"#, (0..10).map(member).collect::<Vec<_>>().join(",")));
    }
    format!(r#"{{"version": 1, "groups": {{{}}}, "objects": [{{"group": "g{depth}"}}]}}"#, groups.join(","))
}

fn many(count: usize, one: &str) -> String {
    vec![one; count].join(",")
}

pub fn bombs() -> Vec<Bomb> {
    let light = r#"{"point": {"position": [4, 6, 4]}}"#;
    let lights =
        |count| format!(r#"{{"version": 1, "lights": [{}], "objects": [{{"shape": "sphere"}}]}}"#, many(count, light));
    let animation = |frames: &str| {
        format!(r#"{{"version": 1, "animation": {{"frames": {frames}}}, "objects": [{{"shape": "sphere"}}]}}"#)
    };
    let chain = |count: &str| {
        objects(&format!(
            r#"{{"chain": {{"from": {{"center": [0,0,0], "radius": 1}}, "to": {{"center": [0,5,0], "radius": 1}}, "count": {count}}}}}"#
        ))
    };
    let line = |line: &str, must_name: &str| Bomb::from_command_line(CLASS, line, must_name);
    vec![
        scene("a million emitting spheres in groups", emitters(3, r#"{"emissive": {}}"#), "memory"),
        scene("a thousand million emitting spheres in groups", emitters(6, r#"{"emissive": {}}"#), ""),
        scene("a thousand million spheres in groups", emitters(6, r#"{"phong": {}}"#), ""),
        scene("10^13 spheres in groups", emitters(10, r#"{"phong": {}}"#), "objects"),
        scene("a chain of 4,294,967,295", chain("4294967295"), "count"),
        scene("a chain of 1e300", chain("1e300"), "count"),
        scene("10,000 lights", lights(10_000), "lights"),
        scene("200,000 lights", lights(200_000), "memory"),
        scene("100,000 objects", objects(&many(100_000, r#"{"shape": "sphere"}"#)), "memory"),
        scene("4,294,967,295 frames", animation("4294967295"), "frames"),
        line("render good.json --frames 0..4294967295 -o a_####.png --size 8x8", "frames"),
        line("render good.json --frames 4294967294..4294967295 -o a_####.png --size 8x8", "frame"),
        line("render good.json --time 1e20 -o a.png --size 8x8", "--time"),
        line("render good.json --samples 4294967295 -o a.png --size 8x8", "--samples"),
        line("render good.json --size 65536x65536 -o a.png --max-memory 512M", "65536"),
        line("render good.json --size 4294967295x1 -o a.png", "--size"),
        line("render good.json --size 8x8 --shard 4294967294/4294967295 -o a.jfilm", "shard"),
        line("render good.json --size 8x8 --crop 4294967295,4294967295,4294967295,4294967295 -o a.png", "crop"),
    ]
}
