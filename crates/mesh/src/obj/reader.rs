//! Reader of the statements of an OBJ, in pieces on all threads.

use super::colors;
use super::lenient;
use super::model::Mark;
use super::notes::Notes;
use crate::assemble::{Colors, MeshParts};
use crate::error::{MeshErrorKind, quote};
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::{PieceReader, next_line_start};
use crate::text::{Scanner, integer};
use crate::weld::{Key, Welded, WeldedPiece};
use juggler_math::{BuildControl, Vec2, Vec3, vec3};
use rayon::prelude::*;

/// Index of an element that a corner does not have.
const NONE: u32 = u32::MAX;

/// Contents of a file.
pub(super) struct Contents {
    /// Mesh of all faces.
    pub file: MeshFile,
    /// Index of the position of each vertex; empty unless the file is read as a model.
    pub positions: Vec<u32>,
    /// Settings of the faces; empty unless the file is read as a model.
    pub marks: Vec<Mark>,
}

/// Reads a whole file in pieces. A model keeps the settings of faces.
pub(super) fn read(
    bytes: &[u8],
    limits: &MeshLimits,
    reader: PieceReader<'_>,
    is_model: bool,
) -> Result<Contents, MeshErrorKind> {
    let texts = cut(bytes, reader.size);
    let mut start = Start { line: 1, is_model, ..Start::default() };
    let mut starts = Vec::with_capacity(texts.len());
    reader.read(
        &texts,
        |text| Ok(Start::of_next(text)),
        |counts| {
            starts.push(start);
            start.add(&counts);
            Ok(())
        },
    )?;
    let mut whole = ObjData::with_room_for(&start, limits);
    let pieces: Vec<(&[u8], Start)> = texts.into_iter().zip(starts).collect();
    reader.read(&pieces, |(text, start)| read_piece(text, *start, limits), |piece| whole.append(piece, limits))?;
    whole.finish(limits, reader.control)
}

/// Cuts the text into pieces at line ends that no `\` continues.
fn cut(bytes: &[u8], piece: usize) -> Vec<&[u8]> {
    let mut pieces = Vec::new();
    let mut rest = bytes;
    while let Some((first, after)) =
        next_line_start(rest, piece, |before, _| !before.ends_with(b"\\")).and_then(|at| rest.split_at_checked(at))
    {
        pieces.push(first);
        rest = after;
    }
    pieces.push(rest);
    pieces
}

/// Counts of the text before a piece, or of a piece.
#[derive(Clone, Copy, Default)]
struct Start {
    line: u64,
    /// Whether the settings of faces are kept.
    is_model: bool,
    /// Number of positions, texture coordinates and normals.
    counts: [usize; 3],
    faces: usize,
}

impl Start {
    /// Counts the statements of a piece of text.
    fn of_next(text: &[u8]) -> Self {
        let mut found = Self::default();
        let mut scanner = Scanner::with_obj_rules(text).starting_at_line(0);
        loop {
            match scanner.word() {
                Some(b"v") => found.counts[0] += 1,
                Some(b"vt") => found.counts[1] += 1,
                Some(b"vn") => found.counts[2] += 1,
                Some(b"f" | b"fo") => found.faces += 1,
                _ => {}
            }
            if !scanner.next_line() {
                found.line = scanner.line();
                return found;
            }
        }
    }

    fn add(&mut self, piece: &Self) {
        self.line += piece.line;
        self.faces += piece.faces;
        self.counts.iter_mut().zip(piece.counts).for_each(|(sum, count)| *sum += count);
    }
}

fn read_piece(text: &[u8], start: Start, limits: &MeshLimits) -> Result<ObjPiece, MeshErrorKind> {
    let mut scanner = Scanner::with_obj_rules(text).starting_at_line(start.line);
    let mut reader = ObjPiece { start: start.counts, is_model: start.is_model, ..ObjPiece::default() };
    loop {
        reader.statement(&mut scanner, limits)?;
        if !scanner.next_line() {
            return Ok(reader);
        }
    }
}

/// Contents of a piece of the text.
#[derive(Default)]
struct ObjPiece {
    /// Number of positions, texture coordinates and normals before the piece.
    start: [usize; 3],
    /// Whether the settings of faces are kept.
    is_model: bool,
    positions: Vec<Vec3>,
    /// Encoded colors of the positions; positions beyond the last color are white.
    colors: Vec<Vec3>,
    marks: Vec<Mark>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    welded: WeldedPiece,
    /// Corners of the current face; kept to reuse its allocation.
    face: Vec<u32>,
    notes: Notes,
}

