//! Reading of partial renders: header and index on opening, tiles on demand.

use super::chunk::decode;
use super::format::{ENTRY, Entry, Header, MAGIC, MAX_HEADER, PRELUDE, Prelude, SEAL, VERSION, describe, layers};
use super::storage::{Storage, StorageReader};
use super::{PartialRenderError, RenderDescription};
use juggler_camera::film::{Tile, Tiling};
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;

/// Bytes of the index that are read at once.
const INDEX_BUFFER: usize = 1024 * ENTRY;

/// A partial render in a file or in memory, whose header and index are verified. It keeps no file
/// open.
#[derive(Clone, Debug)]
pub struct PartialRender {
    name: String,
    storage: Storage,
    description: RenderDescription,
    tiling: Tiling,
    /// Chunk locations, sorted by tile number.
    locations: Vec<ChunkLocation>,
    bytes: u64,
}

/// Location of a tile's chunk.
#[derive(Clone, Copy, Debug)]
struct ChunkLocation {
    entry: Entry,
    offset: u64,
}

/// Whether a file that begins with these bytes (8 suffice) is a `.jfilm` file.
pub fn is_partial_render(first_bytes: &[u8]) -> bool {
    first_bytes.starts_with(&MAGIC)
}

impl PartialRender {
    /// Reads and verifies header and index. Memory is bounded by a small multiple of the file's
    /// length, whatever sizes the file claims.
    pub fn open(path: &Path) -> Result<Self, PartialRenderError> {
        let source = Source::open(path.display().to_string(), Storage::File(path.to_owned()))?;
        source.into_partial_render()
    }

    /// Verifies header and index of a partial render in memory, as [`PartialRender::open`] does.
    /// Messages call it by `name`.
    pub fn from_bytes(name: &str, bytes: impl Into<Arc<[u8]>>) -> Result<Self, PartialRenderError> {
        Source::open(name.to_owned(), Storage::Memory(bytes.into()))?.into_partial_render()
    }

    /// Path of the file, or the name of a partial render in memory.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All bytes of the file, or those in memory.
    pub fn to_bytes(&self) -> Result<Arc<[u8]>, PartialRenderError> {
        let failed = |source| PartialRenderError::Read { file: self.name.clone(), source };
        if let Storage::Memory(bytes) = &self.storage {
            return Ok(Arc::clone(bytes));
        }
        let mut bytes = Vec::new();
        let length = self.storage.open().and_then(|reader| reader.take(self.bytes).read_to_end(&mut bytes));
        if length.map_err(failed)? as u64 != self.bytes {
            return Err(self.changed("it is shorter"));
        }
        // Between opening and reading, another file may have taken the place of this one.
        let read = Self::from_bytes(&self.name, bytes)?;
        if read.description != self.description {
            return Err(self.changed("it has another description"));
        }
        read.to_bytes()
    }

    /// Length of the file in bytes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Description of the partial render.
    pub fn description(&self) -> &RenderDescription {
        &self.description
    }

    /// Numbers of the stored tiles in the region's layout, in ascending order.
    pub fn tiles(&self) -> impl ExactSizeIterator<Item = u64> + Clone {
        self.locations.iter().map(|location| location.entry.tile)
    }

    /// Numbers of the stored tiles from `first` up to, but excluding, `end`.
    pub fn tiles_in(&self, first: u64, end: u64) -> impl ExactSizeIterator<Item = u64> + Clone {
        let at = |number: u64| self.locations.partition_point(|location| location.entry.tile < number);
        let range = at(first)..at(end.max(first));
        self.locations.get(range).unwrap_or_default().iter().map(|location| location.entry.tile)
    }

    /// Reads one tile; it is empty if the partial render does not store it. For many tiles use
    /// [`PartialRender::reader`].
    pub fn tile(&self, number: u64) -> Result<Tile, PartialRenderError> {
        self.reader()?.tile(number)
    }

