//! Rendered images: pixels and AOVs as bytes, which arrays wrap.

use crate::denoise::library;
use crate::errors::{convert, of_image, settings_error};
use crate::settings::denoiser_by_name;
use crate::task;
use juggler::film::counts::SampleCountStats;
use juggler::imaging::{CropFrame, Header, ImageFormat, Tone, Viewpoint};
use juggler::math::Rgb;
use juggler::render::{Control, RayCounts};
use juggler::{Aov, AovSet, Error, RenderStats, RenderedImage, by_name};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Two matrices of 4 rows each.
type Matrices = ([[f32; 4]; 4], [[f32; 4]; 4]);

/// Rendered image.
#[pyclass(frozen, module = "juggler._native")]
pub struct Image {
    /// Pixels, AOVs and all that a file contains.
    pub image: Arc<RenderedImage>,
    frame: f64,
}

impl Image {
    /// The image of a frame.
    pub fn new(image: RenderedImage, frame: f64) -> Self {
        Self { image: Arc::new(image), frame }
    }

    fn metadata_of(&self, key: &str) -> Option<&str> {
        self.image.header.metadata.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str())
    }
}

#[pymethods]
impl Image {
    /// Width and height in pixels.
    #[getter]
    fn size(&self) -> [u32; 2] {
        self.image.size()
    }

    /// Frame, which may lie between two.
    #[getter]
    fn frame(&self) -> f64 {
        self.frame
    }

    /// Hash of the linear pixels: `film.hash` of `juggler render --stats`.
    #[getter]
    fn hash(&self) -> &str {
        &self.image.stats().film.hash
    }

    /// Fingerprint of everything that determines the pixels.
    #[getter]
    fn fingerprint(&self) -> Option<&str> {
        self.metadata_of("Fingerprint")
    }

    /// Metadata of the file, as pairs of key and text.
    #[getter]
    fn metadata(&self) -> Vec<(String, String)> {
        self.image.header.metadata.clone()
    }

    /// Camera matrices for row vectors: world to camera, and world to image.
    #[getter]
    fn viewpoint(&self) -> Option<Matrices> {
        self.image.header.viewpoint.map(|viewpoint| (viewpoint.world_to_camera, viewpoint.world_to_ndc))
    }

    /// Size of the whole frame, and the left upper corner of the image in it.
    #[getter]
    fn window(&self) -> ([u32; 2], [u32; 2]) {
        let size = self.image.size();
        self.image.header.crop.map_or((size, [0, 0]), |crop| (crop.size, crop.corner))
    }

