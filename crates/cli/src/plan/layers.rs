//! Layers beside the picture: which, and where they go.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use juggler::Aov;
use juggler::imaging::layered::PLACEHOLDER;
use std::path::Path;

/// Where layers go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Into the picture's own file, an EXR.
    InPicture,
    /// Into a file of this name, or a file for each layer where it holds a placeholder.
    File(String),
}

/// The AOVs that were asked for.
pub fn wanted(args: &RenderArgs, output: &str) -> Result<Vec<Aov>, Failure> {
    let wrong = |message: &str| Err(Failure::Wrong(message.into()));
    let layers = args.aov.as_deref().map(Aov::list).transpose()?;
    match (layers, &args.aov_output) {
        (None, None) => Ok(Vec::new()),
        (None, Some(_)) => wrong("--aov-output says where AOVs go: say which with --aov"),
        (Some(_), None) if output == STANDARD_OUTPUT => {
            wrong("--aov needs a file for the AOVs: give one with --aov-output")
        }
        (Some(layers), Some(file)) => {
            check(file)?;
            Ok(layers)
        }
        (Some(layers), None) => Ok(layers),
    }
}

/// Whether layers can be written to a file of that name.
pub fn check(file: &str) -> Result<(), Failure> {
    let ending = Path::new(file).extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("exr") => Ok(()),
        Some("npy") if file.contains(PLACEHOLDER) => Ok(()),
        _ => Err(Failure::Wrong(format!(
            "`{file}`: layers go into one .exr, or one .exr or .npy each where the name holds `{PLACEHOLDER}` for theirs"
        ))),
    }
}

/// Where the layers of a picture go that is written to `output`, when `asked` was asked for.
pub fn place(output: &str, asked: Option<&str>) -> Place {
    let path = Path::new(output);
    match asked {
        Some(file) => Place::File(file.to_owned()),
        None if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr")) => Place::InPicture,
        None => Place::File(path.with_extension("layers.exr").to_string_lossy().into_owned()),
    }
}

/// The same for one of several frames.
pub fn numbered(asked: Option<&str>, frame: u32) -> Option<String> {
    asked.map(|file| output::numbered(file, frame))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_go_into_the_picture_where_it_can_hold_them() {
        assert_eq!(place("a/b.EXR", None), Place::InPicture);
        assert_eq!(place("a/b.png", None), Place::File("a/b.layers.exr".into()));
        assert_eq!(place("a/b.exr", Some("c.exr")), Place::File("c.exr".into()));
        assert_eq!(numbered(Some("l/{}_##.npy"), 7), Some("l/{}_07.npy".into()));
    }
}
