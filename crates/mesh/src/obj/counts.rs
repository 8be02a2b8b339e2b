//! Estimated counts of an OBJ from the statements of samples.

use crate::sampling::{CORNER, Counts, FileSampler, lines, scaled, words};
use std::collections::BTreeSet;
use std::io;

/// Estimates the counts of an OBJ.
pub(super) fn counts(file: &mut FileSampler) -> io::Result<Counts> {
    let mut found = Statements::default();
    let sampled_bytes = file.sample(|text| found.count(text))?;
    Ok(found.extrapolate(file.size, sampled_bytes).counts())
}

/// Counts of the statements of a text.
#[derive(Clone, Copy, Debug, Default)]
struct Statements {
    positions: u64,
    /// Number of positions with a color.
    colors: u64,
    uvs: u64,
    normals: u64,
    triangles: u64,
    corners: u64,
    /// Number of distinct corners, and of distinct positions that they use, summed over the
    /// samples.
    distinct: [u64; 2],
}

impl Statements {
    /// Counts the statements of a sample.
    fn count(&mut self, text: &[u8]) {
        let mut different = [BTreeSet::new(), BTreeSet::new()];
        for line in lines(text) {
            let mut words = words(line);
            match words.next() {
                Some("v") => {
                    self.positions += 1;
                    self.colors += u64::from(words.count() >= 6);
                }
                Some("vt") => self.uvs += 1,
                Some("vn") => self.normals += 1,
                Some("f" | "fo") => {
                    let before = self.corners;
                    for corner in words {
                        self.corners += 1;
                        different[0].insert(corner);
                        different[1].insert(corner.split('/').next().unwrap_or_default());
                    }
                    self.triangles += (self.corners - before).saturating_sub(2);
                }
                _ => {}
            }
        }
        self.distinct.iter_mut().zip(different).for_each(|(sum, set)| *sum += set.len() as u64);
    }

    /// Counts of a file of `size` bytes of which `sampled_bytes` were counted.
    fn extrapolate(self, size: u64, sampled_bytes: u64) -> Self {
        let all = |count| scaled(count, size, sampled_bytes);
        Self {
            positions: all(self.positions),
            colors: all(self.colors),
            uvs: all(self.uvs),
            normals: all(self.normals),
            triangles: all(self.triangles),
            corners: all(self.corners),
            distinct: self.distinct,
        }
    }

    /// Counts of an OBJ: a position with several normals or texture coordinates becomes several
    /// vertices.
    fn counts(&self) -> Counts {
        let [corners, positions] = self.distinct;
        let vertices = scaled(self.positions, corners, positions.min(corners)).min(self.corners);
        // Colors of some positions are white colors of all others.
        let colors = if self.colors > 0 { self.positions } else { 0 };
        let attribute_bytes =
            if self.normals > 0 { 12 } else { 0 } + if self.uvs > 0 { 8 } else { 0 } + if colors > 0 { 12 } else { 0 };
        let lists = (self.positions + colors) * 12 + self.uvs * 8 + self.normals * 12;
        let polygons = if self.corners > self.triangles * 3 { self.triangles * 16 } else { 0 };
        Counts {
            face_bytes: 0,
            vertices,
            triangles: self.triangles,
            vertex_bytes: 12 + attribute_bytes,
            temporary_bytes: lists.saturating_add(vertices.saturating_mul(CORNER)).saturating_add(polygons),
        }
    }
}
