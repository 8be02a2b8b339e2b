//! The program `juggler`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(juggler_cli::run(std::env::args_os()))
}
