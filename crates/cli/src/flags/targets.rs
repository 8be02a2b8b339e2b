//! Sets of targets.

use crate::target::Target;
use juggler::imaging::{DisplayLook, ImageFormat};

/// A set of targets. Numbered pictures are pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Targets {
    /// One picture.
    SinglePictures,
    /// Pictures that store linear radiance.
    LinearPictures,
    /// Pictures whose format has no quality.
    PicturesWithoutQuality,
    /// Pictures whose format has no display looks.
    PicturesWithoutLook,
    /// Pictures that are never dithered.
    PicturesWithoutDither,
    /// Pictures that cannot be transparent.
    PicturesWithoutAlpha,
    /// Pictures whose format does not store how they were made.
    PicturesWithoutMetadata,
    PartialRenders,
    AllButPartialRenders,
    Movies,
    AllButMovies,
    /// Movies whose format has no quality.
    MoviesWithoutQuality,
    /// Movies whose format does not store how often they play.
    MoviesWithoutPlays,
    /// Movies whose format cannot be transparent.
    MoviesWithoutAlpha,
}

impl Targets {
    /// Whether the set contains a target.
    pub fn contain(self, target: Target) -> bool {
        let picture = target.encoding();
        let is_picture_without = |has: fn(ImageFormat) -> bool| picture.is_some_and(|picture| !has(picture.format));
        match self {
            Self::SinglePictures => matches!(target, Target::Picture(_)),
            Self::LinearPictures => is_picture_without(ImageFormat::is_tone_mapped),
            Self::PicturesWithoutQuality => is_picture_without(|format| format == ImageFormat::Jpeg),
            Self::PicturesWithoutLook => is_picture_without(ImageFormat::supports_display_looks),
            Self::PicturesWithoutDither => picture.is_some_and(|picture| {
                let options = picture.options;
                !picture.format.is_tone_mapped() || options.look != DisplayLook::Plain || options.png_16_bit
            }),
            Self::PicturesWithoutAlpha => picture
                .is_some_and(|picture| !picture.format.stores_alpha() || picture.options.look != DisplayLook::Plain),
            Self::PicturesWithoutMetadata => is_picture_without(ImageFormat::stores_metadata),
            Self::PartialRenders => target == Target::PartialRender,
            Self::AllButPartialRenders => target != Target::PartialRender,
            Self::Movies => matches!(target, Target::Movie(_)),
            Self::AllButMovies => !matches!(target, Target::Movie(_)),
            Self::MoviesWithoutQuality => matches!(target, Target::Movie(format) if !format.has_quality()),
            Self::MoviesWithoutPlays => matches!(target, Target::Movie(format) if !format.stores_play_count()),
            Self::MoviesWithoutAlpha => matches!(target, Target::Movie(format) if !format.stores_alpha()),
        }
    }
}
