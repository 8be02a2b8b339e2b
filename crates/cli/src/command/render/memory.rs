//! `--max-memory`: what a render takes, told before anything large is read, how it is made to fit, and what to say when
//! it cannot.

use crate::failure::Failure;
use crate::format::bytes;
use crate::output::STANDARD_OUTPUT;
use crate::plan::{Encoding, Plan, Product, Shard, Shot};
use juggler::Limit;
use juggler::denoise::Guides;
use juggler::imaging::Header;
use juggler::memory::{Effort, Memory, Part, sum};
use juggler::render::BAND_PIXELS;
use juggler::scene::Scene;

/// Samples of a pixel from which on a film's frame is kept while it is under way: that takes as long as a third of a sample, and
/// what has fewer is soon begun anew.
const WORTH_KEEPING: u32 = 8;

/// What a picture of a plan takes, before its files are read.
pub fn of(plan: &Plan, scene: &Scene, shot: &Shot) -> Result<Memory, Failure> {
    let mut memory = Memory::of(scene, &plan.settings)?;
    if plan.needs_film(shot) {
        // Numbers of samples may come from a file: then all the film may get that many.
        let (crop, shards) = if plan.samples_from.is_some() { (None, 1) } else { (plan.cut.crop, shot.shard.count) };
        memory = memory.on_film(crop, plan.cut.samples.clone(), shards);
    }
    if plan.settings.denoiser.is_some() {
        let bytes = memory.region().area().saturating_mul(Guides::BYTES);
        memory = memory.and("taking the noise out", bytes);
    }
    if let Product::Picture(Encoding { format, options }) = plan.product {
        let (width, height) = (memory.region().width, memory.region().height);
        format.check_dimensions(width, height)?;
        let header = Header { options, ..Header::new(width, height) };
        let file = format.memory_needed(&header, shot.output != STANDARD_OUTPUT);
        memory = memory.and(format!("the {format} file"), file);
        // A shard makes pictures alone.
        if let Some(reel) = plan.reel.as_ref().filter(|_| plan.shard == Shard::WHOLE) {
            memory = memory.and(format!("the {} film", reel.format), reel.format.memory_needed(width, height));
        }
    }
    Ok(memory)
}

/// What a picture takes and with which effort it fits. A film's frame that is not worth a checkpoint, or for whose
/// checkpoint there is no room, is made without one.
pub fn fitting(plan: &Plan, scene: &Scene, shot: &Shot) -> Result<(Memory, Effort, Shot), Failure> {
    let is_own = plan.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_own);
    let without = Shot { checkpoint: shot.checkpoint.clone().filter(|_| !is_own), ..shot.clone() };
    if plan.settings.samples_of(scene) >= WORTH_KEEPING {
        let memory = of(plan, scene, shot)?;
        match effort(plan, &memory, plan.threads) {
            Err(_) if shot.checkpoint != without.checkpoint => {}
            effort => return Ok((memory, effort?, shot.clone())),
        }
    }
    let memory = of(plan, scene, &without)?;
    let effort = effort(plan, &memory, plan.threads)?;
    Ok((memory, effort, without))
}

/// The threads and bands with which a render fits.
pub fn effort(plan: &Plan, memory: &Memory, threads: usize) -> Result<Effort, Failure> {
    let Some(most) = plan.max_memory else { return Ok(Effort { threads, band_pixels: BAND_PIXELS }) };
    memory.fit(most, threads).map_err(|parts| refused(plan, &parts, most))
}

fn refused(plan: &Plan, parts: &[Part], most: u64) -> Failure {
    let needed = sum(parts);
    let mut parts: Vec<&Part> = parts.iter().collect();
    parts.sort_by_key(|part| std::cmp::Reverse(part.bytes));
    let each: Vec<String> = parts.iter().map(|part| format!("{} for {}", bytes(part.bytes), part.what)).collect();
    let help = parts.first().map(|largest| help(plan, largest, needed, most)).unwrap_or_default();
    Failure::Wrong(format!(
        "the render needs about {} of memory ({}), more than --max-memory {}{help}",
        bytes(needed),
        each.join(", "),
        bytes(most)
    ))
}

/// What would make the largest part smaller.
fn help(plan: &Plan, largest: &Part, needed: u64, most: u64) -> String {
    let shards = needed.div_ceil(most.max(1)).saturating_mul(2);
    let advice = match largest.what.as_str() {
        "the film" if plan.settings.limit != Limit::Samples => {
            "a film with so many samples holds several sums a pixel; a lower bound (`--samples`) needs less, as does a \
             smaller `--size`"
                .into()
        }
        "the film" if plan.product == Product::Part => {
            format!("more and smaller parts need less, such as `--shard 0/{shards}`; so does a smaller `--size`")
        }
        "the film" => format!(
            "a kept film needs 36 bytes a pixel and more; without `--checkpoint`, `--noise`, `--time` and \
             `--samples-from` there is none; parts (`--shard 0/{shards} -o part.jfilm`) need less, as does a smaller `--size`"
        ),
        film if film.ends_with(" film") => {
            "a film of another format (.webp .apng .gif) may need less; so do numbered pictures and a smaller `--size`"
                .into()
        }
        file if file.ends_with(" file") => {
            "PNG, EXR, HDR and PFM files are written row by row and need less, as does a smaller `--size`".into()
        }
        mesh if mesh.contains("mesh") || mesh.contains("trees") => "a mesh of fewer triangles needs less".into(),
        _ => return String::new(),
    };
    format!("\nhelp: {advice}")
}
