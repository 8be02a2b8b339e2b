//! Faces of a primitive from vertex indices (glTF 2.0, section 3.7.2.1).
//!
//! | mode | faces, i = 0, 1, ... |
//! |---|---|
//! | points | i |
//! | lines | {2i, 2i + 1} |
//! | line loop, line strip | {i, i + 1}; the loop also {last, first} |
//! | triangles | {3i, 3i + 1, 3i + 2} |
//! | triangle strip | {i, i + (1 + i % 2), i + (2 - i % 2)} |
//! | triangle fan | {i + 1, i + 2, 0} |

use super::Assembler;
use crate::gltf::document::{ComponentType, Document, Index, Mode, Primitive, Semantic};
use crate::gltf::error::Fault;

/// Faces of a primitive by the indices of their vertices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Faces {
    /// Points.
    Points(Vec<u32>),
    /// Line segments.
    Lines(Vec<[u32; 2]>),
    /// Triangles, counterclockwise seen from the front.
    Triangles(Vec<[u32; 3]>),
}

impl Default for Faces {
    fn default() -> Self {
        Self::Triangles(Vec::new())
    }
}

impl Faces {
    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Points(points) => size_of_val(&**points),
            Self::Lines(lines) => size_of_val(&**lines),
            Self::Triangles(triangles) => size_of_val(&**triangles),
        }
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        match self {
            Self::Points(points) => points.len(),
            Self::Lines(lines) => lines.len(),
            Self::Triangles(triangles) => triangles.len(),
        }
    }

    /// Whether there are no faces.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Number of points or line segments of a primitive by the counts of its accessors; 0 for surfaces.
pub fn points_and_lines(document: &Document, primitive: &Primitive) -> u64 {
    let is_surface = matches!(primitive.mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan);
    if is_surface || primitive.extensions.draco.is_some() {
        return 0;
    }
    let accessor = primitive.indices.or_else(|| primitive.attributes.find(&Semantic::Position));
    let corners = accessor.and_then(|index| document.accessors.get(index.get())).map_or(0, |found| found.count.get());
    face_count(primitive.mode, usize::try_from(corners).unwrap_or(usize::MAX)) as u64
}

/// Number of triangles of a compressed primitive by the counts of its accessors. Without indices, it
/// is the largest number of triangles of a surface without holes: twice that of the vertices.
pub fn compressed_triangles(document: &Document, primitive: &Primitive) -> u64 {
    let count = |index: Index| document.accessors.get(index.get()).map(|accessor| accessor.count.get());
    let vertices = || primitive.attributes.find(&Semantic::Position).and_then(count).unwrap_or(0);
    match (primitive.indices.and_then(count), primitive.mode) {
        (Some(corners), Mode::TriangleStrip) => corners.saturating_sub(2),
        (Some(corners), _) => corners / 3,
        (None, _) => vertices().saturating_mul(2),
    }
}

