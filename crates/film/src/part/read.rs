//! Reading parts: head and index at once, tiles when asked for.

use super::chunk::decode;
use super::format::{ENTRY, Entry, Head, MAGIC, MAX_HEAD, PRELUDE, Prelude, SEAL, VERSION, in_words, layers};
use super::{Description, PartError};
use juggler_camera::film::{Layout, Tile};
use juggler_imaging::regular;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Bytes of the index that are read at once.
const PIECE: usize = 1024 * ENTRY;

/// A part whose head and index are known to be whole. It holds no open file.
#[derive(Clone, Debug)]
pub struct Part {
    path: PathBuf,
    description: Description,
    layout: Layout,
    /// By number.
    places: Vec<Place>,
    bytes: u64,
}

/// Where the chunk of a tile is.
#[derive(Clone, Copy, Debug)]
struct Place {
    entry: Entry,
    offset: u64,
}

/// Whether these first bytes of a file (8 are enough) are those of a part.
pub fn is_part(first_bytes: &[u8]) -> bool {
    first_bytes.starts_with(&MAGIC)
}

impl Part {
    /// Reads head and index. Takes no more memory than a small multiple of the file's length, whatever it claims.
    pub fn open(path: &Path) -> Result<Self, PartError> {
        let source = Source::open(path)?;
        source.part(path)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its length in bytes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// What it says about itself.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The numbers of its tiles in the region's layout, rising.
    pub fn tiles(&self) -> impl ExactSizeIterator<Item = u64> + Clone {
        self.places.iter().map(|place| place.entry.tile)
    }

    /// The numbers of its tiles from `first` up to, but without, `end`.
    pub fn tiles_in(&self, first: u64, end: u64) -> impl ExactSizeIterator<Item = u64> + Clone {
        let at = |number: u64| self.places.partition_point(|place| place.entry.tile < number);
        let range = at(first)..at(end.max(first));
        self.places.get(range).unwrap_or_default().iter().map(|place| place.entry.tile)
    }

    /// One of its tiles; without samples when the part has none of it. For many tiles see [`Part::reader`].
    pub fn tile(&self, number: u64) -> Result<Tile, PartError> {
        self.reader()?.tile(number)
    }

    /// Opens the file to read tiles.
    pub fn reader(&self) -> Result<Reader<'_>, PartError> {
        let name = self.path.display().to_string();
        match regular::open(&self.path) {
            Ok(file) => Ok(Reader { part: self, file, name, bytes: Vec::new() }),
            Err(source) => Err(PartError::Read { file: name, source }),
        }
    }

    /// What it holds is no longer what it held when it was opened.
    pub(crate) fn changed(&self, what: &str) -> PartError {
        PartError::Damaged { file: self.path.display().to_string(), what: format!("changed while it was read: {what}") }
    }

    /// Reads and checks every chunk, one at a time.
    pub fn verify(&self) -> Result<(), PartError> {
        let mut reader = self.reader()?;
        self.tiles().try_for_each(|number| reader.tile(number).map(drop))
    }
}

/// Reads tiles of a part.
#[derive(Debug)]
pub struct Reader<'p> {
    part: &'p Part,
    file: File,
    name: String,
    bytes: Vec<u8>,
}

impl Reader<'_> {
    /// One of the part's tiles, its chunk checked; without samples when the part has none of it.
    pub fn tile(&mut self, number: u64) -> Result<Tile, PartError> {
        let Part { layout, places, description, .. } = self.part;
        let Some(pixels) = layout.tile(number) else {
            return Err(self.damaged(format!("its region has no tile {number}")));
        };
        let found = places.binary_search_by_key(&number, |place| place.entry.tile).ok().and_then(|at| places.get(at));
        let Some(Place { entry, offset }) = found else { return Ok(Tile::new(pixels)) };
        self.fetch(*offset, entry.length as usize)?;
        if *blake3::hash(&self.bytes).as_bytes() != entry.hash {
            return Err(self.damaged(format!("the bytes of tile {number} are not those that were written")));
        }
        decode(&self.bytes, pixels, description).map_err(|what| self.damaged(format!("tile {number}: {what}")))
    }

    fn damaged(&self, what: String) -> PartError {
        PartError::Damaged { file: self.name.clone(), what }
    }

    fn fetch(&mut self, offset: u64, length: usize) -> Result<(), PartError> {
        let failed = |source| PartError::Read { file: self.name.clone(), source };
        self.bytes.resize(length, 0);
        self.file.seek(SeekFrom::Start(offset)).map_err(failed)?;
        self.file.read_exact(&mut self.bytes).map_err(failed)
    }
}

/// A file that may be a part.
struct Source {
    name: String,
    file: BufReader<File>,
    length: u64,
}

