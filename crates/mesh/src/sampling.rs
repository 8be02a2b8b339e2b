//! Samples of a mesh file, from which its format estimates its counts without reading all of it.

use juggler_imaging::regular;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

/// Number of bytes read at the start of a file: enough for any sensible header and for all of a
/// small file.
const HEAD: u64 = 1 << 20;
/// Number of bytes read at the end, where the faces of a PLY are.
const TAIL: u64 = 1 << 18;
/// Number of evenly spaced samples of a longer text, and the size of each in bytes.
const SAMPLES: u64 = 64;
const SAMPLE_BYTES: u64 = 1 << 14;
/// Bytes per triangle, and per distinct corner, while the file is read.
pub(crate) const FACE: u64 = 12;
pub(crate) const CORNER: u64 = 12 + 4 + 10;

/// Estimated contents of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Counts {
    pub vertices: u64,
    pub triangles: u64,
    /// Bytes of a vertex: position, normal, texture coordinates.
    pub vertex_bytes: u64,
    /// Bytes of a triangle beside its indices: color.
    pub face_bytes: u64,
    /// Temporary memory while reading, beside the file and the mesh, in bytes.
    pub temporary_bytes: u64,
}

impl Counts {
    /// Counts for facets whose corners may all be distinct.
    pub fn of_facets(facets: u64) -> Self {
        let corners = facets.saturating_mul(3);
        Self {
            vertices: corners,
            triangles: facets,
            vertex_bytes: 12,
            face_bytes: 0,
            temporary_bytes: corners.saturating_mul(CORNER - 12),
        }
    }
}

/// Bytes that are read at any position.
trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// A file, on disk or in memory, of which samples are read.
pub(crate) struct FileSampler<'f> {
    file: Box<dyn Source + 'f>,
    /// First bytes: at most [`HEAD`], all of a smaller file.
    pub head: Vec<u8>,
    /// Size of the file, in bytes.
    pub size: u64,
}

impl<'f> FileSampler<'f> {
    /// Opens a file and reads its first bytes; none of a file of more than `limit` bytes.
    pub fn open(path: &Path, limit: u64) -> io::Result<Self> {
        let file = regular::open(path)?;
        let size = file.metadata()?.len();
        Self::new(file, size, limit)
    }

    /// Reads the first bytes of a file in memory.
    pub fn from_bytes(bytes: &'f [u8], limit: u64) -> io::Result<Self> {
        Self::new(Cursor::new(bytes), bytes.len() as u64, limit)
    }

    fn new(mut file: impl Source + 'f, size: u64, limit: u64) -> io::Result<Self> {
        let head = if size > limit { Vec::new() } else { read_at(&mut file, 0, HEAD)? };
        Ok(Self { file: Box::new(file), head, size })
    }

    /// Reads the last bytes of the file: at most [`TAIL`], all of a smaller file.
    pub fn tail(&mut self) -> io::Result<Vec<u8>> {
        read_at(&mut self.file, self.size.saturating_sub(TAIL), TAIL)
    }

    /// Passes the text of the file to `count`, of a longer one samples of complete lines. Returns
    /// the number of bytes passed, for [`scaled`].
    pub fn sample(&mut self, mut count: impl FnMut(&[u8])) -> io::Result<u64> {
        let size = self.size;
        if size <= HEAD {
            count(&self.head);
            return Ok(size);
        }
        // Free the head's memory before the samples are read.
        self.head = Vec::new();
        let mut sampled_bytes = 0;
        for i in 0..SAMPLES {
            let bytes = read_at(&mut self.file, (size - SAMPLE_BYTES) / (SAMPLES - 1) * i, SAMPLE_BYTES)?;
            // Keep only complete lines.
            let start = bytes.iter().position(|byte| *byte == b'\n').map_or(0, |at| at + 1);
            let end = bytes.iter().rposition(|byte| *byte == b'\n').unwrap_or(0);
            let whole = bytes.get(start..end).unwrap_or_default();
            sampled_bytes += whole.len() as u64 + 1;
            count(whole);
        }
        Ok(sampled_bytes)
    }
}

fn read_at(file: &mut impl Source, at: u64, length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(at))?;
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Extrapolates `count` in a sample of `part` bytes to `whole` bytes, plus 5 % if the sample is not
/// the whole.
pub(crate) fn scaled(count: u64, whole: u64, part: u64) -> u64 {
    let exact = u128::from(count) * u128::from(whole) / u128::from(part.max(1));
    let more = if whole > part { exact / 20 } else { 0 };
    u64::try_from(exact + more).unwrap_or(u64::MAX)
}

/// Lines of a sample.
pub(crate) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|byte| matches!(byte, b'\n' | b'\r'))
}

/// Words of a line of a sample; none unless the line is UTF-8.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &str> {
    std::str::from_utf8(line).unwrap_or_default().split_ascii_whitespace()
}
