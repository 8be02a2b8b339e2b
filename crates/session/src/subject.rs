//! Edited scene with the picture to render. It needs neither threads nor clocks: all long work is
//! in [`BuildRequest::run`], which the owner runs where it likes.

use crate::build::{BuildRequest, MAX_DENOISED_PIXELS, MAX_PIXELS, Task, error_text, pixel_count};
use crate::{Edit, ModelStatus, Setting, Status, pose};
use juggler::camera::AnyCamera;
use juggler::camera::film::Tile;
use juggler::denoise::Denoiser;
use juggler::math::{Rgb, Vec3};
use juggler::mesh::FileContent;
use juggler::scene::description::Animation;
use juggler::scene::document::read_text;
use juggler::scene::kind::name_of;
use juggler::scene::{Scene, camera_json, with_camera};
use juggler::{MAX_GAIN, Picture, Settings, View};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Scene with its edits, camera and picture.
#[derive(Clone)]
pub struct Subject {
    /// Name under which the scene was opened.
    pub name: String,
    /// Scene as its file describes it, at frame 0.
    pub(crate) file: Arc<Scene>,
    /// Scene with the edited values, at the current frame.
    pub(crate) scene: Arc<Scene>,
    /// Edited values by JSON pointer, in the order of the edits.
    pub(crate) values: Vec<(String, Value)>,
    /// Values that a reset keeps.
    pub(crate) given_values: Vec<(String, Value)>,
    /// Whether missing and broken pictures of models are shown gray.
    pub(crate) lenient: bool,
    pub(crate) models: Arc<[ModelStatus]>,
    pub(crate) frame: f64,
    pub(crate) settings: Settings,
    /// Size that a reset restores; `None` restores the scene's.
    pub(crate) size: Option<[u32; 2]>,
    /// Camera that an edit has moved.
    pub(crate) camera: Option<AnyCamera>,
    /// Bookmarked cameras held in memory, by name.
    pub(crate) bookmarks: Vec<(String, AnyCamera)>,
    /// RGB gains of light groups, by name; 1 for all others.
    pub(crate) gains: Vec<(String, Rgb)>,
    pub(crate) upward: Vec3,
    pub(crate) interest: Vec3,
    /// Whether the point of interest was chosen, and so does not follow the image center.
    pub(crate) interest_is_chosen: bool,
    pub(crate) picture: Arc<Picture>,
}

/// Effect of an edit.
pub enum EditEffect {
    /// The picture is unchanged.
    Nothing,
    /// [`Subject::picture`] is already a new one.
    View,
    /// A world must be built first.
    Build(Box<BuildRequest>),
}

fn can_be_denoised(size: [u32; 2]) -> Result<(), String> {
    if pixel_count(size) <= MAX_DENOISED_PIXELS {
        return Ok(());
    }
    let [width, height] = size;
    Err(format!(
        "error: {width} x {height} are more pixels than the limit of {MAX_DENOISED_PIXELS} for the denoised preview"
    ))
}

fn rebuild(build: BuildRequest) -> EditEffect {
    EditEffect::Build(Box::new(build))
}

impl Subject {
    /// Returns the picture to render.
    pub fn picture(&self) -> &Arc<Picture> {
        &self.picture
    }

    /// Returns the scene with the edited values, at the current frame.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Returns the point of interest, in world space.
    pub fn interest(&self) -> Vec3 {
        self.interest
    }

    /// Returns the current frame.
    pub fn frame(&self) -> f64 {
        self.frame
    }

    /// Returns length and frame rate of the animation, if the scene has one.
    pub fn animation(&self) -> Option<Animation> {
        let animation = self.scene.description.animation;
        (animation.frames > 1).then_some(animation)
    }

    /// Returns the diagonal of the box around all bounded objects, in scene units; 1 if there are
    /// none.
    pub fn extent(&self) -> f32 {
        let bounds = self.picture.world().bounds();
        if bounds.is_empty() { 1.0 } else { bounds.extent().length().max(f32::MIN_POSITIVE) }
    }

    /// Returns the names of all cameras, including bookmarks.
    pub fn cameras(&self) -> Vec<String> {
        let description = &self.scene.description;
        let single = description.camera.iter().map(|_| "camera".to_owned());
        let names = single.chain(description.cameras.keys().cloned());
        names.chain(self.bookmarks.iter().map(|(name, _)| name.clone())).collect()
    }

