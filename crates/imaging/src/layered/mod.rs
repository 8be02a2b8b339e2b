//! Files of many layers: one EXR with a part for each, or a file for each layer.
//!
//! Rows come for all layers together, so that a large picture needs no more memory than the film that it comes from.

mod attributes;
pub(crate) mod exr;
mod npy;
mod read;

use crate::atomic::AtomicFile;
use crate::output::{WriteSeek, whole_file};
use crate::{ExrCompression, Header, ImageError, Primaries, SampleDepth, Viewpoint};
use std::path::{Path, PathBuf};

pub use read::{LayerName, layer_names, read_layer};

/// What stands for a layer's name in the name of a file.
pub const PLACEHOLDER: &str = "{}";

/// One layer.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerHeader {
    /// What it is called.
    pub name: String,
    /// What its channels are called in an EXR.
    pub channels: Vec<String>,
    /// How exact an EXR keeps it.
    pub depth: SampleDepth,
    /// Whether its three channels are red, green and blue in the primaries of sRGB, which an EXR turns into its own.
    pub is_color: bool,
    /// Texts by key, in order, for an EXR.
    pub metadata: Vec<(String, String)>,
}

impl LayerHeader {
    /// A layer whose channels carry its name: `normal.X`.
    pub fn new(name: &str, channels: &[&str]) -> Self {
        let channels = channels.iter().map(|channel| format!("{name}.{channel}")).collect();
        let (name, depth) = (name.to_owned(), SampleDepth::Float);
        Self { name, channels, depth, is_color: false, metadata: Vec::new() }
    }

    /// A layer of colours.
    pub fn color(name: &str) -> Self {
        Self { is_color: true, ..Self::new(name, &["R", "G", "B"]) }
    }

    /// The picture itself, whose channels are plain `R`, `G` and `B`.
    pub fn beauty(depth: SampleDepth) -> Self {
        let channels = ["R", "G", "B"].map(str::to_owned).to_vec();
        Self { name: "beauty".to_owned(), channels, depth, is_color: true, metadata: Vec::new() }
    }
}

/// A picture of many layers.
#[derive(Clone, Debug, PartialEq)]
pub struct LayeredHeader {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// All layers.
    pub layers: Vec<LayerHeader>,
    /// Packing of an EXR; nothing is lost by any.
    pub compression: ExrCompression,
    /// The primaries of an EXR's colours. An NPY, which cannot say so, keeps those of sRGB.
    pub primaries: Primaries,
    /// Texts of the picture as a whole.
    pub metadata: Vec<(String, String)>,
    /// From where it was taken, if anybody knows.
    pub viewpoint: Option<Viewpoint>,
}

impl LayeredHeader {
    /// With what `header` says of the picture.
    pub fn new(header: &Header, layers: Vec<LayerHeader>) -> Self {
        Self {
            width: header.width,
            height: header.height,
            layers,
            compression: header.options.exr_compression,
            primaries: header.tone.primaries,
            metadata: header.metadata.clone(),
            viewpoint: header.viewpoint,
        }
    }
}

/// Writes rows of layers to their files, which take their places when all are finished.
pub struct LayeredWriter {
    files: Vec<Piece>,
    width: usize,
}

/// One file, and which of all channels go there.
struct Piece {
    writer: Box<dyn LayerRows>,
    channels: std::ops::Range<usize>,
    file: Option<AtomicFile>,
    name: String,
}

/// A file of some channels.
pub(crate) trait LayerRows: Send {
    /// Takes the next rows, channel by channel.
    fn write_rows(&mut self, channels: &[&[f32]]) -> Result<(), ImageError>;
    /// Writes what is left.
    fn finish(&mut self) -> Result<(), ImageError>;
}

impl LayeredWriter {
    /// Begins `path`: an EXR of all layers; where its name holds [`PLACEHOLDER`], a file for each layer, EXR or NPY (an
    /// array of rows × columns × channels for NumPy).
    pub fn create(path: &Path, header: &LayeredHeader) -> Result<Self, ImageError> {
        let name = path.to_string_lossy();
        let mut files = Vec::new();
        if !name.contains(PLACEHOLDER) {
            let all = header.layers.iter().map(|layer| layer.channels.len()).sum();
            files.push(piece(path, header, 0..all)?);
        } else {
            let mut start = 0;
            for layer in &header.layers {
                let end = start + layer.channels.len();
                let one = LayeredHeader { layers: vec![layer.clone()], ..header.clone() };
                files.push(piece(&PathBuf::from(name.replace(PLACEHOLDER, &layer.name)), &one, start..end)?);
                start = end;
            }
        }
        Ok(Self { files, width: header.width as usize })
    }

    /// Writes the next rows of all channels of all layers, in order; each as many values as the others.
    pub fn write_rows(&mut self, channels: &[Vec<f32>]) -> Result<(), ImageError> {
        debug_assert!(channels.iter().all(|channel| channel.len().is_multiple_of(self.width.max(1))));
        for piece in &mut self.files {
            let rows = channels.get(piece.channels.clone()).unwrap_or_default();
            piece.writer.write_rows(&rows.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
        }
        Ok(())
    }

    /// Writes what is left, then puts every file in its place.
    pub fn finish(mut self) -> Result<(), ImageError> {
        self.files.iter_mut().try_for_each(|piece| piece.writer.finish())?;
        for Piece { writer, file, name, .. } in self.files {
            drop(writer);
            let commit = file.map_or(Ok(()), AtomicFile::commit);
            commit.map_err(|source| ImageError::Write { place: name, source })?;
        }
        Ok(())
    }
}

fn piece(path: &Path, header: &LayeredHeader, channels: std::ops::Range<usize>) -> Result<Piece, ImageError> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let is_npy = match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("exr") => false,
        Some("npy") => true,
        _ => return Err(ImageError::Layers { place: path.display().to_string() }),
    };
    if is_npy && header.layers.len() > 1 {
        return Err(ImageError::Layers { place: path.display().to_string() });
    }
    let (destination, file) = whole_file(path)?;
    let name = destination.name().to_owned();
    let sink: Box<dyn WriteSeek> = destination.into_seekable();
    let writer: Box<dyn LayerRows> = match is_npy {
        true => Box::new(npy::Writer::new(sink, name.clone(), header)?),
        false => Box::new(exr::Writer::new(sink, name.clone(), header)?),
    };
    Ok(Piece { writer, channels, file, name })
}

#[cfg(test)]
mod tests;
