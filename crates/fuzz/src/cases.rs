//! Runs numbered cases in processes of their own: the address space is limited, so that what asks for too much memory is seen,
//! and a case that does not end is found by the time that nothing is said.

use crate::{fields, mutate, seeds, targets};
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// Address space of a process, in bytes.
const MOST_MEMORY: u64 = 2 << 30;
/// Longest time for one case.
const PATIENCE: Duration = Duration::from_secs(10);
/// Name of the scenes from the schema.
pub const FIELDS: &str = "fields";

/// What cases of one kind came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Cases that were taken: read, or rendered.
    pub taken: u64,
    /// What went wrong, with the number of the case.
    pub failures: Vec<String>,
}

/// Runs the cases from `first` up to, but without, `end` here, and prints what parents want to know.
pub fn run_here(kind: &str, first: u64, end: u64, say: &mut dyn FnMut(String)) {
    let (seeds, fields) = (seeds::of(kind), if kind == FIELDS { fields::fields() } else { Vec::new() });
    for case in first..end {
        say(format!("case {case}"));
        if kind == FIELDS {
            let (path, text) = fields::case(&fields, case);
            match fields::render(&text) {
                Ok(rendered) => say(format!("{} {path}", if rendered { "taken" } else { "refused" })),
                Err(broken) => say(format!("broken {path}: {broken}: {text}").replace('\n', " ")),
            }
        } else if let Some(target) = targets::by_name(kind) {
            let taken = (target.read)(&mutate::mutated(&seeds, case));
            say(if taken { "taken" } else { "refused" }.to_owned());
        }
    }
}

/// Runs `count` cases of a kind by `program`, which is this crate's `cases`. After a case that ends the process another process
/// goes on with the next.
pub fn run(program: &str, kind: &str, count: u64) -> Outcome {
    let mut outcome = Outcome { taken: 0, failures: Vec::new() };
    let mut first = 0;
    while first < count && outcome.failures.len() < 20 {
        match start(program, kind, first, count) {
            Ok(child) => first = follow(child, kind, first, count, &mut outcome),
            Err(error) => {
                outcome.failures.push(format!("{program} does not start: {error}"));
                break;
            }
        }
    }
    outcome
}

fn start(program: &str, kind: &str, first: u64, end: u64) -> std::io::Result<Child> {
    let line = format!("ulimit -v {}; exec \"$@\"", MOST_MEMORY / 1024);
    let mut command = Command::new("sh");
    command.args(["-c", &line, "sh", program, kind, &first.to_string(), &end.to_string()]);
    // Threads have stacks and arenas of address space: few are enough here.
    command.env("RAYON_NUM_THREADS", "2").env("RUST_BACKTRACE", "0");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
}

/// Listens to a process until it ends; the number of the next case.
fn follow(mut child: Child, kind: &str, first: u64, end: u64, outcome: &mut Outcome) -> u64 {
    let (sender, lines) = mpsc::channel();
    let out = child.stdout.take();
    let listener = std::thread::spawn(move || {
        let lines = out.into_iter().flat_map(|out| BufReader::new(out).lines());
        lines.map_while(Result::ok).try_for_each(|line| sender.send(line)).is_ok()
    });
    let mut case = first;
    let failure = loop {
        match lines.recv_timeout(PATIENCE) {
            Ok(line) => match line.split_once(' ').unwrap_or((&line, "")) {
                ("case", number) => case = number.parse().unwrap_or(case),
                ("taken", _) => outcome.taken += 1,
                ("broken", what) => outcome.failures.push(format!("{kind} {case}: {what}")),
                _ => {}
            },
            Err(RecvTimeoutError::Timeout) => {
                let _ = child.kill();
                break Some(format!("takes longer than {} s", PATIENCE.as_secs()));
            }
            Err(RecvTimeoutError::Disconnected) => break None,
        }
    };
    let _ = listener.join();
    let status = child.wait().map(|status| status.to_string());
    let failure = failure.or_else(|| match &status {
        Ok(status) if status.ends_with(": 0") => None,
        Ok(status) => Some(format!("{status}: {}", complaint(&mut child))),
        Err(error) => Some(error.to_string()),
    });
    let Some(failure) = failure else { return end };
    outcome.failures.push(format!("{kind} {case}: {failure}"));
    case + 1
}

/// What a process said last.
fn complaint(child: &mut Child) -> String {
    let mut text = String::new();
    if let Some(err) = &mut child.stderr {
        let _ = err.read_to_string(&mut text);
    }
    text.trim().chars().take(600).collect()
}
