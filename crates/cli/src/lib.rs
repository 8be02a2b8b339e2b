//! The program `juggler` as a library: [`run`] does what a command line says. The words become
//! flags (`args`, `flags`) of a command (`command`); a render derives a plan (`plan`) from them.

mod args;
mod command;
mod command_line;
mod console;
mod encoding;
mod failure;
mod flags;
mod format;
mod interrupt;
mod memory;
mod model_args;
mod output;
mod plan;
mod plans;
mod progress;
mod reproduce;
mod source;
mod stage_args;
mod stats;
mod target;
mod value;

use command_line::CommandLine;
use std::ffi::OsString;

/// Exit status of a wrong command line.
const WRONG_COMMAND_LINE: u8 = 2;

/// Runs the program with the words of a command line, the first of which is the program's name.
/// Prints results to standard output and messages to standard error, and returns the exit status: 0
/// done, 1 negative result, 2 wrong input, 3 system error, 128 + n signal n.
///
/// The call handles signals of the whole process while it runs.
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    interrupt::ignore_file_size_signal();
    let words: Vec<OsString> = words.into_iter().collect();
    let command_line = match CommandLine::parse_words(&words, console::color_choice()) {
        Ok(command_line) => command_line,
        Err(error) => {
            // Help and version go to standard output, errors to standard error.
            console::print_parse_error(&error);
            return if error.use_stderr() { WRONG_COMMAND_LINE } else { 0 };
        }
    };
    match command_line.command.run(CommandLine::command_line) {
        Ok(()) => 0,
        Err(failure) => {
            if let Some(message) = failure.message(console::color()) {
                console::print_message(&message);
            }
            failure.status()
        }
    }
}
