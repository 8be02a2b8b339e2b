//! Comparison of two images.

use crate::errors::settings_error;
use crate::image::Image;
use crate::task::{self, Fault};
use juggler::comparison::{self, ComparedImage, NoiseTest};
use juggler::imaging::Difference;
use juggler::imaging::flip::Flip;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::PathBuf;
use std::sync::Arc;

/// Reason for images that are equal or have no variances.
const NO_VARIANCES: &str = "the images have no variances: render both with `aovs=[\"variance\"]` and another seed";

/// An image that is rendered, or a file.
#[derive(FromPyObject)]
pub enum Source {
    /// Rendered image.
    Image(Py<Image>),
    /// Image file, or partial render of a whole image.
    File(PathBuf),
}

/// All results of a comparison.
struct Compared {
    difference: Difference,
    flip: Option<Flip>,
    noise: Option<NoiseTest>,
    size: [u32; 2],
}

/// Compares an image with a reference, and tests whether noise explains the difference.
#[pyfunction]
pub fn compare<'py>(
    py: Python<'py>,
    image: Source,
    reference: Source,
    significance: f64,
    with_flip: bool,
) -> PyResult<Bound<'py, PyDict>> {
    if !(significance > 0.0 && significance < 1.0) {
        let message = format!("`significance` must lie between 0 and 1, not {significance}");
        return Err(settings_error("significance", message));
    }
    let sources = [source(image), source(reference)];
    let compared = task::call(py, move || {
        let [image, reference] = sources.map(|read| read());
        measure(&image?, &reference?, significance, with_flip)
    })?;
    let Compared { difference: Difference { rmse, relative_mse, largest, same_bits, .. }, flip, noise, size } =
        compared;
    let all = PyDict::new(py);
    all.set_item("same_bits", same_bits)?;
    all.set_item("rmse", rmse)?;
    all.set_item("relative_mse", relative_mse)?;
    all.set_item("largest", largest)?;
    all.set_item("size", size)?;
    all.set_item("flip", flip.as_ref().map(|flip| flip.mean))?;
    let map = flip.map(|flip| flip.map.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<u8>>());
    all.set_item("flip_map", map.map(|bytes| PyBytes::new(py, &bytes)))?;
    let (is_same, p, reason) = match noise {
        _ if same_bits => (Some(true), None, Some("the images are equal to the bit".to_owned())),
        None => (None, None, Some(NO_VARIANCES.to_owned())),
        // The program's flag is a setting here.
        Some(NoiseTest::Untested(reason)) => (None, None, Some(reason.replace("--seed", "`seed`"))),
        Some(test) => {
            let note = if let NoiseTest::Tested { note, .. } = &test { note.map(str::to_owned) } else { None };
            (test.is_same(), test.p(), note)
        }
    };
    all.set_item("same_but_for_noise", is_same)?;
    all.set_item("p", p)?;
    all.set_item("reason", reason)?;
    Ok(all)
}

/// Function that reads the image on another thread.
fn source(source: Source) -> Box<dyn FnOnce() -> Result<ComparedImage, Fault> + Send> {
    match source {
        Source::Image(image) => {
            let image = Arc::clone(&image.get().image);
            Box::new(move || Ok(ComparedImage::from_rendered(&image)))
        }
        Source::File(path) => Box::new(move || ComparedImage::read(&path).map_err(Fault::from)),
    }
}

fn measure(a: &ComparedImage, b: &ComparedImage, significance: f64, with_flip: bool) -> Result<Compared, Fault> {
    let difference = comparison::difference(a, b)?;
    let flip = with_flip.then(|| comparison::perceived_difference(a, b)).transpose()?;
    let noise = if difference.same_bits { None } else { NoiseTest::new(a, b, significance) };
    Ok(Compared { difference, flip, noise, size: [b.image.width(), b.image.height()] })
}
