//! A picture on a film that is kept: gone on with, ended by noise or time, shared with other machines.

use super::{Session, Take};
use crate::console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::plan::layers::{self, Place};
use crate::plan::{Checkpoint as Keeping, Cut, Product, Shard, Shot};
use crate::progress::{Goal, Watch, watched};
use crate::reproduce::{self, SAMPLES, SAMPLES_PER_TILE};
use juggler::camera::film::{Digest, Film, Rect, Summary, TILE};
use juggler::denoise::Denoised;
use juggler::film::checkpoint::{self, Checkpoint};
use juggler::film::counts::{self, Spread};
use juggler::film::part::{Description, Part, PartError, Share, write};
use juggler::film::share::{self, Work};
use juggler::imaging::layered::LayeredWriter;
use juggler::imaging::{Header, inspect};
use juggler::math::Rgb;
use juggler::render::{Control, Stopped};
use juggler::{Limit, Origin, Outcome, Picture, Settings};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// A film on its way to becoming a picture or a part of one.
struct Exposure<'t> {
    session: &'t Session,
    take: &'t Take<'t>,
    header: Header,
    film: Film,
    description: Description,
}

/// A picture that is there, and what went wrong beside it.
pub type Made = (Outcome, Result<(), Failure>);

/// Renders on a film.
pub fn render(session: &Session, take: &Take, header: Header, interrupts: &Interrupts) -> Result<Made, Failure> {
    let (film, share) = wanted(session, take)?;
    let command = reproduce::command(&session.plan, take.shot);
    let origin = Origin { scene: session.plan.scene.clone(), frame: take.shot.frame, command };
    let description = take.picture.description(&origin, &header, share);
    Exposure { session, take, header, film, description }.run(interrupts)
}

/// The tiles and samples that are asked for.
fn wanted(session: &Session, take: &Take) -> Result<(Film, Share), Failure> {
    let (picture, plan) = (take.picture, &session.plan);
    let layout = picture.layout();
    let whole = Share::whole(picture.samples());
    if let Some(file) = &plan.samples_from {
        let counts = samples_of(file, picture)?;
        return Ok((Film::of(layout, (0..).zip(counts.into_iter().map(|count| 0..count))), whole));
    }
    let Cut { crop, samples } = &plan.cut;
    let samples = samples.clone().unwrap_or(whole.samples);
    if samples.end > picture.samples() {
        let most = picture.samples();
        return Err(Failure::Wrong(format!("--sample-range ends at {}; the picture has {most} samples", samples.end)));
    }
    if let Some(crop) = crop {
        check_crop(crop, &picture.region())?;
    }
    let Shard { index, count } = take.shot.shard;
    let work = Work { layout, crop: *crop, samples: samples.clone(), stop: picture.end() };
    let units = work.share(index, count).into_iter().map(|unit| (unit.tile, unit.samples));
    Ok((Film::of(layout, units), Share { index, count, samples, crop: *crop }))
}

/// Parts are cut between tiles only.
fn check_crop(crop: &Rect, region: &Rect) -> Result<(), Failure> {
    Settings { crop: Some(*crop), ..Settings::default() }.region([region.width, region.height])?;
    match share::whole_tiles(region, crop) {
        whole if whole == *crop => Ok(()),
        Rect { x, y, width, height } => Err(Failure::Wrong(format!(
            "the crop of a part is cut at multiples of {TILE} pixels, such as {x},{y},{width},{height}"
        ))),
    }
}

/// How many samples each tile of a picture or part got.
fn samples_of(file: &str, picture: &Picture) -> Result<Vec<u32>, Failure> {
    let (path, tiles) = (Path::new(file), picture.layout().tiles());
    let other = || Failure::Wrong(format!("`{file}` is of another picture or other settings"));
    match Part::open(path) {
        Ok(part) => {
            let Description { fingerprint, region, .. } = part.description();
            let same = fingerprint == picture.fingerprint().parts() && *region == picture.region();
            return if same { Ok(counts::of_part(&part)?) } else { Err(other()) };
        }
        Err(PartError::NotAPart { .. }) => {}
        Err(error) => return Err(error.into()),
    }
    let metadata = inspect(path)?.metadata;
    let text = |key: &str| metadata.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str());
    let Some(counts) = text(SAMPLES_PER_TILE) else {
        return Err(Failure::Wrong(format!("`{file}` does not say how many samples its parts got")));
    };
    if text("Fingerprint") != Some(&picture.fingerprint().hash()) {
        return Err(other());
    }
    counts::from_text(counts, tiles).ok_or_else(other)
}

