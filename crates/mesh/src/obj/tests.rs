//! Tests of the OBJ reader, one rule each.

use super::Obj;
use crate::error::{FilePosition, MeshErrorKind};
use crate::format::MeshFormat;
use crate::pieces::{PIECE, pieces};
use crate::{MeshFile, MeshLimits};
use juggler_math::{Vec2, Vec3, vec2, vec3};

fn read(text: &str) -> MeshFile {
    Obj.read(text.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap()
}

/// Reads a malformed text and returns the line and the message of the error.
fn error(text: &str) -> (u64, String) {
    match Obj.read(text.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap_err() {
        MeshErrorKind::Malformed { place: FilePosition::Line(line), message } => (line, message),
        other => panic!("expected a line: {other}"),
    }
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn plain_indices_keep_the_order_of_the_file() {
    let MeshFile { mesh, warnings, .. } = read(&format!("{SQUARE}f 1 2 3\nf 1 3 4\n"));
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.normals.is_empty() && mesh.uvs.is_empty() && warnings.is_empty());
}

#[test]
fn all_forms_of_face_vertices_are_read() {
    let streams = "vt 0 0\nvt 1 0\nvt .5 1 9\nvn 0 0 1\nvn 0 0 2\n";
    let full = read(&format!("{SQUARE}{streams}f 1/1/1 2/2/1 3/3/2\n")).mesh;
    assert_eq!(full.uvs, [Vec2::ZERO, Vec2::X, vec2(0.5, 1.0)]);
    assert_eq!(full.normals, [Vec3::Z, Vec3::Z, 2.0 * Vec3::Z]);
    let without_uv = read(&format!("{SQUARE}{streams}f 1//1 2//1 3//2\n")).mesh;
    assert_eq!(without_uv.normals, full.normals);
    assert!(without_uv.uvs.is_empty());
    let without_normal = read(&format!("{SQUARE}{streams}f 1/1 2/2/ 3/3\n")).mesh;
    assert_eq!(without_normal.uvs, full.uvs);
    assert!(without_normal.normals.is_empty());
}

#[test]
fn negative_indices_count_back_from_the_line_they_stand_on() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf -3/-1 -2/-2 -1/1\nv 5 5 5\nf -1/2 -4/1 -3/1\n";
    let mesh = read(text).mesh;
    assert_eq!(mesh.positions[..3], [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.uvs[..3], [Vec2::ONE, Vec2::ZERO, Vec2::ZERO]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 1]]);
    assert_eq!(mesh.positions[3..], [Vec3::splat(5.0), Vec3::ZERO]);
}

#[test]
fn equal_triples_merge_and_seams_stay() {
    let uvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n";
    let joined = read(&format!("{SQUARE}{uvs}f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")).mesh;
    assert_eq!((joined.positions.len(), joined.triangles[1]), (4, [0, 2, 3]));
    let seam = read(&format!("{SQUARE}{uvs}f 1/1 2/2 3/3\nf 1/5 3/3 4/4\n")).mesh;
    assert_eq!((seam.positions.len(), seam.triangles[1]), (5, [3, 2, 4]));
    assert_eq!(seam.positions[0], seam.positions[3]);
    assert_eq!(seam.uvs[3], vec2(0.5, 0.5));
}

#[test]
fn faces_may_stand_before_their_vertices() {
    let mesh = read(&format!("f 1 2 3\n{SQUARE}f 1 3 4\n")).mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[2], vec3(1.0, 1.0, 0.0));
}

