//! Mesh file formats: a closed set, each format in its own file or folder.

use crate::estimate::{Counts, FileSampler};
use crate::{MeshErrorKind, MeshFile, MeshLimits, obj, ply, stl};
use std::io;
use std::path::Path;

/// A format of mesh files.
pub(crate) trait MeshFormat: Sync {
    /// Display name, such as "OBJ".
    fn name(&self) -> &'static str;

    /// File name extension, in lower case, without a dot.
    fn extension(&self) -> &'static str;

    /// Whether the up axis is z, as usual for 3D printing, instead of y.
    fn is_z_up(&self) -> bool {
        false
    }

    /// Whether the content of a file is certainly of this format.
    fn is_content(&self, bytes: &[u8]) -> bool;

    /// Whether the first bytes of a file of `size` bytes are certainly of this format.
    fn is_head(&self, head: &[u8], _size: u64) -> bool {
        self.is_content(head)
    }

    /// Reads a whole file, in pieces of about `piece` bytes.
    fn read(&self, bytes: &[u8], limits: &MeshLimits, piece: usize) -> Result<MeshFile, MeshErrorKind>;

    /// Estimates the counts of a file without reading all of it.
    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts>;
}

/// All formats. STL comes first, since a binary STL may begin with the words of another format.
const FORMATS: &[&dyn MeshFormat] = &[
    &stl::Stl, //
    &obj::Obj,
    &ply::Ply,
];

/// Format of a file by the extension of its name, in any case.
pub(crate) fn of_name(path: &Path) -> Option<&'static dyn MeshFormat> {
    let extension = path.extension()?;
    FORMATS.iter().copied().find(|format| extension.eq_ignore_ascii_case(format.extension()))
}

/// Format of a file by its content, if that is unambiguous.
pub(crate) fn of_content(bytes: &[u8]) -> Option<&'static dyn MeshFormat> {
    FORMATS.iter().copied().find(|format| format.is_content(bytes))
}

/// Format of a file of `size` bytes by its first bytes, if these are unambiguous.
pub(crate) fn of_head(head: &[u8], size: u64) -> Option<&'static dyn MeshFormat> {
    FORMATS.iter().copied().find(|format| format.is_head(head, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(format: Option<&'static dyn MeshFormat>) -> Option<&'static str> {
        format.map(MeshFormat::name)
    }

    #[test]
    fn file_extensions_ignore_case() {
        assert_eq!(name(of_name(Path::new("a/b.c/part.STL"))), Some("STL"));
        assert_eq!(name(of_name(Path::new("x.Ply"))), Some("PLY"));
        assert_eq!(name(of_name(Path::new("obj"))), None);
        assert_eq!(name(of_name(Path::new("x.obj.gz"))), None);
    }

    #[test]
    fn format_is_detected_from_unambiguous_content() {
        assert_eq!(name(of_content(b"ply\r\nformat ascii 1.0\r\n")), Some("PLY"));
        assert_eq!(name(of_content(b"# made by hand\n\nv 0 0 0\n")), Some("OBJ"));
        assert_eq!(name(of_content(b" Solid cube\n")), Some("STL"));
        assert_eq!(name(of_content(b"ply me with questions\n")), None);
        assert_eq!(name(of_content(b"\x7fELF")), None);
        assert_eq!(name(of_content(b"")), None);
    }

    #[test]
    fn a_binary_stl_may_begin_with_solid() {
        let mut bytes = vec![b' '; 80];
        bytes[..5].copy_from_slice(b"solid");
        bytes.extend([1, 0, 0, 0]);
        bytes.extend([0; 50]);
        assert_eq!(name(of_content(&bytes)), Some("STL"));
        bytes[..5].copy_from_slice(b"v 1 2");
        assert_eq!(name(of_content(&bytes)), Some("STL"));
    }
}
