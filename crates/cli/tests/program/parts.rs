//! Checkpoints, shards and merging.

use crate::harness::{self, Folder, Run, wait_until};
use serde_json::Value;
use std::fs;
use std::process::Stdio;

const BALL: &str = "ball.json --size 48x36";

#[test]
fn resuming_from_a_checkpoint_gives_the_same_bits() {
    let folder = Folder::new();
    let straight = |samples: u32| {
        folder.good(&format!("render {BALL} --samples {samples} -o straight.png -q"));
        fs::read(folder.path("straight.png")).unwrap()
    };
    for samples in [20, 70] {
        folder.good(&format!("render {BALL} --samples {samples} -o out.png -q --checkpoint kept.jfilm"));
        assert_eq!(fs::read(folder.path("out.png")).unwrap(), straight(samples), "{samples} samples");
    }
    // Everything is in the checkpoint, so no ray is traced.
    let again = folder.stats(&format!("{BALL} --samples 70 -o again.png --checkpoint kept.jfilm"));
    assert_eq!(again["rays"]["camera"], 0);
    assert_eq!(fs::read(folder.path("again.png")).unwrap(), straight(70));
    assert_eq!(folder.files(), ["again.png", "kept.jfilm", "out.png", "straight.png"]);
}

#[test]
fn logs_report_resumed_samples() {
    let folder = Folder::new();
    let said = |flags: &str| {
        let line = format!("render {BALL} --checkpoint kept.jfilm -o part.jfilm {flags}");
        String::from_utf8(folder.command(&line).output().unwrap().stderr).unwrap()
    };
    assert_eq!(said("--samples 70"), "");
    assert_eq!(said("--samples 100"), "kept.jfilm: 70.0 % is done, resuming\n");
    assert_eq!(said("--samples 100 -q"), "");
}

#[test]
fn checkpoint_of_another_picture_is_rejected() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} --samples 16 -q --checkpoint kept.jfilm"));
    let kept = fs::read(folder.path("kept.jfilm")).unwrap();
    for (flags, said) in [
        ("--seed 7", "render.seed: 0 instead of 7"),
        ("--frame 1", "frame: 0 instead of 1"),
        ("--integrator normals", "render.integrator"),
        ("--camera top", "camera: "),
        ("--crop 0,0,16,16", "region"),
        ("--samples 8", "beyond 8"),
        ("--noise 0.1", "noise"),
    ] {
        let samples = if flags.contains("--samples") { "" } else { "--samples 16" };
        let message = folder.bad(&format!("render {BALL} {samples} -q --checkpoint kept.jfilm {flags}"), 2);
        assert!(message.contains(said) && message.contains("kept.jfilm"), "{flags}: {message}");
        assert_eq!(fs::read(folder.path("kept.jfilm")).unwrap(), kept, "{flags}");
    }
    let changed = fs::read_to_string(folder.path("ball.json")).unwrap().replace("[0.8, 0.1, 0.1]", "[0.8, 0.2, 0.1]");
    fs::write(folder.path("ball.json"), changed).unwrap();
    let message = folder.bad(&format!("render {BALL} --samples 16 -q --checkpoint kept.jfilm"), 2);
    assert!(message.contains("materials"), "{message}");
    let message = folder.bad(&format!("render {BALL} --checkpoint ball.json"), 2);
    assert!(message.contains("ball.json"), "{message}");
}

#[test]
fn an_interrupted_render_keeps_its_work() {
    let folder = Folder::new();
    let line = "render ball.json --size 100x100 --samples 100000 --checkpoint kept.jfilm --checkpoint-every 0.05";
    for (signal, status) in [("-INT", 130), ("-TERM", 143), ("-KILL", -1)] {
        let child = folder.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let modified = || fs::metadata(folder.path("kept.jfilm")).and_then(|data| data.modified()).ok();
        let old = modified();
        wait_until("a new checkpoint", || modified() != old);
        harness::signal(&child, signal);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code().unwrap_or(-1), status);
        if status > 0 {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(said.contains("progress is saved in `kept.jfilm`"), "{said}");
        }
    }
    let left: Vec<String> = folder.files().into_iter().filter(|name| !name.starts_with(".kept")).collect();
    assert_eq!(left, ["kept.jfilm", "kept.jfilm.previous"]);
}

#[test]
fn merged_shards_equal_the_whole_picture() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} --samples 40 -o straight.png -q"));
    for count in [2, 5] {
        let mut parts = Vec::new();
        for index in (0..count).rev() {
            folder.good(&format!("render {BALL} --samples 40 -q --shard {index}/{count} -o part{index}.jfilm"));
            parts.push(format!("part{index}.jfilm"));
        }
        folder.good(&format!("merge {} -o merged.png -q", parts.join(" ")));
        let (merged, straight) = (fs::read(folder.path("merged.png")), fs::read(folder.path("straight.png")));
        assert!(merged.unwrap() == straight.unwrap(), "{count} shards");
    }
    let message = folder.bad("merge part0.jfilm part3.jfilm part0.jfilm -o merged.png", 2);
    assert!(message.contains("part0.jfilm") && message.contains("1-2,4"), "{message}");
}