#[test]
fn polygons_are_triangulated() {
    let pentagon = "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv 0 2 0\nf 1 2 3 4 5\n";
    assert_eq!(read(pentagon).mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    let dart = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv .5 1 0\nf 1 2 3 4\n";
    let mut cut = read(dart).mesh.triangles;
    cut.iter_mut().for_each(|corners| corners.sort_unstable());
    assert_eq!(cut, [[0, 1, 3], [1, 2, 3]], "the diagonal must start at the notch");
}

#[test]
fn comments_continuations_and_line_ends_are_read() {
    let text = "# made by hand \\\r\n  v 1e1 -2.5E-1 +.5 # first\r\n\r\nv\t0 0 \\\r\n 0\r\nv 1 0 0\r\nv 7 \\\n\\\n7 7\r\nf 1 \\\r\n2 3";
    let mesh = read(text).mesh;
    assert_eq!(mesh.positions, [vec3(10.0, -0.25, 0.5), Vec3::ZERO, Vec3::X]);
}

#[test]
fn ignored_statements_are_counted() {
    let text = "mtllib a.mtl\no name\ng a b\nusemtl red\ns 1\nv 0 0 0 1 0 0\nv 1 0 0 1\nv 0 1 0\nusemtl blue\nf 1 2 3\nl 1 2\np 1\nf 1 2\n";
    let MeshFile { mesh, warnings, .. } = read(text);
    assert_eq!((mesh.triangles.len(), mesh.attributes.contains_key("color")), (1, true));
    assert_eq!(
        warnings,
        [
            "1 vertices have numbers after x y z that are no colors: ignored",
            "ignored statements: 1 'g', 1 'l', 1 'mtllib', 1 'o', 1 'p', 1 's', 2 'usemtl'",
            "1 faces with fewer than 3 vertices ignored",
        ]
    );
}

#[test]
fn a_warning_about_many_kinds_stays_short() {
    let words: String = (0..10_000).map(|index| format!("word{index}\n")).collect();
    let warnings = read(&format!("{SQUARE}f 1 2 3\n{words}")).warnings;
    assert!(warnings[0].ends_with(", 9984 others") && warnings[0].len() < 500, "{warnings:?}");
}

#[test]
fn missing_normals_and_uvs_become_zero() {
    let text = format!("{SQUARE}vn 0 .6 .8\nvt .3 .4\nf 1/1/1 2/1/1 3/1/1\nf 1 3 4\n");
    let MeshFile { mesh, warnings, .. } = read(&text);
    assert_eq!(mesh.triangles[0], [0, 1, 2]);
    let flat = mesh.triangles[1].map(|corner| mesh.normals[corner as usize]);
    assert_eq!(flat, [Vec3::ZERO; 3]);
    assert_eq!(mesh.triangles[1].map(|corner| mesh.uvs[corner as usize]), [Vec2::ZERO; 3]);
    assert_eq!(mesh.normals[..3], [vec3(0.0, 0.6, 0.8); 3]);
    assert!(warnings.iter().any(|warning| warning == "3 vertices have no normal and are shaded flat"));
    assert!(warnings.iter().any(|warning| warning == "3 vertices have no texture coordinates and get 0 0"));
}

#[test]
fn invalid_normals_are_treated_as_missing() {
    let mesh = read(&format!("{SQUARE}vn nan 0 0\nvn 0 0 0\nf 1//1 2//2 3//1\n")).mesh;
    assert!(mesh.normals.is_empty());
}

#[test]
fn undefined_normals_and_uvs_are_ignored() {
    let MeshFile { mesh, warnings, .. } = read(&format!("{SQUARE}vt 1 1\nf 1/1/1 2/2/1 3/1/1\n"));
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (3, 1));
    assert_eq!((mesh.normals.as_slice(), mesh.uvs.as_slice()), (&[][..], &[Vec2::ONE, Vec2::ZERO, Vec2::ONE][..]));
    assert_eq!(
        warnings,
        [
            "1 vertices refer to an undefined texture coordinate (vt) (the file has 1): ignored",
            "3 vertices refer to an undefined normal (vn) (the file has 0): ignored",
            "1 vertices have no texture coordinates and get 0 0",
        ]
    );
}

