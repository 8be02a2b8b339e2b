//! The program `juggler`: command line ([`args`]), plan of a render ([`plan`]) and commands
//! ([`command`]).

mod args;
mod command;
mod console;
mod failure;
mod format;
mod interrupt;
mod memory;
mod model_args;
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
    interrupt::ignore_file_size_signal();
    let words: Vec<_> = std::env::args_os().collect();
    let args = match args::Args::parse_arguments(&words, console::color_choice()) {
        Ok(args) => args,
        Err(error) => {
            // Help and version go to standard output, errors to standard error.
            console::print_parse_error(&error);
            return if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS };
        }
    };
    match args.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(message) = failure.message(console::color()) {
                console::print_message(&message);
            }
            failure.into()
        }
    }
}
