//! Renders to a film that is kept in memory: for checkpoints, noise levels and time limits, partial
//! renders, AOVs and denoising.

use super::folder::forget;
use super::frame::{FrameRender, RenderCommand};
use crate::console;
use crate::encoding::OutputKind;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::plan::aovs::{self, AovOutput};
use crate::plan::{Checkpoint as CheckpointPlan, Cut, FrameOutput, Shard};
use crate::progress::{Goal, Watch, with_progress};
use crate::reproduce;
use juggler::camera::film::{Film, FilmDigest, FilmSummary, Rect, TILE_EDGE};
use juggler::denoise::DenoisedPicture;
use juggler::film::checkpoint::{self, Checkpoint};
use juggler::film::counts::{self, SampleCountStats};
use juggler::film::partial_render::{PartialRender, PartialRenderError, RenderDescription, ShardDescription, write};
use juggler::film::shard::{self, Work};
use juggler::imaging::layered::LayeredWriter;
use juggler::imaging::{Header, inspect};
use juggler::math::{PixelRows, Rgb};
use juggler::render::{Cancelled, Control};
use juggler::{Limit, Picture, RenderOrigin, RenderStats, SAMPLES_PER_TILE, Settings};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// A render to a film.
struct FilmRender<'t> {
    command: &'t RenderCommand,
    frame: &'t FrameRender<'t>,
    header: Header,
    film: Film,
    description: RenderDescription,
}

/// Result of a render, and the error of a file beside the picture, if any.
pub type FilmOutput = (RenderStats, Result<(), Failure>);

/// Renders a picture or a partial render to a film.
pub fn render(
    command: &RenderCommand,
    frame: &FrameRender,
    header: Header,
    interrupts: &Interrupts,
) -> Result<FilmOutput, Failure> {
    let (film, shard) = requested_work(command, frame)?;
    let command_line = reproduce::command(&command.plan, frame.frame_output);
    let origin =
        RenderOrigin { scene: command.plan.scene.clone(), frame: frame.frame_output.frame, command: command_line };
    let description = frame.picture.description(&origin, &header, shard);
    FilmRender { command, frame, header, film, description }.run(interrupts)
}

/// Film with the requested tiles and samples, and its share of the picture.
fn requested_work(command: &RenderCommand, frame: &FrameRender) -> Result<(Film, ShardDescription), Failure> {
    let (picture, plan) = (frame.picture, &command.plan);
    let tiling = picture.tiling();
    let whole = ShardDescription::whole(picture.samples());
    if let Some(file) = &plan.samples_from {
        let counts = samples_of(file, picture)?;
        return Ok((Film::from_tiles(tiling, (0..).zip(counts.into_iter().map(|count| 0..count))), whole));
    }
    let Cut { crop, samples } = &plan.cut;
    let samples = samples.clone().unwrap_or(whole.samples.clone());
    if samples.end > picture.samples() {
        let most = picture.samples();
        return Err(Failure::Invalid(format!(
            "--sample-range ends at {}; the picture has {most} samples",
            samples.end
        )));
    }
    if let Some(crop) = crop {
        check_crop(crop, &picture.region())?;
    }
    let Shard { index, count } = frame.frame_output.shard;
    let work = Work { tiling, crop: *crop, samples: samples.clone(), stop: picture.stop() };
    let units = work.shard(index, count).into_iter().map(|unit| (unit.tile, unit.samples));
    let shard = ShardDescription { index, count, samples, crop: *crop, ..whole };
    Ok((Film::from_tiles(tiling, units), shard))
}

/// Checks that a crop of a partial render lies on tile boundaries.
fn check_crop(crop: &Rect, region: &Rect) -> Result<(), Failure> {
    Settings { crop: Some(*crop), ..Settings::default() }.region([region.width, region.height])?;
    match shard::whole_tiles(region, crop) {
        whole if whole == *crop => Ok(()),
        Rect { x, y, width, height } => Err(Failure::Invalid(format!(
            "the crop of a partial render must lie on multiples of {TILE_EDGE} pixels, such as {x},{y},{width},{height}"
        ))),
    }
}

