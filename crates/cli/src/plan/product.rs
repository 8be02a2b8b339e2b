//! What is made, and how it is written.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use juggler::imaging::{Format, Look, Options, SampleDepth};
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
        if !is_part {
            let encoding = Encoding::new(args.format.as_deref(), args.bits, args.quality, output)?;
            return encoding.with_look(args.look).map(Self::Picture);
        }
        let wrong = |message: &str| Err(Failure::Wrong(message.into()));
        match (output, args.bits, args.quality) {
            (STANDARD_OUTPUT, ..) => wrong("a film part needs a file: it cannot go to standard output"),
            (_, Some(_), _) => wrong("--bits is for pictures; a film part keeps the sums as they are"),
            _ if args.look.is_some() => wrong("--look is for pictures; a film part keeps the sums as they are"),
            (_, _, Some(_)) => wrong("--quality is for JPEG and MP4 files; a film part has none"),
            _ => Ok(Self::Part),
        }
    }
}

impl Encoding {
    /// What was asked for, or what the output's ending says.
    pub fn new(format: Option<&str>, bits: Option<u8>, quality: Option<u8>, output: &str) -> Result<Self, Failure> {
        let wrong = |message: String| Failure::Wrong(message);
        let format = match format {
            Some(name) => Format::from_path(Path::new(&format!("picture.{name}")))
                .map_err(|_| wrong(format!("no format is called `{name}`; known are {}", Format::endings())))?,
            None if output == STANDARD_OUTPUT => Format::Png,
            None => Format::from_path(Path::new(output)).map_err(|error| wrong(error.to_string()))?,
        };
        let mut options = Options::default();
        if let Some(bits) = bits {
            set_bits(&mut options, format, bits)?;
        }
        if let Some(quality) = quality {
            if format != Format::Jpeg {
                return Err(wrong(format!("--quality is for JPEG and MP4 files; a {format} file has none")));
            }
            options.jpeg_quality = quality;
        }
        Ok(Self { format, options })
    }

    /// The same with a look, which takes levels.
    pub fn with_look(mut self, look: Option<Look>) -> Result<Self, Failure> {
        if look.is_some() && !self.format.has_looks() {
            return Err(Failure::Wrong(format!("--look is for levels; a {} file keeps light as it is", self.format)));
        }
        self.options.look = look.unwrap_or_default();
        Ok(self)
    }
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
