//! `juggler merge`: joins partial renders into a picture or a larger partial render.

mod memory;

use crate::console;
use crate::encoding::{Encoding, EncodingChoice};
use crate::failure::Failure;
use crate::flags::GivenFlags;
use crate::format::{bytes, clamping, counted, duration, samples};
use crate::interrupt::Interrupts;
use crate::output::{self, STANDARD_OUTPUT};
use crate::plan::aovs::{self, AovOutput};
use crate::plan::effect;
use crate::progress::{Goal, Reporter, Watch, with_progress};
use crate::stats::{self, ClampStats};
use crate::target::Target;
use crate::value;
use clap::Args;
use juggler::SAMPLES;
use juggler::camera::film::{FilmDigest, FilmSummary};
use juggler::denoise::{DenoisedPicture, DenoiserInput};
use juggler::film::counts::SampleCountStats;
use juggler::film::{self, MergeGoal, RenderDescription, Stop};
use juggler::imaging::layered::LayeredWriter;
use juggler::imaging::{self, Header, Tone};
use juggler::math::PixelRows;
use juggler::render::Control;
use juggler::{AovSet, Denoiser};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Flags of `juggler merge`.
#[derive(Debug, Args)]
pub struct Merge {
    #[command(flatten)]
    given: GivenFlags,
    /// Partial renders of one picture (.jfilm), in any order
    #[arg(required = true, value_name = "FILE")]
    partial_renders: Vec<String>,
    /// Output file; its extension selects the format
    ///
    /// A picture needs all its partial renders. A .jfilm joins any of them to a larger one.
    #[arg(short, long, value_name = "FILE")]
    output: String,
    /// File format of the picture, instead of the one that the extension selects
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Bits per channel: 8 or 16 for PNG, 16 or 32 for EXR
    #[arg(long, value_name = "N")]
    bits: Option<u8>,
    /// Quality of a JPEG [default: 95]
    #[arg(long, value_name = "1-100", value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: Option<u8>,
    /// File for the AOVs of the partial renders: one .exr, or one .exr or .npy per AOV if the name
    /// contains `{}`
    ///
    /// By default, an EXR picture contains the AOVs as layers; other pictures get a file beside
    /// them (NAME.layers.exr).
    #[arg(long, value_name = "FILE")]
    aov_output: Option<String>,
    /// Write statistics as JSON; `-` is standard output
    ///
    /// Statistics are counts, times, and a hash of the pixels.
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
    /// Memory limit, such as 4G
    ///
    /// A merge that needs more is refused before any tile is read.
    #[arg(long, value_name = "SIZE", value_parser = value::memory)]
    max_memory: Option<u64>,
}

/// Result of a merge.
enum MergeOutput {
    /// A picture, and its numbers of samples per pixel if a noise level or a time limit ended the
    /// render.
    Picture(FilmSummary, Option<SampleCountStats>),
    /// A partial render of this length in bytes.
    PartialRender(u64),
}

/// The merged picture, denoised.
fn denoised(
    merge: &film::Merge,
    set: &AovSet,
    denoiser: Denoiser,
    interrupts: &Interrupts,
) -> Result<DenoisedPicture, Failure> {
    let mut input = DenoiserInput::new(merge.description().region);
    merge.tile_rows(|_, tiles, _| {
        interrupts.check()?;
        tiles.iter().for_each(|tile| input.add(set, tile));
        Ok::<(), Failure>(())
    })?;
    let library = std::env::var_os("JUGGLER_OIDN").map(PathBuf::from);
    let control = Control::default();
    let watch = Watch {
        reporter: &Reporter::Nothing,
        interrupts,
        control: &control,
        goal: Goal::Samples(0),
        frame_progress: None,
    };
    let denoised = with_progress(&watch, || input.denoise(denoiser, library.as_deref(), &control))?;
    interrupts.check()?;
    Ok(denoised.unwrap_or_default())
}

/// Numbers of samples per pixel, if a noise level or a time limit ended the render.
fn sample_counts(merge: &film::Merge) -> Result<Option<SampleCountStats>, Failure> {
    if merge.description().stop == Stop::Samples {
        return Ok(None);
    }
    Ok(Some(SampleCountStats::from_counts(&merge.description().tiling(), &merge.counts()?)))
}

