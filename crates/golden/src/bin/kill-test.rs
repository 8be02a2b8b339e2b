//! Kills renders at random times and checks that the finished pictures are bit for bit the same.
//!
//! ```text
//! cargo run --release -p juggler-golden --bin kill-test -- [TRIALS] [SEED]
//! ```
//!
//! Every trial renders a scene with a checkpoint, kills the program (SIGKILL) after a random time,
//! and starts the same command again, until the picture is complete. Its hash must equal that of an
//! undisturbed render. The times depend only on the seed; where a kill interrupts the program
//! depends on the machine, too.

use juggler::math::hash;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Command lines to render; each takes about a second.
const CASES: [&str; 5] = [
    "juggler --size 320x180 --samples 64",
    "step-12b --size 200x120 --noise 0.02 --samples 512",
    "chess --size 320x180 --samples 33",
    "cornell-cube --size 160x120 --samples 100 --crop 5,7,100,90",
    "depth-of-field --size 240x160 --samples 64 --seed 7",
];

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1).map(|arg| arg.parse::<u32>());
    match (args.next().unwrap_or(Ok(100)), args.next().unwrap_or(Ok(1))) {
        (Ok(trials), Ok(seed)) => match run(trials, seed) {
            Ok(0) => ExitCode::SUCCESS,
            Ok(_) => ExitCode::FAILURE,
            Err(error) => report(&format!("kill-test: {error}"), ExitCode::from(3)),
        },
        _ => report("usage: kill-test [TRIALS] [SEED]", ExitCode::from(2)),
    }
}

#[expect(clippy::print_stderr, reason = "a program")]
fn report(message: &str, code: ExitCode) -> ExitCode {
    eprintln!("{message}");
    code
}

/// Pseudorandom numbers from the seed.
struct Random(u32);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = hash::mix(self.0.wrapping_add(0x9e37_79b9));
        self.0 % end.max(1)
    }
}

/// Runs all trials; returns the number of failures.
#[expect(clippy::print_stdout, reason = "a program")]
fn run(trials: u32, seed: u32) -> Outcome<u32> {
    let program = build()?;
    let folder = std::env::temp_dir().join(format!("juggler-kill-test-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let mut random = Random(seed);
    let mut expected = Vec::new();
    for case in CASES {
        let start = Instant::now();
        let hash = finish(start_render(&program, &folder, case, &["--threads", "2"])?)?;
        expected.push((hash, start.elapsed()));
    }
    let (mut failed, mut kills) = (0, 0);
    for trial in 0..trials {
        let number = random.below(CASES.len() as u32) as usize;
        let (hash, time) = &expected[number];
        let found = render_with_kills(&program, &folder, CASES[number], *time, &mut random)?;
        kills += found.kills;
        let fine = found.hash == *hash;
        failed += u32::from(!fine);
        let verdict = if fine { "same" } else { "DIFFERENT" };
        println!("trial {trial}: {}, {} kills: {verdict} {}", CASES[number], found.kills, found.hash);
    }
    println!("{trials} trials, {kills} kills, {failed} pictures that differ (seed {seed})");
    std::fs::remove_dir_all(&folder)?;
    Ok(failed)
}

/// Builds the program with the same profile as this one; returns its path.
fn build() -> Outcome<PathBuf> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["build", "--quiet", "--package", "juggler-cli"]);
    if !cfg!(debug_assertions) {
        command.arg("--release");
    }
    if !command.status()?.success() {
        return Err("the program cannot be built".into());
    }
    Ok(std::env::current_exe()?.with_file_name("juggler"))
}

fn start_render(program: &Path, folder: &Path, case: &str, flags: &[&str]) -> Outcome<Child> {
    let mut command = Command::new(program);
    command.arg("render").args(case.split(' ')).args(flags).args(["-o", "out.pfm", "--quiet", "--stats", "-"]);
    Ok(command.current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?)
}

/// Waits for a render to finish; returns the hash of the picture.
fn finish(child: Child) -> Outcome<String> {
    let output = child.wait_with_output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let stats: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    Ok(stats["film"]["hash"].as_str().unwrap_or_default().to_owned())
}

struct KilledRender {
    hash: String,
    kills: u32,
}

/// Renders with kills, each after a random fraction of the time of an undisturbed render.
fn render_with_kills(
    program: &Path,
    folder: &Path,
    case: &str,
    time: Duration,
    random: &mut Random,
) -> Outcome<KilledRender> {
    let _ = std::fs::remove_file(folder.join("kept.jfilm"));
    let _ = std::fs::remove_file(folder.join("kept.jfilm.previous"));
    let every = format!("{}", 0.005 + f64::from(random.below(100)) * 0.001);
    let mut kills = 0;
    loop {
        let threads = (1 + random.below(3)).to_string();
        let flags = ["--checkpoint", "kept.jfilm", "--checkpoint-every", &every, "--threads", &threads];
        let mut child = start_render(program, folder, case, &flags)?;
        let wait = time.mul_f64(f64::from(random.below(1000)) * 0.0008);
        let start = Instant::now();
        while start.elapsed() < wait && child.try_wait()?.is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        // Let the last start finish, so that the trial ends.
        if kills >= 12 || child.try_wait()?.is_some() {
            return Ok(KilledRender { hash: finish(child)?, kills });
        }
        child.kill()?;
        child.wait()?;
        kills += 1;
    }
}
