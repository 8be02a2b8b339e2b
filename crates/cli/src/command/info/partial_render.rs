//! `juggler info part.jfilm`: contents of a partial render, after a check of all its bytes.

use super::rows::row;
use crate::failure::Failure;
use crate::format::bytes;
use juggler::camera::film::Rect;
use juggler::film::{PartialRender, RenderDescription, ShardDescription, Stop};
use serde_json::json;
use std::path::Path;

/// Maximum number of samples per pixel, so in effect no limit.
const MOST_SAMPLES: u32 = 1 << 24;

/// Summary of the tiles of a partial render.
struct Contents {
    /// Number of tiles with samples.
    tiles: usize,
    /// Minimum and maximum number of samples per pixel over the tiles.
    samples: [u32; 2],
}

/// Report as text or as one JSON object.
pub fn text(path: &Path, json: bool) -> Result<String, Failure> {
    let partial_render = PartialRender::open(path)?;
    let contents = contents(&partial_render)?;
    Ok(if json { to_json(&partial_render, &contents) } else { to_words(&partial_render, &contents) })
}

fn contents(partial_render: &PartialRender) -> Result<Contents, Failure> {
    let mut reader = partial_render.reader()?;
    let mut samples = [u32::MAX, 0];
    for number in partial_render.tiles() {
        let tile = reader.tile(number)?;
        let own = tile.runs().iter().map(|run| run.samples.end - run.samples.start).sum();
        samples = [samples[0].min(own), samples[1].max(own)];
    }
    Ok(Contents { tiles: partial_render.tiles().len(), samples: [samples[0].min(samples[1]), samples[1]] })
}

fn to_words(partial_render: &PartialRender, contents: &Contents) -> String {
    let RenderDescription { size: [width, height], region, samples, stop, shard, .. } = partial_render.description();
    let [fewest, most] = contents.samples;
    let of = partial_render.description().tiling().tile_count();
    let mut lines = vec![partial_render.name().to_owned()];
    let mut say = |key: &str, value: String| lines.push(row(key, &value));
    let finished = if partial_render.description().finished { "finished" } else { "not finished" };
    say("shard", format!("{}, {finished}", describe_shard(shard, *samples)));
    say("picture", format!("{width}x{height}{}, {}", crop_text(region, *width, *height), goal(*stop, *samples)));
    say("scene", format!("{}, frame {}", partial_render.description().scene, partial_render.description().frame));
    say("tiles", format!("{} of {of}", contents.tiles));
    say("samples", if fewest == most { most.to_string() } else { format!("{fewest} to {most} per pixel") });
    say("file", bytes(partial_render.bytes()));
    say("command", partial_render.description().command.clone());
    for (key, text) in &partial_render.description().metadata {
        say(key, text.clone());
    }
    for (name, value) in &partial_render.description().fingerprint {
        say("fingerprint", format!("{name} {value}"));
    }
    lines.join("\n")
}

/// `3/40`, `whole` or `some tiles`, and the crop and sample range if there are any.
fn describe_shard(shard: &ShardDescription, all: u32) -> String {
    let ShardDescription { index, count, samples, crop, units } = shard;
    let mut text = if *count > 1 {
        format!("{index}/{count}")
    } else if units.is_empty() {
        "whole".to_owned()
    } else {
        "some tiles".to_owned()
    };
    if *samples != (0..all) {
        text += &format!(" of samples {}..{}", samples.start, samples.end);
    }
    if let Some(Rect { x, y, width, height }) = crop {
        text += &format!(" of the crop {x},{y},{width},{height}");
    }
    text
}

fn crop_text(region: &Rect, width: u32, height: u32) -> String {
    let Rect { x, y, width: w, height: h } = *region;
    if *region == (Rect { x: 0, y: 0, width, height }) { String::new() } else { format!(", its crop {x},{y},{w},{h}") }
}

fn goal(stop: Stop, samples: u32) -> String {
    match stop {
        Stop::Samples => format!("{samples} samples"),
        Stop::Noise { level } => format!("until the noise is {level}, at most {samples} samples"),
        Stop::Time { seconds } if samples == MOST_SAMPLES => format!("{seconds} s"),
        Stop::Time { seconds } => format!("{seconds} s, at most {samples} samples"),
    }
}

fn to_json(partial_render: &PartialRender, contents: &Contents) -> String {
    json!({
        "version": 1,
        "file": partial_render.name(),
        "bytes": partial_render.bytes(),
        "tiles": contents.tiles,
        "samples": contents.samples,
        "part": partial_render.description(),
    })
    .to_string()
}
