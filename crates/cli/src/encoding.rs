//! Kind of output and its encoding.

use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use juggler::imaging::{AnimationFormat, DisplayLook, ImageError, ImageFormat, Options, SampleDepth};
use std::path::Path;

/// Extension of partial renders.
pub const PARTIAL_RENDER_EXTENSION: &str = "jfilm";

/// Kind of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// A picture.
    Picture(Encoding),
    /// A partial render.
    PartialRender,
}

/// File format and its options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    /// File format.
    pub format: ImageFormat,
    /// Encoding options.
    pub options: Options,
}

/// What flags choose about an encoding.
#[derive(Clone, Copy, Debug, Default)]
pub struct EncodingChoice<'a> {
    /// File format, instead of the one that the output's extension selects.
    pub format: Option<&'a str>,
    /// Bits per channel.
    pub bits: Option<u8>,
    /// Quality of a JPEG, 1 to 100.
    pub quality: Option<u8>,
    /// Display look.
    pub look: Option<DisplayLook>,
}

impl EncodingChoice<'_> {
    /// Whether an output of this name is a partial render.
    pub fn is_partial_render(&self, output: &str) -> bool {
        match self.format {
            Some(name) => name == PARTIAL_RENDER_EXTENSION,
            None => Path::new(output)
                .extension()
                .is_some_and(|ending| ending.eq_ignore_ascii_case(PARTIAL_RENDER_EXTENSION)),
        }
    }
}

impl OutputKind {
    /// Output kind from the output's extension and the flags.
    ///
    /// # Errors
    ///
    /// Fails for unknown formats and extensions, and for a partial render on standard output.
    pub fn new(choice: EncodingChoice<'_>, output: &str) -> Result<Self, Failure> {
        match output {
            STANDARD_OUTPUT if choice.is_partial_render(output) => {
                Err(Failure::Invalid("a partial render needs a file: it cannot be written to standard output".into()))
            }
            _ if choice.is_partial_render(output) => Ok(Self::PartialRender),
            _ if choice.format.is_none() && output != STANDARD_OUTPUT && !is_picture(output) => {
                Err(Failure::Invalid(unknown_extension(output)))
            }
            _ => Ok(Self::Picture(Encoding::new(choice, output)?)),
        }
    }
}

fn is_picture(output: &str) -> bool {
    ImageFormat::from_path(Path::new(output)).is_ok()
}

/// Error message for an unknown extension, with all supported ones.
fn unknown_extension(output: &str) -> String {
    if let Err(error @ ImageError::ReadOnly { .. }) = ImageFormat::from_path(Path::new(output)) {
        return error.to_string();
    }
    let ending = Path::new(output).extension().map(|ending| ending.to_string_lossy());
    let wrong = match ending {
        Some(ending) => format!("unknown extension `.{ending}`"),
        None => "the name has no extension to select the format".to_owned(),
    };
    let (pictures, movies) = (ImageFormat::extensions(), AnimationFormat::extensions());
    format!(
        "`{output}`: {wrong}; supported: pictures {pictures}, movies {movies}, partial renders \
         .{PARTIAL_RENDER_EXTENSION} (or give --format)"
    )
}

impl Encoding {
    /// Encoding from `--format`, or else from the output's extension.
    ///
    /// # Errors
    ///
    /// Fails for unknown formats and extensions, and for numbers of bits that a format lacks.
    pub fn new(choice: EncodingChoice<'_>, output: &str) -> Result<Self, Failure> {
        let wrong = |message: String| Failure::Invalid(message);
        let format = match choice.format {
            Some(name) => ImageFormat::from_path(Path::new(&format!("picture.{name}")))
                .map_err(|_| wrong(unknown_format(name)))?,
            None if output == STANDARD_OUTPUT => ImageFormat::Png,
            None => ImageFormat::from_path(Path::new(output)).map_err(|error| wrong(error.to_string()))?,
        };
        let mut options = Options::default();
        if let Some(bits) = choice.bits {
            set_bits(&mut options, format, bits)?;
        }
        options.jpeg_quality = choice.quality.unwrap_or(options.jpeg_quality);
        options.look = choice.look.unwrap_or_default();
        Ok(Self { format, options })
    }
}

fn unknown_format(name: &str) -> String {
    let (pictures, movies) = (ImageFormat::extensions(), AnimationFormat::extensions());
    format!("unknown format `{name}`; supported: pictures {pictures}, movies {movies}").replace(" .", " ")
}

fn set_bits(options: &mut Options, format: ImageFormat, bits: u8) -> Result<(), Failure> {
    let possible: &[u8] = match format {
        ImageFormat::Png => &[8, 16],
        ImageFormat::Exr => &[16, 32],
        ImageFormat::Pfm => &[32],
        _ => &[8],
    };
    if !possible.contains(&bits) {
        let possible = possible.iter().map(u8::to_string).collect::<Vec<_>>().join(" or ");
        return Err(Failure::Invalid(format!("a {format} file has {possible} bits per channel, not {bits}")));
    }
    options.png_16_bit = bits == 16;
    options.exr_depth = if bits == 16 { SampleDepth::Half } else { SampleDepth::Float };
    Ok(())
}
