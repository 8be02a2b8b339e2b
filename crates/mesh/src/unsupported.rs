//! File formats of other programs that are recognized but not supported, so that messages can name
//! them.

use crate::formats;
use std::fmt;
use std::path::Path;

/// A recognized format of another program that is not supported yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnsupportedFormat {
    /// Name of the format as its authors write it.
    name: &'static str,
    /// File name extensions, in lower case.
    extensions: &'static [&'static str],
    /// Magic bytes at the start of the file; empty if the format has none.
    magic: &'static [u8],
    /// Whether the format is a scene description language that people write by hand.
    is_language: bool,
}

/// Defines a format of models.
const fn model(name: &'static str, extensions: &'static [&'static str], magic: &'static [u8]) -> UnsupportedFormat {
    UnsupportedFormat { name, extensions, magic, is_language: false }
}

/// Defines a scene description language.
const fn language(name: &'static str, extensions: &'static [&'static str]) -> UnsupportedFormat {
    UnsupportedFormat { name, extensions, magic: b"", is_language: true }
}

/// Name of the format of models that importers read.
const GLTF: &str = "glTF";

/// All recognized formats.
const FOREIGN: &[UnsupportedFormat] = &[
    model(GLTF, &["glb", "gltf"], b"glTF"),
    model("FBX", &["fbx"], b"Kaydara FBX Binary"),
    model("Blender's own format", &["blend"], b"BLENDER"),
    model("USD", &["usdc", "usd"], b"PXR-USDC"),
    model("USD", &["usda", "usdz"], b"#usda"),
    model("Alembic", &["abc"], b"Ogawa"),
    model("COLLADA", &["dae"], b""),
    model("3DS", &["3ds"], b""),
    model("3MF", &["3mf"], b""),
    model("OFF", &["off"], b""),
    model("X3D", &["x3d", "x3dv"], b""),
    model("VRML", &["wrl"], b"#VRML"),
    model("STEP", &["step", "stp"], b"ISO-10303-21;"),
    model("IGES", &["iges", "igs"], b""),
    model("LightWave's format", &["lwo"], b""),
    model("Cinema 4D's format", &["c4d"], b""),
    model("3ds Max's own format", &["max"], b""),
    model("Maya's format", &["ma", "mb"], b"//Maya ASCII"),
    language("POV-Ray's scene language", &["pov", "inc"]),
    language("pbrt's scene format", &["pbrt"]),
    language("Mitsuba's scene format", &["xml"]),
];

impl UnsupportedFormat {
    /// Recognizes the format by the magic bytes at the start of a file.
    pub fn of_content(head: &[u8]) -> Option<Self> {
        FOREIGN.iter().find(|format| !format.magic.is_empty() && head.starts_with(format.magic)).copied()
    }

    /// Recognizes the format by the file name's extension, in any case.
    pub fn of_name(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        FOREIGN.iter().find(|format| format.extensions.contains(&ending.as_str())).copied()
    }

    /// Name of the format as its authors write it.
    pub fn name(self) -> &'static str {
        self.name
    }
}

impl fmt::Display for UnsupportedFormat {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, is_language, .. } = *self;
        match name {
            GLTF => {
                write!(formatter, "{GLTF} files are no meshes: write \"model\": {{\"file\": ...}} instead of \"shape\"")
            }
            _ if is_language => write!(
                formatter,
                "{name} is not supported (docs/names.md lists the corresponding names in scene files)"
            ),
            _ => write!(
                formatter,
                "{name} is not supported: export the model as {GLTF} (.glb), {}",
                formats::alternatives()
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unsupported_formats_are_detected_by_content_and_extension() {
        let name = |found: Option<UnsupportedFormat>| found.map(UnsupportedFormat::name);
        assert_eq!(name(UnsupportedFormat::of_content(b"glTF\x02\0\0\0")), Some("glTF"));
        assert_eq!(name(UnsupportedFormat::of_content(b"Kaydara FBX Binary  \0")), Some("FBX"));
        assert_eq!(name(UnsupportedFormat::of_content(b"BLENDER-v300")), Some("Blender's own format"));
        assert_eq!(name(UnsupportedFormat::of_content(b"{\"version\": 1}")), None);
        assert_eq!(name(UnsupportedFormat::of_content(b"")), None);
        for (file, expected) in [("a/b.GLTF", "glTF"), ("x.usdz", "USD"), ("x.dae", "COLLADA"), ("x.3ds", "3DS")] {
            assert_eq!(name(UnsupportedFormat::of_name(Path::new(file))), Some(expected), "{file}");
        }
        for file in ["scene.json", "a.obj", "gltf", "x"] {
            assert_eq!(UnsupportedFormat::of_name(Path::new(file)), None, "{file}");
        }
    }

    #[test]
    fn messages_name_the_format_and_what_to_do() {
        let message = |file: &str| UnsupportedFormat::of_name(Path::new(file)).unwrap().to_string();
        assert_eq!(message("a.glb"), "glTF files are no meshes: write \"model\": {\"file\": ...} instead of \"shape\"");
        let exported = "is not supported: export the model as glTF (.glb), OBJ, PLY or STL";
        assert_eq!(message("a.blend"), format!("Blender's own format {exported}"));
        assert!(message("a.pov").starts_with("POV-Ray's scene language is not supported"));
        assert!(message("a.pov").contains("docs/names.md"));
    }
}
