//! How much memory a mesh file will take, told before it is read: from its size, its head, and a look into a text here
//! and there. Factors were measured (docs/benchmarks.md, "Memory").

use super::{ImportError, Limits, format};
use juggler_imaging::regular;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Bytes of the first look, which holds any sensible header, and smaller files as a whole.
const HEAD: u64 = 1 << 20;
/// Bytes of a look at the end, where a PLY has its faces.
const TAIL: u64 = 1 << 18;
/// Looks into a longer text, in even steps, and bytes of each.
const LOOKS: u64 = 64;
const LOOK: u64 = 1 << 14;
/// Bytes a triangle while its hierarchy is built, and of the hierarchy when it stands.
const BUILDING: u64 = 96;
const BUILT: u64 = 64;
/// Bytes a triangle, and a corner that is not yet known to be another's, while the file is read.
pub(super) const FACE: u64 = 12;
const CORNER: u64 = 12 + 4 + 10;

/// What a mesh file will take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Triangles, after polygons are cut.
    pub triangles: u64,
    /// Bytes of the mesh and its hierarchy.
    pub kept: u64,
    /// The most bytes at once, from the first byte read to the finished hierarchy.
    pub peak: u64,
}

/// Estimated content of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Counts {
    pub vertices: u64,
    pub triangles: u64,
    /// Bytes of a vertex: position, normal, surface coordinates.
    pub vertex: u64,
    /// Bytes that are held while the file is read, beside the file and the mesh.
    pub aside: u64,
}

impl Counts {
    /// Facets whose corners may all be different.
    pub fn of_facets(facets: u64) -> Self {
        let corners = facets.saturating_mul(3);
        Self { vertices: corners, triangles: facets, vertex: 12, aside: corners.saturating_mul(CORNER - 12) }
    }

    fn estimate(&self, file: u64) -> Estimate {
        let product = u64::saturating_mul;
        let mesh = product(self.vertices, self.vertex).saturating_add(product(self.triangles, FACE));
        let reading = file.saturating_add(mesh).saturating_add(self.aside);
        let building = mesh.saturating_add(product(self.triangles, BUILDING));
        let kept = mesh.saturating_add(product(self.triangles, BUILT));
        Estimate { triangles: self.triangles, kept, peak: reading.max(building) }
    }
}

/// How much memory it takes to [`load`](super::load) a file and to build the hierarchy of its mesh: an upper bound of
/// what has been measured. Nothing for a file that no reader takes.
pub fn estimate(path: &Path) -> Result<Estimate, ImportError> {
    let failed = |error: io::Error| ImportError { path: path.to_owned(), fault: error.into() };
    let mut file = regular::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    if size > Limits::default().file_bytes {
        return Ok(Estimate::default());
    }
    let head = look(&mut file, 0, HEAD).map_err(failed)?;
    let Some(format) = format::of_head(&head, size).or_else(|| format::of_name(path)) else {
        return Ok(Estimate::default());
    };
    let counts = format.counts(&mut Survey { file, head, size }).map_err(failed)?;
    Ok(counts.estimate(size))
}

/// An open file of which parts are looked at.
pub(super) struct Survey {
    file: File,
    /// First bytes: [`HEAD`], or the whole of a smaller file.
    pub head: Vec<u8>,
    /// Size of the file, in bytes.
    pub size: u64,
}

fn look(file: &mut File, at: u64, length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(at))?;
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// `count` of `part`, of `whole`; rounded up and a little more, for a sample is not the whole.
pub(super) fn scaled(count: u64, whole: u64, part: u64) -> u64 {
    let exact = u128::from(count) * u128::from(whole) / u128::from(part.max(1));
    let more = if whole > part { exact / 20 } else { 0 };
    u64::try_from(exact + more).unwrap_or(u64::MAX)
}

/// Statements of a text.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    positions: u64,
    uvs: u64,
    normals: u64,
    triangles: u64,
    corners: u64,
    pub facets: u64,
    /// Different corners, and different positions that they name.
    distinct: [u64; 2],
}

impl Survey {
    /// Last bytes of the file: [`TAIL`], or the whole of a smaller file.
    pub fn tail(&mut self) -> io::Result<Vec<u8>> {
        look(&mut self.file, self.size.saturating_sub(TAIL), TAIL)
    }

