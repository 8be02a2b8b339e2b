//! Renderer: a scene that is built once, edited and rendered again.

use crate::arrays::Asset;
use crate::budget;
use crate::cluster::{Ledger, Unit};
use crate::errors::{convert, key_error, line, settings_error};
use crate::image::Image;
use crate::partial_render::PartialRender;
use crate::progressive::Progressive;
use crate::scene::{self, Refusal, Scene};
use crate::settings::RenderSettings;
use crate::state::{self, Built};
use crate::task::{self, Canceler, Fault, Monitor, Watch};
use juggler::film::shard::WorkUnit;
use juggler::memory::Effort;
use juggler::probe::{Detail, Prober};
use juggler::scene::camera_json;
use juggler::scene::path::Path;
use juggler::{BuildControl, RenderOrigin, scene as scenes};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::Value;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Scene with settings, whose world is kept between renders.
#[pyclass(frozen, module = "juggler._native")]
pub struct Renderer {
    /// Held only while the interpreter is attached, and never while Python code runs: otherwise a
    /// thread that waits for the lock could keep the one that holds it from running.
    state: Mutex<State>,
    settings: RenderSettings,
    name: String,
    /// Name that partial renders store.
    title: String,
}

/// A scene, its frame, a known world of which parts may still hold, and the effort of a render.
struct Start {
    scene: scenes::Scene,
    frame: f64,
    before: Option<Arc<Built>>,
    effort: Effort,
}

/// What edits and renders change. Renders under way keep the scene with which they began.
struct State {
    scene: scenes::Scene,
    frame: f64,
    built: Option<Arc<Built>>,
    /// Scene of the last render.
    rendered: Option<scenes::Scene>,
    /// Kinds of changes between the last two renders.
    changed: Vec<&'static str>,
    /// Warnings of builds that were not taken yet.
    warnings: Vec<String>,
}

#[pymethods]
impl Renderer {
    #[new]
    fn new(scene: &Scene, keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        let settings = RenderSettings::new(keywords)?;
        let mut own = scene.scene.clone();
        if let Some(setting) = settings.model_setting() {
            let [variant, animation, model_scene] = settings.model.clone();
            if !own.choose_model(variant, animation, model_scene) {
                return Err(scene::no_model(setting, &scene.name));
            }
        }
        settings.settings.apply(&own).map_err(convert)?;
        let frame = state::frame(&own, &settings);
        let (changed, warnings) = (Vec::new(), Vec::new());
        let state = State { scene: own, frame, built: None, rendered: None, changed, warnings };
        Ok(Self { state: Mutex::new(state), settings, name: scene.name.clone(), title: scene.title() })
    }

    /// The current scene.
    fn scene(&self) -> Scene {
        Scene { scene: self.lock().scene.clone(), name: self.name.clone() }
    }

    /// Value at a path, as JSON.
    fn value(&self, path: &str) -> PyResult<String> {
        let (path, scene) = (scene::path(path)?, self.lock().scene.clone());
        let value = scene.value_at(&path).map_err(|unknown| key_error(&unknown.to_string()))?;
        Ok(value.to_string())
    }

    /// Sets the value at a path, given as JSON with the assets that it names; `null` removes it.
    #[pyo3(signature = (path, json, assets=Vec::new()))]
    fn set_value(&self, path: &str, json: &str, assets: Vec<(String, Py<Asset>)>) -> PyResult<()> {
        let value: Value = serde_json::from_str(json).map_err(|error| settings_error("value", error.to_string()))?;
        let (path, assets) = (scene::path(path)?, scene::shared(assets));
        // Edits of several threads follow each other. The lock is released before an exception is
        // made, which may let other threads run.
        let edited = {
            let mut state = self.lock();
            let with_assets =
                assets.into_iter().fold(state.scene.clone(), |scene, (name, asset)| scene.asset(name, asset));
            scene::with_value(&with_assets, &path, value).map(|scene| state.scene = scene)
        };
        edited.map_err(Refusal::into_exception)
    }

    /// Path of the camera of the image.
    fn camera_path(&self) -> String {
        let scene = &self.lock().scene;
        let cameras = &scene.description.cameras;
        let settings = self.settings.settings.camera.as_ref();
        let chosen = scene.description.render.camera.as_ref().map(|camera| &camera.0);
        let name = settings.or(chosen).filter(|name| cameras.contains_key(*name)).or_else(|| cameras.keys().next());
        name.map_or_else(|| "camera".to_owned(), |name| Path::root().key("cameras").key(name).to_string())
    }

