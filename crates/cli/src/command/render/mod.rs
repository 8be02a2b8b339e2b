//! `juggler render`: one picture, or the pictures of an animation.

mod film;
mod memory;
mod reel;

use crate::args::RenderArgs;
use crate::console;
use crate::failure::Failure;
use crate::format::{amount, counted, duration};
use crate::interrupt::Interrupts;
use crate::output::{self, STANDARD_OUTPUT};
use crate::plan::{Plan, Product, Shot};
use crate::progress::{Reporter, Watch, watched};
use crate::reproduce;
use crate::source;
use crate::stats::{Seconds, Stats, rays_per_second};
use juggler::imaging::{self, Format, Header, RowWriter};
use juggler::memory::{Effort, Memory};
use juggler::scene::Scene;
use juggler::tracer::render::Control;
use juggler::{Outcome, Picture};
use reel::Encoder;
use std::path::Path;
use std::time::{Duration, Instant};

/// Shown after the help.
pub const EXAMPLES: &str = "\
Examples:
  juggler render juggler                                     the built-in scene, into juggler.png
  juggler render scene.json -o big.exr --size 3840x2160 --samples 256
  juggler render juggler --frames 0..30 -o 'frame_####.png'
  juggler render juggler -o juggler.gif                      all frames as a film
  juggler render scene.json -o - | display                   the picture to another program
  juggler render scene.json --noise 0.02                     until it is good enough
  juggler render scene.json --checkpoint scene.jfilm         the same command again goes on where it ended
  juggler render scene.json --shard 3/40 -o part3.jfilm      a fortieth of it; `juggler merge` joins them
  juggler info scene.png                                     how that picture was made

Exit status: 0 done, 2 the command line or the scene is wrong, 3 a file or the system failed, 130 or 143 interrupted.";

/// Renders what was asked for.
pub fn run(args: RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let plan = Plan::new(args)?;
    Session { reporter: plan.progress.reporter(), plan }.all(start)
}

/// All pictures of one command.
struct Session {
    plan: Plan,
    reporter: Reporter,
}

/// A picture whose world is to be built.
struct Ready<'t> {
    scene: &'t Scene,
    shot: &'t Shot,
    memory: Memory,
    effort: Effort,
    load: Duration,
    start: Instant,
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
    start: Instant,
}

impl Session {
    fn all(self, start: Instant) -> Result<(), Failure> {
        let scene = source::load(&self.plan.scene, self.plan.max_memory)?;
        let animation = scene.description.animation;
        // Watched once there is something to clean up; until then a signal ends the program as it always does.
        let mut interrupts = None;
        let mut start = start;
        let shots = self.plan.shots(animation.frames, animation.frames_per_second)?;
        let began = start;
        let encoder = self.plan.reel.as_ref();
        let encoder = encoder.map(|reel| Encoder::start(reel, shots.len(), animation.frames_per_second));
        let mut encoder = encoder.transpose()?;
        for shot in &shots {
            self.one(&scene, shot, start, &mut interrupts).map_err(|failure| match &self.plan.reel {
                Some(reel) => failure.keeping(Some(reel.folder())),
                None => failure,
            })?;
            if encoder.as_mut().is_some_and(|encoder| !encoder.take(&shot.output)) {
                break;
            }
            start = Instant::now();
        }
        let Some((encoder, reel)) = encoder.zip(self.plan.reel.as_ref()) else { return Ok(()) };
        encoder.finish()?;
        if self.plan.quiet {
            return Ok(());
        }
        self.tell(&format!("{}: {}, {}", reel.file, counted(shots.len() as u128, "frame"), duration(began.elapsed())))
    }

    fn one(
        &self,
        scene: &Scene,
        shot: &Shot,
        start: Instant,
        interrupts: &mut Option<Interrupts>,
    ) -> Result<(), Failure> {
        let moved;
        let scene = if shot.frame == 0.0 {
            scene
        } else {
            moved = scene.at_frame(shot.frame)?;
            &moved
        };
        let load = start.elapsed();
        let memory = memory::of(&self.plan, scene, shot)?;
        let effort = memory::effort(&self.plan, &memory, self.plan.threads)?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(effort.threads).build();
        let pool = pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?;
        let ready = Ready { scene, shot, memory, effort, load, start };
        pool.install(|| self.picture(ready, interrupts))
    }

    fn picture(&self, ready: Ready, interrupts: &mut Option<Interrupts>) -> Result<(), Failure> {
        let Ready { scene, shot, memory, effort, load, start } = ready;
        let built = Instant::now();
        let picture = Picture::new(scene, &self.plan.settings)?;
        let expected = memory.bytes(&effort);
        // The threads are there; now that the world stands, larger bands may fit.
        let Effort { band_pixels, .. } = memory::effort(&self.plan, &memory.of_built(&picture), effort.threads)?;
        let picture = picture.with_bands(band_pixels);
        self.warn(&picture);
        let take = Take { shot, picture: &picture, effort, expected, load, build: built.elapsed(), start };
        let mut header = picture.header(self.plan.options());
        header.metadata.push(("Command".to_owned(), reproduce::command(&self.plan, shot)));
        if self.plan.reel.is_some() {
            header.metadata.push(("Tone".to_owned(), format!("{:?}", header.tone)));
            if reel::is_made(&shot.output, &header) {
                return Ok(());
            }
        }
        let interrupts = match interrupts {
            Some(interrupts) => interrupts,
            none => none.insert(Interrupts::watch()?),
        };
        let outcome = match self.plan.product {
            Product::Picture(encoding) if !self.plan.needs_film() => {
                self.render(&take, encoding.format, &header, interrupts)?
            }
            _ => film::render(self, &take, header, interrupts)?,
        };
        self.report(&take, &outcome)
    }

    fn warn(&self, picture: &Picture) {
        let warnings = &picture.compiled().warnings;
        if !self.plan.quiet && !warnings.list().is_empty() {
            console::say(&warnings.render(console::color()));
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
        self.reporter.start(&shot.output, picture.size(), picture.samples());
        let samples = picture.total_samples();
        let watch = Watch { reporter: &self.reporter, interrupts, control: &control, samples, time: None };
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
        let Take { shot, picture, start, .. } = take;
        let total = start.elapsed();
        let seconds = Seconds {
            load: take.load.as_secs_f64(),
            build: take.build.as_secs_f64(),
            render: outcome.render.as_secs_f64(),
            denoise: 0.0,
            write: outcome.write.as_secs_f64(),
            total: total.as_secs_f64(),
        };
        self.reporter.done(&shot.output, seconds.total, outcome.rays.total(), &outcome.film.hash);
        if let Some(file) = &shot.stats {
            let mut stats = Stats::new(&self.plan.scene, picture, take.effort.threads, seconds, outcome);
            stats.expected_memory(take.expected);
            output::write_text(file, &stats.to_json())?;
        }
        let lost = outcome.rays.not_finite;
        if lost > 0 {
            let samples = counted(lost.into(), "sample");
            console::say(&format!("warning: {samples} had no finite value and counted as black"));
        }
        if self.plan.quiet || self.plan.reel.is_some() {
            return Ok(());
        }
        let [width, height] = picture.size();
        let samples = counted(picture.samples().into(), "sample");
        let rate = amount(rays_per_second(&outcome.rays, seconds.render));
        let took = duration(total);
        self.tell(&format!("{}: {width}x{height}, {samples}, {took}, {rate} rays/s", shot.output))
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
