//! Paths that are no regular files, and files with false headers: every command refuses them by
//! name and without delay.
#![cfg(unix)]

use crate::harness::Folder;
use juggler::memory::PROGRAM;
use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;

/// A folder with a named pipe, a link to itself and a folder, each with every extension.
fn folder() -> Folder {
    let folder = Folder::new();
    for ending in ["png", "jfilm", "ply", "json"] {
        let place = |name: &str| folder.path(&format!("{name}.{ending}"));
        assert!(Command::new("mkfifo").arg(place("pipe")).status().unwrap().success());
        symlink(place("round"), place("round")).unwrap();
        symlink("/dev/zero", place("zero")).unwrap();
        fs::create_dir(place("folder")).unwrap();
    }
    folder.good("render ball.json -o good.png");
    folder.good("render ball.json -o good.jfilm");
    folder
}

const WORDS: [(&str, &str); 4] = [
    ("pipe", "this is a named pipe (FIFO), not a regular file"),
    ("round", "this is a link that leads back to itself"),
    ("zero", "this is a device, not a regular file"),
    ("folder", "a folder"),
];

#[test]
fn every_reader_rejects_pipes_and_folders() {
    let folder = folder();
    for (name, words) in WORDS {
        for line in [
            "info X.png",
            "info X.jfilm",
            "info X.ply",
            "info X.json",
            "check X.json",
            "render X.json -o a.png",
            "convert X.json a.json",
            "compare X.png good.png",
            "compare good.png X.jfilm",
            "merge X.jfilm -o a.png",
            "merge good.jfilm X.jfilm -o a.jfilm",
            "relight X.jfilm --gain rest=2 -o a.png",
            "render ball.json --samples-from X.jfilm -o a.png",
            "render ball.json --samples-from X.png -o a.png",
            "render ball.json --checkpoint X.jfilm -o a.png",
        ] {
            let line = line.replace('X', name);
            let run = folder.run(&line);
            // `check` reports what is wrong inside of a file by 1.
            let least = if line.starts_with("check") { 1 } else { 2 };
            assert!((least..=3).contains(&run.status), "{line}: {} {}", run.status, run.stderr);
            assert!(run.stderr.contains(words) && run.stderr.contains(&format!("{name}.")), "{line}: {}", run.stderr);
        }
    }
}

#[test]
fn scenes_report_referenced_pipes_and_folders() {
    let folder = folder();
    for (name, words) in WORDS {
        let scenes = [
            format!(r#"{{"version": 1, "include": ["{name}.json"]}}"#),
            format!(r#"{{"version": 1, "objects": [{{"shape": {{"mesh": {{"file": "{name}.ply"}}}}}}]}}"#),
            format!(r#"{{"version": 1, "background": {{"environment": {{"file": "{name}.png"}}}}}}"#),
            format!(r#"{{"version": 1, "lights": [{{"point": {{"ies": {{"file": "{name}.png"}}}}}}]}}"#),
            format!(
                r#"{{"version": 1, "textures": {{"a": {{"image": {{"file": "{name}.png"}}}}}}, "objects": [{{"shape": "plane"}}]}}"#
            ),
        ];
        for scene in scenes {
            fs::write(folder.path("a.json"), &scene).unwrap();
            let message = folder.bad("check a.json", 1);
            assert!(message.contains(words) && message.contains(&format!("{name}.")), "{scene}: {message}");
            folder.bad("render a.json -o a.png --max-memory 1G", 2);
        }
    }
}

#[test]
fn a_broken_picture_is_reported_as_such() {
    let folder = folder();
    let good = fs::read(folder.path("good.png")).unwrap();
    fs::write(folder.path("start.png"), [&b"x"[..], &good[1..]].concat()).unwrap();
    fs::write(folder.path("short.png"), &good[..20]).unwrap();
    fs::write(folder.path("empty.png"), "").unwrap();
    let reported = |name: &str| folder.bad(&format!("info {name}"), 3);
    assert!(reported("start.png").contains("cannot read `start.png`: its first bytes match no supported format"));
    assert!(reported("empty.png").contains("cannot read `empty.png`: its first bytes"));
    assert!(reported("short.png").contains("cannot read `short.png`: unexpected end of file at byte 20"));
}

#[test]
fn comparing_and_merging_keep_to_a_budget() {
    let folder = folder();
    for line in ["compare good.png good.png", "compare good.jfilm good.jfilm", "merge good.jfilm -o a.png"] {
        folder.good(&format!("{line} --max-memory 1G"));
        let message = folder.bad(&format!("{line} --max-memory 1M"), 2);
        assert!(message.contains("of memory, more than --max-memory 1.0 MiB"), "{line}: {message}");
    }
    let message = folder.bad("merge good.jfilm -o a.jfilm --max-memory 1M", 2);
    assert!(message.contains("merging the partial renders needs about"), "{message}");
    // FLIP needs most memory; without room for it, the other results are printed.
    folder.good("render ball.json --size 400x300 --samples 1 -o a.pfm");
    folder.good("render ball.json --size 400x300 --samples 1 --seed 2 -o b.pfm");
    let line = format!("compare a.pfm b.pfm --tolerance 10 --max-memory {}", PROGRAM + (22 << 20));
    assert!(folder.good(&line).stdout.contains("FLIP    not measured"), "{line}");
    assert!(folder.bad(&format!("{line} --difference d.png"), 2).contains("comparing the pictures needs about"));
    assert!(
        folder
            .good(&format!("compare a.pfm b.pfm --tolerance 10 --max-memory {}", PROGRAM + (58 << 20)))
            .stdout
            .contains("(HDR)")
    );
}