    /// Counts statements in a whole text, or in parts of a longer one.
    pub fn sample(&mut self) -> io::Result<Sample> {
        let (mut found, size) = (Sample::default(), self.size);
        if size <= HEAD {
            found.count(&self.head);
            return Ok(found);
        }
        // The looks below take its memory.
        self.head = Vec::new();
        let mut seen = 0;
        for i in 0..LOOKS {
            let bytes = look(&mut self.file, (size - LOOK) / (LOOKS - 1) * i, LOOK)?;
            // Lines that are whole.
            let start = bytes.iter().position(|byte| *byte == b'\n').map_or(0, |at| at + 1);
            let end = bytes.iter().rposition(|byte| *byte == b'\n').unwrap_or(0);
            let whole = bytes.get(start..end).unwrap_or_default();
            seen += whole.len() as u64 + 1;
            found.count(whole);
        }
        let Sample { positions, uvs, normals, triangles, corners, facets, distinct } = found;
        let [positions, uvs, normals, triangles, corners, facets] =
            [positions, uvs, normals, triangles, corners, facets].map(|count| scaled(count, size, seen));
        Ok(Sample { positions, uvs, normals, triangles, corners, facets, distinct })
    }
}

impl Sample {
    fn count(&mut self, text: &[u8]) {
        let mut different = [BTreeSet::new(), BTreeSet::new()];
        for line in lines(text) {
            let mut words = words(line);
            match words.next() {
                Some("v") => self.positions += 1,
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

    /// As an OBJ: a corner of other normals or surface coordinates is a vertex of its own.
    pub fn wavefront(&self) -> Counts {
        let [corners, positions] = self.distinct;
        let vertices = scaled(self.positions, corners, positions.min(corners)).min(self.corners);
        let carried = if self.normals > 0 { 12 } else { 0 } + if self.uvs > 0 { 8 } else { 0 };
        let lists = self.positions * 12 + self.uvs * 8 + self.normals * 12;
        let polygons = if self.corners > self.triangles * 3 { self.triangles * 16 } else { 0 };
        Counts {
            vertices,
            triangles: self.triangles,
            vertex: 12 + carried,
            aside: lists.saturating_add(vertices.saturating_mul(CORNER)).saturating_add(polygons),
        }
    }
}

pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|byte| matches!(byte, b'\n' | b'\r'))
}

pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &str> {
    std::str::from_utf8(line).unwrap_or_default().split_ascii_whitespace()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, bytes: &[u8]) -> Estimate {
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
    fn a_binary_ply_is_known_by_its_head_and_length() {
        // A quadrilateral and a triangle, with a colour each.
        let body = vec![0; 4 * 12 + (1 + 4 * 4 + 1) + (1 + 3 * 4 + 1)];
        let found = of("a.ply", &ply("binary_little_endian", &body));
        assert_eq!((found.triangles, found.kept), (3, 4 * 12 + 3 * (FACE + BUILT)));
        let text = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 9\n3 0 1 2 9\n";
        assert!((3..9).contains(&of("a.ply", &ply("ascii", text.as_bytes())).triangles));
        let lies = ply("binary_little_endian", &[]);
        let lies = String::from_utf8(lies).unwrap().replace("face 2", "face 2000000000");
        assert_eq!(of("a.ply", lies.as_bytes()), Estimate { peak: lies.len() as u64, ..Estimate::default() });
    }

    #[test]
    fn texts_are_counted() {
        let small = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1 4//1\nf 1//2 2//2 3//2\n";
        let found = of("a.obj", small.as_bytes());
        // Seven different corners, more than there are positions.
        assert_eq!((found.triangles, found.kept), (3, 7 * 24 + 3 * (FACE + BUILT)));
        // Of a long one only parts are looked at.
        let long: String = (0..50_000).map(|i| format!("v {i} {} 0\n", i / 7)).collect();
        let faces: String = (0..40_000).map(|i| format!("f {} {} {} {}\n", i + 1, i + 2, i + 3, i + 4)).collect();
        let found = of("a.obj", format!("{long}{faces}").as_bytes());
        assert!((80_000..96_000).contains(&found.triangles), "{found:?}");
    }

    #[test]
    fn soups_and_what_is_no_mesh() {
        let mut stl = vec![0; 84 + 50 * 10];
        stl[80] = 10;
        assert_eq!(of("a.stl", &stl).triangles, 10);
        assert_eq!(of("a.xyz", b"\x7fELF"), Estimate::default());
        assert!(estimate(Path::new("there is none.ply")).is_err());
    }
}