/// Renders a shard with the checkpoint `kept`, kills it at its first checkpoint, and returns
/// whether it was still running.
fn killed_midway(folder: &Folder, line: &str, kept: &str) -> bool {
    let line = format!("{line} --checkpoint-every 0.005");
    let mut child = folder.command(&line).stderr(Stdio::null()).spawn().unwrap();
    wait_until("a checkpoint", || folder.path(kept).exists() || child.try_wait().unwrap().is_some());
    child.kill().unwrap();
    child.wait().unwrap().code().is_none()
}

/// Renders the five shards of a picture, two of which are killed and resumed. Returns whether they
/// were still running when killed.
fn with_killed_shards(folder: &Folder, picture: &str) -> bool {
    let mut midway = true;
    for index in [3, 0, 4, 1, 2] {
        let kept = format!("kept{index}.jfilm");
        let line = format!("render {picture} -q --shard {index}/5 -o part{index}.jfilm --checkpoint {kept}");
        if index == 4 || index == 1 {
            midway &= killed_midway(folder, &line, &kept);
        }
        folder.good(&line);
    }
    midway
}

#[test]
fn killed_shards_are_rendered_again_and_duplicate_shards_named() {
    // Use more samples on fast machines, until the shards are killed before they finish.
    let found = [400, 1600, 6400, 25_600].into_iter().find_map(|samples| {
        let folder = Folder::new();
        let picture = format!("ball.json --size 160x120 --samples {samples}");
        with_killed_shards(&folder, &picture).then_some((folder, picture))
    });
    let (folder, picture) = found.unwrap();
    folder.good(&format!("render {picture} -o straight.png -q"));
    folder.good("merge part2.jfilm part0.jfilm part4.jfilm part3.jfilm part1.jfilm -o merged.png -q");
    assert_eq!(fs::read(folder.path("merged.png")).unwrap(), fs::read(folder.path("straight.png")).unwrap());
    fs::copy(folder.path("part3.jfilm"), folder.path("copy.jfilm")).unwrap();
    let all = "merge part2.jfilm copy.jfilm part0.jfilm part4.jfilm part3.jfilm part1.jfilm -o again.png -q";
    let message = folder.bad(all, 2);
    assert!(message.contains("`part3.jfilm` repeats samples of `copy.jfilm`"), "{message}");
    assert!(!folder.files().contains(&"again.png".to_owned()));
}

#[test]
fn a_partial_render_may_be_its_own_checkpoint() {
    let folder = Folder::new();
    let shard = format!("render {BALL} --samples 40 -q --shard 1/3");
    folder.good(&format!("{shard} -o apart.jfilm"));
    folder.good(&format!("{shard} -o one.jfilm --checkpoint one.jfilm"));
    assert_eq!(fs::read(folder.path("one.jfilm")).unwrap(), fs::read(folder.path("apart.jfilm")).unwrap());
    assert_eq!(folder.files(), ["apart.jfilm", "one.jfilm"]);
}

#[test]
fn clusters_number_their_shards() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} -q --shard 1/3 -o typed.jfilm"));
    let line = format!("render {BALL} -q --shard auto/3 -o auto.jfilm");
    let output = folder.command(&line).env("SLURM_ARRAY_TASK_ID", "1").output().unwrap();
    assert!(output.status.success());
    assert_eq!(fs::read(folder.path("auto.jfilm")).unwrap(), fs::read(folder.path("typed.jfilm")).unwrap());
}

#[test]
fn partial_renders_of_ranges_given_by_hand_merge() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} --samples 48 -o straight.png -q"));
    for (number, flags) in
        ["--crop 0,0,48,16", "--crop 0,16,48,20 --sample-range 0..32", "--crop 0,16,48,20 --sample-range 32..48"]
            .iter()
            .enumerate()
    {
        folder.good(&format!("render {BALL} --samples 48 -q {flags} -o cut{number}.jfilm"));
    }
    folder.good("merge cut2.jfilm cut0.jfilm cut1.jfilm -o merged.png -q");
    assert_eq!(fs::read(folder.path("merged.png")).unwrap(), fs::read(folder.path("straight.png")).unwrap());
    let message = folder.bad(&format!("render {BALL} --crop 1,0,20,16 -o cut.jfilm"), 2);
    assert!(message.contains("0,0,32,16"), "{message}");
    assert!(folder.bad(&format!("render {BALL} --crop 40,0,20,16 -o cut.jfilm"), 2).contains("beyond"));
    assert!(folder.bad(&format!("render {BALL} --sample-range 0..64 --samples 48 -o cut.jfilm"), 2).contains("48"));
}

