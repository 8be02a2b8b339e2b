//! `juggler merge` and `juggler info` on partial renders.

use crate::harness::Folder;
use juggler::camera::film::{Accumulator, Rect, SampleRun, Tile, runs};
use juggler::film::shard::Work;
use juggler::film::{AovDescription, RenderDescription, ShardDescription, Stop, write};
use juggler::imaging::Tone;
use juggler::math::Rgb;
use std::fs;

const SAMPLES: u32 = 40;

fn description() -> RenderDescription {
    RenderDescription {
        software: "Juggler".into(),
        command: "juggler render ball.json --samples 40".into(),
        scene: "ball".into(),
        frame: 1.5,
        size: [70, 40],
        region: Rect { x: 0, y: 0, width: 70, height: 40 },
        samples: SAMPLES,
        stop: Stop::Samples,
        clamped: false,
        aovs: AovDescription::default(),
        shard: ShardDescription::whole(SAMPLES),
        finished: true,
        fingerprint: [("seed".to_owned(), "7".to_owned())].into(),
        tone: serde_json::to_value(Tone::default()).unwrap(),
        metadata: vec![("Software".into(), "Juggler".into())],
        viewpoint: None,
    }
}

/// Writes shard `index` of `count` of a picture of a gradient, as `index.jfilm`.
fn shard(folder: &Folder, index: u32, count: u32, change: impl Fn(&mut RenderDescription)) {
    let mut description = RenderDescription {
        shard: ShardDescription { index, count, ..ShardDescription::whole(SAMPLES) },
        ..description()
    };
    change(&mut description);
    let tiling = description.tiling();
    let tile = |number: u64| {
        let mut tile = Tile::new(tiling.tile(number).unwrap());
        let Rect { x, y, width, .. } = tile.pixels();
        for samples in runs(0..SAMPLES) {
            let sum = |pixel: u32| {
                let mut accumulator = Accumulator::default();
                accumulator.begin(samples.start, None);
                let light = (x + pixel % width + y) as f32 / 110.0;
                accumulator.add(&vec![Rgb::new(light, 0.5, 1.0 - light); samples.len()]);
                accumulator.sums().next().unwrap()
            };
            let sums = (0..tile.pixels().area() as u32).map(sum).collect();
            tile.add(SampleRun::new(samples, sums)).unwrap();
        }
        (number, tile)
    };
    // If units divide a tile's samples, the first of them carries all.
    let units = Work::from_description(&RenderDescription { stop: Stop::Time { seconds: 1.0 }, ..description.clone() })
        .shard(index, count);
    let tiles = units.into_iter().map(|unit| tile(unit.tile));
    write(&folder.path(&format!("{index}.jfilm")), &description, tiles).unwrap();
}

fn shards(folder: &Folder, count: u32) -> String {
    let name = |index: u32| {
        shard(folder, index, count, |description| description.stop = Stop::Noise { level: 0.1 });
        format!("{index}.jfilm ")
    };
    (0..count).rev().map(name).collect()
}

#[test]
fn partial_renders_merge_into_the_whole_picture() {
    let folder = Folder::new();
    shard(&folder, 0, 1, |description| description.stop = Stop::Noise { level: 0.1 });
    folder.good("merge 0.jfilm -o whole.png");
    let parts = shards(&folder, 3);
    let line = folder.good(&format!("merge {parts} -o parts.png")).stdout;
    assert!(line.starts_with("parts.png: 70x40, 40 samples, of 3 partial renders, "), "{line}");
    assert_eq!(fs::read(folder.path("whole.png")).unwrap(), fs::read(folder.path("parts.png")).unwrap());
    // Through a larger partial render, and to standard output.
    let line = folder.good("merge 2.jfilm 0.jfilm -o some.jfilm").stdout;
    assert!(line.starts_with("some.jfilm: 70x40, incomplete, "), "{line}");
    let streamed = folder.run("merge some.jfilm 1.jfilm -o - --quiet");
    assert_eq!(streamed.bytes, fs::read(folder.path("whole.png")).unwrap());
    let stats = folder.good(&format!("merge {parts} -o a.pfm --stats - --quiet")).stdout;
    let stats: serde_json::Value = serde_json::from_str(&stats).unwrap();
    assert_eq!((&stats["parts"], &stats["size"][0], &stats["samples"]), (&3.into(), &70.into(), &40.into()));
    assert_eq!(stats["film"]["hash"].as_str().unwrap().len(), 64);
    assert!(folder.good("info whole.png").stdout.contains("Software"));
}

#[test]
fn wrong_sets_of_partial_renders_are_named() {
    let folder = Folder::new();
    shards(&folder, 5);
    let message = folder.bad("merge 0.jfilm 2.jfilm 0.jfilm -o a.png", 2);
    assert!(message.contains("`0.jfilm` repeats samples of `0.jfilm`"), "{message}");
    assert!(message.contains("still to do: shards 1,3-4 of 5 (--shard 1/5)"), "{message}");
    shard(&folder, 1, 5, |description| drop(description.fingerprint.insert("seed".into(), "8".into())));
    let message = folder.bad("merge 0.jfilm 1.jfilm 2.jfilm -o a.jfilm", 2);
    let expected =
        "`1.jfilm` is of another picture than `0.jfilm`: stop: samples instead of noise 0.1; seed: 8 instead of 7";
    assert!(message.contains(expected), "{message}");
    assert!(folder.bad("merge 0.jfilm -o a.jfilm --bits 8", 2).contains("--bits"));
    assert!(folder.bad("merge 0.jfilm -o a.tga", 2).contains(".png"));
    assert!(folder.bad("merge -o a.png", 2).contains("<FILE>"));
    assert!(!folder.path("a.png").exists() && !folder.path("a.jfilm").exists());
}

#[test]
fn files_that_fail_are_named() {
    let folder = Folder::new();
    shards(&folder, 2);
    let bytes = fs::read(folder.path("1.jfilm")).unwrap();
    fs::write(folder.path("1.jfilm"), &bytes[..bytes.len() - 1]).unwrap();
    let message = folder.bad("merge 0.jfilm 1.jfilm none.jfilm ball.json -o a.png", 3);
    for expected in [
        "cannot read `1.jfilm`: unexpected end of file",
        "cannot read `none.jfilm`: ",
        "`ball.json` is not a partial render",
        "still to do: shard 1 of 2",
    ] {
        assert!(message.contains(expected), "{expected}: {message}");
    }
    assert!(folder.bad("info 1.jfilm", 3).contains("cannot read `1.jfilm`: unexpected end of file"));
}

#[test]
fn info_describes_partial_renders() {
    let folder = Folder::new();
    shards(&folder, 3);
    let words = folder.good("info 1.jfilm").stdout;
    for expected in [
        "shard        1/3, finished",
        "picture      70x40, until the noise is 0.1, at most 40 samples",
        "scene        ball, frame 1.5",
        "tiles        5 of 15",
        "samples      40",
        "command      juggler render ball.json --samples 40",
        "fingerprint  seed 7",
    ] {
        assert!(words.contains(expected), "{expected}: {words}");
    }
    let json: serde_json::Value = serde_json::from_str(&folder.good("info 1.jfilm --json").stdout).unwrap();
    assert_eq!((&json["part"]["share"]["index"], &json["tiles"]), (&1.into(), &5.into()));
}
