//! Standard output for results, standard error for everything else.

use crate::failure::Failure;
use clap::ColorChoice;
use juggler::math::message;
use std::io::{self, ErrorKind, IsTerminal, Write};

/// Writes a result. A reader that has gone away is no failure: it has seen enough.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{}", text.trim_end_matches('\n')).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::file("write", "standard output", &error)),
        _ => Ok(()),
    }
}

/// Says something that is no result, in one piece: others may write into the same log. Nobody can be told when that
/// fails.
pub fn say(text: &str) {
    let line = format!("{}\n", text.trim_end_matches('\n'));
    let _ = io::stderr().lock().write_all(line.as_bytes());
}

/// Prints what the parser of command lines answers. Mistakes quote what was typed, which may be long. A closed pipe is
/// no mistake.
pub fn answer(error: &clap::Error) {
    let told = error.render().to_string();
    let shown = message::lines(&told);
    if shown == told {
        let _ = error.print();
    } else {
        say(&shown);
    }
}

/// Whether standard error shows colors.
pub fn color() -> bool {
    io::stderr().is_terminal() && !plain()
}

/// The same for what the command-line parser prints.
pub fn color_choice() -> ColorChoice {
    if plain() { ColorChoice::Never } else { ColorChoice::Auto }
}

/// Whether the environment asks for text without colors.
fn plain() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    set("NO_COLOR") || std::env::var_os("TERM").is_some_and(|term| term == "dumb")
}