    /// Statistics as a dictionary.
    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let RenderStats { film, samples, rays, render, denoise, .. } = self.image.stats();
        let all = PyDict::new(py);
        all.set_item("mean", film.mean)?;
        all.set_item("clamped", film.clamped)?;
        all.set_item("samples_min", samples.min)?;
        all.set_item("samples", samples.mean)?;
        all.set_item("samples_max", samples.max)?;
        all.set_item("rays", rays.total())?;
        all.set_item("camera_rays", rays.camera)?;
        all.set_item("shadow_rays", rays.shadow)?;
        all.set_item("secondary_rays", rays.secondary)?;
        all.set_item("not_finite", rays.not_finite)?;
        all.set_item("render_seconds", render.as_secs_f64())?;
        all.set_item("denoise_seconds", denoise.as_secs_f64())?;
        Ok(all)
    }

    /// Linear pixels: 3 numbers of 32 bits each, row by row from the top.
    fn pixels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let pixels = self.image.pixels();
        words(py, pixels.len() * 3, pixels.iter().flat_map(|pixel| pixel.to_array()).map(f32::to_ne_bytes))
    }

    /// Alpha: a number of 32 bits for each pixel; `None` for an opaque image.
    fn alpha<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let alpha = self.image.alpha();
        alpha.map(|alpha| words(py, alpha.len(), alpha.iter().map(|value| value.to_ne_bytes()))).transpose()
    }

    /// Layers of the AOVs: name, number of channels, and whether its numbers are integers.
    fn layers(&self) -> Vec<(String, usize, bool)> {
        self.image
            .layers()
            .map(|(layer, channels)| (layer.name.clone(), channels.len(), is_index(&layer.name)))
            .collect()
    }

    /// Pixels of a layer, with its channels side by side: floats or integers of 32 bits.
    fn layer<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let Some((_, channels)) = self.image.layers().find(|(layer, _)| layer.name == name) else { return Ok(None) };
        let count = self.image.pixels().len();
        let values = (0..count).flat_map(|at| channels.iter().filter_map(move |channel| channel.get(at)));
        let bytes = if is_index(name) {
            words(py, count * channels.len(), values.map(|value| (*value as i32).to_ne_bytes()))
        } else {
            words(py, count * channels.len(), values.map(|value| value.to_ne_bytes()))
        };
        bytes.map(Some)
    }

    /// Names of the objects or materials that an AOV numbers from 1; `None` for other AOVs.
    fn names(&self, aov: &str) -> Option<Vec<String>> {
        let names = self.image.aovs().names();
        match aov {
            "object_id" => Some((0..names.entries).map(|entry| names.object(entry)).collect()),
            "material_id" => {
                // A material without a name is called by its index, up to the last material that the image shows.
                let named = names.materials.last().map_or(0, |(id, _)| id.0.saturating_add(1));
                let layer = self.image.layers().find(|(layer, _)| layer.name == aov);
                let channels = layer.map_or(&[][..], |(_, channels)| channels);
                let shown = channels.iter().flatten().fold(0.0, |most: f32, id| most.max(*id)) as u32;
                Some((0..named.max(shown)).map(|id| names.material(id)).collect())
            }
            _ => None,
        }
    }

    /// The image without noise, by a denoiser of this name.
    fn denoised(&self, py: Python<'_>, with: &str) -> PyResult<Self> {
        let (image, with) = (Arc::clone(&self.image), denoiser_by_name(with)?);
        let denoised = task::call(py, move || Ok(image.denoised(with, library().as_deref(), &Control::default())?))?;
        Ok(Self::new(denoised, self.frame))
    }

    /// Saves the image; the extension selects the format.
    fn save(&self, py: Python<'_>, path: String) -> PyResult<()> {
        let image = Arc::clone(&self.image);
        task::call(py, move || Ok(image.save(path)?))
    }

    /// Bytes of an image file in the format of this extension, at most `most` pixels wide.
    fn encode<'py>(&self, py: Python<'py>, extension: &str, most: u32) -> PyResult<Bound<'py, PyBytes>> {
        let name = format!("image.{extension}");
        let format = ImageFormat::from_path(Path::new(&name)).map_err(|error| of_image(&error))?;
        let image = Arc::clone(&self.image);
        let bytes = task::call(py, move || Ok(image.encode(format, most)?))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// PNG of a layer, at most `most` pixels wide, with its numbers brought to the range of colors.
    fn thumbnail<'py>(&self, py: Python<'py>, name: String, most: u32) -> PyResult<Bound<'py, PyBytes>> {
        let image = Arc::clone(&self.image);
        let bytes = task::call(py, move || Ok(thumbnail(&image, &name)?.encode(ImageFormat::Png, most)?))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Name of the tone curve.
    #[getter]
    fn tone_curve(&self) -> String {
        let curve = serde_json::to_value(&self.image.header.tone.curve).unwrap_or_default();
        let kind = curve.as_object().and_then(|kinds| kinds.keys().next().cloned());
        kind.or_else(|| curve.as_str().map(str::to_owned)).unwrap_or_default()
    }

    /// 8-bit levels of all pixels, with another tone curve or exposure if given.
    fn to_rgb8<'py>(
        &self,
        py: Python<'py>,
        curve: Option<&str>,
        exposure: Option<f32>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let mut tone = self.image.header.tone.clone();
        if let Some(name) = curve {
            let kind: juggler::imaging::ToneCurveKind =
                by_name("tone curve", name).map_err(|error| convert(error.for_setting("tone")))?;
            tone.curve = kind.into();
        }
        tone.exposure_stops = exposure.unwrap_or(tone.exposure_stops);
        let image = Arc::clone(&self.image);
        let levels = task::call(py, move || Ok(image.to_rgb8(&tone)))?;
        Ok(PyBytes::new(py, &levels))
    }

    /// Everything that [`Image::from_state`] needs to make an equal image.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (header, stats) = (&self.image.header, self.image.stats());
        let all = PyDict::new(py);
        all.set_item("size", self.image.size())?;
        all.set_item("frame", self.frame)?;
        all.set_item("tone", serde_json::to_string(&header.tone).unwrap_or_default())?;
        all.set_item("metadata", &header.metadata)?;
        all.set_item("viewpoint", self.viewpoint())?;
        all.set_item("window", self.window())?;
        all.set_item("aovs", serde_json::to_string(&self.image.aovs().to_description()).unwrap_or_default())?;
        all.set_item("film", (&stats.film.hash, stats.film.mean, stats.film.clamped))?;
        all.set_item("samples", (stats.samples.min, stats.samples.mean, stats.samples.max))?;
        let RayCounts { camera, shadow, secondary, not_finite } = stats.rays;
        all.set_item("rays", (camera, shadow, secondary, not_finite))?;
        all.set_item("seconds", [stats.render, stats.denoise, stats.write].map(|time| time.as_secs_f64()))?;
        all.set_item("pixels", self.pixels(py)?)?;
        all.set_item("alpha", self.alpha(py)?)?;
        let channels = self.image.layers().flat_map(|(_, channels)| channels);
        let channels =
            channels.map(|channel| words(py, channel.len(), channel.iter().map(|value| value.to_ne_bytes())));
        all.set_item("channels", channels.collect::<PyResult<Vec<_>>>()?)?;
        Ok(all)
    }

    /// Makes an image of the state of another one.
    #[staticmethod]
    fn from_state(state: &Bound<'_, PyDict>) -> PyResult<Self> {
        let header = header(state)?;
        let film: (String, [f64; 3], f64) = item(state, "film")?;
        let (min, mean, max) = item(state, "samples")?;
        let (camera, shadow, secondary, not_finite) = item(state, "rays")?;
        let [render, denoise, write] = item::<[f64; 3]>(state, "seconds")?.map(Duration::from_secs_f64);
        let stats = RenderStats {
            film: juggler::camera::film::FilmSummary { hash: film.0, mean: film.1, clamped: film.2 },
            samples: SampleCountStats { min, mean, max },
            rays: RayCounts { camera, shadow, secondary, not_finite },
            render,
            denoise,
            write,
        };
        let description = serde_json::from_str(&item::<String>(state, "aovs")?).map_err(|_| broken())?;
        let aovs = AovSet::from_description(&description).map_err(convert)?;
        let pixels = floats(&item::<Vec<u8>>(state, "pixels")?);
        let pixels = pixels.as_chunks::<3>().0.iter().map(|pixel| Rgb::from(*pixel)).collect();
        let channels = item::<Vec<Vec<u8>>>(state, "channels")?.iter().map(|bytes| floats(bytes)).collect();
        let alpha = item::<Option<Vec<u8>>>(state, "alpha")?.map(|bytes| floats(&bytes));
        let header = Header { transparent: alpha.is_some(), ..header };
        let image = RenderedImage::from_parts(header, pixels, alpha, aovs, channels, stats).ok_or_else(broken)?;
        Ok(Self::new(image, item(state, "frame")?))
    }
}

