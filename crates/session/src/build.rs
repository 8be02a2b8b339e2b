//! Builds of worlds: reading, compiling and building hierarchies, with the errors of a scene.

use crate::ModelStatus;
use crate::subject::Subject;
use juggler::camera::AnyCamera;
use juggler::math::{Rgb, Vec3};
use juggler::scene::{Bundle, Loader, Names, Scene, SceneError};
use juggler::{Aov, Error, Picture, Settings, View};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maximum number of pixels of an interactive image, whose film is held in memory.
pub const MAX_PIXELS: u64 = 1 << 25;

/// Maximum number of pixels of the denoised preview: the denoiser needs up to 320 bytes per pixel.
pub const MAX_DENOISED_PIXELS: u64 = 1 << 21;

/// JSON pointer of the clip of the model in a scene around a model file.
const SHOWN_CLIP: &str = "/objects/0/model/animation";

/// Request to build a world, run by [`BuildRequest::run`].
pub struct BuildRequest {
    pub(crate) task: Task,
    pub(crate) name: String,
    pub(crate) values: Vec<(String, Value)>,
    /// Values that a reset keeps.
    pub(crate) given_values: Vec<(String, Value)>,
    /// Models of the scene; `None` if they may have changed.
    pub(crate) models: Option<Arc<[ModelStatus]>>,
    /// Whether missing and broken pictures of models are shown gray.
    pub(crate) lenient: bool,
    pub(crate) frame: f64,
    pub(crate) settings: Settings,
    pub(crate) size: Option<[u32; 2]>,
    /// Camera that an edit has moved; `None` for the scene's own.
    pub(crate) camera: Option<AnyCamera>,
    /// Bookmarked cameras held in memory, by name.
    pub(crate) bookmarks: Vec<(String, AnyCamera)>,
    /// RGB gain of each light group, by name.
    pub(crate) gains: Vec<(String, Rgb)>,
    /// Point of interest that was chosen explicitly; kept only together with `camera`.
    pub(crate) interest: Option<Vec3>,
    /// Scene and picture of the previous subject, whose world is reused where it still holds.
    pub(crate) previous: Option<(Arc<Scene>, Arc<Picture>)>,
}

#[derive(Clone)]
pub(crate) enum Task {
    /// Open another scene by its name.
    Open,
    /// Open another scene of files in memory.
    OpenFiles(Bundle),
    /// Read the same file again; the given scene holds meshes that need not be read again.
    Reload(Arc<Scene>),
    /// Use a scene in memory.
    InMemory(Arc<Scene>),
}

/// Error that prevented a build.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildError {
    /// Message as `juggler check` prints it, without colors.
    pub text: String,
    /// Files that were read before the error, as far as they are known.
    pub files: Vec<PathBuf>,
}

impl BuildRequest {
    /// Request for a scene file, or for a built-in scene by name.
    pub fn open(name: &str, size: Option<[u32; 2]>) -> Self {
        let settings = Settings { size, ..Settings::default() };
        Self {
            task: Task::Open,
            name: name.to_owned(),
            values: Vec::new(),
            given_values: Vec::new(),
            models: None,
            lenient: false,
            frame: 0.0,
            settings,
            size,
            camera: None,
            bookmarks: Vec::new(),
            gains: Vec::new(),
            interest: None,
            previous: None,
        }
    }

    /// The same request for a scene of files in memory.
    #[must_use]
    pub fn with_files(self, files: Bundle) -> Self {
        Self { task: Task::OpenFiles(files), ..self }
    }

    /// The same request, in which missing and broken pictures of models are shown gray or are errors.
    #[must_use]
    pub fn with_lenient(self, lenient: bool) -> Self {
        Self { lenient, ..self }
    }

    /// The same request with values of the scene that differ from its file; a reset keeps them.
    #[must_use]
    pub fn with_values(self, values: Vec<(String, Value)>) -> Self {
        Self { values: values.clone(), given_values: values, ..self }
    }

    /// Request for a scene that a program has built.
    pub fn from_scene(scene: Scene, name: &str, size: Option<[u32; 2]>) -> Self {
        Self { task: Task::InMemory(Arc::new(scene)), ..Self::open(name, size) }
    }

    /// The same request with another value of the scene. Another clip starts at its beginning.
    pub(crate) fn with_value(mut self, path: &str, value: &Value) -> Self {
        self.values.retain(|(other, _)| other != path);
        self.values.push((path.to_owned(), value.clone()));
        let frame = if path == SHOWN_CLIP { 0.0 } else { self.frame };
        Self { models: None, frame, ..self }
    }

    /// Reads the scene and builds its world on the threads of the current rayon pool. This call may
    /// take long.
    pub fn run(self) -> Result<Subject, BuildError> {
        let is_in_memory = matches!(self.task, Task::OpenFiles(_));
        let mut files = if is_in_memory { Vec::new() } else { vec![PathBuf::from(&self.name)] };
        self.build().map_err(|error| {
            if let Error::Scene(SceneError::Problems(problems)) = &error
                && !is_in_memory
            {
                files.extend(problems.sources().names().map(PathBuf::from));
            }
            BuildError { text: error_text(&error), files }
        })
    }

