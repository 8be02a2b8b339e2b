//! Builds of worlds: reading, compiling and building hierarchies, with the errors of a scene.

use crate::choices::Choices;
use crate::edited_scene::EditedScene;
use crate::memory;
use crate::model_status::ModelStatus;
use crate::subject::Subject;
use juggler::camera::AnyCamera;
use juggler::math::Vec3;
use juggler::scene::{Bundle, Loader, Names, Scene, SceneError};
use juggler::{Aov, BuildControl, Error, Picture, Settings, View};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maximum number of pixels of an interactive image, whose film is held in memory.
pub const MAX_PIXELS: u64 = 1 << 25;

/// Maximum number of pixels of the denoised preview: the denoiser needs up to 320 bytes per pixel.
pub const MAX_DENOISED_PIXELS: u64 = 1 << 21;

/// Request to build a world, run by [`BuildRequest::run`].
pub struct BuildRequest {
    pub(crate) source: SceneSource,
    pub(crate) name: String,
    /// Whether missing and broken pictures of models are shown gray.
    pub(crate) lenient: bool,
    /// Values of a newly opened scene that differ from its file.
    pub(crate) given: Arc<[(String, Value)]>,
    pub(crate) choices: Choices,
    /// Models of the scene; `None` if they may have changed.
    pub(crate) models: Option<Arc<[ModelStatus]>>,
    /// Point of interest that was chosen explicitly; kept only together with a moved camera.
    pub(crate) interest: Option<Vec3>,
    /// Scene and picture of the previous subject, whose world is reused where it still holds.
    pub(crate) previous: Option<(Arc<Scene>, Arc<Picture>)>,
    /// Maximum memory in bytes of files in memory and of the scene that they make.
    pub(crate) max_memory: Option<u64>,
}

/// Origin of the scene.
pub(crate) enum SceneSource {
    /// A file or a built-in scene, by its name.
    Name,
    /// Files in memory.
    Files(Bundle),
    /// A program.
    Program(Arc<Scene>),
    /// The scene before, with a change.
    Edited(EditedScene, SceneChange),
}

