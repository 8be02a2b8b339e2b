//! Model files of a scene. Each is opened once and shared by all objects, frames and copies of the
//! scene.

use super::{FileDigest, FileError, Files, ModelFile, ModelFormat, ModelNeeds};
use crate::compile::file_stamp;
use crate::picture_reading::PictureReading;
use crate::report::plain_io;
use crate::store::{MAX_FILE_BYTES, Store};
use juggler_imaging::regular::ReadError;
use juggler_math::BuildControl;
use juggler_mesh::UnsupportedFormat;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Opened model files by canonical path, and the formats that can be opened.
#[derive(Clone, Debug, Default)]
pub struct ModelCache {
    formats: &'static [&'static dyn ModelFormat],
    /// Whether pictures that are missing or broken are shown gray.
    is_lenient: bool,
    pictures: PictureReading,
    entries: Arc<Mutex<BTreeMap<PathBuf, Arc<OpenedModel>>>>,
}

/// An opened model file, or error messages.
#[derive(Debug)]
pub struct OpenedModel {
    /// The file, or messages that name it.
    pub file: Result<Arc<dyn ModelFile>, Vec<String>>,
    /// Hashes of the file and of the files that it names; none if it cannot be opened.
    pub digests: Arc<[FileDigest]>,
    /// The file and the files that it names, each with length and modification time before it was
    /// read.
    stamps: Vec<(PathBuf, Option<(u64, SystemTime)>)>,
}

impl OpenedModel {
    /// The file and the files that it names.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.stamps.iter().map(|(path, _)| path)
    }
}

impl ModelCache {
    /// Cache of these formats. With `is_lenient`, pictures that are missing or broken are shown gray.
    pub fn new(formats: &'static [&'static dyn ModelFormat], is_lenient: bool, pictures: PictureReading) -> Self {
        Self { formats, is_lenient, pictures, ..Self::default() }
    }

    /// Format of a file by its first bytes, or else by the extension of its name.
    pub fn format(&self, path: &Path, head: &[u8]) -> Option<&'static dyn ModelFormat> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let is_named =
            |format: &&dyn ModelFormat| format.extensions().iter().any(|e| e.eq_ignore_ascii_case(extension));
        let by_content = self.formats.iter().find(|format| format.is_content(head));
        by_content.or_else(|| self.formats.iter().find(|format| is_named(format))).copied()
    }

    /// Cache without the files that have changed.
    pub fn without_changed_files(&self) -> Self {
        let same = |model: &OpenedModel| {
            model.file.is_ok() && model.stamps.iter().all(|(path, stamp)| stamp.is_some() && *stamp == file_stamp(path))
        };
        let entries = self.entries();
        let kept = entries.iter().filter(|(_, model)| same(model));
        let kept = kept.map(|(path, model)| (path.clone(), Arc::clone(model))).collect();
        Self { entries: Arc::new(Mutex::new(kept)), ..*self }
    }

    /// Opens a file without holding the lock, as for meshes. If `control` is cancelled, the model has
    /// a message and is not kept.
    pub fn get(&self, path: &Path, store: &Store, control: &BuildControl) -> Arc<OpenedModel> {
        let name = store.canonical_name(path);
        if let Some(known) = self.entries().get(&name) {
            return Arc::clone(known);
        }
        let model = Arc::new(self.open(path, store, control));
        if control.is_cancelled() {
            return model;
        }
        Arc::clone(self.entries().entry(name).or_insert(model))
    }

    /// Memory that a model file needs; zero for other files.
    pub fn needs(&self, path: &Path, store: &Store) -> ModelNeeds {
        let Ok(bytes) = store.read_bytes(path, MAX_FILE_BYTES) else { return ModelNeeds::default() };
        let beside = FolderFiles { folder: path.parent().unwrap_or(Path::new("")), store, models: self };
        let format = self.format(path, &bytes);
        format.map_or_else(ModelNeeds::default, |format| format.needs(bytes.into_owned(), &beside))
    }

    fn open(&self, path: &Path, store: &Store, control: &BuildControl) -> OpenedModel {
        let (folder, shown) = (path.parent().unwrap_or(Path::new("")), path.display().to_string());
        let mut stamps = vec![(path.to_owned(), file_stamp(path))];
        let none = || Arc::from(Vec::new());
        let failed =
            |message: String| OpenedModel { file: Err(vec![message]), digests: none(), stamps: stamps.clone() };
        let bytes = match store.read_bytes(path, MAX_FILE_BYTES) {
            Ok(bytes) => bytes.into_owned(),
            Err(error) => return failed(crate::compile::read_error_message(path, &error, store)),
        };
        let Some(format) = self.format(path, &bytes) else {
            let foreign = UnsupportedFormat::of_content(&bytes).or_else(|| UnsupportedFormat::of_name(path));
            let unknown = || format!("`{shown}` is in no known format of models");
            return failed(foreign.map_or_else(unknown, |foreign| format!("`{shown}`: {foreign}")));
        };
        let beside = FolderFiles { folder, store, models: self };
        match format.open_with_control(&shown, bytes, &beside, control) {
            Ok(file) => {
                let others = file.files().iter().map(|other| folder.join(&other.name));
                stamps.extend(others.map(|path| (path.clone(), file_stamp(&path))));
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let own = FileDigest { name, digest: file.digest() };
                let digests = std::iter::once(own).chain(file.files().iter().cloned()).collect();
                OpenedModel { file: Ok(file), digests, stamps }
            }
            Err(mut error) => {
                let models = &Self { is_lenient: true, ..self.clone() };
                let lenient = FolderFiles { models, ..beside };
                let opens =
                    |bytes: Cow<'_, [u8]>| format.open_with_control(&shown, bytes.into_owned(), &lenient, control);
                let helps =
                    !self.is_lenient && store.read_bytes(path, MAX_FILE_BYTES).is_ok_and(|bytes| opens(bytes).is_ok());
                if let Some(last) = error.faults.last_mut().filter(|_| helps) {
                    last.push_str("; `--lenient` shows such pictures gray");
                }
                OpenedModel { file: Err(error.faults), digests: none(), stamps }
            }
        }
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<OpenedModel>>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Files in the folder of a model file.
struct FolderFiles<'f> {
    folder: &'f Path,
    store: &'f Store,
    models: &'f ModelCache,
}

impl Files for FolderFiles<'_> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let path = self.folder.join(name);
        if self.store.leads_out(&path, self.folder) {
            return Err(FileError::Outside);
        }
        self.store.read_bytes(&path, limit).map(Cow::into_owned).map_err(|error| match error {
            ReadError::Io(error) if error.kind() == ErrorKind::NotFound => FileError::Missing,
            ReadError::Io(error) => FileError::Read(plain_io(&error)),
            ReadError::TooLarge { found, limit } => FileError::TooLarge { found, limit },
        })
    }

    fn length(&self, name: &str) -> Option<u64> {
        self.store.length(&self.folder.join(name))
    }

    fn is_lenient(&self) -> bool {
        self.models.is_lenient
    }

    fn pictures(&self) -> PictureReading {
        self.models.pictures
    }
}