impl Source {
    fn open(path: &Path) -> Result<Self, PartError> {
        let name = path.display().to_string();
        let opened = regular::open(path).and_then(|file| {
            let length = file.metadata()?.len();
            Ok((file, length))
        });
        match opened {
            Ok((file, length)) => Ok(Self { name, file: BufReader::new(file), length }),
            Err(source) => Err(PartError::Read { file: name, source }),
        }
    }

    fn damaged(&self, what: impl Into<String>) -> PartError {
        PartError::Damaged { file: self.name.clone(), what: what.into() }
    }

    fn truncated(&self, expected: u64) -> PartError {
        PartError::Truncated { file: self.name.clone(), length: self.length, expected }
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<(), PartError> {
        self.file.read_exact(bytes).map_err(|source| PartError::Read { file: self.name.clone(), source })
    }

    /// The first bytes, as far as they can be checked without the rest.
    fn prelude(&mut self) -> Result<[u8; PRELUDE], PartError> {
        let mut bytes = [0; PRELUDE];
        let there = self.length.min(PRELUDE as u64) as usize;
        let start = bytes.get_mut(..there).unwrap_or_default();
        self.file.read_exact(start).map_err(|source| PartError::Read { file: self.name.clone(), source })?;
        let name = MAGIC.len().min(there);
        if bytes.get(..name) != MAGIC.get(..name) {
            return Err(PartError::NotAPart { file: self.name.clone() });
        }
        if there < PRELUDE {
            return Err(self.truncated(PRELUDE as u64));
        }
        Ok(bytes)
    }

    fn part(mut self, path: &Path) -> Result<Part, PartError> {
        let bytes = self.prelude()?;
        let prelude = Prelude::of_bytes(&bytes);
        if prelude.version != VERSION {
            return Err(PartError::Version { file: self.name, version: prelude.version, known: VERSION });
        }
        if prelude.length > self.length {
            return Err(self.truncated(prelude.length));
        }
        if prelude.length < self.length {
            return Err(self.damaged(format!("{} bytes follow its end", self.length - prelude.length)));
        }
        let Some((chunks, index)) = prelude.places().filter(|_| prelude.head <= MAX_HEAD) else {
            return Err(self.damaged("its lengths do not fit each other"));
        };
        let mut hasher = blake3::Hasher::new();
        hasher.update(&bytes);
        let mut head = vec![0; prelude.head as usize];
        self.read(&mut head)?;
        hasher.update(&head);
        let failed = |source| PartError::Read { file: self.name.clone(), source };
        self.file.seek(SeekFrom::Start(index)).map_err(failed)?;
        let (places, end) = self.index(prelude.chunks, chunks, &mut hasher)?;
        let mut seal = [0; SEAL];
        self.read(&mut seal)?;
        if seal != *hasher.finalize().as_bytes() || end != index {
            return Err(self.damaged("its head or index is not what was written"));
        }
        let description = self.description(&head)?;
        self.finish(path, description, places)
    }

    /// The entries of the index, and where their chunks end.
    fn index(&mut self, count: u64, start: u64, hasher: &mut blake3::Hasher) -> Result<(Vec<Place>, u64), PartError> {
        let mut places = Vec::new();
        let mut offset = start;
        let mut left = count * ENTRY as u64;
        while left > 0 {
            let mut bytes = vec![0; left.min(PIECE as u64) as usize];
            self.read(&mut bytes)?;
            hasher.update(&bytes);
            for entry in bytes.as_chunks::<ENTRY>().0 {
                let entry = Entry::of_bytes(entry);
                places.push(Place { entry, offset });
                offset = offset.saturating_add(entry.length.into());
            }
            left -= bytes.len() as u64;
        }
        Ok((places, offset))
    }

    fn description(&self, head: &[u8]) -> Result<Description, PartError> {
        let Head { layers: found, part } =
            serde_json::from_slice(head).map_err(|error| self.damaged(format!("its head cannot be read: {error}")))?;
        let known = layers(&part);
        if found != known {
            let (layers, known) = (in_words(&found), in_words(&known));
            return Err(PartError::Layers { file: self.name.clone(), layers, known });
        }
        match part.fault() {
            Some(fault) => Err(self.damaged(fault)),
            None => Ok(part),
        }
    }

    fn finish(self, path: &Path, description: Description, mut places: Vec<Place>) -> Result<Part, PartError> {
        places.sort_unstable_by_key(|place| place.entry.tile);
        if let Some([place, _]) = places.array_windows().find(|[a, b]| a.entry.tile == b.entry.tile) {
            return Err(self.damaged(format!("tile {} is there twice", place.entry.tile)));
        }
        let layout = description.layout();
        if let Some(place) = places.last().filter(|place| place.entry.tile >= layout.tiles()) {
            return Err(self.damaged(format!("tile {} is none of its region", place.entry.tile)));
        }
        Ok(Part { path: path.to_owned(), description, layout, places, bytes: self.length })
    }
}
