//! Scenes.

use crate::arrays::Asset;
use crate::errors::{key_error, of_problems, of_scene, scene_error, settings_error};
use crate::task::{self, Fault};
use juggler::BuildControl;
use juggler::scene::model::{ModelSummary, SceneModel};
use juggler::scene::path::{Path as ScenePath, Step};
use juggler::scene::{self, Loader, UnknownPath};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::Path;

/// File name of the text of a scene that is no file. Messages do not show it. A folder before it is
/// that of the files that the scene names.
pub const UNNAMED: &str = "<scene>";

/// Scene, which never changes.
#[pyclass(frozen, module = "juggler._native")]
pub struct Scene {
    /// The scene at frame 0.
    pub scene: scene::Scene,
    /// File, built-in scene, or [`UNNAMED`], which may follow a folder.
    pub name: String,
}

impl Scene {
    /// Name that partial renders store.
    pub fn title(&self) -> String {
        if self.name.ends_with(UNNAMED) { "scene".to_owned() } else { self.name.clone() }
    }
}

#[pymethods]
impl Scene {
    /// Loads a file, or the built-in scene of this name.
    #[staticmethod]
    fn named(py: Python<'_>, name: String, lenient: bool) -> PyResult<Self> {
        let file = name.clone();
        let scene = task::read(py, move |control| Ok(loader(lenient).named_with_control(&file, control)?))?;
        Ok(Self { scene, name })
    }

    /// Reads the text of a scene, which refers to assets by their names. All other names of files in
    /// it are relative to the folder of `name`, or to the current one.
    #[staticmethod]
    #[pyo3(signature = (text, lenient, name=None, assets=Vec::new()))]
    fn from_json(
        py: Python<'_>,
        text: String,
        lenient: bool,
        name: Option<String>,
        assets: Vec<(String, Py<Asset>)>,
    ) -> PyResult<Self> {
        let name = name.unwrap_or_else(|| UNNAMED.to_owned());
        let (file, assets) = (name.clone(), shared(assets));
        let read =
            move |control: &BuildControl| Ok(loader(lenient).from_json_with_control(text, &file, assets, control)?);
        Ok(Self { scene: task::read(py, read)?, name })
    }

    /// The assets with their names.
    fn assets(&self) -> Vec<(String, Asset)> {
        self.scene.assets().map(|(name, asset)| (name.to_owned(), Asset { asset: asset.clone() })).collect()
    }

    /// File or built-in scene.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// Raises an exception with all mistakes, and returns the warnings.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let scene = self.scene.clone();
        let problems = task::call(py, move || Ok(scene.check()))?;
        if problems.errors() > 0 {
            return Err(of_problems(&problems));
        }
        Ok(problems.list().iter().map(crate::errors::line).collect())
    }

    /// Bounding box of all objects: least and greatest corner.
    fn bounds(&self, py: Python<'_>) -> PyResult<([f32; 3], [f32; 3])> {
        let scene = self.scene.clone();
        let bounds = task::call(py, move || Ok(scene.compile()?.world.bounds()))?;
        let is_finite = bounds.min.is_finite() && bounds.max.is_finite() && bounds.min.cmple(bounds.max).all();
        if !is_finite {
            return Err(scene_error("the objects have no bounds: they are infinite, or there are none"));
        }
        Ok((bounds.min.to_array(), bounds.max.to_array()))
    }

    /// Text of the scene file.
    fn to_json(&self) -> String {
        self.scene.to_json()
    }

    /// Text of the scene file, in which names of files are relative to the folder of `name`.
    fn to_json_at_name(&self) -> String {
        self.scene.to_json_in(Path::new(&self.name).parent().unwrap_or(Path::new("")))
    }

    /// Text of the scene file, in which names of files are relative to the current folder.
    fn to_json_here(&self) -> String {
        self.scene.to_json_in(Path::new(""))
    }

    /// Writes the scene file with its assets.
    fn save(&self, py: Python<'_>, path: String) -> PyResult<()> {
        let scene = self.scene.clone();
        task::call(py, move || scene.save(&path).map_err(Fault::from))
    }

    /// Descriptions of the models of the scene, as JSON.
    fn models(&self, py: Python<'_>) -> PyResult<String> {
        let scene = self.scene.clone();
        let models = task::call(py, move || Ok(scene.model_summaries()))?;
        Ok(Value::from_iter(models.iter().map(model)).to_string())
    }

    /// Number of frames and frames per second of the animation.
    fn animation(&self) -> (u32, f64) {
        let animation = self.scene.description.animation;
        (animation.frames, animation.frames_per_second)
    }
}

