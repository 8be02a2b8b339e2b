//! The table of all flags: the heading of each in the help, its names in other programs, and the
//! targets on which it cannot act. Headings, tips and refusals follow from it.

mod given;
mod table;
mod targets;
#[cfg(test)]
mod tests;
mod tips;

pub use given::GivenFlags;
pub use tips::with_tip;

use clap::Command;
use table::{FLAGS, OPTIONS};

/// Puts the flags of a command below their headings.
pub fn with_headings(command: Command) -> Command {
    command.mut_args(|arg| {
        let row = arg.get_long().and_then(|name| FLAGS.iter().find(|flag| flag.name == name));
        match row.filter(|flag| flag.heading != OPTIONS) {
            Some(flag) => arg.help_heading(flag.heading),
            None => arg,
        }
    })
}
