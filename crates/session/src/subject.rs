//! What is looked at: a scene, what people changed of it, and the picture that follows. No threads, no clocks: all that
//! takes long is in [`Build::run`], which whoever holds the subject runs where it likes.

use crate::build::{Build, MOST_DENOISED, MOST_PIXELS, Task, pixels_of, text_of};
use crate::{Edit, Setting, Status, pose};
use juggler::camera::AnyCamera;
use juggler::camera::film::Tile;
use juggler::denoise::Denoiser;
use juggler::integrator::AnyIntegrator;
use juggler::math::{Rgb, Vec3};
use juggler::scene::description::Animation;
use juggler::scene::document::read_text;
use juggler::scene::import::Content;
use juggler::scene::kind::name_of;
use juggler::scene::{Scene, camera_json, with_camera};
use juggler::{MOST_GAIN, Picture, Settings, View};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is looked at.
#[derive(Clone)]
pub struct Subject {
    /// The name that it was opened by.
    pub name: String,
    /// As its file has it, at frame 0.
    pub(crate) file: Arc<Scene>,
    /// With the values that were set, at the frame.
    pub(crate) scene: Arc<Scene>,
    /// Values that were set, by place, in their order.
    pub(crate) values: Vec<(String, Value)>,
    pub(crate) frame: f64,
    pub(crate) settings: Settings,
    /// The size that a reset leads back to; the scene's without.
    pub(crate) size: Option<[u32; 2]>,
    /// The camera where people moved it.
    pub(crate) camera: Option<AnyCamera>,
    /// Cameras that were kept in memory, by name.
    pub(crate) kept: Vec<(String, AnyCamera)>,
    /// Factors on groups of lights, by name; 1 for all others.
    pub(crate) gains: Vec<(String, Rgb)>,
    pub(crate) upward: Vec3,
    pub(crate) interest: Vec3,
    /// Whether the point of interest was chosen, and does not follow the picture's middle.
    pub(crate) held: bool,
    pub(crate) picture: Arc<Picture>,
}

/// What an edit asks for.
pub enum Change {
    /// Nothing of the picture.
    Nothing,
    /// The picture is another one already: [`Subject::picture`].
    View,
    /// A world must be built first.
    Build(Box<Build>),
}

fn can_be_denoised(size: [u32; 2]) -> Result<(), String> {
    if pixels_of(size) <= MOST_DENOISED {
        return Ok(());
    }
    let [width, height] = size;
    Err(format!("error: {width} x {height} are more pixels than the limit of {MOST_DENOISED} for the denoised preview"))
}

fn rebuild(build: Build) -> Change {
    Change::Build(Box::new(build))
}

impl Subject {
    /// The picture to make.
    pub fn picture(&self) -> &Arc<Picture> {
        &self.picture
    }

    /// The scene at the frame, with the values that were set.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The point of interest.
    pub fn interest(&self) -> Vec3 {
        self.interest
    }

    /// The frame.
    pub fn frame(&self) -> f64 {
        self.frame
    }

    /// Length and pace of the animation, when there is one.
    pub fn animation(&self) -> Option<Animation> {
        let animation = self.file.description.animation;
        (animation.frames > 1).then_some(animation)
    }

    /// The diagonal of a box around everything that has an end, 1 when nothing has.
    pub fn extent(&self) -> f32 {
        let bounds = self.picture.world().bounds();
        if bounds.is_empty() { 1.0 } else { bounds.extent().length().max(f32::MIN_POSITIVE) }
    }

    /// Names of the cameras.
    pub fn cameras(&self) -> Vec<String> {
        let description = &self.scene.description;
        let single = description.camera.iter().map(|_| "camera".to_owned());
        let names = single.chain(description.cameras.keys().cloned());
        names.chain(self.kept.iter().map(|(name, _)| name.clone())).collect()
    }

    /// Cameras that were kept in memory, as the member `cameras` of a scene file.
    pub fn kept(&self) -> Value {
        self.kept.iter().map(|(name, camera)| (name.clone(), camera_json(camera))).collect()
    }