impl ObjPiece {
    /// Number of positions, texture coordinates and normals before the current statement.
    fn counts(&self) -> [usize; 3] {
        let [v, vt, vn] = self.start;
        [v + self.positions.len(), vt + self.uvs.len(), vn + self.normals.len()]
    }

    fn statement(&mut self, scanner: &mut Scanner<'_>, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        match scanner.word() {
            None => {}
            Some(b"v") => {
                limits.next_vertex(self.counts()[0])?;
                self.positions.push(vec3(scanner.finite("x")?, scanner.finite("y")?, scanner.finite("z")?));
                self.color(scanner);
            }
            Some(b"vt") => {
                limits.next_vertex(self.counts()[1])?;
                self.uvs.push(lenient::texture_coordinates(scanner, &mut self.notes)?);
            }
            Some(b"vn") => {
                limits.next_vertex(self.counts()[2])?;
                self.normals.push(lenient::normal(scanner, &mut self.notes)?);
            }
            Some(b"f" | b"fo") => self.face(scanner, limits)?,
            Some(word) => {
                let rest = if self.is_model { scanner.rest_of_line() } else { &[] };
                let mark = Mark::new(self.welded.faces.len(), word, rest).filter(|_| self.is_model);
                match mark {
                    Some(mark) => self.marks.push(mark),
                    None => self.notes.ignore(word),
                }
            }
        }
        Ok(())
    }

    /// Reads what follows x, y and z of the last position: a color, or a weight, which is ignored.
    fn color(&mut self, scanner: &mut Scanner<'_>) {
        let Some(first) = scanner.word() else { return };
        let words = std::iter::once(first).chain(std::iter::from_fn(|| scanner.word()));
        match colors::color(words) {
            Some(color) => {
                self.colors.resize(self.positions.len().saturating_sub(1), colors::NO_COLOR);
                self.colors.push(color);
            }
            None => self.notes.weights += 1,
        }
    }

    fn face(&mut self, scanner: &mut Scanner<'_>, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        self.face.clear();
        while let Some(word) = scanner.word() {
            let (word, has_comment) = lenient::without_comment(word, &mut self.notes);
            let triple = self.corner(word, scanner)?;
            self.face.push(self.welded.corners.index(triple, limits)?);
            if has_comment {
                scanner.rest_of_line();
            }
        }
        self.welded.faces.push(&self.face, limits)
    }

    /// Parses a corner: `7`, `7/2`, `7//3` or `7/2/3`. An empty index at the end (`7/2/`) counts as
    /// absent.
    fn corner(&mut self, word: &[u8], scanner: &Scanner<'_>) -> Result<[u32; 3], MeshErrorKind> {
        let counts = self.counts();
        let mut parts = word.split(|byte| *byte == b'/');
        let mut triple = [NONE; 3];
        for (stream, count) in counts.into_iter().enumerate() {
            let part = parts.next().unwrap_or_default();
            if part.is_empty() && stream > 0 {
                continue;
            }
            let found = || format!("expected {STREAMS} in {}", quote(word));
            let index = integer(part).ok_or_else(|| scanner.place().error(found()))?;
            let index =
                absolute(index, count).ok_or_else(|| scanner.place().error(out_of_range(index, stream, count)))?;
            triple[stream] = index;
        }
        if parts.next().is_some() {
            return Err(scanner.place().error(format!("expected {STREAMS}, found {}", quote(word))));
        }
        if triple[0] as usize >= counts[0] {
            self.notes.not_yet_defined(triple[0], scanner.place());
        }
        Ok(triple)
    }
}

/// The joined pieces of a text.
#[derive(Default)]
struct ObjData {
    is_model: bool,
    positions: Vec<Vec3>,
    /// Encoded colors of the positions; positions beyond the last color are white.
    colors: Vec<Vec3>,
    marks: Vec<Mark>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    welded: Welded,
    notes: Notes,
}

impl ObjData {
    /// Allocates memory for the counted statements, up to the limits.
    fn with_room_for(counted: &Start, limits: &MeshLimits) -> Self {
        let [v, vt, vn] = counted.counts.map(|count| count.min(limits.vertices as usize));
        Self {
            is_model: counted.is_model,
            positions: Vec::with_capacity(v),
            colors: Vec::new(),
            marks: Vec::new(),
            uvs: Vec::with_capacity(vt),
            normals: Vec::with_capacity(vn),
            welded: Welded::with_capacity(counted.faces.min(limits.triangles as usize)),
            notes: Notes::default(),
        }
    }

