//! A file with the contents of its buffers.

use super::document::{Buffer, CompressedView, Index};
use super::error::{Fault, GltfError, Place};
use super::location::Location;
use super::media::Media;
use super::meshopt;
use super::open::Gltf;
use super::uri::{self, Uri};
use super::{FileError, Files};
use juggler_math::message::{MAX_QUOTE, excerpt};
use std::borrow::Cow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes of a document for each byte of its JSON.
const JSON: u64 = 6;

/// Bytes of the pose and the objects of a node beside those of its document, while parts are made.
const NODE: u64 = 600;

/// Contents of a buffer.
#[derive(Debug)]
enum Contents {
    /// The chunk BIN.
    Binary,
    /// Another file, or a data URI.
    Bytes(Vec<u8>),
    /// No data: only readers without the decoder of compressed buffer views need it.
    Fallback,
}

/// A glTF file with the contents of its buffers, from which arrays are decoded. Several threads may
/// decode at once.
#[derive(Debug)]
pub struct GltfData {
    /// The file.
    pub gltf: Gltf,
    buffers: Vec<Contents>,
    /// Compressed buffer views that were decoded.
    views: Vec<OnceLock<Result<Vec<u8>, Fault>>>,
    /// Number of bytes of all arrays decoded so far.
    decoded: AtomicU64,
    /// Maximum number of decoded bytes.
    decoded_limit: u64,
    /// Pictures and light profiles, once they are read.
    pub(super) media: Media,
}

impl GltfData {
    pub(super) fn load(gltf: Gltf, files: &dyn Files) -> Result<Self, GltfError> {
        let list = Location::root("buffers");
        let loaded = gltf.document.buffers.iter().enumerate().map(|(position, buffer)| {
            let at = list.index(position);
            contents(&at, buffer, files, gltf.limits.buffer_bytes)
        });
        let (mut buffers, mut faults) = (Vec::new(), Vec::new());
        loaded.for_each(|result| match result {
            Ok(contents) => buffers.push(contents),
            Err(fault) => faults.push(fault),
        });
        if !faults.is_empty() {
            let omitted = faults.len().saturating_sub(gltf.limits.faults);
            faults.truncate(gltf.limits.faults.max(1));
            return Err(GltfError { file: gltf.name, faults, omitted });
        }
        let sizes = buffers.iter().map(|contents| if let Contents::Bytes(bytes) = contents { bytes.len() } else { 0 });
        let bytes = sizes.fold(gltf.length, |sum, size| sum.saturating_add(size as u64));
        let views = gltf.document.buffer_views.iter().map(|_| OnceLock::new()).collect();
        let decoded_limit = gltf.limits.decoded_bytes_of(bytes);
        Ok(Self { gltf, buffers, views, decoded: AtomicU64::new(0), decoded_limit, media: Media::default() })
    }

    /// Error of a fault in this file.
    pub fn error(&self, fault: Fault) -> GltfError {
        GltfError::new(&self.gltf.name, fault)
    }

    /// Bytes of a buffer.
    ///
    /// # Errors
    ///
    /// The buffer is one for readers without the decoder of compressed buffer views.
    pub fn buffer(&self, index: Index) -> Result<&[u8], Fault> {
        let at = || format!("/buffers/{index}");
        match self.buffers.get(index.get()) {
            Some(Contents::Bytes(bytes)) => Ok(bytes),
            Some(Contents::Binary) => {
                let binary = self.gltf.binary.clone().and_then(|range| self.gltf.bytes.get(range));
                binary.ok_or_else(|| Fault::at(at(), "the BIN chunk is missing"))
            }
            Some(Contents::Fallback) => {
                Err(Fault::at(at(), "has no data; buffer views that are not compressed cannot use it"))
            }
            None => Err(Fault::at(at(), "there is no such buffer")),
        }
    }