impl Assembler<'_> {
    /// Faces of the primitive, or why it is left out.
    pub(super) fn faces(&mut self, vertices: usize) -> Result<Result<Faces, &'static str>, Fault> {
        let corners = self.indices(vertices)?;
        // Decoders of compressed primitives return separate triangles for each mode.
        let mode = if self.draco.is_some() { Mode::Triangles } else { self.primitive.mode };
        let unused = match mode {
            Mode::Lines => corners.len() % 2,
            Mode::Triangles => corners.len() % 3,
            _ => 0,
        };
        self.warn("vertices at the end make no whole face", unused as u64);
        let count = face_count(mode, corners.len());
        let is_surface = matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan);
        if !is_surface && count as u64 > self.data.gltf.limits.points_and_lines {
            return Ok(Err("has too many points or lines and is left out"));
        }
        let bytes = if is_surface { 12 } else { 8 };
        self.data.reserve(&self.pointer, (count as u64).saturating_mul(bytes))?;
        let faces = faces(mode, &corners);
        let dropped = count.saturating_sub(faces.len());
        self.warn("faces with two equal corners are left out", dropped as u64);
        Ok(if faces.is_empty() { Err("has no faces and is left out") } else { Ok(faces) })
    }

    /// Vertex indices, which are less than `vertices`.
    fn indices(&self, vertices: usize) -> Result<Vec<u32>, Fault> {
        if let Some(draco) = self.draco {
            self.check(&draco.indices, u32::MAX, vertices)?;
            self.data.reserve(&self.pointer, (draco.indices.len() as u64).saturating_mul(4))?;
            return Ok(draco.indices.clone());
        }
        let Some(accessor) = self.primitive.indices else {
            self.data.reserve(&self.pointer, (vertices as u64).saturating_mul(4))?;
            return Ok((0..u32::try_from(vertices).unwrap_or(u32::MAX)).collect());
        };
        let indices = self.data.indices(accessor)?;
        let component = self.data.gltf.document.accessors.get(accessor.get()).map(|accessor| accessor.component_type);
        let restart = match component {
            Some(ComponentType::U8) => u32::from(u8::MAX),
            Some(ComponentType::U16) => u32::from(u16::MAX),
            _ => u32::MAX,
        };
        self.check(&indices, restart, vertices)?;
        Ok(indices)
    }

    /// Checks that all indices are less than `vertices` and none is `restart`.
    fn check(&self, indices: &[u32], restart: u32, vertices: usize) -> Result<(), Fault> {
        let is_valid = |index: u32| index != restart && (index as usize) < vertices;
        // This loop has no branches; the search below runs only for a fault.
        if indices.iter().fold(true, |all, index| all & is_valid(*index)) {
            return Ok(());
        }
        let Some((element, index)) = indices.iter().enumerate().find(|(_, index)| !is_valid(**index)) else {
            return Ok(());
        };
        let text = match *index == restart {
            true => format!("index {index} at element {element} restarts the primitive, which glTF forbids"),
            false => format!("index {index} at element {element}, there are {vertices} positions"),
        };
        Err(Fault::at(&self.pointer, text))
    }
}

/// Number of faces of a primitive with this number of corners, degenerate ones included.
fn face_count(mode: Mode, corners: usize) -> usize {
    match mode {
        Mode::Points => corners,
        Mode::Lines => corners / 2,
        Mode::LineLoop => {
            if corners > 1 {
                corners
            } else {
                0
            }
        }
        Mode::LineStrip => corners.saturating_sub(1),
        Mode::Triangles => corners / 3,
        Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
    }
}

/// Faces without those that have two equal corners.
fn faces(mode: Mode, corners: &[u32]) -> Faces {
    let line = |[a, b]: &[u32; 2]| a != b;
    let triangle = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::Points => Faces::Points(corners.to_vec()),
        Mode::Lines => Faces::Lines(corners.as_chunks::<2>().0.iter().filter(|l| line(l)).copied().collect()),
        Mode::LineStrip => Faces::Lines(pairs(corners).filter(line).collect()),
        Mode::LineLoop => {
            let closing = corners.last().copied().zip(corners.first().copied()).map(|(last, first)| [last, first]);
            Faces::Lines(pairs(corners).chain(closing).filter(line).collect())
        }
        Mode::Triangles => {
            Faces::Triangles(corners.as_chunks::<3>().0.iter().filter(|t| triangle(t)).copied().collect())
        }
        Mode::TriangleStrip => {
            let strip =
                triples(corners).enumerate().map(|(i, [a, b, c])| if i % 2 == 0 { [a, b, c] } else { [a, c, b] });
            Faces::Triangles(strip.filter(triangle).collect())
        }
        Mode::TriangleFan => {
            let Some((center, rim)) = corners.split_first() else { return Faces::default() };
            Faces::Triangles(pairs(rim).map(|[a, b]| [a, b, *center]).filter(triangle).collect())
        }
    }
}

/// Each corner with the next.
fn pairs(corners: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    corners.iter().zip(corners.iter().skip(1)).map(|(a, b)| [*a, *b])
}

/// Each corner with the next two.
fn triples(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    pairs(corners).zip(corners.iter().skip(2)).map(|([a, b], c)| [a, b, *c])
}
