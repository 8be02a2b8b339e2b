//! `--stats` and `--progress json`: keys that scripts rely on.

use crate::harness::{Folder, SCENE};
use serde_json::Value;
use std::fs;

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// Checks what is known of the program itself.
fn check_program(program: &Value) {
    assert_eq!(keys(program), ["version", "compiler", "simd"]);
    assert_eq!(program["version"], env!("CARGO_PKG_VERSION"));
    assert!(program["compiler"].as_str().unwrap().starts_with("rustc 1."), "{}", program);
    let levels = ["sse2", "sse4_2", "avx2", "avx512"];
    let simd = program["simd"].as_str().unwrap();
    assert!(levels.contains(&simd) || !cfg!(target_arch = "x86_64"), "{simd}");
}

#[test]
fn statistics_have_the_documented_keys() {
    let folder = Folder::new();
    folder.good("render ball.json --stats stats.json --threads 2");
    let stats: Value = serde_json::from_str(&fs::read_to_string(folder.path("stats.json")).unwrap()).unwrap();
    assert_eq!(
        keys(&stats),
        [
            "version",
            "program",
            "scene",
            "size",
            "samples",
            "threads",
            "integrator",
            "integrator_reason",
            "seconds",
            "rays",
            "geometry",
            "memory",
            "film",
            "camera",
            "fingerprint"
        ]
    );
    assert_eq!(keys(&stats["seconds"]), ["load", "build", "render", "denoise", "write", "total", "cpu"]);
    check_program(&stats["program"]);
    assert_eq!(keys(&stats["rays"]), ["camera", "shadow", "secondary", "total", "per_second", "not_finite"]);
    assert_eq!(keys(&stats["geometry"]), ["shapes", "triangles", "unique_triangles", "instances", "lights"]);
    assert_eq!(keys(&stats["memory"]), ["peak_rss_bytes", "expected_bytes", "geometry_bytes", "bvh_bytes"]);
    assert_eq!(keys(&stats["film"]), ["mean", "hash"]);
    assert_eq!((&stats["version"], &stats["scene"], &stats["threads"]), (&1.into(), &"ball.json".into(), &2.into()));
    assert_eq!((&stats["size"], &stats["samples"]), (&serde_json::json!([16, 9]), &2.into()));
    assert_eq!((&stats["rays"]["camera"], &stats["integrator"]), (&(16 * 9 * 2).into(), &"classic".into()));
    assert_eq!(stats["integrator_reason"], "chosen because `classic` supports all lights and materials of the scene");
    let whole = stats["seconds"]["total"].as_f64().unwrap();
    let parts = ["load", "build", "render", "write"].map(|part| stats["seconds"][part].as_f64().unwrap());
    let cpu = stats["seconds"]["cpu"].as_f64().unwrap();
    assert!(cpu > 0.0 && cpu < 100.0, "{cpu}");
    assert!(parts.iter().sum::<f64>() <= whole && parts.iter().all(|part| *part >= 0.0), "{}", stats["seconds"]);
}

#[test]
fn fingerprint_covers_everything_that_affects_pixels() {
    let folder = Folder::new();
    let fingerprint =
        |flags: &str| folder.stats(&format!("ball.json {flags}"))["fingerprint"].as_str().unwrap().to_owned();
    let plain = fingerprint("");
    assert_eq!(fingerprint("--threads 1"), plain);
    for other in ["--seed 1", "--frame 1", "--integrator normals", "--size 16x10"] {
        assert_ne!(fingerprint(other), plain, "{other}");
    }
}

#[test]
fn statistics_of_frames_are_lines() {
    let folder = Folder::new();
    let run = folder.good("render ball.json --quiet --frames 0..3 --stats -");
    let hashes: Vec<Value> =
        run.stdout.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["film"]["hash"].clone()).collect();
    assert!(hashes.len() == 3 && hashes[0] != hashes[1] && hashes[1] != hashes[2]);
}

#[test]
fn progress_is_a_stream_of_events() {
    let folder = Folder::new();
    let run = folder.run("render ball.json --progress json");
    let events: Vec<Value> = run.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(keys(&events[0]), ["event", "output", "size", "samples"]);
    let last = events.last().unwrap();
    assert_eq!((&events[0]["event"], &last["event"]), (&"start".into(), &"done".into()));
    assert_eq!(keys(last), ["event", "output", "seconds", "rays", "hash"]);
    assert_eq!(folder.good("render ball.json").stdout.lines().count(), 1);
    assert_eq!(folder.good("render ball.json --quiet").stdout, "");
}

