//! `juggler man`: manual pages, from the same definitions as the help.

use crate::console;
use crate::failure::Failure;
use clap::Command;
use clap_mangen::Man;
use juggler::imaging::atomic;
use std::path::Path;

/// Flags of `juggler man`.
#[derive(Debug, clap::Args)]
pub struct Manual {
    /// Command, such as `render` [default: the page of `juggler` itself]
    command: Option<String>,
    /// Write the pages of all commands into this folder: juggler.1, juggler-render.1 and so on
    #[arg(long, value_name = "FOLDER", conflicts_with = "command")]
    folder: Option<String>,
}

impl Manual {
    /// Prints a page of the program, or writes all pages.
    pub fn run(self, mut program: Command) -> Result<(), Failure> {
        program.build();
        if let Some(folder) = &self.folder {
            let pages = std::iter::once(&program).chain(program.get_subcommands());
            return pages.filter(|command| command.get_name() != "help").try_for_each(|command| write(folder, command));
        }
        let Some(name) = &self.command else { return print(&program) };
        let names: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        juggler::check_name("command", name, names.iter().copied())?;
        program.find_subcommand(name).map_or(Ok(()), print)
    }
}

fn print(command: &Command) -> Result<(), Failure> {
    console::print_result(&String::from_utf8_lossy(&page(command)?))
}

fn write(folder: &str, command: &Command) -> Result<(), Failure> {
    let file = format!("{folder}/{}.1", title(command));
    atomic::write(Path::new(&file), &page(command)?).map_err(|error| Failure::file("write", &file, &error))
}

/// Title of a page, such as `juggler-render`.
fn title(command: &Command) -> String {
    command.get_display_name().unwrap_or(command.get_name()).to_owned()
}

fn page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    let man = Man::new(command.clone()).title(title(command).to_uppercase());
    man.render(&mut page).map_err(|error| Failure::file("write", "the manual page", &error))?;
    Ok(page)
}
