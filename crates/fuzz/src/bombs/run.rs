//! Gives a bomb to the program, and judges what comes back.

use super::{Bomb, Content};
use juggler::imaging;
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time that the program may take for one command line.
const PATIENCE: Duration = Duration::from_secs(10);
/// Address space: a budget of 512 MiB, and what threads and libraries reserve and never use.
const ADDRESS_SPACE: u64 = 2 << 30;

/// What came of one command line.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// The command line.
    pub line: String,
    /// The exit status, if the program ended by itself.
    pub status: Option<i32>,
    /// Seconds.
    pub seconds: f64,
    /// What is wrong with it; nothing where the promise is kept.
    pub fault: Option<String>,
}

/// Runs all command lines of a bomb in a fresh folder.
pub fn run(program: &Path, bomb: &Bomb) -> io::Result<Vec<Verdict>> {
    let folder = tempfile::tempdir()?;
    for (name, content) in &bomb.files {
        put(&folder.path().join(name), content)?;
    }
    bomb.lines.iter().map(|line| run_line(program, folder.path(), line, &bomb.place)).collect()
}

#[cfg(unix)]
fn put(path: &Path, content: &Content) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    match content {
        Content::Bytes(bytes) => fs::write(path, bytes),
        Content::Folder => fs::create_dir(path),
        Content::Link(target) => std::os::unix::fs::symlink(target, path),
        Content::Pipe => Command::new("mkfifo").arg(path).status().map(drop),
        Content::Closed => {
            fs::write(path, "closed")?;
            fs::set_permissions(path, fs::Permissions::from_mode(0o0))
        }
    }
}

#[cfg(not(unix))]
fn put(path: &Path, content: &Content) -> io::Result<()> {
    match content {
        Content::Bytes(bytes) => fs::write(path, bytes),
        Content::Folder => fs::create_dir(path),
        _ => Err(io::ErrorKind::Unsupported.into()),
    }
}

fn run_line(program: &Path, folder: &Path, line: &str, place: &str) -> io::Result<Verdict> {
    let limited = format!("ulimit -v {}; exec \"$@\"", ADDRESS_SPACE / 1024);
    let (out, err) = (folder.join(".out"), folder.join(".err"));
    let mut command = Command::new("sh");
    command.args(["-c", &limited, "sh"]).arg(program).args(line.split_whitespace()).current_dir(folder);
    command.env("RAYON_NUM_THREADS", "2").stdin(Stdio::null());
    let mut child = command.stdout(fs::File::create(&out)?).stderr(fs::File::create(&err)?).spawn()?;
    let start = Instant::now();
    let status = loop {
        match child.try_wait()? {
            Some(status) => break Some(status),
            None if start.elapsed() > PATIENCE => {
                child.kill()?;
                child.wait()?;
                break None;
            }
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let code = status.and_then(|status| status.code());
    let told = format!("{}{}", text(&out)?, text(&err)?);
    let fault = match (status, code) {
        (None, _) => Some(format!("takes longer than {} s", PATIENCE.as_secs())),
        (Some(status), None) => Some(format!("ended by a signal: {status}")),
        (_, Some(code)) => fault(code, &told, place).or_else(|| not_finite(&folder.join("bomb.pfm"))),
    };
    let fault = fault.map(|fault| format!("{fault}: {}", told.chars().take(500).collect::<String>().trim()));
    let line = line.chars().take(200).collect();
    Ok(Verdict { line, status: code, seconds, fault })
}

/// As much of a file as is looked at.
fn text(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    fs::File::open(path)?.take(1 << 20).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn fault(code: i32, told: &str, place: &str) -> Option<String> {
    if told.contains("panicked") || !(0..=3).contains(&code) {
        return Some(format!("status {code}"));
    }
    if told.chars().any(|c| c.is_control() && !"\n\t".contains(c)) {
        return Some("what it says holds characters that a terminal obeys".to_owned());
    }
    if told.len() > 100_000 {
        return Some("it says too much".to_owned());
    }
    (code > 1 && !told.contains(place)).then(|| format!("the refusal does not name `{place}`"))
}

/// What is wrong with the pixels of a picture that was rendered.
fn not_finite(picture: &Path) -> Option<String> {
    let image = imaging::read(picture).ok()?;
    let pixel = image.pixels().iter().find(|pixel| !pixel.is_finite())?;
    Some(format!("a pixel is not finite: {pixel:?}"))
}
