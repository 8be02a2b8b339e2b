//! `juggler relight`: changes the brightness and color of light groups after rendering, without
//! tracing rays.

use crate::console;
use crate::encoding::{Encoding, EncodingChoice};
use crate::failure::Failure;
use crate::flags::GivenFlags;
use crate::format::duration;
use crate::interrupt::Interrupts;
use crate::output::{self, STANDARD_OUTPUT};
use crate::target::Target;
use clap::Args;
use juggler::camera::film::{Rect, Tile};
use juggler::film::{self, MergeGoal, RenderDescription};
use juggler::imaging::{self, Header, Tone};
use juggler::math::{PixelRows, Rgb};
use juggler::{AovSet, MAX_GAIN};
use std::path::Path;
use std::time::Instant;

/// Flags of `juggler relight`.
#[derive(Debug, Args)]
pub struct Relight {
    #[command(flatten)]
    given: GivenFlags,
    /// All partial renders (.jfilm) of a picture rendered with `--aov light_groups`, in any order
    #[arg(required = true, value_name = "FILM")]
    films: Vec<String>,
    /// Factors of light groups, such as key=2,fill=#ffc080
    ///
    /// The group `rest` contains the lights of no group. A factor is a number or a color; 0
    /// switches a group off.
    #[arg(short, long, value_name = "GROUP=FACTOR")]
    gain: String,
    /// Output file; its extension selects the format
    #[arg(short, long, value_name = "FILE")]
    output: String,
    /// File format, instead of the one that the extension selects
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Bits per channel: 8 or 16 for PNG, 16 or 32 for EXR
    #[arg(long, value_name = "N")]
    bits: Option<u8>,
    /// Quality of a JPEG [default: 95]
    #[arg(long, value_name = "1-100", value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: Option<u8>,
    /// Exposure in stops, instead of that of the render
    #[arg(long, value_name = "STOPS")]
    exposure: Option<f32>,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

impl Relight {
    /// Combines the light groups with the factors and writes the picture.
    pub fn run(self) -> Result<(), Failure> {
        let start = Instant::now();
        output::check_stream(&self.output)?;
        let (format, bits, quality) = (self.format.as_deref(), self.bits, self.quality);
        let encoding = Encoding::new(EncodingChoice { format, bits, quality, look: None }, &self.output)?;
        self.given.check(Target::Picture(encoding))?;
        let Encoding { format, options } = encoding;
        let merge = film::Merge::open(&self.films, MergeGoal::Whole)?;
        let RenderDescription { region, tone, metadata, aovs, viewpoint, .. } = merge.description();
        let set = AovSet::from_description(aovs)?;
        let gains = gains(&self.gain, &set)?;
        let mut tone: Tone = serde_json::from_value(tone.clone()).map_err(|error| {
            Failure::System(format!("cannot read the tone settings of the partial render: {error}"))
        })?;
        tone.exposure_stops = self.exposure.unwrap_or(tone.exposure_stops);
        let mut metadata = metadata.clone();
        metadata.push(("Gain".to_owned(), self.gain.clone()));
        let (viewpoint, crop) = (*viewpoint, merge.description().crop_frame());
        let (transparent, size) = (set.is_transparent(), Header::new(region.width, region.height));
        let header = Header { tone, options, transparent, metadata, viewpoint, crop, ..size };
        let interrupts = Interrupts::watch()?;
        let mut writer = match self.output.as_str() {
            STANDARD_OUTPUT => imaging::to_standard_output(format, &header)?,
            file => imaging::create(Path::new(file), format, &header)?,
        };
        merge.tile_rows(|band, tiles, _| {
            interrupts.check()?;
            let alpha = set.alpha(band, tiles);
            let colors = relit(&set, &gains, band, tiles);
            Ok::<(), Failure>(writer.write_rows(PixelRows { colors: &colors, alpha: alpha.as_deref() })?)
        })?;
        writer.finish()?;
        console::warn_of_clamping(&header.clamped, &self.output, self.quiet);
        self.tell(region, start)
    }

    fn tell(&self, Rect { width, height, .. }: &Rect, start: Instant) -> Result<(), Failure> {
        if self.quiet {
            return Ok(());
        }
        let line = format!("{}: {width}x{height}, {}", self.output, duration(start.elapsed()));
        if self.output == STANDARD_OUTPUT {
            console::print_message(&line);
            return Ok(());
        }
        console::print_result(&line)
    }
}

/// Relights a row of tiles.
fn relit(set: &AovSet, gains: &[Rgb], band: &Rect, tiles: &[Tile]) -> Vec<Rgb> {
    let mut pixels = vec![Rgb::BLACK; band.area() as usize];
    tiles.iter().for_each(|tile| tile.pixels().copy_into(&set.relight(tile, gains), band, &mut pixels));
    pixels
}

/// Factors of the film's light groups, by index.
fn gains(text: &str, set: &AovSet) -> Result<Vec<Rgb>, Failure> {
    let groups = set.light_groups();
    if groups.is_empty() {
        return Err(Failure::Invalid(
            "the partial render contains no light groups: render it with --aov light_groups".into(),
        ));
    }
    let mut gains = vec![Rgb::WHITE; groups.len()];
    for part in text.split(',') {
        let wrong = || Failure::Invalid(format!("`{part}`: a gain is GROUP=FACTOR, such as key=2 or key=#ffc080"));
        let (name, factor) = part.split_once('=').ok_or_else(wrong)?;
        juggler::check_name("light group", name.trim(), groups.iter().map(String::as_str))?;
        let number =
            factor.trim().parse().ok().filter(|number: &f32| (0.0..=MAX_GAIN).contains(number)).map(Rgb::splat);
        let factor = number.or_else(|| Rgb::from_css(factor.trim())).ok_or_else(wrong)?;
        let group = groups.iter().position(|group| group == name.trim());
        if let Some(gain) = group.and_then(|group| gains.get_mut(group)) {
            *gain = factor;
        }
    }
    Ok(gains)
}
