//! Files that an earlier build of version 0.1.0 wrote (commit 19847c6a), and command lines that it
//! took. `ball.json` was written by `juggler convert`; of its frame 1, `ball.png` is the picture,
//! `kept.jfilm` a checkpoint after 20 of 70 samples, and `shard0.jfilm` the first of two shards with
//! AOVs.

use crate::harness::Folder;
use std::fs;
use std::path::Path;

/// Hash of the linear pixels of `ball.png`, as that build printed it.
const HASH: &str = "9fa6512393c11c4096b96c726846993bd7a8ec680919a32f8135d59492a3ad30";

/// A folder with the files.
fn folder() -> Folder {
    let folder = Folder::new();
    for name in ["ball.json", "ball.png", "kept.jfilm", "shard0.jfilm"] {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/before").join(name);
        fs::copy(from, folder.path(name)).unwrap();
    }
    folder
}

#[test]
fn scenes_from_before_give_the_same_picture_and_text() {
    let folder = folder();
    assert_eq!(folder.hash("ball.json --frame 1 -o new.png"), HASH);
    assert_eq!(fs::read(folder.path("new.png")).unwrap(), fs::read(folder.path("ball.png")).unwrap());
    folder.good("convert ball.json again.json");
    assert_eq!(fs::read(folder.path("again.json")).unwrap(), fs::read(folder.path("ball.json")).unwrap());
}

#[test]
fn checkpoints_from_before_are_resumed() {
    let folder = folder();
    let stats = folder.stats("ball.json --frame 1 -o new.png --checkpoint kept.jfilm");
    assert_eq!(stats["film"]["hash"], HASH);
    assert_eq!(stats["rays"]["camera"], 32 * 24 * 50, "20 of 70 samples are kept");
}

#[test]
fn shards_from_before_merge_with_new_ones() {
    let folder = folder();
    folder.good("render ball.json --frame 1 --shard 1/2 --aov albedo,object_id -o shard1.jfilm -q");
    let merged = folder.run("merge shard0.jfilm shard1.jfilm -o whole.png --stats -");
    let stats: serde_json::Value = serde_json::from_str(&merged.stdout).unwrap();
    assert_eq!((merged.status, &stats["film"]["hash"]), (0, &HASH.into()), "{}", merged.stderr);
}

/// Command lines that write or print something small.
const LINES: &[&str] = &[
    "render ball.json -o a.png -q --size 8x6 --samples 2 --frame 2 --seed 3 --threads 1",
    "render ball.json -o a.png -q --size 8x6 --samples 2 --frame 3 --threads 2 --integrator ambient_occlusion",
    "render ball.json -o a.png -q --size 8x6 --samples 2 --camera top --max-depth 3 --shutter 0..0.25",
    "render ball.json -o a.png -q --size 8x6 --crop 2,1,4,4 --samples 2 --tone aces --exposure 0.5",
    "render ball.json -o a.png -q --size 8x6 --noise 0.5 --samples 64 --bits 16 --white-balance 5000",
    "render ball.json -o a.jpg -q --size 8x6 --time 0.01 --quality 50 --look ham",
    "render ball.json -o a.exr -q --size 8x6 --samples 2 --aov albedo,depth --denoise own --bits 16",
    "render ball.json -o a.png -q --size 8x6 --samples 2 --aov normal --aov-output b.exr --max-memory 2G",
    "render ball.json -o a.mp4 -q --size 16x16 --samples 1 --frames 0..2",
    "render ball.json -o a.gif -q --size 16x16 --samples 1 --frames 0..2 --fps 5",
    "render ball.json -o a%02d.png -q --size 8x6 --samples 1 --frames 0..2",
    "render ball.json -o a.jfilm -q --size 32x32 --samples 32 --sample-range 0..16 --crop 0,0,16,16",
    "check ball.json",
    "convert ball.json c.json --frame 1",
    "info ball.json",
    "info ball.png",
    "info kept.jfilm",
    "compare ball.png ball.png",
    "probe ball.json 4,4 --size 8x6 --samples 2",
    "scenes",
    "schema",
    "completions bash",
];

#[test]
fn command_lines_from_before_are_taken() {
    let folder = folder();
    let refused = LINES.iter().filter_map(|line| {
        let run = folder.run(line);
        (run.status != 0).then(|| format!("{line}: {}", run.stderr))
    });
    let refused: Vec<String> = refused.collect();
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}
