//! `juggler merge`: parts of a picture become the picture, or a larger part.

mod memory;

use crate::console;
use crate::failure::Failure;
use crate::format::{bytes, clamping, counted, duration, samples};
use crate::interrupt::Interrupts;
use crate::output::{self, STANDARD_OUTPUT};
use crate::plan::effect::{self, Given};
use crate::plan::layers::{self, Place};
use crate::plan::{Encoding, PART_ENDING, Target};
use crate::progress::{Goal, Reporter, Watch, watched};
use crate::reproduce::SAMPLES;
use crate::stats::{self, Clamped};
use crate::value;
use clap::Args;
use juggler::camera::film::{Digest, Summary};
use juggler::denoise::Guides;
use juggler::film::counts::Spread;
use juggler::film::{self, Description, Stop, Wanted};
use juggler::imaging::layered::LayeredWriter;
use juggler::imaging::{self, Header, Tone};
use juggler::math::Rgb;
use juggler::render::Control;
use juggler::{Denoiser, LayerSet};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Flags of `juggler merge`.
#[derive(Debug, Args)]
pub struct Merge {
    /// Parts of one picture (.jfilm), in any order
    #[arg(required = true, value_name = "PART")]
    parts: Vec<String>,
    /// Where the picture goes; the ending says the format: a picture needs all its parts, a .jfilm takes what is there
    #[arg(short, long, value_name = "FILE")]
    output: String,
    /// The file format of the picture, instead of the one that the ending says
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Bits of a channel: 8 or 16 in a PNG, 16 or 32 in an EXR
    #[arg(long, value_name = "N")]
    bits: Option<u8>,
    /// Quality of a JPEG
    #[arg(long, value_name = "1-100", value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: Option<u8>,
    /// Where layers go that the parts keep: one .exr, or one .exr or .npy each where the name holds `{}` for the layer's. Without
    /// it an EXR holds them itself, another picture has them beside it (NAME.layers.exr)
    #[arg(long, value_name = "FILE")]
    aov_output: Option<String>,
    /// Write counts, times and the hash of the pixels as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
    /// Refuse, before any tile is joined, what needs more memory than this
    #[arg(long, value_name = "SIZE", value_parser = value::memory)]
    max_memory: Option<u64>,
}

/// What was made.
enum Made {
    /// A picture, and its samples per pixel where noise or time ended it.
    Picture(Summary, Option<Spread>),
    /// A part of so many bytes.
    Part(u64),
}

/// The pixels of the picture that the parts make, without noise.
fn denoised(
    merge: &film::Merge,
    set: &LayerSet,
    denoiser: Denoiser,
    interrupts: &Interrupts,
) -> Result<Vec<Rgb>, Failure> {
    let mut guides = Guides::new(merge.description().region);
    merge.rows_of_tiles(|_, tiles, _| {
        interrupts.check()?;
        tiles.iter().for_each(|tile| guides.add(set, tile));
        Ok::<(), Failure>(())
    })?;
    let library = std::env::var_os("JUGGLER_OIDN").map(PathBuf::from);
    let control = Control::default();
    let watch =
        Watch { reporter: &Reporter::Nothing, interrupts, control: &control, goal: Goal::Samples(0), course: None };
    let denoised = watched(&watch, || guides.denoise(denoiser, library.as_deref(), &control))?;
    interrupts.check()?;
    Ok(denoised.map(|denoised| denoised.pixels).unwrap_or_default())
}

/// The samples per pixel of a picture that noise or time ended.
fn spread(merge: &film::Merge) -> Result<Option<Spread>, Failure> {
    if merge.description().stop == Stop::Samples {
        return Ok(None);
    }
    Ok(Some(Spread::of_counts(&merge.description().layout(), &merge.counts()?)))
}

impl Merge {
    /// Checks all parts, then joins them.
    pub fn run(self) -> Result<(), Failure> {
        let start = Instant::now();
        output::at_most_one_stream(&self.output, self.stats.as_deref())?;
        output::check_stream(&self.output)?;
        let is_part =
            Path::new(&self.output).extension().is_some_and(|ending| ending.eq_ignore_ascii_case(PART_ENDING));
        let (merge, made) = if is_part {
            effect::check(Target::Part, &self.given())?;
            let merge = film::Merge::open(&self.parts, Wanted::Part)?;
            if self.max_memory.is_some() {
                memory::check(&merge, &LayerSet::of_part(&merge.description().layers)?, None, self.max_memory)?;
            }
            let interrupts = Interrupts::watch()?;
            let made = Made::Part(merge.write(Path::new(&self.output), || interrupts.check())?);
            (merge, made)
        } else {
            let encoding = Encoding::new(self.format.as_deref(), self.bits, self.quality, &self.output)?;
            effect::check(Target::Picture(encoding), &self.given())?;
            let merge = film::Merge::open(&self.parts, Wanted::Whole)?;
            let spread = spread(&merge)?;
            let interrupts = Interrupts::watch()?;
            let made = Made::Picture(self.picture(&merge, encoding, spread, &interrupts)?, spread);
            (merge, made)
        };
        self.report(merge.description(), &made, start)
    }

    /// Flags that not every target can obey.
    fn given(&self) -> [Given; 4] {
        [
            ("--format", self.format.is_some()),
            ("--bits", self.bits.is_some()),
            ("--quality", self.quality.is_some()),
            ("--aov-output", self.aov_output.is_some()),
        ]
    }

