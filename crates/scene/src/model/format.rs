//! Formats of model files, which other crates implement (`juggler-import` implements glTF).

use super::{Files, ModelChoice, ModelParts, ModelSummary};
use glam::DAffine3;
use juggler_math::{BuildControl, Cancelled};
use std::fmt::Debug;
use std::ops::Add;
use std::sync::Arc;

/// Memory that a model needs before its world is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModelNeeds {
    /// Bytes to open the file and to translate it to parts of a scene, pictures as they are
    /// encoded.
    pub bytes: u64,
    /// Number of spheres and cylinders that its points and lines become.
    pub solids: u64,
}

impl Add for ModelNeeds {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { bytes: self.bytes.saturating_add(other.bytes), solids: self.solids.saturating_add(other.solids) }
    }
}

/// A format of model files.
pub trait ModelFormat: Debug + Send + Sync {
    /// Display name, such as "glTF".
    fn name(&self) -> &'static str;

    /// File name extensions, in lower case, without dots.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether the first bytes of a file are certainly of this format.
    fn is_content(&self, head: &[u8]) -> bool;

    /// Whether a file contains nothing but a mesh, without materials. The scene around such a file
    /// is that of a mesh file. Defaults to `false`.
    fn is_plain_mesh(&self, _bytes: &[u8]) -> bool {
        false
    }

    /// Memory that a file needs, from its document and the lengths of the files that it names; zero
    /// for a file that is not valid. Defaults to zero: the estimate of mesh files suffices.
    fn needs(&self, _bytes: Vec<u8>, _files: &dyn Files) -> ModelNeeds {
        ModelNeeds::default()
    }

    /// Opens a model file. `name` is the file's name in messages; `files` reads the files that it
    /// names.
    ///
    /// # Errors
    ///
    /// The file or one of its files is not valid, is missing, or exceeds a limit.
    fn open(&self, name: &str, bytes: Vec<u8>, files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError>;

    /// [`ModelFormat::open`], which may end early with an error if `control` is cancelled. Defaults to
    /// opening the whole file.
    fn open_with_control(
        &self,
        name: &str,
        bytes: Vec<u8>,
        files: &dyn Files,
        _control: &BuildControl,
    ) -> Result<Arc<dyn ModelFile>, ModelError> {
        self.open(name, bytes, files)
    }
}

/// A file with the hash of its content.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FileDigest {
    /// Name of the file.
    pub name: String,
    /// BLAKE3 hash of the content.
    pub digest: [u8; 32],
}

/// An opened model file. All files that it names are read.
pub trait ModelFile: Debug + Send + Sync {
    /// Hash of the file without the files that it names. It may be equal for texts of equal meaning.
    fn digest(&self) -> [u8; 32];

    /// The files that the file names, relative to its folder, in the order of reading.
    fn files(&self) -> &[FileDigest];

    /// Memory in bytes that the opened file holds beside its parts. Defaults to 0.
    fn bytes(&self) -> u64 {
        0
    }

    /// Whether the z axis of the file points up. A scene around the file rotates it. Defaults to
    /// `false`: y points up.
    fn is_z_up(&self) -> bool {
        false
    }

    /// Translates the file to parts of a scene. The names of all parts begin with `prefix`.
    ///
    /// The time of the choice changes values only: the numbers, the order and the names of objects,
    /// materials, lights and cameras are the same at all times. Meshes that do not deform share
    /// their arrays at all times.
    ///
    /// # Errors
    ///
    /// The content is not valid, or the choice names something that the file does not have.
    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError>;

    /// [`ModelFile::parts`], which may end early with an error if `control` is cancelled. Defaults to
    /// translating the whole file.
    fn parts_with_control(
        &self,
        choice: &ModelChoice,
        prefix: &str,
        _control: &BuildControl,
    ) -> Result<ModelParts, ModelError> {
        self.parts(choice, prefix)
    }

    /// Transform of a node to the space of the file, in the pose of a choice. `node` is the name of
    /// the node, or a path of names such as "Root/Body/Head". Defaults to an error: the format has
    /// no nodes.
    ///
    /// # Errors
    ///
    /// The file has no such node, several nodes have the name, or the choice names something that
    /// the file does not have.
    fn node_transform(&self, node: &str, _choice: &ModelChoice) -> Result<DAffine3, ModelError> {
        Err(ModelError::new(format!("there is no node `{node}`: files of this format have no nodes")))
    }

    /// Whether a choice shows an animation, so that the parts depend on its time.
    fn moves(&self, choice: &ModelChoice) -> bool;

    /// Describes the file for people and programs.
    ///
    /// # Errors
    ///
    /// As [`ModelFile::parts`].
    fn summary(&self, choice: &ModelChoice) -> Result<ModelSummary, ModelError>;
}

/// Why a model file cannot be read: all faults at once, each with its place in the file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .faults.join("\n"))]
pub struct ModelError {
    /// Messages such as "car.glb: /accessors/7: needs 48 bytes from byte 1020". At least one.
    pub faults: Vec<String>,
}

impl From<Cancelled> for ModelError {
    fn from(cancelled: Cancelled) -> Self {
        Self::new(cancelled.to_string())
    }
}

impl ModelError {
    /// Creates an error of a single fault.
    pub fn new(fault: impl Into<String>) -> Self {
        Self { faults: vec![fault.into()] }
    }
}