    /// Changes what can be changed at once, and says what else is to be done. After an error nothing has changed. Edits
    /// that are not about the picture are ignored.
    pub fn apply(&mut self, edit: &Edit) -> Result<Change, String> {
        match edit {
            Edit::Scene(name) => Ok(rebuild(self.open(name))),
            Edit::Reload => Ok(rebuild(self.build(Task::Reload(Arc::clone(&self.file))))),
            Edit::Reset => Ok(rebuild(self.reset())),
            Edit::Set { path, value } => {
                let mut build = self.build(Task::Have(Arc::clone(&self.file)));
                build.values.retain(|(other, _)| other != path);
                build.values.push((path.clone(), value.clone()));
                Ok(rebuild(build))
            }
            Edit::At(frame) => {
                let frame = self.animation().map_or(0.0, |animation| frame.clamp(0.0, f64::from(animation.frames)));
                if frame == self.frame || !frame.is_finite() {
                    return Ok(Change::Nothing);
                }
                Ok(rebuild(Build { frame, ..self.build(Task::Have(Arc::clone(&self.file))) }))
            }
            Edit::Setting(setting) => self.set(setting),
            Edit::Pivot(pixel) => {
                self.pivot(*pixel);
                Ok(Change::Nothing)
            }
            Edit::Fly(_) | Edit::Orbit(_) | Edit::Zoom(_) | Edit::Focus(_) | Edit::Frame(_) => self.steer(edit),
            Edit::Camera(name) => self.choose(name),
            Edit::Look(camera) => {
                let camera =
                    serde_json::from_value(camera.clone()).map_err(|error| format!("error: camera: {error}"))?;
                self.look(camera, true)
            }
            Edit::Bookmark(_) | Edit::Play(_) | Edit::Show(_) | Edit::Region(_) => Ok(Change::Nothing),
        }
    }

    /// Keeps the camera under a name, in memory.
    pub fn keep(&mut self, name: &str) {
        self.kept.retain(|(other, _)| other != name);
        self.kept.push((name.to_owned(), self.picture.view().camera));
    }

    /// The text of the scene's file with the camera kept in it, when there is a file that holds a scene.
    pub fn with_bookmark(&self, name: &str) -> Option<Result<String, String>> {
        let path = Path::new(&self.name);
        if Content::of_file(path).is_mesh() {
            return None;
        }
        let text = read_text(path).ok()?;
        let kept = with_camera(&text, name, &self.picture.view().camera);
        Some(kept.map_err(|error| format!("error: the camera cannot be kept in `{}`: {error}", self.name)))
    }

    /// The files that the scene was read from, and those of its meshes.
    pub fn files(&self) -> Vec<PathBuf> {
        self.file.paths()
    }

    /// Another scene, looked at in the same way.
    fn open(&self, name: &str) -> Build {
        let mut build = Build { size: self.size, ..Build::open(name, self.settings.size) };
        build.settings.denoiser = self.settings.denoiser;
        build
    }

    /// The scene as its file has it, looked at in the same way.
    fn reset(&self) -> Build {
        let settings = Settings { size: self.size, denoiser: self.settings.denoiser, ..Settings::default() };
        let (values, gains, camera) = (Vec::new(), Vec::new(), None);
        Build { values, frame: 0.0, settings, camera, gains, ..self.build(Task::Have(Arc::clone(&self.file))) }
    }

    fn build(&self, task: Task) -> Build {
        Build {
            task,
            name: self.name.clone(),
            values: self.values.clone(),
            frame: self.frame,
            settings: self.settings.clone(),
            size: self.size,
            camera: self.camera.clone(),
            kept: self.kept.clone(),
            gains: self.gains.clone(),
            interest: self.held.then_some(self.interest),
            before: Some((Arc::clone(&self.scene), Arc::clone(&self.picture))),
        }
    }

