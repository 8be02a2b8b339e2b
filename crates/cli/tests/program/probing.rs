//! `juggler probe`, and the noise test of `juggler compare`.

use crate::harness::{Folder, SCENE};
use serde_json::Value;
use std::fs;

const BALL: &str = "ball.json --size 24x18 --samples 20 --integrator path";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn probe_equals_the_rendered_pixel() {
    let folder = Folder::new();
    for flags in ["", "--seed 7", "--frame 2", "--at 1", "--camera top", "--integrator classic", "--integrator normals"]
    {
        let line = format!("{} {flags}", if flags.contains("integrator") { "ball.json --size 24x18" } else { BALL });
        folder.good(&format!("render {line} -q -o a.pfm"));
        let image = juggler::imaging::read(&folder.path("a.pfm")).unwrap();
        for (x, y) in [(0, 0), (12, 9), (23, 17), (12, 14)] {
            let probe = json(&folder.good(&format!("probe {line} {x},{y} --stats -")).stdout);
            let mean: Vec<f32> = probe["mean"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap() as f32).collect();
            assert_eq!(mean, image.pixels()[y * 24 + x].to_array(), "{line} {x},{y}");
            assert_eq!(probe["light"].is_null(), flags.contains("normals"));
        }
    }
}

#[test]
fn probe_explains_a_pixel() {
    let folder = Folder::new();
    let said = folder.good(&format!("probe {BALL} 12,9")).stdout;
    for part in [
        "pixel 12,9 of 24x18, path, 20 samples",
        "first hit",
        "objects[1], sphere",
        "material red",
        "lights[0] (point)",
        "brightest samples",
        "objects[1] diffuse",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let sky = folder.good(&format!("probe {BALL} 0,0 --brightest 0 --branches 0")).stdout;
    assert!(
        sky.contains("first hit  background") && sky.contains("1 other branch") && !sky.contains("brightest"),
        "{sky}"
    );
    let normals = folder.good("probe ball.json 3,3 --integrator normals").stdout;
    assert!(normals.contains("traces no paths"), "{normals}");
    folder.good("probe ball.json 0,0 --size 1x1 --samples 1 --stats a.json");
    assert_eq!(json(&fs::read_to_string(folder.path("a.json")).unwrap())["version"], 1);
    fs::write(folder.path("empty.json"), r#"{"version": 1, "objects": []}"#).unwrap();
    let empty = folder.run("probe empty.json 1,1 --size 4x4");
    assert!(empty.status == 0 && empty.stdout.contains("background"), "{}", empty.stdout);
    assert!(empty.stderr.contains("the scene has no objects"), "{}", empty.stderr);
}

#[test]
fn probes_outside_the_picture_are_rejected() {
    let folder = Folder::new();
    for (line, said) in [
        ("probe ball.json 16,0", "X is 0 to 15, Y is 0 to 8"),
        ("probe ball.json 0,9", "0,9 is outside the picture"),
        ("probe ball.json 4294967295,0", "is outside the picture"),
        ("probe ball.json 4294967296,0", "X,Y"),
        ("probe ball.json 3", "X,Y"),
        ("probe ball.json a,b", "320,180"),
        ("probe ball.json", "X,Y"),
        ("probe ball.json 1,1 --fireflies", "cannot be used with"),
        ("probe ball.json --fireflies 0", "0"),
        ("probe bal.json 1,1", "bal.json"),
        ("probe ball.json 1,1 --integrator pth", "path"),
        ("probe ball.json 1,1 --camera none", "none"),
    ] {
        let status = if line.starts_with("probe bal.json") { 3 } else { 2 };
        let message = folder.bad(line, status);
        assert!(message.contains(said), "{line}: {message}");
    }
}

#[test]
fn fireflies_are_listed() {
    let folder = Folder::new();
    let said = folder.good(&format!("probe {BALL} --fireflies")).stdout;
    assert!(said.contains("out by chance") && said.contains("fewer than 32 samples"), "{said}");
    let stats = json(&folder.good(&format!("probe {BALL} --fireflies 3 --stats - --threads 2")).stdout);
    assert!(stats["pixels"].as_array().unwrap().len() <= 3 && stats["count"].is_u64() && stats["clamped"].is_null());
    assert!(folder.good("probe ball.json --fireflies --size 1x1 --samples 1").stdout.contains("0 pixels stand out"));
    let clamped =
        SCENE.replace(r#""samples": 2"#, r#""samples": 40, "integrator": {"path": {"clamp_indirect": 0.02}}"#);
    fs::write(folder.path("clamped.json"), clamped).unwrap();
    assert!(folder.good("probe clamped.json --fireflies").stdout.contains("clamping removed "));
}

/// Pictures of the scene and of a brighter version, with their variances.
fn noisy() -> Folder {
    let folder = Folder::new();
    let brighter = SCENE.replace(r#""intensity": 60"#, r#""intensity": 63"#);
    fs::write(folder.path("brighter.json"), brighter).unwrap();
    let line = "--size 48x32 --samples 32 --integrator path -q";
    for (name, flags) in [
        ("a.exr", "ball.json --aov variance,samples"),
        ("b.exr", "ball.json --aov variance,samples --seed 1"),
        ("c.exr", "brighter.json --aov variance --seed 2"),
        ("a.jfilm", "ball.json"),
        ("b.jfilm", "ball.json --seed 1"),
        ("more.jfilm", "ball.json --samples 48"),
        ("few.jfilm", "ball.json --samples 16 --seed 3"),
        ("d.exr", "ball.json --aov variance --denoise --seed 4"),
        ("plain.exr", "ball.json --seed 1"),
    ] {
        let line = if flags.contains("--samples ") { line.replace("--samples 32", "") } else { line.to_owned() };
        folder.good(&format!("render {flags} {line} -o {name}"));
    }
    folder
}

#[test]
fn noise_is_distinguished_from_differences() {
    let folder = noisy();
    assert!(folder.good("compare a.exr a.jfilm").stdout.starts_with("identical, bit for bit"));
    for pair in ["a.exr b.exr", "a.jfilm b.jfilm", "a.exr b.jfilm"] {
        let said = folder.good(&format!("compare {pair}")).stdout;
        assert!(said.starts_with("same up to noise, p = 0."), "{pair}: {said}");
    }
    for pair in ["a.exr c.exr", "c.exr b.jfilm"] {
        let run = folder.run(&format!("compare {pair}"));
        assert!(run.status == 1 && run.stdout.starts_with("different, p "), "{pair}: {}", run.stdout);
        assert!(run.stdout.contains("standard errors"), "{}", run.stdout);
    }
    let run = folder.run("compare a.exr plain.exr");
    assert!(run.status == 1 && !run.stdout.contains("noise"), "{}", run.stdout);
    assert!(folder.good("compare a.exr c.exr --tolerance 10").stdout.starts_with("equal within the limits"));
    let stats = json(&folder.run("compare a.exr c.exr --significance 0.001 --stats -").stdout);
    assert_eq!((&stats["equal"], &stats["noise"]["same"]), (&false.into(), &false.into()));
    assert!(stats["noise"]["p"].as_f64().unwrap() < 1e-3 && stats["noise"]["significance"] == 0.001);
    assert!(json(&folder.good("compare a.exr b.exr --stats -").stdout)["noise"]["same"] == true);
    assert!(folder.bad("compare a.exr b.exr --significance 2", 2).contains("between 0 and 1"));
}

#[test]
fn a_comparison_without_variances_says_so() {
    let folder = noisy();
    for (pair, reason) in [
        ("a.jfilm more.jfilm", "share samples"),
        ("a.jfilm few.jfilm", "at least 32 per pixel"),
        ("a.exr d.exr", "before denoising"),
    ] {
        let run = folder.run(&format!("compare {pair}"));
        assert!(run.status == 1 && run.stdout.contains("not tested"), "{pair}: {}", run.stdout);
        assert!(run.stdout.contains(reason), "{pair}: {}", run.stdout);
    }
}
