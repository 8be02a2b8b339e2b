//! Layers beside the picture, from the command line to the file.

use crate::harness::{Folder, SCENE};
use std::fs;

const BALL: &str = "ball.json --size 48x36 --samples 20 --integrator path";

#[test]
fn shards_with_all_layers_are_the_bytes_of_the_whole() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} --aov all -o whole.exr -q"));
    let parts: Vec<String> = (0..5).map(|index| format!("part{index}.jfilm")).collect();
    for (index, part) in parts.iter().enumerate() {
        folder.good(&format!("render {BALL} --aov all --shard {index}/5 -o {part} -q --threads {}", index % 3 + 1));
    }
    folder.good(&format!("merge {} -o merged.exr -q", parts.join(" ")));
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("whole.exr") == bytes("merged.exr"), "the merged file differs");
    // Parts that are joined keep their layers, and so does a checkpoint that is gone on with.
    folder.good(&format!("merge {} -o some.jfilm -q", parts[..3].join(" ")));
    folder.good(&format!("merge some.jfilm {} -o again.exr -q", parts[3..].join(" ")));
    assert!(bytes("whole.exr") == bytes("again.exr"), "the file of joined parts differs");
    let fewer = BALL.replace("--samples 20", "--samples 7");
    folder.good(&format!("render {fewer} --aov all --checkpoint kept.jfilm -o few.exr -q"));
    folder.good(&format!("render {BALL} --aov all --checkpoint kept.jfilm -o more.exr -q"));
    assert!(bytes("whole.exr") == bytes("more.exr"), "the file that was gone on with differs");
}

#[test]
fn the_picture_is_the_same_with_layers_and_without() {
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
fn what_cannot_be_is_said() {
    let folder = Folder::new();
    for (line, said) in [
        ("render ball.json --aov dept", "did you mean `depth`"),
        ("render ball.json --aov depth -o -", "--aov-output"),
        ("render ball.json --aov depth -o a.gif", "film"),
        ("render ball.json --aov-output a.exr", "--aov"),
        ("render ball.json --aov depth --aov-output a.npy", "{}"),
        ("render ball.json --aov depth -o a.jfilm --aov-output a.exr", "merge"),
    ] {
        let message = folder.bad(line, 2);
        assert!(message.contains(said), "{line}: {message}");
    }
    folder.good("render ball.json --aov depth -o a.jfilm -q");
    let other = folder.bad("render ball.json --aov depth,albedo --checkpoint a.jfilm -o b.png", 2);
    assert!(other.contains("layers: depth instead of albedo,depth"), "{other}");
    folder.good("render ball.json -o plain.jfilm -q");
    assert!(folder.bad("merge plain.jfilm -o a.png --aov-output b.exr", 2).contains("no layers"));
}

#[test]
fn lights_are_mixed_anew_without_a_ray() {
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
    // #bc is 0.503 of linear light.
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
fn noise_is_taken_out_the_same_way_by_shards() {
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
}
