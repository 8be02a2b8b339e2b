//! Ten thousand mutated scenes: each either compiles or gives an error message.

use juggler_scene::{BuiltIn, Scene, built_in_scenes};

/// Scenes that together use most of the format, to which the built-in scenes are added.
const SEEDS: [&str; 5] = [
    r##"{"version": 1, "title": "a", "animation": {"frames": 30, "frames_per_second": 25},
 "variables": {"phi": "2*pi*frame/frames", "s": "(1+cos(phi))/2"},
 "render": {"size": [64, 36], "samples": 2, "seed": 7, "integrator": {"classic": {"max_depth": 3}}, "filter": "tent"},
 "cameras": {"main": {"perspective": {"eye": [0, 2, "=6+s"], "look_at": [0, 1, 0], "vertical_fov_degrees": 40}}},
 "textures": {"board": {"checker": {"size": 0.5, "even": "#ffffff", "odd": [0, 0, 0]}}},
 "materials": {"red": {"phong": {"diffuse": "board", "specular": 0.5}}, "two": {"checkerboard": {"even": "red", "odd": {"phong": {}}}}},
 "lights": [{"point": {"position": [4, 6, 4], "intensity": 60}}, {"ambient": {"intensity": 0.1}}],
 "groups": {"pair": [{"shape": "sphere"}, {"shape": {"cuboid": {}}, "material": "two"}]},
 "objects": [{"group": "pair", "transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": "=30*s"}}]}]}"##,
    r##"{"version": 1, // a comment
 "background": "#203040", "tone": {"curve": "srgb", "exposure_stops": 1},
 "objects": [{"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [0, 5, 0], "radius": 2}, "count": 8}},
  {"limb": {"from": [0, 0, 0], "to": [0, 4, 0], "lengths": [3, 2], "plane_normal": [0, 0, 1], "counts": [4, 4], "radii": [1, 2, 1]}},
  {"objects": [{"shape": {"polygon": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0]]}}}], "material": {"phong": {"ior": 1.5}}},
  {"shape": {"mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}}},],}"##,
    r##"{"version": 1, "camera": {"orthographic": {}}, "lights": [{"spot": {"direction": [0, -1, 0]}}],
 "objects": [{"shape": {"cylinder": {"radius": 2}}, "transform": [{"matrix": [1,0,0,0,0,1,0,0,0,0,1,0]}]}]}"##,
    r##"{"version": 1, "variables": {"v": [1, "frame", {"animate": {"keys": [[0, 1], [9, 2]]}}], "w": {"joint": {"from": "=v", "to": [0, 4, 0], "lengths": [3, 2.5], "plane_normal": [0, 0, 1]}}},
 "objects": [{"shape": {"sphere": {"radius": "=v.x"}}, "transform": [{"translate": "=w"}, {"look_at": {"from": "=v", "to": [0, 9, 9]}}], "visible": "=frame >= 0"},
  {"animate": {"keys": [[0, {"shape": "sphere"}], [2, {"shape": "cuboid", "visible": false}]], "interpolation": "step"}}]}"##,
    r##"{"version": 1, "include": ["missing.json"], "objects": [{"shape": {"mesh": {"file": "cow.ply"}}}]}"##,
];

/// A scene with every form of motion.
const ANIMATED: &str = r##"{"version": 1, "animation": {"frames": 30, "frames_per_second": 25},
 "paths": {"ring": {"points": [[1, 0, 0], [0, "=1+frames/30", 1], [-1, 0, 0]], "closed": true}, "line": {"points": [[0, 0, 0], [0, 5, 0]]}},
 "variables": {"bird": {"along": {"path": "ring", "at": "=seconds / 2"}}, "t": "seconds * 2"},
 "background": {"animate": {"keys": [[0, "#102030"], [1, "#ffffff", "in_out"], [2, [0, 0, 1]]], "repeat": "ping_pong"}},
 "objects": [{"shape": "sphere", "transform": [{"translate": "=bird"}]},
  {"shape": "cuboid", "transform": [{"orient": {"animate": {"keys": [[0, [0, 0, 0, 1]], [2, {"axis": [0, 1, 0], "degrees": 90}]], "interpolation": "slerp", "repeat": "loop"}}}]},
  {"shape": {"sphere": {"radius": {"animate": {"keys": [[0, 1, [0.2, 0, 0.5, 1]], [1, 2, "step"], [3, 1], [4, 1.5]], "interpolation": "smooth", "at": "=t", "ease": "out"}}}},
   "transform": [{"translate": {"along": {"path": "line", "at": {"animate": {"keys": [[0, 0], [1, 1]]}}}}}]}]}"##;

/// Numbers and words at the limits of the format.
const EXTREMES: [&str; 24] = [
    "0",
    "-0",
    "-1",
    "1e-45",
    "1e-320",
    "3.5e38",
    "-1e308",
    "1e309",
    "4294967296",
    "18446744073709551616",
    "0.1",
    "null",
    "true",
    "\"\"",
    "\"=1/0\"",
    "\"=frame\"",
    "\"sphere\"",
    "[]",
    "{}",
    "[[[[]]]]",
    "\"#ffffff\"",
    "1000000",
    "65537",
    "\"\\ud800\"",
];

/// Random number generator SplitMix64 (Steele, Lea and Flood 2014).
pub struct Numbers(pub u64);