#[test]
fn noise_targets_give_one_picture_on_any_threads_and_shards() {
    let folder = Folder::new();
    let flags = "--noise 0.004 --samples 512";
    let one = folder.hash(&format!("{BALL} {flags} --threads 1 -o one.png"));
    assert_eq!(folder.hash(&format!("{BALL} {flags} --threads 3 -o three.png")), one);
    for index in 0..3 {
        folder.good(&format!("render {BALL} {flags} -q --shard {index}/3 -o part{index}.jfilm"));
    }
    folder.good("merge part1.jfilm part2.jfilm part0.jfilm -o merged.png -q");
    assert_eq!(fs::read(folder.path("merged.png")).unwrap(), fs::read(folder.path("one.png")).unwrap());
    let coarse = folder.stats(&format!("{BALL} --noise 0.5 -o coarse.png"));
    assert_eq!(coarse["rays"]["camera"], 64 * 48 * 36, "the minimum for an estimate of noise");
}

#[test]
fn time_limited_picture_is_reproduced_from_its_sample_counts() {
    let folder = Folder::new();
    let stats: Value = folder.stats(&format!("{BALL} --time 0.3 -o timed.png --checkpoint timed.jfilm"));
    assert!(stats["seconds"]["render"].as_f64().unwrap() < 10.0);
    let hash = stats["film"]["hash"].as_str().unwrap();
    for file in ["timed.png", "timed.jfilm"] {
        assert_eq!(folder.hash(&format!("{BALL} --samples-from {file} -o again.png")), hash, "{file}");
    }
    assert_eq!(fs::read(folder.path("again.png")).unwrap(), fs::read(folder.path("timed.png")).unwrap());
    assert!(folder.bad("render ball.json --samples-from timed.png", 2).contains("another picture"));
    folder.good(&format!("render {BALL} -o plain.png -q"));
    assert!(
        folder
            .bad(&format!("render {BALL} --samples-from plain.png"), 2)
            .contains("does not contain the numbers of samples")
    );
    // The command in the metadata names the file itself, at its current path.
    fs::rename(folder.path("timed.png"), folder.path("moved.png")).unwrap();
    let reported = folder.good("info moved.png").stdout;
    assert!(reported.contains("--samples-from moved.png"), "{reported}");
}

#[test]
fn unwritable_checkpoint_does_not_lose_the_picture() {
    let folder = Folder::new();
    // A limit on file sizes stands for a full disk: the picture fits, the checkpoint does not.
    let program = env!("CARGO_BIN_EXE_juggler");
    let line = format!(
        "trap '' XFSZ; ulimit -f 40; exec {program} render ball.json --size 96x64 --samples 16 -o a.png --checkpoint a.jfilm"
    );
    let mut shell = std::process::Command::new("sh");
    let run = Run::of(shell.args(["-c", &line]).current_dir(folder.path(".")).output().unwrap());
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stderr.contains("cannot write `a.jfilm`") && run.stdout.starts_with("a.png: "), "{}", run.stderr);
    folder.good("render ball.json --size 96x64 --samples 16 -o b.png -q");
    assert!(fs::read(folder.path("a.png")).unwrap() == fs::read(folder.path("b.png")).unwrap());
    // A failed AOV file does not prevent the picture either.
    let message = folder.bad("render ball.json --aov depth -q -o c.png --aov-output /dev/null/a.exr", 3);
    assert!(message.contains("/dev/null/a.exr"), "{message}");
}

#[test]
fn pictures_that_end_by_noise_or_time_say_how_many_samples_they_got() {
    let folder = Folder::new();
    let line = format!("render {BALL} --integrator path --noise 0.2");
    let run = folder.good(&format!("{line} -o a.png --stats a.json"));
    let stats: Value = serde_json::from_str(&fs::read_to_string(folder.path("a.json")).unwrap()).unwrap();
    let spread = &stats["samples_per_pixel"];
    let [min, mean, max] = ["min", "mean", "max"].map(|key| spread[key].as_f64().unwrap());
    assert!(min >= 64.0 && min <= mean && mean <= max && max < 65_536.0, "{spread}");
    assert_eq!(stats["samples"].as_f64(), Some(max));
    assert!(run.stdout.contains(&format!("{min} to {max} samples, ")) || min == max, "{}", run.stdout);
    let reported = folder.good("info a.png").stdout;
    assert!(reported.contains(&format!("Samples      {min}")) && !reported.contains("65536"), "{reported}");
    // The shards merge to identical bytes.
    for shard in 0..2 {
        folder.good(&format!("{line} -q --shard {shard}/2 -o {shard}.jfilm"));
    }
    let merged = folder.good("merge 0.jfilm 1.jfilm -o b.png --stats - -q").stdout;
    assert!(fs::read(folder.path("a.png")).unwrap() == fs::read(folder.path("b.png")).unwrap());
    assert_eq!(serde_json::from_str::<Value>(&merged).unwrap()["samples_per_pixel"], *spread);
    let run = folder.run(&format!("render {BALL} --time 3 -o t.png --progress json"));
    let events: Vec<Value> = run.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let progress = events.iter().find(|event| event["event"] == "progress").unwrap();
    assert!(events[0]["samples"].is_null() && progress["limit_seconds"] == 3.0, "{progress}");
    assert!(progress["eta_seconds"].as_f64().unwrap() < 2.9 && progress["fraction"].as_f64().unwrap() > 0.1);
    assert!(!run.stdout.contains("16777216") && !folder.good("info t.png").stdout.contains("16777216"));
}