impl Merge {
    /// Checks all partial renders, then joins them.
    pub fn run(self) -> Result<(), Failure> {
        let start = Instant::now();
        output::at_most_one_stream(&self.output, self.stats.as_deref())?;
        output::check_stream(&self.output)?;
        let (format, bits, quality) = (self.format.as_deref(), self.bits, self.quality);
        let choice = EncodingChoice { format, bits, quality, look: None };
        let (merge, merged) = if choice.is_partial_render(&self.output) {
            self.given.check(Target::PartialRender)?;
            let merge = film::Merge::open(&self.partial_renders, MergeGoal::PartialRender)?;
            if self.max_memory.is_some() {
                memory::check(&merge, &AovSet::from_description(&merge.description().aovs)?, None, self.max_memory)?;
            }
            let interrupts = Interrupts::watch()?;
            let merged = MergeOutput::PartialRender(merge.write(Path::new(&self.output), || interrupts.check())?);
            (merge, merged)
        } else {
            let encoding = Encoding::new(choice, &self.output)?;
            self.given.check(Target::Picture(encoding))?;
            let merge = film::Merge::open(&self.partial_renders, MergeGoal::Whole)?;
            let sample_counts = sample_counts(&merge)?;
            let interrupts = Interrupts::watch()?;
            let merged =
                MergeOutput::Picture(self.picture(&merge, encoding, sample_counts, &interrupts)?, sample_counts);
            (merge, merged)
        };
        self.report(merge.description(), &merged, start)
    }

    fn picture(
        &self,
        merge: &film::Merge,
        encoding: Encoding,
        sample_counts: Option<SampleCountStats>,
        interrupts: &Interrupts,
    ) -> Result<FilmSummary, Failure> {
        let Encoding { format, .. } = encoding;
        let set = AovSet::from_description(&merge.description().aovs)?;
        let header = self.header(merge, encoding, &set, sample_counts)?;
        memory::check(merge, &set, Some((format, &header, self.output != STANDARD_OUTPUT)), self.max_memory)?;
        let mut aov_writer = self.aov_writer(&set, &header)?;
        let with_picture = aov_writer.as_ref().is_some_and(|(_, with_picture)| *with_picture);
        let mut writer = match self.output.as_str() {
            _ if with_picture => None,
            STANDARD_OUTPUT => Some(imaging::to_standard_output(format, &header)?),
            file => Some(imaging::create(Path::new(file), format, &header)?),
        };
        let denoised = set.denoiser().map(|denoiser| denoised(merge, &set, denoiser, interrupts)).transpose()?;
        let is_other = denoised.is_some() || set.is_transparent();
        let mut rest = denoised.as_ref().map(DenoisedPicture::rows);
        let mut digest = FilmDigest::new(header.width, header.height);
        let summary = merge.tile_rows(|band, tiles, rows| {
            interrupts.check()?;
            let plain = if rest.is_none() { set.alpha(band, tiles) } else { None };
            let plain = PixelRows { colors: rows, alpha: plain.as_deref() };
            let rows = rest.as_mut().map_or(plain, |rest| rest.split_off(rows.len()));
            if is_other {
                digest.update(rows);
            }
            if let Some((writer, with_picture)) = &mut aov_writer {
                writer.write_rows(&set.band_values(band, tiles, with_picture.then_some(rows)))?;
            }
            Ok::<(), Failure>(writer.as_mut().map_or(Ok(()), |writer| writer.write_rows(rows))?)
        })?;
        writer.map_or(Ok(()), |writer| writer.finish())?;
        aov_writer.map_or(Ok(()), |(writer, _)| writer.finish())?;
        console::warn_of_clamping(&header.clamped, &self.output, self.quiet);
        let FilmSummary { hash, mean, .. } = if is_other { digest.finish() } else { summary.clone() };
        Ok(FilmSummary { hash, mean, ..summary })
    }

