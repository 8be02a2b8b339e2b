//! Renders that several workers share: the film that their partial renders fill, and the files of a
//! scene, which travel to them.

use crate::arrays::Asset;
use crate::denoise::library;
use crate::errors::settings_error;
use crate::image::Image;
use crate::scene::{Scene, loader, shared};
use crate::task::{self, Fault, Watch};
use crate::threads::thread_count;
use juggler::film::checkpoint::Checkpoint;
use juggler::film::shard::WorkUnit;
use juggler::film::{Added, PartialRender};
use juggler::imaging::{self, AnimationFormat, AnimationHeader, FrameWriter};
use juggler::render::Cancelled;
use juggler::scene::ScenePackage;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Number of a tile, first sample, and the sample after the last.
pub type Unit = (u64, u32, u32);

/// Film of an image that several workers render.
#[pyclass(frozen, module = "juggler._native")]
pub struct Ledger {
    ledger: Arc<juggler::Ledger>,
    checkpoint: Arc<Mutex<Option<Checkpoint>>>,
    frame: f64,
    start: Instant,
}

impl Ledger {
    /// The ledger of a frame.
    pub fn new(ledger: juggler::Ledger, frame: f64) -> Self {
        Self { ledger: Arc::new(ledger), checkpoint: Arc::default(), frame, start: Instant::now() }
    }

    fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}

#[pymethods]
impl Ledger {
    /// Uses a checkpoint, and continues from it if the file exists. Returns a message if the newest file
    /// was damaged and an older one was used.
    fn resume(&self, py: Python<'_>, path: &str) -> PyResult<Option<String>> {
        let (ledger, path) = (Arc::clone(&self.ledger), PathBuf::from(path));
        let (checkpoint, damage) = task::call(py, move || Ok(ledger.resume(&path)?))?;
        *self.checkpoint.lock().unwrap_or_else(PoisonError::into_inner) = Some(checkpoint);
        Ok(damage)
    }

    /// Saves the film to its checkpoint, if it has one.
    fn save(&self, py: Python<'_>) -> PyResult<()> {
        let (ledger, checkpoint) = (Arc::clone(&self.ledger), Arc::clone(&self.checkpoint));
        task::call(py, move || {
            let mut checkpoint = checkpoint.lock().unwrap_or_else(PoisonError::into_inner);
            checkpoint.as_mut().map(|checkpoint| ledger.save(checkpoint)).transpose()?;
            Ok(())
        })
    }

    /// Removes the previous checkpoint of a complete render.
    fn close(&self) {
        let checkpoint = self.checkpoint.lock().unwrap_or_else(PoisonError::into_inner).take();
        checkpoint.into_iter().for_each(Checkpoint::close);
    }

    /// Units of work that the film lacks, of these samples and for this number of workers: tile, first
    /// sample, the sample after the last, and cost in samples of pixels.
    fn missing(&self, py: Python<'_>, samples: (u32, u32), workers: u32) -> PyResult<Vec<(u64, u32, u32, u64)>> {
        let ledger = Arc::clone(&self.ledger);
        task::call(py, move || {
            let tiling = ledger.picture().tiling();
            let unit = |WorkUnit { tile, samples }: WorkUnit| {
                let area = tiling.tile(tile).map_or(0, |pixels| pixels.area());
                (tile, samples.start, samples.end, area * samples.len() as u64)
            };
            Ok(ledger.missing(samples.0..samples.1, workers).into_iter().map(unit).collect())
        })
    }

    /// Adds the bytes of a partial render. Returns the numbers of samples of pixels that are new, and of
    /// those that the film held already. Messages call the partial render by `name`.
    fn add(&self, py: Python<'_>, bytes: &[u8], name: String) -> PyResult<(u64, u64)> {
        let (ledger, bytes) = (Arc::clone(&self.ledger), Arc::<[u8]>::from(bytes));
        let Added { samples, duplicates } = task::call(py, move || {
            let partial_render = PartialRender::from_bytes(&name, bytes)?;
            Ok(ledger.add(&partial_render)?)
        })?;
        Ok((samples, duplicates))
    }

    /// Whether the film lacks nothing.
    fn is_finished(&self, py: Python<'_>) -> bool {
        py.detach(|| self.ledger.is_finished())
    }

    /// Finished share of the work, from 0 to 1, and the samples of all pixels that the film holds.
    fn progress(&self, py: Python<'_>) -> (f64, u64) {
        py.detach(|| (self.ledger.share(), self.ledger.samples()))
    }

