//! How fast a session follows: frames a second while the camera moves, and the time from an edit to the first frame.
//!
//! `cargo bench -p juggler-session --bench frames [-- THREADS] [SCENE]` prints two tables, or of one scene its frames
//! a second.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::scene::built_in_scenes;
use juggler_session::{Edit, Fly, Options, Session, Setting, Stage};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Frames that are measured, and edits.
const FRAMES: usize = 120;
const EDITS: usize = 9;
/// The mesh's vertices to a side: a million triangles.
const SIDE: u32 = 708;

fn main() -> std::io::Result<()> {
    let threads = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(2);
    let one = std::env::args().skip(1).find(|word| built_in_scenes().iter().any(|scene| scene.name == *word));
    let options = |budget| Options { size: Some([640, 480]), threads, budget, ..Options::default() };
    println!("640 x 480, {threads} threads, one ray through each pixel's centre\n");
    println!("{:<34} {:>9} {:>9}", "full resolution while it moves", "frames/s", "slowest");
    let wanted = |name: &&str| one.as_ref().map_or(name.starts_with("scalablitz-"), |one| one == name);
    for name in built_in_scenes().iter().map(|scene| scene.name).filter(wanted) {
        // A budget that nothing exceeds: never coarse.
        let session = Session::open(name, options(Duration::from_secs(100)));
        settle(&session);
        session.edit(Edit::Setting(Setting::MaxDepth(2)));
        let mut times: Vec<Duration> = (0..FRAMES).map(|i| step(&session, i)).collect();
        let total: Duration = times.iter().sum();
        times.sort();
        let slowest = times[FRAMES * 95 / 100].as_secs_f64() * 1e3;
        println!("{name:<34} {:>9.1} {slowest:>6.1} ms", FRAMES as f64 / total.as_secs_f64());
    }
    if one.is_some() {
        return Ok(());
    }
    println!("\n{:<34} {:>9} {:>9}", "from an edit to its frame", "median", "slowest");
    for scene in built_in_scenes() {
        follow(scene.name, &Session::open(scene.name, options(Options::default().budget)));
    }
    let folder = tempfile::tempdir()?;
    let hills = hills(folder.path())?;
    follow("a million triangles", &Session::open(&hills.to_string_lossy(), options(Options::default().budget)));
    Ok(())
}

/// Waits until a scene is there, and a little more: its picture is being refined.
fn settle(session: &Session) {
    while session.frame().is_none() || session.status().stage == Stage::Loading {
        session.wait(0, u64::MAX, Duration::from_secs(1));
    }
    std::thread::sleep(Duration::from_millis(300));
}

/// Moves the camera and waits for the frame that shows it.
fn step(session: &Session, i: usize) -> Duration {
    let yaw_degrees = if i.is_multiple_of(40) { -10.0 } else { 0.25 };
    let begin = Instant::now();
    let revision = session.edit(Edit::Fly(Fly { yaw_degrees, ..Fly::default() }));
    let mut seen = 0;
    loop {
        if let Some(frame) = session.frame() {
            if frame.revision >= revision {
                return begin.elapsed();
            }
            seen = frame.number;
        }
        session.wait(seen, u64::MAX, Duration::from_secs(1));
    }
}

fn follow(name: &str, session: &Session) {
    settle(session);
    let mut times: Vec<Duration> = (1..=EDITS)
        .map(|i| {
            let time = step(session, i);
            // Long enough for the picture to be refined again.
            std::thread::sleep(Duration::from_millis(100));
            time
        })
        .collect();
    times.sort();
    let [median, slowest] = [times[EDITS / 2], times[EDITS - 1]].map(|time| time.as_secs_f64() * 1e3);
    println!("{name:<34} {median:>6.1} ms {slowest:>6.1} ms");
}

/// A scene of hills of a million triangles, and its mesh, in a folder.
fn hills(folder: &Path) -> std::io::Result<PathBuf> {
    let height = |x: f32, y: f32| ((x * 9.0).sin() + (y * 7.0).cos() + (x * 31.0 + y * 17.0).sin() * 0.3) * 0.1;
    let at = |i: u32| i as f32 / (SIDE - 1) as f32 * 4.0 - 2.0;
    let (vertices, quads) = (SIDE * SIDE, (SIDE - 1) * (SIDE - 1));
    let mut ply = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        quads * 2
    )
    .into_bytes();
    for i in 0..vertices {
        let (x, z) = (at(i % SIDE), at(i / SIDE));
        ply.extend([x, height(x, z), z].into_iter().flat_map(f32::to_le_bytes));
    }
    for i in (0..quads).map(|i| i % (SIDE - 1) + i / (SIDE - 1) * SIDE) {
        for triangle in [[i, i + SIDE, i + 1], [i + 1, i + SIDE, i + SIDE + 1]] {
            ply.push(3);
            ply.extend(triangle.into_iter().flat_map(u32::to_le_bytes));
        }
    }
    std::fs::write(folder.join("hills.ply"), ply)?;
    let scene = folder.join("hills.json");
    std::fs::write(&scene, r#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "hills.ply"}}}]}"#)?;
    Ok(scene)
}
