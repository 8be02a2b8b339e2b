//! `juggler render`: renders a picture or the frames of an animation.

mod film_render;
mod folder;
mod frame;
mod frame_cache;
mod memory;
mod movie;
mod series;

use crate::args::RenderArgs;
use crate::console;
use crate::encoding::OutputKind;
use crate::failure::Failure;
use crate::format::{amount, clamping, counted, duration, samples};
use crate::interrupt::Interrupts;
use crate::output;
use crate::plan::{FrameOutput, Movie, Shard, effect, end_warning};
use crate::plans::Plans;
use crate::progress::{FrameProgress, Goal, Watch, with_progress};
use crate::reproduce;
use crate::source;
use crate::stats::{Seconds, Stats, rays_per_second};
use folder::{Access, FrameFolder};
use frame::{FrameRender, RenderCommand, RenderStart};
use frame_cache::FrameCache;
use juggler::camera::film::Rect;
use juggler::imaging::{AnimationHeader, Header, ImageFormat, Tone};
use juggler::memory::Effort;
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Picture, RenderStats, TONE};
use juggler_raybench::clock::{CpuClock, Stopwatch};
use movie::MovieEncoder;
use std::time::Instant;

/// Text after the short help.
pub const MORE: &str = "\
`juggler render --help` lists all flags, with examples.";

/// Text after the long help.
pub const EXAMPLES: &str = "\
Examples:
  juggler render juggler                                     the built-in scene, into juggler.png
  juggler render scene.json -o big.exr --size 3840x2160 --samples 256
  juggler render scenes -o pictures --resume                 all scenes of a folder, without those that are done
  juggler render juggler --frames 0..30 -o 'frame_####.png'
  juggler render juggler -o juggler.mp4                      all frames as a movie, also .webp .apng .gif
  juggler render juggler -o juggler.mp4 --shard 0/3          a third of its frames; without --shard they become the movie
  juggler render scene.json -o - | display                   the picture to another program
  juggler render scene.json --noise 0.02                     until the relative error is 2 %
  juggler render scene.json --checkpoint scene.jfilm         after an interruption, the same command resumes
  juggler render scene.json --shard 3/40 -o part3.jfilm      a fortieth of the picture; `juggler merge` joins them
  juggler info scene.png                                     how that picture was made

Exit status: 0 done, 2 the command line or the scene is wrong, 3 a file or the system failed,
129, 130 or 143 interrupted; of several scenes, that of the first that failed.";

/// Runs the command.
pub fn run(args: RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    match Plans::new(args)? {
        Plans::One(plan) => {
            output::check_stream(&plan.output)?;
            RenderCommand { reporter: plan.progress.reporter(), plan: *plan }.run(start, &mut None).map(drop)
        }
        Plans::Series { plans, folder } => series::run(plans, folder.as_deref()),
    }
}

impl RenderCommand {
    /// Renders the scene; returns whether there was something to render. Signals are caught from the
    /// first render on, when there are files to clean up; until then they end the program.
    fn run(self, start: Instant, interrupts: &mut Option<Interrupts>) -> Result<bool, Failure> {
        let scene = source::load_model(&self.plan.scene, &self.plan.model, self.plan.max_memory)?;
        effect::check_scene(&self.plan.settings, &scene)?;
        self.plan.model.stage.check_floor(self.plan.settings.transparent_of(&scene))?;
        let animation = scene.description.animation;
        let header = self.plan.movie.as_ref().map(|movie| self.header(movie, &scene)).transpose()?;
        let frame_outputs = self.plan.frame_outputs(animation.frames, animation.frames_per_second)?;
        self.warn_of_settings(&scene);
        let Some((movie, header)) = self.plan.movie.as_ref().zip(header) else {
            let files = frame_outputs.first().map(|FrameOutput { output, aov_output, checkpoint, .. }| {
                [Some(output), aov_output.as_ref(), checkpoint.as_ref()]
            });
            files.into_iter().flatten().flatten().try_for_each(|file| output::check_folder(file))?;
            return self.frames(&scene, &frame_outputs, start, interrupts, |_| true);
        };
        // Check the memory limit before the folder is created.
        frame_outputs.first().map(|first| memory::fit(&self.plan, &scene, first)).transpose()?;
        if self.plan.shard != Shard::WHOLE {
            let _folder = FrameFolder::open(&movie.folder(), Access::Shared)?;
            self.frames(&scene, &frame_outputs, start, interrupts, |_| true)
                .map_err(|failure| failure.with_saved_work(Some(movie.folder())))?;
            return self.report_frames(movie, frame_outputs.len()).map(|()| true);
        }
        let mut encoder = MovieEncoder::start(movie, header)?;
        let push = |frame_output: &FrameOutput| encoder.push(&frame_output.output);
        let frames = self.frames(&scene, &frame_outputs, start, interrupts, push);
        frames.map_err(|failure| failure.with_saved_work(Some(movie.folder())))?;
        encoder.finish()?;
        self.report_movie(movie, frame_outputs.len(), start).map(|()| true)
    }

