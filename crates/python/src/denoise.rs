//! Denoising of arrays of any origin.

use crate::image::{floats, words};
use crate::settings::denoiser_by_name;
use crate::task;
use juggler::denoise::{NoisyPixels, PixelFeatures, denoise_pixels};
use juggler::math::{Rgb, Vec3};
use juggler::render::{Cancelled, Control};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;

/// Path of Open Image Denoise, which an environment variable gives where the system does not find it.
pub fn library() -> Option<PathBuf> {
    std::env::var_os("JUGGLER_OIDN").map(PathBuf::from)
}

/// Denoises pixels of this width and height: the bytes of 3 floats each, or twice as many for two
/// halves. The features are bytes of 3 floats, the depth of 1, for each pixel.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "these are the keywords of a function for users")]
pub fn denoise<'py>(
    py: Python<'py>,
    size: [u32; 2],
    color: &[u8],
    has_halves: bool,
    albedo: Option<&[u8]>,
    normal: Option<&[u8]>,
    depth: Option<&[u8]>,
    with: &str,
) -> PyResult<Bound<'py, PyBytes>> {
    let with = denoiser_by_name(with)?;
    let color: Vec<Rgb> = triples(color).collect();
    let albedo: Option<Vec<Rgb>> = albedo.map(|bytes| triples(bytes).collect());
    let normal: Option<Vec<Vec3>> = normal.map(|bytes| triples(bytes).collect());
    let depth = depth.map(floats);
    let pixels = task::call(py, move || {
        let features = PixelFeatures { albedo: albedo.as_deref(), normal: normal.as_deref(), depth: depth.as_deref() };
        let (a, b) = color.split_at(color.len() / 2);
        let noisy = if has_halves { NoisyPixels::Halves([a, b]) } else { NoisyPixels::Whole(&color) };
        let denoised = denoise_pixels(size, noisy, &features, with, library().as_deref(), &Control::default())?;
        Ok(denoised.ok_or(Cancelled)?.pixels)
    })?;
    words(py, pixels.len() * 3, pixels.iter().flat_map(|pixel| pixel.to_array()).map(f32::to_ne_bytes))
}

/// Triples of floats.
fn triples<T: From<[f32; 3]>>(bytes: &[u8]) -> impl Iterator<Item = T> {
    floats(bytes).as_chunks::<3>().0.to_vec().into_iter().map(T::from)
}
