//! A scene as programs use it: read or built, checked, compiled.

use crate::animate;
use crate::compile::{Assembly, Compiled};
use crate::description::{Backdrop, Description, Object};
use crate::document::{Document, Node, Sources, Unreadable, read_text};
use crate::report::{Finding, Problems, plain_io};
use juggler_tracer::camera::AnyCamera;
use juggler_tracer::light::AnyLight;
use juggler_tracer::material::AnyMaterial;
use juggler_tracer::texture::AnyTexture;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read `{}`: {}", path.display(), plain_io(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is not a scene file at all.
    #[error("`{}`: {message}", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Why not.
        message: String,
    },
    /// No built-in scene has this name.
    #[error("no built-in scene is called `{name}`{}", help.as_ref().map(|h| format!("; {h}")).unwrap_or_default())]
    UnknownBuiltIn {
        /// The name.
        name: String,
        /// What was probably meant.
        help: Option<String>,
    },
    /// The scene has mistakes.
    #[error("{0}")]
    Problems(Problems),
}

/// A scene at one frame.
///
/// ```
/// use juggler_scene::{Object, Scene};
/// use juggler_tracer::shape::Sphere;
///
/// let scene = Scene::new().add(Object::new(Sphere::default()).at(0.0, 1.0, 0.0));
/// let compiled = scene.compile()?;
/// assert_eq!(compiled.cameras.len(), 1);
/// # Ok::<(), juggler_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// All of it, as numbers: expressions are resolved.
    pub description: Description,
    /// Where it was read from.
    origin: Option<Arc<Origin>>,
}

/// A scene's files, and its tree at the frame.
#[derive(Clone, Debug)]
struct Origin {
    document: Arc<Document>,
    resolved: Node,
}

impl Scene {
    /// An empty scene to build upon.
    pub fn new() -> Self {
        Self::default()
    }

    /// Reads a scene file and what it includes, at frame 0.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let text = read_text(path).map_err(|unreadable| match unreadable {
            Unreadable::Io(source) => SceneError::Read { path: path.into(), source },
            Unreadable::NotText(message) => SceneError::NotText { path: path.into(), message },
        })?;
        Self::from_json(text, &path.to_string_lossy())
    }

    /// Reads a scene from a text. `name` is what messages call it; files that the scene names are looked for in
    /// the folder of `name`.
    pub fn from_json(text: impl Into<String>, name: &str) -> Result<Self, SceneError> {
        let document = Document::read(name, text.into())
            .map_err(|(sources, findings)| SceneError::Problems(Problems::new(findings, sources, None)))?;
        Self::resolve(Arc::new(document), 0.0)
    }

    /// The same scene at another frame, which may lie between two. A scene that was not read from a file has no
    /// expressions and stays as it is; changes made since a scene was read are lost.
    pub fn at_frame(&self, frame: f64) -> Result<Self, SceneError> {
        match &self.origin {
            Some(origin) => Self::resolve(Arc::clone(&origin.document), frame),
            None => Ok(self.clone()),
        }
    }

    fn resolve(document: Arc<Document>, frame: f64) -> Result<Self, SceneError> {
        let (resolved, mut findings) = animate::resolve(&document.tree, &document.sources, frame);
        match serde_path_to_error::deserialize(resolved.to_json()) {
            Ok(description) if findings.is_empty() => {
                Ok(Self { description, origin: Some(Arc::new(Origin { document, resolved })) })
            }
            Ok(_) => Err(problems(findings, &document, &resolved)),
            Err(error) => {
                let path = crate::path::Path::root().join(&error.path().to_string());
                findings.push(Finding::error(error.into_inner().to_string()).at(&path));
                Err(problems(findings, &document, &resolved))
            }
        }
    }

    /// All that is wrong with the scene, warnings included, without building the world.
    pub fn check(&self) -> Problems {
        self.report(Assembly::of(&self.description).1)
    }

    /// Builds the world.
    pub fn compile(&self) -> Result<Compiled, SceneError> {
        let (assembly, findings) = Assembly::of(&self.description);
        if findings.iter().any(Finding::is_error) {
            return Err(SceneError::Problems(self.report(findings)));
        }
        Ok(assembly.compile(self.description.render.clone()))
    }

    fn report(&self, findings: Vec<Finding>) -> Problems {
        match &self.origin {
            Some(origin) => Problems::new(findings, origin.document.sources.clone(), Some(&origin.resolved)),
            None => Problems::new(findings, Sources::default(), None),
        }
    }

    /// The scene as a file, expressions resolved.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(&self.description).unwrap_or_default()
    }
}

fn problems(findings: Vec<Finding>, document: &Document, resolved: &Node) -> SceneError {
    SceneError::Problems(Problems::new(findings, document.sources.clone(), Some(resolved)))
}

/// Building a scene.
impl Scene {
    /// Adds an object.
    #[must_use]
    #[expect(clippy::should_implement_trait, reason = "a scene is built by adding to it")]
    pub fn add(mut self, object: Object) -> Self {
        self.description.objects.push(object);
        self
    }

    /// Adds a light.
    #[must_use]
    pub fn light(mut self, light: impl Into<AnyLight>) -> Self {
        self.description.lights.push(light.into());
        self
    }

    /// Adds a material under a name.
    #[must_use]
    pub fn material(mut self, name: impl Into<String>, material: impl Into<AnyMaterial>) -> Self {
        self.description.materials.insert(name.into(), material.into());
        self
    }

    /// Adds a texture under a name.
    #[must_use]
    pub fn texture(mut self, name: impl Into<String>, texture: impl Into<AnyTexture>) -> Self {
        self.description.textures.insert(name.into(), texture.into());
        self
    }

    /// Adds a group of objects under a name, to be placed by [`Object::group`].
    #[must_use]
    pub fn group(mut self, name: impl Into<String>, objects: impl IntoIterator<Item = Object>) -> Self {
        self.description.groups.insert(name.into(), objects.into_iter().collect());
        self
    }

    /// Adds a camera under a name; the first is used unless another is chosen.
    #[must_use]
    pub fn camera(mut self, name: impl Into<String>, camera: impl Into<AnyCamera>) -> Self {
        self.description.cameras.insert(name.into(), camera.into());
        self
    }

    /// Sets what lies behind everything.
    #[must_use]
    pub fn background(mut self, background: impl Into<Backdrop>) -> Self {
        self.description.background = Some(background.into());
        self
    }

    /// Sets the picture's size in pixels.
    #[must_use]
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.description.render.size = [width, height];
        self
    }

    /// Sets the samples per pixel.
    #[must_use]
    pub fn samples(mut self, samples: u32) -> Self {
        self.description.render.samples = samples;
        self
    }
}
