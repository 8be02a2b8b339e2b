//! `cases KIND FIRST END` runs numbered cases of one kind and prints the result of each.
//! `cases KIND CASE` writes the bytes of one case to standard output. Kinds are the names of the
//! readers, and `fields`.

use juggler_fuzz::{cases, fields, mutate, seeds};
use std::io::{self, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let number = |word: &str| word.parse::<u64>().ok();
    let mut out = io::stdout();
    let written = match words.as_slice() {
        [kind, first, end] => match (number(first), number(end)) {
            (Some(first), Some(end)) => {
                // Ignore write errors: the parent has exited.
                cases::run_in_process(kind, first, end, &mut |line| {
                    drop(writeln!(out, "{line}").and_then(|()| out.flush()));
                });
                Ok(())
            }
            _ => return ExitCode::from(2),
        },
        [cases::FIELDS, case] => {
            let (_, text) = fields::case(&fields::fields(), number(case).unwrap_or(0));
            out.write_all(text.as_bytes())
        }
        [kind, case] => out.write_all(&mutate::mutate(&seeds::for_target(kind), number(case).unwrap_or(0))),
        _ => return ExitCode::from(2),
    };
    if written.is_ok() { ExitCode::SUCCESS } else { ExitCode::from(3) }
}
