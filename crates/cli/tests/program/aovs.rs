//! AOVs, from the command line to the file.

use crate::harness::{Folder, SCENE};
use std::fs;

const BALL: &str = "ball.json --size 48x36 --samples 20 --integrator path";

#[test]
fn shards_with_all_aovs_merge_into_the_bytes_of_the_whole() {
    // Use motion and clamping, so that every AOV has content.
    let folder = Folder::new();
    let limits = r#""samples": 2, "integrator": {"path": {"clamp_direct": 0.2}}"#;
    let clamped = SCENE.replace(r#""samples": 2"#, limits);
    assert!(clamped != SCENE);
    fs::write(folder.path("ball.json"), clamped).unwrap();
    folder.good(&format!("render {BALL} --aov all -o whole.exr -q"));
    let parts: Vec<String> = (0..5).map(|index| format!("part{index}.jfilm")).collect();
    for (index, part) in parts.iter().enumerate() {
        folder.good(&format!("render {BALL} --aov all --shard {index}/5 -o {part} -q --threads {}", index % 3 + 1));
    }
    folder.good(&format!("merge {} -o merged.exr -q", parts.join(" ")));
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("whole.exr") == bytes("merged.exr"), "the merged file differs");
    // Merged partial renders and resumed checkpoints keep their AOVs.
    folder.good(&format!("merge {} -o some.jfilm -q", parts[..3].join(" ")));
    folder.good(&format!("merge some.jfilm {} -o again.exr -q", parts[3..].join(" ")));
    assert!(bytes("whole.exr") == bytes("again.exr"), "the file of joined parts differs");
    let fewer = BALL.replace("--samples 20", "--samples 7");
    folder.good(&format!("render {fewer} --aov all --checkpoint kept.jfilm -o few.exr -q"));
    folder.good(&format!("render {BALL} --aov all --checkpoint kept.jfilm -o more.exr -q"));
    assert!(bytes("whole.exr") == bytes("more.exr"), "the file that was gone on with differs");
}

#[test]
fn the_picture_is_the_same_with_aovs_and_without() {
    let folder = Folder::new();
    let plain = folder.hash(&format!("{BALL} -o a.png"));
    assert_eq!(folder.hash(&format!("{BALL} --aov depth,crypto_material -o b.png")), plain);
    assert_eq!(folder.hash(&format!("{BALL} --aov all -o c.exr")), plain);
    let files = folder.files();
    assert!(files.contains(&"b.layers.exr".to_owned()) && !files.contains(&"c.layers.exr".to_owned()), "{files:?}");
    folder.good(&format!("render {BALL} --aov depth,normal --aov-output l_{{}}.npy -o d.png -q"));
    assert!(folder.path("l_depth.npy").exists() && folder.path("l_normal.npy").exists());
    let said = folder.good("info c.exr").stdout;
    assert!(said.contains("--aov alpha,albedo"), "{said}");
}

#[test]
fn info_names_the_layers_of_an_exr() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} --aov albedo,depth -o two.exr -q"));
    let words = folder.good("info two.exr").stdout;
    assert!(words.contains("\nlayers       beauty: R, G, B\n             albedo: R, G, B\n"), "{words}");
    let json: serde_json::Value = serde_json::from_str(&folder.good("info two.exr --json").stdout).unwrap();
    let names: Vec<&str> =
        json["layers"].as_array().unwrap().iter().map(|layer| layer["name"].as_str().unwrap()).collect();
    assert_eq!(names[..3], ["beauty", "albedo", "depth"]);
    assert_eq!(json["layers"][1]["channels"], serde_json::json!(["R", "G", "B"]));
    folder.good(&format!("render {BALL} -o plain.exr -q"));
    assert!(folder.good("info plain.exr").stdout.contains("\nlayers       R, G, B\n"));
    folder.good(&format!("render {BALL} -o plain.png -q"));
    assert!(!folder.good("info plain.png").stdout.contains("layers"));
}

