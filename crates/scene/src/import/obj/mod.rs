//! Wavefront OBJ ("Advanced Visualizer" manual, Wavefront Technologies 1992, appendix B1): polygons from
//! `v`, `vt`, `vn` and `f`.
//!
//! A corner names position, surface coordinate and normal by three indices; corners with equal triples
//! become one vertex, in the order of their first use. Indices count from 1, or back from the last one with
//! -1. A face may name a vertex that is defined further down. A position that is nowhere is an error; a
//! surface coordinate or normal that is nowhere is left out, for the mesh has its form without it. What a
//! single mesh has no place for (groups, materials, smoothing groups, lines, curves, colours behind a
//! position) is counted and left out.

#[cfg(test)]
mod tests;

use super::assemble::Parts;
use super::error::{Fault, Place, quote};
use super::faces::Faces;
use super::text::{Scanner, integer};
use super::weld::Welder;
use super::{Imported, Limits};
use juggler_math::{Vec2, Vec3, vec2, vec3};
use std::collections::BTreeMap;

/// Stands for an index that a corner does not give.
const NONE: u32 = u32::MAX;

/// Kinds of ignored statements that a warning names; a file of random words has more.
const NAMED_STATEMENTS: usize = 16;

/// Reads a whole file.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Imported, Fault> {
    let mut scanner = Scanner::wavefront(bytes);
    let mut reader = Reader::default();
    loop {
        reader.statement(&mut scanner, limits)?;
        if !scanner.next_line() {
            return reader.finish();
        }
    }
}

#[derive(Default)]
struct Reader {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// The furthest position that was named before it was defined, and where.
    furthest: Option<(u32, Place)>,
    corners: Welder,
    faces: Faces,
    /// The face being read; kept for its memory.
    face: Vec<u32>,
    ignored: BTreeMap<String, u64>,
    other_ignored: u64,
    colors: u64,
}

impl Reader {
    fn statement(&mut self, scanner: &mut Scanner<'_>, limits: &Limits) -> Result<(), Fault> {
        match scanner.word() {
            None => {}
            Some(b"v") => {
                limits.next_vertex(self.positions.len())?;
                self.positions.push(vec3(scanner.finite("x")?, scanner.finite("y")?, scanner.finite("z")?));
                self.colors += u64::from(scanner.word().is_some());
            }
            Some(b"vt") => {
                limits.next_vertex(self.uvs.len())?;
                self.uvs.push(surface_coordinate(scanner)?);
            }
            Some(b"vn") => {
                limits.next_vertex(self.normals.len())?;
                let [x, y, z] = ["x", "y", "z"];
                self.normals.push(vec3(scanner.real(x)?, scanner.real(y)?, scanner.real(z)?));
            }
            Some(b"f" | b"fo") => self.face(scanner, limits)?,
            Some(other) => self.ignore(other),
        }
        Ok(())
    }

    fn face(&mut self, scanner: &mut Scanner<'_>, limits: &Limits) -> Result<(), Fault> {
        self.face.clear();
        while let Some(word) = scanner.word() {
            let triple = self.corner(word, scanner)?;
            self.face.push(self.corners.index(triple, limits)?);
        }
        self.faces.push(&self.face, limits)
    }

    /// One corner: `7`, `7/2`, `7//3` or `7/2/3`; an empty index at the end (`7/2/`) is as none.
    fn corner(&mut self, word: &[u8], scanner: &Scanner<'_>) -> Result<[u32; 3], Fault> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let mut parts = word.split(|byte| *byte == b'/');
        let mut triple = [NONE; 3];
        for (stream, count) in counts.into_iter().enumerate() {
            let part = parts.next().unwrap_or_default();
            if part.is_empty() && stream > 0 {
                continue;
            }
            let found = || format!("expected {STREAMS} in {}", quote(word));
            let index = integer(part).ok_or_else(|| scanner.place().fault(found()))?;
            let index =
                absolute(index, count).ok_or_else(|| scanner.place().fault(out_of_range(index, stream, count)))?;
            triple[stream] = index;
        }
        if parts.next().is_some() {
            return Err(scanner.place().fault(format!("expected {STREAMS}, found {}", quote(word))));
        }
        if triple[0] as usize >= counts[0] && self.furthest.is_none_or(|(known, _)| known < triple[0]) {
            self.furthest = Some((triple[0], scanner.place()));
        }
        Ok(triple)
    }

