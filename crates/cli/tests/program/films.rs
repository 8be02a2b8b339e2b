//! Films: all frames in one file, whatever happens in between.
#![cfg(unix)]

use crate::harness::{Folder, Run};
use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const LINE: &str = "render ball.json --size 64x36 --samples 1";

#[test]
fn a_film_has_all_frames_and_leaves_nothing_else() {
    let folder = Folder::new();
    for ending in ["gif", "apng"] {
        let run = folder.good(&format!("{LINE} -o film.{ending}"));
        assert!(run.stdout.starts_with(&format!("film.{ending}: 4 frames, ")), "{}", run.stdout);
    }
    assert_eq!(folder.files(), ["film.apng", "film.gif"]);
    let [gif, apng] = ["film.gif", "film.apng"].map(|name| fs::read(folder.path(name)).unwrap());
    // Graphic control extensions; frame controls.
    assert_eq!(gif.windows(3).filter(|bytes| bytes == b"\x21\xf9\x04").count(), 4);
    assert_eq!(apng.windows(4).filter(|bytes| bytes == b"fcTL").count(), 4);
    // The first frame is what shows only PNG shows.
    fs::rename(folder.path("film.apng"), folder.path("film.png")).unwrap();
    folder.good(&format!("{LINE} -o one.png"));
    folder.good("compare film.png one.png");
}

#[test]
fn frames_and_pace_can_be_chosen() {
    let folder = Folder::new();
    folder.good(&format!("{LINE} --frames 1..3 --fps 10 --plays 3 -o film.gif"));
    let gif = fs::read(folder.path("film.gif")).unwrap();
    let delays: Vec<u8> = gif.windows(5).filter(|bytes| bytes[..3] == *b"\x21\xf9\x04").map(|bytes| bytes[4]).collect();
    assert_eq!(delays, [10, 10]);
    assert!(gif.windows(15).any(|bytes| bytes == b"NETSCAPE2.0\x03\x01\x02\x00"), "twice after the first time");
}

#[test]
fn a_film_that_was_killed_goes_on_to_the_same_bytes() {
    let folder = Folder::new();
    let line = "render ball.json --size 120x80 --samples 64 --threads 1 -o film.apng";
    folder.good(line);
    let straight = fs::read(folder.path("film.apng")).unwrap();
    fs::remove_file(folder.path("film.apng")).unwrap();
    let frame = folder.path("film.apng.frames/frame_0001.png");
    let mut child = folder.command(line).stdout(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while !frame.exists() && child.try_wait().unwrap().is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "there is no second frame");
        sleep(Duration::from_millis(1));
    }
    let _ = Command::new("kill").args(["-9", &child.id().to_string()]).status();
    child.wait().unwrap();
    let made = frame.exists().then(|| fs::metadata(&frame).unwrap().modified().unwrap());
    // Another tone is another film: its frames are not those that are there.
    folder.good(&format!("{line} --exposure 1 --frames 0..1"));
    assert_ne!(fs::read(folder.path("film.apng")).unwrap(), straight);
    assert_eq!(made, frame.exists().then(|| fs::metadata(&frame).unwrap().modified().unwrap()), "it stays");
    folder.good(line);
    assert!(fs::read(folder.path("film.apng")).unwrap() == straight);
    assert!(!folder.path("film.apng.frames/frame_0000.png").exists());
}

#[test]
fn an_interrupted_film_says_where_its_frames_are_and_leaves_no_half_of_itself() {
    let folder = Folder::new();
    let mut command = folder.command("render ball.json --size 120x80 --samples 100000 -o film.gif");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    // The first frame's file is there, under its hidden name.
    while fs::read_dir(folder.path("film.gif.frames")).map_or(0, Iterator::count) == 0 {
        assert!(start.elapsed() < Duration::from_secs(60), "nothing was begun");
        sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let run = Run::of(child.wait_with_output().unwrap());
    assert_eq!((run.status, run.stdout.as_str()), (130, ""));
    assert!(run.stderr.contains("the work so far is in `film.gif.frames`"), "{}", run.stderr);
    assert_eq!(folder.files(), ["film.gif.frames"]);
}

#[test]
fn what_a_film_cannot_be_is_said() {
    let folder = Folder::new();
    for (flags, word) in [
        ("-o f.gif --bits 16", "--bits is for pictures"),
        ("-o f.gif --quality 50", "--quality is for pictures"),
        ("-o f.gif --frame 1", "--frame is for pictures"),
        ("-o f.gif --at 1", "--at is for pictures"),
        ("-o f.apng --shard 0/2", "frame_####.png"),
        ("-o f.png --fps 10", "--fps is for moving pictures: .apng .gif"),
        ("-o f.png --plays 1", "--plays is for moving pictures"),
        ("-o - --format gif", "a film needs a file"),
        ("-o f.gif --fps 0", "a number from 0.01 to 1000"),
        ("-o f.gif --frames 9..", "no frame is left"),
    ] {
        let message = folder.bad(&format!("render ball.json {flags}"), 2);
        assert!(message.contains(word), "{flags}: {message}");
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
    let message = folder.bad(&format!("{LINE} -o no/folder/f.gif"), 3);
    assert!(message.contains("no/folder/f.gif.frames"), "{message}");
}
