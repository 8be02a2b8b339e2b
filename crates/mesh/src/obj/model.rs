//! An OBJ as a model: its mesh with what the statements `o`, `g`, `usemtl` and `s` say about the
//! faces.

use crate::text::{Scanner, integer, without_byte_order_mark};
use juggler_shape::MeshData;
use std::sync::Arc;

/// Maximum number of bytes of a name; longer names are cut.
const MAX_NAME: usize = 1024;

/// Mesh of an OBJ with what its statements say about the faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjModel {
    /// Mesh of all faces, in the order of the file. Its attribute `color` holds the colors of the
    /// positions, in linear light.
    pub mesh: MeshData,
    /// Index of the file's position (`v`) of each vertex of the mesh, counted from 0.
    pub positions: Vec<u32>,
    /// Sections of triangles with equal settings, in rising order. Triangles before the first
    /// section have no settings.
    pub sections: Vec<ObjSection>,
    /// Rests of the statements `mtllib`: each names one or several libraries of materials.
    pub libraries: Vec<String>,
    /// Warnings about ignored and repaired content, one per kind with a count.
    pub warnings: Vec<String>,
}

/// Triangles with equal settings. A section ends where the next one begins.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ObjSection {
    /// Index of the first triangle.
    pub first: usize,
    /// Name of the object (`o`).
    pub object: Option<Arc<str>>,
    /// Names of the groups (`g`), as written.
    pub group: Option<Arc<str>>,
    /// Name of the material (`usemtl`).
    pub material: Option<Arc<str>>,
    /// Smoothing group (`s`); 0 for none.
    pub smoothing: u32,
}

/// Setting for the faces that follow.
#[derive(Debug)]
enum Setting {
    Object(Option<Arc<str>>),
    Group(Option<Arc<str>>),
    Material(Option<Arc<str>>),
    Smoothing(u32),
    Library(String),
}

/// Setting with the number of triangles before it.
#[derive(Debug)]
pub(super) struct Mark {
    triangles: usize,
    setting: Setting,
}

impl Mark {
    /// Mark of a statement, of which `rest` follows the word; `None` for other statements.
    pub fn new(triangles: usize, word: &[u8], rest: &[u8]) -> Option<Self> {
        let text = String::from_utf8_lossy(rest.trim_ascii()).into_owned();
        let name = || {
            let short = text.get(..text.floor_char_boundary(MAX_NAME)).unwrap_or_default();
            Some(Arc::from(short)).filter(|name: &Arc<str>| !name.is_empty())
        };
        let setting = match word {
            b"o" => Setting::Object(name()),
            b"g" => Setting::Group(name().filter(|name| !matches!(&**name, "default" | "off" | "(null)"))),
            b"usemtl" => Setting::Material(name()),
            b"s" => Setting::Smoothing(smoothing(rest)),
            b"mtllib" => Setting::Library(text),
            _ => return None,
        };
        Some(Self { triangles, setting })
    }

    /// Moves the mark behind a number of triangles.
    pub fn after(self, triangles: usize) -> Self {
        Self { triangles: self.triangles.saturating_add(triangles), ..self }
    }
}

/// Smoothing group; 0 for `off` and for words that are no positive integers.
fn smoothing(rest: &[u8]) -> u32 {
    let word = rest.trim_ascii().split(u8::is_ascii_whitespace).next().unwrap_or_default();
    integer(word).and_then(|group| u32::try_from(group).ok()).unwrap_or_default()
}

/// Whether an OBJ shows nothing but a mesh: no statement `mtllib` names a library of materials, and
/// no smoothing group decides normals. Only the first words of the lines are read.
pub fn is_plain_obj(bytes: &[u8]) -> bool {
    let mut scanner = Scanner::with_obj_rules(without_byte_order_mark(bytes));
    let (mut is_smooth, mut has_normals) = (false, false);
    loop {
        match scanner.word() {
            Some(b"mtllib") if !scanner.rest_of_line().is_empty() => return false,
            Some(b"vn") => has_normals |= !scanner.rest_of_line().is_empty(),
            Some(b"s") => is_smooth |= !matches!(scanner.rest_of_line().trim_ascii(), b"off" | b"0" | b""),
            _ => {}
        }
        if !scanner.next_line() {
            return has_normals || !is_smooth;
        }
    }
}

/// Sections and libraries of marks in the order of the file.
pub(super) fn sections(marks: Vec<Mark>) -> (Vec<ObjSection>, Vec<String>) {
    let (mut sections, mut libraries) = (Vec::<ObjSection>::new(), Vec::new());
    let mut current = ObjSection::default();
    for Mark { triangles, setting } in marks {
        match setting {
            Setting::Object(name) => (current.object, current.group) = (name, None),
            Setting::Group(name) => current.group = name,
            Setting::Material(name) => current.material = name,
            Setting::Smoothing(group) => current.smoothing = group,
            Setting::Library(name) => {
                libraries.push(name);
                continue;
            }
        }
        current.first = triangles;
        match sections.last_mut() {
            Some(last) if last.first == triangles => *last = current.clone(),
            _ => sections.push(current.clone()),
        }
    }
    (sections, libraries)
}

#[cfg(test)]
#[path = "model_tests.rs"]
mod tests;
