//! Runs numbered cases in separate processes with a limited address space, which catches excessive
//! allocation; a time limit catches endless cases.

use crate::{fields, mutate, seeds, targets};
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// Limit of a process's address space, in bytes.
const MAX_MEMORY: u64 = 2 << 30;
/// Time limit of one case.
const TIME_LIMIT: Duration = Duration::from_secs(10);
/// Time limit of a process until its first case, which includes the list of all fields.
const START_LIMIT: Duration = Duration::from_secs(60);
/// Kind of the cases generated from the schema.
pub const FIELDS: &str = "fields";

/// Results of the cases of one kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Number of accepted cases: read without error, or rendered.
    pub accepted: u64,
    /// Failures, with their case numbers.
    pub failures: Vec<String>,
}

/// Runs the cases `first..end` in this process and reports each to `say` by the protocol of
/// [`run`].
pub fn run_in_process(kind: &str, first: u64, end: u64, say: &mut dyn FnMut(String)) {
    let (seeds, fields) = (seeds::for_target(kind), if kind == FIELDS { fields::fields() } else { Vec::new() });
    for case in first..end {
        say(format!("case {case}"));
        if kind == FIELDS {
            let (path, text) = fields::case(&fields, case);
            match fields::render(&text) {
                Ok(rendered) => say(format!("{} {path}", if rendered { "taken" } else { "refused" })),
                Err(broken) => say(format!("broken {path}: {broken}: {text}").replace('\n', " ")),
            }
        } else if let Some(target) = targets::by_name(kind) {
            let accepted = (target.read)(&mutate::mutate(&seeds, case));
            say(if accepted { "taken" } else { "refused" }.to_owned());
        }
    }
}

/// Runs `count` cases of a kind by `program`, which is this crate's binary `cases`. If a case ends
/// the process, a new one continues with the next case.
pub fn run(program: &str, kind: &str, count: u64) -> Outcome {
    let mut outcome = Outcome { accepted: 0, failures: Vec::new() };
    let mut first = 0;
    while first < count && outcome.failures.len() < 20 {
        match start(program, kind, first, count) {
            Ok(child) => first = read_results(child, kind, first, count, &mut outcome),
            Err(error) => {
                outcome.failures.push(format!("{program} does not start: {error}"));
                break;
            }
        }
    }
    outcome
}

fn start(program: &str, kind: &str, first: u64, end: u64) -> std::io::Result<Child> {
    let line = format!("ulimit -v {}; exec \"$@\"", MAX_MEMORY / 1024);
    let mut command = Command::new("sh");
    command.args(["-c", &line, "sh", program, kind, &first.to_string(), &end.to_string()]);
    // Threads reserve address space for stacks and allocator arenas, so use few of them.
    command.env("RAYON_NUM_THREADS", "2").env("RUST_BACKTRACE", "0");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
}

/// Reads the output of a process until it ends. Returns the number of the next case.
fn read_results(mut child: Child, kind: &str, first: u64, end: u64, outcome: &mut Outcome) -> u64 {
    let (sender, lines) = mpsc::channel();
    let out = child.stdout.take();
    let listener = std::thread::spawn(move || {
        let lines = out.into_iter().flat_map(|out| BufReader::new(out).lines());
        lines.map_while(Result::ok).try_for_each(|line| sender.send(line)).is_ok()
    });
    let (mut case, mut limit) = (first, START_LIMIT);
    let failure = loop {
        match lines.recv_timeout(limit) {
            Ok(line) => match line.split_once(' ').unwrap_or((&line, "")) {
                ("case", number) => case = number.parse().unwrap_or(case),
                ("taken", _) => outcome.accepted += 1,
                ("broken", what) => outcome.failures.push(format!("{kind} {case}: {what}")),
                _ => {}
            },
            Err(RecvTimeoutError::Timeout) => {
                let _ = child.kill();
                break Some(format!("takes longer than {} s", limit.as_secs()));
            }
            Err(RecvTimeoutError::Disconnected) => break None,
        }
        limit = TIME_LIMIT;
    };
    let _ = listener.join();
    let status = child.wait().map(|status| status.to_string());
    let failure = failure.or_else(|| match &status {
        Ok(status) if status.ends_with(": 0") => None,
        Ok(status) => Some(format!("{status}: {}", stderr_text(&mut child))),
        Err(error) => Some(error.to_string()),
    });
    let Some(failure) = failure else { return end };
    outcome.failures.push(format!("{kind} {case}: {failure}"));
    case + 1
}

/// Beginning of a process's standard error.
fn stderr_text(child: &mut Child) -> String {
    let mut text = String::new();
    if let Some(err) = &mut child.stderr {
        let _ = err.read_to_string(&mut text);
    }
    text.trim().chars().take(600).collect()
}
