//! What is made, and how it is written.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use juggler::imaging::{AnimationFormat, Format, Look, Options, SampleDepth};
use std::path::Path;

/// The ending of film parts.
pub const PART_ENDING: &str = "jfilm";

/// What is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Product {
    /// A picture.
    Picture(Encoding),
    /// A film part.
    Part,
}

/// A file format with what it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    /// The format.
    pub format: Format,
    /// The choices that it leaves.
    pub options: Options,
}

impl Product {
    /// What the output's name and the flags ask for.
    pub fn new(args: &RenderArgs, output: &str) -> Result<Self, Failure> {
        let is_part = match &args.format {
            Some(name) => name == PART_ENDING,
            None => Path::new(output).extension().is_some_and(|ending| ending.eq_ignore_ascii_case(PART_ENDING)),
        };
        match output {
            _ if !is_part && args.format.is_none() && output != STANDARD_OUTPUT && !is_picture(output) => {
                Err(Failure::Wrong(unknown_ending(output)))
            }
            _ if !is_part => {
                let encoding = Encoding::new(args.format.as_deref(), args.bits, args.quality, output)?;
                Ok(Self::Picture(encoding.with_look(args.look)))
            }
            STANDARD_OUTPUT => Err(Failure::Wrong("a film part needs a file: it cannot go to standard output".into())),
            _ => Ok(Self::Part),
        }
    }
}

fn is_picture(output: &str) -> bool {
    Format::from_path(Path::new(output)).is_ok()
}

/// What to say of a name that tells no format, with all formats that there are.
fn unknown_ending(output: &str) -> String {
    let ending = Path::new(output).extension().map(|ending| ending.to_string_lossy());
    let wrong = match ending {
        Some(ending) => format!("no format has the ending .{ending}"),
        None => "the name has no ending that tells the format".to_owned(),
    };
    let (pictures, movies) = (Format::endings(), AnimationFormat::endings());
    format!(
        "`{output}`: {wrong}; pictures can be {pictures}, movies {movies}, parts of pictures .{PART_ENDING} \
         (or say --format)"
    )
}

impl Encoding {
    /// What was asked for, or what the output's ending says.
    pub fn new(format: Option<&str>, bits: Option<u8>, quality: Option<u8>, output: &str) -> Result<Self, Failure> {
        let wrong = |message: String| Failure::Wrong(message);
        let format = match format {
            Some(name) => {
                Format::from_path(Path::new(&format!("picture.{name}"))).map_err(|_| wrong(unknown_format(name)))?
            }
            None if output == STANDARD_OUTPUT => Format::Png,
            None => Format::from_path(Path::new(output)).map_err(|error| wrong(error.to_string()))?,
        };
        let mut options = Options::default();
        if let Some(bits) = bits {
            set_bits(&mut options, format, bits)?;
        }
        options.jpeg_quality = quality.unwrap_or(options.jpeg_quality);
        Ok(Self { format, options })
    }

    /// The same with a display look.
    pub fn with_look(mut self, look: Option<Look>) -> Self {
        self.options.look = look.unwrap_or_default();
        self
    }
}

fn unknown_format(name: &str) -> String {
    let (pictures, movies) = (Format::endings(), AnimationFormat::endings());
    format!("no format is called `{name}`; pictures can be {pictures}, movies {movies}").replace(" .", " ")
}

fn set_bits(options: &mut Options, format: Format, bits: u8) -> Result<(), Failure> {
    let possible: &[u8] = match format {
        Format::Png => &[8, 16],
        Format::Exr => &[16, 32],
        Format::Pfm => &[32],
        Format::Jpeg | Format::Webp | Format::Hdr => &[8],
    };
    if !possible.contains(&bits) {
        let possible = possible.iter().map(u8::to_string).collect::<Vec<_>>().join(" or ");
        return Err(Failure::Wrong(format!("a {format} file has {possible} bits a channel, not {bits}")));
    }
    options.png_16_bit = bits == 16;
    options.exr_depth = if bits == 16 { SampleDepth::Half } else { SampleDepth::Float };
    Ok(())
}