    /// The camera of the image, as JSON.
    fn camera(&self, py: Python<'_>) -> PyResult<String> {
        let built = self.built(py)?;
        Ok(camera_json(&built.picture.view().camera).to_string())
    }

    /// Frame, which may lie between two.
    fn frame(&self) -> f64 {
        self.lock().frame
    }

    /// Selects another frame.
    fn set_frame(&self, frame: f64) -> PyResult<()> {
        if !frame.is_finite() {
            return Err(settings_error("frame", format!("a frame must be a finite number, not {frame}")));
        }
        self.lock().frame = frame;
        Ok(())
    }

    /// Kinds of changes between the last two renders.
    fn changed(&self) -> Vec<&'static str> {
        self.lock().changed.clone()
    }

    /// Removes and returns the warnings of builds.
    fn take_warnings(&self) -> Vec<String> {
        std::mem::take(&mut self.lock().warnings)
    }

    /// Fingerprint of everything that determines the pixels, of another frame than the selected one if
    /// `frame` is given.
    #[pyo3(signature = (frame=None))]
    fn fingerprint(&self, py: Python<'_>, frame: Option<f64>) -> PyResult<String> {
        let built = self.built_at(py, frame)?;
        task::call(py, move || Ok(built.picture.fingerprint().hash()))
    }

    /// Renders the image, of another frame than the selected one if `frame` is given.
    #[pyo3(signature = (callback=None, canceler=None, frame=None))]
    fn render(
        &self,
        py: Python<'_>,
        callback: Option<Py<PyAny>>,
        canceler: Option<Py<Canceler>>,
        frame: Option<f64>,
    ) -> PyResult<Image> {
        let watch = Watch { callback, canceler };
        let (built, image) = self.with_world_of(py, self.start_at(frame)?, &watch, state::render)?;
        self.store(&built);
        Ok(Image::new(image, built.frame))
    }

    /// Renders better and better images.
    fn progressive(&self, py: Python<'_>, every: f64) -> PyResult<Progressive> {
        let (Start { scene, frame, before, effort }, settings) = (self.start()?, self.settings.clone());
        let build = move |control: &BuildControl| state::build(&scene, frame, &settings.settings, before, control);
        Progressive::start(py, effort.threads, every, build)
    }

    /// Keeps the world of a progressive render.
    fn keep(&self, progressive: &Progressive) {
        if let Some(built) = progressive.built() {
            self.store(&built);
        }
    }

    /// Renders one of `count` shards.
    #[pyo3(signature = (index, count, callback=None))]
    fn render_shard(
        &self,
        py: Python<'_>,
        index: u32,
        count: u32,
        callback: Option<Py<PyAny>>,
    ) -> PyResult<PartialRender> {
        let name = self.title.clone();
        let (built, bytes) = self.with_world(py, &Watch { callback, canceler: None }, move |built, _, monitor| {
            let origin = RenderOrigin { scene: name, frame: built.frame, command: String::new() };
            Ok(built.picture.render_shard([index, count], &origin, &monitor.control)?)
        })?;
        self.keep_world(&mut self.lock(), &built);
        PartialRender::new(bytes)
    }

    /// Renders units of work at a frame, and returns the bytes of their partial render.
    #[pyo3(signature = (units, frame, callback=None))]
    fn render_units<'py>(
        &self,
        py: Python<'py>,
        units: Vec<Unit>,
        frame: f64,
        callback: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let start = self.start_at(Some(frame))?;
        let origin = RenderOrigin { scene: self.title.clone(), frame, command: String::new() };
        let units: Vec<WorkUnit> =
            units.into_iter().map(|(tile, first, end)| WorkUnit { tile, samples: first..end }).collect();
        let watch = Watch { callback, canceler: None };
        let (built, bytes) = self.with_world_of(py, start, &watch, move |built, _, monitor| {
            Ok(built.picture.render_units(&units, &origin, &monitor.control)?)
        })?;
        self.keep_world(&mut self.lock(), &built);
        Ok(PyBytes::new(py, &bytes))
    }

    /// Empty film of the image, which partial renders fill.
    fn ledger(&self, py: Python<'_>) -> PyResult<Ledger> {
        let built = self.built(py)?;
        let origin = RenderOrigin { scene: self.title.clone(), frame: built.frame, command: String::new() };
        let (picture, frame) = (built.picture.clone(), built.frame);
        let ledger = task::call(py, move || Ok(juggler::Ledger::new(picture, &origin)?))?;
        Ok(Ledger::new(ledger, frame))
    }

    /// Continues a partial render up to the samples of the settings.
    #[pyo3(signature = (partial_render, callback=None))]
    fn extend(&self, py: Python<'_>, partial_render: &PartialRender, callback: Option<Py<PyAny>>) -> PyResult<Image> {
        let (name, partial_render) = (self.title.clone(), partial_render.partial_render.clone());
        let (built, image) = self.with_world(py, &Watch { callback, canceler: None }, move |built, _, monitor| {
            let origin = RenderOrigin { scene: name, frame: built.frame, command: String::new() };
            let film = Arc::new(built.picture.resume_film(&partial_render, &origin)?);
            state::finish(&built.picture, &film, Instant::now(), monitor)
        })?;
        self.store(&built);
        Ok(Image::new(image, built.frame))
    }

    /// Explains a pixel: the report as text and as JSON.
    fn probe(
        &self,
        py: Python<'_>,
        pixel: [u32; 2],
        depth: u32,
        branches: usize,
        brightest: usize,
    ) -> PyResult<(String, String)> {
        let (built, report) = self.with_world(py, &Watch::default(), move |built, _, monitor| {
            let prober = Prober::new(&built.scene, built.picture.clone());
            let probe = prober.probe_pixel(pixel, &Detail { depth, branches, brightest }, &monitor.control)?;
            Ok((probe.to_string(), serde_json::to_string(&probe).unwrap_or_default()))
        })?;
        self.keep_world(&mut self.lock(), &built);
        Ok(report)
    }
}