/// Assets that share the content of these.
pub fn shared(assets: Vec<(String, Py<Asset>)>) -> Vec<(String, scene::Asset)> {
    assets.into_iter().map(|(name, asset)| (name, asset.get().asset.clone())).collect()
}

/// Loader of all formats; `lenient` shows missing pictures of models gray.
pub fn loader(lenient: bool) -> Loader {
    if lenient { juggler::loader().lenient() } else { juggler::loader() }
}

fn model(SceneModel { path, summary, .. }: &SceneModel) -> Value {
    let ModelSummary { format, generator, scenes, variants, clips, materials, cameras, lights, warnings, .. } = summary;
    let clips: Vec<Value> = clips.iter().map(|clip| json!({"name": clip.name, "seconds": clip.seconds})).collect();
    let cameras: Vec<&String> = cameras.iter().map(|(name, _)| name).collect();
    let extensions: Vec<&String> = summary.extensions.iter().map(|extension| &extension.name).collect();
    json!({
        "path": path.to_string(), "format": format, "generator": generator, "scenes": scenes, "variants": variants,
        "clips": clips, "materials": materials, "cameras": cameras, "lights": lights, "nodes": summary.nodes,
        "triangles": summary.drawn_triangles, "extensions": extensions, "warnings": warnings,
    })
}

/// Path of a value of a scene, as messages print it or as a JSON pointer.
pub fn path(text: &str) -> PyResult<ScenePath> {
    ScenePath::parse(text).ok_or_else(|| {
        key_error(&format!("`{text}` is no path, such as `materials.gold.conductor.roughness` or `objects[0].shape`"))
    })
}

/// Why a value cannot be set.
pub enum Refusal {
    /// The scene has no such path.
    Path(String),
    /// The scene would be wrong.
    Scene(scene::SceneError),
    /// The renderer failed.
    Fault(Fault),
}

impl Refusal {
    /// The exception. Making it runs Python code, during which other threads may run.
    pub fn into_exception(self) -> PyErr {
        match self {
            Self::Path(message) => key_error(&message),
            Self::Scene(error) => of_scene(error),
            Self::Fault(fault) => fault.into_exception(),
        }
    }
}

/// The scene with another value at a path; `Null` removes the value.
pub fn with_value(scene: &scene::Scene, path: &ScenePath, value: Value) -> Result<scene::Scene, Refusal> {
    let known = scene.value_at(path);
    let unknown = known.as_ref().err();
    // A new key may have a default, and the index after the last one appends.
    let is_new = |unknown: &UnknownPath| unknown.is_last && (unknown.count.is_none() || appends(unknown));
    if let Some(unknown) = unknown.filter(|unknown| value.is_null() || !is_new(unknown)) {
        return Err(Refusal::Path(unknown.to_string()));
    }
    let edited = task::guarded(|| scene.with_value(&path.pointer(), value)).map_err(Refusal::Fault)?;
    edited.map_err(|error| match &error {
        scene::SceneError::Problems(problems) if unknown.is_some() => match problems.list() {
            [problem] if problem.path == path.to_string() && problem.message.starts_with("unknown key") => {
                Refusal::Path(crate::errors::line(problem))
            }
            _ => Refusal::Scene(error),
        },
        _ => Refusal::Scene(error),
    })
}

fn appends(unknown: &UnknownPath) -> bool {
    matches!(&unknown.step, Step::Index(index) if unknown.count == Some(*index))
}

/// Error of a setting for models, of a scene around none.
pub fn no_model(setting: &str, name: &str) -> PyErr {
    settings_error(setting, format!("`{setting}` is for model files; `{name}` is another scene"))
}
