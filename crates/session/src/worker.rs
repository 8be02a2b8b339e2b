//! The thread that turns edits into pictures.

use crate::coarse::{Pace, coarse_size};
use crate::draw::draw;
use crate::screen::{self, Canvas, Draft, Toner};
use crate::session::Options;
use crate::shared::{Rendering, Shared, Shown};
use crate::subject::{Build, Change, Subject};
use crate::{Channel, Edit, Frame, Setting, Stage, Status};
use juggler::Picture;
use juggler::tracer::film::{Film, Layout, Rect};
use juggler::tracer::render::{self, Control, Scheduler, Stop};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long after a frame the next edit is waited for before the picture gets better.
const LINGER: Duration = Duration::from_millis(20);
/// The first picture that gets better is shown after so long, later ones ever less often.
const FIRST_SHOW: Duration = Duration::from_millis(40);
const LAST_SHOW: Duration = Duration::from_millis(500);
/// A world that takes longer is told of.
const QUICK: Duration = Duration::from_millis(100);

/// The thread that turns edits into pictures.
pub struct Worker {
    pub shared: Arc<Shared>,
    pub options: Options,
    pub pool: Arc<ThreadPool>,
    pub scheduler: Scheduler,
    pub subject: Option<Arc<Subject>>,
    /// Samples of the picture so far.
    pub film: Option<Arc<Film>>,
    pub draft: Draft,
    pub canvas: Option<Canvas>,
    pub toner: Toner,
    pub channel: Channel,
    pub region: Option<Rect>,
    pub pace: Pace,
    pub status: Status,
    /// The world that is being built: its number, when it began, whether it is another scene.
    pub building: Option<(u64, Instant, bool)>,
    pub builds: u64,
    /// The picture is another one than the draft shows.
    pub moved: bool,
    /// The film is to be shown anew.
    pub retoned: bool,
    pub drawn: Instant,
    /// Since when it plays, and from which frame.
    pub playing: Option<(Instant, f64)>,
}

/// Threads that render.
pub fn pool(threads: usize) -> Option<Arc<ThreadPool>> {
    ThreadPoolBuilder::new().num_threads(threads).thread_name(|i| format!("session {i}")).build().ok().map(Arc::new)
}

impl Worker {
    /// Works until the session is closed.
    pub fn run(mut self) {
        loop {
            if self.shared.desk().closed {
                return;
            }
            self.take_built();
            self.take_edits();
            self.play();
            if self.moved && self.building.is_none() {
                self.draw();
            } else if self.retoned {
                self.repaint();
            } else if !self.refine() {
                self.rest();
            }
        }
    }

    fn rest(&self) {
        let due = self.playing.filter(|_| self.building.is_none()).map(|_| Duration::from_millis(5));
        let slow = self.building.is_some() && self.status.stage != Stage::Loading;
        let due = due.or(slow.then_some(QUICK));
        let building = self.building.is_some();
        self.shared.rest(due, |desk| {
            // While a world is built, only another scene is of interest.
            desk.closed
                || desk.built.is_some()
                || if building { desk.edits.iter().any(supersedes) } else { !desk.edits.is_empty() }
        });
    }

    fn publish(&mut self, frame: Option<Frame>) {
        let shown = self.subject.clone().zip(self.film.clone()).map(|(subject, film)| Shown { subject, film });
        self.shared.publish(frame, self.status.clone(), shown);
    }

    /// Takes a world that was built.
    fn take_built(&mut self) {
        let built = self.shared.desk().built.take();
        if let Some((_, began, _)) = self.building
            && began.elapsed() >= QUICK
            && built.is_none()
            && self.status.stage != Stage::Loading
        {
            self.status.stage = Stage::Loading;
            self.publish(None);
        }
        let Some((number, result)) = built else { return };
        let Some((_, _, fresh)) = self.building.filter(|(wanted, ..)| *wanted == number) else { return };
        self.building = None;
        match result {
            Ok(subject) => {
                self.status.error = None;
                if fresh {
                    (self.region, self.playing) = (None, None);
                    self.pace.forget();
                }
                self.subject = Some(Arc::new(subject));
                self.film = None;
                self.moved = true;
                self.describe();
            }
            Err(error) => {
                self.status.error = Some(error);
                self.status.stage = Stage::Finished;
                self.playing = None;
                self.publish(None);
            }
        }
    }