impl Renderer {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins a render.
    fn start(&self) -> PyResult<Start> {
        self.start_at(None)
    }

    /// Begins a render of this frame, or of the selected one.
    fn start_at(&self, frame: Option<f64>) -> PyResult<Start> {
        let mut state = self.lock();
        let (scene, frame) = (state.scene.clone(), frame.unwrap_or(state.frame));
        // Of another frame's world little holds, so memory does not keep both.
        let before = match &state.built {
            Some(built) if built.frame != frame => state.built.take(),
            built => built.clone(),
        };
        drop(state);
        let effort = budget::effort(&scene, &self.settings)?;
        Ok(Start { scene, frame, before, effort })
    }

    /// Does work with the world of the current scene, which is built if it is not known.
    fn with_world<T: Send + 'static>(
        &self,
        py: Python<'_>,
        watch: &Watch,
        work: impl FnOnce(&Built, &Effort, &Monitor) -> Result<T, Fault> + Send + 'static,
    ) -> PyResult<(Arc<Built>, T)> {
        self.with_world_of(py, self.start()?, watch, work)
    }

    /// Does work with the world of a render that begins.
    fn with_world_of<T: Send + 'static>(
        &self,
        py: Python<'_>,
        Start { scene, frame, before, effort }: Start,
        watch: &Watch,
        work: impl FnOnce(&Built, &Effort, &Monitor) -> Result<T, Fault> + Send + 'static,
    ) -> PyResult<(Arc<Built>, T)> {
        let settings = self.settings.clone();
        task::run(py, effort.threads, watch, move |monitor| {
            let built = state::build(&scene, frame, &settings.settings, before, monitor.control.build())?;
            let result = work(&built, &effort, monitor)?;
            Ok((built, result))
        })
    }

    /// World of the current scene.
    fn built(&self, py: Python<'_>) -> PyResult<Arc<Built>> {
        self.built_at(py, None)
    }

    /// World of the current scene at this frame, or at the selected one.
    fn built_at(&self, py: Python<'_>, frame: Option<f64>) -> PyResult<Arc<Built>> {
        let start = self.start_at(frame)?;
        let (built, ()) = self.with_world_of(py, start, &Watch::default(), |_, _, _| Ok(()))?;
        self.keep_world(&mut self.lock(), &built);
        Ok(built)
    }

    fn keep_world(&self, state: &mut State, built: &Arc<Built>) {
        if state.built.as_ref().is_some_and(|known| Arc::ptr_eq(known, built)) {
            return;
        }
        let warnings = built.picture.compiled().warnings.list().iter().map(line);
        state.warnings.extend(warnings);
        state.built = Some(Arc::clone(built));
    }

    /// Keeps the world of a finished render, and notes what changed since the one before.
    fn store(&self, built: &Arc<Built>) {
        let mut state = self.lock();
        self.keep_world(&mut state, built);
        let before = state.rendered.replace(built.scene.clone());
        if let Some(before) = before {
            state.changed = built.scene.change_since(&before).kinds().map(scenes::Changed::name).collect();
        }
    }
}
