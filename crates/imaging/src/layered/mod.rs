//! Files with several layers (AOVs): a multi-part EXR, or one file per layer.
//!
//! Rows of all layers are streamed together, so that memory does not depend on the image height.

mod attributes;
pub(crate) mod exr;
mod npy;
mod read;

use crate::atomic::AtomicFile;
use crate::output::{WriteSeek, whole_file};
use crate::{ClampCount, CropFrame, ExrCompression, Header, ImageError, Primaries, SampleDepth, Viewpoint};
use juggler_math::PixelRows;
use std::path::{Path, PathBuf};

pub(crate) use read::read_channels;
pub use read::{LayerName, layer_names, read_layer};

/// Placeholder for the layer name in file names.
pub const PLACEHOLDER: &str = "{}";

/// Name, channels and sample type of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerHeader {
    /// Name of the layer.
    pub name: String,
    /// Channel names in an EXR file.
    pub channels: Vec<String>,
    /// Sample type in an EXR file.
    pub depth: SampleDepth,
    /// Whether the first three channels are RGB with sRGB primaries, which EXR files convert to their
    /// own.
    pub is_color: bool,
    /// Metadata for an EXR file, as pairs of key and text.
    pub metadata: Vec<(String, String)>,
}

impl LayerHeader {
    /// A layer whose channels are prefixed with its name, such as `normal.X`.
    pub fn new(name: &str, channels: &[&str]) -> Self {
        let channels = channels.iter().map(|channel| format!("{name}.{channel}")).collect();
        let (name, depth) = (name.to_owned(), SampleDepth::Float);
        Self { name, channels, depth, is_color: false, metadata: Vec::new() }
    }

    /// An RGB layer.
    pub fn color(name: &str) -> Self {
        Self { is_color: true, ..Self::new(name, &["R", "G", "B"]) }
    }

    /// The rendered image itself, with channels `R`, `G` and `B`, and `A` if `header` says that the
    /// image is transparent.
    pub fn beauty(header: &Header) -> Self {
        let names = if header.transparent { &["R", "G", "B", "A"][..] } else { &["R", "G", "B"] };
        let channels = names.iter().map(|name| (*name).to_owned()).collect();
        let depth = header.options.exr_depth;
        Self { name: "beauty".to_owned(), channels, depth, is_color: true, metadata: Vec::new() }
    }
}

/// Properties of an image with several layers.
#[derive(Clone, Debug, PartialEq)]
pub struct LayeredHeader {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Layers, in order.
    pub layers: Vec<LayerHeader>,
    /// Compression of EXR files, always lossless.
    pub compression: ExrCompression,
    /// Primaries of color layers in EXR files; NPY files keep sRGB, since they cannot state
    /// primaries.
    pub primaries: Primaries,
    /// Metadata of the whole image.
    pub metadata: Vec<(String, String)>,
    /// Camera matrices, if known.
    pub viewpoint: Option<Viewpoint>,
    /// Frame that the image is a crop of; EXR files store it as their display window.
    pub crop: Option<CropFrame>,
    /// Receives the number of values that are clamped to the range of half floats.
    pub clamped: ClampCount,
}

impl LayeredHeader {
    /// Takes size, options and metadata from `header`.
    pub fn new(header: &Header, layers: Vec<LayerHeader>) -> Self {
        Self {
            width: header.width,
            height: header.height,
            layers,
            compression: header.options.exr_compression,
            primaries: header.tone.primaries,
            metadata: header.metadata.clone(),
            viewpoint: header.viewpoint,
            crop: header.crop,
            clamped: header.clamped.clone(),
        }
    }
}

/// Channels of the layer [`LayerHeader::beauty`]: red, green and blue of the pixels, and alpha if they
/// have it.
pub fn channels(rows: PixelRows) -> Vec<Vec<f32>> {
    let color = |channel: usize| rows.colors.iter().map(|pixel| pixel.to_array()[channel]).collect();
    (0..3).map(color).chain(rows.alpha.map(<[f32]>::to_vec)).collect()
}

/// Streams layers to one or several files, which replace their destinations when all are complete.
pub struct LayeredWriter {
    files: Vec<LayerFile>,
    width: usize,
}

/// One file and the range of channels that it stores.
struct LayerFile {
    writer: Box<dyn LayerRows>,
    channels: std::ops::Range<usize>,
    file: Option<AtomicFile>,
    name: String,
}

/// Encoder of a layered file.
pub(crate) trait LayerRows: Send {
    /// Encodes the next rows, given per channel.
    fn write_rows(&mut self, channels: &[&[f32]]) -> Result<(), ImageError>;
    /// Writes the remaining data.
    fn finish(&mut self) -> Result<(), ImageError>;
}

impl LayeredWriter {
    /// Creates a multi-part EXR at `path`. If the file name contains [`PLACEHOLDER`], creates one
    /// file per layer instead, EXR or NPY (a NumPy array of shape height × width × channels).
    ///
    /// # Errors
    ///
    /// [`ImageError::Layers`] for other file extensions.
    pub fn create(path: &Path, header: &LayeredHeader) -> Result<Self, ImageError> {
        let name = path.to_string_lossy();
        let mut files = Vec::new();
        if !name.contains(PLACEHOLDER) {
            let all = header.layers.iter().map(|layer| layer.channels.len()).sum();
            files.push(layer_file(path, header, 0..all)?);
        } else {
            let mut start = 0;
            for layer in &header.layers {
                let end = start + layer.channels.len();
                let one = LayeredHeader { layers: vec![layer.clone()], ..header.clone() };
                files.push(layer_file(&PathBuf::from(name.replace(PLACEHOLDER, &layer.name)), &one, start..end)?);
                start = end;
            }
        }
        Ok(Self { files, width: header.width as usize })
    }

    /// Writes the next rows of all channels of all layers, in order; all have the same length.
    pub fn write_rows(&mut self, channels: &[Vec<f32>]) -> Result<(), ImageError> {
        debug_assert!(channels.iter().all(|channel| channel.len().is_multiple_of(self.width.max(1))));
        for layer_file in &mut self.files {
            let rows = channels.get(layer_file.channels.clone()).unwrap_or_default();
            layer_file.writer.write_rows(&rows.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
        }
        Ok(())
    }

    /// Completes all files, then moves each to its destination.
    pub fn finish(mut self) -> Result<(), ImageError> {
        self.files.iter_mut().try_for_each(|layer_file| layer_file.writer.finish())?;
        for LayerFile { writer, file, name, .. } in self.files {
            drop(writer);
            let commit = file.map_or(Ok(()), AtomicFile::commit);
            commit.map_err(|source| ImageError::Write { file: name, source })?;
        }
        Ok(())
    }
}

fn layer_file(path: &Path, header: &LayeredHeader, channels: std::ops::Range<usize>) -> Result<LayerFile, ImageError> {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    let is_npy = match extension.as_ref().and_then(|extension| extension.to_str()) {
        Some("exr") => false,
        Some("npy") => true,
        _ => return Err(ImageError::Layers { file: path.display().to_string() }),
    };
    if is_npy && header.layers.len() > 1 {
        return Err(ImageError::Layers { file: path.display().to_string() });
    }
    let (destination, file) = whole_file(path)?;
    let name = destination.name().to_owned();
    let sink: Box<dyn WriteSeek> = destination.into_seekable();
    let writer: Box<dyn LayerRows> = match is_npy {
        true => Box::new(npy::Writer::new(sink, name.clone(), header)?),
        false => Box::new(exr::Writer::new(sink, name.clone(), header)?),
    };
    Ok(LayerFile { writer, channels, file, name })
}

#[cfg(test)]
mod tests;
