//! Movies: all frames in one file, also after interruptions.
#![cfg(unix)]

use crate::harness::{self, Folder, Run, wait_until};
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, ChildStderr, Stdio};

const LINE: &str = "render ball.json --size 64x36 --samples 1";

#[test]
fn a_movie_has_all_frames_and_leaves_no_other_file() {
    let folder = Folder::new();
    for ending in ["gif", "apng", "webp --frames 0..4", "mp4"] {
        let run = folder.good(&format!("{LINE} -o film.{ending}"));
        let file = format!("film.{}", ending.split(' ').next().unwrap());
        assert!(run.stdout.starts_with(&format!("{file}: 4 frames, ")), "{}", run.stdout);
    }
    assert_eq!(folder.files(), ["film.apng", "film.gif", "film.mp4", "film.webp"]);
    let [gif, apng, webp] = ["film.gif", "film.apng", "film.webp"].map(|name| fs::read(folder.path(name)).unwrap());
    assert_eq!(webp.windows(4).filter(|bytes| bytes == b"ANMF").count(), 4);
    // Count graphic control extensions and frame controls.
    assert_eq!(gif.windows(3).filter(|bytes| bytes == b"\x21\xf9\x04").count(), 4);
    assert_eq!(apng.windows(4).filter(|bytes| bytes == b"fcTL").count(), 4);
    // Without several frames, the output is a picture.
    folder.good(&format!("{LINE} -o still.webp"));
    folder.good(&format!("{LINE} -o still.png"));
    folder.good("compare still.webp still.png");
    // Programs that know only PNG show the first frame.
    fs::rename(folder.path("film.apng"), folder.path("film.png")).unwrap();
    folder.good(&format!("{LINE} -o one.png --dither off"));
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
fn a_killed_movie_is_resumed_to_the_same_bytes() {
    let folder = Folder::new();
    let line = "render ball.json --size 120x80 --samples 64 --threads 1 -o film.apng";
    folder.good(line);
    let straight = fs::read(folder.path("film.apng")).unwrap();
    fs::remove_file(folder.path("film.apng")).unwrap();
    let frame = folder.path("film.apng.frames/frame_0001.png");
    let mut child = folder.command(line).stdout(Stdio::null()).spawn().unwrap();
    wait_until("a second frame", || frame.exists() || child.try_wait().unwrap().is_some());
    harness::signal(&child, "-KILL");
    child.wait().unwrap();
    let made = frame.exists().then(|| fs::metadata(&frame).unwrap().modified().unwrap());
    // Another tone makes another movie, so existing frames are not reused.
    folder.good(&format!("{line} --exposure 1 --frames 0..1"));
    assert_ne!(fs::read(folder.path("film.apng")).unwrap(), straight);
    assert_eq!(made, frame.exists().then(|| fs::metadata(&frame).unwrap().modified().unwrap()), "it stays");
    folder.good(line);
    assert!(fs::read(folder.path("film.apng")).unwrap() == straight);
    assert!(!folder.path("film.apng.frames/frame_0000.png").exists());
}

#[test]
fn an_interrupted_movie_names_the_folder_of_its_frames_and_leaves_no_half_file() {
    let folder = Folder::new();
    let log = interrupted(&folder, "render ball.json --size 120x80 --samples 100000 -o film.gif");
    assert!(log.contains("progress is saved in `film.gif.frames`"), "{log}");
    assert_eq!(folder.files(), ["film.gif.frames"]);
}

/// Starts a movie and returns at its first report of progress, with the log until then and the
/// reader of the rest.
fn under_way(folder: &Folder, line: &str) -> (Child, String, BufReader<ChildStderr>) {
    let mut command = folder.command(&format!("{line} --progress json"));
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    let mut log = String::new();
    while !log.contains("\"progress\"") {
        assert!(lines.read_line(&mut log).unwrap() > 0, "it ended: {log}");
    }
    (child, log, lines)
}

/// Starts a movie, interrupts it in its first frame, and returns its log.
fn interrupted(folder: &Folder, line: &str) -> String {
    let (mut child, mut log, mut lines) = under_way(folder, line);
    harness::signal(&child, "-INT");
    lines.read_to_string(&mut log).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{log}");
    log
}

#[test]
fn interrupted_frame_of_a_movie_is_resumed() {
    let folder = Folder::new();
    let line = "render ball.json --size 160x120 --frames 0..1 --samples 20000 --threads 1 -o film.apng";
    let log = interrupted(&folder, line);
    let [start, progress] = ["start", "progress"].map(|event| {
        let line = log.lines().find(|line| line.contains(&format!("\"{event}\""))).unwrap();
        serde_json::from_str::<serde_json::Value>(line).unwrap()
    });
    // For a single frame, the events have no keys of frames.
    assert!(start["frame"].is_null() && progress["film_eta_seconds"].is_null(), "{log}");
    let kept = folder.path("film.apng.frames/frame_0000.jfilm");
    let samples = fs::metadata(&kept).unwrap().len();
    assert!(samples > 0);
    // A checkpoint of other settings is no error; the frame is rendered anew.
    let few = line.replace("20000", "2");
    folder.good(&few);
    assert_eq!(folder.files(), ["film.apng"]);
    interrupted(&folder, line);
    let again = interrupted(&folder, line);
    assert!(again.contains("frame_0000.jfilm: ") && again.contains("% is done, resuming"), "{again}");
}

#[test]
fn progress_counts_the_whole_movie() {
    let folder = Folder::new();
    let log = interrupted(&folder, "render ball.json --size 160x120 --samples 20000 -o film.apng");
    let line = log.lines().find(|line| line.contains("\"progress\"")).unwrap();
    let progress: serde_json::Value = serde_json::from_str(line).unwrap();
    assert_eq!((&progress["frame"], &progress["frames"]), (&1.into(), &4.into()));
    let [one, all, eta, film_eta] =
        ["fraction", "film_fraction", "eta_seconds", "film_eta_seconds"].map(|key| progress[key].as_f64().unwrap());
    assert!((one / 4.0 - all).abs() < 1e-9 && film_eta > 3.0 * eta, "{progress}");
}

#[test]
fn shards_of_a_movie_fill_its_folder_together() {
    let folder = Folder::new();
    folder.good(&format!("{LINE} -o straight.apng"));
    let shards = [0, 1].map(|shard| {
        let line = format!("{LINE} -o film.apng --shard {shard}/2");
        folder.command(&line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    });
    for (number, shard) in shards.into_iter().enumerate() {
        let run = Run::of(shard.wait_with_output().unwrap());
        assert_eq!((run.status, run.stderr.as_str()), (0, ""));
        let said = format!(
            "film.apng.frames: 2 frames of shard {number}/2; the same command without --shard encodes the movie"
        );
        assert_eq!(run.stdout.trim(), said);
    }
    let frames = fs::read_dir(folder.path("film.apng.frames")).unwrap();
    let times: Vec<_> = frames.map(|frame| frame.unwrap().metadata().unwrap().modified().unwrap()).collect();
    assert!(!folder.path("film.apng").exists());
    let run = folder.run(&format!("{LINE} -o film.apng --progress json"));
    assert!(!run.stderr.contains("progress"), "all frames are there: {}", run.stderr);
    assert_eq!((times.len(), folder.files().len()), (5, 2), "four frames and the lock; then two films");
    assert!(fs::read(folder.path("film.apng")).unwrap() == fs::read(folder.path("straight.apng")).unwrap());
}

#[test]
fn a_movie_is_made_by_one_process_at_a_time() {
    let folder = Folder::new();
    let line = "render ball.json --size 160x120 --samples 100000 -o film.apng";
    // The process holds the lock once it reports progress.
    let (mut first, _, _lines) = under_way(&folder, line);
    for flags in ["", " --shard 1/2"] {
        let message = folder.bad(&format!("{line}{flags}"), 3);
        assert!(message.contains("other processes are writing to `film.apng.frames`"), "{message}");
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // The killed process has released the lock.
    folder.good(&line.replace("100000", "1"));
    assert_eq!(folder.files(), ["film.apng"]);
}

#[test]
fn existing_numbered_pictures_are_not_rendered_again() {
    let folder = Folder::new();
    for ending in ["png", "exr", "hdr"] {
        let line = format!("{LINE} --frames 0..3 -o f_#.{ending}");
        folder.good(&format!("{line} --shard 1/2"));
        let time = || fs::metadata(folder.path(&format!("f_1.{ending}"))).unwrap().modified().unwrap();
        let before = time();
        let run = folder.good(&line);
        let left = format!("f_1.{ending}: exists already, made by the same command");
        assert_eq!((run.stdout.lines().count(), time()), (3, before));
        assert_eq!(run.stdout.lines().nth(1), Some(left.as_str()));
        folder.good(&format!("{line} --seed 2"));
        assert_ne!(time(), before, "another command makes it anew");
    }
    let again = || {
        folder.good(&format!("{LINE} --frames 0..2 -o f_#.png"));
        fs::read(folder.path("f_1.png")).unwrap()
    };
    let plain = again();
    folder.good(&format!("{LINE} --frame 1 -o one.png"));
    assert!(plain == fs::read(folder.path("one.png")).unwrap(), "equal pictures are equal files");
    // The scene's tone is not part of its fingerprint, but changes the picture.
    let scene = fs::read_to_string(folder.path("ball.json")).unwrap();
    let bright = scene.replacen('{', r#"{"tone": {"exposure_stops": 1},"#, 1);
    fs::write(folder.path("ball.json"), bright).unwrap();
    assert!(again() != plain);
    fs::write(folder.path("ball.json"), scene).unwrap();
    assert!(again() == plain);
}

#[test]
fn a_mesh_is_read_once_for_all_frames() {
    let folder = Folder::new();
    let scene = fs::read_to_string(folder.path("ball.json")).unwrap();
    let mesh = r#"{"shape": {"mesh": {"file": "three.obj"}}, "transform": [{"translate": ["=frame / 9", 0, 1]}]},"#;
    fs::write(folder.path("meshes.json"), scene.replace("{\"shape\": \"plane\"},", &format!("{mesh}{mesh}"))).unwrap();
    // Use more samples on fast machines, until the file is removed before the last frame.
    let midway = [200, 800, 3200, 12_800].into_iter().any(|samples| removed_midway(&folder, samples));
    assert!(midway, "the film was complete before the mesh could be removed");
}

/// Renders a movie of `meshes.json` and removes its mesh file after the first of four frames.
/// Returns whether frames were missing then.
fn removed_midway(folder: &Folder, samples: u32) -> bool {
    fs::write(folder.path("three.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let line = format!("render meshes.json --size 160x90 --samples {samples} --threads 1 -o film.apng");
    let mut child = folder.command(&line).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let [first, third] = [0, 2].map(|frame| folder.path(&format!("film.apng.frames/frame_000{frame}.png")));
    wait_until("the first frame", || first.exists() || child.try_wait().unwrap().is_some());
    fs::remove_file(folder.path("three.obj")).unwrap();
    let midway = first.exists() && !third.exists();
    let ended = child.wait_with_output().unwrap();
    // If the movie was complete already, the run proves nothing.
    assert!(ended.status.success(), "the other frames need no file: {}", String::from_utf8_lossy(&ended.stderr));
    fs::remove_file(folder.path("film.apng")).unwrap();
    midway
}

#[test]
fn movie_formats_that_cannot_hold_the_frames_are_refused() {
    let folder = Folder::new();
    for (flags, word) in [
        ("-o f.gif --bits 16", "--bits is for pictures"),
        ("-o f.gif --quality 50", "--quality is for JPEG and MP4 files"),
        ("-o f.gif --frame 1", "--frame is for pictures"),
        ("-o f.gif --at 1", "--at is for pictures"),
        ("-o f.webp --fps 5 --quality 50", "--quality is for JPEG and MP4 files"),
        ("-o f.mp4 --plays 2", "--plays is for .webp, .apng and .gif"),
        ("-o f.gif --fps 50.1", "only 0.01 to 50"),
        ("-o f.gif --size 65536x1", "65536 × 1"),
        ("-o f.webp --frames 0..2 --size 2x16384", "1 to 16383"),
        ("-o f.mp4 --size 15x16", "16 to 65535"),
        ("-o f.mp4 --crop 0,0,8,8", "8 × 8"),
        ("-o f.apng --frames 0..4000000000", "at most 1000000 are allowed"),
        ("-o f.mp4 --size 4000x4000 --max-memory 1G", "for the MP4 movie"),
        ("-o f.png --shard 0/2", "--frames"),
        ("-o f.png --fps 10", "--fps is for movies: .apng .gif .mp4 .webp"),
        ("-o f.png --plays 1", "--plays is for movies"),
        ("-o - --format gif", "a movie needs a file"),
        ("-o f.gif --fps 0", "a number from 0.01 to 1000"),
        ("-o f.gif --frames 9..", "--frames starts at 9, beyond the end"),
    ] {
        let message = folder.bad(&format!("render ball.json {flags}"), 2);
        assert!(message.contains(word), "{flags}: {message}");
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
    let message = folder.bad(&format!("{LINE} -o no/folder/f.gif"), 3);
    assert!(message.contains("no/folder/f.gif.frames"), "{message}");
}
