//! glTF as a format of model files.

use super::digest::digest;
use super::document::Document;
use super::error::{Fault, GltfError};
use super::limits::Limits;
use super::open::Gltf;
use super::translate::Content;
use super::{is_binary, needs, summary};
use glam::DAffine3;
use juggler_math::BuildControl;
use juggler_scene::PictureReading;
use juggler_scene::model::{
    FileDigest, FileError, Files, ModelChoice, ModelError, ModelFile, ModelFormat, ModelNeeds, ModelParts, ModelSummary,
};
use std::cell::RefCell;
use std::sync::Arc;

/// The format glTF 2.0: `.gltf` and `.glb`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GltfFormat {
    /// Limits of the files; [`Limits::default`] if `None`.
    pub limits: Option<Limits>,
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

    fn needs(&self, bytes: Vec<u8>, files: &dyn Files) -> ModelNeeds {
        let gltf = Gltf::open("", bytes, &self.limits.unwrap_or_default());
        gltf.map_or_else(|_| ModelNeeds::default(), |gltf| needs::needs(&gltf, files))
    }

    fn open(&self, name: &str, bytes: Vec<u8>, files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError> {
        self.open_with_control(name, bytes, files, &BuildControl::default())
    }

    fn open_with_control(
        &self,
        name: &str,
        bytes: Vec<u8>,
        files: &dyn Files,
        control: &BuildControl,
    ) -> Result<Arc<dyn ModelFile>, ModelError> {
        let files = Recorder { files, read: RefCell::default() };
        let limits = self.limits.unwrap_or_default();
        let digest = digest(name, &bytes, &limits);
        let content = Gltf::open(name, bytes, &limits).and_then(|gltf| {
            let mut data = gltf.load(&files)?;
            data.load_media(&files, control)?;
            Content::new(data)
        });
        let content = content.map_err(|error| model_error(&error))?;
        control.check()?;
        Ok(Arc::new(GltfModel { content, files: files.read.into_inner(), digest }))
    }
}

/// An opened file.
#[derive(Debug)]
pub(super) struct GltfModel {
    /// The file with its decoded arrays.
    pub content: Content,
    files: Vec<FileDigest>,
    digest: [u8; 32],
}

impl GltfModel {
    /// The document of the file.
    pub fn document(&self) -> &Document {
        &self.content.data.gltf.document
    }
}

impl ModelFile for GltfModel {
    fn digest(&self) -> [u8; 32] {
        self.digest
    }

    fn files(&self) -> &[FileDigest] {
        &self.files
    }

    fn bytes(&self) -> u64 {
        let deformable = self.content.meshes.deformable_bytes();
        self.content.data.bytes().saturating_add(deformable)
    }

    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError> {
        self.parts_with_control(choice, prefix, &BuildControl::default())
    }

    fn parts_with_control(
        &self,
        choice: &ModelChoice,
        prefix: &str,
        control: &BuildControl,
    ) -> Result<ModelParts, ModelError> {
        let parts = self.content.parts(choice, prefix, control).map_err(|error| model_error(&error));
        control.check()?;
        parts
    }

    fn node_transform(&self, node: &str, choice: &ModelChoice) -> Result<DAffine3, ModelError> {
        self.content.node_transform(node, choice).map_err(|error| model_error(&error))
    }

    fn moves(&self, choice: &ModelChoice) -> bool {
        self.content.moves(choice)
    }

    fn summary(&self, choice: &ModelChoice) -> Result<ModelSummary, ModelError> {
        summary::summary(self, choice).map_err(|error| model_error(&error))
    }
}

/// Error of a model file: one text for each fault.
fn model_error(error: &GltfError) -> ModelError {
    let one = |fault: &Fault| GltfError::new(&error.file, fault.clone()).to_string();
    let further = (error.omitted > 0).then(|| format!("{} further errors", error.omitted));
    ModelError { faults: error.faults.iter().map(one).chain(further).collect() }
}

/// Files that remember what was read.
struct Recorder<'f> {
    files: &'f dyn Files,
    /// The files in the order of reading.
    read: RefCell<Vec<FileDigest>>,
}

impl Files for Recorder<'_> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let bytes = self.files.read(name, limit)?;
        let digest = blake3::hash(&bytes).into();
        self.read.borrow_mut().push(FileDigest { name: name.to_owned(), digest });
        Ok(bytes)
    }

    fn is_lenient(&self) -> bool {
        self.files.is_lenient()
    }

    fn pictures(&self) -> PictureReading {
        self.files.pictures()
    }
}
