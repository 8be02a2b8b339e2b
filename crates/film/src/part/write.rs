//! Writing parts: chunk after chunk beside the place, which the file takes when the disk has all of it.

use super::chunk::MAX_RUNS;
use super::format::{Entry, Head, MAX_HEAD, PRELUDE, Prelude, SEAL, VERSION, layers};
use super::{Chunk, Description, PartError};
use juggler_camera::film::{Layout, Tile};
use juggler_imaging::atomic::AtomicFile;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

/// A part in the making. Nothing is at its place before [`PartWriter::finish`]; what was there stays until then.
#[derive(Debug)]
pub struct PartWriter {
    name: String,
    file: AtomicFile,
    out: BufWriter<File>,
    layout: Layout,
    clamped: bool,
    head: Vec<u8>,
    entries: Vec<Entry>,
    length: u64,
}

impl PartWriter {
    /// Begins a part for this place.
    pub fn create(path: &Path, description: &Description) -> Result<Self, PartError> {
        let name = path.display().to_string();
        let head = head(&name, description)?;
        let failed = |source| PartError::Write { file: name.clone(), source };
        let file = AtomicFile::create(path).map_err(failed)?;
        let mut out = BufWriter::with_capacity(1 << 16, file.handle().map_err(failed)?);
        // The prelude is written last, when its numbers are known.
        out.write_all(&[0; PRELUDE]).and_then(|()| out.write_all(&head)).map_err(failed)?;
        let length = (PRELUDE + head.len()) as u64;
        let Description { clamped, .. } = *description;
        Ok(Self { name, file, out, layout: description.layout(), clamped, head, entries: Vec::new(), length })
    }

    /// Adds a tile by its number in the region's layout. Each comes once, in any order.
    pub fn add(&mut self, number: u64, chunk: &Chunk) -> Result<(), PartError> {
        if self.layout.tile(number) != Some(chunk.pixels) {
            return Err(self.unfit(format!("tile {number} has other pixels than the region's tile of that number")));
        }
        if chunk.clamped != self.clamped {
            return Err(self.unfit(format!("tile {number} and its picture do not agree on whether it is clamped")));
        }
        let length = u32::try_from(chunk.bytes.len()).ok().filter(|_| chunk.runs <= MAX_RUNS);
        let Some(length) = length else {
            return Err(self.unfit(format!("tile {number} is in {} runs of samples, more than {MAX_RUNS}", chunk.runs)));
        };
        self.put(&chunk.bytes)?;
        self.entries.push(Entry { tile: number, length, hash: chunk.hash });
        Ok(())
    }

    /// Writes the index, waits for the disk, and puts the file in its place. Returns its bytes.
    pub fn finish(mut self) -> Result<u64, PartError> {
        self.check_doubles()?;
        let mut index = Vec::new();
        self.entries.iter().for_each(|entry| entry.append_to(&mut index));
        let length = self.length + (index.len() + SEAL) as u64;
        // Heads have a limit, so this fits.
        let head = self.head.len() as u32;
        let prelude = Prelude { version: VERSION, head, length, chunks: self.entries.len() as u64 }.to_bytes();
        let mut hasher = blake3::Hasher::new();
        hasher.update(&prelude).update(&self.head).update(&index);
        self.put(&index)?;
        self.put(hasher.finalize().as_bytes())?;
        let Self { name, file, out, .. } = self;
        end(file, out, &prelude).map_err(|source| PartError::Write { file: name, source })?;
        Ok(length)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), PartError> {
        self.length += bytes.len() as u64;
        self.out.write_all(bytes).map_err(|source| PartError::Write { file: self.name.clone(), source })
    }

    fn check_doubles(&self) -> Result<(), PartError> {
        let mut tiles: Vec<u64> = self.entries.iter().map(|entry| entry.tile).collect();
        tiles.sort_unstable();
        match tiles.array_windows().find(|[a, b]| a == b) {
            Some([tile, _]) => Err(self.unfit(format!("tile {tile} is there twice"))),
            None => Ok(()),
        }
    }

    fn unfit(&self, what: String) -> PartError {
        PartError::Unfit { file: self.name.clone(), what }
    }
}

fn end(file: AtomicFile, mut out: BufWriter<File>, prelude: &[u8]) -> io::Result<()> {
    out.seek(SeekFrom::Start(0))?;
    out.write_all(prelude)?;
    out.flush()?;
    file.commit_durably()
}

fn head(name: &str, description: &Description) -> Result<Vec<u8>, PartError> {
    let unfit = |what: String| PartError::Unfit { file: name.to_owned(), what };
    if let Some(fault) = description.fault() {
        return Err(unfit(fault.to_owned()));
    }
    let head = Head { layers: layers(description), part: description.clone() };
    let mut bytes = serde_json::to_vec_pretty(&head).map_err(|error| unfit(error.to_string()))?;
    bytes.push(b'\n');
    if bytes.len() > MAX_HEAD as usize {
        return Err(unfit(format!("its description has {} bytes, more than {MAX_HEAD}", bytes.len())));
    }
    Ok(bytes)
}

/// Writes a part with these tiles, by their numbers in the region's layout. An existing file is replaced when the
/// new one is complete and on the disk. Returns its bytes.
pub fn write(
    path: &Path,
    description: &Description,
    tiles: impl IntoIterator<Item = (u64, Tile)>,
) -> Result<u64, PartError> {
    let mut writer = PartWriter::create(path, description)?;
    for (number, tile) in tiles {
        writer.add(number, &Chunk::encode(&tile, description.clamped))?;
    }
    writer.finish()
}