#[test]
fn aovs_have_the_requested_primaries() {
    let folder = Folder::new();
    let wide = SCENE.replacen('{', r#"{"tone": {"primaries": "acescg"},"#, 1);
    fs::write(folder.path("wide.json"), wide).unwrap();
    let line = BALL.trim_start_matches("ball.json");
    folder.good(&format!("render {BALL} --aov albedo,depth,direct -o plain.exr -q"));
    folder.good(&format!("render {BALL} --aov albedo,depth,direct -o requested.exr -q --primaries acescg"));
    folder.good(&format!("render wide.json {line} --aov albedo,depth,direct -o scene.exr -q"));
    folder.good(&format!("render wide.json {line} --aov albedo,depth,direct -o kept.jfilm -q"));
    folder.good("merge kept.jfilm -o merged.exr -q");
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("scene.exr") == bytes("merged.exr"));
    for wide in ["requested.exr", "scene.exr"] {
        folder.good(&format!("compare {wide} plain.exr --tolerance 1e-6"));
        let all = bytes(wide);
        let named = all.windows(15).filter(|window| *window == b"chromaticities\0").count();
        // A name and a type in each of four parts.
        assert_eq!(named, 8, "{wide}");
    }
}

#[test]
fn partial_renders_of_other_motion_do_not_merge() {
    let folder = Folder::new();
    let part = |name: &str, shard: u32, aov: &str| {
        folder.good(&format!("render {BALL} --aov {aov} --shard {shard}/2 -o {name} -q"));
    };
    part("first.jfilm", 0, "motion,depth");
    part("plain.jfilm", 0, "depth");
    // The position at this frame is the same, that at the next frame differs.
    fs::write(folder.path("ball.json"), SCENE.replace("=frame / 4", "=frame / 2")).unwrap();
    part("second.jfilm", 1, "motion,depth");
    part("rest.jfilm", 1, "depth");
    folder.good("merge plain.jfilm rest.jfilm -o a.exr -q");
    let message = folder.bad("merge first.jfilm second.jfilm -o b.exr", 2);
    assert!(message.contains("neighbor frames"), "{message}");
}

#[test]
fn files_contain_camera_matrices() {
    let folder = Folder::new();
    let stats = folder.good(&format!("render {BALL} -o a.exr -q --stats -")).stdout;
    let stats: serde_json::Value = serde_json::from_str(&stats).unwrap();
    let bytes = fs::read(folder.path("a.exr")).unwrap();
    for (name, key) in [("worldToCamera", "world_to_camera"), ("worldToNDC", "world_to_ndc")] {
        let head = format!("{name}\0m44f\0\u{40}\0\0\0");
        let start = bytes.windows(head.len()).position(|window| window == head.as_bytes()).unwrap() + head.len();
        let found: Vec<f32> =
            bytes[start..start + 64].as_chunks().0.iter().map(|four| f32::from_le_bytes(*four)).collect();
        let reported = stats["camera"][key].as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap());
        let reported: Vec<f32> = reported.map(|number| number.as_f64().unwrap() as f32).collect();
        assert_eq!(found, reported, "{name}");
    }
    folder.good(&format!("render {BALL} -o a.jfilm -q"));
    let merged = folder.good("merge a.jfilm -o b.exr -q --stats -").stdout;
    assert_eq!(serde_json::from_str::<serde_json::Value>(&merged).unwrap()["camera"], stats["camera"]);
    assert!(fs::read(folder.path("b.exr")).unwrap() == bytes);
}

#[test]
fn invalid_aov_flags_are_reported() {
    let folder = Folder::new();
    for (line, said) in [
        ("render ball.json --aov dept", "did you mean `depth`"),
        ("render ball.json --aov depth -o -", "--aov-output"),
        ("render ball.json --aov depth -o a.gif", "movie"),
        ("render ball.json --aov-output a.exr", "--aov"),
        ("render ball.json --aov depth --aov-output a.npy", "{}"),
        ("render ball.json --aov depth -o a.jfilm --aov-output a.exr", "merge"),
    ] {
        let message = folder.bad(line, 2);
        assert!(message.contains(said), "{line}: {message}");
    }
    folder.good("render ball.json --aov depth -o a.jfilm -q");
    let other = folder.bad("render ball.json --aov depth,albedo --checkpoint a.jfilm -o b.png", 2);
    assert!(other.contains("AOVs: depth instead of albedo,depth"), "{other}");
    folder.good("render ball.json -o plain.jfilm -q");
    assert!(folder.bad("merge plain.jfilm -o a.png --aov-output b.exr", 2).contains("no AOVs"));
}

