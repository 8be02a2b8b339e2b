//! Which format a file is: its content if that is plain, else its name's ending.

use super::foreign::Foreign;
use super::format;
use juggler_imaging::regular;
use std::io::Read;
use std::path::Path;

/// Number of first bytes of a file that say what it holds, unless its name must: comments of an OBJ
/// may be longer.
const HEAD: u64 = 1 << 16;

/// What a file holds that is given where a scene is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// A scene file, or nothing that is known.
    Scene,
    /// A mesh.
    Mesh {
        /// Whether its height lies along z, as the formats of printers have it, instead of along y.
        z_up: bool,
    },
    /// Something of a format that is not read yet.
    Foreign(Foreign),
}

impl Content {
    /// What a file holds by its first bytes, its length in bytes, and the ending of its name. Content
    /// decides where it is plain: JSON is a scene whatever its name, but for `.gltf`, which is JSON too.
    pub fn of(path: &Path, head: &[u8], size: u64) -> Self {
        let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        let named = Foreign::of_name(path);
        if let Some(foreign) = Foreign::of_content(head) {
            return Self::Foreign(foreign);
        }
        let is_json = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        if is_json || head.trim_ascii_start().starts_with(b"{") {
            return named.filter(|foreign| foreign.name() == "glTF").map_or(Self::Scene, Self::Foreign);
        }
        if let (None, Some(foreign)) = (format::of_head(head, size), named) {
            return Self::Foreign(foreign);
        }
        match format::of_head(head, size).or_else(|| format::of_name(path)) {
            Some(format) => Self::Mesh { z_up: format.is_z_up() },
            None => Self::Scene,
        }
    }

    /// What a file holds. Its name alone decides where it is no ordinary file or cannot be read,
    /// which its reader then says; a file that is not there counts as a scene.
    pub fn of_file(path: &Path) -> Self {
        let Ok(metadata) = std::fs::metadata(path) else { return Self::Scene };
        let mut head = Vec::new();
        if let Ok(file) = regular::open(path)
            && file.take(HEAD).read_to_end(&mut head).is_err()
        {
            head.clear();
        }
        Self::of(path, &head, metadata.len())
    }

    /// Whether it is a mesh.
    pub fn is_mesh(self) -> bool {
        matches!(self, Self::Mesh { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_meshes_and_foreign_files_are_told_apart() {
        let of = |name: &str, text: &str| Content::of(Path::new(name), text.as_bytes(), text.len() as u64);
        let (mesh, z_up) = (Content::Mesh { z_up: false }, Content::Mesh { z_up: true });
        for (name, text, expected) in [
            ("a.json", "{\"version\": 1}", Content::Scene),
            ("a.obj", "\u{feff} {\"version\": 1}", Content::Scene),
            ("a", "// a scene\n{}", Content::Scene),
            ("a.json", "v is no word here", Content::Scene),
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
            let Content::Foreign(foreign) = of(name, text) else { panic!("{name} {text}") };
            assert_eq!(foreign.name(), expected, "{name}");
        }
    }
}