    /// Header of the merged picture.
    fn header(
        &self,
        merge: &film::Merge,
        encoding: Encoding,
        set: &AovSet,
        sample_counts: Option<SampleCountStats>,
    ) -> Result<Header, Failure> {
        let RenderDescription { region, tone, metadata, viewpoint, .. } = merge.description();
        let (mut metadata, viewpoint, crop) = (metadata.clone(), *viewpoint, merge.description().crop_frame());
        if let Some(sample_counts) = sample_counts {
            metadata.push((SAMPLES.to_owned(), sample_counts.to_string()));
        }
        let tone: Tone = serde_json::from_value(tone.clone()).map_err(|error| {
            Failure::System(format!("cannot read the tone settings of the partial renders: {error}"))
        })?;
        if let Some(warning) = effect::ignored_tone_warning(Target::Picture(encoding), &tone).filter(|_| !self.quiet) {
            console::print_message(&warning);
        }
        let (options, transparent) = (encoding.options, set.is_transparent());
        let size = Header::new(region.width, region.height);
        Ok(Header { tone, options, transparent, metadata, viewpoint, crop, ..size })
    }

    /// Writer of the AOVs of the partial renders, and whether its file contains the picture too.
    fn aov_writer(&self, set: &AovSet, header: &Header) -> Result<Option<(LayeredWriter, bool)>, Failure> {
        if set.selected().is_empty() {
            return match &self.aov_output {
                Some(_) => Err(Failure::Invalid(
                    "--aov-output: the partial renders contain no AOVs; render them with --aov".into(),
                )),
                None => Ok(None),
            };
        }
        let place = aovs::output_for(&self.output, self.aov_output.as_deref());
        let (file, with_picture) = match &place {
            AovOutput::InPicture => (self.output.as_str(), true),
            AovOutput::File(_) if self.aov_output.is_none() && self.output == STANDARD_OUTPUT => return Ok(None),
            AovOutput::File(file) => (file.as_str(), false),
        };
        let writer = LayeredWriter::create(Path::new(file), &set.file_header(header, with_picture))?;
        Ok(Some((writer, with_picture)))
    }

    fn report(&self, picture: &RenderDescription, merged: &MergeOutput, start: Instant) -> Result<(), Failure> {
        let took = start.elapsed();
        if let Some(file) = &self.stats {
            output::write_text(file, &self.to_json(picture, merged, took.as_secs_f64()))?;
        }
        if self.quiet {
            return Ok(());
        }
        let [width, height] = [picture.region.width, picture.region.height];
        let what = match merged {
            MergeOutput::Picture(film, sample_counts) => {
                let samples = samples(&sample_counts.unwrap_or(SampleCountStats::uniform(picture.samples)));
                if picture.clamped { format!("{samples}, {}", clamping(film)) } else { samples }
            }
            MergeOutput::PartialRender(length) if picture.finished => format!("complete, {}", bytes(*length)),
            MergeOutput::PartialRender(length) => format!("incomplete, {}", bytes(*length)),
        };
        let count = counted(self.partial_renders.len() as u128, "partial render");
        let line = format!("{}: {width}x{height}, {what}, of {count}, {}", self.output, duration(took));
        if self.output == STANDARD_OUTPUT || self.stats.as_deref() == Some(STANDARD_OUTPUT) {
            console::print_message(&line);
            return Ok(());
        }
        console::print_result(&line)
    }

    /// Statistics as JSON, with the keys of a render's.
    fn to_json(&self, picture: &RenderDescription, merged: &MergeOutput, seconds: f64) -> String {
        let film = match merged {
            MergeOutput::Picture(film, _) if picture.clamped => {
                json!({"mean": film.mean, "hash": film.hash, "clamped": ClampStats::of(film)})
            }
            MergeOutput::Picture(FilmSummary { hash, mean, .. }, _) => json!({"mean": mean, "hash": hash}),
            MergeOutput::PartialRender(_) => serde_json::Value::Null,
        };
        let sample_counts = if let MergeOutput::Picture(_, sample_counts) = merged { *sample_counts } else { None };
        let mut json = json!({
            "version": 1,
            "scene": picture.scene,
            "size": [picture.region.width, picture.region.height],
            "samples": sample_counts.map_or(picture.samples, |sample_counts| sample_counts.max),
            "finished": picture.finished,
            "camera": stats::camera(picture.viewpoint.as_ref()),
            "parts": self.partial_renders.len(),
            "seconds": {"total": seconds},
            "film": film,
        });
        if let Some(sample_counts) = sample_counts {
            json["samples_per_pixel"] = json!(sample_counts);
        }
        json.to_string()
    }
}
