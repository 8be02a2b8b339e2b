//! `juggler compare`: measures the difference between two pictures, and tests whether noise
//! explains it.

mod memory;
mod noise;

use crate::console;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::value;
use clap::Args;
use juggler::comparison::{ComparedImage, NoiseTest};
use juggler::imaging::flip::{self, DynamicRange, Flip};
use juggler::imaging::{self, Difference, Header, ImageFormat, Tone};
use juggler::math::Image;
use serde_json::json;
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
    /// Without it, pictures are equal if all bits are equal, or if both contain variances and noise
    /// explains the difference. Variances are in .jfilm files and in EXR files rendered with
    /// `--aov variance,samples`.
    #[arg(long, value_name = "RMSE", value_parser = value::tolerance)]
    tolerance: Option<f64>,
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
        let names = [self.picture.as_str(), self.reference.as_str()];
        let has_room = memory::has_room_for_flip(names, map.is_some(), self.max_memory)?;
        let (picture, reference) =
            (ComparedImage::read(Path::new(&self.picture))?, ComparedImage::read(Path::new(&self.reference))?);
        let difference = imaging::compare(&picture.image, &reference.image)?;
        // Tone-mapped files contain display values. If one file contains linear radiance, compare
        // both as HDR.
        let range =
            if picture.is_tone_mapped && reference.is_tone_mapped { DynamicRange::Ldr } else { DynamicRange::Hdr };
        let flip = if has_room { measured(&picture.image, &reference.image, range, &difference)? } else { None };
        let noise = if difference.same_bits { None } else { NoiseTest::new(&picture, &reference, self.significance) };
        let equal = match self.tolerance {
            Some(most) => difference.rmse <= most,
            None => difference.same_bits || noise.as_ref().and_then(NoiseTest::is_same) == Some(true),
        };
        let (reference, comparison) = (reference.image, Comparison { difference, flip, noise, equal });
        if let Some((file, format)) = map {
            write_map(file, format, comparison.flip.as_ref(), &reference)?;
        }
        if let Some(file) = &self.stats {
            output::write_text(file, &comparison.to_json())?;
        }
        if self.stats.as_deref() != Some(STANDARD_OUTPUT) {
            console::print_result(&comparison.to_words(self.tolerance.is_some()))?;
        }
        if comparison.equal { Ok(()) } else { Err(Failure::Negative) }
    }
}

/// Measures FLIP, unless the pictures are too large.
fn measured(
    picture: &Image,
    reference: &Image,
    range: DynamicRange,
    difference: &Difference,
) -> Result<Option<Flip>, Failure> {
    let pixels = reference.pixels().len();
    if difference.same_bits && pixels <= MAX_PIXELS {
        return Ok(Some(Flip { mean: 0.0, range, map: vec![0.0; pixels] }));
    }
    if pixels > MAX_PIXELS {
        return Ok(None);
    }
    Ok(Some(flip::flip(picture, reference, range, flip::PIXELS_PER_DEGREE)?))
}

/// Writes the map in colors.
fn write_map(file: &str, format: ImageFormat, flip: Option<&Flip>, reference: &Image) -> Result<(), Failure> {
    let (width, height) = (reference.width(), reference.height());
    let Some(map) = flip.and_then(|flip| flip::color_map(&flip.map, width)) else {
        return Err(Failure::Invalid(format!("--difference is for pictures of up to {MAX_PIXELS} pixels")));
    };
    let tone = Tone { dither: false, ..Tone::default() };
    let header = Header { tone, ..Header::new(width, height) };
    Ok(imaging::write_image(imaging::create(Path::new(file), format, &header)?, &map)?)
}

/// Result of a comparison.
struct Comparison {
    difference: Difference,
    flip: Option<Flip>,
    noise: Option<NoiseTest>,
    equal: bool,
}

impl Comparison {
    fn to_words(&self, has_tolerance: bool) -> String {
        let Difference { rmse, relative_mse, largest, same_bits } = self.difference;
        let p_value = self.noise.as_ref().and_then(noise::p_value).filter(|_| !has_tolerance);
        let answer = match (self.equal, same_bits, p_value) {
            (_, true, _) => "identical, bit for bit".to_owned(),
            (true, _, Some(p_value)) => format!("same up to noise, {p_value}"),
            (true, _, None) => "equal within the tolerance".to_owned(),
            (false, _, Some(p_value)) => format!("different, {p_value}"),
            (false, _, None) => "different".to_owned(),
        };
        let flip = match &self.flip {
            Some(Flip { mean, range, .. }) => format!("{mean:.6e} ({})", range.name()),
            None => "not measured: the pictures are too large".to_owned(),
        };
        let numbers = format!("RMSE    {rmse:.6e}\nrelMSE  {relative_mse:.6e}\nmax     {largest:.6e}\nFLIP    {flip}");
        let noise = self.noise.iter().flat_map(noise::to_words);
        [answer, numbers].into_iter().chain(noise).collect::<Vec<_>>().join("\n")
    }

    /// Results as JSON; numbers that JSON cannot represent are null.
    fn to_json(&self) -> String {
        let Difference { rmse, relative_mse, largest, same_bits } = self.difference;
        let flip = self.flip.as_ref();
        let flip = flip.map(|Flip { mean, range, .. }| json!({"mean": mean, "range": range.name().to_lowercase()}));
        let mut json = json!({
            "version": 1, "equal": self.equal, "same_bits": same_bits,
            "rmse": rmse, "relative_mse": relative_mse, "max": largest, "flip": flip,
        });
        if let (Some(object), Some(noise)) = (json.as_object_mut(), &self.noise) {
            object.insert("noise".to_owned(), noise::to_json(noise));
        }
        json.to_string()
    }
}