    fn append(&mut self, piece: ObjPiece, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        if !piece.colors.is_empty() {
            self.colors.resize(self.positions.len(), colors::NO_COLOR);
            self.colors.extend(piece.colors);
        }
        let triangles = self.welded.triangles();
        self.marks.extend(piece.marks.into_iter().map(|mark| mark.after(triangles)));
        self.positions.extend(piece.positions);
        self.uvs.extend(piece.uvs);
        self.normals.extend(piece.normals);
        self.notes.append(piece.notes);
        self.welded.append(piece.welded, limits)
    }

    fn finish(self, limits: &MeshLimits, control: &BuildControl) -> Result<Contents, MeshErrorKind> {
        let count = self.positions.len();
        if let Some((index, place)) = self.notes.furthest.filter(|(index, _)| *index as usize >= count) {
            let number = u64::from(index) + 1;
            return Err(place.error(format!("{} index {number} is out of range: the file has only {count}", NAMES[0])));
        }
        let mut warnings = self.notes.in_words();
        let (mut keys, faces) = self.welded.finish(limits, control)?;
        drop_undefined(&mut keys, 1, self.uvs.len(), &mut warnings);
        drop_undefined(&mut keys, 2, self.normals.len(), &mut warnings);
        let positions = gather(&keys, 0, &self.positions);
        let normals = if self.normals.is_empty() { Vec::new() } else { gather(&keys, 2, &self.normals) };
        let without = keys.iter().filter(|key| key[1] == NONE).count();
        let uvs = if without == keys.len() { Vec::new() } else { gather(&keys, 1, &self.uvs) };
        if !uvs.is_empty() && without > 0 {
            warnings.push(format!("{without} vertices have no texture coordinates and get 0 0"));
        }
        let vertex_colors = vertex_colors(self.colors, self.positions.len(), &keys, &mut warnings);
        let file =
            MeshParts { positions, normals, uvs, vertex_colors, faces, warnings, ..MeshParts::default() }.assemble()?;
        let positions = if self.is_model { keys.iter().map(|[position, ..]| *position).collect() } else { Vec::new() };
        Ok(Contents { file, positions, marks: self.marks })
    }
}

/// Colors of the vertices, if positions have colors.
fn vertex_colors(mut colors: Vec<Vec3>, positions: usize, keys: &[Key], warnings: &mut Vec<String>) -> Colors {
    if colors.is_empty() {
        return Colors::default();
    }
    colors.resize(positions, colors::NO_COLOR);
    colors::decode(&mut colors, warnings);
    Colors { channels: 3, values: gather(keys, 0, &colors).iter().flat_map(Vec3::to_array).collect() }
}

const NAMES: [&str; 3] = ["vertex (v)", "texture coordinate (vt)", "normal (vn)"];
const STREAMS: &str = "a face vertex v, v/vt, v//vn or v/vt/vn of integers";

/// Converts an index that counts from 1 or backwards to an index from 0; `None` for 0 and before
/// the first element.
fn absolute(index: i64, count: usize) -> Option<u32> {
    let from_zero = if index > 0 { index - 1 } else { i64::try_from(count).ok()?.checked_add(index)? };
    let defined = index != 0 && from_zero >= 0 && from_zero < i64::from(NONE);
    if defined { u32::try_from(from_zero).ok() } else { None }
}

fn out_of_range(index: i64, stream: usize, count: usize) -> String {
    let name = NAMES[stream];
    match index {
        0 => format!("{name} index 0 is invalid: indices start at 1"),
        ..0 => format!("{name} index {index} is out of range: only {count} precede this line"),
        _ => format!("{name} index {index} is too large"),
    }
}

/// Removes indices beyond the last texture coordinates or normal.
fn drop_undefined(keys: &mut [Key], stream: usize, count: usize, warnings: &mut Vec<String>) {
    let mut dropped = 0_u64;
    for index in keys.iter_mut().filter_map(|key| key.get_mut(stream)) {
        if *index != NONE && *index as usize >= count {
            *index = NONE;
            dropped += 1;
        }
    }
    if dropped > 0 {
        warnings.push(format!(
            "{dropped} vertices refer to an undefined {} (the file has {count}): ignored",
            NAMES[stream]
        ));
    }
}

/// Gathers the value of each key; the default for a key without one.
fn gather<T: Copy + Default + Send + Sync>(keys: &[Key], stream: usize, values: &[T]) -> Vec<T> {
    keys.par_iter().map(|key| values.get(key[stream] as usize).copied().unwrap_or_default()).collect()
}