/// Image of a layer: directions from -1 to 1 as colors from 0 to 1, other numbers relative to the
/// largest finite one.
fn thumbnail(image: &RenderedImage, name: &str) -> Result<RenderedImage, Error> {
    let layer = image.layers().find(|(layer, _)| layer.name == name);
    let channels = layer.map(|(_, channels)| channels).unwrap_or_default();
    let is_direction = name.ends_with("normal");
    let finite = channels.iter().flatten().filter(|value| value.is_finite());
    let most = finite.fold(0.0_f32, |most, value| most.max(*value)).max(f32::MIN_POSITIVE);
    let level = |value: f32| if is_direction { 0.5 + 0.5 * value } else { (value / most).clamp(0.0, 1.0) };
    let value = |channel: usize, at: usize| {
        let channel = channels.get(channel).or(if channels.len() == 1 { channels.first() } else { None });
        channel.and_then(|channel| channel.get(at)).map_or(0.0, |value| level(*value))
    };
    let pixels = (0..image.pixels().len()).map(|at| Rgb::new(value(0, at), value(1, at), value(2, at))).collect();
    let [width, height] = image.size();
    let made = RenderedImage::from_parts(
        Header::new(width, height),
        pixels,
        None,
        AovSet::default(),
        Vec::new(),
        image.stats().clone(),
    );
    made.ok_or_else(|| Error::setting("layer", format!("the image has no layer `{name}`")))
}

/// Header of the image with this state.
fn header(state: &Bound<'_, PyDict>) -> PyResult<Header> {
    let [width, height] = item(state, "size")?;
    let tone: Tone = serde_json::from_str(&item::<String>(state, "tone")?).map_err(|_| broken())?;
    let viewpoint: Option<Matrices> = item(state, "viewpoint")?;
    let viewpoint = viewpoint.map(|(world_to_camera, world_to_ndc)| Viewpoint { world_to_camera, world_to_ndc });
    let (frame, corner) = item(state, "window")?;
    let crop = CropFrame::new(frame, corner, [width, height]);
    Ok(Header { tone, metadata: item(state, "metadata")?, viewpoint, crop, ..Header::new(width, height) })
}

fn item<T: for<'a, 'py> FromPyObject<'a, 'py>>(state: &Bound<'_, PyDict>, name: &str) -> PyResult<T> {
    let item = state.get_item(name)?.ok_or_else(broken)?;
    item.extract().map_err(|_| broken())
}

fn broken() -> PyErr {
    settings_error("state", "the pickled image is damaged, or another version of juggler made it")
}

/// Whether a layer numbers objects, materials or instances.
fn is_index(layer: &str) -> bool {
    [Aov::ObjectId, Aov::MaterialId, Aov::InstanceId].iter().any(|aov| aov.name() == layer)
}

/// Bytes of `count` words.
pub fn words(py: Python<'_>, count: usize, words: impl Iterator<Item = [u8; 4]>) -> PyResult<Bound<'_, PyBytes>> {
    PyBytes::new_with(py, count * 4, |bytes| {
        bytes.as_chunks_mut::<4>().0.iter_mut().zip(words).for_each(|(place, word)| *place = word);
        Ok(())
    })
}

/// Floats of their bytes.
pub fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks::<4>().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()
}
