//! `juggler render`: one picture, or the pictures of an animation.

mod film;
mod folder;
mod memory;
mod reel;
mod studio;

use crate::args::RenderArgs;
use crate::console;
use crate::failure::Failure;
use crate::format::{amount, clamping, counted, duration, samples};
use crate::interrupt::Interrupts;
use crate::output::{self, STANDARD_OUTPUT};
use crate::plan::{Plan, Product, Reel, Shard, Shot, beyond_the_end, effect};
use crate::progress::{Course, Goal, Reporter, Watch, watched};
use crate::reproduce;
use crate::source;
use crate::stats::{Seconds, Stats, rays_per_second};
use folder::{Folder, Use};
use juggler::camera::film::Rect;
use juggler::imaging::{self, AnimationHeader, Format, Header, RowWriter, Tone};
use juggler::memory::Effort;
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Outcome, Picture};
use reel::Encoder;
use std::path::Path;
use std::time::{Duration, Instant};
use studio::Studio;

/// Shown after the short help.
pub const MORE: &str = "\
`juggler render --help` tells all flags, with examples.";

/// Shown after the whole help.
pub const EXAMPLES: &str = "\
Examples:
  juggler render juggler                                     the built-in scene, into juggler.png
  juggler render scene.json -o big.exr --size 3840x2160 --samples 256
  juggler render juggler --frames 0..30 -o 'frame_####.png'
  juggler render juggler -o juggler.mp4                      all frames as a movie, also .webp .apng .gif
  juggler render juggler -o juggler.mp4 --shard 0/3          a third of its frames; without --shard they become the movie
  juggler render scene.json -o - | display                   the picture to another program
  juggler render scene.json --noise 0.02                     until it is good enough
  juggler render scene.json --checkpoint scene.jfilm         the same command again goes on where it ended
  juggler render scene.json --shard 3/40 -o part3.jfilm      a fortieth of it; `juggler merge` joins them
  juggler info scene.png                                     how that picture was made

Exit status: 0 done, 2 the command line or the scene is wrong, 3 a file or the system failed,
129, 130 or 143 interrupted.";

/// Renders what was asked for.
pub fn run(args: RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let plan = Plan::new(args)?;
    output::check_stream(&plan.output)?;
    Session { reporter: plan.progress.reporter(), plan }.all(start)
}

/// All pictures of one command.
struct Session {
    plan: Plan,
    reporter: Reporter,
}

/// When a picture was begun, and where it stands among others.
#[derive(Clone, Copy)]
struct Moment {
    start: Instant,
    course: Option<Course>,
}

/// A picture on its way.
struct Take<'t> {
    shot: &'t Shot,
    picture: &'t Picture,
    effort: Effort,
    /// Bytes that were thought to be needed.
    expected: u64,
    load: Duration,
    build: Duration,
    moment: Moment,
}

impl Session {
    fn all(self, start: Instant) -> Result<(), Failure> {
        let scene = source::load(&self.plan.scene, self.plan.max_memory)?;
        effect::check_scene(&self.plan.settings, &scene)?;
        let animation = scene.description.animation;
        let header = self.plan.reel.as_ref().map(|reel| self.header(reel, &scene)).transpose()?;
        let shots = self.plan.shots(animation.frames, animation.frames_per_second)?;
        self.warn_of_settings(&scene);
        let Some((reel, header)) = self.plan.reel.as_ref().zip(header) else {
            let files = shots.first().map(|Shot { output, layers_output, checkpoint, .. }| {
                [Some(output), layers_output.as_ref(), checkpoint.as_ref()]
            });
            files.into_iter().flatten().flatten().try_for_each(|file| output::check_folder(file))?;
            return self.frames(&scene, &shots, start, |_| true);
        };
        // What needs more memory than it may have is refused before anything is there, too.
        shots.first().map(|first| memory::fitting(&self.plan, &scene, first)).transpose()?;
        if self.plan.shard != Shard::WHOLE {
            let _folder = Folder::open(&reel.folder(), Use::Shared)?;
            self.frames(&scene, &shots, start, |_| true).map_err(|failure| failure.keeping(Some(reel.folder())))?;
            return self.tell_frames(reel, shots.len());
        }
        let mut encoder = Encoder::start(reel, header)?;
        let frames = self.frames(&scene, &shots, start, |shot| encoder.take(&shot.output));
        frames.map_err(|failure| failure.keeping(Some(reel.folder())))?;
        encoder.finish()?;
        self.tell_film(reel, shots.len(), start)
    }

