//! Worlds to be built: all that takes long, and what is wrong with a scene.

use crate::subject::Subject;
use juggler::camera::AnyCamera;
use juggler::math::{Rgb, Vec3};
use juggler::scene::{Names, Scene, SceneError};
use juggler::{Aov, Error, Picture, Settings, View};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most pixels of a picture that is looked at: their samples are all held in memory.
pub const MOST_PIXELS: u64 = 1 << 25;

/// Most pixels of a picture that is shown denoised: the filter needs up to 320 bytes for each.
pub const MOST_DENOISED: u64 = 1 << 21;

/// A world to be built.
pub struct Build {
    pub(crate) task: Task,
    pub(crate) name: String,
    pub(crate) values: Vec<(String, Value)>,
    pub(crate) frame: f64,
    pub(crate) settings: Settings,
    pub(crate) size: Option<[u32; 2]>,
    /// The camera where people moved it.
    pub(crate) camera: Option<AnyCamera>,
    /// Cameras that were kept in memory.
    pub(crate) kept: Vec<(String, AnyCamera)>,
    /// Factors on groups of lights, by name.
    pub(crate) gains: Vec<(String, Rgb)>,
    /// The point of interest that was chosen; it stays with the camera.
    pub(crate) interest: Option<Vec3>,
    /// The subject as it was, whose world may be that of the new one.
    pub(crate) before: Option<(Arc<Scene>, Arc<Picture>)>,
}

#[derive(Clone)]
pub(crate) enum Task {
    /// Another scene, by its name.
    Open,
    /// The same file again; the scene holds meshes that need not be read again.
    Reload(Arc<Scene>),
    /// A scene that is here.
    Have(Arc<Scene>),
}

/// Why there is no world.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    /// As `juggler check` says it, without colours.
    pub text: String,
    /// The files that were read before it was found, as far as they are known.
    pub files: Vec<PathBuf>,
}

impl Build {
    /// A scene file, or a built-in scene by name.
    pub fn open(name: &str, size: Option<[u32; 2]>) -> Self {
        let settings = Settings { size, ..Settings::default() };
        let (values, kept, gains) = (Vec::new(), Vec::new(), Vec::new());
        let (task, name) = (Task::Open, name.to_owned());
        let (camera, interest, before) = (None, None, None);
        Self { task, name, values, frame: 0.0, settings, size, camera, kept, gains, interest, before }
    }

    /// A scene that a program made.
    pub fn of(scene: Scene, name: &str, size: Option<[u32; 2]>) -> Self {
        Self { task: Task::Have(Arc::new(scene)), ..Self::open(name, size) }
    }

    /// Reads and builds: takes its time, on the threads of the current rayon pool.
    pub fn run(self) -> Result<Subject, Mistake> {
        let name = PathBuf::from(&self.name);
        self.build().map_err(|error| {
            let mut files = vec![name];
            if let Error::Scene(SceneError::Problems(problems)) = &error {
                files.extend(problems.sources().names().map(PathBuf::from));
            }
            Mistake { text: text_of(&error), files }
        })
    }

    fn build(mut self) -> Result<Subject, Error> {
        let file = match self.task.clone() {
            Task::Open => Arc::new(Scene::named(&self.name)?),
            Task::Reload(scene) => self.reload(&scene)?,
            Task::Have(scene) => scene,
        };
        let scene = self.scene(&file)?;
        self.fit_settings(&scene);
        let mut picture = self.picture(&scene)?;
        let upward = picture.view().camera.upward();
        if let Some(camera) = &self.camera {
            picture = picture.seen(View { camera: camera.clone(), ..picture.view() })?;
        }
        let Self { name, values, frame, settings, size, camera, kept, gains, .. } = self;
        let chosen = self.interest.filter(|_| camera.is_some());
        let (picture, interest, held) = (Arc::new(picture), chosen.unwrap_or_default(), chosen.is_some());
        let mut subject = Subject {
            name,
            file,
            scene,
            values,
            frame,
            settings,
            size,
            camera,
            kept,
            gains,
            upward,
            interest,
            held,
            picture,
        };
        if !held {
            subject.begin_interest();
        }
        Ok(subject)
    }

    /// Keeps size and denoising within what memory bears, and the light of groups apart, so that it can be mixed.
    fn fit_settings(&mut self, scene: &Scene) {
        let size = self.settings.size_of(scene);
        if bearable(size) != size {
            self.settings.size = Some(bearable(size));
        }
        if pixels_of(size) > MOST_DENOISED {
            self.settings.denoiser = None;
        }
        let groups = Names::of(&scene.description).light_groups.len();
        self.settings.aovs = if groups > 1 { vec![Aov::LightGroups] } else { Vec::new() };
    }

    /// The file's scene with the values that were set, at the frame.
    fn scene(&self, file: &Arc<Scene>) -> Result<Arc<Scene>, SceneError> {
        let mut scene = Arc::clone(file);
        for (path, value) in &self.values {
            scene = Arc::new(scene.with_value(path, value.clone())?);
        }
        if self.frame != 0.0 {
            scene = Arc::new(scene.at_frame(self.frame)?);
        }
        Ok(scene)
    }

    fn picture(&self, scene: &Scene) -> Result<Picture, Error> {
        match &self.before {
            Some((before, picture)) => picture.after(before, scene, &self.settings),
            _ => Picture::new(scene, &self.settings),
        }
    }

    /// The file again. What people changed stays, unless the file has changed there too.
    fn reload(&mut self, old: &Arc<Scene>) -> Result<Arc<Scene>, Error> {
        let is_file = Path::new(&self.name).is_file();
        let new = Arc::new(if is_file { old.reload(&self.name)? } else { Scene::named(&self.name)? });
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

/// The camera that is looked through first, when the scene says.
fn chosen_camera<'s>(settings: &Settings, scene: &'s Scene) -> Option<&'s AnyCamera> {
    let description = &scene.description;
    let named = settings.camera.as_ref().or(description.render.camera.as_ref().map(|name| &name.0));
    let several = &description.cameras;
    let named = named.map(|name| several.get(name).or(description.camera.as_ref().filter(|_| name == "camera")));
    named.unwrap_or_else(|| description.camera.as_ref().or_else(|| several.values().next())).map(|camera| &**camera)
}

/// Width times height.
pub fn pixels_of([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

/// A size whose film can be held in memory, of the same shape.
fn bearable([width, height]: [u32; 2]) -> [u32; 2] {
    let pixels = pixels_of([width, height]);
    let scale = (MOST_PIXELS as f64 / pixels.max(1) as f64).sqrt();
    if pixels <= MOST_PIXELS {
        [width, height]
    } else {
        [width, height].map(|edge| ((f64::from(edge) * scale) as u32).max(1))
    }
}

/// As `juggler check` says it.
pub fn text_of(error: &Error) -> String {
    match error {
        Error::Scene(SceneError::Problems(problems)) => problems.render(false),
        error => format!("error: {error}"),
    }
}
