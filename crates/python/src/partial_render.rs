//! Partial renders: the bytes of `.jfilm` files.

use crate::denoise::library;
use crate::errors::{of_file, of_partial_render, settings_error};
use crate::image::Image;
use crate::task::{self, Fault};
use juggler::film::{self, Merge, MergeGoal};
use juggler::render::Control;
use juggler::{RenderedImage, imaging};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Samples of some pixels of an image, which other partial renders complete.
#[pyclass(frozen, module = "juggler._native")]
pub struct PartialRender {
    /// The partial render, whose bytes are in memory.
    pub partial_render: Arc<film::PartialRender>,
    bytes: Arc<[u8]>,
}

impl PartialRender {
    /// Reads the bytes of a partial render.
    pub fn new(bytes: impl Into<Arc<[u8]>>) -> PyResult<Self> {
        let bytes = bytes.into();
        let read = film::PartialRender::from_bytes("partial render", Arc::clone(&bytes));
        let partial_render = read.map_err(|error| of_partial_render(&error))?;
        Ok(Self { partial_render: Arc::new(partial_render), bytes })
    }
}

#[pymethods]
impl PartialRender {
    /// Reads the bytes of a `.jfilm` file.
    #[new]
    fn from_bytes(bytes: &[u8]) -> PyResult<Self> {
        Self::new(bytes)
    }

    /// Reads a `.jfilm` file.
    #[staticmethod]
    fn open(py: Python<'_>, path: &str) -> PyResult<Self> {
        let file = PathBuf::from(path);
        let bytes = task::call(py, move || Ok(film::PartialRender::open(&file)?.to_bytes()?))?;
        Self::new(bytes)
    }

    /// All bytes.
    fn bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.bytes)
    }

    fn __len__(&self) -> usize {
        self.bytes.len()
    }

    /// Writes the bytes to a file.
    fn save(&self, py: Python<'_>, path: &str) -> PyResult<()> {
        let bytes = Arc::clone(&self.bytes);
        let written = py.detach(|| imaging::atomic::write(Path::new(path), &bytes));
        written.map_err(|error| of_file("write", path, &error))
    }

    /// Description of the render and of the share, as JSON.
    fn description(&self) -> String {
        serde_json::to_string(self.partial_render.description()).unwrap_or_default()
    }
}

/// Joins partial renders to a whole image.
#[pyfunction]
pub fn merge(py: Python<'_>, partial_renders: Vec<Py<PartialRender>>) -> PyResult<Image> {
    if partial_renders.is_empty() {
        return Err(settings_error("partial_renders", "there are no partial renders to merge"));
    }
    let frame = partial_renders.first().map_or(0.0, |first| first.get().partial_render.description().frame);
    let named = partial_renders.into_iter().enumerate().map(|(number, one)| {
        let name = format!("partial render {number}");
        film::PartialRender::from_bytes(&name, Arc::clone(&one.get().bytes)).map_err(|error| of_partial_render(&error))
    });
    let opened = named.collect::<PyResult<Vec<_>>>()?;
    let image = task::call(py, move || {
        let merge = Merge::new(opened, MergeGoal::Whole)?;
        let library = library();
        RenderedImage::from_partial_renders(&merge, library.as_deref(), &Control::default()).map_err(Fault::from)
    })?;
    Ok(Image::new(image, frame))
}
