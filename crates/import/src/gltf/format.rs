//! glTF as a format of model files.

use super::data::GltfData;
use super::error::{Fault, GltfError};
use super::limits::Limits;
use super::open::Gltf;
use super::translate::{ClipSet, GeometryCache, Names, Source, translate};
use super::{is_binary, summary};
use juggler_scene::model::{
    FileError, Files, ModelChoice, ModelError, ModelFile, ModelFormat, ModelParts, ModelSummary,
};
use std::cell::RefCell;
use std::sync::Arc;

/// The format glTF 2.0: `.gltf` and `.glb`.
#[derive(Clone, Copy, Debug, Default)]
pub struct GltfFormat;

/// An opened glTF file.
#[derive(Debug)]
pub struct GltfModel {
    pub(super) data: GltfData,
    pub(super) clips: ClipSet,
    pub(super) names: Names,
    geometry: GeometryCache,
    files: Vec<String>,
    digest: [u8; 32],
}

impl ModelFormat for GltfFormat {
    fn name(&self) -> &'static str {
        "glTF"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["gltf", "glb"]
    }

    fn is_content(&self, head: &[u8]) -> bool {
        is_binary(head)
    }

    fn open(&self, name: &str, bytes: Vec<u8>, files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError> {
        let recorder = Recorder { files, read: RefCell::default() };
        let mut hasher = blake3::Hasher::new();
        hasher.update(&bytes);
        let gltf = Gltf::open(name, bytes, &Limits::default()).map_err(|error| model_error(&error))?;
        let mut data = gltf.load(&recorder).map_err(|error| model_error(&error))?;
        data.load_images(&recorder).map_err(|error| model_error(&error))?;
        let names = Names::new(&data.gltf.document);
        let clips = ClipSet::new(&data, &names).map_err(|fault| model_error(&data.error(fault)))?;
        let read = recorder.read.into_inner();
        for (_, digest) in &read {
            hasher.update(digest);
        }
        let files = read.into_iter().map(|(name, _)| name).collect();
        let digest = hasher.finalize().into();
        Ok(Arc::new(GltfModel { data, clips, names, geometry: GeometryCache::default(), files, digest }))
    }
}

impl GltfModel {
    pub(super) fn source(&self) -> Source<'_> {
        Source { data: &self.data, clips: &self.clips, geometry: &self.geometry, names: &self.names }
    }

    pub(super) fn failed(&self, fault: Fault) -> ModelError {
        model_error(&self.data.error(fault))
    }
}

impl ModelFile for GltfModel {
    fn digest(&self) -> [u8; 32] {
        self.digest
    }

    fn files(&self) -> &[String] {
        &self.files
    }

    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError> {
        let mut parts = translate(&self.source(), choice, prefix).map_err(|fault| self.failed(fault))?;
        let mut warnings = self.data.gltf.warnings.clone();
        warnings.append(self.clips.warnings.clone());
        let known = super::translate::texts(&warnings);
        parts.warnings = known.into_iter().chain(parts.warnings).collect();
        Ok(parts)
    }

    fn summary(&self, choice: &ModelChoice) -> Result<ModelSummary, ModelError> {
        summary::summary(self, choice)
    }
}

fn model_error(error: &GltfError) -> ModelError {
    ModelError { faults: error.to_string().lines().map(str::to_owned).collect() }
}

/// Files that remember what was read.
struct Recorder<'f> {
    files: &'f dyn Files,
    /// Names and BLAKE3 hashes of the files, in the order of reading.
    read: RefCell<Vec<(String, [u8; 32])>>,
}

impl Files for Recorder<'_> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let bytes = self.files.read(name, limit)?;
        self.read.borrow_mut().push((name.to_owned(), blake3::hash(&bytes).into()));
        Ok(bytes)
    }
}
