//! Storage of a scene's files: the file system, or memory.

use crate::asset::{Assets, display_name};
use crate::document::{self, Unreadable, text_of};
use crate::named;
use crate::suggest::closest;
use juggler_imaging::regular::{self, ReadError};
use juggler_imaging::{Limits, RasterHead, raster_head};
use juggler_mesh::{FileContent, PointEstimate, estimate_bytes, estimate_points, points_of_head};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{BufReader, Cursor, ErrorKind};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Maximum number of bytes of a file, unless its reader has a lower limit: 4 GiB.
pub(crate) const MAX_FILE_BYTES: u64 = 1 << 32;

/// Maximum number of file names that are searched for suggestions. A scene may name many missing
/// files.
const MAX_NAMES: usize = 1000;

/// Number of first bytes by which formats of models are recognized.
const HEAD: usize = 16;

/// Storage of a scene's files and assets.
#[derive(Clone, Debug, Default)]
pub struct Store {
    backend: Backend,
    pub(crate) assets: Assets,
}

/// Origin of the files.
#[derive(Clone, Debug, Default)]
enum Backend {
    /// The file system.
    #[default]
    Disk,
    /// Only these files.
    Memory(Bundle),
}

impl From<Bundle> for Store {
    /// Creates a store of only the files of a bundle.
    fn from(bundle: Bundle) -> Self {
        Self { backend: Backend::Memory(bundle), assets: Assets::default() }
    }
}

/// Files in memory, by name. Cheap to clone.
///
/// A file is found by its path, or else by its name alone, since files dropped on a web page come
/// without their folders.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bundle(Arc<BTreeMap<PathBuf, Vec<u8>>>);

impl FromIterator<(String, Vec<u8>)> for Bundle {
    fn from_iter<Files: IntoIterator<Item = (String, Vec<u8>)>>(files: Files) -> Self {
        Self(Arc::new(files.into_iter().map(|(name, bytes)| (normalize(Path::new(&name)), bytes)).collect()))
    }
}

impl Bundle {
    /// Number of bytes of all files.
    pub fn bytes(&self) -> u64 {
        self.0.values().map(|bytes| bytes.len() as u64).fold(0, u64::saturating_add)
    }

    /// Upper bound of the memory of all mesh files (OBJ, PLY, STL) while they are read and their
    /// hierarchies are built, in bytes.
    pub fn mesh_bytes(&self) -> u64 {
        let meshes = self.0.iter().filter(|(path, bytes)| {
            let content = FileContent::from_head(path, bytes, bytes.len() as u64);
            content.is_mesh()
        });
        let peaks = meshes.map(|(path, bytes)| estimate_bytes(path, bytes).peak_bytes);
        peaks.fold(0, u64::saturating_add)
    }

    fn find(&self, path: &Path) -> Option<(&PathBuf, &Vec<u8>)> {
        let alone = || self.0.get_key_value(Path::new(path.file_name()?));
        self.0.get_key_value(&normalize(path)).or_else(alone)
    }

    /// Name of the file that resembles a missing one most.
    fn similar_file(&self, path: &Path) -> Option<String> {
        let names = self.0.keys().filter_map(|path| path.file_name()?.to_str()).take(MAX_NAMES);
        closest(path.file_name()?.to_str()?, names).map(str::to_owned)
    }
}

impl Store {
    /// Whether the store holds only files in memory.
    pub(crate) fn is_in_memory(&self) -> bool {
        matches!(self.backend, Backend::Memory(_))
    }

    /// Reads the text of a file.
    pub(crate) fn text(&self, path: &Path) -> Result<String, Unreadable> {
        match &self.backend {
            Backend::Disk => document::read_text(path),
            Backend::Memory(bundle) => {
                let (_, bytes) = bundle.find(path).ok_or_else(|| Unreadable::Io(ErrorKind::NotFound.into()))?;
                text_of(bytes.clone()).map_err(Unreadable::NotText)
            }
        }
    }

    /// Detects the content of a file that was given as a scene.
    pub(crate) fn content(&self, path: &Path) -> FileContent {
        match &self.backend {
            Backend::Disk => FileContent::detect(path),
            Backend::Memory(bundle) => bundle
                .find(path)
                .map_or(FileContent::Other, |(_, bytes)| FileContent::from_head(path, bytes, bytes.len() as u64)),
        }
    }

    /// First bytes of a file, by which formats are recognized; none if the file cannot be read.
    pub(crate) fn head(&self, path: &Path) -> Vec<u8> {
        match &self.backend {
            Backend::Disk => regular::first_bytes(path, HEAD as u64).unwrap_or_default(),
            Backend::Memory(bundle) => {
                let bytes = bundle.find(path).map(|(_, bytes)| bytes.as_slice()).unwrap_or_default();
                bytes.get(..HEAD).unwrap_or(bytes).to_vec()
            }
        }
    }

    /// Head of a picture, and the length of its file in bytes; `None` if it cannot be read.
    pub(crate) fn picture_head(&self, path: &Path, limits: &Limits) -> Option<(RasterHead, u64)> {
        let name = display_name(path);
        let of_bytes = |bytes: &[u8]| {
            let head = raster_head(&name, Cursor::new(bytes), limits).ok()?;
            Some((head, bytes.len() as u64))
        };
        match (self.assets.at(path), &self.backend) {
            (Some(asset), _) => of_bytes(asset.bytes()?),
            (None, Backend::Memory(bundle)) => of_bytes(bundle.find(path)?.1),
            (None, Backend::Disk) => {
                let file = regular::open(path).ok()?;
                let length = file.metadata().ok()?.len();
                Some((raster_head(&name, BufReader::new(file), limits).ok()?, length))
            }
        }
    }

