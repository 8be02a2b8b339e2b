//! Console output: results to standard output, everything else to standard error.

use crate::failure::Failure;
use clap::ColorChoice;
use juggler::imaging::ClampCount;
use juggler::math::message;
use std::io::{self, ErrorKind, IsTerminal, Write};

/// Prints a result. A closed pipe is no error: the reader needs no more.
pub fn print_result(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{}", text.trim_end_matches('\n')).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::file("write", "standard output", &error)),
        _ => Ok(()),
    }
}

/// Warns of the values that the writer of `file` has clamped to the range of half floats.
pub fn warn_of_clamping(clamped: &ClampCount, file: &str, is_quiet: bool) {
    if let Some(warning) = clamped.warning(file).filter(|_| !is_quiet) {
        print_message(&warning);
    }
}

/// Prints a message to standard error in a single write, since other processes may share the log.
/// Errors are ignored.
pub fn print_message(text: &str) {
    let line = format!("{}\n", text.trim_end_matches('\n'));
    let _ = io::stderr().lock().write_all(line.as_bytes());
}

/// Prints the message of the command-line parser, with long arguments shortened. A closed pipe is
/// no error.
pub fn print_parse_error(error: &clap::Error) {
    let message_text = error.render().to_string();
    let shown = message::lines(&message_text);
    if shown == message_text {
        let _ = error.print();
    } else {
        print_message(&shown);
    }
}

/// Whether messages on standard error are colored.
pub fn color() -> bool {
    io::stderr().is_terminal() && !plain()
}

/// Color choice for the command-line parser.
pub fn color_choice() -> ColorChoice {
    if plain() { ColorChoice::Never } else { ColorChoice::Auto }
}

/// Whether the environment asks for text without colors.
fn plain() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    set("NO_COLOR") || std::env::var_os("TERM").is_some_and(|term| term == "dumb")
}
