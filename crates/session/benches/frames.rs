//! Frame rate of a session while the camera moves, and latency from an edit to the first frame.
//!
//! `cargo bench -p juggler-session --bench frames [-- THREADS] [SCENE]` prints one table for each;
//! with SCENE it prints only the frame rate of that scene.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::scene::built_in_scenes;
use juggler_session::{Edit, Fly, Session, SessionOptions, Setting, Stage};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Number of measured frames, then of measured edits.
const FRAMES: usize = 120;
const EDITS: usize = 9;
/// Vertices along each side of the mesh, which has a million triangles.
const SIDE: u32 = 708;

fn main() -> std::io::Result<()> {
    let threads = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(2);
    let one = std::env::args().skip(1).find(|word| built_in_scenes().iter().any(|scene| scene.name == *word));
    let options = |budget| SessionOptions { size: Some([640, 480]), threads, budget, ..SessionOptions::default() };
    println!("640 x 480, {threads} threads, one ray through each pixel's center\n");
    println!("{:<34} {:>9} {:>9}", "full resolution while it moves", "frames/s", "slowest");
    let is_selected = |name: &&str| one.as_ref().map_or(name.starts_with("scalablitz-"), |one| one == name);
    for name in built_in_scenes().iter().map(|scene| scene.name).filter(is_selected) {
        // The budget is never exceeded, so every frame has full resolution.
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
        follow(scene.name, &Session::open(scene.name, options(SessionOptions::default().budget)));
    }
    let folder = tempfile::tempdir()?;
    let hills = hills(folder.path())?;
    follow("a million triangles", &Session::open(&hills.to_string_lossy(), options(SessionOptions::default().budget)));
    Ok(())
}

/// Waits until the scene is loaded and its image is being refined.
fn settle(session: &Session) {
    while session.frame().is_none() || session.status().stage == Stage::Loading {
        session.wait(0, u64::MAX, Duration::from_secs(1));
    }
    std::thread::sleep(Duration::from_millis(300));
}

/// Moves the camera and returns the time until a frame shows the move.
fn step(session: &Session, i: usize) -> Duration {
    let yaw_degrees = if i.is_multiple_of(40) { -10.0 } else { 0.25 };
    let begin = Instant::now();
    let revision = session.edit(Edit::Fly(Fly { yaw_degrees, ..Fly::default() }));
    let mut last_frame = 0;
    loop {
        if let Some(frame) = session.frame() {
            if frame.revision >= revision {
                return begin.elapsed();
            }
            last_frame = frame.number;
        }
        session.wait(last_frame, u64::MAX, Duration::from_secs(1));
    }
}

fn follow(name: &str, session: &Session) {
    settle(session);
    let mut times: Vec<Duration> = (1..=EDITS)
        .map(|i| {
            let time = step(session, i);
            // Let refinement start again.
            std::thread::sleep(Duration::from_millis(100));
            time
        })
        .collect();
    times.sort();
    let [median, slowest] = [times[EDITS / 2], times[EDITS - 1]].map(|time| time.as_secs_f64() * 1e3);
    println!("{name:<34} {median:>6.1} ms {slowest:>6.1} ms");
}

/// Writes a scene with a height field of a million triangles into `folder`.
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
