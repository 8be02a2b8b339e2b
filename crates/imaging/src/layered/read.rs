//! Names of an EXR's layers, and one of them read by the names of its channels.

use crate::codec::exr::{heads, unreadable};
use crate::input::{open, source};
use crate::{Format, ImageError, Limits};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel};
use std::io::{BufRead, Seek};
use std::path::Path;

/// A layer's width, height, and one value after the other for each pixel, row by row.
pub type LayerValues = (u32, u32, Vec<[f32; 3]>);

/// One layer of an EXR as its head names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerName {
    /// Name: what stands before a channel's last dot, or else the name of the file's part; empty where there is neither.
    pub name: String,
    /// Channels without that name, such as `R`, in the order red, green, blue, alpha, then by the alphabet.
    pub channels: Vec<String>,
}

/// Reads the names of all layers of an EXR, in the file's order. None for a file of another format.
pub fn layer_names(path: &Path) -> Result<Vec<LayerName>, ImageError> {
    let place = path.display().to_string();
    let mut bytes = open(path)?;
    let limits = Limits::default();
    let source = source(&place, &mut bytes, &limits)?;
    if source.format != Format::Exr {
        return Ok(Vec::new());
    }
    let mut layers: Vec<LayerName> = Vec::new();
    for header in &heads(source, &mut bytes)? {
        let part = header.own_attributes.layer_name.as_ref().map_or_else(String::new, ToString::to_string);
        for channel in &header.channels.list {
            let full = channel.name.to_string();
            let (name, channel) = full.rsplit_once('.').unwrap_or((&part, &full));
            match layers.iter_mut().find(|layer| layer.name == name) {
                Some(layer) => layer.channels.push(channel.to_owned()),
                None => layers.push(LayerName { name: name.to_owned(), channels: vec![channel.to_owned()] }),
            }
        }
    }
    let place_of = |channel: &String| ["R", "G", "B", "A"].iter().position(|known| known == channel).unwrap_or(4);
    layers.iter_mut().for_each(|layer| layer.channels.sort_by_key(place_of));
    Ok(layers)
}

/// Reads what stands in up to three channels, such as `variance.R`, `variance.G` and `variance.B`; where fewer are named, the first
/// of them stands for the others. `None` where the file is no EXR, or none of its layers has them.
pub fn read_layer(path: &Path, channels: &[&str]) -> Result<Option<LayerValues>, ImageError> {
    let place = path.display().to_string();
    let mut bytes = open(path)?;
    let limits = Limits::default();
    let source = source(&place, &mut bytes, &limits)?;
    if source.format != Format::Exr {
        return Ok(None);
    }
    let [Some(first), second, third] = [0, 1, 2].map(|number| channels.get(number).copied()) else { return Ok(None) };
    let names = [first, second.unwrap_or(first), third.unwrap_or(first)];
    let has =
        |header: &&Header| names.iter().all(|name| header.channels.list.iter().any(|channel| channel.name == **name));
    let heads = heads(source, &mut bytes)?;
    let Some(head) = heads.iter().filter(|head| !head.deep).find(has) else { return Ok(None) };
    let values = if second.is_none() { one(&mut bytes, first) } else { three(&mut bytes, names) };
    let values = values.map_err(|error| unreadable(source, error))?;
    // The sides were checked to fit 32 bits.
    Ok(Some((head.layer_size.0 as u32, head.layer_size.1 as u32, values)))
}

type Values = (usize, Vec<[f32; 3]>);

fn room(size: Vec2<usize>) -> Values {
    (size.0, vec![[0.0; 3]; size.0.saturating_mul(size.1)])
}

fn put((width, values): &mut Values, position: Vec2<usize>, value: [f32; 3]) {
    if let Some(place) = values.get_mut(position.1 * *width + position.0) {
        *place = value;
    }
}

fn one(bytes: &mut (impl BufRead + Seek + Send), name: &str) -> Result<Vec<[f32; 3]>, ExrError> {
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels().required(name);
    let reader = reader.collect_pixels(
        |size, _| room(size),
        |values: &mut Values, position, (value,): (f32,)| put(values, position, [value; 3]),
    );
    let image = reader.first_valid_layer().all_attributes().non_parallel().from_buffered(bytes)?;
    Ok(image.layer_data.channel_data.pixels.1)
}

fn three(bytes: &mut (impl BufRead + Seek + Send), names: [&str; 3]) -> Result<Vec<[f32; 3]>, ExrError> {
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels();
    let reader = reader.required(names[0]).required(names[1]).required(names[2]).collect_pixels(
        |size, _| room(size),
        |values: &mut Values, position, (r, g, b): (f32, f32, f32)| put(values, position, [r, g, b]),
    );
    let image = reader.first_valid_layer().all_attributes().non_parallel().from_buffered(bytes)?;
    Ok(image.layer_data.channel_data.pixels.1)
}
