//! `--max-memory`: estimates the memory of a render before large files are read, makes it fit, and
//! suggests what to change if it cannot.

use crate::encoding::{Encoding, OutputKind};
use crate::failure::Failure;
use crate::format::bytes;
use crate::output::STANDARD_OUTPUT;
use crate::plan::{FrameOutput, Plan, Shard};
use juggler::Limit;
use juggler::denoise::DenoiserInput;
use juggler::imaging::Header;
use juggler::memory::{Effort, Memory, MemoryPart, sum};
use juggler::render::BAND_PIXELS;
use juggler::scene::Scene;

/// Minimum number of samples per pixel for automatic checkpoints of a movie's frames. Saving takes
/// as long as a third of a sample, and shorter renders are quickly repeated.
const MIN_CHECKPOINT_SAMPLES: u32 = 8;

/// Maximum number of components that a refusal lists.
const MAX_LISTED: usize = 8;

/// Memory estimate of a picture, before its files are read.
pub fn estimate(plan: &Plan, scene: &Scene, frame_output: &FrameOutput) -> Result<Memory, Failure> {
    let mut memory = Memory::estimate(scene, &plan.settings)?;
    if plan.needs_film(scene, frame_output) {
        // Numbers of samples read from a file may reach the maximum in every tile.
        let (crop, shards) =
            if plan.samples_from.is_some() { (None, 1) } else { (plan.cut.crop, frame_output.shard.count) };
        memory = memory.with_film(crop, plan.cut.samples.clone(), shards);
    }
    if plan.settings.denoiser.is_some() {
        let pixel = DenoiserInput::bytes_per_pixel(plan.settings.transparent_of(scene));
        let bytes = memory.region().area().saturating_mul(pixel);
        memory = memory.with_part("denoising", bytes);
    }
    if let OutputKind::Picture(Encoding { format, options }) = plan.output_kind {
        let (width, height) = (memory.region().width, memory.region().height);
        format.check_dimensions(width, height)?;
        let transparent = plan.settings.transparent_of(scene);
        let header = Header { options, transparent, ..Header::new(width, height) };
        let file = format.memory_needed(&header, frame_output.output != STANDARD_OUTPUT);
        memory = memory.with_part(format!("the {format} file"), file);
        // A shard renders frames and encodes no movie.
        if let Some(movie) = plan.movie.as_ref().filter(|_| plan.shard == Shard::WHOLE) {
            memory = memory.with_part(format!("the {} movie", movie.format), movie.format.memory_needed(width, height));
        }
    }
    Ok(memory)
}

/// Memory estimate of a picture, the threads and bands with which it fits, and the shot. The shot
/// of a movie's frame has no checkpoint if the checkpoint is not worthwhile or does not fit.
pub fn fit(plan: &Plan, scene: &Scene, frame_output: &FrameOutput) -> Result<(Memory, Effort, FrameOutput), Failure> {
    let is_automatic = plan.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_automatic);
    let without =
        FrameOutput { checkpoint: frame_output.checkpoint.clone().filter(|_| !is_automatic), ..frame_output.clone() };
    if plan.settings.samples_of(scene) >= MIN_CHECKPOINT_SAMPLES {
        let memory = estimate(plan, scene, frame_output)?;
        match effort(plan, &memory, plan.threads) {
            Err(_) if frame_output.checkpoint != without.checkpoint => {}
            effort => return Ok((memory, effort?, frame_output.clone())),
        }
    }
    let memory = estimate(plan, scene, &without)?;
    let effort = effort(plan, &memory, plan.threads)?;
    Ok((memory, effort, without))
}

/// Threads and bands with which a render fits.
pub fn effort(plan: &Plan, memory: &Memory, threads: usize) -> Result<Effort, Failure> {
    let Some(most) = plan.max_memory else { return Ok(Effort { threads, band_pixels: BAND_PIXELS }) };
    memory.fit(most, threads).map_err(|parts| refused(plan, &parts, most))
}

fn refused(plan: &Plan, parts: &[MemoryPart], most: u64) -> Failure {
    let needed = sum(parts);
    let mut parts: Vec<&MemoryPart> = parts.iter().collect();
    parts.sort_by_key(|part| std::cmp::Reverse(part.bytes));
    let (listed, others) = parts.split_at(parts.len().min(MAX_LISTED));
    let mut each: Vec<String> = listed.iter().map(|part| format!("{} for {}", bytes(part.bytes), part.what)).collect();
    if !others.is_empty() {
        let rest = others.iter().map(|part| part.bytes).fold(0, u64::saturating_add);
        each.push(format!("{} for {} others", bytes(rest), others.len()));
    }
    let help = parts.first().map(|largest| help(plan, largest, needed, most)).unwrap_or_default();
    Failure::Invalid(format!(
        "the render needs about {} of memory ({}), more than --max-memory {}{help}",
        bytes(needed),
        each.join(", "),
        bytes(most)
    ))
}

/// Advice on how to reduce the largest part of the estimate.
fn help(plan: &Plan, largest: &MemoryPart, needed: u64, most: u64) -> String {
    let shards = needed.div_ceil(most.max(1)).saturating_mul(2);
    let advice = match largest.what.as_str() {
        "the film" if plan.settings.limit != Limit::Samples => {
            "a film with so many samples holds several sums per pixel; a lower maximum (`--samples`) needs less, as does a \
             smaller `--size`"
                .into()
        }
        "the film" if plan.output_kind == OutputKind::PartialRender => {
            format!("more and smaller shards need less, such as `--shard 0/{shards}`; so does a smaller `--size`")
        }
        "the film" => format!(
            "a whole film in memory needs at least 36 bytes per pixel; `--checkpoint`, `--noise`, `--time` and \
             `--samples-from` require it; partial renders (`--shard 0/{shards} -o part.jfilm`) need less, as does a smaller `--size`"
        ),
        movie if movie.ends_with(" movie") => {
            "a movie in another format (.webp .apng .gif) may need less; so do numbered pictures and a smaller `--size`"
                .into()
        }
        file if file.ends_with(" file") => {
            "PNG, EXR, HDR and PFM files are written row by row and need less, as does a smaller `--size`".into()
        }
        picture if picture.starts_with("the picture `") => "pictures with fewer pixels need less".into(),
        mesh if mesh.contains("mesh") || mesh.contains("trees") => "a mesh of fewer triangles needs less".into(),
        _ => return String::new(),
    };
    format!("\nhelp: {advice}")
}