/// Numbers of samples of each tile of a picture or partial render.
fn samples_of(file: &str, picture: &Picture) -> Result<Vec<u32>, Failure> {
    let (path, tiles) = (Path::new(file), picture.tiling().tile_count());
    let other = || Failure::Invalid(format!("`{file}` belongs to another picture or to other settings"));
    match PartialRender::open(path) {
        Ok(partial_render) => {
            let RenderDescription { fingerprint, region, .. } = partial_render.description();
            let same = fingerprint == picture.fingerprint().parts() && *region == picture.region();
            return if same { Ok(counts::from_partial_render(&partial_render)?) } else { Err(other()) };
        }
        Err(PartialRenderError::NotAPartialRender { .. }) => {}
        Err(error) => return Err(error.into()),
    }
    let metadata = inspect(path)?.metadata;
    let text = |key: &str| metadata.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str());
    let Some(counts) = text(SAMPLES_PER_TILE) else {
        return Err(Failure::Invalid(format!("`{file}` does not contain the numbers of samples of its tiles")));
    };
    if text("Fingerprint") != Some(&picture.fingerprint().hash()) {
        return Err(other());
    }
    counts::from_text(counts, tiles).ok_or_else(other)
}

/// Note on the fraction of the light that the denoiser moved from outliers to their neighborhoods,
/// if it is not negligible. A black picture has its own warning.
fn moved_note(denoised: &DenoisedPicture) -> Option<String> {
    const TRIFLE: f64 = 1e-3;
    let percent = 100.0 * denoised.moved_energy;
    let is_black = || denoised.pixels.iter().all(|pixel| *pixel == Rgb::BLACK);
    (denoised.moved_energy >= TRIFLE && !is_black()).then(|| {
        format!(
            "note: the denoiser spread {percent:.1} % of the light from single bright pixels to their neighbors; more \
             samples make them rarer"
        )
    })
}

/// Summary of pixels that are not those of the film, such as denoised ones.
fn summary_of(pixels: PixelRows, picture: &Picture, film: &Film) -> FilmSummary {
    let [width, height] = picture.size();
    let mut digest = FilmDigest::new(width, height);
    digest.update(pixels);
    digest.add_clamped(film.clamped());
    digest.finish()
}

