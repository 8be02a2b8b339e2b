//! `--stats` and `--progress json`: keys that other people's scripts read.

use crate::harness::Folder;
use serde_json::Value;
use std::fs;

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn the_keys_are_those_that_were_promised() {
    let folder = Folder::new();
    folder.good("render ball.json --stats stats.json --threads 2");
    let stats: Value = serde_json::from_str(&fs::read_to_string(folder.path("stats.json")).unwrap()).unwrap();
    assert_eq!(
        keys(&stats),
        [
            "version",
            "scene",
            "size",
            "samples",
            "threads",
            "integrator",
            "seconds",
            "rays",
            "geometry",
            "memory",
            "film",
            "fingerprint"
        ]
    );
    assert_eq!(keys(&stats["seconds"]), ["load", "build", "render", "denoise", "write", "total"]);
    assert_eq!(keys(&stats["rays"]), ["camera", "shadow", "secondary", "total", "per_second"]);
    assert_eq!(keys(&stats["geometry"]), ["shapes", "triangles", "unique_triangles", "instances", "lights"]);
    assert_eq!(keys(&stats["memory"]), ["peak_rss_bytes", "expected_bytes", "geometry_bytes", "bvh_bytes"]);
    assert_eq!(keys(&stats["film"]), ["mean", "hash"]);
    assert_eq!((&stats["version"], &stats["scene"], &stats["threads"]), (&1.into(), &"ball.json".into(), &2.into()));
    assert_eq!((&stats["size"], &stats["samples"]), (&serde_json::json!([16, 9]), &2.into()));
    assert_eq!((&stats["rays"]["camera"], &stats["integrator"]), (&(16 * 9 * 2).into(), &"classic".into()));
    let whole = stats["seconds"]["total"].as_f64().unwrap();
    let parts = ["load", "build", "render", "write"].map(|part| stats["seconds"][part].as_f64().unwrap());
    assert!(parts.iter().sum::<f64>() <= whole && parts.iter().all(|part| *part >= 0.0), "{}", stats["seconds"]);
}

#[test]
fn the_fingerprint_is_one_of_everything_that_decides_the_pixels() {
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
