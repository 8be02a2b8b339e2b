//! Destinations of images: regular files (replaced atomically), devices, standard output, memory.

use crate::atomic::{AtomicFile, is_device_or_pipe};
use crate::{Header, ImageError, ImageFormat, RowWriter, writer};
use juggler_math::{Image, PixelRows};
use std::fs::File;
use std::io::{self, BufWriter, Cursor, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Seekable output.
pub trait WriteSeek: Write + Seek + Send {}
impl<T: Write + Seek + Send> WriteSeek for T {}

/// Output with a name for messages.
pub struct Destination {
    name: String,
    sink: Sink,
}

enum Sink {
    Seekable(Box<dyn WriteSeek>),
    Stream(Box<dyn Write + Send>),
}

impl Destination {
    /// A file or memory; `sink` should be buffered.
    pub fn seekable(name: impl Into<String>, sink: impl Write + Seek + Send + 'static) -> Self {
        Self { name: name.into(), sink: Sink::Seekable(Box::new(sink)) }
    }

    /// A pipe, which cannot seek: formats that need to seek buffer the whole file in memory.
    pub fn stream(name: impl Into<String>, sink: impl Write + Send + 'static) -> Self {
        Self { name: name.into(), sink: Sink::Stream(Box::new(sink)) }
    }

    /// Name for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn into_stream(self) -> Box<dyn Write + Send> {
        match self.sink {
            Sink::Seekable(sink) => Box::new(sink),
            Sink::Stream(sink) => sink,
        }
    }

    /// Converts to seekable output. Flush it exactly once, at the end: a pipe receives the data
    /// only then.
    pub(crate) fn into_seekable(self) -> Box<dyn WriteSeek> {
        match self.sink {
            Sink::Seekable(sink) => sink,
            Sink::Stream(pipe) => Box::new(BufferedPipe { pipe, bytes: Cursor::default() }),
        }
    }
}

/// A file buffered in memory, which `flush` writes to the pipe.
struct BufferedPipe {
    pipe: Box<dyn Write + Send>,
    bytes: Cursor<Vec<u8>>,
}

impl Write for BufferedPipe {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.pipe.write_all(&std::mem::take(&mut self.bytes).into_inner())?;
        self.pipe.flush()
    }
}

impl Seek for BufferedPipe {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// Creates a writer to a file, which appears at `path` only once it is finished. Devices
/// (`/dev/null`) and named pipes are written directly.
pub fn create(path: &Path, format: ImageFormat, header: &Header) -> Result<Box<dyn RowWriter>, ImageError> {
    format.check_dimensions(header.width, header.height)?;
    header.check(format)?;
    let (destination, file) = whole_file(path)?;
    let name = destination.name().to_owned();
    let rows = writer(format, destination, header)?;
    Ok(match file {
        Some(file) => Box::new(WholeFile { rows, file, name }),
        None => rows,
    })
}

/// Opens a temporary file, which replaces the file at `path` when it is committed. Devices and
/// named pipes are written directly, without a file to commit.
pub(crate) fn whole_file(path: &Path) -> Result<(Destination, Option<AtomicFile>), ImageError> {
    let name = path.display().to_string();
    let failed = |source| ImageError::Write { file: name.clone(), source };
    if is_device_or_pipe(path) {
        let device = File::options().write(true).open(path).map_err(failed)?;
        return Ok((Destination::stream(name, BufWriter::new(device)), None));
    }
    let file = AtomicFile::create(path).map_err(failed)?;
    let handle = BufWriter::with_capacity(1 << 16, file.handle().map_err(failed)?);
    Ok((Destination::seekable(name, handle), Some(file)))
}

/// Creates a writer to standard output.
pub fn to_standard_output(format: ImageFormat, header: &Header) -> Result<Box<dyn RowWriter>, ImageError> {
    writer(format, Destination::stream("standard output", BufWriter::new(io::stdout())), header)
}

/// Encodes a complete image, given row by row, and returns the bytes of its file.
///
/// ```
/// use juggler_imaging::{Header, ImageFormat, to_memory};
/// use juggler_math::Rgb;
///
/// let bytes = to_memory(ImageFormat::Png, &Header::new(2, 1), &[Rgb::BLACK, Rgb::WHITE])?;
/// assert!(bytes.starts_with(b"\x89PNG"));
/// # Ok::<(), juggler_imaging::ImageError>(())
/// ```
pub fn to_memory<'a>(
    format: ImageFormat,
    header: &Header,
    pixels: impl Into<PixelRows<'a>>,
) -> Result<Vec<u8>, ImageError> {
    format.check_dimensions(header.width, header.height)?;
    header.check(format)?;
    let bytes = SharedBytes::default();
    let mut rows = writer(format, Destination::seekable("memory", bytes.clone()), header)?;
    rows.write_rows(pixels.into())?;
    rows.finish()?;
    Ok(std::mem::take(bytes.lock().get_mut()))
}

/// Bytes that a writer writes and the function that made it reads.
#[derive(Clone, Default)]
struct SharedBytes(Arc<Mutex<Cursor<Vec<u8>>>>);

impl SharedBytes {
    fn lock(&self) -> std::sync::MutexGuard<'_, Cursor<Vec<u8>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for SharedBytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.lock().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for SharedBytes {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.lock().seek(to)
    }
}

/// Writes a complete image.
pub fn write_image(rows: Box<dyn RowWriter>, image: &Image) -> Result<(), ImageError> {
    let mut rows = rows;
    rows.write_rows(image.pixels().into())?;
    rows.finish()
}

/// Writer to a temporary file that replaces the old file only when it is finished.
struct WholeFile {
    rows: Box<dyn RowWriter>,
    file: AtomicFile,
    name: String,
}

impl RowWriter for WholeFile {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        self.rows.write_rows(rows)
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { rows, file, name } = *self;
        rows.finish()?;
        file.commit().map_err(|source| ImageError::Write { file: name, source })
    }
}
