//! Reading of layer names and single layers of EXR files.

use crate::codec::exr::{read_headers, unreadable};
use crate::input::{open, source};
use crate::{ImageError, ImageFormat, Limits};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel};
use std::io::{BufRead, Seek};
use std::path::Path;

/// Width and height of a layer, and three values per pixel, row by row.
pub type LayerValues = (u32, u32, Vec<[f32; 3]>);

/// Name and channels of an EXR layer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerName {
    /// Layer name: the channel name up to its last dot, else the name of the part, else empty.
    pub name: String,
    /// Channel names without the layer name, such as `R`, ordered red, green, blue, alpha, then as
    /// in the file.
    pub channels: Vec<String>,
}

/// Reads the layer names of an EXR file in file order; empty for other formats.
pub fn layer_names(path: &Path) -> Result<Vec<LayerName>, ImageError> {
    let file = path.display().to_string();
    let mut bytes = open(path)?;
    let limits = Limits::default();
    let source = source(&file, &mut bytes, &limits)?;
    if source.format != ImageFormat::Exr {
        return Ok(Vec::new());
    }
    let mut layers: Vec<LayerName> = Vec::new();
    for header in &read_headers(source, &mut bytes)? {
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

/// Reads up to three channels of an EXR file, such as `variance.R`, `variance.G` and `variance.B`;
/// the first channel replaces missing ones. `None` if the file is not an EXR or no part has these
/// channels.
pub fn read_layer(path: &Path, channels: &[&str]) -> Result<Option<LayerValues>, ImageError> {
    let file = path.display().to_string();
    let mut bytes = open(path)?;
    let limits = Limits::default();
    let source = source(&file, &mut bytes, &limits)?;
    if source.format != ImageFormat::Exr {
        return Ok(None);
    }
    let [Some(first), second, third] = [0, 1, 2].map(|number| channels.get(number).copied()) else { return Ok(None) };
    let names = [first, second.unwrap_or(first), third.unwrap_or(first)];
    let has =
        |header: &&Header| names.iter().all(|name| header.channels.list.iter().any(|channel| channel.name == **name));
    let headers = read_headers(source, &mut bytes)?;
    let Some(header) = headers.iter().filter(|header| !header.deep).find(has) else { return Ok(None) };
    let values =
        if second.is_none() { read_one_channel(&mut bytes, first) } else { read_three_channels(&mut bytes, names) };
    let values = values.map_err(|error| unreadable(source, error))?;
    // `read_headers` has checked that the sides fit 32 bits.
    Ok(Some((header.layer_size.0 as u32, header.layer_size.1 as u32, values)))
}

type Values = (usize, Vec<[f32; 3]>);

fn allocate(size: Vec2<usize>) -> Values {
    (size.0, vec![[0.0; 3]; size.0.saturating_mul(size.1)])
}

fn put((width, values): &mut Values, position: Vec2<usize>, value: [f32; 3]) {
    if let Some(target) = values.get_mut(position.1 * *width + position.0) {
        *target = value;
    }
}

fn read_one_channel(bytes: &mut (impl BufRead + Seek + Send), name: &str) -> Result<Vec<[f32; 3]>, ExrError> {
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels().required(name);
    let reader = reader.collect_pixels(
        |size, _| allocate(size),
        |values: &mut Values, position, (value,): (f32,)| put(values, position, [value; 3]),
    );
    let image = reader.first_valid_layer().all_attributes().non_parallel().from_buffered(bytes)?;
    Ok(image.layer_data.channel_data.pixels.1)
}

fn read_three_channels(bytes: &mut (impl BufRead + Seek + Send), names: [&str; 3]) -> Result<Vec<[f32; 3]>, ExrError> {
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels();
    let reader = reader.required(names[0]).required(names[1]).required(names[2]).collect_pixels(
        |size, _| allocate(size),
        |values: &mut Values, position, (r, g, b): (f32, f32, f32)| put(values, position, [r, g, b]),
    );
    let image = reader.first_valid_layer().all_attributes().non_parallel().from_buffered(bytes)?;
    Ok(image.layer_data.channel_data.pixels.1)
}