    /// Opens the file for reading tiles.
    pub fn reader(&self) -> Result<TileReader<'_>, PartialRenderError> {
        let name = self.name.clone();
        match self.storage.open() {
            Ok(reader) => Ok(TileReader { partial_render: self, reader, name, bytes: Vec::new() }),
            Err(source) => Err(PartialRenderError::Read { file: name, source }),
        }
    }

    /// Error of a file that was modified after it was opened.
    pub(crate) fn changed(&self, what: &str) -> PartialRenderError {
        PartialRenderError::Damaged { file: self.name.clone(), what: format!("changed while it was read: {what}") }
    }

    /// Reads and verifies every chunk, one at a time.
    pub fn verify(&self) -> Result<(), PartialRenderError> {
        let mut reader = self.reader()?;
        self.tiles().try_for_each(|number| reader.tile(number).map(drop))
    }
}

/// Reads tiles of a partial render.
#[derive(Debug)]
pub struct TileReader<'p> {
    partial_render: &'p PartialRender,
    reader: StorageReader,
    name: String,
    bytes: Vec<u8>,
}

impl TileReader<'_> {
    /// Reads and verifies one tile; it is empty if the partial render does not store it.
    pub fn tile(&mut self, number: u64) -> Result<Tile, PartialRenderError> {
        let PartialRender { tiling, locations, description, .. } = self.partial_render;
        let Some(pixels) = tiling.tile(number) else {
            return Err(self.damaged(format!("its region has no tile {number}")));
        };
        let found = locations
            .binary_search_by_key(&number, |location| location.entry.tile)
            .ok()
            .and_then(|at| locations.get(at));
        let Some(ChunkLocation { entry, offset }) = found else { return Ok(Tile::new(pixels)) };
        self.fetch(*offset, entry.length as usize)?;
        if *blake3::hash(&self.bytes).as_bytes() != entry.hash {
            return Err(self.damaged(format!("the checksum of tile {number} is wrong")));
        }
        decode(&self.bytes, pixels, description).map_err(|what| self.damaged(format!("tile {number}: {what}")))
    }

    fn damaged(&self, what: String) -> PartialRenderError {
        PartialRenderError::Damaged { file: self.name.clone(), what }
    }

    fn fetch(&mut self, offset: u64, length: usize) -> Result<(), PartialRenderError> {
        let failed = |source| PartialRenderError::Read { file: self.name.clone(), source };
        self.bytes.resize(length, 0);
        self.reader.seek(SeekFrom::Start(offset)).map_err(failed)?;
        self.reader.read_exact(&mut self.bytes).map_err(failed)
    }
}

/// A partial render that is being opened.
struct Source {
    name: String,
    storage: Storage,
    reader: BufReader<StorageReader>,
    length: u64,
}

impl Source {
    fn open(name: String, storage: Storage) -> Result<Self, PartialRenderError> {
        let opened = storage.open().and_then(|reader| {
            let length = reader.length()?;
            Ok((reader, length))
        });
        match opened {
            Ok((reader, length)) => Ok(Self { name, storage, reader: BufReader::new(reader), length }),
            Err(source) => Err(PartialRenderError::Read { file: name, source }),
        }
    }

    fn damaged(&self, what: impl Into<String>) -> PartialRenderError {
        PartialRenderError::Damaged { file: self.name.clone(), what: what.into() }
    }

