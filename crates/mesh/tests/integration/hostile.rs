//! Malformed mesh files of every format give an error or a valid mesh, never a panic, and never an
//! allocation for counts that only a header declares. This test is a process of its own because it
//! measures the process's memory.

use juggler_math::hash::{combine, mix};
use juggler_mesh::{MeshFile, MeshLimits, parse};
use juggler_shape::attribute::{AttributeData, AttributeDomain};
use std::path::Path;

/// Replacements for numbers.
const NUMBERS: [&str; 12] = [
    "-1",
    "0",
    "1",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "99999999999999999999",
    "1e39",
    "nan",
    "-inf",
];

const OBJ: &str = "# x\nmtllib a\no b\nv 0 0 0 1 0 0\nv 1e0 0 0\nv 1 1 .5\nv 0 1 0\nv .5 .5 0\nvt 0 0\nvt 1 0\nvt 1 1\n\
                   vn 0 0 1\nvn 0 1 0\nusemtl c\ns 1\nf 1 2 3\nf 1/1 2/2 3/3 4/1\nf 1//1 2//1 \\\n -1//2\nf -5/-3/-2 2/2/1 5/1/1 4/3/2\nl 1 2\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment c\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar red\n\
                   element junk 1\nproperty list int float j\nelement vertex 4\nproperty float x\nproperty double y\nproperty short z\n\
                   property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nend_header\n\
                   4 0 1 2 3 9\n3 2 1 0 9\n2 7 8\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n";

const ATTRIBUTES: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                          property float attribute.a.1\nproperty float attribute.a.0\nproperty uchar attribute.b%20c\n\
                          element face 2\nproperty list uchar int vertex_indices\nproperty ushort attribute.d\nend_header\n\
                          0 0 0 .5 2 0\n1 0 0 1e3 -2 1\n1 1 0 0 0 255\n0 1 0 7 8 9\n4 0 1 2 3 65535\n3 2 1 0 7\n";

const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
                   facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1e0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

fn binary_ply(order: &str, of: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty uchar z\n\
         element junk 1\nproperty list ushort short j\nelement face 2\nproperty list uint uint vertex_index\nend_header\n"
    )
    .into_bytes();
    for (x, y) in [(0.0_f32, 0.0_f64), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        bytes.extend(of(&x.to_le_bytes()));
        bytes.extend(of(&y.to_le_bytes()));
        bytes.push(0);
    }
    bytes.extend([2_u16, 5, 6].iter().flat_map(|value| of(&value.to_le_bytes())));
    bytes.extend([4_u32, 0, 1, 2, 3, 3, 0, 1, 2].iter().flat_map(|value| of(&value.to_le_bytes())));
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = format!("{:80}", "solid or not").into_bytes();
    bytes.extend(2_u32.to_le_bytes());
    for facet in
        [[[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]]
    {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flatten().flat_map(|value| value.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a.obj", OBJ.into()),
        ("a.ply", PLY.into()),
        ("attributes.ply", ATTRIBUTES.into()),
        ("little.ply", binary_ply("little", <[u8]>::to_vec)),
        ("big.ply", binary_ply("big", |bytes| bytes.iter().rev().copied().collect())),
        ("a.stl", STL.into()),
        ("b.stl", binary_stl()),
    ]
}

/// Asserts the invariants of an imported mesh.
fn assert_sound(found: &MeshFile, bytes: &[u8], what: &str) {
    let mesh = &found.mesh;
    let count = mesh.positions.len();
    assert!(
        !mesh.triangles.is_empty() && mesh.triangles.iter().flatten().all(|index| (*index as usize) < count),
        "{what}"
    );
    assert!(mesh.positions.iter().all(|position| position.is_finite()), "{what}");
    assert!(mesh.normals.is_empty() || mesh.normals.len() == count, "{what}");
    assert!(mesh.normals.iter().all(|normal| normal.is_finite()), "{what}");
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == count, "{what}");
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()), "{what}");
    for attribute in mesh.attributes.values() {
        let is_vertex = attribute.domain == AttributeDomain::Vertex;
        let values = if is_vertex { count } else { mesh.triangles.len() };
        assert!((1..=4).contains(&attribute.channels), "{what}");
        assert_eq!(attribute.data.len(), values * attribute.channels as usize, "{what}");
        let AttributeData::F32(numbers) = &attribute.data else { continue };
        assert!(numbers.iter().all(|number| number.is_finite()), "{what}");
    }
    let held = mesh.positions.capacity() + mesh.triangles.capacity() + mesh.normals.capacity() + mesh.uvs.capacity();
    assert!(held <= 4 * bytes.len(), "{what}: {held} entries for {} bytes", bytes.len());
    assert!(found.warnings.iter().map(String::len).sum::<usize>() <= 2000, "{what}");
}

