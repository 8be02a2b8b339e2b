//! Limits of threads and memory.

use crate::errors::{convert, memory_error};
use crate::settings::RenderSettings;
use crate::threads;
use juggler::denoise::DenoiserInput;
use juggler::memory::{Effort, Memory, MemoryPart, model_bytes, sum};
use juggler::render::BAND_PIXELS;
use juggler::scene::Scene;
use juggler::{Limit, Settings};
use pyo3::prelude::*;

/// Bytes per pixel of the image in memory.
const PIXEL: u64 = 12;

/// Number of threads of a render, and of the pixels in memory at once. Fails if the render needs
/// more memory than the limit.
pub fn effort(scene: &Scene, settings: &RenderSettings) -> PyResult<Effort> {
    let threads = threads::thread_count(settings.threads)?;
    let Some(most) = settings.max_memory else { return Ok(Effort { threads, band_pixels: BAND_PIXELS }) };
    let models = model_bytes(&scene.model_needs());
    if models > most {
        let (models, most) = (bytes(models), bytes(most));
        let message = format!("the models of the scene need about {models} of memory to be read");
        return Err(memory_error(&format!("{message}, more than `max_memory` of {most}")));
    }
    let memory = estimate(scene, &settings.settings).map_err(convert)?;
    memory.fit(most, threads).map_err(|parts| memory_error(&message(&parts, most)))
}

fn estimate(scene: &Scene, settings: &Settings) -> Result<Memory, juggler::Error> {
    let mut memory = Memory::estimate(scene, settings)?;
    let area = memory.region().area();
    memory = memory.with_part("the picture", area.saturating_mul(PIXEL));
    if settings.limit != Limit::Samples || !settings.aovs.is_empty() || settings.denoiser.is_some() {
        memory = memory.with_film(None, None, 1);
    }
    if settings.denoiser.is_some() {
        let bytes = DenoiserInput::bytes_per_pixel(settings.transparent_of(scene));
        memory = memory.with_part("denoising", area.saturating_mul(bytes));
    }
    Ok(memory)
}

fn message(parts: &[MemoryPart], most: u64) -> String {
    let mut parts: Vec<&MemoryPart> = parts.iter().collect();
    parts.sort_by_key(|part| std::cmp::Reverse(part.bytes));
    let each: Vec<String> = parts.iter().map(|part| format!("{} for {}", bytes(part.bytes), part.what)).collect();
    let needed = sum(&parts.into_iter().cloned().collect::<Vec<_>>());
    format!(
        "the render needs about {} of memory ({}), more than `max_memory` of {}; a smaller `size` needs less",
        bytes(needed),
        each.join(", "),
        bytes(most)
    )
}

/// `850 bytes`, `12.3 MiB`.
fn bytes(count: u64) -> String {
    let units = [(1_u64 << 40, "TiB"), (1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    match units.into_iter().find(|(size, _)| count >= *size) {
        Some((size, unit)) => format!("{:.1} {unit}", count as f64 / size as f64),
        None => format!("{count} bytes"),
    }
}