/// Change of a scene.
pub(crate) enum SceneChange {
    /// No change.
    None,
    /// Another value at a JSON pointer; `null` removes the old one.
    Value {
        /// JSON pointer.
        path: String,
        /// New value.
        value: Value,
    },
    /// Another frame.
    Frame(f64),
    /// Return to the scene as it was opened.
    Reset,
    /// Another version of the file.
    Reload,
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
            source: SceneSource::Name,
            name: name.to_owned(),
            lenient: false,
            given: Arc::default(),
            choices: Choices { settings, size, ..Choices::default() },
            models: None,
            interest: None,
            previous: None,
            max_memory: None,
        }
    }

    /// The same request for a scene of files in memory.
    #[must_use]
    pub fn with_files(self, files: Bundle) -> Self {
        Self { source: SceneSource::Files(files), ..self }
    }

    /// The same request, in which missing and broken pictures of models are shown gray or are errors.
    #[must_use]
    pub fn with_lenient(self, lenient: bool) -> Self {
        Self { lenient, ..self }
    }

    /// The same request with values of the scene that differ from its file; a reset keeps them.
    #[must_use]
    pub fn with_values(self, values: Vec<(String, Value)>) -> Self {
        Self { given: values.into(), ..self }
    }

    /// Request for a scene that a program has built.
    pub fn from_scene(scene: Scene, name: &str, size: Option<[u32; 2]>) -> Self {
        Self { source: SceneSource::Program(Arc::new(scene)), ..Self::open(name, size) }
    }

    /// Reads the scene and builds its world on the threads of the current rayon pool. This call may
    /// take long.
    pub fn run(self) -> Result<Subject, BuildError> {
        self.run_with_control(&BuildControl::default())
    }

    /// [`BuildRequest::run`], which ends early with an error if `control` is cancelled.
    pub fn run_with_control(self, control: &BuildControl) -> Result<Subject, BuildError> {
        let is_in_memory = matches!(self.source, SceneSource::Files(_));
        let mut files = if is_in_memory { Vec::new() } else { vec![PathBuf::from(&self.name)] };
        self.build(control).map_err(|error| {
            if let Error::Scene(SceneError::Problems(problems)) = &error
                && !is_in_memory
            {
                files.extend(problems.sources().names().map(PathBuf::from));
            }
            BuildError { text: error_text(&error), files }
        })
    }

    fn build(mut self, control: &BuildControl) -> Result<Subject, Error> {
        let scene = self.scene(control)?;
        let displayed = Arc::clone(scene.displayed());
        self.fit_settings(&displayed);
        if let (SceneSource::Files(files), Some(most)) = (&self.source, self.max_memory) {
            memory::check(files, &displayed, &self.choices.settings, most)?;
        }
        let mut picture = self.picture(&displayed, control)?;
        let upward = picture.view().camera.up();
        if let Some(camera) = &self.choices.camera {
            picture = picture.with_view(View { camera: camera.clone(), ..picture.view() })?;
        }
        let models = self.models.unwrap_or_else(|| ModelStatus::of_scene(&displayed).into());
        let Self { name, lenient, choices, .. } = self;
        let chosen = self.interest.filter(|_| choices.camera.is_some());
        let (picture, interest, interest_is_chosen) = (Arc::new(picture), chosen.unwrap_or_default(), chosen.is_some());
        let mut subject =
            Subject { name, lenient, scene, models, choices, upward, interest, interest_is_chosen, picture };
        if !interest_is_chosen {
            subject.init_interest();
        }
        Ok(subject)
    }

    /// Reads the scene, or changes the one before.
    fn scene(&mut self, control: &BuildControl) -> Result<EditedScene, Error> {
        let file = match &self.source {
            SceneSource::Name => Arc::new(self.loader().named_with_control(&self.name, control)?),
            SceneSource::Files(files) => Arc::new(self.loader().from_bundle(files.clone(), &self.name)?),
            SceneSource::Program(scene) => Arc::clone(scene),
            SceneSource::Edited(scene, SceneChange::None) => return Ok(scene.clone()),
            SceneSource::Edited(scene, SceneChange::Value { path, value }) => {
                return Ok(scene.with_value(path, value)?);
            }
            SceneSource::Edited(scene, SceneChange::Frame(frame)) => return Ok(scene.at_frame(*frame)?),
            SceneSource::Edited(scene, SceneChange::Reset) => return Ok(scene.reset()?),
            SceneSource::Edited(scene, SceneChange::Reload) => {
                let scene = scene.clone();
                return self.reload(&scene, control);
            }
        };
        Ok(EditedScene::new(file, Arc::clone(&self.given))?)
    }

    /// Limits size and denoising to the memory budget, and stores light groups separately where
    /// there are several, so that they can be relit.
    fn fit_settings(&mut self, scene: &Scene) {
        let size = self.choices.settings.size_of(scene);
        if limited_size(size) != size {
            self.choices.settings.size = Some(limited_size(size));
        }
        if pixel_count(size) > MAX_DENOISED_PIXELS {
            self.choices.settings.denoiser = None;
        }
        let groups = Names::from_scene(&scene.description).light_groups.len();
        self.choices.settings.aovs = if groups > 1 { vec![Aov::LightGroups] } else { Vec::new() };
    }

    fn picture(&self, scene: &Scene, control: &BuildControl) -> Result<Picture, Error> {
        let settings = &self.choices.settings;
        match &self.previous {
            Some((before, picture)) => picture.rebuild_with_control(before, scene, settings, control),
            _ => Picture::new_with_control(scene, settings, control),
        }
    }

    fn loader(&self) -> Loader {
        if self.lenient { juggler::loader().lenient() } else { juggler::loader() }
    }

    /// Reads the file again. Edited values and the camera are kept unless the file has changed
    /// there too.
    fn reload(&mut self, scene: &EditedScene, control: &BuildControl) -> Result<EditedScene, Error> {
        let old = scene.file();
        if old.is_in_memory() {
            return Ok(scene.clone());
        }
        let is_file = Path::new(&self.name).is_file();
        let new = match is_file {
            true => old.reload_with_control(&self.name, control)?,
            false => self.loader().named_with_control(&self.name, control)?,
        };
        let Choices { settings, camera, .. } = &mut self.choices;
        if chosen_camera(settings, old) != chosen_camera(settings, &new) {
            (*camera, settings.camera) = (None, None);
        }
        Ok(scene.with_file(Arc::new(new))?)
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