    fn build(mut self) -> Result<Subject, Error> {
        let file = match self.task.clone() {
            Task::Open => Arc::new(self.loader().named(&self.name)?),
            Task::OpenFiles(files) => Arc::new(self.loader().from_bundle(files, &self.name)?),
            Task::Reload(scene) => self.reload(&scene)?,
            Task::InMemory(scene) => scene,
        };
        let scene = self.scene(&file)?;
        self.fit_settings(&scene);
        let mut picture = self.picture(&scene)?;
        let upward = picture.view().camera.up();
        if let Some(camera) = &self.camera {
            picture = picture.with_view(View { camera: camera.clone(), ..picture.view() })?;
        }
        let models = self.models.unwrap_or_else(|| ModelStatus::of_scene(&scene).into());
        let Self { name, values, given_values, lenient, frame, settings, size, camera, bookmarks, gains, .. } = self;
        let chosen = self.interest.filter(|_| camera.is_some());
        let (picture, interest, interest_is_chosen) = (Arc::new(picture), chosen.unwrap_or_default(), chosen.is_some());
        let mut subject = Subject {
            name,
            file,
            scene,
            values,
            given_values,
            lenient,
            models,
            frame,
            settings,
            size,
            camera,
            bookmarks,
            gains,
            upward,
            interest,
            interest_is_chosen,
            picture,
        };
        if !interest_is_chosen {
            subject.init_interest();
        }
        Ok(subject)
    }

    /// Limits size and denoising to the memory budget, and stores light groups separately where
    /// there are several, so that they can be relit.
    fn fit_settings(&mut self, scene: &Scene) {
        let size = self.settings.size_of(scene);
        if limited_size(size) != size {
            self.settings.size = Some(limited_size(size));
        }
        if pixel_count(size) > MAX_DENOISED_PIXELS {
            self.settings.denoiser = None;
        }
        let groups = Names::from_scene(&scene.description).light_groups.len();
        self.settings.aovs = if groups > 1 { vec![Aov::LightGroups] } else { Vec::new() };
    }

    /// Returns the file's scene with the edited values, at the current frame.
    fn scene(&self, file: &Arc<Scene>) -> Result<Arc<Scene>, SceneError> {
        let mut scene = Arc::clone(file);
        for (path, value) in &self.values {
            scene = Arc::new(scene.with_value(path, value.clone())?);
        }
        if scene.is_around_model() && self.values.iter().any(|(path, _)| path == SHOWN_CLIP) {
            Arc::make_mut(&mut scene).fit_animation();
        }
        if self.frame != 0.0 {
            scene = Arc::new(scene.at_frame(self.frame)?);
        }
        Ok(scene)
    }

    fn picture(&self, scene: &Scene) -> Result<Picture, Error> {
        match &self.previous {
            Some((before, picture)) => picture.rebuild(before, scene, &self.settings),
            _ => Picture::new(scene, &self.settings),
        }
    }

    fn loader(&self) -> Loader {
        if self.lenient { juggler::loader().lenient() } else { juggler::loader() }
    }

    /// Reads the file again. Edited values and the camera are kept unless the file has changed
    /// there too.
    fn reload(&mut self, old: &Arc<Scene>) -> Result<Arc<Scene>, Error> {
        if old.is_in_memory() {
            return Ok(Arc::clone(old));
        }
        let is_file = Path::new(&self.name).is_file();
        let new = Arc::new(if is_file { old.reload(&self.name)? } else { self.loader().named(&self.name)? });
        if !self.values.is_empty() {
            let [before, after] = [old, &new].map(|scene| scene.to_value());
            self.values.retain(|(path, _)| before.pointer(path) == after.pointer(path));
        }
        let chosen = |settings: &Settings, scene: &Scene| chosen_camera(settings, scene).cloned();
        if chosen(&self.settings, old) != chosen(&self.settings, &new) {
            (self.camera, self.settings.camera) = (None, None);
        }
        Ok(new)
    }
}

/// Returns the initial camera: the one that settings or scene name, otherwise the first.
fn chosen_camera<'s>(settings: &Settings, scene: &'s Scene) -> Option<&'s AnyCamera> {
    let description = &scene.description;
    let named = settings.camera.as_ref().or(description.render.camera.as_ref().map(|name| &name.0));
    let several = &description.cameras;
    let named = named.map(|name| several.get(name).or(description.camera.as_ref().filter(|_| name == "camera")));
    named.unwrap_or_else(|| description.camera.as_ref().or_else(|| several.values().next())).map(|camera| &**camera)
}

/// Returns width times height.
pub fn pixel_count([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

/// Returns the largest size of the same aspect ratio that has at most [`MAX_PIXELS`] pixels.
fn limited_size([width, height]: [u32; 2]) -> [u32; 2] {
    let pixels = pixel_count([width, height]);
    let scale = (MAX_PIXELS as f64 / pixels.max(1) as f64).sqrt();
    if pixels <= MAX_PIXELS {
        [width, height]
    } else {
        [width, height].map(|edge| ((f64::from(edge) * scale) as u32).max(1))
    }
}

/// Formats an error as `juggler check` prints it, without colors.
pub fn error_text(error: &Error) -> String {
    match error {
        Error::Scene(SceneError::Problems(problems)) => problems.render(false),
        error => format!("error: {error}"),
    }
}
