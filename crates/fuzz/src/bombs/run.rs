//! Runs the program on a bomb and judges the result.

use super::{Bomb, Content};
use juggler::imaging;
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Time limit of one command line.
const TIME_LIMIT: Duration = Duration::from_secs(10);
/// Limit of the address space, in bytes: a memory budget of 512 MiB, plus address space that
/// threads and libraries reserve but do not use.
const ADDRESS_SPACE: u64 = 2 << 30;

/// Result of one command line.
#[derive(Clone, Debug, Default)]
pub struct BombResult {
    /// The command line.
    pub line: String,
    /// Exit status; `None` if a signal or the time limit ended the program.
    pub status: Option<i32>,
    /// Run time in seconds.
    pub seconds: f64,
    /// Description of the failure; `None` if the program behaved as promised.
    pub fault: Option<String>,
}

/// Runs all command lines of a bomb in a new folder.
pub fn run(program: &Path, bomb: &Bomb) -> io::Result<Vec<BombResult>> {
    let folder = tempfile::tempdir()?;
    for (name, content) in &bomb.files {
        put(&folder.path().join(name), content)?;
    }
    bomb.lines.iter().map(|line| run_line(program, folder.path(), line, &bomb.must_name)).collect()
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

fn run_line(program: &Path, folder: &Path, line: &str, must_name: &str) -> io::Result<BombResult> {
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
            None if start.elapsed() > TIME_LIMIT => {
                child.kill()?;
                child.wait()?;
                break None;
            }
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let code = status.and_then(|status| status.code());
    let output = format!("{}{}", text(&out)?, text(&err)?);
    let fault = match (status, code) {
        (None, _) => Some(format!("takes longer than {} s", TIME_LIMIT.as_secs())),
        (Some(status), None) => Some(format!("ended by a signal: {status}")),
        (_, Some(code)) => fault(code, &output, must_name).or_else(|| not_finite(&folder.join("bomb.pfm"))),
    };
    let fault = fault.map(|fault| format!("{fault}: {}", output.chars().take(500).collect::<String>().trim()));
    let line = line.chars().take(200).collect();
    Ok(BombResult { line, status: code, seconds, fault })
}

/// Reads at most the first MiB of a text file.
fn text(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    fs::File::open(path)?.take(1 << 20).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn fault(code: i32, output: &str, must_name: &str) -> Option<String> {
    if output.contains("panicked") || !(0..=3).contains(&code) {
        return Some(format!("status {code}"));
    }
    if output.chars().any(|c| c.is_control() && !"\n\t".contains(c)) {
        return Some("what it says holds characters that a terminal obeys".to_owned());
    }
    if output.len() > 100_000 {
        return Some("it says too much".to_owned());
    }
    (code > 1 && !output.contains(must_name)).then(|| format!("the refusal does not name `{must_name}`"))
}

/// Describes a pixel of the rendered picture that is not finite, if there is one.
fn not_finite(picture: &Path) -> Option<String> {
    let image = imaging::read(picture).ok()?;
    let pixel = image.pixels().iter().find(|pixel| !pixel.is_finite())?;
    Some(format!("a pixel is not finite: {pixel:?}"))
}