    /// Header of the movie.
    ///
    /// # Errors
    ///
    /// Fails if the format does not support the movie, before the first frame is rendered.
    fn header(&self, movie: &Movie, scene: &Scene) -> Result<AnimationHeader, Failure> {
        let animation = scene.description.animation;
        let Rect { width, height, .. } = self.plan.settings.region(self.plan.settings.size_of(scene))?;
        let frames = self.plan.frames(animation.frames).len();
        let mut tone = (*scene.description.tone).clone();
        self.plan.settings.apply_to(&mut (*scene.description.render).clone(), &mut tone)?;
        // The frames of a movie with a backdrop are opaque pictures.
        let transparent = self.plan.settings.transparent_of(scene) && tone.backdrop.is_none();
        // An empty range of frames is an error of `frame_outputs`.
        let header = movie.header([width, height], frames.max(1), animation.frames_per_second);
        let header = AnimationHeader { transparent, ..header };
        movie.check(&header)?;
        if !tone.primaries.is_srgb() {
            let name = tone.primaries.name();
            return Err(Failure::Invalid(format!(
                "a movie cannot have the primaries `{name}`: only PNG and EXR pictures can"
            )));
        }
        Ok(header)
    }

    /// Renders the pictures in order, as long as `done` returns `true`. Returns whether one was
    /// rendered and did not exist already.
    fn frames(
        &self,
        scene: &Scene,
        frame_outputs: &[FrameOutput],
        start: Instant,
        interrupts: &mut Option<Interrupts>,
        mut done: impl FnMut(&FrameOutput) -> bool,
    ) -> Result<bool, Failure> {
        let mut some_rendered = false;
        let (mut frame_cache, mut frame_progress, mut start) =
            (FrameCache::default(), FrameProgress::new(frame_outputs.len()), start);
        for frame_output in frame_outputs {
            let current = Some(frame_progress).filter(|frame_progress| frame_progress.count > 1);
            let is_rendered = self.render_frame(
                scene,
                frame_output,
                &mut frame_cache,
                RenderStart { time: start, frame_progress: current },
                interrupts,
            )?;
            some_rendered |= is_rendered;
            if !done(frame_output) {
                break;
            }
            // Frames that exist already do not check for signals themselves.
            if let Some(failure) = interrupts.as_ref().and_then(Interrupts::caught) {
                return Err(failure);
            }
            frame_progress = frame_progress.after(is_rendered.then(|| start.elapsed()));
            start = Instant::now();
        }
        Ok(some_rendered)
    }

    /// Renders a picture; returns `false` if it exists already.
    fn render_frame(
        &self,
        scene: &Scene,
        frame_output: &FrameOutput,
        frame_cache: &mut FrameCache,
        start: RenderStart,
        interrupts: &mut Option<Interrupts>,
    ) -> Result<bool, Failure> {
        let moved;
        let scene = if frame_output.frame == 0.0 {
            scene
        } else {
            moved = scene.at_frame(frame_output.frame)?;
            &moved
        };
        let load = start.time.elapsed();
        let (memory, effort, frame_output) = memory::fit(&self.plan, scene, frame_output)?;
        frame_cache.set_threads(effort.threads)?;
        let built = Instant::now();
        let picture = frame_cache.picture(&self.plan, scene, interrupts.as_ref())?;
        let expected = memory.bytes(&effort);
        // With the world built, larger bands may fit.
        let Effort { band_pixels, .. } = memory::effort(&self.plan, &memory.with_world(&picture), effort.threads)?;
        let picture = picture.with_band_pixels(band_pixels);
        self.warn(&picture);
        let build = built.elapsed();
        let frame = FrameRender {
            frame_output: &frame_output,
            picture: &picture,
            effort,
            expected,
            load,
            build,
            start,
            stopwatch: Stopwatch::start(CpuClock::Process),
        };
        let needs_film = self.plan.needs_film(scene, &frame_output);
        let is_rendered = frame_cache.install(|| self.picture(&frame, needs_film, interrupts))?;
        frame_cache.keep(&self.plan, scene, picture)?;
        Ok(is_rendered)
    }

