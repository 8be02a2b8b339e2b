//! Detection of a file's format: by unambiguous content, else by the extension of its name.

use crate::formats;
use crate::text::without_byte_order_mark;
use crate::unsupported::UnsupportedFormat;
use juggler_imaging::regular;
use std::path::Path;

/// Number of leading bytes in which the content is recognized. Comments of an OBJ may be longer;
/// its name then decides.
const HEAD: u64 = 1 << 16;

/// Content of a file that a user names: a mesh, or something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileContent {
    /// A mesh.
    Mesh {
        /// Whether the up axis is z, as in the formats of 3D printers, instead of y.
        z_up: bool,
    },
    /// A known format that is not supported yet.
    Unsupported(UnsupportedFormat),
    /// No mesh: a scene file, or a file of unknown content.
    Other,
}

impl FileContent {
    /// Detects the content from the file's first bytes, its size in bytes and the extension of its
    /// name. Unambiguous content takes precedence: JSON is no mesh whatever its name. Only
    /// `.gltf`, which is JSON too, is named as a format.
    pub fn from_head(path: &Path, head: &[u8], size: u64) -> Self {
        let head = without_byte_order_mark(head);
        let named = UnsupportedFormat::of_name(path);
        if let Some(foreign) = UnsupportedFormat::of_content(head) {
            return Self::Unsupported(foreign);
        }
        let is_json = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        if is_json || head.trim_ascii_start().starts_with(b"{") {
            return named.filter(|foreign| foreign.name() == "glTF").map_or(Self::Other, Self::Unsupported);
        }
        if let (None, Some(foreign)) = (formats::of_head(head, size), named) {
            return Self::Unsupported(foreign);
        }
        match formats::of_head(head, size).or_else(|| formats::of_name(path)) {
            Some(format) => Self::Mesh { z_up: format.info().is_z_up },
            None => Self::Other,
        }
    }

    /// Detects the content of a file. Only the name decides if the file is not a regular file or
    /// cannot be read; its reader then reports that. A missing file counts as no mesh.
    pub fn detect(path: &Path) -> Self {
        let Ok(metadata) = std::fs::metadata(path) else { return Self::Other };
        let head = regular::first_bytes(path, HEAD).unwrap_or_default();
        Self::from_head(path, &head, metadata.len())
    }

    /// Whether the content is a mesh.
    pub fn is_mesh(self) -> bool {
        matches!(self, Self::Mesh { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_meshes_and_foreign_files_are_distinguished() {
        let of = |name: &str, text: &str| FileContent::from_head(Path::new(name), text.as_bytes(), text.len() as u64);
        let (mesh, z_up) = (FileContent::Mesh { z_up: false }, FileContent::Mesh { z_up: true });
        for (name, text, expected) in [
            ("a.json", "{\"version\": 1}", FileContent::Other),
            ("a.obj", "\u{feff} {\"version\": 1}", FileContent::Other),
            ("a", "// a scene\n{}", FileContent::Other),
            ("a.json", "v is no word here", FileContent::Other),
            ("a.obj", "v 0 0 0\n", mesh),
            ("a.OBJ", "# nothing plain\n", mesh),
            ("a.ply", "", mesh),
            ("a.txt", "ply\nformat ascii 1.0\n", mesh),
            ("a", "# made by hand\nv 1 2 3\n", mesh),
            ("a.stl", "solid cube\n", z_up),
            ("a.dae", "ply\nformat ascii 1.0\n", mesh),
        ] {
            assert_eq!(of(name, text), expected, "{name} {text}");
        }
        for (name, text, expected) in [
            ("a.gltf", "{\"asset\": {\"version\": \"2.0\"}}", "glTF"),
            ("a.json", "glTF\u{2}", "glTF"),
            ("car", "BLENDER-v300", "Blender's own format"),
            ("a.pov", "// a sphere\nsphere { 0, 1 }", "POV-Ray's scene language"),
            ("a.xml", "<scene version='3.0.0'/>", "Mitsuba's scene format"),
            ("a.abc", "", "Alembic"),
        ] {
            let FileContent::Unsupported(foreign) = of(name, text) else { panic!("{name} {text}") };
            assert_eq!(foreign.name(), expected, "{name}");
        }
    }
}