    /// Memory of the points of a PLY file, from its head; zero for a file that cannot be read.
    pub(crate) fn points_of_head(&self, path: &Path) -> PointEstimate {
        let of_bytes = |bytes: &[u8]| points_of_head(bytes, bytes.len() as u64);
        if let Some(asset) = self.assets.at(path) {
            return asset.bytes().map(of_bytes).unwrap_or_default();
        }
        match &self.backend {
            Backend::Disk => estimate_points(path).unwrap_or_default(),
            Backend::Memory(bundle) => bundle.find(path).map(|(_, bytes)| of_bytes(bytes)).unwrap_or_default(),
        }
    }

    /// Reads the bytes of a file or asset. Files are limited to `limit` bytes.
    pub(crate) fn read_bytes(&self, path: &Path, limit: u64) -> Result<Cow<'_, [u8]>, ReadError> {
        if let Some(asset) = self.assets.at(path) {
            let wrong = || {
                let content = asset.content_name();
                std::io::Error::other(format!("the asset of this name contains {content}, not the bytes of a file"))
            };
            let bytes = asset.bytes().map(Cow::Borrowed);
            return bytes.ok_or_else(|| wrong().into());
        }
        match &self.backend {
            Backend::Disk => regular::read(path, limit).map(Cow::Owned),
            Backend::Memory(bundle) => match bundle.find(path) {
                Some((_, bytes)) => Ok(Cow::Borrowed(bytes)),
                None => Err(std::io::Error::from(ErrorKind::NotFound).into()),
            },
        }
    }

    /// Whether a file whose name stays in a folder is elsewhere, because of a symbolic link.
    pub(crate) fn leads_out(&self, path: &Path, folder: &Path) -> bool {
        if self.is_in_memory() || self.assets.at(path).is_some() {
            return false;
        }
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        match (std::fs::canonicalize(path), std::fs::canonicalize(folder)) {
            (Ok(file), Ok(folder)) => !file.starts_with(folder),
            // The reader reports a file that does not exist.
            _ => false,
        }
    }

    /// Question that suggests a file of the same folder for a missing one; empty for all other errors.
    pub(crate) fn suggestion(&self, path: &Path, error: &std::io::Error) -> String {
        if error.kind() != ErrorKind::NotFound {
            return String::new();
        }
        let fixed = named::with_slashes(path);
        let exists = |fixed: &String| self.length(&path.with_file_name(fixed)).is_some();
        if let Some(fixed) = fixed.as_ref().filter(|fixed| !exists(fixed)) {
            return format!("; write `/` in place of `\\`: `{fixed}`");
        }
        named::question(match &self.backend {
            _ if fixed.is_some() => fixed,
            Backend::Disk => named::similar_file(path, MAX_NAMES),
            Backend::Memory(bundle) => bundle.similar_file(path),
        })
    }

    /// Length of a file in bytes; `None` if it cannot be read.
    pub(crate) fn length(&self, path: &Path) -> Option<u64> {
        match (self.assets.at(path), &self.backend) {
            (Some(asset), _) => asset.bytes().map(|bytes| bytes.len() as u64),
            (None, Backend::Disk) => Some(std::fs::metadata(path).ok()?.len()),
            (None, Backend::Memory(bundle)) => Some(bundle.find(path)?.1.len() as u64),
        }
    }

    /// Canonical name, which is equal for equal files.
    pub(crate) fn canonical_name(&self, path: &Path) -> PathBuf {
        if self.assets.at(path).is_some() {
            return path.to_owned();
        }
        match &self.backend {
            Backend::Disk => std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()),
            Backend::Memory(bundle) => bundle.find(path).map_or_else(|| normalize(path), |(name, _)| name.clone()),
        }
    }
}

/// Normalizes a path: removes `.`, and `..` together with the folder before it.
fn normalize(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut normal, component| {
        match component {
            Component::CurDir => {}
            Component::ParentDir if normal.file_name().is_some() => {
                normal.pop();
            }
            other => normal.push(other),
        }
        normal
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bundle(names: &[&str]) -> Store {
        let file = |name: &&str| ((*name).to_owned(), name.as_bytes().to_vec());
        names.iter().map(file).collect::<Bundle>().into()
    }

    #[test]
    fn bundled_files_are_found_by_path_then_by_file_name() {
        let store = bundle(&["scene.json", "models/a.obj", "b.obj", "./c/../d.obj"]);
        let found = |path: &str| {
            let bytes = store.read_bytes(Path::new(path), MAX_FILE_BYTES);
            bytes.map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        };
        assert_eq!(found("./models/x/../a.obj").unwrap(), "models/a.obj");
        assert_eq!(found("elsewhere/b.obj").unwrap(), "b.obj", "by its name alone");
        assert_eq!(found("d.obj").unwrap(), "./c/../d.obj");
        let missing = |error: &ReadError| matches!(error, ReadError::Io(error) if error.kind() == ErrorKind::NotFound);
        assert!(found("a.obj").is_err_and(|error| missing(&error)), "in a folder nobody named");
        assert_eq!(store.canonical_name(Path::new("elsewhere/b.obj")), Path::new("b.obj"));
        assert_eq!(store.canonical_name(Path::new("x/../y.obj")), Path::new("y.obj"));
        assert!(matches!(store.text(Path::new("none.json")), Err(Unreadable::Io(_))));
        assert_eq!(store.text(Path::new("scene.json")).unwrap(), "scene.json");
    }
}
