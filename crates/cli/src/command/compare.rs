//! `juggler compare`: how different two pictures are, and whether that is more than noise.

mod memory;
mod noise;
mod side;

use crate::console;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::value;
use clap::Args;
use juggler::imaging::flip::{self, Flip, Range};
use juggler::imaging::{self, Difference, Format, Header, Tone};
use juggler::math::Image;
use noise::Noise;
use serde_json::json;
use side::Side;
use std::path::Path;

/// Pixels up to which FLIP is measured: each takes some hundred bytes, and a pair of light of this size minutes.
const MOST_PIXELS: usize = 1 << 26;

/// Flags of `juggler compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// A picture, or a film part (.jfilm) of a whole one
    picture: String,
    /// What it should look like
    reference: String,
    /// The root mean squared difference up to which they count as equal; without it every bit must be, or noise explain all of it
    /// where both pictures know their variances: film parts, and EXRs rendered with `--aov variance,samples`
    #[arg(long, value_name = "RMSE", value_parser = value::tolerance)]
    tolerance: Option<f64>,
    /// The chance of equals to differ as much, below which noise does not explain it
    #[arg(long, value_name = "P", value_parser = value::chance, default_value = "0.01")]
    significance: f64,
    /// Write a picture of where they look different, from black (the same) by violet and orange to pale yellow; the ending
    /// says the format
    #[arg(long, value_name = "FILE")]
    difference: Option<String>,
    /// Write the numbers as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,
    /// Stay within so much memory: FLIP is left out where it needs more; pictures that do are refused before they are read
    #[arg(long, value_name = "SIZE", value_parser = value::memory)]
    max_memory: Option<u64>,
}

impl Compare {
    /// Prints the differences, and says no when there are too many.
    pub fn run(self) -> Result<(), Failure> {
        let map = self.difference.as_deref().map(|file| Ok::<_, Failure>((file, Format::from_path(Path::new(file))?)));
        let map = map.transpose()?;
        let names = [self.picture.as_str(), self.reference.as_str()];
        let has_room = memory::has_room_for_flip(names, map.is_some(), self.max_memory)?;
        let (picture, reference) = (Side::read(&self.picture)?, Side::read(&self.reference)?);
        let difference = imaging::compare(&picture.image, &reference.image)?;
        // Files of levels hold what a screen shows; where one of them holds light, both are taken as that.
        let range = if picture.is_tone_mapped && reference.is_tone_mapped { Range::Ldr } else { Range::Hdr };
        let flip = if has_room { measured(&picture.image, &reference.image, range, &difference)? } else { None };
        let noise = if difference.same_bits { None } else { Noise::of(&picture, &reference, self.significance) };
        let equal = match self.tolerance {
            Some(most) => difference.rmse <= most,
            None => difference.same_bits || noise.as_ref().and_then(Noise::is_same) == Some(true),
        };
        let (reference, found) = (reference.image, Found { difference, flip, noise, equal });
        if let Some((file, format)) = map {
            write_map(file, format, found.flip.as_ref(), &reference)?;
        }
        if let Some(file) = &self.stats {
            output::write_text(file, &found.to_json())?;
        }
        if self.stats.as_deref() != Some(STANDARD_OUTPUT) {
            console::print(&found.to_words(self.tolerance.is_some()))?;
        }
        if found.equal { Ok(()) } else { Err(Failure::No) }
    }
}

/// FLIP, unless the pictures are too large for it.
fn measured(
    picture: &Image,
    reference: &Image,
    range: Range,
    difference: &Difference,
) -> Result<Option<Flip>, Failure> {
    let pixels = reference.pixels().len();
    if difference.same_bits && pixels <= MOST_PIXELS {
        return Ok(Some(Flip { mean: 0.0, range, map: vec![0.0; pixels] }));
    }
    if pixels > MOST_PIXELS {
        return Ok(None);
    }
    Ok(Some(flip::flip(picture, reference, range, flip::PIXELS_PER_DEGREE)?))
}

/// Writes the map in colours.
fn write_map(file: &str, format: Format, flip: Option<&Flip>, reference: &Image) -> Result<(), Failure> {
    let (width, height) = (reference.width(), reference.height());
    let Some(map) = flip.and_then(|flip| flip::colors(&flip.map, width)) else {
        return Err(Failure::Wrong(format!("--difference is for pictures of up to {MOST_PIXELS} pixels")));
    };
    let tone = Tone { dither: false, ..Tone::default() };
    let header = Header { tone, ..Header::new(width, height) };
    Ok(imaging::write_image(imaging::create(Path::new(file), format, &header)?, &map)?)
}

/// How different they are.
struct Found {
    difference: Difference,
    flip: Option<Flip>,
    noise: Option<Noise>,
    equal: bool,
}

impl Found {
    fn to_words(&self, has_tolerance: bool) -> String {
        let Difference { rmse, relative_mse, largest, same_bits } = self.difference;
        let chance = self.noise.as_ref().and_then(Noise::chance).filter(|_| !has_tolerance);
        let answer = match (self.equal, same_bits, chance) {
            (_, true, _) => "equal to the bit".to_owned(),
            (true, _, Some(chance)) => format!("same up to noise, {chance}"),
            (true, _, None) => "equal within the tolerance".to_owned(),
            (false, _, Some(chance)) => format!("different, {chance}"),
            (false, _, None) => "different".to_owned(),
        };
        let flip = match &self.flip {
            Some(Flip { mean, range, .. }) => format!("{mean:.6e} ({})", range.name()),
            None => "not measured: the pictures are too large".to_owned(),
        };
        let numbers = format!("RMSE    {rmse:.6e}\nrelMSE  {relative_mse:.6e}\nmax     {largest:.6e}\nFLIP    {flip}");
        let noise = self.noise.iter().flat_map(Noise::to_words);
        [answer, numbers].into_iter().chain(noise).collect::<Vec<_>>().join("\n")
    }

    /// Numbers that JSON cannot hold become null.
    fn to_json(&self) -> String {
        let Difference { rmse, relative_mse, largest, same_bits } = self.difference;
        let flip = self.flip.as_ref();
        let flip = flip.map(|Flip { mean, range, .. }| json!({"mean": mean, "range": range.name().to_lowercase()}));
        let mut json = json!({
            "version": 1, "equal": self.equal, "same_bits": same_bits,
            "rmse": rmse, "relative_mse": relative_mse, "max": largest, "flip": flip,
        });
        if let (Some(object), Some(noise)) = (json.as_object_mut(), &self.noise) {
            object.insert("noise".to_owned(), noise.to_json());
        }
        json.to_string()
    }
}