#[test]
fn radiance_removed_by_clamping_is_always_reported() {
    let folder = Folder::new();
    let integrator = r#""integrator": {"path": {"max_depth": 5, "clamp_direct": 0.4, "clamp_indirect": 0.02}}"#;
    let scene = SCENE.replace(r#""samples": 2"#, &format!(r#""samples": 2, {integrator}"#));
    fs::write(folder.path("clamped.json"), scene).unwrap();
    let reported = |flags: &str| {
        let run = folder.run(&format!("{flags} --stats s.json"));
        assert_eq!(run.status, 0, "{}", run.stderr);
        let stats: Value = serde_json::from_str(&fs::read_to_string(folder.path("s.json")).unwrap()).unwrap();
        assert_eq!(keys(&stats["film"]["clamped"]), ["mean", "share"]);
        assert!(run.stdout.contains("clamping removed ") && run.stdout.contains(" % of the light"), "{}", run.stdout);
        stats["film"].clone()
    };
    let render = "render clamped.json --size 40x25 --samples 40";
    let whole = reported(&format!("{render} --threads 1 -o whole.png"));
    let share = whole["clamped"]["share"].as_f64().unwrap();
    assert!(share > 0.001 && share < 0.9, "{share}");
    for threads in [2, 4] {
        assert_eq!(reported(&format!("{render} --threads {threads} -o whole.png")), whole);
    }
    for shard in 0..2 {
        reported(&format!("{render} --shard {shard}/2 -o {shard}.jfilm"));
    }
    assert_eq!(reported("merge 0.jfilm 1.jfilm -o merged.png"), whole);
    // Start with fewer samples, then resume.
    reported("render clamped.json --size 40x25 --samples 7 -o a.jfilm --checkpoint a.jfilm");
    assert_eq!(reported(&format!("{render} -o a.jfilm --checkpoint a.jfilm")), whole);
    assert!(folder.good("info whole.png").stdout.contains("direct light at 0.4, indirect light at 0.02"));
    // Frames of a movie report clamping too.
    let film = folder.run("render clamped.json --frames 0..2 -o film.gif");
    assert_eq!(film.status, 0, "{}", film.stderr);
    assert_eq!(film.stderr.matches("clamping removed ").count(), 2, "{}", film.stderr);
}

#[test]
fn samples_that_are_not_finite_are_counted_and_black() {
    let folder = Folder::new();
    let scene = r#"{"version": 1, "render": {"size": [24, 16], "samples": 4},
        "background": {"solid": {"color": [1e30, 0, 0]}},
        "lights": [{"point": {"position": [0, 4, 4], "intensity": 1e30}}],
        "objects": [{"shape": {"sphere": {}}, "material": {"phong": {"diffuse": [1e30, 1, 1]}}}]}"#;
    fs::write(folder.path("wild.json"), scene).unwrap();
    let reported = |flags: &str| {
        let run = folder.run(&format!("render wild.json {flags} -o wild.exr --stats s.json"));
        assert_eq!(run.status, 0, "{}", run.stderr);
        let stats: Value = serde_json::from_str(&fs::read_to_string(folder.path("s.json")).unwrap()).unwrap();
        let lost = stats["rays"]["not_finite"].as_u64().unwrap();
        assert!(lost > 10 && lost < 24 * 16 * 4, "{lost}");
        assert!(run.stdout.contains(&format!("{lost} samples not finite")), "{}", run.stdout);
        assert!(stats["film"]["mean"].as_array().unwrap().iter().all(Value::is_number), "{}", stats["film"]);
        (lost, stats["film"]["hash"].clone())
    };
    let whole = reported("--threads 1");
    assert_eq!(reported("--threads 4"), whole);
    assert_ne!(reported("--samples 1"), whole);
    let run = folder.run("render wild.json -q -o wild.exr");
    assert!(run.stderr.contains("samples not finite, counted as black"), "{}", run.stderr);
}

/// A render says that its picture is black, and `check` why.
#[test]
fn a_black_picture_is_reported() {
    let folder = Folder::new();
    let text = r#"{"version": 1, "objects": [{"shape": "sphere"}],
        "lights": [{"point": {"position": [0, 3, 0], "intensity": INTENSITY}}]}"#;
    fs::write(folder.path("dark.json"), text.replace("INTENSITY", "0")).unwrap();
    let run = folder.run("render dark.json --size 8x8 --samples 1 -o a.png");
    assert_eq!(run.status, 0);
    assert!(run.stderr.contains("a.png: all pixels are black: no light reaches the camera"), "{}", run.stderr);
    let check = folder.run("check dark.json");
    let report = format!("{}{}", check.stdout, check.stderr);
    assert!(check.status == 0 && report.contains("no light reaches the camera"), "{report}");
    fs::write(folder.path("lit.json"), text.replace("INTENSITY", "9")).unwrap();
    let run = folder.good("render lit.json --size 8x8 --samples 1 -o a.png");
    assert!(!run.stderr.contains("black"), "{}", run.stderr);
}
