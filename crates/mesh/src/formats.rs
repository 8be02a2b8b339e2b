//! The table of mesh file formats: a closed set, each format in its own file or folder.

use crate::format::{MeshFormat, MeshFormatInfo};
use crate::obj::Obj;
use crate::ply::Ply;
use crate::stl::Stl;
use std::path::Path;

/// All formats. STL comes first, since a binary STL may begin with the words of another format.
const FORMATS: &[&dyn MeshFormat] = &[
    &Stl, //
    &Obj, &Ply,
];

/// Format of a file by the extension of its name, in any case.
pub(crate) fn of_name(path: &Path) -> Option<&'static dyn MeshFormat> {
    let extension = path.extension()?;
    FORMATS.iter().copied().find(|format| extension.eq_ignore_ascii_case(format.info().extension))
}

/// Format of a file by its content, if that is unambiguous.
pub(crate) fn of_content(bytes: &[u8]) -> Option<&'static dyn MeshFormat> {
    FORMATS.iter().copied().find(|format| format.is_content(bytes))
}

/// Format of a file of `size` bytes by its first bytes, if these are unambiguous.
pub(crate) fn of_head(head: &[u8], size: u64) -> Option<&'static dyn MeshFormat> {
    FORMATS.iter().copied().find(|format| format.is_head(head, size))
}

/// Names of all formats in words: "OBJ, PLY or STL".
pub(crate) fn alternatives() -> String {
    enumeration(|format| format.name.to_owned())
}

/// Extensions of all formats in words: ".obj, .ply or .stl".
pub(crate) fn extensions() -> String {
    enumeration(|format| format!(".{}", format.extension))
}

/// The words for all formats in alphabetical order.
fn enumeration(word: impl Fn(MeshFormatInfo) -> String) -> String {
    let mut words: Vec<String> = FORMATS.iter().map(|format| word(format.info())).collect();
    words.sort();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(format: Option<&'static dyn MeshFormat>) -> Option<&'static str> {
        format.map(|format| format.info().name)
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
