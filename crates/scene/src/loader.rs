//! Loading of scenes by programs that know formats of models.

use crate::asset::Asset;
use crate::compile::{AssetCache, NEVER_CANCELLED};
use crate::model::{ModelCache, ModelFormat, ModelNeeds};
use crate::picture_reading::PictureReading;
use crate::store::{Bundle, Store};
use crate::{Scene, SceneError};
use juggler_math::BuildControl;
use std::path::Path;

/// Loads scene files, mesh files and files of the model formats that it knows.
///
/// [`Scene::load`] knows no model format. The scenes of a loader keep its formats, for models among
/// their objects and for [`Scene::reload`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Loader {
    formats: &'static [&'static dyn ModelFormat],
    is_lenient: bool,
    pictures: PictureReading,
}

impl Loader {
    /// Creates a loader that knows these formats.
    pub const fn new(formats: &'static [&'static dyn ModelFormat]) -> Self {
        Self { formats, is_lenient: false, pictures: PictureReading::Whole }
    }

    /// The same loader, which shows missing and broken pictures of models gray, with a warning,
    /// instead of refusing these models.
    #[must_use]
    pub const fn lenient(self) -> Self {
        Self { is_lenient: true, ..self }
    }

    /// The same loader, whose scenes read only the heads of the pictures of textures, for programs
    /// that render nothing.
    #[must_use]
    pub const fn with_picture_heads(self) -> Self {
        Self { pictures: PictureReading::Heads, ..self }
    }

    /// Loads a file as [`Scene::load`] does. A model becomes a scene that shows it, with a light if
    /// it has none.
    pub fn load(self, path: impl AsRef<Path>) -> Result<Scene, SceneError> {
        self.load_with_control(path, &NEVER_CANCELLED)
    }

    /// [`Loader::load`], which ends early if `control` is cancelled, and reports its progress to it.
    pub fn load_with_control(self, path: impl AsRef<Path>, control: &BuildControl) -> Result<Scene, SceneError> {
        Scene::read(path.as_ref(), self.cache(Store::default()), control)
    }

    /// Reads a scene from files in memory, as [`Loader::load`] does from disk.
    pub fn from_bundle(self, bundle: Bundle, name: &str) -> Result<Scene, SceneError> {
        Scene::read(Path::new(name), self.cache(bundle.into()), &NEVER_CANCELLED)
    }

    /// Parses a scene as [`Scene::from_json`] does.
    pub fn from_json(self, text: impl Into<String>, name: &str) -> Result<Scene, SceneError> {
        self.from_json_with(text, name, [])
    }

    /// Parses a scene as [`Scene::from_json`] does, with assets by the names under which the scene
    /// refers to them ([`Scene::asset`]). The assets are there before the text is checked.
    pub fn from_json_with(
        self,
        text: impl Into<String>,
        name: &str,
        assets: impl IntoIterator<Item = (String, Asset)>,
    ) -> Result<Scene, SceneError> {
        self.from_json_with_control(text, name, assets, &NEVER_CANCELLED)
    }

    /// [`Loader::from_json_with`], which ends early if `control` is cancelled, and reports its progress
    /// to it.
    pub fn from_json_with_control(
        self,
        text: impl Into<String>,
        name: &str,
        assets: impl IntoIterator<Item = (String, Asset)>,
        control: &BuildControl,
    ) -> Result<Scene, SceneError> {
        let mut cache = self.cache(Store::default());
        assets.into_iter().for_each(|(name, asset)| cache.insert_asset(name, asset));
        Scene::parse(text.into(), name, cache, control)
    }

    /// Whether a file is a model in a format that the loader knows, by its first bytes or its name. A
    /// file that holds nothing but a mesh is none.
    pub fn is_model(self, path: &Path) -> bool {
        let cache = self.cache(Store::default());
        cache.is_model(path) && !cache.is_plain_mesh(path)
    }

    /// Memory that a model file needs, from its document and the lengths of the files that it
    /// names; zero for other files.
    pub fn model_needs(self, path: &Path) -> ModelNeeds {
        self.models().needs(path, &Store::default())
    }

    fn models(self) -> ModelCache {
        ModelCache::new(self.formats, self.is_lenient, self.pictures)
    }

    /// Cache of files from a store, in the formats of the loader.
    pub(crate) fn cache(self, store: Store) -> AssetCache {
        AssetCache::new(store).with_models(self.models(), self.pictures)
    }
}
