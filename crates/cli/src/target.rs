//! Kind of file that a command writes in the end.

use crate::encoding::{Encoding, OutputKind};
use juggler::imaging::AnimationFormat;

/// Kind of file that a command writes in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A picture.
    Picture(Encoding),
    /// Numbered pictures.
    NumberedPictures(Encoding),
    /// A partial render.
    PartialRender,
    /// A movie.
    Movie(AnimationFormat),
}

impl Target {
    /// Target of a command that writes one file.
    pub fn of_file(output_kind: OutputKind) -> Self {
        match output_kind {
            OutputKind::Picture(encoding) => Self::Picture(encoding),
            OutputKind::PartialRender => Self::PartialRender,
        }
    }

    /// Encoding of a picture, also of numbered ones.
    pub fn encoding(self) -> Option<Encoding> {
        match self {
            Self::Picture(encoding) | Self::NumberedPictures(encoding) => Some(encoding),
            Self::PartialRender | Self::Movie(_) => None,
        }
    }

    /// Name of the file format, for messages.
    pub fn format(self) -> String {
        match self {
            Self::Picture(encoding) | Self::NumberedPictures(encoding) => encoding.format.to_string(),
            Self::PartialRender => "jfilm".to_owned(),
            Self::Movie(format) => format.to_string(),
        }
    }
}
