//! `juggler compare`: measures the difference between two pictures, and tests whether noise
//! explains it.

mod memory;
mod noise;
mod result;

use crate::console;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::value;
use clap::Args;
use juggler::comparison::{self, ComparedImage, NoiseTest};
use juggler::imaging::flip::{self, Flip};
use juggler::imaging::{self, Difference, Header, ImageFormat, Tone};
use juggler::math::Image;
use result::{CompareLimits, Comparison};
use std::path::Path;

/// Maximum number of pixels for FLIP, which needs more than a hundred bytes per pixel and takes
/// minutes for HDR pictures of this size.
const MAX_PIXELS: usize = 1 << 26;

/// Flags of `juggler compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// Picture, or .jfilm file of a complete picture
    picture: String,
    /// Reference picture
    reference: String,
    /// Maximum root mean squared difference of equal pictures
    ///
    /// Without it and `--flip`, pictures are equal if all bits are equal, or if both contain
    /// variances and noise explains the difference. Variances are in .jfilm files and in EXR files
    /// rendered with `--aov variance,samples`.
    #[arg(long, value_name = "RMSE", value_parser = value::tolerance)]
    tolerance: Option<f64>,
    /// Maximum perceived difference (mean FLIP, 0 to 1) of equal pictures
    ///
    /// With `--tolerance`, both limits must hold.
    #[arg(long, value_name = "LEVEL", value_parser = value::flip)]
    flip: Option<f64>,
    /// Significance level: smallest p-value at which noise explains the difference
    #[arg(long, value_name = "P", value_parser = value::probability, default_value = "0.01")]
    significance: f64,
    /// Write a map of the perceived difference (FLIP); the extension selects the format
    ///
    /// The colors are black for equal pixels, then violet, orange and pale yellow.
    #[arg(long, value_name = "FILE")]
    difference: Option<String>,
    /// Write the results as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,
    /// Memory limit, such as 4G
    ///
    /// FLIP is skipped if it does not fit. Pictures that do not fit are refused before they are
    /// read.
    #[arg(long, value_name = "SIZE", value_parser = value::memory)]
    max_memory: Option<u64>,
}

impl Compare {
    /// Prints the differences, and fails if the pictures are not equal.
    pub fn run(self) -> Result<(), Failure> {
        let map =
            self.difference.as_deref().map(|file| Ok::<_, Failure>((file, ImageFormat::from_path(Path::new(file))?)));
        let map = map.transpose()?;
        let (reference, comparison) = self.measure(map.is_some() || self.flip.is_some())?;
        if let (Some((file, format)), Some(flip)) = (map, &comparison.flip) {
            write_map(file, format, flip, &reference)?;
        }
        let width = reference.width();
        if let Some(file) = &self.stats {
            output::write_text(file, &comparison.to_json(width))?;
        }
        if self.stats.as_deref() != Some(STANDARD_OUTPUT) {
            console::print_result(&comparison.to_words(width))?;
        }
        if comparison.is_equal() { Ok(()) } else { Err(Failure::Negative) }
    }

    /// Compares the pictures; returns the reference, too. Fails without FLIP if that is needed.
    fn measure(&self, needs_flip: bool) -> Result<(Image, Comparison), Failure> {
        let names = [self.picture.as_str(), self.reference.as_str()];
        let has_room = memory::has_room_for_flip(names, needs_flip, self.max_memory)?;
        let (picture, reference) =
            (ComparedImage::read(Path::new(&self.picture))?, ComparedImage::read(Path::new(&self.reference))?);
        let difference = comparison::difference(&picture, &reference)?;
        let flip = if has_room { measured(&picture, &reference, &difference)? } else { None };
        if flip.is_none() && needs_flip {
            let flag = if self.flip.is_some() { "--flip" } else { "--difference" };
            return Err(Failure::Invalid(format!("{flag} is for pictures of up to {MAX_PIXELS} pixels")));
        }
        let noise = if difference.same_bits { None } else { NoiseTest::new(&picture, &reference, self.significance) };
        let limits = CompareLimits { rmse: self.tolerance, flip: self.flip };
        Ok((reference.image, Comparison { difference, flip, noise, limits }))
    }
}

/// Measures FLIP, unless the pictures are too large.
fn measured(
    picture: &ComparedImage,
    reference: &ComparedImage,
    difference: &Difference,
) -> Result<Option<Flip>, Failure> {
    let pixels = reference.image.pixels().len();
    if pixels > MAX_PIXELS {
        return Ok(None);
    }
    if difference.same_bits {
        let range = comparison::dynamic_range(picture, reference);
        return Ok(Some(Flip { mean: 0.0, range, map: vec![0.0; pixels] }));
    }
    Ok(Some(comparison::perceived_difference(picture, reference)?))
}

/// Writes the map in colors.
fn write_map(file: &str, format: ImageFormat, flip: &Flip, reference: &Image) -> Result<(), Failure> {
    let (width, height) = (reference.width(), reference.height());
    let Some(map) = flip::color_map(&flip.map, width) else { return Ok(()) };
    let tone = Tone { dither: false, ..Tone::default() };
    let header = Header { tone, ..Header::new(width, height) };
    Ok(imaging::write_image(imaging::create(Path::new(file), format, &header)?, &map)?)
}
