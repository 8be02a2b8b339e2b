//! Memory estimates of mesh files before they are read, from their size, their header, and samples
//! of a text. The factors are measured (docs/benchmarks.md, "Memory").

use crate::{MeshError, MeshLimits, format};
use juggler_imaging::regular;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Number of bytes read at the start of a file: enough for any sensible header and for all of a
/// small file.
const HEAD: u64 = 1 << 20;
/// Number of bytes read at the end, where the faces of a PLY are.
const TAIL: u64 = 1 << 18;
/// Number of evenly spaced samples of a longer text, and the size of each in bytes.
const SAMPLES: u64 = 64;
const SAMPLE_BYTES: u64 = 1 << 14;
/// Bytes per triangle during the construction of the hierarchy, and of the finished hierarchy.
const BUILDING: u64 = 96;
const BUILT: u64 = 64;
/// Bytes per triangle, and per distinct corner, while the file is read.
pub(crate) const FACE: u64 = 12;
const CORNER: u64 = 12 + 4 + 10;

/// Estimated memory of a mesh file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshEstimate {
    /// Number of triangles after triangulation of polygons.
    pub triangles: u64,
    /// Size of the mesh and its hierarchy, in bytes.
    pub resident_bytes: u64,
    /// Peak memory from the start of reading to the finished hierarchy, in bytes.
    pub peak_bytes: u64,
}

/// Estimated contents of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Counts {
    pub vertices: u64,
    pub triangles: u64,
    /// Bytes of a vertex_bytes: position, normal, texture coordinates.
    pub vertex_bytes: u64,
    /// Bytes of a triangle beside its indices: color.
    pub face_bytes: u64,
    /// Temporary memory while reading, beside the file and the mesh, in bytes.
    pub temporary_bytes: u64,
}

impl Counts {
    /// Counts for facets whose corners may all be distinct.
    pub fn of_facets(facets: u64) -> Self {
        let corners = facets.saturating_mul(3);
        Self {
            vertices: corners,
            triangles: facets,
            vertex_bytes: 12,
            face_bytes: 0,
            temporary_bytes: corners.saturating_mul(CORNER - 12),
        }
    }

    fn estimate(&self, file: u64) -> MeshEstimate {
        let product = u64::saturating_mul;
        let mesh =
            product(self.vertices, self.vertex_bytes).saturating_add(product(self.triangles, FACE + self.face_bytes));
        let reading = file.saturating_add(mesh).saturating_add(self.temporary_bytes);
        let building = mesh.saturating_add(product(self.triangles, BUILDING));
        let resident_bytes = mesh.saturating_add(product(self.triangles, BUILT));
        MeshEstimate { triangles: self.triangles, resident_bytes, peak_bytes: reading.max(building) }
    }
}

/// Estimates the memory to [`load`](super::load) a file and to build the hierarchy of its mesh, as
/// an upper bound of measured values. Zero for a file that no reader supports or that exceeds the
/// default limit of bytes.
pub fn estimate(path: &Path) -> Result<MeshEstimate, MeshError> {
    let failed = |error: io::Error| MeshError { path: path.to_owned(), kind: error.into() };
    let mut file = regular::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    if size > MeshLimits::default().file_bytes {
        return Ok(MeshEstimate::default());
    }
    let head = read_at(&mut file, 0, HEAD).map_err(failed)?;
    let Some(format) = format::of_head(&head, size).or_else(|| format::of_name(path)) else {
        return Ok(MeshEstimate::default());
    };
    let counts = format.counts(&mut FileSampler { file, head, size }).map_err(failed)?;
    Ok(counts.estimate(size))
}

/// An open file of which samples are read.
pub(crate) struct FileSampler {
    file: File,
    /// First bytes: at most [`HEAD`], all of a smaller file.
    pub head: Vec<u8>,
    /// Size of the file, in bytes.
    pub size: u64,
}

fn read_at(file: &mut File, at: u64, length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(at))?;
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Extrapolates `count` in a sample of `part` bytes to `whole` bytes, plus 5 % if the sample is not
/// the whole.
pub(crate) fn scaled(count: u64, whole: u64, part: u64) -> u64 {
    let exact = u128::from(count) * u128::from(whole) / u128::from(part.max(1));
    let more = if whole > part { exact / 20 } else { 0 };
    u64::try_from(exact + more).unwrap_or(u64::MAX)
}

/// Counts of the statements of a text.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sample {
    positions: u64,
    /// Number of positions with a color.
    colors: u64,
    uvs: u64,
    normals: u64,
    triangles: u64,
    corners: u64,
    pub facets: u64,
    /// Number of distinct corners, and of distinct positions that they use, summed over the
    /// samples.
    distinct: [u64; 2],
}

