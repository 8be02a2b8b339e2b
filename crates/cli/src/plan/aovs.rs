//! AOVs: selection and output files.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use juggler::Aov;
use juggler::imaging::layered::PLACEHOLDER;
use std::path::Path;

/// Output of the AOVs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AovOutput {
    /// Layers of the picture's own EXR file.
    InPicture,
    /// A separate file, or one file per AOV if the name contains a placeholder.
    File(String),
}

/// Requested AOVs.
///
/// # Errors
///
/// Fails for unknown names, and without a valid output for them.
pub fn requested(args: &RenderArgs, output: &str) -> Result<Vec<Aov>, Failure> {
    let wrong = |message: &str| Err(Failure::Invalid(message.into()));
    let aovs = args.aov.as_deref().map(Aov::list).transpose()?;
    match (aovs, &args.aov_output) {
        (None, None) => Ok(Vec::new()),
        (None, Some(_)) => wrong("--aov-output needs AOVs to write: list them with --aov"),
        (Some(_), None) if output == STANDARD_OUTPUT => {
            wrong("--aov needs a file for the AOVs: give one with --aov-output")
        }
        (Some(aovs), Some(file)) => {
            check(file)?;
            Ok(aovs)
        }
        (Some(aovs), None) => Ok(aovs),
    }
}

/// Checks that a file of this name can hold AOVs.
pub fn check(file: &str) -> Result<(), Failure> {
    let ending = Path::new(file).extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("exr") => Ok(()),
        Some("npy") if file.contains(PLACEHOLDER) => Ok(()),
        _ => Err(Failure::Invalid(format!(
            "`{file}`: AOVs go to one .exr, or to one .exr or .npy per AOV if the name contains `{PLACEHOLDER}`"
        ))),
    }
}

/// Output of the AOVs of the picture `output`; `file` is the file given by a flag.
pub fn output_for(output: &str, file: Option<&str>) -> AovOutput {
    let path = Path::new(output);
    match file {
        Some(file) => AovOutput::File(file.to_owned()),
        None if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr")) => AovOutput::InPicture,
        None => AovOutput::File(path.with_extension("layers.exr").to_string_lossy().into_owned()),
    }
}

/// File for the AOVs of a frame.
pub fn numbered(file: Option<&str>, frame: u32) -> Option<String> {
    file.map(|file| output::numbered(file, frame))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aovs_are_written_into_the_picture_where_its_format_holds_layers() {
        assert_eq!(output_for("a/b.EXR", None), AovOutput::InPicture);
        assert_eq!(output_for("a/b.png", None), AovOutput::File("a/b.layers.exr".into()));
        assert_eq!(output_for("a/b.exr", Some("c.exr")), AovOutput::File("c.exr".into()));
        assert_eq!(numbered(Some("l/{}_##.npy"), 7), Some("l/{}_07.npy".into()));
    }
}