    /// Maximum number of samples per pixel.
    fn samples(&self) -> u32 {
        self.ledger.picture().samples()
    }

    /// Fingerprint of everything that determines the pixels.
    fn fingerprint(&self, py: Python<'_>) -> PyResult<String> {
        let ledger = Arc::clone(&self.ledger);
        task::call(py, move || Ok(ledger.picture().fingerprint().hash()))
    }

    /// The image so far.
    fn snapshot(&self, py: Python<'_>) -> PyResult<Image> {
        let (ledger, elapsed) = (Arc::clone(&self.ledger), self.elapsed());
        let image = task::call(py, move || Ok(ledger.snapshot(elapsed)))?;
        Ok(Image::new(image, self.frame))
    }

    /// The whole image, denoised if the settings say so.
    fn develop(&self, py: Python<'_>) -> PyResult<Image> {
        let (ledger, elapsed) = (Arc::clone(&self.ledger), self.elapsed());
        let image = task::run(py, thread_count(None)?, &Watch::default(), move |monitor| {
            let library = library();
            Ok(ledger.develop(elapsed, library.as_deref(), &monitor.control)?)
        })?;
        Ok(Image::new(image, self.frame))
    }
}

/// Name of a scene file, its text if it is one, and the other files: paths, BLAKE3 hashes in
/// hexadecimal, and contents.
type Package<'py> = (String, Option<String>, Vec<(String, String, Bound<'py, PyBytes>)>);

/// Everything but assets that a scene was read from.
#[pyfunction]
pub fn scene_package<'py>(py: Python<'py>, scene: &Scene) -> PyResult<Package<'py>> {
    let scene = scene.scene.clone();
    let (ScenePackage { name, text, files }, hashes) = task::call(py, move || {
        let package = scene.package()?;
        let hashes = package.digests().iter().map(hexadecimal).collect::<Vec<_>>();
        Ok((package, hashes))
    })?;
    let file = |((path, bytes), hash): ((String, Vec<u8>), String)| (path, hash, PyBytes::new(py, &bytes));
    Ok((name, text, files.into_iter().zip(hashes).map(file).collect()))
}

/// Reads the scene of a package with its assets, without files on disk. `title` is the name of the
/// scene in messages.
#[pyfunction]
pub fn scene_from_package(
    py: Python<'_>,
    title: String,
    name: String,
    text: Option<String>,
    files: Vec<(String, Bound<'_, PyBytes>)>,
    lenient: bool,
    assets: Vec<(String, Py<Asset>)>,
) -> PyResult<Scene> {
    let files = files.into_iter().map(|(path, bytes)| (path, bytes.as_bytes().to_vec())).collect();
    let package = ScenePackage { name, text, files };
    let assets = shared(assets);
    let read = move || loader(lenient).from_package(package, assets).map_err(Fault::from);
    Ok(Scene { scene: task::call(py, read)?, name: title })
}

fn hexadecimal(digest: &[u8; 32]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Encodes pictures as a movie, whose format the ending of `path` selects.
#[pyfunction]
pub fn encode_movie(py: Python<'_>, path: String, frames: Vec<String>, frames_per_second: f64) -> PyResult<()> {
    let Some(format) = AnimationFormat::from_path(Path::new(&path)) else {
        let known = AnimationFormat::extensions();
        return Err(settings_error("path", format!("`{path}` is no movie: the ending must be one of {known}")));
    };
    let watch = Watch::default();
    task::run(py, thread_count(None)?, &watch, move |monitor| {
        let mut writer: Option<Box<dyn FrameWriter>> = None;
        for frame in &frames {
            if monitor.control.is_cancelled() {
                return Err(Cancelled.into());
            }
            let image = imaging::read_with_alpha(Path::new(frame))?;
            let [width, height] = [image.colors.width(), image.colors.height()];
            let count = u32::try_from(frames.len()).unwrap_or(u32::MAX);
            let header = AnimationHeader::new(width, height, count, frames_per_second);
            let header = AnimationHeader { transparent: image.alpha.is_some(), ..header };
            let writer = match &mut writer {
                Some(writer) => writer,
                none => none.insert(imaging::create_animation(Path::new(&path), format, &header)?),
            };
            writer.write_frame(image.rows())?;
        }
        writer.map_or(Ok(()), |writer| Ok(writer.finish()?))
    })
}