impl FilmRender<'_> {
    fn run(mut self, interrupts: &Interrupts) -> Result<FilmOutput, Failure> {
        let mut checkpoint = self.frame.frame_output.checkpoint.as_deref().map(|file| self.open(file)).transpose()?;
        let is_automatic = self.command.plan.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_automatic);
        let (control, start) = (Control::default(), Instant::now());
        let result = self.render_film(&control, interrupts, checkpoint.as_mut());
        let render = start.elapsed();
        self.description.finished = result.is_ok() && self.frame.picture.is_finished(&self.film);
        // A finished frame of a movie is kept as a picture, so its checkpoint is not saved.
        let saved = self.save(checkpoint.as_mut().filter(|_| !is_automatic || result.is_err()));
        if result.is_err() {
            saved?;
            let caught = interrupts.caught();
            let file = checkpoint.and(self.frame.frame_output.checkpoint.clone());
            return Err(caught.map_or(Failure::System(Cancelled.to_string()), |failure| failure.with_saved_work(file)));
        }
        // If the checkpoint is the output, saving it wrote the partial render.
        let saved = if self.frame.frame_output.checkpoint.as_ref() == Some(&self.frame.frame_output.output) {
            saved?;
            Ok(())
        } else {
            saved
        };
        let denoise = Instant::now();
        let denoised =
            if self.command.plan.output_kind == OutputKind::PartialRender { None } else { self.denoised(&control)? };
        let (denoise, write) = (denoise.elapsed(), Instant::now());
        // Write the finished picture before reporting that its checkpoint could not be saved.
        let (film, layers) = self.write(denoised.as_ref().map(DenoisedPicture::rows))?;
        if let Some(checkpoint) = checkpoint.filter(|_| saved.is_ok()) {
            checkpoint.close();
        }
        if is_automatic {
            self.frame.frame_output.checkpoint.as_deref().into_iter().for_each(forget);
        }
        let samples = SampleCountStats::from_film(&self.film);
        let outcome = RenderStats { film, samples, rays: control.rays(), render, denoise, write: write.elapsed() };
        Ok((outcome, saved.and(layers)))
    }

    /// Saves the film to its checkpoint, if there is one.
    fn save(&self, checkpoint: Option<&mut Checkpoint>) -> Result<(), Failure> {
        let saved = checkpoint.map(|checkpoint| checkpoint.save(&self.description, &self.film)).transpose();
        saved.map(drop).map_err(Failure::from)
    }

    /// Opens the checkpoint and resumes from it. An automatic checkpoint that does not match
    /// belongs to another scene and is removed.
    fn open(&self, file: &str) -> Result<Checkpoint, Failure> {
        match self.resume(file) {
            Err(_) if self.command.plan.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_automatic) => {
                forget(file);
                self.resume(file)
            }
            other => other,
        }
    }

    fn resume(&self, file: &str) -> Result<Checkpoint, Failure> {
        let (checkpoint, found) = Checkpoint::open(Path::new(file))?;
        if let Some(damage) = found.damage {
            console::print_message(&format!("warning: {damage}; resuming from the previous checkpoint"));
        }
        if let Some(partial_render) = found.partial_render {
            checkpoint::resume(&partial_render, &self.description, &self.film)?;
            self.report_resumed(file);
        }
        Ok(checkpoint)
    }

    /// Reports the resumed fraction, for the log of a task that was killed.
    fn report_resumed(&self, file: &str) {
        if !self.command.plan.quiet {
            let percent = 100.0 * self.film.samples() as f64 / self.film.requested_samples().max(1) as f64;
            console::print_message(&format!("{file}: {percent:.1} % is done, resuming"));
        }
    }

    fn render_film(
        &self,
        control: &Control,
        interrupts: &Interrupts,
        checkpoint: Option<&mut Checkpoint>,
    ) -> Result<(), Cancelled> {
        let RenderCommand { plan, reporter } = self.command;
        let goal = self.film.requested_samples().saturating_sub(self.film.samples());
        let frame_progress = self.frame.start.frame_progress;
        let goal = match (self.frame.picture.limit(), plan.time) {
            (Limit::Noise(level), _) => Goal::Noise(&self.film, *level),
            (_, Some(time)) => Goal::Time(time, goal),
            _ => Goal::Samples(goal),
        };
        let samples = matches!(goal, Goal::Samples(_)).then_some(self.frame.picture.samples());
        reporter.start(&self.frame.frame_output.output, self.frame.picture.size(), samples, frame_progress);
        let watch = Watch { reporter, interrupts, control, goal, frame_progress };
        let work = || self.frame.picture.render_film(&self.film, control);
        let result = with_progress(&watch, || match (checkpoint, &plan.checkpoint) {
            (Some(checkpoint), Some(CheckpointPlan { every, .. })) => self.saving(checkpoint, *every, work),
            _ => work(),
        });
        if result.is_err() {
            reporter.clear();
        }
        result
    }

    /// Runs `work` while another thread saves the film at regular intervals.
    fn saving<T>(&self, checkpoint: &mut Checkpoint, every: Duration, work: impl FnOnce() -> T) -> T {
        std::thread::scope(|scope| {
            let (running, ended) = mpsc::channel::<()>();
            scope.spawn(move || {
                while ended.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                    if let Err(error) = checkpoint.save(&self.description, &self.film) {
                        console::print_message(&format!("warning: {error}"));
                    }
                }
            });
            let result = work();
            drop(running);
            result
        })
    }

    /// Denoised picture, or `None` without a denoiser.
    fn denoised(&self, control: &Control) -> Result<Option<DenoisedPicture>, Failure> {
        let Some(denoiser) = self.command.plan.settings.denoiser else { return Ok(None) };
        let library = std::env::var_os("JUGGLER_OIDN").map(PathBuf::from);
        let input = self.frame.picture.denoiser_input(&self.film);
        let denoised = input.denoise(denoiser, library.as_deref(), control)?;
        let denoised = denoised.ok_or_else(|| Failure::System(Cancelled.to_string()))?;
        if let Some(note) = moved_note(&denoised).filter(|_| !self.command.plan.quiet) {
            console::print_message(&note);
        }
        Ok(Some(denoised))
    }

    /// Writes the AOVs. Returns whether their file contains the picture too.
    fn write_aovs(&self, pixels: Option<PixelRows>) -> Result<bool, Failure> {
        let FrameRender { picture, frame_output, .. } = self.frame;
        if picture.aovs().selected().is_empty() {
            return Ok(false);
        }
        let place = aovs::output_for(&frame_output.output, frame_output.aov_output.as_deref());
        let (file, with_picture) = match &place {
            AovOutput::InPicture => (frame_output.output.as_str(), true),
            AovOutput::File(file) => (file.as_str(), false),
        };
        let header = picture.aovs().file_header(&self.header, with_picture);
        let writer = LayeredWriter::create(Path::new(file), &header)?;
        let mut plain = DenoisedPicture::default();
        if with_picture && pixels.is_none() {
            picture.develop(&self.film, |rows| {
                plain.pixels.extend_from_slice(rows.colors);
                Ok::<(), Failure>(())
            })?;
            plain.alpha = picture.alpha(&self.film);
        }
        picture.write_layers(&self.film, writer, with_picture.then(|| pixels.unwrap_or(plain.rows())))?;
        Ok(with_picture)
    }

    /// Writes the AOVs. Returns whether their file contains the picture too, and the error of a
    /// separate AOV file.
    fn write_beside(&self, pixels: Option<PixelRows>) -> Result<(bool, Result<(), Failure>), Failure> {
        let FrameOutput { output, aov_output, .. } = self.frame.frame_output;
        match self.write_aovs(pixels) {
            Ok(in_picture) => Ok((in_picture, Ok(()))),
            Err(failure) if aovs::output_for(output, aov_output.as_deref()) == AovOutput::InPicture => Err(failure),
            Err(failure) => Ok((false, Err(failure))),
        }
    }

    /// Writes the picture or the partial render. `pixels` replaces the film's pixels. Also returns
    /// the error of a separate AOV file.
    fn write(&mut self, pixels: Option<PixelRows>) -> Result<(FilmSummary, Result<(), Failure>), Failure> {
        let (picture, output) = (self.frame.picture, &self.frame.frame_output.output);
        match self.command.plan.output_kind {
            OutputKind::PartialRender => {
                // If the checkpoint is the output, the last save wrote the partial render.
                if self.frame.frame_output.checkpoint.as_ref() != Some(output) {
                    write(Path::new(output), &self.description, self.film.tiles())?;
                }
                Ok((picture.develop(&self.film, |_| Ok::<(), Failure>(()))?, Ok(())))
            }
            OutputKind::Picture(encoding) => {
                picture.add_sample_counts(&self.film, &mut self.header);
                let (in_picture, beside) = self.write_beside(pixels)?;
                let writer = || self.command.writer(encoding.format, output, &self.header);
                let summary = match pixels {
                    None if in_picture => picture.develop(&self.film, |_| Ok::<(), Failure>(()))?,
                    None => picture.write_film(&self.film, writer()?)?,
                    Some(pixels) => {
                        if !in_picture {
                            let mut writer = writer()?;
                            writer.write_rows(pixels)?;
                            writer.finish()?;
                        }
                        summary_of(pixels, picture, &self.film)
                    }
                };
                Ok((summary, beside))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moved_light_is_noted_unless_the_picture_is_black() {
        let note = |pixel: Rgb, moved_energy: f64| {
            moved_note(&DenoisedPicture { pixels: vec![Rgb::BLACK, pixel], alpha: None, moved_energy })
        };
        let text = "note: the denoiser spread 12.5 % of the light from single bright pixels";
        assert!(note(Rgb::WHITE, 0.125).unwrap().starts_with(text));
        assert_eq!(note(Rgb::WHITE, 1e-4), None);
        assert_eq!(note(Rgb::BLACK, 1.0), None);
    }
}