    fn truncated(&self, expected: u64) -> PartialRenderError {
        PartialRenderError::Truncated { file: self.name.clone(), length: self.length, expected }
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<(), PartialRenderError> {
        self.reader.read_exact(bytes).map_err(|source| PartialRenderError::Read { file: self.name.clone(), source })
    }

    /// Reads the prelude and checks the magic number and the minimum length.
    fn prelude(&mut self) -> Result<[u8; PRELUDE], PartialRenderError> {
        let mut bytes = [0; PRELUDE];
        let there = self.length.min(PRELUDE as u64) as usize;
        let start = bytes.get_mut(..there).unwrap_or_default();
        self.reader.read_exact(start).map_err(|source| PartialRenderError::Read { file: self.name.clone(), source })?;
        let name = MAGIC.len().min(there);
        if bytes.get(..name) != MAGIC.get(..name) {
            return Err(PartialRenderError::NotAPartialRender { file: self.name.clone() });
        }
        if there < PRELUDE {
            return Err(self.truncated(PRELUDE as u64));
        }
        Ok(bytes)
    }

    fn into_partial_render(mut self) -> Result<PartialRender, PartialRenderError> {
        let bytes = self.prelude()?;
        let prelude = Prelude::from_bytes(&bytes);
        if prelude.version != VERSION {
            return Err(PartialRenderError::Version { file: self.name, version: prelude.version, known: VERSION });
        }
        if prelude.length > self.length {
            return Err(self.truncated(prelude.length));
        }
        if prelude.length < self.length {
            return Err(self.damaged(format!("{} bytes follow its end", self.length - prelude.length)));
        }
        let Some((chunks, index)) = prelude.offsets().filter(|_| prelude.header <= MAX_HEADER) else {
            return Err(self.damaged("its lengths are inconsistent"));
        };
        let mut hasher = blake3::Hasher::new();
        hasher.update(&bytes);
        let mut header = vec![0; prelude.header as usize];
        self.read(&mut header)?;
        hasher.update(&header);
        let failed = |source| PartialRenderError::Read { file: self.name.clone(), source };
        self.reader.seek(SeekFrom::Start(index)).map_err(failed)?;
        let (locations, end) = self.index(prelude.chunks, chunks, &mut hasher)?;
        let mut seal = [0; SEAL];
        self.read(&mut seal)?;
        if seal != *hasher.finalize().as_bytes() || end != index {
            return Err(self.damaged("the checksum of its header and index is wrong"));
        }
        let description = self.description(&header)?;
        self.finish(description, locations)
    }

    /// Reads the index; returns the chunk locations and the end offset of the last chunk.
    fn index(
        &mut self,
        count: u64,
        start: u64,
        hasher: &mut blake3::Hasher,
    ) -> Result<(Vec<ChunkLocation>, u64), PartialRenderError> {
        let mut locations = Vec::new();
        let mut offset = start;
        let mut left = count * ENTRY as u64;
        while left > 0 {
            let mut bytes = vec![0; left.min(INDEX_BUFFER as u64) as usize];
            self.read(&mut bytes)?;
            hasher.update(&bytes);
            for entry in bytes.as_chunks::<ENTRY>().0 {
                let entry = Entry::from_bytes(entry);
                locations.push(ChunkLocation { entry, offset });
                offset = offset.saturating_add(entry.length.into());
            }
            left -= bytes.len() as u64;
        }
        Ok((locations, offset))
    }

    fn description(&self, header: &[u8]) -> Result<RenderDescription, PartialRenderError> {
        let Header { layers: found, partial_render } = serde_json::from_slice(header)
            .map_err(|error| self.damaged(format!("its header is malformed: {error}")))?;
        let known = layers(&partial_render);
        if found != known {
            let (layers, known) = (describe(&found), describe(&known));
            return Err(PartialRenderError::Layers { file: self.name.clone(), layers, known });
        }
        match partial_render.problem() {
            Some(problem) => Err(self.damaged(problem)),
            None => Ok(partial_render),
        }
    }

    fn finish(
        self,
        description: RenderDescription,
        mut locations: Vec<ChunkLocation>,
    ) -> Result<PartialRender, PartialRenderError> {
        locations.sort_unstable_by_key(|location| location.entry.tile);
        if let Some([location, _]) = locations.array_windows().find(|[a, b]| a.entry.tile == b.entry.tile) {
            return Err(self.damaged(format!("tile {} occurs twice", location.entry.tile)));
        }
        let tiling = description.tiling();
        if let Some(location) = locations.last().filter(|location| location.entry.tile >= tiling.tile_count()) {
            return Err(self.damaged(format!("tile {} is outside of its region", location.entry.tile)));
        }
        let Self { name, storage, length: bytes, .. } = self;
        Ok(PartialRender { name, storage, description, tiling, locations, bytes })
    }
}
