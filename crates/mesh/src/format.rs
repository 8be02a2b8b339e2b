//! Interface of mesh file formats.

use crate::error::MeshErrorKind;
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::PieceReader;
use crate::sampling::{Counts, FileSampler};
use std::io;

/// Name, extension and up axis of a mesh format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshFormatInfo {
    /// Display name, such as "OBJ".
    pub name: &'static str,
    /// File name extension, in lower case, without a dot.
    pub extension: &'static str,
    /// Whether the up axis is z, as usual for 3D printing, instead of y.
    pub is_z_up: bool,
}

/// A format of mesh files.
pub(crate) trait MeshFormat: Sync {
    /// Name, extension and up axis.
    fn info(&self) -> MeshFormatInfo;

    /// Whether the content of a file is certainly of this format.
    fn is_content(&self, bytes: &[u8]) -> bool;

    /// Whether the first bytes of a file of `size` bytes are certainly of this format.
    fn is_head(&self, head: &[u8], _size: u64) -> bool {
        self.is_content(head)
    }

    /// Reads a whole file, in pieces.
    fn read(&self, bytes: &[u8], limits: &MeshLimits, pieces: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind>;

    /// Estimates the counts of a file without reading all of it.
    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts>;
}
