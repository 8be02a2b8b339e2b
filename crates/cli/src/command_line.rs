//! The command line: parsing of its words to a command with its flags.

use crate::command::Command;
use crate::{flags, value};
use clap::{Arg, ColorChoice, CommandFactory, FromArgMatches, Parser};
use juggler::scene::built_in_scenes;
use std::ffi::OsString;
use std::path::Path;

/// Renders 3D scenes and models to pictures and movies, bit-identical on every machine.
#[derive(Debug, Parser)]
#[command(name = "juggler", version, propagate_version = true, max_term_width = 100)]
pub struct CommandLine {
    /// Command to run.
    #[command(subcommand)]
    pub command: Command,
}

impl CommandLine {
    /// Parses a command line. A word after a flag with an optional value is that value if it parses
    /// as one, and the scene otherwise. If neither parses, the error is that of the flag's value.
    pub fn parse_words(words: &[OsString], color: ColorChoice) -> Result<Self, clap::Error> {
        let parse = |words: &[OsString]| {
            let matches = Self::command_line().color(color).try_get_matches_from(words)?;
            Self::from_arg_matches(&matches)
        };
        let parsed = parse(words).or_else(|error| parse(&with_optional_values(words)).map_err(|_| error));
        parsed.map_err(|error| flags::with_tip(error, &Self::command_line(), words))
    }

    /// All commands and their flags. A negative number after a flag is parsed as the flag's value,
    /// so that the error message names the flag.
    pub fn command_line() -> clap::Command {
        let numbers = |flag: Arg| {
            let takes_value = flag.get_long().is_some() && flag.get_action().takes_values();
            if takes_value { flag.allow_negative_numbers(true) } else { flag }
        };
        Self::command().mut_subcommands(|command| flags::with_headings(command).mut_args(numbers))
    }
}

/// Default value of a flag whose value is optional, and whether `word` parses as its value. Returns
/// `None` for all other flags.
fn optional_value(flag: &str, word: &str) -> Option<(&'static str, bool)> {
    match flag {
        "--denoise" => Some(("own", value::denoiser(word).is_ok())),
        "--fireflies" => Some(("10", word.parse::<u32>().is_ok())),
        "--floor" => Some(("solid", value::stage::floor(word).is_ok())),
        _ => None,
    }
}

/// Whether a word is certainly no value of a flag: another flag, or a scene.
fn is_no_value(word: &str) -> bool {
    let is_built_in = || built_in_scenes().iter().any(|scene| scene.name == word);
    word.is_empty()
        || word.starts_with('-')
        || word.contains(['.', '/', '\\'])
        || Path::new(word).exists()
        || is_built_in()
}

/// Inserts the omitted optional values of a command line: `--denoise scene.json` uses the default
/// denoiser and leaves the scene as an argument.
fn with_optional_values(words: &[OsString]) -> Vec<OsString> {
    let end = words.iter().position(|word| word == "--").unwrap_or(words.len());
    let filled = |(at, word): (usize, &OsString)| {
        let next = words.get(at + 1).and_then(|next| next.to_str()).unwrap_or_default();
        match word.to_str().filter(|_| at < end).and_then(|flag| Some((flag, optional_value(flag, next)?))) {
            Some((flag, (default, false))) if is_no_value(next) => format!("{flag}={default}").into(),
            _ => word.clone(),
        }
    };
    words.iter().enumerate().map(filled).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(line: &str) -> String {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        with_optional_values(&words).into_iter().map(|word| word.into_string().unwrap()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn flags_with_optional_values_do_not_consume_the_scene() {
        assert_eq!(filled("render --denoise scene.json -q"), "render --denoise=own scene.json -q");
        assert_eq!(filled("render scene.json --denoise"), "render scene.json --denoise=own");
        assert_eq!(filled("render --denoise oidn scene.json"), "render --denoise oidn scene.json");
        assert_eq!(filled("render --denoise=oidn scene.json"), "render --denoise=oidn scene.json");
        assert_eq!(filled("probe --fireflies juggler"), "probe --fireflies=10 juggler");
        assert_eq!(filled("probe --fireflies 20 juggler"), "probe --fireflies 20 juggler");
        assert_eq!(filled("render -- --denoise"), "render -- --denoise");
        assert_eq!(filled("render a.glb --floor b.glb"), "render a.glb --floor=solid b.glb");
        assert_eq!(filled("render a.glb --floor shadow"), "render a.glb --floor shadow");
        // A misspelled value is an error, not a scene.
        assert_eq!(filled("render a.json --denoise owl"), "render a.json --denoise owl");
    }
}
