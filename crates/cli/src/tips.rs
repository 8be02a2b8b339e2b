//! Suggestions for unknown flags. The parser's own suggestions are misleading for flags of other
//! renderers, so these come first.

use clap::Error;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use juggler::scene::suggest;

/// Flags of other programs, and the corresponding tips.
const FOREIGN_FLAGS: &[(&[&str], &str)] = &[
    (
        &["--width", "--height", "-W", "-H", "--resolution", "--res", "--dimensions", "--geometry"],
        "--size WxH sets width and height, such as --size 640x360",
    ),
    (&["-s", "--spp", "--sample", "--sample-count", "--num-samples"], "--samples N sets the samples per pixel"),
    (&["-t", "-j", "--jobs", "--nthreads", "--num-threads"], "--threads N sets the number of threads"),
    (&["--bounces", "--max-bounces", "--depth", "--path-depth"], "--max-depth N limits the number of path segments"),
    (&["--out", "--outfile", "--output-file", "-O"], "-o FILE, or --output FILE, sets the output file"),
    (&["--timeout", "--time-limit", "--seconds"], "--time SECONDS stops the render after this time"),
    (&["--threshold", "--noise-threshold", "--error"], "--noise LEVEL stops the render at this relative error"),
    (&["--passes", "--layers", "--channels"], "--aov LIST selects the AOVs to write"),
    (&["--start", "--end", "-f", "-a", "--frame-range", "--animation"], "--frames A..B renders several frames"),
    (&["--gamma", "--tonemap", "--tonemapper", "--tone-mapping"], "--tone CURVE sets the tone curve"),
    (&["--ev", "--gain"], "--exposure STOPS makes the picture brighter or darker"),
    (&["--cam", "--view"], "--camera NAME chooses one of the scene's cameras"),
    (&["--region", "--window", "--cropwindow"], "--crop X,Y,W,H renders a rectangle of the picture"),
    (&["--resume", "--continue"], "--checkpoint FILE saves progress; the same command resumes from it"),
    (&["-v", "--verbose"], "--progress bar shows the progress, --stats FILE writes statistics"),
    (&["-V"], "`juggler --version` prints the version"),
];

/// Replaces the parser's suggestion by a better one, or removes it.
pub fn with_tip(mut error: Error) -> Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg).cloned() else { return error };
    let name = flag.split([' ', '=']).next().unwrap_or_default();
    let ours = FOREIGN_FLAGS.iter().find(|(names, _)| names.contains(&name)).map(|(_, tip)| *tip);
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

/// `--samples <N>` without its value name.
fn flag_name(flag: &str) -> &str {
    flag.split([' ', '=', '[']).next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::args::Args;
    use clap::ColorChoice;
    use std::ffi::OsString;

    fn refused(line: &str) -> String {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        Args::parse_arguments(&words, ColorChoice::Never).unwrap_err().to_string()
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
