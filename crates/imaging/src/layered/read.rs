//! Reading one layer of an EXR by the names of its channels.

use crate::input::{open, sniff};
use crate::{Format, ImageError, Limits};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel};
use std::io::{BufRead, Seek};
use std::path::Path;

/// A layer's width, height, and one value after the other for each pixel, row by row.
pub type LayerValues = (u32, u32, Vec<[f32; 3]>);

/// Reads what stands in up to three channels, such as `variance.R`, `variance.G` and `variance.B`; where fewer are named, the first
/// of them stands for the others. `None` where the file is no EXR, or none of its layers has them.
pub fn read_layer(path: &Path, channels: &[&str]) -> Result<Option<LayerValues>, ImageError> {
    let place = path.display().to_string();
    let mut bytes = open(path)?;
    if sniff(&place, &mut bytes)? != Format::Exr {
        return Ok(None);
    }
    let [Some(first), second, third] = [0, 1, 2].map(|number| channels.get(number).copied()) else { return Ok(None) };
    let names = [first, second.unwrap_or(first), third.unwrap_or(first)];
    let wrong = |error: ExrError| match error {
        ExrError::Io(source) => ImageError::Read { place: place.clone(), source },
        other => ImageError::Malformed { place: place.clone(), format: Format::Exr, message: other.to_string() },
    };
    let Some(size) = size_of(&mut bytes, &names).map_err(wrong)? else { return Ok(None) };
    let (width, height) = (size.0 as u64, size.1 as u64);
    let Limits { most_pixels } = Limits::default();
    if width.saturating_mul(height) > most_pixels {
        return Err(ImageError::TooLarge { place, width, height, most_pixels });
    }
    bytes.rewind().map_err(|source| ImageError::Read { place: place.clone(), source })?;
    let values = if second.is_none() { one(&mut bytes, first) } else { three(&mut bytes, names) }.map_err(wrong)?;
    Ok(Some((width as u32, height as u32, values)))
}

/// The size of the layer with these channels.
fn size_of(bytes: &mut (impl BufRead + Seek), names: &[&str; 3]) -> Result<Option<Vec2<usize>>, ExrError> {
    let meta = exr::meta::MetaData::read_from_buffered(&mut *bytes, false)?;
    let has = |header: &exr::meta::header::Header| {
        names.iter().all(|name| header.channels.list.iter().any(|channel| channel.name == **name))
    };
    Ok(meta.headers.iter().find(|header| !header.deep && has(header)).map(|header| header.layer_size))
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