    fn set(&mut self, setting: &Setting) -> Result<Change, String> {
        let mut settings = self.settings.clone();
        match setting {
            Setting::Size(size) if pixels_of(*size) > MOST_PIXELS => {
                let [width, height] = size;
                return Err(format!(
                    "error: {width} x {height} are more pixels than the limit of {MOST_PIXELS} for looking"
                ));
            }
            Setting::Size(size) if self.settings.denoiser.is_some() => {
                can_be_denoised(*size)?;
                settings.size = Some(*size);
            }
            Setting::Size(size) => settings.size = Some(*size),
            Setting::Samples(samples) => settings.samples = Some(*samples),
            Setting::Integrator(name) => settings.integrator = Some(name.clone()),
            Setting::Sampler(name) => settings.sampler = Some(name.clone()),
            Setting::MaxDepth(depth) => settings.max_depth = Some(*depth),
            Setting::Tone(name) => settings.curve = Some(name.clone()),
            Setting::Exposure(stops) => settings.exposure_stops = Some(*stops),
            Setting::Seed(seed) => settings.seed = Some(*seed),
            Setting::Gain(group, factors) => return self.relight(group, *factors),
            Setting::Denoise(on) => return self.denoise(*on),
            Setting::Threads(_) | Setting::Scheduler(_) => return Ok(Change::Nothing),
        }
        if matches!(setting, Setting::Integrator(name) if name != "classic") {
            settings.max_depth = None;
        }
        let description = &self.scene.description;
        let (mut render, mut tone) = ((*description.render).clone(), (*description.tone).clone());
        render.integrator.get_or_insert_with(|| self.scene.integrator_choice().integrator);
        settings.apply_to(&mut render, &mut tone).map_err(|error| text_of(&error))?;
        render.camera = self.picture.view().render.camera;
        self.see(View { camera: self.picture.view().camera, render, tone })?;
        self.settings = settings;
        Ok(Change::View)
    }

    /// The film keeps what guides the denoiser, or keeps it no more: it begins anew.
    fn denoise(&self, on: bool) -> Result<Change, String> {
        let denoiser = on.then_some(Denoiser::Own);
        if self.settings.denoiser == denoiser {
            return Ok(Change::Nothing);
        }
        if on {
            can_be_denoised(self.picture.size())?;
        }
        let settings = Settings { denoiser, ..self.settings.clone() };
        Ok(rebuild(Build { settings, ..self.build(Task::Have(Arc::clone(&self.file))) }))
    }

    fn relight(&mut self, group: &str, factors: [f32; 3]) -> Result<Change, String> {
        let known = self.picture.layers().light_groups();
        juggler::check_name("group of lights", group, known.iter().map(String::as_str)).map_err(|e| text_of(&e))?;
        if !factors.iter().all(|factor| (0.0..=MOST_GAIN).contains(factor)) {
            return Err(format!("error: factors on light are 0 to {MOST_GAIN}"));
        }
        self.gains.retain(|(other, _)| other != group);
        self.gains.push((group.to_owned(), Rgb::from(factors)));
        Ok(Change::View)
    }

    fn gain(&self, group: &str) -> Rgb {
        self.gains.iter().find(|(name, _)| name == group).map_or(Rgb::WHITE, |(_, gain)| *gain)
    }

    /// The factor on each of the picture's groups of lights, by number; nothing where all are 1.
    pub fn gains(&self) -> Vec<Rgb> {
        let groups = self.picture.layers().light_groups();
        let gains: Vec<Rgb> = groups.iter().map(|group| self.gain(group)).collect();
        if gains.iter().all(|gain| *gain == Rgb::WHITE) { Vec::new() } else { gains }
    }

    /// The light of a tile of the picture's film, groups of lights mixed by [`Self::gains`].
    pub fn light(&self, tile: &Tile, gains: &[Rgb]) -> Vec<Rgb> {
        if gains.is_empty() { tile.means() } else { self.picture.layers().relit(tile, gains) }
    }