    fn take_edits(&mut self) {
        loop {
            let edit = {
                let mut desk = self.shared.desk();
                if self.building.is_some() {
                    let Some(at) = desk.edits.iter().position(supersedes) else { return };
                    // What came before is about a scene that nobody wants to see any more.
                    desk.edits.drain(..at);
                    self.status.revision += at as u64;
                }
                let Some(edit) = desk.edits.pop_front() else { return };
                self.status.revision += 1;
                // Of several in a row only the last is seen.
                if desk.edits.front().is_some_and(|next| replaces(next, &edit)) {
                    continue;
                }
                edit
            };
            if let Err(error) = self.apply(&edit) {
                self.status.error = Some(error);
                self.publish(None);
            }
        }
    }

    fn apply(&mut self, edit: &Edit) -> Result<(), String> {
        match edit {
            Edit::Show(channel) => {
                (self.channel, self.moved) = (*channel, true);
                self.status.channel = *channel;
            }
            Edit::Region(region) => self.confine(*region),
            Edit::Play(play) => {
                let from = self.subject.as_ref().filter(|subject| *play && subject.animation().is_some());
                self.playing = from.map(|subject| (Instant::now(), subject.frame()));
                self.status.playing = self.playing.is_some();
                self.publish(None);
            }
            Edit::Setting(Setting::Threads(threads)) => {
                self.pool = pool(*threads).ok_or("error: the threads cannot be started")?;
                self.pace.forget();
                self.describe();
                self.publish(None);
            }
            Edit::Setting(Setting::Scheduler(name)) => {
                self.scheduler = scheduler(name)?;
                name.clone_into(&mut self.status.scheduler);
                self.publish(None);
            }
            Edit::Bookmark(name) => self.bookmark(name)?,
            Edit::Scene(name) if self.subject.is_none() => {
                let size = self.options.size;
                self.build(Build::open(name, size), true);
            }
            edit => self.apply_to_subject(edit)?,
        }
        Ok(())
    }