/// Reports how much light the denoiser moved from outliers to their neighborhoods, where that is more than a trifle.
pub fn report_moved(denoised: &Denoised) {
    const TRIFLE: f64 = 1e-3;
    if denoised.moved >= TRIFLE {
        let percent = 100.0 * denoised.moved;
        console::say(&format!(
            "note: the denoiser moved {percent:.1} % of the light from single bright pixels to their surroundings"
        ));
    }
}

/// Of pixels that were made of a film's.
fn summary_of(pixels: &[Rgb], picture: &Picture, film: &Film) -> Summary {
    let [width, height] = picture.size();
    let mut digest = Digest::new(width, height);
    digest.update(pixels);
    digest.clamp(film.clamped());
    digest.finish()
}

/// Clears a checkpoint away that is of no use any more.
pub fn forget(file: &str) {
    for file in [file.to_owned(), format!("{file}.previous")] {
        // It may never have been written.
        let _ = std::fs::remove_file(file);
    }
}

impl Exposure<'_> {
    fn run(mut self, interrupts: &Interrupts) -> Result<Made, Failure> {
        let mut kept = self.take.shot.checkpoint.as_deref().map(|file| self.open(file)).transpose()?;
        let is_own = self.session.plan.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_own);
        let (control, start) = (Control::default(), Instant::now());
        let result = self.expose(&control, interrupts, kept.as_mut());
        let render = start.elapsed();
        self.description.finished = result.is_ok() && self.take.picture.is_finished(&self.film);
        // A film's frame that is finished is kept as a picture.
        let saved = self.save(kept.as_mut().filter(|_| !is_own || result.is_err()));
        if result.is_err() {
            saved?;
            let caught = interrupts.caught();
            let file = kept.and(self.take.shot.checkpoint.clone());
            return Err(caught.map_or(Failure::System(Stopped.to_string()), |failure| failure.keeping(file)));
        }
        // A part whose checkpoint is its own file is written by that alone.
        let saved = if self.take.shot.checkpoint.as_ref() == Some(&self.take.shot.output) {
            saved?;
            Ok(())
        } else {
            saved
        };
        let denoise = Instant::now();
        let pixels = if self.session.plan.product == Product::Part { None } else { self.pixels(&control)? };
        let (denoise, write) = (denoise.elapsed(), Instant::now());
        // Finished work is written before anything is told of a checkpoint that could not be.
        let (film, layers) = self.write(pixels.as_deref())?;
        if let Some(kept) = kept.filter(|_| saved.is_ok()) {
            kept.close();
        }
        if is_own {
            self.take.shot.checkpoint.as_deref().into_iter().for_each(forget);
        }
        let samples = Spread::of_film(&self.film);
        let outcome = Outcome { film, samples, rays: control.rays(), render, denoise, write: write.elapsed() };
        Ok((outcome, saved.and(layers)))
    }

    /// Keeps the film as it is now, if it is to be kept.
    fn save(&self, kept: Option<&mut Checkpoint>) -> Result<(), Failure> {
        let saved = kept.map(|kept| kept.save(&self.description, &self.film)).transpose();
        saved.map(drop).map_err(Failure::from)
    }

    /// Opens the checkpoint and takes over what it holds. One of our own that does not fit is of another scene: it goes.
    fn open(&self, file: &str) -> Result<Checkpoint, Failure> {
        match self.resume(file) {
            Err(_) if self.session.plan.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_own) => {
                forget(file);
                self.resume(file)
            }
            other => other,
        }
    }

    fn resume(&self, file: &str) -> Result<Checkpoint, Failure> {
        let (kept, found) = Checkpoint::open(Path::new(file))?;
        if let Some(damage) = found.damage {
            console::say(&format!("warning: {damage}; going on from the one before it"));
        }
        if let Some(part) = found.part {
            checkpoint::resume(&part, &self.description, &self.film)?;
            self.tell_where_it_goes_on(file);
        }
        Ok(kept)
    }

    /// So that the log of a task that was killed says what was saved.
    fn tell_where_it_goes_on(&self, file: &str) {
        if !self.session.plan.quiet {
            let percent = 100.0 * self.film.samples() as f64 / self.film.goal().max(1) as f64;
            console::say(&format!("{file}: {percent:.1} % is there, going on"));
        }
    }

    fn expose(&self, control: &Control, interrupts: &Interrupts, kept: Option<&mut Checkpoint>) -> Result<(), Stopped> {
        let Session { plan, reporter } = self.session;
        let goal = self.film.goal().saturating_sub(self.film.samples());
        let course = self.take.moment.course;
        let goal = match (self.take.picture.limit(), plan.time) {
            (Limit::Noise(level), _) => Goal::Noise(&self.film, *level),
            (_, Some(time)) => Goal::Time(time, goal),
            _ => Goal::Samples(goal),
        };
        let samples = matches!(goal, Goal::Samples(_)).then_some(self.take.picture.samples());
        reporter.start(&self.take.shot.output, self.take.picture.size(), samples, course);
        let watch = Watch { reporter, interrupts, control, goal, course };
        let work = || self.take.picture.expose(&self.film, control);
        let result = watched(&watch, || match (kept, &plan.checkpoint) {
            (Some(kept), Some(Keeping { every, .. })) => self.keeping(kept, *every, work),
            _ => work(),
        });
        if result.is_err() {
            reporter.clear();
        }
        result
    }

    /// Does `work` while another thread keeps the film again and again.
    fn keeping<T>(&self, kept: &mut Checkpoint, every: Duration, work: impl FnOnce() -> T) -> T {
        std::thread::scope(|scope| {
            let (running, ended) = mpsc::channel::<()>();
            scope.spawn(move || {
                while ended.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                    if let Err(error) = kept.save(&self.description, &self.film) {
                        console::say(&format!("warning: {error}"));
                    }
                }
            });
            let result = work();
            drop(running);
            result
        })
    }

    /// All pixels, the noise taken out of them where that is wished for.
    fn pixels(&self, control: &Control) -> Result<Option<Vec<Rgb>>, Failure> {
        let Some(denoiser) = self.session.plan.settings.denoiser else { return Ok(None) };
        let library = std::env::var_os("JUGGLER_OIDN").map(PathBuf::from);
        let guides = self.take.picture.guides(&self.film);
        let denoised = guides.denoise(denoiser, library.as_deref(), control)?;
        let denoised = denoised.ok_or_else(|| Failure::System(Stopped.to_string()))?;
        if !self.session.plan.quiet {
            report_moved(&denoised);
        }
        Ok(Some(denoised.pixels))
    }

    /// Writes the layers that were asked for; whether the picture itself is among them.
    fn write_layers(&self, pixels: Option<&[Rgb]>) -> Result<bool, Failure> {
        let Take { picture, shot, .. } = self.take;
        if picture.layers().wanted().is_empty() {
            return Ok(false);
        }
        let place = layers::place(&shot.output, shot.layers_output.as_deref());
        let (file, with_picture) = match &place {
            Place::InPicture => (shot.output.as_str(), true),
            Place::File(file) => (file.as_str(), false),
        };
        let header = picture.layers().file_header(&self.header, with_picture);
        let writer = LayeredWriter::create(Path::new(file), &header)?;
        let mut plain = Vec::new();
        if with_picture && pixels.is_none() {
            picture.develop(&self.film, |rows| {
                plain.extend_from_slice(rows);
                Ok::<(), Failure>(())
            })?;
        }
        picture.write_layers(&self.film, writer, with_picture.then(|| pixels.unwrap_or(&plain)))?;
        Ok(with_picture)
    }

    /// Writes the AOVs that have a file of their own or none; whether the picture is written too,
    /// and what went wrong with a file beside the picture.
    fn write_beside(&self, pixels: Option<&[Rgb]>) -> Result<(bool, Result<(), Failure>), Failure> {
        let Shot { output, layers_output, .. } = self.take.shot;
        match self.write_layers(pixels) {
            Ok(in_picture) => Ok((in_picture, Ok(()))),
            Err(failure) if layers::place(output, layers_output.as_deref()) == Place::InPicture => Err(failure),
            Err(failure) => Ok((false, Err(failure))),
        }
    }

    /// Writes the picture or the part; `pixels` are those of the picture where they are not the
    /// film's. And what went wrong beside it.
    fn write(&mut self, pixels: Option<&[Rgb]>) -> Result<(Summary, Result<(), Failure>), Failure> {
        let (picture, output) = (self.take.picture, &self.take.shot.output);
        match self.session.plan.product {
            Product::Part => {
                // What was kept last is the part, when both are one file.
                if self.take.shot.checkpoint.as_ref() != Some(output) {
                    write(Path::new(output), &self.description, self.film.tiles())?;
                }
                Ok((picture.develop(&self.film, |_| Ok::<(), Failure>(()))?, Ok(())))
            }
            Product::Picture(encoding) => {
                if *picture.limit() != Limit::Samples {
                    let spread = Spread::of_film(&self.film).to_string();
                    self.header.metadata.push((SAMPLES.to_owned(), spread));
                }
                if matches!(picture.limit(), Limit::Time { .. }) {
                    let counts = counts::to_text(&self.film.counts());
                    self.header.metadata.push((SAMPLES_PER_TILE.to_owned(), counts));
                }
                let (in_picture, beside) = self.write_beside(pixels)?;
                let writer = || self.session.writer(encoding.format, output, &self.header);
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
