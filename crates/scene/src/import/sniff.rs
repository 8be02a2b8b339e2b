//! Which format a file is: its content if that is plain, else its name's ending.

use super::stl;
use super::text::Scanner;
use std::path::Path;

/// A format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY.
    Ply,
    /// STL of stereolithography, text or binary.
    Stl,
}

impl Format {
    /// The format that a name's ending speaks of, in any case.
    pub fn of_name(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }

    /// The format that the content cannot but be.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        if stl::is_binary(bytes) {
            return Some(Self::Stl);
        }
        let mut scanner = Scanner::wavefront(bytes);
        let first = scanner.word_anywhere()?;
        let alone = scanner.word().is_none();
        match first {
            b"ply" if alone => Some(Self::Ply),
            b"v" | b"vt" | b"vn" | b"f" | b"mtllib" | b"usemtl" | b"o" | b"g" => Some(Self::Obj),
            word if word.eq_ignore_ascii_case(b"solid") => Some(Self::Stl),
            _ => None,
        }
    }

    /// As people write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_in_any_case() {
        assert_eq!(Format::of_name(Path::new("a/b.c/part.STL")), Some(Format::Stl));
        assert_eq!(Format::of_name(Path::new("x.Ply")), Some(Format::Ply));
        assert_eq!(Format::of_name(Path::new("obj")), None);
        assert_eq!(Format::of_name(Path::new("x.obj.gz")), None);
    }

    #[test]
    fn content_speaks_when_it_is_plain() {
        assert_eq!(Format::of_content(b"ply\r\nformat ascii 1.0\r\n"), Some(Format::Ply));
        assert_eq!(Format::of_content(b"# made by hand\n\nv 0 0 0\n"), Some(Format::Obj));
        assert_eq!(Format::of_content(b" Solid cube\n"), Some(Format::Stl));
        assert_eq!(Format::of_content(b"ply me with questions\n"), None);
        assert_eq!(Format::of_content(b"\x7fELF"), None);
        assert_eq!(Format::of_content(b""), None);
    }

    #[test]
    fn a_binary_stl_may_begin_with_solid() {
        let mut bytes = vec![b' '; 80];
        bytes[..5].copy_from_slice(b"solid");
        bytes.extend([1, 0, 0, 0]);
        bytes.extend([0; 50]);
        assert_eq!(Format::of_content(&bytes), Some(Format::Stl));
        bytes[..5].copy_from_slice(b"v 1 2");
        assert_eq!(Format::of_content(&bytes), Some(Format::Stl));
    }
}