    /// Bytes of a buffer view, decoded if it is compressed.
    ///
    /// # Errors
    ///
    /// The compressed data is not valid, or exceeds the limit of decoded bytes.
    pub fn view(&self, index: Index) -> Result<&[u8], Fault> {
        let missing = || Fault::at(format!("/bufferViews/{index}"), "there is no such buffer view");
        let view = self.gltf.document.buffer_views.get(index.get()).ok_or_else(missing)?;
        let Some((name, compressed)) = view.compressed() else {
            let at = format!("/bufferViews/{index}");
            return self.range(&at, view.buffer, view.byte_offset.get(), view.byte_length.get());
        };
        let cell = self.views.get(index.get()).ok_or_else(missing)?;
        let decoded = cell.get_or_init(|| {
            let at = format!("/bufferViews/{index}/extensions/{name}");
            self.decompress(&at, compressed)
        });
        decoded.as_deref().map_err(Clone::clone)
    }

    /// Decodes the data of a compressed buffer view.
    fn decompress(&self, at: &str, view: &CompressedView) -> Result<Vec<u8>, Fault> {
        let data = self.range(at, view.buffer, view.byte_offset.get(), view.byte_length.get())?;
        let (count, stride) = (view.count.get(), view.byte_stride.get());
        self.reserve(at, count.saturating_mul(stride as u64))?;
        let count = usize::try_from(count).map_err(|_| Fault::at(at, "has too many elements"))?;
        meshopt::decode(view.mode.0, view.filter.0, count, stride, data).map_err(|error| Fault::at(at, error))
    }

    /// Range of a buffer.
    fn range(&self, at: &str, buffer: Index, offset: u64, length: u64) -> Result<&[u8], Fault> {
        let bytes = self.buffer(buffer)?;
        let start = usize::try_from(offset).ok();
        let end = offset.checked_add(length).and_then(|end| usize::try_from(end).ok());
        let range = start.zip(end).and_then(|(start, end)| bytes.get(start..end));
        let available = bytes.len();
        let text = || format!("needs {length} bytes from byte {offset}, buffer {buffer} has {available}");
        range.ok_or_else(|| Fault::at(at, text()))
    }

    /// Counts bytes that are about to be decoded.
    ///
    /// # Errors
    ///
    /// All decoded arrays together exceed their limit.
    pub(super) fn reserve(&self, at: &str, bytes: u64) -> Result<(), Fault> {
        let before = self.decoded.fetch_add(bytes, Ordering::Relaxed);
        match before.checked_add(bytes).is_some_and(|all| all <= self.decoded_limit) {
            true => Ok(()),
            false => {
                let limit = self.decoded_limit;
                Err(Fault::at(at, format!("the arrays of the file need more than {limit} bytes, the limit")))
            }
        }
    }

    /// Memory in bytes of the file, its buffers, decoded buffer views, pictures and document.
    pub fn bytes(&self) -> u64 {
        let of_buffer = |contents: &Contents| if let Contents::Bytes(bytes) = contents { bytes.len() } else { 0 };
        let buffers = self.buffers.iter().map(of_buffer);
        let views = self.views.iter().filter_map(|view| Some(view.get()?.as_ref().ok()?.len()));
        let encoded = buffers.chain(views).map(|bytes| bytes as u64).fold(self.media.bytes(), u64::saturating_add);
        let nodes = (self.gltf.document.nodes.len() as u64).saturating_mul(NODE);
        let document = self.gltf.json_length.saturating_mul(JSON).saturating_add(nodes);
        encoded.saturating_add(self.gltf.bytes.len() as u64).saturating_add(document)
    }

    /// Number of bytes of all arrays decoded so far.
    pub fn decoded_bytes(&self) -> u64 {
        self.decoded.load(Ordering::Relaxed)
    }

    /// Maximum number of bytes of all decoded arrays.
    pub(super) fn decoded_limit(&self) -> u64 {
        self.decoded_limit
    }