/// Parses a file and returns whether it gives a mesh.
fn read(name: &str, bytes: &[u8], what: &str) -> bool {
    match parse(Path::new(name), bytes, &MeshLimits::default()) {
        Ok(found) => {
            assert_sound(&found, bytes, what);
            true
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with(&format!("{name}: ")) && text.len() < 600, "{what}: {text}");
            false
        }
    }
}

/// Applies one to four random changes, determined by the number of the case.
fn mutate(original: &[u8], case: u32) -> Vec<u8> {
    let mut bytes = original.to_vec();
    let mut draw = (0_u32..).map(|index| combine(mix(case), index) as usize);
    let mut next = |below: usize| draw.next().unwrap_or_default() % below.max(1);
    for _ in 0..=next(4) {
        let at = next(bytes.len());
        match next(6) {
            0 => bytes[at] ^= 1 << next(8),
            1 => bytes[at] = next(256) as u8,
            2 => replace_word(&mut bytes, at, NUMBERS[next(NUMBERS.len())].as_bytes()),
            3 => {
                let value = [u32::MAX, 0, 0x7f80_0000, 0x8000_0000, 0x00ff_ffff][next(5)].to_ne_bytes();
                bytes.iter_mut().skip(at).zip(value).for_each(|(byte, new)| *byte = new);
            }
            4 => drop(bytes.drain(at..bytes.len().min(at + 1 + next(12)))),
            _ => {
                let copy = bytes[at..bytes.len().min(at + 1 + next(40))].to_vec();
                let to = next(bytes.len());
                bytes.splice(to..to, copy);
            }
        }
        if bytes.is_empty() {
            return bytes;
        }
    }
    bytes
}

fn replace_word(bytes: &mut Vec<u8>, at: usize, word: &[u8]) {
    let blank = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'/';
    let start = bytes[..at].iter().rposition(blank).map_or(0, |index| index + 1);
    let end = bytes[at..].iter().position(blank).map_or(bytes.len(), |length| at + length);
    if start <= end {
        bytes.splice(start..end, word.iter().copied());
    }
}

/// Peak address space of this process in KiB, if the system reports it.
fn peak_address_space() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmPeak:"))?.split_whitespace().next()?.parse().ok()
}

#[test]
fn broken_files_give_an_error_or_a_sound_mesh_in_little_memory() {
    const MUTATIONS: u32 = 10_000;
    let before = peak_address_space();
    let (mut cases, mut meshes) = (0, 0);
    for (name, original) in seeds() {
        assert!(read(name, &original, name), "{name} itself must be a mesh");
        for length in 0..original.len() {
            cases += 1;
            meshes += u32::from(read(name, &original[..length], &format!("{name} cut to {length}")));
        }
        for case in 0..MUTATIONS {
            cases += 1;
            meshes += u32::from(read(name, &mutate(&original, case), &format!("{name} mutation {case}")));
        }
    }
    assert!(cases > 60_000, "{cases}");
    assert!(
        meshes > cases / 20 && meshes < cases - cases / 20,
        "{meshes} meshes of {cases}: the mutations are no test"
    );
    if let (Some(before), Some(after)) = (before, peak_address_space()) {
        assert!(after - before < 256 * 1024, "{} KiB more address space than before", after - before);
    }
}
