//! The program `juggler`: what was typed ([`args`]), what it means ([`plan`]), and doing it ([`command`]).

mod args;
mod command;
mod console;
mod failure;
mod format;
mod interrupt;
mod memory;
mod output;
mod plan;
mod progress;
mod reproduce;
mod source;
mod stats;
mod tips;
mod value;

use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<_> = std::env::args_os().collect();
    let args = match args::Args::parse_words(&words, console::color_choice()) {
        Ok(args) => args,
        Err(error) => {
            // Help and version go to standard output, mistakes to standard error.
            console::answer(&error);
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