    fn picture(
        &self,
        frame: &FrameRender,
        needs_film: bool,
        interrupts: &mut Option<Interrupts>,
    ) -> Result<bool, Failure> {
        let mut header = frame.picture.header(self.plan.options());
        header.metadata.push(("Command".to_owned(), reproduce::command(&self.plan, frame.frame_output)));
        if header.tone != Tone::default() {
            // The scene's tone is not part of its fingerprint.
            let tone = serde_json::to_string(&header.tone).unwrap_or_default();
            header.metadata.push((TONE.to_owned(), tone));
        }
        // Frames of a movie are read again and encoded, and dithering would make still areas
        // flicker.
        header.tone.dither &= self.plan.movie.is_none();
        if let OutputKind::Picture(encoding) = self.plan.output_kind {
            header.check(encoding.format)?;
        }
        let interrupts = match interrupts {
            Some(interrupts) => interrupts,
            none => none.insert(Interrupts::watch()?),
        };
        if self.plan.keeps_existing() && movie::is_rendered(frame.frame_output, &header) {
            self.report_existing(frame.frame_output)?;
            return Ok(false);
        }
        let clamped = header.clamped.clone();
        let (outcome, beside) = match self.plan.output_kind {
            OutputKind::Picture(encoding) if !needs_film => {
                (self.render(frame, encoding.format, &header, interrupts)?, Ok(()))
            }
            _ => film_render::render(self, frame, header, interrupts)?,
        };
        console::warn_of_clamping(&clamped, &frame.frame_output.output, self.plan.quiet);
        self.report(frame, &outcome)?;
        beside.map(|()| true)
    }

    fn warn(&self, picture: &Picture) {
        let warnings = &picture.compiled().warnings;
        if !self.plan.quiet && !warnings.list().is_empty() {
            console::print_message(&warnings.render(console::color()));
        }
    }

    /// Warns of tone settings that the output format ignores, of frames beyond the end of the
    /// animation, and of a turn with one picture.
    fn warn_of_settings(&self, scene: &Scene) {
        let frames = scene.description.animation.frames;
        let last = self.plan.frames(frames).end.saturating_sub(1);
        // The tone of the scene around a model is not the user's.
        let tone = effect::ignored_tone_warning(self.plan.target(), &scene.description.tone);
        let tone = tone.filter(|_| !scene.is_around_model());
        let turn = self.plan.turn_note.clone();
        for warning in tone.into_iter().chain(end_warning(last, frames)).chain(turn).filter(|_| !self.plan.quiet) {
            console::print_message(&warning);
        }
    }

    /// Renders row by row.
    fn render(
        &self,
        frame: &FrameRender,
        format: ImageFormat,
        header: &Header,
        interrupts: &Interrupts,
    ) -> Result<RenderStats, Failure> {
        let FrameRender { frame_output, picture, .. } = frame;
        let control = Control::default();
        let writer = self.writer(format, &frame_output.output, header)?;
        let frame_progress = frame.start.frame_progress;
        self.reporter.start(&frame_output.output, picture.size(), Some(picture.samples()), frame_progress);
        let goal = Goal::Samples(picture.total_samples());
        let watch = Watch { reporter: &self.reporter, interrupts, control: &control, goal, frame_progress };
        with_progress(&watch, || picture.write(writer, &control)).map_err(|error| {
            self.reporter.clear();
            interrupts.caught().unwrap_or_else(|| error.into())
        })
    }