#[test]
fn relighting_needs_no_rays() {
    let folder = Folder::new();
    let scene = |key: f64, color: &str| {
        let lights = format!(
            r#"[{{"point": {{"position": [4, 6, 4], "intensity": {}, "light_group": "key"}}}},
               {{"point": {{"position": [-4, 6, 4], "intensity": 20, "color": {color}, "light_group": "fill"}}}}]"#,
            60.0 * key
        );
        let text = SCENE.replace(r#"[{"point": {"position": [4, 6, 4], "intensity": 60}}]"#, &lights);
        assert!(text != SCENE);
        text
    };
    let render = |key: f64, color: &str, line: &str| {
        fs::write(folder.path("lit.json"), scene(key, color)).unwrap();
        folder.good(&format!("render lit.json --size 24x18 --samples 16 -q {line}"));
    };
    render(1.0, "[1, 1, 1]", "--aov light_groups -o film.jfilm");
    render(1.0, "[1, 1, 1]", "-o as_it_was.pfm");
    render(2.0, "[0, 0.5, 0]", "-o other.pfm");
    folder.good("relight film.jfilm --gain key=1 -o same.pfm -q");
    assert!(fs::read(folder.path("same.pfm")).unwrap() == fs::read(folder.path("as_it_was.pfm")).unwrap());
    folder.good("relight film.jfilm --gain key=2,fill=#00bc00 -o mixed.pfm -q");
    // #bc is 0.503 in linear light.
    folder.good("compare mixed.pfm other.pfm --tolerance 2e-3");
    assert_eq!(folder.run("compare mixed.pfm as_it_was.pfm --tolerance 2e-3").status, 1);
    for (gain, said) in [("kye=2", "did you mean `key`"), ("key", "GROUP=FACTOR"), ("key=-1", "GROUP=FACTOR")] {
        let message = folder.bad(&format!("relight film.jfilm --gain {gain} -o a.png"), 2);
        assert!(message.contains(said), "{gain}: {message}");
    }
    render(1.0, "[1, 1, 1]", "-o plain.jfilm");
    assert!(folder.bad("relight plain.jfilm --gain key=2 -o a.png", 2).contains("light_groups"));
}

#[test]
fn merged_shards_denoise_like_the_whole() {
    let folder = Folder::new();
    let line = format!("render {BALL} --denoise");
    let noisy = folder.hash(&format!("{BALL} -o noisy.pfm"));
    assert_ne!(folder.hash(&format!("{BALL} --denoise -o whole.png --threads 1")), noisy);
    for index in 0..3 {
        folder.good(&format!("{line} --shard {index}/3 -o part{index}.jfilm -q"));
    }
    folder.good("merge part0.jfilm part1.jfilm part2.jfilm -o merged.png -q");
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("whole.png") == bytes("merged.png"));
    folder.good(&format!("render {BALL} --aov depth --denoise -o whole.exr -q"));
    folder.good(&format!("render {BALL} --denoise -o whole.pfm -q"));
    folder.good("compare whole.exr whole.pfm");
    folder.good(&format!("render {BALL} --samples 1024 -o right.pfm -q").replace("--samples 20 ", ""));
    let error = |name: &str| {
        let said = folder.run(&format!("compare {name} right.pfm --stats -")).stdout;
        serde_json::from_str::<serde_json::Value>(&said).unwrap()["relative_mse"].as_f64().unwrap()
    };
    assert!(error("whole.pfm") < 0.8 * error("noisy.pfm"), "{} {}", error("whole.pfm"), error("noisy.pfm"));
    let message = folder.bad(&format!("render {BALL} --denoise owl"), 2);
    assert!(message.contains("own"), "{message}");
    // A scene after the flag is parsed as the scene.
    folder.good(&format!("render --denoise {BALL} -o after.png -q"));
    assert!(bytes("whole.png") == bytes("after.png"));
}
