//! Bombs of animation: keys, shutter times, expressions and frames.

use super::{Bomb, objects};

const CLASS: &str = "times";

fn scene(name: &str, text: impl Into<Vec<u8>>, must_name: &str) -> Bomb {
    Bomb::from_scene(CLASS, name, text, must_name)
}

fn animated(animation: &str, radius: &str) -> String {
    format!(
        r#"{{"version": 1, "animation": {animation}, "objects": [{{"shape": {{"sphere": {{"radius": {radius}}}}}}}]}}"#
    )
}

pub fn bombs() -> Vec<Bomb> {
    let radius = |text: &str| objects(&format!(r#"{{"shape": {{"sphere": {{"radius": {text}}}}}}}"#));
    let keys = |keys: &str| radius(&format!(r#"{{"animate": {{"keys": {keys}, "repeat": "loop"}}}}"#));
    let many: Vec<String> = (0..200_000).map(|at| format!("[{at}, 1]")).collect();
    let points = vec!["[0, 0, 0]"; 10_001].join(",");
    let path =
        format!(r#"{{"version": 1, "paths": {{"p": {{"points": [{points}]}}}}, "objects": [{{"shape": "sphere"}}]}}"#);
    let variables: Vec<String> = (0..1_000).map(|n| format!(r#""v{}": "v{n} + v{n}""#, n + 1)).collect();
    let variables = format!(
        r#"{{"version": 1, "variables": {{"v0": 1, {}}}, "objects": [{{"shape": "sphere"}}]}}"#,
        variables.join(",")
    );
    let line = |line: &str, must_name: &str| Bomb::from_command_line(CLASS, line, must_name);
    vec![
        scene("keys at the ends of time", keys("[[-1e308, 1], [1e308, 2]]"), "keys"),
        scene("keys at one time", keys("[[0, 1], [0, 2], [0, 3]]"), "keys"),
        scene("keys that turn back", keys("[[1, 1], [0, 2]]"), "keys"),
        scene("a loop of no length", keys("[[0, 1], [1e-300, 2]]"), "keys"),
        scene("200,000 keys", keys(&format!("[{}]", many.join(","))), "keys"),
        scene("10,001 points of a path", path, "path"),
        scene("1,000 variables that double", variables, "variables"),
        scene("frame to the frame to the frame", radius(r#""=(frame + 99)^(frame + 99)^(frame + 99)""#), "radius"),
        scene("a division by no time", radius(r#""=1 / seconds""#), "radius"),
        scene("an endless pace", animated(r#"{"frames": 2, "frames_per_second": 1e308}"#, "1"), "frames_per_second"),
        scene("no pace", animated(r#"{"frames": 2, "frames_per_second": 1e-308}"#, "1"), "frames_per_second"),
        scene("an endless shutter", animated(r#"{"frames": 2, "shutter": 1e30}"#, r#""=1 + frame / 9""#), "shutter"),
        line("render good.json --frame 4294967295 -o a.png --size 8x8", "frame"),
        line("render good.json --at 1e308 -o a.png --size 8x8", "--at"),
        line("render good.json --at nan -o a.png --size 8x8", "--at"),
        line("render good.json --noise 1e-300 --time 1 -o a.png --size 8x8", "--noise"),
    ]
}
