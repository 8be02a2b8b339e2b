//! Tests of the STL reader, one rule each.

use super::{Stl, has_several_solids};
use crate::error::{FilePosition, MeshErrorKind};
use crate::format::MeshFormat;
use crate::pieces::{PIECE, pieces};
use crate::{MAX_SOLIDS, MeshFile, MeshLimits};
use juggler_math::{Vec3, vec3};

fn read(bytes: &[u8]) -> MeshFile {
    Stl.read(bytes, &MeshLimits::default(), pieces(PIECE)).unwrap()
}

fn message(bytes: &[u8]) -> String {
    Stl.read(bytes, &MeshLimits::default(), pieces(PIECE)).unwrap_err().to_string()
}

fn facet(corners: [Vec3; 3]) -> String {
    let lines: String = corners.iter().map(|p| format!("vertex {} {} {}\n", p.x, p.y, p.z)).collect();
    format!("facet normal 0 0 0\nouter loop\n{lines}endloop\nendfacet\n")
}

fn binary(header: &str, facets: &[[Vec3; 3]]) -> Vec<u8> {
    let mut bytes = format!("{header:80}").into_bytes();
    bytes.extend((facets.len() as u32).to_le_bytes());
    for corners in facets {
        bytes.extend([0xff; 12]); // a normal of NaNs
        bytes.extend(corners.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

const LOWER: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];
const UPPER: [Vec3; 3] = [Vec3::X, Vec3 { x: 1.0, y: 1.0, z: 0.0 }, Vec3::Y];

#[test]
fn text_and_binary_weld_to_the_same_mesh() {
    let text = format!("solid a name\n{}{}endsolid a name\n", facet(LOWER), facet(UPPER));
    let from_text = read(text.as_bytes());
    assert_eq!(from_text.mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y, vec3(1.0, 1.0, 0.0)]);
    assert_eq!(from_text.mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    assert!(from_text.mesh.normals.is_empty() && from_text.warnings.is_empty());
    for header in ["exported", "solid but binary"] {
        let from_binary = read(&binary(header, &[LOWER, UPPER]));
        assert_eq!((from_binary.mesh, from_binary.warnings), (from_text.mesh.clone(), Vec::new()));
    }
}

#[test]
fn keywords_ignore_case_and_line_breaks_and_solids_are_joined() {
    let text = format!(
        "SOLID one\nFacet Normal -nan(ind) -nan(ind) x OUTER loop vertex 0 0 0 \nvertex 1 0 0 vertex 0 1e0 0\nendloop EndFacet\nEndSolid one two\n\nsolid\n{}endsolid",
        facet(UPPER)
    );
    assert_eq!(read(text.as_bytes()).mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
}

/// First triangles and names of the solids.
fn solids(file: &MeshFile) -> Vec<(usize, Option<&str>)> {
    file.solids.iter().map(|solid| (solid.first, solid.name.as_deref())).collect()
}

#[test]
fn solids_are_sections_with_the_names_of_their_lines() {
    let (lower, upper) = (facet(LOWER), facet(UPPER));
    let broken = facet([Vec3::ZERO, Vec3::NAN, Vec3::Y]);
    let text = format!(
        "\n solid  lid of pot \t\n{lower}{broken}{upper}endsolid solid\n\tSOLID\n{upper}endsolid\rsolid none\nendsolid none\n\
         solid a\0b\n{lower}endsolid\nsolid {}\nendsolid\nsolid {}\n{lower}endsolid",
        "x".repeat(1025),
        "y".repeat(1024)
    );
    // A zero byte near the start marks a binary file, so that the name with one stands behind.
    let text = format!("solid first {}\n{upper}endsolid{text}", " ".repeat(1024));
    let long = "y".repeat(1024);
    let expected = [
        (0, Some("first")),
        (1, Some("lid of pot")),
        (3, None),
        (4, Some("none")),
        (4, None),
        (5, None),
        (5, Some(long.as_str())),
    ];
    let file = read(text.as_bytes());
    assert_eq!(solids(&file), expected);
    assert_eq!(file.mesh.triangles.len(), 6);
    assert!(has_several_solids(text.as_bytes()));
}

#[test]
fn a_binary_file_is_one_solid_that_its_header_may_name() {
    let named = |header: &str| {
        let file = read(&binary(header, &[LOWER, UPPER]));
        assert!(!has_several_solids(&binary(header, &[LOWER])));
        let [solid] = file.solids.as_slice() else { panic!("{:?}", file.solids) };
        assert_eq!(solid.first, 0);
        solid.name.clone()
    };
    assert_eq!(named(" solid a part\r\nsolid of\nsolid three\n").as_deref(), Some("a part"));
    // A name that no line end closes may have been cut.
    for header in ["exported", "solid but binary", "solid", "solid\n", "solidworks a\n"] {
        assert_eq!(named(header), None, "{header}");
    }
}

#[test]
fn solids_beyond_the_limit_are_not_kept() {
    let count = |solids: usize, piece: usize| {
        let text = format!("{}solid\n{}endsolid", "solid a\nendsolid\n".repeat(solids - 1), facet(LOWER));
        Stl.read(text.as_bytes(), &MeshLimits::default(), pieces(piece)).unwrap().solids.len()
    };
    assert_eq!(count(MAX_SOLIDS, PIECE), MAX_SOLIDS);
    assert_eq!([PIECE, 1000].map(|piece| count(MAX_SOLIDS + 9, piece)), [MAX_SOLIDS + 1; 2]);
}

#[test]
fn several_solids_are_found_without_reading_facets() {
    let cases = [
        ("", false),
        ("solid", false),
        ("solid\nsolid", true),
        ("\u{feff}solid a\nendsolid\n\tSolid b", true),
        ("solid a\rfacet\r solid\r", true),
        ("solid solid\nendsolid solid\nsolids\n", false),
        ("# x\nsolid\n", false),
    ];
    for (text, expected) in cases {
        assert_eq!(has_several_solids(text.as_bytes()), expected, "{text:?}");
    }
}

#[test]
fn zero_and_negative_zero_are_welded() {
    let mirrored = [vec3(-0.0, 0.0, -0.0), Vec3::Y, Vec3::X];
    let mesh = read(&binary("", &[LOWER, mirrored])).mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 1]]);
    assert_eq!(mesh.positions[0].to_array().map(f32::to_bits), [0; 3]);
}

