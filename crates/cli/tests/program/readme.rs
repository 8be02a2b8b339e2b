//! Runs the commands in the console blocks of README.md and of the documentation and compares their
//! output.
#![cfg(target_os = "linux")]

use crate::harness::{self, Folder, Run, wait_until};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Pages with console blocks.
const PAGES: [(&str, &str); 2] = [
    ("README.md", include_str!("../../../../README.md")),
    ("docs/probe.md", include_str!("../../../../docs/probe.md")),
];

/// Scene whose mistakes README shows.
const WRONG: &str = r##"{
  "version": 1,
  "materials": {"red": {"phong": {"diffuse": "#c02020"}}},
  "objects": [
    {"shape": {"spere": {"radius": 1}}, "material": "red"},
    {"shape": "sphere", "material": "rde"}
  ]
}
"##;

/// A command of a console block, with the output that the page shows; a last line `...` stands for lines
/// that it leaves out.
struct Step {
    command: String,
    shown: Vec<String>,
}

/// Steps of each console block of a page.
fn blocks(page: &str) -> Vec<Vec<Step>> {
    let blocks = page.split("```console\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.map(|block| steps(block).collect()).collect()
}

fn steps(block: &str) -> impl Iterator<Item = Step> {
    let commands = block.trim_end().split("$ ").filter(|command| !command.is_empty());
    commands.map(|command| {
        let mut lines = command.lines().map(str::to_owned);
        let command = lines.next().unwrap_or_default();
        Step { command, shown: lines.collect() }
    })
}

/// Starts a command line in a shell that finds the program. Simple commands replace the shell.
fn typed(folder: &Folder, line: &str) -> Child {
    let program = Path::new(env!("CARGO_BIN_EXE_juggler")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let simple = !line.contains(['|', '&']);
    let line = if simple { format!("exec {line} 2>&1") } else { line.to_owned() };
    let mut command = Command::new("sh");
    command.args(["-c", &line]).env("PATH", path).current_dir(folder.path("."));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Sends SIGINT as soon as the program handles it. The program registers SIGTERM next; shells
/// handle SIGINT, but not SIGTERM.
fn interrupt(child: &Child) {
    let status = format!("/proc/{}/status", child.id());
    let catches = || {
        let status = fs::read_to_string(&status).unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).map(str::trim);
        mask.and_then(|mask| u64::from_str_radix(mask, 16).ok()).is_some_and(|mask| mask & (1 << 14) != 0)
    };
    wait_until("the program to watch for signals", catches);
    harness::signal(child, "-INT");
}

/// Output of a command; after `^C`, the program is interrupted.
fn run(folder: &Folder, step: &Step) -> Vec<String> {
    let child = typed(folder, &step.command);
    let is_interrupted = step.shown.first().is_some_and(|line| line == "^C");
    if is_interrupted {
        interrupt(&child);
    }
    let Run { stdout, .. } = Run::of(child.wait_with_output().unwrap());
    let typed = is_interrupted.then(|| "^C".to_owned());
    typed.into_iter().chain(stdout.lines().map(str::to_owned)).collect()
}

/// Whether two lines are equal except for measured values.
fn alike(shown: &str, printed: &str) -> bool {
    let pairs = shown.split_whitespace().zip(printed.split_whitespace());
    let same_length = shown.split_whitespace().count() == printed.split_whitespace().count();
    same_length && pairs.into_iter().all(|(a, b)| a == b || (is_measured(a) && is_measured(b)))
}

/// Whether a word depends on the machine's speed, such as `1.21s,`, `9m56s`, `41.2` or `million`.
fn is_measured(word: &str) -> bool {
    let number = word.starts_with(|c: char| c.is_ascii_digit());
    let unit = word.trim_end_matches(',').trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let is_time = unit.is_empty() || unit == "s" || unit == "ms" || (unit.starts_with('m') && unit.ends_with('s'));
    (number && is_time) || ["thousand", "million", "billion"].contains(&word)
}

#[test]
fn pages_show_what_is_printed() {
    for (page, text) in PAGES {
        check_page(page, &blocks(text));
    }
}

fn check_page(page: &str, blocks: &[Vec<Step>]) {
    let folder = Folder::new();
    fs::write(folder.path("wrong.json"), WRONG).unwrap();
    assert!(blocks.iter().flatten().count() >= 5, "{page}");
    for step in blocks.iter().flatten() {
        let mut printed = run(&folder, step);
        let left_out = step.shown.last().is_some_and(|line| line == "...");
        let shown = step.shown.len() - usize::from(left_out);
        if left_out {
            printed.truncate(shown);
        }
        let same = printed.len() == shown;
        assert!(
            same && step.shown.iter().zip(&printed).all(|(shown, printed)| alike(shown, printed)),
            "`{}` prints\n{}\n{page} shows\n{}",
            step.command,
            printed.join("\n"),
            step.shown.join("\n")
        );
    }
}

#[test]
fn differences_are_seen() {
    assert!(alike("a: 64 samples, 1.21s, 7.1 million rays/s", "a: 64 samples, 850ms, 950 thousand rays/s"));
    assert!(!alike("the same file", "the same files") && !alike("\"hash\":\"1f\"", "\"hash\":\"2f\""));
    assert!(!alike("2 errors", "2 errors found"));
}