#[test]
fn faults_name_the_line_and_what_was_expected() {
    let cases = [
        ("v 1 2\n", 1, "expected a number for z, found the end of the line"),
        ("v 0 0 0\n\n# x\nv 1 two 3\n", 4, "expected a number for y, found 'two'"),
        ("v 0 \\\n 0 nan\n", 2, "expected a finite number for z, found NaN"),
        ("v 1e60 0 0\n", 1, "expected a finite number for x, found inf"),
        ("vt inf\n", 1, "expected a finite number for u, found inf"),
        ("v 0 0 0\nf 1 0 1\n", 2, "vertex (v) index 0 is invalid: indices start at 1"),
        ("f -4 -3 -2", 1, "vertex (v) index -4 is out of range: only 0 precede this line"),
        (
            "v 0 0 0\nvt 0 0\nf 1/1 1/-2 1/1\n",
            3,
            "texture coordinate (vt) index -2 is out of range: only 1 precede this line",
        ),
        ("v 0 0 0\nf 1 1 1\nf 1 3 2\nf 1 1 2\n", 3, "vertex (v) index 3 is out of range: the file has only 1"),
        ("f 1 99999999999 1\n", 1, "vertex (v) index 99999999999 is too large"),
        ("f 1 4294967296 1\n", 1, "vertex (v) index 4294967296 is too large"),
    ];
    for (text, line, message) in cases {
        assert_eq!(error(text), (line, message.to_owned()), "{text}");
    }
    for word in ["1.0", "a", "1/2/3/4", "/1", "1/x", "99999999999999999999"] {
        let (line, message) = error(&format!("\nf 1 {word} 1\n"));
        assert_eq!(line, 2);
        assert!(
            message.starts_with("expected a face vertex v, v/vt, v//vn or v/vt/vn") && message.contains(word),
            "{message}"
        );
    }
}

#[test]
fn limits_are_kept_and_named() {
    let check = |text: &str, limits: MeshLimits, expected: &str| {
        assert_eq!(Obj.read(text.as_bytes(), &limits, pieces(PIECE)).unwrap_err().to_string(), expected);
    };
    let few = MeshLimits { vertices: 3, ..MeshLimits::default() };
    check(&format!("{SQUARE}f 1 2 3\n"), few, "at least 4 vertices, the limit is 3");
    let seams = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 2/1 3/1\n";
    check(seams, few, "at least 4 vertices, the limit is 3");
    let one = MeshLimits { triangles: 1, ..MeshLimits::default() };
    check(&format!("{SQUARE}f 1 2 3 4\n"), one, "at least 2 triangles, the limit is 1");
    assert!(
        Obj.read(SQUARE.as_bytes(), &one, pieces(PIECE)).unwrap_err().to_string().starts_with("contains no triangles")
    );
}

#[test]
fn comments_may_touch_the_last_face_vertex() {
    let MeshFile { mesh, warnings, .. } = read(&format!("{SQUARE}f 1 2 3 # comment\nf 1 3 4#c 7 8\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(warnings, ["comments that follow a face vertex without a blank: 1"]);
    assert_eq!(error(&format!("{SQUARE}f 1 2 #3\nf 1 3 x#c\n")).0, 6);
}

#[test]
fn normals_that_are_no_numbers_in_c_are_missing() {
    let with = |word: &str| read(&format!("{SQUARE}vn 0 0 1\nvn {word} 0 0\nf 1//1 2//1 3//2\n"));
    let expected = with("nan");
    for word in ["-nan(ind)", "nan(snan)", "-1.#IND", "1.#QNAN0"] {
        let MeshFile { mesh, warnings, .. } = with(word);
        assert_eq!(mesh.triangles, expected.mesh.triangles, "{word}");
        assert!(
            warnings.contains(&"numbers of normals that are no numbers and count as missing: 1".to_owned()),
            "{warnings:?}"
        );
        assert_eq!(warnings.len(), expected.warnings.len() + 1, "{warnings:?}");
    }
    let MeshFile { mesh, warnings, .. } = read(&format!("{SQUARE}vt nan 0.5\nvt 1 -nan(ind)\nvt 0 1\nf 1/1 2/2 3/3\n"));
    assert_eq!(mesh.uvs, [vec2(0.0, 0.5), vec2(1.0, 0.0), vec2(0.0, 1.0)]);
    assert_eq!(warnings, ["texture coordinates that are no numbers and become 0: 2"]);
    assert_eq!(error(&format!("{SQUARE}vt inf 0\n")), (5, "expected a finite number for u, found inf".into()));
    assert_eq!(error(&format!("{SQUARE}vn nano 0 0\n")), (5, "expected a number for x, found 'nano'".into()));
}