    fn apply_to_subject(&mut self, edit: &Edit) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        let before = Arc::clone(subject.picture());
        match Arc::make_mut(subject).apply(edit)? {
            Change::Nothing => self.describe(),
            Change::Build(build) => self.build(build, matches!(edit, Edit::Scene(_))),
            Change::View => {
                self.status.error = None;
                let picture = Arc::clone(subject.picture());
                self.take_view(&before, &picture);
                self.describe();
            }
        }
        Ok(())
    }

    /// The film goes on when its samples are those of the new picture too.
    fn take_view(&mut self, before: &Picture, picture: &Picture) {
        if before.shares_samples(picture) {
            self.retoned = true;
            self.refilm();
        } else {
            (self.film, self.moved) = (None, true);
        }
    }

    fn bookmark(&mut self, name: &str) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        Arc::make_mut(subject).keep(name);
        self.describe();
        self.publish(None);
        Ok(())
    }

    /// Has a world built beside this thread.
    pub fn build(&mut self, build: Build, fresh: bool) {
        self.builds += 1;
        let (number, shared) = (self.builds, Arc::clone(&self.shared));
        self.building = Some((number, Instant::now(), fresh));
        if fresh {
            self.status.stage = Stage::Loading;
            self.publish(None);
        }
        self.pool.spawn(move || {
            let result = build.run();
            shared.tell(|desk| desk.built = Some((number, result)));
        });
    }

    fn play(&mut self) {
        let (Some((since, from)), Some(subject)) = (self.playing, &self.subject) else { return };
        let Some(animation) = subject.animation().filter(|_| self.building.is_none() && !self.moved) else { return };
        let frames = f64::from(animation.frames);
        let at = (from + since.elapsed().as_secs_f64() * animation.frames_per_second).floor().rem_euclid(frames);
        if at != subject.frame() {
            // A subject that can be played has a world for every frame, or says what is wrong.
            if let Err(error) = self.apply_to_subject(&Edit::At(at)) {
                (self.status.error, self.playing) = (Some(error), None);
            }
        }
    }

    /// A frame as fine as the budget allows.
    fn draw(&mut self) {
        let Some(subject) = self.subject.clone() else {
            self.moved = false;
            return;
        };
        let picture = subject.picture();
        let budget = self.options.budget;
        let coarseness = self.pace.coarseness(picture.size(), budget.as_secs_f64());
        let size = coarse_size(picture.size(), coarseness);
        let control = Arc::new(Control::default());
        let began = Instant::now();
        self.shared.desk().rendering =
            Some(Rendering { control: Arc::clone(&control), until: Some(began + budget * 2) });
        let (channel, scheduler) = (self.channel, self.scheduler);
        let toner = self.toner_of(picture);
        let drawn = self.pool.install(|| {
            let draft = draw(picture, size, channel, scheduler, &control)?;
            let rgba = toner.picture(&draft.pixels);
            Ok::<_, render::Stopped>((draft, rgba))
        });
        self.shared.desk().rendering = None;
        let seconds = began.elapsed().as_secs_f64();
        self.pace.learn(control.samples() as f64, seconds);
        let Ok((draft, rgba)) = drawn else { return };
        self.measure(&control, seconds);
        (self.draft, self.toner, self.canvas, self.moved) = (draft, toner, None, false);
        self.retoned = false;
        self.refilm();
        (self.status.stage, self.status.coarseness) = (Stage::Moving, coarseness);
        (self.status.samples, self.status.noise, self.status.hash) = (0.0, None, None);
        let samples = if coarseness == 1 { 1.0 } else { 0.0 };
        let frame = self.frame(size, rgba, samples);
        self.publish(Some(frame));
    }

    fn frame(&self, [width, height]: [u32; 2], rgba: Vec<u8>, samples: f32) -> Frame {
        let revision = self.status.revision;
        Frame { number: 0, revision, width, height, rgba, size: self.status.size, samples }
    }

    fn measure(&mut self, control: &Control, seconds: f64) {
        self.status.rays_per_second = (control.rays().total() as f64 / seconds.max(1e-9)) as f32;
        let since = self.drawn.elapsed().as_secs_f64();
        self.drawn = Instant::now();
        if since < 0.5 {
            let now = (1.0 / since.max(1e-6)) as f32;
            let before = self.status.frames_per_second;
            self.status.frames_per_second = if before > 0.0 { before + (now - before) * 0.2 } else { now };
        }
    }

    fn toner_of(&self, picture: &Picture) -> Toner {
        match self.channel {
            Channel::Color | Channel::Albedo | Channel::Samples | Channel::Noise => Toner::new(picture.tone()),
            _ => Toner::plain(),
        }
    }

    /// A film for the picture as it is now, with the samples that are there; only the region gets more.
    pub fn refilm(&mut self) {
        let Some(subject) = &self.subject else { return };
        let picture = subject.picture();
        let layout = Layout::new(picture.region());
        let (wanted, region) = (picture.samples(), self.region);
        let inside = |number: u64| {
            let tile = layout.tile(number);
            region.is_none_or(|region| tile.is_some_and(|tile| tile.intersection(&region).area() > 0))
        };
        let have = |number: u64| {
            self.film.as_ref().and_then(|film| film.tile(number as usize).map(|tile| tile.count())).unwrap_or(0)
        };
        let share = |number: u64| (number, 0..if inside(number) { wanted } else { have(number).min(wanted) });
        let film = Film::of(layout, (0..layout.tiles()).map(share));
        if let Some(old) = self.film.take() {
            if (0..old.len()).any(|place| old.tile(place).is_some_and(|tile| tile.count() > wanted)) {
                self.film = Some(Arc::new(film));
                return;
            }
            for (number, tile) in old.tiles() {
                // Tiles of the same layout: none is of other pixels, none is there already.
                let added = film.add(number, tile);
                debug_assert!(added.is_ok());
            }
        }
        self.film = Some(Arc::new(film));
    }

    fn confine(&mut self, region: Option<Rect>) {
        let [width, height] = self.status.size;
        let whole = Rect { x: 0, y: 0, width, height };
        self.region = region.map(|region| region.intersection(&whole)).filter(|region| region.area() > 0);
        self.status.region = self.region;
        self.refilm();
        self.publish(None);
    }

    /// The same samples shown otherwise.
    fn repaint(&mut self) {
        self.retoned = false;
        let Some(subject) = self.subject.clone() else { return };
        self.toner = self.toner_of(subject.picture());
        self.canvas = None;
        if self.draft.pixels.is_empty() {
            return;
        }
        self.show(self.status.samples);
    }

    /// Shows the film as it is, over the draft.
    fn show(&mut self, samples: f32) {
        let Some(film) = self.film.clone() else { return };
        let size = self.status.size;
        let toner = &self.toner;
        let canvas = self.canvas.get_or_insert_with(|| Canvas::new(&self.draft, size, toner));
        let wanted = self.status.samples_wanted;
        // A whole picture through the pixels' centres looks better than one through one place of each.
        let least = if self.draft.size == size { wanted.min(4) } else { 1 };
        match self.channel {
            Channel::Color => canvas.paint(&film, least, |tile| screen::light(toner, tile)),
            Channel::Samples => canvas.paint(&film, 1, |tile| screen::samples(tile, wanted)),
            Channel::Noise => canvas.paint(&film, 1, screen::noise),
            _ => {}
        }
        let rgba = canvas.rgba().to_vec();
        let frame = self.frame(size, rgba, samples);
        self.publish(Some(frame));
    }

    /// Makes the picture better until something else is to be done; `false` when it cannot get better now.
    fn refine(&mut self) -> bool {
        let (Some(subject), Some(film)) = (self.subject.clone(), self.film.clone()) else { return false };
        if self.building.is_some() || render::is_finished(&film, Stop::Evenly) {
            self.finish(&subject, &film);
            return false;
        }
        let linger = LINGER.saturating_sub(self.drawn.elapsed());
        if !linger.is_zero() && self.status.stage == Stage::Moving {
            self.shared.rest(Some(linger), |desk| desk.calls());
            if self.shared.desk().calls() {
                return true;
            }
        }
        let control = Arc::new(Control::default());
        {
            let mut desk = self.shared.desk();
            if desk.calls() {
                return true;
            }
            desk.exposed = false;
            desk.rendering = Some(Rendering { control: Arc::clone(&control), until: None });
        }
        (self.status.stage, self.status.coarseness) = (Stage::Refining, 1);
        self.expose(subject.picture(), &film, &control);
        self.shared.desk().rendering = None;
        true
    }

    /// Exposes the film and shows it from time to time.
    fn expose(&mut self, picture: &Picture, film: &Arc<Film>, control: &Arc<Control>) {
        let shared = Arc::clone(&self.shared);
        let pool = Arc::clone(&self.pool);
        let began = Instant::now();
        let mut interval = FIRST_SHOW;
        pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                // Cancelled or not: what is there stays.
                let _ = render::expose(&picture.job(), film, Stop::Evenly, control);
                shared.tell(|desk| desk.exposed = true);
            });
            loop {
                shared.rest(Some(interval), |desk| desk.exposed || desk.calls());
                let desk = shared.desk();
                let (done, called) = (desk.exposed, desk.calls());
                drop(desk);
                if called && !done {
                    control.cancel();
                    shared.rest(None, |desk| desk.exposed);
                    break;
                }
                if done {
                    break;
                }
                self.tell_of(film, control, began);
                interval = (interval * 3 / 2).min(LAST_SHOW);
            }
        });
    }

    fn tell_of(&mut self, film: &Film, control: &Control, began: Instant) {
        let pixels = self.status.size.map(f64::from).iter().product::<f64>();
        self.status.samples = (film.samples() as f64 / pixels.max(1.0)) as f32;
        self.status.noise = screen::noise_of(film);
        self.status.rays_per_second = (control.rays().total() as f64 / began.elapsed().as_secs_f64().max(1e-9)) as f32;
        if matches!(self.channel, Channel::Color | Channel::Samples | Channel::Noise) {
            self.show(self.status.samples);
        } else {
            self.publish(None);
        }
    }

    fn finish(&mut self, subject: &Subject, film: &Film) {
        if self.building.is_some() || self.status.stage == Stage::Finished {
            return;
        }
        let picture = subject.picture();
        let pixels = self.status.size.map(f64::from).iter().product::<f64>();
        self.status.samples = (film.samples() as f64 / pixels.max(1.0)) as f32;
        self.status.noise = screen::noise_of(film);
        self.status.stage = Stage::Finished;
        let whole = film.samples() == picture.total_samples();
        let hash = picture.develop(film, |_| Ok::<(), std::convert::Infallible>(()));
        self.status.hash = hash.ok().filter(|_| whole).map(|summary| summary.hash);
        self.status.coarseness = 1;
        self.show(self.status.samples);
    }

    /// Brings the status up to date with the subject.
    pub fn describe(&mut self) {
        let status = &mut self.status;
        status.threads = self.pool.current_num_threads();
        status.playing = self.playing.is_some();
        status.region = self.region;
        let Some(subject) = &self.subject else { return };
        subject.describe(status);
    }
}

/// Whether nothing that comes before it matters any more.
fn supersedes(edit: &Edit) -> bool {
    matches!(edit, Edit::Scene(_))
}

/// Whether of two edits in a row the first leaves no trace.
fn replaces(next: &Edit, edit: &Edit) -> bool {
    match (next, edit) {
        (Edit::At(_), Edit::At(_)) | (Edit::Reload, Edit::Reload) | (Edit::Scene(_), _) => true,
        (Edit::Set { path: a, .. }, Edit::Set { path: b, .. }) => a == b,
        _ => false,
    }
}

fn scheduler(name: &str) -> Result<Scheduler, String> {
    let known = ["work-stealing", "row-queue", "static-rows"];
    juggler::check_name("scheduler", name, known.into_iter()).map_err(|error| format!("error: {error}"))?;
    Ok(match name {
        "row-queue" => Scheduler::RowQueue,
        "static-rows" => Scheduler::StaticRows,
        _ => Scheduler::WorkStealing,
    })
}