    fn picture(
        &self,
        merge: &film::Merge,
        encoding: Encoding,
        spread: Option<Spread>,
        interrupts: &Interrupts,
    ) -> Result<Summary, Failure> {
        let Encoding { format, options } = encoding;
        let Description { region, tone, metadata, viewpoint, .. } = merge.description();
        let (mut metadata, viewpoint) = (metadata.clone(), *viewpoint);
        if let Some(spread) = spread {
            metadata.push((SAMPLES.to_owned(), spread.to_string()));
        }
        let tone: Tone = serde_json::from_value(tone.clone())
            .map_err(|error| Failure::System(format!("the parts' tone curve cannot be read: {error}")))?;
        if let Some(warning) = effect::idle_tone(Target::Picture(encoding), &tone).filter(|_| !self.quiet) {
            console::say(&warning);
        }
        let header = Header { tone, options, metadata, viewpoint, ..Header::new(region.width, region.height) };
        let set = LayerSet::of_part(&merge.description().layers)?;
        memory::check(merge, &set, Some((format, &header, self.output != STANDARD_OUTPUT)), self.max_memory)?;
        let mut layers = self.layers(&set, &header)?;
        let with_picture = layers.as_ref().is_some_and(|(_, with_picture)| *with_picture);
        let mut writer = match self.output.as_str() {
            _ if with_picture => None,
            STANDARD_OUTPUT => Some(imaging::to_standard_output(format, &header)?),
            file => Some(imaging::create(Path::new(file), format, &header)?),
        };
        let denoised = set.denoiser().map(|denoiser| denoised(merge, &set, denoiser, interrupts)).transpose()?;
        let mut rest = denoised.as_deref();
        let summary = merge.rows_of_tiles(|band, tiles, rows| {
            interrupts.check()?;
            let rows = rest.as_mut().and_then(|rest| rest.split_off(..rows.len())).unwrap_or(rows);
            if let Some((writer, with_picture)) = &mut layers {
                writer.write_rows(&set.band(band, tiles, with_picture.then_some(rows)))?;
            }
            Ok::<(), Failure>(writer.as_mut().map_or(Ok(()), |writer| writer.write_rows(rows))?)
        })?;
        writer.map_or(Ok(()), |writer| writer.finish())?;
        layers.map_or(Ok(()), |(writer, _)| writer.finish())?;
        let Some(pixels) = denoised else { return Ok(summary) };
        let mut digest = Digest::new(region.width, region.height);
        digest.update(&pixels);
        let Summary { hash, mean, .. } = digest.finish();
        Ok(Summary { hash, mean, ..summary })
    }

    /// The layers that the parts keep, and their file; whether the picture is in it.
    fn layers(&self, set: &LayerSet, header: &Header) -> Result<Option<(LayeredWriter, bool)>, Failure> {
        if set.wanted().is_empty() {
            return match &self.aov_output {
                Some(_) => {
                    Err(Failure::Wrong("--aov-output: the parts keep no layers (`juggler render --aov`)".into()))
                }
                None => Ok(None),
            };
        }
        let place = layers::place(&self.output, self.aov_output.as_deref());
        let (file, with_picture) = match &place {
            Place::InPicture => (self.output.as_str(), true),
            Place::File(_) if self.aov_output.is_none() && self.output == STANDARD_OUTPUT => return Ok(None),
            Place::File(file) => (file.as_str(), false),
        };
        let writer = LayeredWriter::create(Path::new(file), &set.file_header(header, with_picture))?;
        Ok(Some((writer, with_picture)))
    }

    fn report(&self, picture: &Description, made: &Made, start: Instant) -> Result<(), Failure> {
        let took = start.elapsed();
        if let Some(file) = &self.stats {
            output::write_text(file, &self.to_json(picture, made, took.as_secs_f64()))?;
        }
        if self.quiet {
            return Ok(());
        }
        let [width, height] = [picture.region.width, picture.region.height];
        let what = match made {
            Made::Picture(film, spread) => {
                let samples = samples(&spread.unwrap_or(Spread::even(picture.samples)));
                if picture.clamped { format!("{samples}, {}", clamping(film)) } else { samples }
            }
            Made::Part(length) if picture.finished => format!("whole, {}", bytes(*length)),
            Made::Part(length) => format!("not all of it, {}", bytes(*length)),
        };
        let parts = counted(self.parts.len() as u128, "part");
        let line = format!("{}: {width}x{height}, {what}, of {parts}, {}", self.output, duration(took));
        if self.output == STANDARD_OUTPUT || self.stats.as_deref() == Some(STANDARD_OUTPUT) {
            console::say(&line);
            return Ok(());
        }
        console::print(&line)
    }

    /// The keys have the meaning that they have for a render.
    fn to_json(&self, picture: &Description, made: &Made, seconds: f64) -> String {
        let film = match made {
            Made::Picture(film, _) if picture.clamped => {
                json!({"mean": film.mean, "hash": film.hash, "clamped": Clamped::of(film)})
            }
            Made::Picture(Summary { hash, mean, .. }, _) => json!({"mean": mean, "hash": hash}),
            Made::Part(_) => serde_json::Value::Null,
        };
        let spread = if let Made::Picture(_, spread) = made { *spread } else { None };
        let mut json = json!({
            "version": 1,
            "scene": picture.scene,
            "size": [picture.region.width, picture.region.height],
            "samples": spread.map_or(picture.samples, |spread| spread.max),
            "finished": picture.finished,
            "camera": stats::camera(picture.viewpoint.as_ref()),
            "parts": self.parts.len(),
            "seconds": {"total": seconds},
            "film": film,
        });
        if let Some(spread) = spread {
            json["samples_per_pixel"] = json!(spread);
        }
        json.to_string()
    }
}
