//! `juggler compare`: how different two pictures are.

use crate::console;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::value;
use clap::Args;
use juggler::imaging::flip::{self, Flip, Range};
use juggler::imaging::{self, Difference, Format, Header, Tone};
use juggler::math::Image;
use serde_json::json;
use std::path::Path;

/// Pixels up to which FLIP is measured: each takes some hundred bytes, and a pair of light of this size minutes.
const MOST_PIXELS: usize = 1 << 26;

/// Flags of `juggler compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// A picture
    picture: String,
    /// What it should look like
    reference: String,
    /// The root mean squared difference up to which they count as equal; without it every bit must be
    #[arg(long, value_name = "RMSE", value_parser = value::tolerance)]
    tolerance: Option<f64>,
    /// Write a picture of where they look different, from black (the same) by violet and orange to pale yellow; the ending
    /// says the format
    #[arg(long, value_name = "FILE")]
    difference: Option<String>,
    /// Write the numbers as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,
}

impl Compare {
    /// Prints the differences, and says no when there are too many.
    pub fn run(self) -> Result<(), Failure> {
        let map = self.difference.as_deref().map(|file| Ok::<_, Failure>((file, Format::from_path(Path::new(file))?)));
        let map = map.transpose()?;
        let read = |name: &str| imaging::read(Path::new(name));
        let (picture, reference) = (read(&self.picture)?, read(&self.reference)?);
        let difference = imaging::compare(&picture, &reference)?;
        let range = self.range()?;
        let flip = measured(&picture, &reference, range, &difference)?;
        let equal = match self.tolerance {
            Some(most) => difference.rmse <= most,
            None => difference.same_bits,
        };
        if let Some((file, format)) = map {
            write_map(file, format, flip.as_ref(), &reference)?;
        }
        if let Some(file) = &self.stats {
            output::write_text(file, &to_json(&difference, flip.as_ref(), equal))?;
        }
        if self.stats.as_deref() != Some(STANDARD_OUTPUT) {
            console::print(&to_words(&difference, flip.as_ref(), equal))?;
        }
        if equal { Ok(()) } else { Err(Failure::No) }
    }

    /// Files of levels hold what a screen shows; where one of them holds light, both are taken as that.
    fn range(&self) -> Result<Range, Failure> {
        let is_of_levels = |name: &str| imaging::inspect(Path::new(name)).map(|facts| facts.format.is_tone_mapped());
        let levels = is_of_levels(&self.picture)? && is_of_levels(&self.reference)?;
        Ok(if levels { Range::Ldr } else { Range::Hdr })
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

fn to_words(difference: &Difference, flip: Option<&Flip>, equal: bool) -> String {
    let answer = match (equal, difference.same_bits) {
        (_, true) => "equal to the bit",
        (true, false) => "equal within the tolerance",
        (false, _) => "different",
    };
    let Difference { rmse, relative_mse, largest, .. } = difference;
    let flip = match flip {
        Some(Flip { mean, range, .. }) => format!("{mean:.6e} ({})", range.name()),
        None => "not measured: the pictures are too large".to_owned(),
    };
    format!("{answer}\nRMSE    {rmse:.6e}\nrelMSE  {relative_mse:.6e}\nmax     {largest:.6e}\nFLIP    {flip}")
}

/// Numbers that JSON cannot hold become null.
fn to_json(difference: &Difference, flip: Option<&Flip>, equal: bool) -> String {
    let Difference { rmse, relative_mse, largest, same_bits } = difference;
    let flip = flip.map(|Flip { mean, range, .. }| json!({"mean": mean, "range": range.name().to_lowercase()}));
    json!({
        "version": 1, "equal": equal, "same_bits": same_bits,
        "rmse": rmse, "relative_mse": relative_mse, "max": largest, "flip": flip,
    })
    .to_string()
}