#[test]
fn facets_that_are_not_numbers_are_left_out_and_counted() {
    let broken = [Vec3::ZERO, Vec3::NAN, Vec3::Y];
    let MeshFile { mesh, warnings, .. } = read(&binary("", &[broken, LOWER, [Vec3::INFINITY; 3]]));
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(warnings, ["2 facets with infinite or NaN coordinates ignored"]);
    let text = format!("solid\n{}{}endsolid\n", facet(broken), facet(LOWER));
    assert_eq!(read(text.as_bytes()).mesh, mesh);
    let nothing = message(&binary("", &[broken]));
    assert_eq!(nothing, "contains no triangles (1 facets with infinite or NaN coordinates ignored)");
}

#[test]
fn colors_and_trailing_bytes_are_counted() {
    let mut bytes = binary("COLOR=", &[LOWER, UPPER]);
    bytes[84 + 48] = 7;
    bytes.extend(b"more");
    let warnings = read(&bytes).warnings;
    assert_eq!(warnings, ["attributes (colors) of 1 facets ignored", "4 bytes after the last facet ignored"]);
}

#[test]
fn short_binary_files_are_refused_before_anything_is_reserved() {
    let mut bytes = binary("solid", &[LOWER, UPPER]);
    bytes.pop();
    let expected = "byte 80: the header declares 2 facets of 50 bytes, but the 99 bytes that follow contain only 1";
    assert_eq!(message(&bytes), expected);
    bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(message(&bytes).starts_with("byte 80: the header declares 4294967295 facets of 50 bytes"));
    assert_eq!(message(&bytes[..30]), "line 1: expected 'facet' or 'endsolid', found the end of the file");
    bytes[20] = 0;
    assert!(message(&bytes[..70]).starts_with("byte 70: expected an STL file"));
}

#[test]
fn faults_of_texts_name_the_line_and_what_was_expected() {
    let good = format!("solid\n{}endsolid\n", facet(LOWER));
    let cases = [
        ("solid\n", "sold\n", 1, "expected 'solid', found 'sold'"),
        ("normal", "norm", 2, "expected 'normal', found 'norm'"),
        ("outer loop", "outer", 4, "expected 'loop', found 'vertex'"),
        ("vertex 1 0 0", "vertex 1 0", 5, "expected a number for z, found the end of the line"),
        ("vertex 1 0 0", "vertex 1 a 0", 5, "expected a number for y, found 'a'"),
        ("vertex 0 1 0\n", "", 6, "expected 'vertex', found 'endloop'"),
        ("endloop", "vertex 9 9 9", 7, "expected 'endloop', found 'vertex'"),
        ("endsolid", "endsold", 9, "expected 'facet' or 'endsolid', found 'endsold'"),
        ("endsolid\n", "", 9, "expected 'facet' or 'endsolid', found the end of the file"),
    ];
    for (old, new, line, message) in cases {
        let text = good.replacen(old, new, 1);
        match Stl.read(text.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap_err() {
            MeshErrorKind::Malformed { place, message: found } => {
                assert_eq!((place, found.as_str()), (FilePosition::Line(line), message), "{old} -> {new}");
            }
            other => panic!("{other}"),
        }
    }
    assert_eq!(message(b""), "contains no triangles");
}

#[test]
fn limits_are_kept_and_named() {
    let bytes = binary("", &[LOWER, UPPER]);
    let check = |limits: MeshLimits, expected: &str| {
        assert_eq!(Stl.read(&bytes, &limits, pieces(PIECE)).unwrap_err().to_string(), expected);
    };
    check(MeshLimits { triangles: 1, ..MeshLimits::default() }, "at least 2 triangles, the limit is 1");
    check(MeshLimits { vertices: 3, ..MeshLimits::default() }, "at least 4 vertices, the limit is 3");
}

#[test]
fn facets_without_a_normal_are_read() {
    let text = format!("solid\n{}{}endsolid\n", facet(LOWER).replace(" normal 0 0 0", ""), facet(UPPER));
    let MeshFile { mesh, warnings, .. } = read(text.as_bytes());
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(warnings, ["facets without 'normal', which STL requires: 1"]);
}