    /// Bytes of an image file.
    ///
    /// # Errors
    ///
    /// The file is missing or too large, or its data URI is not valid.
    pub fn image(&self, index: Index, files: &dyn Files) -> Result<Cow<'_, [u8]>, Fault> {
        let missing = || Fault::at(format!("/images/{index}"), "there is no such image");
        let image = self.gltf.document.images.get(index.get()).ok_or_else(missing)?;
        self.data(&format!("/images/{index}"), image.uri.as_deref(), image.buffer_view, files)
    }

    /// JSON pointer of an image, with its name or that of its file for people.
    pub fn image_place(&self, index: Index) -> String {
        let name = self.own_image_name(index).map_or_else(String::new, |name| format!(" ({name})"));
        format!("/images/{index}{name}")
    }

    /// Name of a picture for messages: its own, that of its file, or else its JSON pointer.
    pub fn image_name(&self, index: Index) -> String {
        self.own_image_name(index).unwrap_or_else(|| format!("/images/{index}"))
    }

    fn own_image_name(&self, index: Index) -> Option<String> {
        let image = self.gltf.document.images.get(index.get())?;
        let uri = || Uri::parse(image.uri.as_deref()?).ok();
        let file = || uri()?.file_name().map(|name| excerpt(name, MAX_QUOTE));
        image.name.as_deref().map(|name| excerpt(name, MAX_QUOTE)).or_else(file)
    }

    /// Bytes of an object that has either a URI or a buffer view, at a JSON pointer.
    ///
    /// # Errors
    ///
    /// The file is missing or too large, or its data URI is not valid.
    pub fn data(
        &self,
        pointer: &str,
        uri: Option<&str>,
        view: Option<Index>,
        files: &dyn Files,
    ) -> Result<Cow<'_, [u8]>, Fault> {
        match (uri, view) {
            (Some(uri), _) => {
                read(&format!("{pointer}/uri"), uri, files, self.gltf.limits.buffer_bytes).map(Cow::Owned)
            }
            (None, Some(view)) => self.view(view).map(Cow::Borrowed),
            (None, None) => Err(Fault::at(pointer, "has neither `uri` nor `bufferView`")),
        }
    }
}

/// Loads a buffer.
fn contents(at: &Location<'_>, buffer: &Buffer, files: &dyn Files, limit: u64) -> Result<Contents, Fault> {
    let Some(uri) = &buffer.uri else {
        return Ok(if buffer.is_fallback() { Contents::Fallback } else { Contents::Binary });
    };
    let bytes = match read(&at.key("uri").to_string(), uri, files, limit) {
        Ok(bytes) => bytes,
        Err(_) if buffer.is_fallback() => return Ok(Contents::Fallback),
        Err(fault) => return Err(fault),
    };
    let needed = buffer.byte_length;
    if (bytes.len() as u64) < needed.get() {
        return Err(Fault::at(at, format!("needs {needed} bytes, its data has {}", bytes.len())));
    }
    Ok(Contents::Bytes(bytes))
}

/// Reads what a URI names; the pointer is that of the URI.
fn read(pointer: &str, uri: &str, files: &dyn Files, limit: u64) -> Result<Vec<u8>, Fault> {
    let names = match Uri::parse(uri).map_err(|error| Fault::at(pointer, error))? {
        Uri::Data { data, .. } => return uri::decode(data).map_err(|error| Fault::at(pointer, error)),
        Uri::File(names) => names,
    };
    let mut fault = None;
    for name in names {
        match files.read(&name, limit) {
            Ok(bytes) => return Ok(bytes),
            Err(FileError::Missing) if fault.is_some() => {}
            Err(error) => {
                let is_missing = error == FileError::Missing;
                fault = Some(Fault::new(Place::File { name, pointer: pointer.to_owned() }, error));
                if !is_missing {
                    break;
                }
            }
        }
    }
    Err(fault.unwrap_or_else(|| Fault::at(pointer, FileError::Missing)))
}