    /// What the film says besides its frames. What its format cannot take is refused here, before the first is rendered.
    fn header(&self, reel: &Reel, scene: &Scene) -> Result<AnimationHeader, Failure> {
        let animation = scene.description.animation;
        let Rect { width, height, .. } = self.plan.settings.region(self.plan.settings.size_of(scene))?;
        let frames = self.plan.frames(animation.frames).len();
        // Whether there are any is told with the pictures.
        let header = reel.header([width, height], frames.max(1), animation.frames_per_second);
        reel.check(&header)?;
        let mut tone = (*scene.description.tone).clone();
        self.plan.settings.apply_to(&mut (*scene.description.render).clone(), &mut tone)?;
        if !tone.primaries.is_srgb() {
            let name = tone.primaries.name();
            return Err(Failure::Wrong(format!(
                "a film cannot have the primaries `{name}`: only PNG and EXR pictures can"
            )));
        }
        Ok(header)
    }

    /// Makes one picture after the other; `done` says whether it goes on.
    fn frames(
        &self,
        scene: &Scene,
        shots: &[Shot],
        start: Instant,
        mut done: impl FnMut(&Shot) -> bool,
    ) -> Result<(), Failure> {
        // Watched once there is something to clean up; until then a signal ends the program as it always does.
        let mut interrupts = None;
        let (mut studio, mut course, mut start) = (Studio::default(), Course::new(shots.len()), start);
        for shot in shots {
            let course_now = Some(course).filter(|course| course.of > 1);
            let is_rendered =
                self.one(scene, shot, &mut studio, Moment { start, course: course_now }, &mut interrupts)?;
            if !done(shot) {
                break;
            }
            // Between frames that are there already, nobody else looks.
            if let Some(failure) = interrupts.as_ref().and_then(Interrupts::caught) {
                return Err(failure);
            }
            course = course.after(is_rendered.then(|| start.elapsed()));
            start = Instant::now();
        }
        Ok(())
    }

    /// Makes a picture; `false` when it was there already.
    fn one(
        &self,
        scene: &Scene,
        shot: &Shot,
        studio: &mut Studio,
        moment: Moment,
        interrupts: &mut Option<Interrupts>,
    ) -> Result<bool, Failure> {
        let moved;
        let scene = if shot.frame == 0.0 {
            scene
        } else {
            moved = scene.at_frame(shot.frame)?;
            &moved
        };
        let load = moment.start.elapsed();
        let (memory, effort, shot) = memory::fitting(&self.plan, scene, shot)?;
        studio.gather(effort.threads)?;
        let built = Instant::now();
        let picture = studio.picture(&self.plan, scene)?;
        let expected = memory.bytes(&effort);
        // The threads are there; now that the world stands, larger bands may fit.
        let Effort { band_pixels, .. } = memory::effort(&self.plan, &memory.of_built(&picture), effort.threads)?;
        let picture = picture.with_bands(band_pixels);
        self.warn(&picture);
        let build = built.elapsed();
        let take = Take { shot: &shot, picture: &picture, effort, expected, load, build, moment };
        let is_rendered = studio.on_threads(|| self.picture(&take, interrupts))?;
        studio.keep(&self.plan, scene, picture)?;
        Ok(is_rendered)
    }

    fn picture(&self, take: &Take, interrupts: &mut Option<Interrupts>) -> Result<bool, Failure> {
        let mut header = take.picture.header(self.plan.options());
        header.metadata.push(("Command".to_owned(), reproduce::command(&self.plan, take.shot)));
        if header.tone != Tone::default() {
            // The scene's own tone is no part of its fingerprint.
            let tone = serde_json::to_string(&header.tone).unwrap_or_default();
            header.metadata.push((reel::TONE.to_owned(), tone));
        }
        // Its frames are read again as what they are, and what stands still in a film is to stand still.
        header.tone.dither &= self.plan.reel.is_none();
        if let Product::Picture(encoding) = self.plan.product {
            header.check_primaries(encoding.format)?;
        }
        let interrupts = match interrupts {
            Some(interrupts) => interrupts,
            none => none.insert(Interrupts::watch()?),
        };
        if self.plan.leaves_what_is_there() && reel::is_made(take.shot, &header) {
            self.tell_left(take.shot)?;
            return Ok(false);
        }
        let (outcome, beside) = match self.plan.product {
            Product::Picture(encoding) if !self.plan.needs_film(take.shot) => {
                (self.render(take, encoding.format, &header, interrupts)?, Ok(()))
            }
            _ => film::render(self, take, header, interrupts)?,
        };
        self.report(take, &outcome)?;
        beside.map(|()| true)
    }

    fn warn(&self, picture: &Picture) {
        let warnings = &picture.compiled().warnings;
        if !self.plan.quiet && !warnings.list().is_empty() {
            console::say(&warnings.render(console::color()));
        }
    }

