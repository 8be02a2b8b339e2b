//! Tests of mesh loading: file names, contents that contradict their names, limits.

use crate::format::MeshFormat;
use crate::obj::Obj;
use crate::pieces::pieces;
use crate::ply::Ply;
use crate::stl::Stl;
use crate::*;
use std::fmt::Write;
use std::path::Path;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const FACET: &str =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const TABLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                     element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn all_formats_give_the_same_mesh_under_any_file_extension() {
    let expected = parse(Path::new("a.obj"), TRIANGLE.as_bytes(), &MeshLimits::default()).unwrap();
    assert!(expected.warnings.is_empty());
    for (name, text, is) in [
        ("a.OBJ", TRIANGLE, None),
        ("a.stl", FACET, None),
        ("a.Ply", TABLE, None),
        ("a.ply", FACET, Some("STL")),
        ("a.obj", TABLE, Some("PLY")),
        ("a.stl", TRIANGLE, Some("OBJ")),
        ("noname", TABLE, Some("PLY")),
        ("a.obj", &format!("\u{feff}{TRIANGLE}"), None),
    ] {
        let found = parse(Path::new(name), text.as_bytes(), &MeshLimits::default()).unwrap();
        assert_eq!(found.mesh, expected.mesh, "{name}");
        let warning = is.map(|is| format!("the file's extension does not match its content, which is {is}"));
        assert_eq!(found.warnings, Vec::from_iter(warning), "{name}");
    }
}

#[test]
fn files_are_loaded_and_their_size_is_limited() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Part.Obj");
    std::fs::write(&path, TRIANGLE).unwrap();
    assert_eq!(load(&path, &MeshLimits::default()).unwrap().mesh.triangles, [[0, 1, 2]]);
    let size = TRIANGLE.len() as u64;
    assert!(load(&path, &MeshLimits { file_bytes: size, ..MeshLimits::default() }).is_ok());
    let error = load(&path, &MeshLimits { file_bytes: size - 1, ..MeshLimits::default() }).unwrap_err();
    assert_eq!(error.to_string(), format!("{}: at least 32 bytes, the limit is 31", path.display()));
    assert_eq!(error.path, path);
}

#[test]
fn unreadable_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = load(&folder.path().join("none.ply"), &MeshLimits::default()).unwrap_err();
    assert!(matches!(missing.kind, MeshErrorKind::Read(_)));
    assert!(missing.to_string().contains("none.ply: cannot be read: "), "{missing}");
    let directory = folder.path().join("folder.ply");
    std::fs::create_dir(&directory).unwrap();
    assert!(matches!(load(&directory, &MeshLimits::default()).unwrap_err().kind, MeshErrorKind::Read(_)));
    let unknown = parse(Path::new("cow.moo"), b"\0\x01cow", &MeshLimits::default()).unwrap_err();
    assert_eq!(unknown.to_string(), "cow.moo: not a known mesh format: expected a file named .obj, .ply or .stl");
    let foreign = parse(Path::new("cow.fbx"), b"Kaydara FBX", &MeshLimits::default()).unwrap_err();
    assert_eq!(foreign.to_string(), "cow.fbx: FBX is not supported: export the model as glTF (.glb), OBJ, PLY or STL");
}

#[test]
fn an_error_names_file_and_line() {
    let error = parse(Path::new("models/cow.obj"), b"v 0 0 0\nv 1 0\n", &MeshLimits::default()).unwrap_err();
    assert_eq!(error.to_string(), "models/cow.obj: line 2: expected a number for z, found the end of the line");
    assert!(matches!(error.kind, MeshErrorKind::Malformed { place: FilePosition::Line(2), .. }));
}

/// Asserts that a file read in pieces of every size, on one thread and on three, gives the same
/// mesh, warnings or error as the file read in one piece.
fn assert_pieces_do_not_show(format: &dyn MeshFormat, bytes: &[u8]) {
    let outcome = |piece| format.read(bytes, &MeshLimits::default(), pieces(piece)).map_err(|error| error.to_string());
    let whole = outcome(usize::MAX);
    let [alone, three] = [1, 3].map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap());
    for piece in (1..bytes.len().min(300)).chain([bytes.len()]) {
        let pool = if piece % 2 == 0 { &alone } else { &three };
        assert_eq!(pool.install(|| outcome(piece)), whole, "{piece}: {}", String::from_utf8_lossy(bytes));
    }
}

/// The text, the text with each kind of line ending, and the text with each of the replacements.
fn variants(text: &str, changes: &[(&str, &str)]) -> Vec<String> {
    let changed = changes.iter().map(|(old, new)| {
        assert!(text.contains(old), "{old}");
        text.replacen(old, new, 1)
    });
    let ends = ["\r\n", "\r"].map(|end| text.replace('\n', end));
    changed.chain(ends).chain([text.to_owned(), text.trim_end().to_owned()]).collect()
}

