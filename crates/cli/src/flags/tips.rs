//! Suggestions for unknown flags. The parser's own suggestions are misleading for flags of other
//! renderers, so these come first.

use super::table::{FLAGS, Flag};
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Error};
use juggler::math::message;
use juggler::scene::{built_in_scenes, suggest};
use std::ffi::OsString;
use std::path::Path;

/// Replaces the parser's suggestion by a better one, or removes it. A tip leads only to flags of
/// the command that the words name.
pub fn with_tip(mut error: Error, program: &Command, words: &[OsString]) -> Error {
    if error.kind() == ErrorKind::InvalidSubcommand {
        return with_command(error);
    }
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg).cloned() else { return error };
    let name = flag.split([' ', '=']).next().unwrap_or_default();
    let ours = tip_of(name, command_of(program, words));
    let keeps_suggestion = match error.get(ContextKind::SuggestedArg) {
        Some(ContextValue::String(suggested)) => {
            ours.is_none() && suggest::closest(name, [flag_name(suggested)]).is_some()
        }
        _ => false,
    };
    if !keeps_suggestion {
        error.remove(ContextKind::SuggestedArg);
    }
    // Remove the suggestion to pass the flag as a value.
    error.remove(ContextKind::Suggested);
    if let Some(tip) = ours {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    error
}

/// Adds the commands for a scene that stands in place of a command.
fn with_command(mut error: Error) -> Error {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand).cloned() else { return error };
    let is_file = Path::new(&word).extension().is_some() || Path::new(&word).exists();
    if is_file || built_in_scenes().iter().any(|scene| scene.name == word) {
        let word = message::excerpt(&word, message::MAX_QUOTE);
        let tip = format!("write 'juggler render {word}' for a picture of it; 'juggler --help' lists all commands");
        error.remove(ContextKind::SuggestedSubcommand);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    error
}

/// The command that the words name; the program itself if they name none.
fn command_of<'c>(program: &'c Command, words: &[OsString]) -> &'c Command {
    words.iter().skip(1).find_map(|word| program.find_subcommand(word)).unwrap_or(program)
}

/// Tip for a name that a flag of the command has in other programs.
fn tip_of(name: &str, command: &Command) -> Option<&'static str> {
    let has = |flag: &Flag| command.get_arguments().any(|argument| argument.get_long() == Some(flag.name));
    let tip = |flag: &'static Flag| flag.tip.filter(|(_, names)| names.contains(&name)).map(|(tip, _)| tip);
    FLAGS.iter().filter(|flag| has(flag)).find_map(tip)
}

/// `--samples <N>` without its value name.
fn flag_name(flag: &str) -> &str {
    flag.split([' ', '=', '[']).next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::command_line::CommandLine;
    use clap::ColorChoice;
    use std::ffi::OsString;

    fn refused(line: &str) -> String {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        CommandLine::parse_words(&words, ColorChoice::Never).unwrap_err().to_string()
    }

    #[test]
    fn flags_of_other_programs_lead_to_ours() {
        for (typed, reported) in [
            ("--width 640", "--size WxH"),
            ("--width=640", "--size WxH"),
            ("-s 4", "--samples N"),
            ("--spp 4", "--samples N"),
            ("-j 4", "--threads N"),
        ] {
            let message = refused(&format!("juggler render a {typed}"));
            assert!(message.contains(&format!("tip: {reported}")), "{message}");
            assert!(!message.contains("as a value") && !message.contains("--white-balance"), "{message}");
        }
    }

    #[test]
    fn scenes_in_place_of_a_command_lead_to_render() {
        for scene in ["vase.glb", "a/b.json", "juggler", "."] {
            let message = refused(&format!("juggler {scene}"));
            assert!(message.contains(&format!("juggler render {scene}")), "{message}");
        }
        let message = refused("juggler rendr");
        assert!(message.contains("'render'") && !message.contains("juggler render rendr"), "{message}");
    }

    #[test]
    fn tips_lead_only_to_flags_of_the_command() {
        assert!(!refused("juggler merge a.jfilm -o a.png --spp 4").contains("--samples"));
        assert!(refused("juggler merge a.jfilm --outfile a.png").contains("--output FILE"));
    }

    #[test]
    fn misspelled_flags_keep_their_suggestion_and_unknown_flags_get_none() {
        assert!(refused("juggler render a --sampels 4").contains("'--samples'"));
        assert!(!refused("juggler render a --zebra").contains("tip:"));
    }

    #[test]
    fn negative_numbers_are_values_of_flags() {
        for flag in ["--samples -4", "--threads -1", "--seed -7", "--time -3"] {
            let message = refused(&format!("juggler render a {flag}"));
            let value = flag.split(' ').nth(1).unwrap();
            assert!(message.contains(&format!("'{value}'")) && !message.contains("as a value"), "{message}");
            assert!(!message.contains("unexpected"), "{message}");
        }
    }
}
