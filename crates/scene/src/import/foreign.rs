//! Formats of other programs that are known by name and not read yet, so that a message can say
//! which one a file is.

use std::fmt;
use std::path::Path;

/// A format of another program that is not read yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Foreign {
    /// The format's name as its makers write it.
    name: &'static str,
    /// Endings of file names, in small letters.
    endings: &'static [&'static str],
    /// First bytes that no other format has; empty where there are none.
    magic: &'static [u8],
    /// Whether files of this format describe whole scenes in a language that people write.
    language: bool,
}

/// A format whose files hold models.
const fn model(name: &'static str, endings: &'static [&'static str], magic: &'static [u8]) -> Foreign {
    Foreign { name, endings, magic, language: false }
}

/// A format whose files are scene descriptions that people write.
const fn language(name: &'static str, endings: &'static [&'static str]) -> Foreign {
    Foreign { name, endings, magic: b"", language: true }
}

/// All of them.
const FOREIGN: &[Foreign] = &[
    model("glTF", &["glb", "gltf"], b"glTF"),
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

impl Foreign {
    /// The format whose mark a file begins with.
    pub fn of_content(head: &[u8]) -> Option<Self> {
        FOREIGN.iter().find(|format| !format.magic.is_empty() && head.starts_with(format.magic)).copied()
    }

    /// The format that the ending of a file's name speaks of, in any case.
    pub fn of_name(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        FOREIGN.iter().find(|format| format.endings.contains(&ending.as_str())).copied()
    }

    /// The format as its makers call it.
    pub fn name(self) -> &'static str {
        self.name
    }
}

impl fmt::Display for Foreign {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} is not read yet; meshes in OBJ, PLY and STL are", self.name)?;
        if self.language {
            formatter.write_str(" (docs/names.md lists what its words are called in scene files)")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_mark_and_by_name() {
        let name = |found: Option<Foreign>| found.map(Foreign::name);
        assert_eq!(name(Foreign::of_content(b"glTF\x02\0\0\0")), Some("glTF"));
        assert_eq!(name(Foreign::of_content(b"Kaydara FBX Binary  \0")), Some("FBX"));
        assert_eq!(name(Foreign::of_content(b"BLENDER-v300")), Some("Blender's own format"));
        assert_eq!(name(Foreign::of_content(b"{\"version\": 1}")), None);
        assert_eq!(name(Foreign::of_content(b"")), None);
        for (file, expected) in [("a/b.GLTF", "glTF"), ("x.usdz", "USD"), ("x.dae", "COLLADA"), ("x.3ds", "3DS")] {
            assert_eq!(name(Foreign::of_name(Path::new(file))), Some(expected), "{file}");
        }
        for file in ["scene.json", "a.obj", "gltf", "x"] {
            assert_eq!(Foreign::of_name(Path::new(file)), None, "{file}");
        }
    }

    #[test]
    fn messages_name_the_format_and_those_that_are_read() {
        let message = |file: &str| Foreign::of_name(Path::new(file)).unwrap().to_string();
        assert_eq!(message("a.glb"), "glTF is not read yet; meshes in OBJ, PLY and STL are");
        assert!(message("a.pov").starts_with("POV-Ray's scene language is not read yet; meshes in OBJ, PLY and STL"));
        assert!(message("a.pov").contains("docs/names.md"));
    }
}
