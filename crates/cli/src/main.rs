//! The program `juggler`: what was typed ([`args`]), what it means ([`plan`]), and doing it ([`command`]).

mod args;
mod command;
mod console;
mod failure;
mod format;
mod interrupt;
mod output;
mod plan;
mod progress;
mod reproduce;
mod source;
mod stats;
mod value;

use clap::{CommandFactory, FromArgMatches};
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut parser = args::Args::command().color(console::color_choice());
    let parsed = parser.try_get_matches_from_mut(args::with_optional_values(std::env::args_os()));
    let args = match parsed.and_then(|matches| args::Args::from_arg_matches(&matches)) {
        Ok(args) => args,
        Err(error) => {
            // Help and version go to standard output, mistakes to standard error; a closed pipe is no mistake.
            let _ = error.print();
            return if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS };
        }
    };
    match args.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(message) = failure.message(console::color()) {
                console::say(&message);
            }
            failure.into()
        }
    }
}