#[test]
fn chunk_size_does_not_change_an_obj() {
    let mut text =
        String::from("# cut me \\\nmtllib a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\n");
    text += "g a b\nusemtl c\nf 1 2 3\nf -4//1 -2/2 -1/-1/-1\n\n  # v 7 7 7\nv .5 \\\n .5 \\\n\\\n0\nf 1 2 -1 4\ns 1\n";
    text += "f 1 2 12\nf 1/1 2/9 3/2\nf 1 2\n";
    (0..8).for_each(|i| writeln!(text, "v {i} {} 2 1 1 1 # {i}", i % 3).unwrap());
    text += "f 6 7 8 9 10 11 12 13\nusemtl d\nf -1 -2 -3\nf 6 8 10\nf 1 2 3";
    let changes = [
        ("v 1 1 0", "v 1 one 0"),
        ("-1/-1/-1", "-5/-1/-1"),
        ("-1/-1/-1", "-1/-1/-2"),
        ("f 1 2 12", "f 1 2 99\nf 98 99 100\nf 100 1 2"),
        ("s 1\n", "s 1\n\n\nf 0 1 2\n"),
        ("f 6 8 10", "f 6 8 x\nf 6 y 8"),
        ("f 1 2 3", &format!("f {}", "1 2 3 ".repeat(100))),
        ("usemtl d\n", "usemtl d \\\n\\\n\n"),
    ];
    variants(&text, &changes).iter().for_each(|text| assert_pieces_do_not_show(&Obj, text.as_bytes()));
}

#[test]
fn chunk_size_does_not_change_a_text_ply() {
    let mut text = String::from("ply\nformat ascii 1.0\nelement face 9\nproperty list uchar int vertex_indices\n");
    text += "element junk 2\nproperty list int int j\nelement vertex 12\nproperty float x\nproperty double y\nproperty float z\n";
    text += "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nend_header\n";
    text += "3 0 1 2\n4 0 1 2 3\n\n \n3 3 2 1\n2 0 1\n5 4 5 6 7 8\n3 9 10 11\n0\n4 8 5 4 3\n3 1 2 3\n2 5 6\n0\n";
    (0..12).for_each(|i| writeln!(text, "{i} {}.25 {} 0 0 {} 1 .5\n", i % 3, i % 5, i % 2).unwrap());
    let changes = [
        ("3 3 2 1", "3 3 2 12"),
        ("3 3 2 1", "3 3 2"),
        ("3 9 10 11", "3 9 10 11 12"),
        ("\n7 1.25", "\n7 nan"),
        ("\n11 ", "\n \n\nx "),
        ("2 5 6\n0", "2 5 6\n1"),
        ("3 0 1 2\n", ""),
    ];
    variants(&text, &changes).iter().for_each(|text| assert_pieces_do_not_show(&Ply, text.as_bytes()));
}

#[test]
fn chunk_size_does_not_change_a_binary_ply() {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 20\nproperty float x\nproperty uchar red\nproperty short y\n\
        property float z\nelement face 30\nproperty uchar flags\nproperty list uchar ushort vertex_indices\nend_header\n"
        .to_vec();
    let start = bytes.len();
    for i in 0..20_u8 {
        bytes.extend(f32::from(i).to_be_bytes());
        bytes.extend([7, 0, i % 4]);
        bytes.extend(f32::from(i % 3).to_be_bytes());
    }
    for i in 0..30_u8 {
        let corners = [3, 4, 2, 3, 7, 0][usize::from(i % 6)];
        bytes.extend([i, corners]);
        bytes.extend((0..corners).flat_map(|corner| [0, (i + corner) % 20]));
    }
    for length in (start..=bytes.len()).rev().step_by(7) {
        assert_pieces_do_not_show(&Ply, &bytes[..length]);
    }
    let mut wrong = bytes.clone();
    wrong[start + 7 * 11] = 0x7f;
    wrong[start + 7 * 11 + 1] = 0x80;
    assert_pieces_do_not_show(&Ply, &wrong);
    let end = bytes.len();
    bytes[end - 30] = 99;
    bytes[end - 90] = 99;
    assert_pieces_do_not_show(&Ply, &bytes);
}

#[test]
fn chunk_size_does_not_change_an_stl() {
    let mut text = String::from("solid facet\nfacet\n");
    for i in 0..9 {
        let name = ["  FACET", "facet", "\t facet"][i % 3];
        // The third word of a normal is not parsed, so it may be anything and stand on any line.
        let normal = ["0 0 1", "0 0\nfacet", "0 0 -nan(ind)"][(i / 2) % 3];
        let start = if i == 0 { " " } else { name };
        writeln!(text, "{start} normal {normal}\nouter loop\nvertex {i} 0 0\n vertex 1 {i} 0 vertex").unwrap();
        writeln!(text, " {} 1 1\nendloop\nendfacet", if i == 4 { "inf" } else { "2" }).unwrap();
        if i % 4 == 3 {
            text += "endsolid\nfacet\n\n solid b c\n";
        }
    }
    text = text.replace("endsolid\nfacet", "endsolid facet");
    text += "endsolid\n";
    let changes = [
        ("vertex 2 0 0", "vertex 2 0 zero"),
        ("endsolid", "\nendfacet\nendsolid"),
        ("solid b c\n", "solid b c\nfacet normal\nouter loop"),
        ("vertex 7 0 0\n", "facet 1 2 3"),
    ];
    variants(&text, &changes).iter().for_each(|text| assert_pieces_do_not_show(&Stl, text.as_bytes()));
    let mut bytes = vec![b' '; 80];
    bytes.extend(60_u32.to_le_bytes());
    for i in 0..60_u8 {
        let corners = (0..9).map(|k| f32::from((i + k) % (3 + k)) * if i == 40 { f32::INFINITY } else { -1.0 });
        bytes.extend([0; 12].into_iter().chain(corners.flat_map(f32::to_le_bytes)).chain([i / 50, 0]));
    }
    assert_pieces_do_not_show(&Stl, &bytes);
}