    /// Reports the result: progress events, statistics and a line of text.
    fn report(&self, frame: &FrameRender, outcome: &RenderStats) -> Result<(), Failure> {
        let FrameRender { frame_output, picture, start, .. } = frame;
        let total = start.time.elapsed();
        let seconds = Seconds {
            load: frame.load.as_secs_f64(),
            build: frame.build.as_secs_f64(),
            render: outcome.render.as_secs_f64(),
            denoise: outcome.denoise.as_secs_f64(),
            write: outcome.write.as_secs_f64(),
            total: total.as_secs_f64(),
            cpu: frame.stopwatch.elapsed().cpu,
        };
        self.reporter.done(&frame_output.output, seconds.total, outcome.rays.total(), &outcome.film.hash);
        if let Some(file) = &frame_output.stats {
            let mut stats = Stats::new(&self.plan.scene, picture, frame.effort.threads, seconds, outcome);
            stats.expected_memory(frame.expected);
            output::write_text(file, &stats.to_json())?;
        }
        let lost = self.warn_of_pixels(frame_output, outcome);
        let clamping = if picture.is_clamped() { format!(", {}", clamping(&outcome.film)) } else { String::new() };
        if self.plan.quiet || self.plan.movie.is_some() {
            // For frames of a movie, report only clamping.
            if picture.is_clamped() && !self.plan.quiet {
                console::print_message(&format!("{}{clamping}", frame_output.output));
            }
            return Ok(());
        }
        let [width, height] = picture.size();
        let samples = samples(&outcome.samples);
        let rate = amount(rays_per_second(&outcome.rays, seconds.render));
        let took = duration(total);
        self.print_line(&format!(
            "{}: {width}x{height}, {samples}, {took}, {rate} rays/s{clamping}{lost}",
            frame_output.output
        ))
    }

    /// Warns of samples that are not finite, and of a picture that is black. Returns the former as
    /// text.
    fn warn_of_pixels(&self, frame_output: &FrameOutput, outcome: &RenderStats) -> String {
        let output = &frame_output.output;
        let lost = match outcome.rays.not_finite {
            0 => String::new(),
            lost => format!(", {} not finite", counted(lost.into(), "sample")),
        };
        if !lost.is_empty() {
            console::print_message(&format!("warning: {output}{lost}, counted as black"));
        }
        // A frame of a movie may be black on purpose.
        if outcome.film.mean == [0.0; 3] && self.plan.movie.is_none() && !self.plan.quiet {
            let help = "`juggler check` names lights without power, `juggler probe` explains a pixel";
            console::print_message(&format!(
                "warning: {output}: all pixels are black: no light reaches the camera; {help}"
            ));
        }
        lost
    }

    /// Reports the frames of a shard, before the movie is encoded.
    fn report_frames(&self, movie: &Movie, frames: usize) -> Result<(), Failure> {
        let Shard { index, count } = self.plan.shard;
        let (folder, frames) = (movie.folder(), counted(frames as u128, "frame"));
        self.print_unless_quiet(&format!(
            "{folder}: {frames} of shard {index}/{count}; the same command without --shard encodes the movie"
        ))
    }

    fn report_movie(&self, movie: &Movie, frames: usize, start: Instant) -> Result<(), Failure> {
        let took = duration(start.elapsed());
        self.print_unless_quiet(&format!("{}: {}, {took}", movie.file, counted(frames as u128, "frame")))
    }

    /// Reports that a picture exists already, except for frames of a movie.
    fn report_existing(&self, frame_output: &FrameOutput) -> Result<(), Failure> {
        if self.plan.movie.is_some() {
            return Ok(());
        }
        self.print_unless_quiet(&format!("{}: exists already, made by the same command", frame_output.output))
    }

    fn print_unless_quiet(&self, line: &str) -> Result<(), Failure> {
        if self.plan.quiet { Ok(()) } else { self.print_line(line) }
    }

    /// Prints a line to standard output, or to standard error if standard output carries the
    /// picture or the statistics.
    fn print_line(&self, line: &str) -> Result<(), Failure> {
        if self.plan.uses_standard_output() {
            console::print_message(line);
            return Ok(());
        }
        console::print_result(line)
    }
}
