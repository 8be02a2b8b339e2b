//! An OBJ as a model: its mesh with what the statements `o`, `g`, `usemtl` and `s` say about the
//! faces.

use super::super::MeshLimits;
use crate::error::MeshErrorKind;
use crate::pieces::PIECE;
use crate::text::integer;
use juggler_math::Vec3;
use juggler_math::color::srgb_decode;
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

/// Encoded color from the words after x, y and z of a position; `None` unless there are at least
/// three finite numbers.
pub(super) fn color<'w>(words: impl Iterator<Item = &'w [u8]>) -> Option<Vec3> {
    let mut numbers = words.take(3).map(|word| std::str::from_utf8(word).ok()?.parse::<f32>().ok());
    let mut channel = || numbers.next().flatten().filter(|number| number.is_finite());
    Some(Vec3::new(channel()?, channel()?, channel()?))
}

/// Color of a position without color: white in any range of numbers.
pub(super) const NO_COLOR: Vec3 = Vec3::INFINITY;

/// Largest channel of colors from 0 to 1. Larger ones in a file mean levels from 0 to 255.
const LARGEST_FRACTION: f32 = 2.0;

/// Decodes the colors of a file, which are sRGB from 0 to 1, or from 0 to 255 with a warning.
pub(super) fn decode_colors(colors: &mut [Vec3], warnings: &mut Vec<String>) {
    let are_levels = colors.iter().any(|color| color.is_finite() && color.max_element() > LARGEST_FRACTION);
    if are_levels {
        warnings.push("colors of vertices exceed 1: taken as levels from 0 to 255".to_owned());
    }
    let scale = if are_levels { 255.0 } else { 1.0 };
    for color in colors {
        *color = color.to_array().map(|channel| srgb_decode((channel / scale).clamp(0.0, 1.0))).into();
    }
}

/// Sections and libraries of marks in the order of the file.
fn sections(marks: Vec<Mark>) -> (Vec<ObjSection>, Vec<String>) {
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

/// Reads a whole file as a model.
pub(crate) fn read_model(bytes: &[u8], limits: &MeshLimits) -> Result<ObjModel, MeshErrorKind> {
    let found = super::read_contents(bytes, limits, PIECE, true)?;
    let (sections, libraries) = sections(found.marks);
    let super::MeshFile { mesh, warnings } = found.imported;
    Ok(ObjModel { mesh, positions: found.positions, sections, libraries, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> ObjModel {
        read_model(text.as_bytes(), &MeshLimits::default()).unwrap()
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn sections_follow_the_statements() {
        let model = read(&format!(
            "mtllib my lib.mtl\n{SQUARE}o a\nusemtl red\ns 1\nf 1 2 3 4\ng b c\nusemtl x\nusemtl  sky blue \ns off\nf 1 2 3\no d\nf 1 3 4\n"
        ));
        let section = |first, object: &str, group: Option<&str>, material: &str, smoothing| ObjSection {
            first,
            object: Some(object.into()),
            group: group.map(Into::into),
            material: Some(material.into()),
            smoothing,
        };
        assert_eq!(model.libraries, ["my lib.mtl"]);
        assert_eq!(
            model.sections,
            [
                section(0, "a", None, "red", 1),
                section(2, "a", Some("b c"), "sky blue", 0),
                section(3, "d", None, "sky blue", 0)
            ]
        );
        assert_eq!(model.mesh.triangles.len(), 4);
        assert_eq!(model.positions, [0, 1, 2, 3]);
        assert!(model.warnings.is_empty());
    }

    #[test]
    fn colors_of_positions_are_decoded() {
        let model = read("v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0 0 2 -1\nf 1 2 3\n");
        let color = model.mesh.attributes.get("color").unwrap();
        let half = srgb_decode(0.5);
        let expected = vec![1.0, 0.0, half, 1.0, 1.0, 1.0, 0.0, 1.0, 0.0];
        assert_eq!((color.channels, &color.data), (3, &juggler_shape::attribute::AttributeData::F32(expected)));
        // Levels from 0 to 255; the position without color stays white.
        let levels = read("v 0 0 0 255 0 51\nv 1 0 0\nv 0 1 0 0 1 255\nf 1 2 3\n");
        let expected = [1.0, 0.0, 0.2, 1.0, 1.0, 1.0, 0.0, 1.0 / 255.0, 1.0].map(srgb_decode).to_vec();
        let color = levels.mesh.attributes.get("color").unwrap();
        assert_eq!(color.data, juggler_shape::attribute::AttributeData::F32(expected));
        assert_eq!(levels.warnings, ["colors of vertices exceed 1: taken as levels from 0 to 255"]);
        let plain = read("v 0 0 0 1\nv 1 0 0 nan 1 1\nv 0 1 0\nf 1 2 3\n");
        assert!(plain.mesh.attributes.is_empty());
        assert_eq!(plain.warnings, ["2 vertices have numbers after x y z that are no colors: ignored"]);
    }
}