    /// Warns of settings of the scene's tone that the format of the picture ignores, and of frames
    /// beyond the end.
    fn warn_of_settings(&self, scene: &Scene) {
        let frames = scene.description.animation.frames;
        let last = self.plan.frames(frames).end.saturating_sub(1);
        let tone = effect::idle_tone(self.plan.target(), &scene.description.tone);
        for warning in tone.into_iter().chain(beyond_the_end(last, frames)).filter(|_| !self.plan.quiet) {
            console::say(&warning);
        }
    }

    /// Renders row by row.
    fn render(
        &self,
        take: &Take,
        format: Format,
        header: &Header,
        interrupts: &Interrupts,
    ) -> Result<Outcome, Failure> {
        let Take { shot, picture, .. } = take;
        let control = Control::default();
        let writer = self.writer(format, &shot.output, header)?;
        let course = take.moment.course;
        self.reporter.start(&shot.output, picture.size(), Some(picture.samples()), course);
        let goal = Goal::Samples(picture.total_samples());
        let watch = Watch { reporter: &self.reporter, interrupts, control: &control, goal, course };
        watched(&watch, || picture.write(writer, &control)).map_err(|error| {
            self.reporter.clear();
            interrupts.caught().unwrap_or_else(|| error.into())
        })
    }

    fn writer(&self, format: Format, output: &str, header: &Header) -> Result<Box<dyn RowWriter>, Failure> {
        Ok(match output {
            STANDARD_OUTPUT => imaging::to_standard_output(format, header)?,
            file => imaging::create(Path::new(file), format, header)?,
        })
    }

    /// Says what was done: to programs, to a file, to people.
    fn report(&self, take: &Take, outcome: &Outcome) -> Result<(), Failure> {
        let Take { shot, picture, moment, .. } = take;
        let total = moment.start.elapsed();
        let seconds = Seconds {
            load: take.load.as_secs_f64(),
            build: take.build.as_secs_f64(),
            render: outcome.render.as_secs_f64(),
            denoise: outcome.denoise.as_secs_f64(),
            write: outcome.write.as_secs_f64(),
            total: total.as_secs_f64(),
        };
        self.reporter.done(&shot.output, seconds.total, outcome.rays.total(), &outcome.film.hash);
        if let Some(file) = &shot.stats {
            let mut stats = Stats::new(&self.plan.scene, picture, take.effort.threads, seconds, outcome);
            stats.expected_memory(take.expected);
            output::write_text(file, &stats.to_json())?;
        }
        let lost = match outcome.rays.not_finite {
            0 => String::new(),
            lost => format!(", {} not finite", counted(lost.into(), "sample")),
        };
        if !lost.is_empty() {
            console::say(&format!("warning: {}{lost}, counted as black", shot.output));
        }
        let clamping = if picture.is_clamped() { format!(", {}", clamping(&outcome.film)) } else { String::new() };
        if self.plan.quiet || self.plan.reel.is_some() {
            // Of a film's frames only this is told.
            if picture.is_clamped() && !self.plan.quiet {
                console::say(&format!("{}{clamping}", shot.output));
            }
            return Ok(());
        }
        let [width, height] = picture.size();
        let samples = samples(&outcome.samples);
        let rate = amount(rays_per_second(&outcome.rays, seconds.render));
        let took = duration(total);
        self.tell(&format!("{}: {width}x{height}, {samples}, {took}, {rate} rays/s{clamping}{lost}", shot.output))
    }

    /// Says which frames are there for a film to come.
    fn tell_frames(&self, reel: &Reel, frames: usize) -> Result<(), Failure> {
        let Shard { index, count } = self.plan.shard;
        let (folder, frames) = (reel.folder(), counted(frames as u128, "frame"));
        self.tell_unless_quiet(&format!(
            "{folder}: {frames} of shard {index}/{count}; the same command without --shard makes the film"
        ))
    }

    fn tell_film(&self, reel: &Reel, frames: usize, start: Instant) -> Result<(), Failure> {
        let took = duration(start.elapsed());
        self.tell_unless_quiet(&format!("{}: {}, {took}", reel.file, counted(frames as u128, "frame")))
    }

    /// Says that a picture was there; of a film's frames nobody wants to know.
    fn tell_left(&self, shot: &Shot) -> Result<(), Failure> {
        if self.plan.reel.is_some() {
            return Ok(());
        }
        self.tell_unless_quiet(&format!("{}: is there already, made by the same command", shot.output))
    }

    fn tell_unless_quiet(&self, line: &str) -> Result<(), Failure> {
        if self.plan.quiet { Ok(()) } else { self.tell(line) }
    }

    /// A line about what was done goes where no picture and no statistics go.
    fn tell(&self, line: &str) -> Result<(), Failure> {
        if self.plan.stream_taken() {
            console::say(line);
            return Ok(());
        }
        console::print(line)
    }
}