    fn ignore(&mut self, statement: &[u8]) {
        let name = quote(statement);
        if let Some(count) = self.ignored.get_mut(&name) {
            *count += 1;
        } else if self.ignored.len() < NAMED_STATEMENTS {
            self.ignored.insert(name, 1);
        } else {
            self.other_ignored += 1;
        }
    }

    fn finish(self) -> Result<Imported, Fault> {
        let count = self.positions.len();
        if let Some((index, place)) = self.furthest.filter(|(index, _)| *index as usize >= count) {
            let number = u64::from(index) + 1;
            return Err(place.fault(format!("{} index {number}: the file has only {count}", NAMES[0])));
        }
        let mut warnings = self.ignored_in_words();
        let mut keys = self.corners.into_keys();
        drop_undefined(&mut keys, 1, self.uvs.len(), &mut warnings);
        drop_undefined(&mut keys, 2, self.normals.len(), &mut warnings);
        let positions = keys.iter().map(|key| pick(&self.positions, key[0])).collect();
        let normals = if self.normals.is_empty() { Vec::new() } else { all(&keys, 2, &self.normals) };
        let without = keys.iter().filter(|key| key[1] == NONE).count();
        let uvs = if without == keys.len() { Vec::new() } else { all(&keys, 1, &self.uvs) };
        if !uvs.is_empty() && without > 0 {
            warnings.push(format!("{without} vertices have no surface coordinates and get 0 0"));
        }
        Parts { positions, normals, uvs, faces: self.faces, warnings }.assemble()
    }

    fn ignored_in_words(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.colors > 0 {
            warnings.push(format!("{} vertices have colours or weights after x y z: ignored", self.colors));
        }
        let mut kinds: Vec<String> = self.ignored.iter().map(|(name, count)| format!("{count} {name}")).collect();
        if self.other_ignored > 0 {
            kinds.push(format!("{} others", self.other_ignored));
        }
        if !kinds.is_empty() {
            warnings.push(format!("ignored statements: {}", kinds.join(", ")));
        }
        warnings
    }
}

const NAMES: [&str; 3] = ["vertex (v)", "surface coordinate (vt)", "normal (vn)"];
const STREAMS: &str = "a corner v, v/vt, v//vn or v/vt/vn of whole numbers";

/// `vt u [v [w]]`; v is 0 when absent.
fn surface_coordinate(scanner: &mut Scanner<'_>) -> Result<Vec2, Fault> {
    let u = scanner.finite("u")?;
    Ok(vec2(u, if scanner.at_line_end() { 0.0 } else { scanner.finite("v")? }))
}

/// Index from 0 of an index that counts from 1 or backwards; `None` for 0 and what lies before the first.
fn absolute(index: i64, count: usize) -> Option<u32> {
    let from_zero = if index > 0 { index - 1 } else { i64::try_from(count).ok()?.checked_add(index)? };
    let defined = index != 0 && from_zero >= 0 && from_zero < i64::from(NONE);
    if defined { u32::try_from(from_zero).ok() } else { None }
}

fn out_of_range(index: i64, stream: usize, count: usize) -> String {
    let name = NAMES[stream];
    match index {
        0 => format!("{name} index 0: indices count from 1"),
        ..0 => format!("{name} index {index}: only {count} stand before this line"),
        _ => format!("{name} index {index} is too large"),
    }
}

/// Takes out indices beyond the last surface coordinate or normal.
fn drop_undefined(keys: &mut [[u32; 3]], stream: usize, count: usize, warnings: &mut Vec<String>) {
    let mut dropped = 0_u64;
    for index in keys.iter_mut().filter_map(|key| key.get_mut(stream)) {
        if *index != NONE && *index as usize >= count {
            *index = NONE;
            dropped += 1;
        }
    }
    if dropped > 0 {
        warnings.push(format!("{dropped} vertices name a {} beyond the last, of {count}: ignored", NAMES[stream]));
    }
}

/// One entry of each key, zero where a key has none.
fn all<T: Copy + Default>(keys: &[[u32; 3]], stream: usize, values: &[T]) -> Vec<T> {
    keys.iter().map(|key| pick(values, key[stream])).collect()
}

fn pick<T: Copy + Default>(values: &[T], index: u32) -> T {
    values.get(index as usize).copied().unwrap_or_default()
}