impl FileSampler {
    /// Reads the last bytes of the file: at most [`TAIL`], all of a smaller file.
    pub fn tail(&mut self) -> io::Result<Vec<u8>> {
        read_at(&mut self.file, self.size.saturating_sub(TAIL), TAIL)
    }

    /// Counts the statements of a text, of a longer one by extrapolation from samples.
    pub fn sample(&mut self) -> io::Result<Sample> {
        let (mut found, size) = (Sample::default(), self.size);
        if size <= HEAD {
            found.count(&self.head);
            return Ok(found);
        }
        // Free the head's memory before the samples are read.
        self.head = Vec::new();
        let mut sampled_bytes = 0;
        for i in 0..SAMPLES {
            let bytes = read_at(&mut self.file, (size - SAMPLE_BYTES) / (SAMPLES - 1) * i, SAMPLE_BYTES)?;
            // Keep only complete lines.
            let start = bytes.iter().position(|byte| *byte == b'\n').map_or(0, |at| at + 1);
            let end = bytes.iter().rposition(|byte| *byte == b'\n').unwrap_or(0);
            let whole = bytes.get(start..end).unwrap_or_default();
            sampled_bytes += whole.len() as u64 + 1;
            found.count(whole);
        }
        let Sample { positions, colors, uvs, normals, triangles, corners, facets, distinct } = found;
        let [positions, colors, uvs, normals, triangles, corners, facets] =
            [positions, colors, uvs, normals, triangles, corners, facets]
                .map(|count| scaled(count, size, sampled_bytes));
        Ok(Sample { positions, colors, uvs, normals, triangles, corners, facets, distinct })
    }
}

impl Sample {
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
                Some("facet") => self.facets += 1,
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

    /// Counts of an OBJ: a position with several normals or texture coordinates becomes several
    /// vertices.
    pub fn obj_counts(&self) -> Counts {
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

pub(crate) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|byte| matches!(byte, b'\n' | b'\r'))
}

pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &str> {
    std::str::from_utf8(line).unwrap_or_default().split_ascii_whitespace()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, bytes: &[u8]) -> MeshEstimate {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        estimate(&path).unwrap()
    }

    fn ply(format: &str, body: &[u8]) -> Vec<u8> {
        let head = format!(
            "ply\nformat {format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
             element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n"
        );
        [head.as_bytes(), body].concat()
    }

    #[test]
    fn size_of_a_binary_ply_follows_from_header_and_length() {
        // A quadrilateral and a triangle, with a color each.
        let body = vec![0; 4 * 12 + (1 + 4 * 4 + 1) + (1 + 3 * 4 + 1)];
        let found = of("a.ply", &ply("binary_little_endian", &body));
        assert_eq!((found.triangles, found.resident_bytes), (3, 4 * 12 + 3 * (FACE + BUILT)));
        let text = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 9\n3 0 1 2 9\n";
        assert!((3..9).contains(&of("a.ply", &ply("ascii", text.as_bytes())).triangles));
        let lies = ply("binary_little_endian", &[]);
        let lies = String::from_utf8(lies).unwrap().replace("face 2", "face 2000000000");
        assert_eq!(
            of("a.ply", lies.as_bytes()),
            MeshEstimate { peak_bytes: lies.len() as u64, ..MeshEstimate::default() }
        );
    }

    #[test]
    fn size_of_a_text_mesh_is_counted_or_sampled() {
        let small = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1 4//1\nf 1//2 2//2 3//2\n";
        let found = of("a.obj", small.as_bytes());
        // There are seven distinct corners, more than positions.
        assert_eq!((found.triangles, found.resident_bytes), (3, 7 * 24 + 3 * (FACE + BUILT)));
        let colored = "v 0 0 0 1 0 0\nv 1 0 0 1 1 0\nv 1 1 0\nf 1 2 3\n";
        assert_eq!(of("a.obj", colored.as_bytes()).resident_bytes, 3 * 24 + FACE + BUILT);
        // A long text is only sampled.
        let long: String = (0..50_000).map(|i| format!("v {i} {} 0\n", i / 7)).collect();
        let faces: String = (0..40_000).map(|i| format!("f {} {} {} {}\n", i + 1, i + 2, i + 3, i + 4)).collect();
        let found = of("a.obj", format!("{long}{faces}").as_bytes());
        assert!((80_000..96_000).contains(&found.triangles), "{found:?}");
    }

    #[test]
    fn size_of_an_stl_follows_from_its_triangle_count() {
        let mut stl = vec![0; 84 + 50 * 10];
        stl[80] = 10;
        assert_eq!(of("a.stl", &stl).triangles, 10);
        assert_eq!(of("a.xyz", b"\x7fELF"), MeshEstimate::default());
        assert!(estimate(Path::new("there is none.ply")).is_err());
    }
}
