//! Reading of layer names and single layers of EXR files.

use crate::codec::ReadSeek;
use crate::codec::exr::{Placement, placement, read_headers, unreadable};
use crate::input::{open, source};
use crate::{ImageError, ImageFormat, Limits};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel};
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
    let placement = placement(source, header)?;
    let names = if second.is_none() { &names[..1] } else { &names };
    let values = read_channels(&mut bytes, names, placement);
    let values = values.map_err(|error| unreadable(source, error))?;
    let (width, height) = placement.size();
    Ok(Some((width, height, values)))
}

/// Reads one channel, three times per pixel, or three different channels, within the display
/// window; values outside of the data window are 0.
pub(crate) fn read_channels(
    bytes: &mut dyn ReadSeek,
    names: &[&str],
    placement: Placement,
) -> Result<Vec<[f32; 3]>, ExrError> {
    let allocate = move || vec![[0.0; 3]; placement.pixels()];
    let put = move |values: &mut Vec<[f32; 3]>, position: Vec2<usize>, value: [f32; 3]| {
        if let Some(target) = placement.index(position).and_then(|index| values.get_mut(index)) {
            *target = value;
        }
    };
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels();
    match names {
        [red, green, blue] => {
            let reader = reader.required(*red).required(*green).required(*blue).collect_pixels(
                move |_, _| allocate(),
                move |values, position, (r, g, b): (f32, f32, f32)| put(values, position, [r, g, b]),
            );
            let image = reader.first_valid_layer().all_attributes().non_parallel().from_buffered(&mut *bytes)?;
            Ok(image.layer_data.channel_data.pixels)
        }
        names => {
            let reader = reader.required(names.first().copied().unwrap_or_default()).collect_pixels(
                move |_, _| allocate(),
                move |values, position, (value,): (f32,)| put(values, position, [value; 3]),
            );
            let image = reader.first_valid_layer().all_attributes().non_parallel().from_buffered(&mut *bytes)?;
            Ok(image.layer_data.channel_data.pixels)
        }
    }
}
