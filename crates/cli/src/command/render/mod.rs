//! `juggler render`: one picture, or the pictures of an animation.

mod film;

use crate::args::RenderArgs;
use crate::console;
use crate::failure::Failure;
use crate::format::{amount, bytes, counted, duration};
use crate::interrupt::Interrupts;
use crate::output::{self, STANDARD_OUTPUT};
use crate::plan::{Encoding, Plan, Product, Shot};
use crate::progress::{Reporter, Watch, watched};
use crate::reproduce;
use crate::source;
use crate::stats::{Seconds, Stats, rays_per_second};
use juggler::imaging::{self, Format, Header, RowWriter};
use juggler::scene::Scene;
use juggler::tracer::film::Film;
use juggler::tracer::render::Control;
use juggler::{Outcome, Picture};
use std::path::Path;
use std::time::{Duration, Instant};

/// Shown after the help.
pub const EXAMPLES: &str = "\
Examples:
  juggler render juggler                                     the built-in scene, into juggler.png
  juggler render scene.json -o big.exr --size 3840x2160 --samples 256
  juggler render juggler --frames 0..30 -o 'frame_####.png'
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
    let pool = rayon::ThreadPoolBuilder::new().num_threads(plan.threads).build();
    let pool = pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?;
    pool.install(|| Session { reporter: plan.progress.reporter(), plan }.all(start))
}

/// All pictures of one command.
struct Session {
    plan: Plan,
    reporter: Reporter,
}

/// A picture on its way.
struct Take<'t> {
    shot: &'t Shot,
    picture: &'t Picture,
    load: Duration,
    build: Duration,
    start: Instant,
}

impl Session {
    fn all(self, start: Instant) -> Result<(), Failure> {
        let scene = source::load(&self.plan.scene)?;
        let animation = scene.description.animation;
        // Watched once there is something to clean up; until then a signal ends the program as it always does.
        let mut interrupts = None;
        let mut start = start;
        for shot in self.plan.shots(animation.frames, animation.frames_per_second)? {
            self.one(&scene, &shot, start, &mut interrupts)?;
            start = Instant::now();
        }
        Ok(())
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
        let built = Instant::now();
        let picture = Picture::new(scene, &self.plan.settings)?;
        self.warn(&picture);
        let take = Take { shot, picture: &picture, load, build: built.elapsed(), start };
        let mut header = picture.header(self.plan.options());
        header.metadata.push(("Command".to_owned(), reproduce::command(&self.plan, shot)));
        self.check_memory(&picture, &header)?;
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

    fn check_memory(&self, picture: &Picture, header: &Header) -> Result<(), Failure> {
        let Plan { threads, output, .. } = &self.plan;
        let mut parts = vec![("scene and rays".to_owned(), picture.memory_needed(*threads))];
        if let Product::Picture(Encoding { format, .. }) = self.plan.product {
            format.check_dimensions(header.width, header.height)?;
            parts.push((format!("the {format} file"), format.memory_needed(header, output != STANDARD_OUTPUT)));
        }
        if self.plan.needs_film() {
            parts.push(("the film".to_owned(), Film::bytes(&picture.layout())));
        }
        let needed = parts.iter().fold(0_u64, |sum, (_, part)| sum.saturating_add(*part));
        let Some(most) = self.plan.max_memory.filter(|most| needed > *most) else { return Ok(()) };
        let each: Vec<String> = parts.iter().map(|(name, part)| format!("{} for {name}", bytes(*part))).collect();
        Err(Failure::Wrong(format!(
            "the render needs about {} of memory ({}), more than --max-memory {}",
            bytes(needed),
            each.join(", "),
            bytes(most)
        )))
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
            let json = Stats::new(&self.plan.scene, picture, self.plan.threads, seconds, outcome).to_json();
            output::write_text(file, &json)?;
        }
        let lost = outcome.rays.not_finite;
        if lost > 0 {
            let samples = counted(lost.into(), "sample");
            console::say(&format!("warning: {samples} had no finite value and counted as black"));
        }
        if self.plan.quiet {
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