    /// Whether the picture is to be shown denoised, and can be: with all lights as they are.
    #[cfg(feature = "native")]
    pub(crate) fn is_denoised(&self) -> bool {
        self.picture.layers().denoiser().is_some() && self.gains().is_empty()
    }

    fn see(&mut self, view: View) -> Result<(), String> {
        self.picture = Arc::new(self.picture.seen(view).map_err(|error| text_of(&error))?);
        Ok(())
    }

    /// Another camera; `fresh` when it has nothing to do with the one before.
    fn look(&mut self, camera: AnyCamera, fresh: bool) -> Result<Change, String> {
        let upward = camera.upward();
        self.see(View { camera: camera.clone(), ..self.picture.view() })?;
        self.camera = Some(camera);
        if fresh {
            self.upward = upward;
            self.begin_interest();
        } else if !self.held {
            self.look_for_interest();
        }
        Ok(Change::View)
    }

    fn choose(&mut self, name: &str) -> Result<Change, String> {
        if let Some((_, camera)) = self.kept.iter().find(|(kept, _)| kept == name) {
            return self.look(camera.clone(), true);
        }
        let settings = Settings { camera: Some(name.to_owned()), ..self.settings.clone() };
        let description = &self.scene.description;
        let known = self.cameras();
        juggler::check_name("camera", name, known.iter().map(String::as_str)).map_err(|error| text_of(&error))?;
        let camera = description.cameras.get(name).or(description.camera.as_ref()).cloned();
        if let Some(camera) = camera {
            self.look(camera.into_inner(), true)?;
            (self.settings, self.camera) = (settings, None);
        }
        Ok(Change::View)
    }

    fn steer(&mut self, edit: &Edit) -> Result<Change, String> {
        let camera = self.picture.view().camera;
        let upward = self.upward;
        let moved = match edit {
            Edit::Fly(fly) => pose::fly(&camera, upward, fly),
            Edit::Orbit(orbit) => {
                self.held = true;
                pose::orbit(&camera, upward, self.interest, orbit)
            }
            Edit::Zoom(factor) => pose::zoom(&camera, *factor),
            Edit::Focus(pixel) => {
                let Some((point, _)) = self.seen_at(*pixel) else { return Ok(Change::Nothing) };
                (self.interest, self.held) = (point, true);
                pose::focus(&camera, point)
            }
            Edit::Frame(pixel) => {
                let bounds = self.to_frame(*pixel);
                (self.interest, self.held) = (bounds.center(), true);
                pose::frame(&camera, upward, &bounds, self.picture.size())
            }
            _ => None,
        };
        let Some(moved) = moved.filter(|moved| *moved != camera) else { return Ok(Change::Nothing) };
        let change = self.look(moved, false)?;
        if matches!(edit, Edit::Fly(_)) {
            self.lose_interest();
        }
        Ok(change)
    }

    /// Writes down how things stand.
    pub fn describe(&self, status: &mut Status) {
        let View { camera, render, tone } = self.picture.view();
        self.name.clone_into(&mut status.scene);
        status.size = render.size;
        status.samples_wanted = render.samples;
        status.integrator = self.picture.integrator().name().to_owned();
        status.max_depth = match self.picture.integrator() {
            AnyIntegrator::Classic(classic) => Some(classic.max_depth),
            _ => None,
        };
        status.denoise = self.settings.denoiser.is_some();
        status.sampler = name_of(&render.sampler);
        status.tone = name_of(&tone.curve);
        status.exposure = tone.exposure_stops;
        let groups = self.picture.layers().light_groups();
        status.light_groups = groups.iter().map(|name| (name.clone(), self.gain(name).to_array())).collect();
        status.cameras = self.cameras();
        status.camera = camera_json(&camera);
        status.interest = self.interest.to_array();
        status.extent = self.extent();
        status.frame = self.frame;
        let animation = self.animation();
        status.frames = animation.map_or(0, |animation| animation.frames);
        status.frame_rate = animation.map_or(0.0, |animation| animation.frames_per_second);
    }
}
