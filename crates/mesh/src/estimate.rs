//! Memory estimates of mesh files before they are read, from their size, their header, and samples
//! of a text. The factors are measured (docs/benchmarks.md, "Memory").

use crate::error::MeshError;
use crate::formats;
use crate::limits::MeshLimits;
use crate::ply::declared_points;
use crate::sampling::{Counts, FACE, FileSampler};
use juggler_shape::MeshData;
use std::io;
use std::path::Path;

/// Bytes per triangle during the construction of the hierarchy, and of the finished hierarchy.
const BUILDING: u64 = 96;
const BUILT: u64 = 64;

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

impl MeshEstimate {
    /// Memory of a file of `file` bytes with these contents.
    fn new(counts: &Counts, file: u64) -> Self {
        let product = u64::saturating_mul;
        let triangle_bytes = product(counts.triangles, FACE + counts.face_bytes);
        let mesh = product(counts.vertices, counts.vertex_bytes).saturating_add(triangle_bytes);
        let reading = file.saturating_add(mesh).saturating_add(counts.temporary_bytes);
        let building = mesh.saturating_add(product(counts.triangles, BUILDING));
        let resident_bytes = mesh.saturating_add(product(counts.triangles, BUILT));
        Self { triangles: counts.triangles, resident_bytes, peak_bytes: reading.max(building) }
    }

    /// Estimates the memory of a mesh whose arrays are in memory already, these included.
    pub fn from_arrays(mesh: &MeshData) -> Self {
        let (triangles, arrays) = (mesh.triangles.len() as u64, mesh.bytes() as u64);
        let with = |hierarchy: u64| arrays.saturating_add(triangles.saturating_mul(hierarchy));
        Self { triangles, resident_bytes: with(BUILT), peak_bytes: with(BUILDING) }
    }
}

/// Estimates the memory to load a file and to build the hierarchy of its mesh, as an upper bound of
/// measured values. Zero for a file that no reader supports or that exceeds the default limit of
/// bytes.
pub fn estimate(path: &Path) -> Result<MeshEstimate, MeshError> {
    let failed = |error: io::Error| MeshError { path: path.to_owned(), kind: error.into() };
    let file = FileSampler::open(path, MeshLimits::default().file_bytes).map_err(failed)?;
    of_samples(path, file).map_err(failed)
}

/// [`estimate`] of a file in memory. Its name counts if its content belongs to no format.
pub fn estimate_bytes(path: &Path, bytes: &[u8]) -> MeshEstimate {
    let file = FileSampler::from_bytes(bytes, MeshLimits::default().file_bytes);
    file.and_then(|file| of_samples(path, file)).unwrap_or_default()
}

fn of_samples(path: &Path, mut file: FileSampler) -> io::Result<MeshEstimate> {
    let size = file.size;
    let format = formats::of_head(&file.head, size).or_else(|| formats::of_name(path));
    let format = format.filter(|_| size <= MeshLimits::default().file_bytes);
    let Some(format) = format else { return Ok(MeshEstimate::default()) };
    Ok(MeshEstimate::new(&format.counts(&mut file)?, size))
}

/// Estimated memory of the points of a PLY file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PointEstimate {
    /// Number of points.
    pub count: u64,
    /// Size of their arrays, in bytes.
    pub resident_bytes: u64,
    /// Peak memory while they are read, in bytes.
    pub peak_bytes: u64,
}

/// Estimates the memory to read the points of a PLY file, from its header. Zero for a file that is no
/// PLY of points or exceeds the default limit of bytes.
pub fn estimate_points(path: &Path) -> Result<PointEstimate, MeshError> {
    let failed = |error: io::Error| MeshError { path: path.to_owned(), kind: error.into() };
    let limit = MeshLimits::default().file_bytes;
    let file = FileSampler::open(path, limit).map_err(failed)?;
    if file.size > limit { Ok(PointEstimate::default()) } else { Ok(points_of_head(&file.head, file.size)) }
}

/// Estimates the memory of the points of a PLY file of `size` bytes from its first bytes, as
/// [`estimate_points`] does.
pub fn points_of_head(head: &[u8], size: u64) -> PointEstimate {
    let Some((count, bytes)) = declared_points(head, size) else { return PointEstimate::default() };
    let resident_bytes = count.saturating_mul(bytes);
    // Arrays are copied to their final place one after the other.
    PointEstimate { count, resident_bytes, peak_bytes: resident_bytes.saturating_mul(2).saturating_add(size) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, bytes: &[u8]) -> MeshEstimate {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let found = estimate(&path).unwrap();
        assert_eq!(estimate_bytes(Path::new(name), bytes), found, "in memory");
        found
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
        // Attributes of vertices and faces.
        let attributes = |text: &str| {
            let text =
                text.replace("z\nelement", "z\nproperty ushort attribute.a.0\nproperty ushort attribute.a.1\nelement");
            text.replace("uchar red", "double attribute.b")
        };
        let face = |corners: &[u32]| {
            let corners: Vec<u8> = corners.iter().flat_map(|corner| corner.to_le_bytes()).collect();
            [&[(corners.len() / 4) as u8], corners.as_slice(), &[0; 8]].concat()
        };
        let body = [vec![0; 4 * 16], face(&[0, 1, 2, 3]), face(&[0, 1, 2])].concat();
        let bytes = ply("binary_little_endian", &body);
        let head = String::from_utf8(bytes[..bytes.len() - body.len()].to_vec()).unwrap();
        let found = of("a.ply", &[attributes(&head).as_bytes(), &body].concat());
        assert_eq!((found.triangles, found.resident_bytes), (3, 4 * 16 + 3 * (FACE + 4 + BUILT)));
        let read =
            crate::parse(Path::new("a.ply"), &[attributes(&head).as_bytes(), &body].concat(), &MeshLimits::default());
        assert!(MeshEstimate::from_arrays(&read.unwrap().mesh).resident_bytes <= found.resident_bytes);
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
