//! Writing of partial renders: to a temporary file, which replaces the destination once it is synced
//! to disk, or to memory.

use super::chunk::MAX_RUNS;
use super::format::{Entry, Header, MAX_HEADER, PRELUDE, Prelude, SEAL, VERSION, layers};
use super::storage::Destination;
use super::{Chunk, PartialRenderError, RenderDescription};
use juggler_camera::film::{Tile, Tiling};
use std::path::Path;

/// A partial render being written. An existing file stays in place until
/// [`PartialRenderWriter::finish`].
#[derive(Debug)]
pub struct PartialRenderWriter {
    name: String,
    out: Destination,
    tiling: Tiling,
    clamped: bool,
    header: Vec<u8>,
    entries: Vec<Entry>,
    length: u64,
}

impl PartialRenderWriter {
    /// Creates the temporary file and writes the header.
    pub fn create(path: &Path, description: &RenderDescription) -> Result<Self, PartialRenderError> {
        let name = path.display().to_string();
        let header = encode_header(&name, description)?;
        let failed = |source| PartialRenderError::Write { file: name.clone(), source };
        let out = Destination::create(path).map_err(failed)?;
        Self::begin(name, out, header, description)
    }

    /// Starts a partial render in memory. Messages call it by `name`.
    pub fn in_memory(name: &str, description: &RenderDescription) -> Result<Self, PartialRenderError> {
        let header = encode_header(name, description)?;
        Self::begin(name.to_owned(), Destination::Memory(Vec::new()), header, description)
    }

    fn begin(
        name: String,
        out: Destination,
        header: Vec<u8>,
        description: &RenderDescription,
    ) -> Result<Self, PartialRenderError> {
        let (tiling, clamped) = (description.tiling(), description.clamped);
        let mut writer = Self { name, out, tiling, clamped, header: Vec::new(), entries: Vec::new(), length: 0 };
        // The prelude is written last, when its lengths are known.
        writer.put(&[0; PRELUDE])?;
        writer.put(&header)?;
        Ok(Self { header, ..writer })
    }

    /// Appends a tile, given its number in the region's layout. Tiles may come in any order, each
    /// once.
    pub fn add(&mut self, number: u64, chunk: &Chunk) -> Result<(), PartialRenderError> {
        if self.tiling.tile(number) != Some(chunk.pixels) {
            return Err(self.invalid(format!("tile {number} has other pixels than tile {number} of the region")));
        }
        if chunk.clamped != self.clamped {
            return Err(self.invalid(format!("tile {number} and its picture do not agree on whether it is clamped")));
        }
        let length = u32::try_from(chunk.bytes.len()).ok().filter(|_| chunk.runs <= MAX_RUNS);
        let Some(length) = length else {
            return Err(
                self.invalid(format!("tile {number} is in {} runs of samples, more than {MAX_RUNS}", chunk.runs))
            );
        };
        self.put(&chunk.bytes)?;
        self.entries.push(Entry { tile: number, length, hash: chunk.hash });
        Ok(())
    }

    /// Writes index and seal, syncs the file to disk and moves it to its destination. Returns its
    /// length in bytes.
    pub fn finish(self) -> Result<u64, PartialRenderError> {
        self.end().map(|(length, _)| length)
    }

    /// Writes index and seal, and returns the bytes of a partial render in memory.
    pub fn into_bytes(self) -> Result<Vec<u8>, PartialRenderError> {
        self.end().map(|(_, bytes)| bytes)
    }

    fn end(mut self) -> Result<(u64, Vec<u8>), PartialRenderError> {
        self.check_doubles()?;
        let mut index = Vec::new();
        self.entries.iter().for_each(|entry| entry.append_to(&mut index));
        let length = self.length + (index.len() + SEAL) as u64;
        // The length is at most `MAX_HEADER`, so it fits.
        let header = self.header.len() as u32;
        let prelude = Prelude { version: VERSION, header, length, chunks: self.entries.len() as u64 }.to_bytes();
        let mut hasher = blake3::Hasher::new();
        hasher.update(&prelude).update(&self.header).update(&index);
        self.put(&index)?;
        self.put(hasher.finalize().as_bytes())?;
        let Self { name, out, .. } = self;
        let bytes = out.finish(&prelude).map_err(|source| PartialRenderError::Write { file: name, source })?;
        Ok((length, bytes))
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), PartialRenderError> {
        self.length += bytes.len() as u64;
        self.out.append(bytes).map_err(|source| PartialRenderError::Write { file: self.name.clone(), source })
    }

    fn check_doubles(&self) -> Result<(), PartialRenderError> {
        let mut tiles: Vec<u64> = self.entries.iter().map(|entry| entry.tile).collect();
        tiles.sort_unstable();
        match tiles.array_windows().find(|[a, b]| a == b) {
            Some([tile, _]) => Err(self.invalid(format!("tile {tile} occurs twice"))),
            None => Ok(()),
        }
    }

    fn invalid(&self, what: String) -> PartialRenderError {
        PartialRenderError::Invalid { file: self.name.clone(), what }
    }
}

fn encode_header(name: &str, description: &RenderDescription) -> Result<Vec<u8>, PartialRenderError> {
    let invalid = |what: String| PartialRenderError::Invalid { file: name.to_owned(), what };
    if let Some(problem) = description.problem() {
        return Err(invalid(problem.to_owned()));
    }
    let header = Header { layers: layers(description), partial_render: description.clone() };
    let mut bytes = serde_json::to_vec_pretty(&header).map_err(|error| invalid(error.to_string()))?;
    bytes.push(b'\n');
    if bytes.len() > MAX_HEADER as usize {
        return Err(invalid(format!("its description has {} bytes, more than {MAX_HEADER}", bytes.len())));
    }
    Ok(bytes)
}

/// Writes a partial render with the given tiles, numbered as in the region's layout, and returns
/// its length in bytes. An existing file is replaced only when the new one is complete and synced
/// to disk.
pub fn write(
    path: &Path,
    description: &RenderDescription,
    tiles: impl IntoIterator<Item = (u64, Tile)>,
) -> Result<u64, PartialRenderError> {
    let mut writer = PartialRenderWriter::create(path, description)?;
    for (number, tile) in tiles {
        writer.add(number, &Chunk::encode(&tile, description.clamped))?;
    }
    writer.finish()
}