impl Numbers {
    pub fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}

/// Splits a JSON text into tokens: strings, numbers, words, punctuation and white space.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    let mut in_string = false;
    for c in text.chars() {
        let word = c.is_ascii_alphanumeric() || "._-+".contains(c);
        match tokens.last_mut() {
            Some(last) if in_string => last.push(c),
            Some(last) if word && last.ends_with(|l: char| l.is_ascii_alphanumeric() || "._-+".contains(l)) => {
                last.push(c);
            }
            _ => tokens.push(c.to_string()),
        }
        if c == '"' {
            in_string = !in_string;
        }
    }
    tokens
}

fn mutated(numbers: &mut Numbers, seeds: &[Vec<String>]) -> String {
    let mut parts = seeds[numbers.below(seeds.len())].clone();
    for _ in 0..=numbers.below(3) {
        let at = numbers.below(parts.len());
        let other = numbers.below(parts.len());
        match numbers.below(6) {
            0 => parts.swap(at, other),
            1 => parts[at] = EXTREMES[numbers.below(EXTREMES.len())].to_owned(),
            2 => parts[at] = parts[other].clone(),
            3 => drop(parts.remove(at)),
            4 => parts.insert(at, EXTREMES[numbers.below(EXTREMES.len())].to_owned()),
            _ => {
                let numeric: Vec<usize> =
                    (0..parts.len()).filter(|i| parts[*i].starts_with(|c: char| c.is_ascii_digit())).collect();
                if !numeric.is_empty() {
                    parts[numeric[numbers.below(numeric.len())]] = EXTREMES[numbers.below(12)].to_owned();
                }
            }
        }
    }
    let mut bytes = parts.concat().into_bytes();
    if numbers.below(4) == 0 {
        let at = numbers.below(bytes.len());
        bytes[at] ^= 1 << numbers.below(8);
    }
    if numbers.below(8) == 0 {
        bytes.truncate(numbers.below(bytes.len()));
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Compiles a mutated scene, or returns its error message.
fn outcome(text: String) -> Result<(), String> {
    let scene = Scene::from_json(text, "mutated.json").map_err(|error| error.to_string())?;
    let frames = [(7.25, scene.at_frame(7.25)), (0.0, Ok(scene))];
    for (frame, scene) in frames {
        let scene = scene.map_err(|error| error.to_string())?;
        let compiled = scene.compile().map_err(|error| error.to_string())?;
        assert!(!compiled.cameras.is_empty() && compiled.warnings.errors() == 0);
        // A scene that compiles can be written and read again, both moving and frozen.
        let read = |json: String| Scene::from_json(json, "mutated.json");
        let again = read(scene.to_json()).and_then(|again| again.at_frame(frame)).map_err(|error| error.to_string());
        assert_eq!(again.map(|again| again.fingerprint()), Ok(scene.fingerprint()));
        let still = scene.still();
        let again = read(still.to_json()).map_err(|error| error.to_string());
        assert_eq!(again.map(|again| again.fingerprint()), Ok(still.fingerprint()));
    }
    Ok(())
}

/// Whether a scene can be built thousands of times in a test.
fn is_small(scene: &BuiltIn) -> bool {
    let objects = || Some(Scene::built_in(scene.name).ok()?.compile().ok()?.world.geometry_stats().shapes);
    scene.name == "juggler" || scene.json.len() < 4000 && objects().is_some_and(|objects| objects < 50)
}

/// The same test for mutations of animated scenes only.
#[test]
fn mutated_animations_never_panic() {
    assert_eq!([ANIMATED, SEEDS[3]].map(|seed| outcome(seed.to_owned())), [Ok(()), Ok(())]);
    let seeds = [tokens(ANIMATED), tokens(SEEDS[3])];
    let mut numbers = Numbers(1986);
    let (mut rendered, mut refused) = (0, 0);
    for round in 0..3_000 {
        let text = mutated(&mut numbers, &seeds);
        match std::panic::catch_unwind(|| outcome(text.clone())) {
            Ok(Ok(())) => rendered += 1,
            Ok(Err(_)) => refused += 1,
            Err(_) => panic!("round {round} panics: {text}"),
        }
    }
    assert!(rendered > 100 && refused > 1000, "{rendered} rendered, {refused} refused");
}

#[test]
fn mutated_scenes_never_panic() {
    let built_in = built_in_scenes().iter().filter(|scene| is_small(scene)).map(|scene| scene.json);
    let seeds: Vec<Vec<String>> = SEEDS.into_iter().chain(built_in).map(tokens).collect();
    assert!(seeds.len() > SEEDS.len() + 10);
    let mut numbers = Numbers(2026);
    let (mut rendered, mut refused) = (0, 0);
    for round in 0..10_000 {
        let text = mutated(&mut numbers, &seeds);
        match std::panic::catch_unwind(|| outcome(text.clone())) {
            Ok(Ok(())) => rendered += 1,
            Ok(Err(message)) => {
                refused += 1;
                assert!(!message.is_empty());
            }
            Err(_) => panic!("round {round} panics: {text}"),
        }
    }
    // Both outcomes must be frequent for the mutations to test much.
    assert!(rendered > 500 && refused > 4000, "{rendered} rendered, {refused} refused");
}
