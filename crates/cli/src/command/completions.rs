//! `juggler completions SHELL`: completion scripts for shells.

use crate::console;
use crate::failure::Failure;
use clap_complete::{Shell, generate};

/// Text after the help.
pub const EXAMPLES: &str = "\
Examples:
  juggler completions bash > ~/.local/share/bash-completion/completions/juggler
  juggler completions zsh > \"${fpath[1]}/_juggler\"
  juggler completions fish > ~/.config/fish/completions/juggler.fish";

/// Flags of `juggler completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    /// Shell to generate the script for
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    /// Prints the script for the program.
    pub fn run(self, mut program: clap::Command) -> Result<(), Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut program, "juggler", &mut script);
        console::print_result(&String::from_utf8_lossy(&script))
    }
}
