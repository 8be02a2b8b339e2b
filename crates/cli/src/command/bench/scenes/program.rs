//! A program that renders the scenes: this one or another version of it.

use super::quantity::Quantity;
use crate::failure::{Failure, plain};
use serde::Deserialize;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Output};

/// The program that counts instructions.
const VALGRIND: &str = "valgrind";
/// Beginning of each line of valgrind's messages.
const VALGRIND_MARK: &str = "==";
/// Beginning of the version of every version of Juggler.
const NAME: &str = "juggler ";

/// A program to measure.
pub struct Program {
    /// Path, or name to look up in `PATH`.
    pub path: String,
    pub version: String,
}

/// A render of a benchmark scene.
pub struct Job<'j> {
    pub scene: &'j Path,
    pub flags: &'j [String],
    /// Samples per pixel.
    pub samples: u32,
    /// Picture to write.
    pub output: &'j Path,
}

/// What a program reports about a render by `--stats`. Old versions report less.
#[derive(Deserialize)]
struct Statistics {
    seconds: Seconds,
    rays: Rays,
    film: FilmHash,
    #[serde(default)]
    program: Build,
}

#[derive(Deserialize)]
struct Seconds {
    cpu: Option<f64>,
}

#[derive(Deserialize)]
struct Rays {
    total: u64,
}

#[derive(Deserialize)]
struct FilmHash {
    hash: String,
}

/// What a program reports about itself.
#[derive(Clone, Default, Deserialize)]
pub struct Build {
    pub compiler: Option<String>,
    pub simd: Option<String>,
}

/// A finished render.
pub struct Render {
    /// Cost: instructions of the whole process, or CPU seconds of rendering.
    pub cost: f64,
    pub rays: u64,
    /// Hash of the picture.
    pub hash: String,
    pub build: Build,
}

impl Program {
    /// Finds a program and asks for its version.
    ///
    /// # Errors
    ///
    /// Fails if the program cannot be started or is not Juggler.
    pub fn find(path: String) -> Result<Self, Failure> {
        let output = Command::new(&path).arg("--version").output().map_err(|error| cannot_run(&path, &error))?;
        let text = String::from_utf8_lossy(&output.stdout);
        match text.trim().strip_prefix(NAME).filter(|_| output.status.success()) {
            Some(version) => Ok(Self { version: version.to_owned(), path }),
            None => Err(Failure::Invalid(format!(
                "`{path}` is not the program juggler, whose --version begins with `{NAME}`; --program and --beside \
                 name programs"
            ))),
        }
    }

    /// Renders on one thread and measures the cost.
    ///
    /// # Errors
    ///
    /// Fails if the program fails or does not report what is measured.
    pub fn render(&self, job: &Job, quantity: Quantity) -> Result<Render, Failure> {
        let mut command = match quantity {
            Quantity::CpuTime => Command::new(&self.path),
            Quantity::Instructions => {
                let mut command = Command::new(VALGRIND);
                // The program may be a script that starts another one.
                let flags =
                    ["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", "--trace-children=yes"];
                command.args(flags).arg(&self.path);
                command
            }
        };
        command.arg("render").arg(job.scene).args(job.flags).args(["--samples", &job.samples.to_string()]);
        command.args(["--threads", "1", "--quiet", "--stats", "-", "--output"]).arg(job.output);
        let output = command.output().map_err(|error| cannot_run(&command.get_program().to_string_lossy(), &error))?;
        let statistics = self.statistics(&output)?;
        let messages = String::from_utf8_lossy(&output.stderr);
        let cost = match quantity {
            Quantity::Instructions => instructions(&messages).map(|count| count as f64),
            Quantity::CpuTime => statistics.seconds.cpu,
        };
        let what = if quantity == Quantity::Instructions { "instructions" } else { "CPU time" };
        let cost = cost.ok_or_else(|| self.failure(&format!("reports no {what}"), &messages))?;
        let Statistics { rays, film, program, .. } = statistics;
        Ok(Render { cost, rays: rays.total, hash: film.hash, build: program })
    }

    fn statistics(&self, output: &Output) -> Result<Statistics, Failure> {
        let messages = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            return Err(self.failure(&format!("failed with {}", output.status), &messages));
        }
        let statistics = serde_json::from_slice(&output.stdout);
        statistics.map_err(|error| self.failure(&format!("reports no statistics ({error})"), &messages))
    }

    /// Failure of a render, with the messages of the program.
    fn failure(&self, what: &str, messages: &str) -> Failure {
        let own: Vec<&str> = messages.lines().filter(|line| !line.starts_with(VALGRIND_MARK)).collect();
        let gap = if own.is_empty() { "" } else { ":\n" };
        Failure::System(format!("`{} render` {what}{gap}{}", self.path, own.join("\n")))
    }
}

/// Version of valgrind; `None` if it is not installed.
pub fn valgrind_version() -> Option<String> {
    let output = Command::new(VALGRIND).arg("--version").output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    Some(text.trim().strip_prefix("valgrind-")?.to_owned())
}

/// Instructions in the messages of cachegrind: the number of the line `I refs`.
fn instructions(messages: &str) -> Option<u64> {
    messages.lines().find_map(|line| {
        let (head, count) = line.strip_prefix(VALGRIND_MARK)?.split_once("refs:")?;
        let is_instructions = head.split_whitespace().last() == Some("I");
        count.trim().replace(',', "").parse().ok().filter(|_| is_instructions)
    })
}

fn cannot_run(path: &str, error: &std::io::Error) -> Failure {
    match error.kind() {
        ErrorKind::NotFound => Failure::System(format!("there is no program `{path}`")),
        _ => Failure::System(format!("cannot run `{path}`: {}", plain(error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_those_of_every_version_of_cachegrind() {
        let old = "==7== Cachegrind, a cache and branch-prediction profiler\n==7== \n==7== I   refs:      1,234,567\n";
        let new = "==7== I refs:        28\n";
        assert_eq!((instructions(old), instructions(new)), (Some(1_234_567), Some(28)));
        let other = "==7== I1  misses: 3\n==7== D   refs: 5 (2 rd + 3 wr)\nI refs: 7\n==7== I refs: many\n";
        assert_eq!(instructions(other), None);
    }
}