    /// Returns the cameras bookmarked in memory as the member `cameras` of a scene file.
    pub fn bookmarks(&self) -> Value {
        self.bookmarks.iter().map(|(name, camera)| (name.clone(), camera_json(camera))).collect()
    }

    /// Applies an edit, or returns the build it requires. An error leaves the subject unchanged.
    /// Edits that do not concern the picture are ignored.
    pub fn apply(&mut self, edit: &Edit) -> Result<EditEffect, String> {
        match edit {
            Edit::Scene(name) => Ok(rebuild(self.open(name))),
            Edit::Files(scene) => Ok(rebuild(self.open(&scene.name).with_files(scene.files.clone()))),
            Edit::Reload => Ok(rebuild(self.build(Task::Reload(Arc::clone(&self.file))))),
            Edit::Reset => Ok(rebuild(self.reset())),
            Edit::Set { path, value } => {
                let build = self.build(Task::InMemory(Arc::clone(&self.file)));
                Ok(rebuild(build.with_value(path, value)))
            }
            Edit::At(frame) => {
                let frame = self.animation().map_or(0.0, |animation| frame.clamp(0.0, f64::from(animation.frames)));
                if frame == self.frame || !frame.is_finite() {
                    return Ok(EditEffect::Nothing);
                }
                Ok(rebuild(BuildRequest { frame, ..self.build(Task::InMemory(Arc::clone(&self.file))) }))
            }
            Edit::Setting(setting) => self.set(setting),
            Edit::Pivot(pixel) => {
                self.pivot(*pixel);
                Ok(EditEffect::Nothing)
            }
            Edit::Fly(_) | Edit::Orbit(_) | Edit::Zoom(_) | Edit::Focus(_) | Edit::Frame(_) => self.navigate(edit),
            Edit::Camera(name) => self.select_camera(name),
            Edit::Look(camera) => {
                let camera =
                    serde_json::from_value(camera.clone()).map_err(|error| format!("error: camera: {error}"))?;
                self.set_camera(camera, true)
            }
            Edit::Bookmark(_) | Edit::Play(_) | Edit::Show(_) | Edit::Region(_) => Ok(EditEffect::Nothing),
        }
    }

    /// Bookmarks the current camera under a name, in memory.
    pub fn add_bookmark(&mut self, name: &str) {
        self.bookmarks.retain(|(other, _)| other != name);
        self.bookmarks.push((name.to_owned(), self.picture.view().camera));
    }

    /// Returns the text of the scene's file with the current camera added under a name; `None` if
    /// no file holds the scene.
    pub fn with_bookmark(&self, name: &str) -> Option<Result<String, String>> {
        let path = Path::new(&self.name);
        if self.file.is_in_memory() || FileContent::detect(path).is_mesh() || self.file.is_around_model() {
            return None;
        }
        let text = read_text(path).ok()?;
        let edited = with_camera(&text, name, &self.picture.view().camera);
        Some(edited.map_err(|error| format!("error: cannot save the camera in `{}`: {error}", self.name)))
    }

    /// Returns the files of the scene, including its meshes; none if they are in memory.
    pub fn files(&self) -> Vec<PathBuf> {
        if self.file.is_in_memory() { Vec::new() } else { self.file.paths() }
    }

    /// Requests another scene with the same size and denoiser.
    fn open(&self, name: &str) -> BuildRequest {
        let mut build = BuildRequest::open(name, self.settings.size).with_lenient(self.lenient);
        (build.size, build.settings.denoiser) = (self.size, self.settings.denoiser);
        build
    }

    /// Requests the scene as its file describes it, with the same denoiser.
    fn reset(&self) -> BuildRequest {
        let settings = Settings { size: self.size, denoiser: self.settings.denoiser, ..Settings::default() };
        let (values, gains, camera) = (self.given_values.clone(), Vec::new(), None);
        BuildRequest {
            values,
            models: None,
            frame: 0.0,
            settings,
            camera,
            gains,
            ..self.build(Task::InMemory(Arc::clone(&self.file)))
        }
    }

