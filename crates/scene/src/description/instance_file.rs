//! File of instances.

use serde::{Deserialize, Serialize};

/// Name of a file of instances, or of an asset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct InstanceFile {
    name: String,
    /// Number of instances that the head of the file declares, for estimates; 0 until it is read.
    declared_count: usize,
}

impl InstanceFile {
    /// Creates the name of a file, relative to the scene file, or of an asset.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), declared_count: 0 }
    }

    /// Name of the file or asset.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of instances that the head of the file declares; 0 until it is read.
    pub(crate) fn declared_count(&self) -> usize {
        self.declared_count
    }

    /// The file with the number of instances that its head declares.
    pub(crate) fn with_declared_count(&self, declared_count: usize) -> Self {
        Self { declared_count, ..self.clone() }
    }
}

impl From<String> for InstanceFile {
    fn from(name: String) -> Self {
        Self::new(name)
    }
}

impl From<InstanceFile> for String {
    fn from(file: InstanceFile) -> Self {
        file.name
    }
}
