//! `juggler completions SHELL`: what a shell needs to complete commands and flags.

use crate::args::Args;
use crate::console;
use crate::failure::Failure;
use clap_complete::{Shell, generate};

/// Shown after the help.
pub const EXAMPLES: &str = "\
Examples:
  juggler completions bash > ~/.local/share/bash-completion/completions/juggler
  juggler completions zsh > \"${fpath[1]}/_juggler\"
  juggler completions fish > ~/.config/fish/completions/juggler.fish";

/// Flags of `juggler completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    /// The shell that completes
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    /// Prints the script.
    pub fn run(self) -> Result<(), Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut Args::command_line(), "juggler", &mut script);
        console::print(&String::from_utf8_lossy(&script))
    }
}