    fn build(&self, task: Task) -> BuildRequest {
        BuildRequest {
            models: matches!(task, Task::InMemory(_)).then(|| Arc::clone(&self.models)),
            task,
            name: self.name.clone(),
            values: self.values.clone(),
            given_values: self.given_values.clone(),
            lenient: self.lenient,
            frame: self.frame,
            settings: self.settings.clone(),
            size: self.size,
            camera: self.camera.clone(),
            bookmarks: self.bookmarks.clone(),
            gains: self.gains.clone(),
            interest: self.interest_is_chosen.then_some(self.interest),
            previous: Some((Arc::clone(&self.scene), Arc::clone(&self.picture))),
        }
    }

    fn set(&mut self, setting: &Setting) -> Result<EditEffect, String> {
        let mut settings = self.settings.clone();
        match setting {
            Setting::Size(size) if pixel_count(*size) > MAX_PIXELS => {
                let [width, height] = size;
                return Err(format!(
                    "error: {width} x {height} are more pixels than the limit of {MAX_PIXELS} for interactive rendering"
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
            Setting::Gain(group, factors) => return self.set_gain(group, *factors),
            Setting::Denoise(on) => return self.denoise(*on),
            Setting::Threads(_) | Setting::Scheduler(_) => return Ok(EditEffect::Nothing),
        }
        if matches!(setting, Setting::Integrator(name) if name != self.picture.integrator().name()) {
            settings.max_depth = None;
        }
        let description = &self.scene.description;
        let (mut render, mut tone) = ((*description.render).clone(), (*description.tone).clone());
        render.integrator.get_or_insert_with(|| self.scene.integrator_choice().integrator);
        settings.apply_to(&mut render, &mut tone).map_err(|error| error_text(&error))?;
        render.camera = self.picture.view().render.camera;
        self.set_view(View { camera: self.picture.view().camera, render, tone })?;
        self.settings = settings;
        Ok(EditEffect::View)
    }

    /// Switches denoising. The film starts over with or without the denoiser's features.
    fn denoise(&self, on: bool) -> Result<EditEffect, String> {
        let denoiser = on.then_some(Denoiser::Own);
        if self.settings.denoiser == denoiser {
            return Ok(EditEffect::Nothing);
        }
        if on {
            can_be_denoised(self.picture.size())?;
        }
        let settings = Settings { denoiser, ..self.settings.clone() };
        Ok(rebuild(BuildRequest { settings, ..self.build(Task::InMemory(Arc::clone(&self.file))) }))
    }

    fn set_gain(&mut self, group: &str, factors: [f32; 3]) -> Result<EditEffect, String> {
        let known = self.picture.aovs().light_groups();
        juggler::check_name("light group", group, known.iter().map(String::as_str)).map_err(|e| error_text(&e))?;
        if !factors.iter().all(|factor| (0.0..=MAX_GAIN).contains(factor)) {
            return Err(format!("error: factors of light groups are 0 to {MAX_GAIN}"));
        }
        self.gains.retain(|(other, _)| other != group);
        self.gains.push((group.to_owned(), Rgb::from(factors)));
        Ok(EditEffect::View)
    }

    fn gain(&self, group: &str) -> Rgb {
        self.gains.iter().find(|(name, _)| name == group).map_or(Rgb::WHITE, |(_, gain)| *gain)
    }

    /// Returns the gains of the picture's light groups, by index; empty if all are 1.
    pub fn gains(&self) -> Vec<Rgb> {
        let groups = self.picture.aovs().light_groups();
        let gains: Vec<Rgb> = groups.iter().map(|group| self.gain(group)).collect();
        if gains.iter().all(|gain| *gain == Rgb::WHITE) { Vec::new() } else { gains }
    }

    /// Returns the mean radiance of a tile's pixels with the light groups scaled by `gains`, see
    /// [`Self::gains`].
    pub fn light(&self, tile: &Tile, gains: &[Rgb]) -> Vec<Rgb> {
        if gains.is_empty() { tile.means() } else { self.picture.aovs().relight(tile, gains) }
    }

    /// Returns whether denoising is on and possible: relit light groups cannot be denoised.
    #[cfg(feature = "native")]
    pub(crate) fn is_denoised(&self) -> bool {
        self.picture.aovs().denoiser().is_some() && self.gains().is_empty()
    }

    fn set_view(&mut self, view: View) -> Result<(), String> {
        self.picture = Arc::new(self.picture.with_view(view).map_err(|error| error_text(&error))?);
        Ok(())
    }

    /// Switches to another camera; `fresh` if it is unrelated to the previous one.
    fn set_camera(&mut self, camera: AnyCamera, fresh: bool) -> Result<EditEffect, String> {
        let upward = camera.up();
        self.set_view(View { camera: camera.clone(), ..self.picture.view() })?;
        self.camera = Some(camera);
        if fresh {
            self.upward = upward;
            self.init_interest();
        } else if !self.interest_is_chosen {
            self.center_interest();
        }
        Ok(EditEffect::View)
    }

    fn select_camera(&mut self, name: &str) -> Result<EditEffect, String> {
        if let Some((_, camera)) = self.bookmarks.iter().find(|(other, _)| other == name) {
            return self.set_camera(camera.clone(), true);
        }
        let settings = Settings { camera: Some(name.to_owned()), ..self.settings.clone() };
        let description = &self.scene.description;
        let known = self.cameras();
        juggler::check_name("camera", name, known.iter().map(String::as_str)).map_err(|error| error_text(&error))?;
        let camera = description.cameras.get(name).or(description.camera.as_ref()).cloned();
        if let Some(camera) = camera {
            self.set_camera(camera.into_inner(), true)?;
            (self.settings, self.camera) = (settings, None);
        }
        Ok(EditEffect::View)
    }

    fn navigate(&mut self, edit: &Edit) -> Result<EditEffect, String> {
        let camera = self.picture.view().camera;
        let upward = self.upward;
        let moved = match edit {
            Edit::Fly(fly) => pose::fly(&camera, upward, fly),
            Edit::Orbit(orbit) => {
                self.interest_is_chosen = true;
                pose::orbit(&camera, upward, self.interest, orbit)
            }
            Edit::Zoom(factor) => pose::zoom(&camera, *factor),
            Edit::Focus(pixel) => {
                let Some((point, _)) = self.pick(*pixel) else { return Ok(EditEffect::Nothing) };
                (self.interest, self.interest_is_chosen) = (point, true);
                pose::focus(&camera, point)
            }
            Edit::Frame(pixel) => {
                let bounds = self.framing_bounds(*pixel);
                (self.interest, self.interest_is_chosen) = (bounds.center(), true);
                pose::frame(&camera, upward, &bounds, self.picture.size())
            }
            _ => None,
        };
        let Some(moved) = moved.filter(|moved| *moved != camera) else { return Ok(EditEffect::Nothing) };
        let change = self.set_camera(moved, false)?;
        if matches!(edit, Edit::Fly(_)) {
            self.drop_hidden_interest();
        }
        Ok(change)
    }

    /// Writes the subject's part of the status.
    pub fn write_status(&self, status: &mut Status) {
        let View { camera, render, tone } = self.picture.view();
        self.name.clone_into(&mut status.scene);
        status.size = render.size;
        status.samples_wanted = render.samples;
        status.integrator = self.picture.integrator().name().to_owned();
        let max_depth = self.picture.max_depth();
        status.depth_range = max_depth.as_ref().map_or([0; 2], |(_, range)| [*range.start(), *range.end()]);
        status.max_depth = max_depth.map(|(depth, _)| depth);
        status.denoise = self.settings.denoiser.is_some();
        status.sampler = name_of(&render.sampler);
        status.tone = name_of(&tone.curve);
        status.exposure = tone.exposure_stops;
        let groups = self.picture.aovs().light_groups();
        status.light_groups = groups.iter().map(|name| (name.clone(), self.gain(name).to_array())).collect();
        status.models = self.models.to_vec();
        status.cameras = self.cameras();
        status.camera = camera_json(&camera);
        status.interest = self.interest.to_array();
        status.extent = self.extent();
        status.flight_speed = self.flight_speed();
        status.frame = self.frame;
        let animation = self.animation();
        status.frames = animation.map_or(0, |animation| animation.frames);
        status.frame_rate = animation.map_or(0.0, |animation| animation.frames_per_second);
    }
}
