//! Tests of the PLY reader, one rule each.

use super::Ply;
use crate::error::{FilePosition, MeshErrorKind};
use crate::format::MeshFormat;
use crate::pieces::{PIECE, pieces};
use crate::{MeshFile, MeshLimits};
use juggler_math::{Vec2, Vec3, vec2, vec3};

fn read(bytes: impl AsRef<[u8]>) -> MeshFile {
    Ply.read(bytes.as_ref(), &MeshLimits::default(), pieces(PIECE)).unwrap()
}

fn error(bytes: impl AsRef<[u8]>) -> (FilePosition, String) {
    match Ply.read(bytes.as_ref(), &MeshLimits::default(), pieces(PIECE)).unwrap_err() {
        MeshErrorKind::Malformed { place, message } => (place, message),
        other => panic!("expected a place: {other}"),
    }
}

const SQUARE: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 1\nproperty list uchar int vertex_indices\nend_header\n\
                      0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

/// A binary PLY of one square polygon; `number(type, value)` encodes its values.
fn binary(format: &str, scalar: &str, length: &str, index: &str, number: impl Fn(&str, u8) -> Vec<u8>) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\ncomment x\nobj_info y\nelement face 1\nproperty list {length} {index} vertex_index\n\
         element vertex 4\nproperty {scalar} x\nproperty {scalar} y\nproperty {scalar} z\nend_header\n"
    )
    .into_bytes();
    bytes.extend(number(length, 4));
    bytes.extend([0, 1, 2, 3].into_iter().flat_map(|value| number(index, value)));
    bytes.extend([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0].into_iter().flat_map(|value| number(scalar, value)));
    bytes
}

fn little(kind: &str, value: u8) -> Vec<u8> {
    match kind {
        "char" | "uchar" | "int8" | "uint8" => vec![value],
        "short" | "ushort" | "int16" | "uint16" => u16::from(value).to_le_bytes().to_vec(),
        "int" | "uint" | "int32" | "uint32" => u32::from(value).to_le_bytes().to_vec(),
        "float" | "float32" => f32::from(value).to_le_bytes().to_vec(),
        _ => f64::from(value).to_le_bytes().to_vec(),
    }
}

fn big(kind: &str, value: u8) -> Vec<u8> {
    little(kind, value).into_iter().rev().collect()
}

#[test]
fn text_ply_with_a_polygon_is_triangulated() {
    let MeshFile { mesh, warnings, .. } = read(SQUARE);
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.normals.is_empty() && mesh.uvs.is_empty() && warnings.is_empty());
}

#[test]
fn all_scalar_types_are_read_in_both_byte_orders() {
    let expected = read(SQUARE);
    let types = "char uchar short ushort int uint float double int8 uint8 int16 uint16 int32 uint32 float32 float64";
    for scalar in types.split(' ') {
        for length in types.split(' ') {
            let index = scalar;
            let file = binary("binary_little_endian", scalar, length, index, little);
            assert_eq!(read(&file), expected, "{scalar} {length}");
            let file = binary("binary_big_endian", scalar, length, index, big);
            assert_eq!(read(&file), expected, "{scalar} {length}");
            let text = binary("ascii", scalar, length, index, |_, value| format!("{value} ").into_bytes());
            let text = String::from_utf8(text).unwrap().replace("4 0 1 2 3 0", "4 0 1 2 3\n0");
            let text = text.replace("0 0 0 1 0 0 1 1 0 0 1 0", "0 0 0\n1 0 0\n1 1 0\n0 1 0");
            assert_eq!(read(&text), expected, "{text}");
        }
    }
}

#[test]
fn unusual_white_space_and_line_ends_are_accepted() {
    let expected = read(SQUARE);
    assert_eq!(read(SQUARE.replace('\n', "\r\n")), expected);
    assert_eq!(read(SQUARE.replace('\n', "\r")), expected);
    assert_eq!(read(SQUARE.replace("element ", "\t element \t ").replace("\n", " \n")), expected);
    assert_eq!(read(SQUARE.replace("\n1 0 0", "\n\n \n 1\t0  0")), expected);
    assert_eq!(read(SQUARE.trim_end()), expected);
    assert_eq!(read(SQUARE.replace("element", "comment \\\ncomment\nobj_info element\n\nelement")), expected);
    let mut file = binary("binary_little_endian", "float", "uchar", "int", little);
    let end = file.windows(11).position(|bytes| bytes == b"end_header\n").unwrap() + 10;
    file.insert(end, b'\r');
    assert_eq!(read(file), expected);
}

#[test]
fn normals_and_uvs_are_read_under_all_property_names() {
    for names in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]] {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar red\nproperty float ny\nproperty double {}\n\
             property float x\nproperty float nx\nproperty list uchar float junk\nproperty float nz\nproperty float y\n\
             property float z\nproperty float {}\nelement face 1\nproperty uchar flags\n\
             property list uint ushort vertex_indices\nend_header\n\
             9 .6 0.1 0 0 0 .8 0 0 0.2\n9 .6 0.3 1 0 2 7 7 .8 0 0 0.4\n9 .6 0.5 0 0 1 7 .8 1 0 0.6\n8 3 0 1 2\n",
            names[1], names[0]
        );
        let MeshFile { mesh, warnings, .. } = read(text);
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
        assert_eq!(mesh.normals, [vec3(0.0, 0.6, 0.8); 3]);
        assert_eq!(mesh.uvs, [vec2(0.2, 0.1), vec2(0.4, 0.3), vec2(0.6, 0.5)]);
        assert_eq!(
            warnings,
            ["ignored properties of 'vertex': 'red', 'junk'", "ignored properties of 'face': 'flags'"]
        );
    }
}

#[test]
fn half_a_set_of_columns_is_ignored() {
    let text = SQUARE.replace("property float z\n", "property float z\nproperty float nx\nproperty float u\n");
    let text = text.replace("0\n1", "0 5 6\n1").replace("0\n0", "0 5 6\n0").replace("0\n4", "0 5 6\n4");
    let MeshFile { mesh, warnings, .. } = read(text);
    assert!(mesh.normals.is_empty() && mesh.uvs == Vec::<Vec2>::new());
    assert_eq!(warnings, ["ignored properties of 'vertex': 'nx', 'u'"]);
}

#[test]
fn unknown_elements_are_passed_over() {
    let text = SQUARE
        .replace(
            "element vertex",
            "element empty 4000000000\nelement edge 2\nproperty list int short a\nproperty int b\nelement vertex",
        )
        .replace("end_header\n", "end_header\n2 1 1 5\n0 6\n");
    let MeshFile { mesh, warnings, .. } = read(text);
    assert_eq!(mesh.triangles.len(), 2);
    assert_eq!(warnings, ["ignored: 4000000000 elements 'empty'", "ignored: 2 elements 'edge'"]);
}

#[test]
fn lines_of_the_header_that_are_no_comments_are_passed_over() {
    let stray = SQUARE.replacen("element vertex", "Created by Blender3D\nelement vertex", 1);
    let MeshFile { mesh, warnings, .. } = read(&stray);
    assert_eq!(mesh, read(SQUARE).mesh);
    assert_eq!(warnings, ["ignored an unknown line of the header: line 3: 'Created by Blender3D'"]);
    let several = stray.replacen("element face", "made for tests\nelement face", 1);
    let words = "ignored 2 unknown lines of the header, the first line 3: 'Created by Blender3D'";
    assert_eq!(read(several).warnings, [words]);
    let mut file = binary("binary_big_endian", "float", "uchar", "int", big);
    file.splice(4..4, *b"by hand\n");
    assert_eq!(read(file).warnings, ["ignored an unknown line of the header: line 2: 'by hand'"]);
    let (place, message) = error(SQUARE.replacen("element vertex", "elment vertex", 1));
    let expected = "expected 'element', 'property', 'comment' or 'end_header', found 'elment'";
    assert_eq!((place, message.as_str()), (FilePosition::Line(3), expected));
}

#[test]
fn a_double_is_rounded_once_in_all_forms() {
    // The value lies just above the midpoint of two floats. Rounded to double first, it rounds to
    // float as in the binary form.
    let text = SQUARE.replace("float", "double").replace("1 1 0", "1.00000017881393432617187 1 0");
    let value = 1.000_000_178_813_934_3_f64;
    assert_eq!(read(text).mesh.positions[2].x, value as f32);
}

#[test]
fn counts_that_the_file_cannot_hold_are_refused_at_once() {
    for count in ["4000000000", "9223372036854775807"] {
        let (place, message) = error(SQUARE.replace("vertex 4", &format!("vertex {count}")));
        assert_eq!(place, FilePosition::Line(3));
        assert!(message.starts_with(&format!("the header declares {count} elements 'vertex' of at least ")));
        assert!(message.ends_with(" bytes, but only 34 remain"), "{message}");
        let mut file = binary("binary_little_endian", "float", "uchar", "int", little);
        let at = file.windows(8).position(|bytes| bytes == b"vertex 4").unwrap();
        file.splice(at + 7..at + 8, count.bytes());
        assert_eq!(error(file).0, FilePosition::Line(7));
    }
    let mut file = binary("binary_little_endian", "float", "uint", "int", little);
    let body = file.windows(11).position(|bytes| bytes == b"end_header\n").unwrap() + 11;
    file[body..body + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    let (place, message) = error(&file);
    assert!(message.contains("vertex index") || message.contains("end of the file"), "{message}");
    assert!(matches!(place, FilePosition::Byte(byte) if byte > body as u64));
}

#[test]
fn faults_name_the_place_and_what_was_expected() {
    let cases = [
        ("ply\n", "pli\n", 1, "expected 'ply', found 'pli'"),
        ("ascii", "binary", 2, "expected 'ascii', 'binary_little_endian' or 'binary_big_endian', found 'binary'"),
        ("1.0", "2.0", 2, "expected version '1.0', found '2.0'"),
        ("format ascii 1.0", "", 9, "expected a line 'format ...' before 'end_header'"),
        ("vertex 4", "vertex -4", 3, "expected the number of elements, found '-4'"),
        ("vertex 4", "vertex", 3, "expected the number of elements, found the end of the line"),
        ("float y", "half y", 5, "expected a type (char, uchar, ..., float, double), found 'half'"),
        ("float y", "float", 5, "expected the property's name, found the end of the line"),
        ("float y", "float x", 5, "property 'x' is declared twice"),
        ("face 1", "vertex 1", 7, "element 'vertex' is declared twice"),
        ("float z", "float w", 3, "expected scalar properties x, y and z of the element 'vertex'"),
        ("float z", "list uchar float z", 3, "expected scalar properties x, y and z of the element 'vertex'"),
        ("vertex_indices", "corners", 7, "expected a property 'vertex_indices' of the element 'face'"),
        ("list uchar int", "int", 7, "expected the property 'vertex_indices' to be a list"),
        ("element vertex 4", "", 4, "expected 'element' before the first 'property'"),
        ("end_header", "end", 9, "expected 'element', 'property', 'comment' or 'end_header', found 'end'"),
        ("\n1 0 0", "\n1 0", 11, "expected a number for z, found the end of the line"),
        ("\n1 0 0", "\n1 0 0 0", 11, "expected the end of the line, as the header declares, found '0'"),
        ("\n1 0 0", "\n1 x 0", 11, "expected a number for y, found 'x'"),
        ("\n1 0 0", "\n1 -inf 0", 11, "expected a finite number for y, found -inf"),
        ("4 0 1 2 3", "4 0 1 2 4", 14, "vertex index 4 is out of range: there are 4 vertices, starting at 0"),
        ("4 0 1 2 3", "4 0 1 2 -1", 14, "vertex index -1 is out of range: there are 4 vertices, starting at 0"),
        ("4 0 1 2 3", "5 0 1 2 3", 14, "expected a vertex index, found the end of the line"),
        ("4 0 1 2 3", "-4 0 1 2 3", 14, "expected the length of a list, found -4"),
        ("4 0 1 2 3\n", "", 14, "expected one more element, found the end of the file"),
    ];
    for (old, new, line, message) in cases {
        let (place, found) = error(SQUARE.replacen(old, new, 1));
        if old.ends_with("3\n") {
            assert!(found.contains("the header declares 1 elements 'face'"), "{found}");
            continue;
        }
        assert_eq!((place, found.as_str()), (FilePosition::Line(line), message), "{old} -> {new}");
    }
}

#[test]
fn faults_of_binary_files_name_the_byte() {
    let file = binary("binary_little_endian", "float", "uchar", "int", little);
    let body = (file.len() - 1 - 4 * 4 - 12 * 4) as u64;
    let mut wrong = file.clone();
    wrong[body as usize + 9] = 4;
    let index = "vertex index 4 is out of range: there are 4 vertices, starting at 0".to_owned();
    assert_eq!(error(wrong), (FilePosition::Byte(body + 9), index));
    let mut infinite = file.clone();
    infinite[body as usize + 17 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let number = "expected a finite number for x, found inf".to_owned();
    assert_eq!(error(infinite), (FilePosition::Byte(body + 17 + 12), number));
    let fractional = binary("binary_big_endian", "float", "uchar", "double", |kind, value| {
        if kind == "double" && value == 2 { 2.5_f64.to_be_bytes().to_vec() } else { big(kind, value) }
    });
    assert_eq!(error(fractional).1, "expected a vertex index, found 2.5");
    let cut = file.split_last().unwrap().1;
    let end = (
        FilePosition::Byte(cut.len() as u64 - 3),
        "expected 4 more bytes, found the end of the file after 3".to_owned(),
    );
    assert_eq!(error(cut), end);
}

#[test]
fn header_length_is_limited() {
    let elements: String = (0..2000).map(|index| format!("element e{index} 0\n")).collect();
    let (place, message) = error(SQUARE.replace("element vertex", &format!("{elements}element vertex")));
    assert_eq!((place, message.as_str()), (FilePosition::Line(1003), "more than 1000 elements"));
    let properties: String = (0..2000).map(|index| format!("property int p{index}\n")).collect();
    let (place, message) = error(SQUARE.replace("property float x", &format!("{properties}property float x")));
    assert_eq!((place, message.as_str()), (FilePosition::Line(1004), "more than 1000 properties of one element"));
}

#[test]
fn limits_are_kept_and_named() {
    let check = |limits: MeshLimits, expected: &str| {
        assert_eq!(Ply.read(SQUARE.as_bytes(), &limits, pieces(PIECE)).unwrap_err().to_string(), expected);
    };
    check(MeshLimits { vertices: 3, ..MeshLimits::default() }, "at least 4 vertices, the limit is 3");
    check(MeshLimits { triangles: 1, ..MeshLimits::default() }, "at least 2 triangles, the limit is 1");
    let no_faces = SQUARE.replace("face 1", "face 0").replace("4 0 1 2 3\n", "");
    let error = Ply.read(no_faces.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap_err();
    assert_eq!(error.to_string(), "contains no triangles");
}

/// Colors of vertices and faces; a polygon gives its color to each of its triangles.
#[test]
fn a_comment_names_the_picture_of_the_surface() {
    let with = |line: &str| {
        super::texture_file(SQUARE.replace("element vertex", &format!("{line}\nelement vertex")).as_bytes())
    };
    let found = |name: &str| Some(name.to_owned());
    assert_eq!(with("comment TextureFile skin 1.png"), found("skin 1.png"));
    assert_eq!(with("comment texturefile C:\\art\\skin.png\r\ncomment TextureFile b.png"), found("skin.png"));
    assert_eq!(super::texture_file(b"ply\rcomment TextureFile a.png\rend_header\r"), found("a.png"));
    for line in
        ["comment TextureFile", "comment TextureFile ", "comment TextureFileX a.png", "TextureFile a.png", "comment"]
    {
        assert_eq!(with(line), None, "{line}");
    }
    let behind = format!("{SQUARE}comment TextureFile a.png\n");
    assert_eq!(super::texture_file(behind.as_bytes()), None);
    assert_eq!(super::texture_file(b"solid a\ncomment TextureFile a.png\n"), None);
}

#[test]
fn colors_become_attributes() {
    use juggler_shape::attribute::{AttributeData, AttributeDomain};
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n\
                element face 1\nproperty list uchar int vertex_indices\nproperty float red\nproperty float green\n\
                property float blue\nend_header\n\
                0 0 0 255 0 188 51\n1 0 0 0 0 0 0\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n4 0 1 2 3 0.25 0.5 2\n";
    let MeshFile { mesh, warnings, .. } = read(text);
    assert!(warnings.is_empty(), "{warnings:?}");
    let (vertex, face) = (&mesh.attributes["color"], &mesh.attributes["face_color"]);
    assert_eq!((vertex.domain, vertex.channels), (AttributeDomain::Vertex, 4));
    assert_eq!((face.domain, face.channels), (AttributeDomain::Face, 3));
    assert_eq!(face.data, AttributeData::F32(vec![0.25, 0.5, 2.0, 0.25, 0.5, 2.0]));
    let AttributeData::F32(colors) = &vertex.data else { panic!("{vertex:?}") };
    assert_eq!((colors.len(), colors[0], colors[1], colors[3]), (16, 1.0, 0.0, 0.2));
    assert!((colors[2] - 0.502_886).abs() < 1e-5, "sRGB 188 is half: {}", colors[2]);
    let only_faces = read(text.replace("uchar red", "char red"));
    assert!(only_faces.mesh.attributes["color"].domain == AttributeDomain::Face, "signed colors are ignored");
}

#[test]
fn several_elements_may_stand_on_a_line() {
    let whole = read(SQUARE);
    let (header, rows) = SQUARE.split_at(SQUARE.find("0 0 0\n").unwrap());
    for rows in [rows.replace('\n', " "), rows.replace(' ', "\n"), rows.replacen('\n', " ", 2)] {
        let MeshFile { mesh, warnings, .. } = read(format!("{header}{rows}"));
        assert_eq!(mesh, whole.mesh, "{rows:?}");
        assert_eq!(warnings, ["lines do not hold one element each: read as a sequence of numbers"]);
    }
    let further = error(format!("{header}{} 7", rows.replace('\n', " ")));
    assert!(further.1.starts_with("expected the end of the line"), "{further:?}");
}

/// A strip of two triangles, a restart, and a strip joined to another by repeated indices.
#[test]
fn triangle_strips_alternate_their_winding_and_restart() {
    let head = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n";
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
    let file = |indices: &str, faces: &str, face: &str| {
        let count = indices.split(' ').count();
        format!("{head}{strips}{faces}end_header\n{points}{count} {indices}\n{face}")
    };
    let triangles = |indices: &str| read(file(indices, "", "")).mesh.triangles;
    assert_eq!(triangles("0 1 2 3"), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(triangles("0 1 2 3 -1 2 3 4 5"), [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]);
    assert_eq!(triangles("0 1 2 2 4 3 5"), [[0, 1, 2], [4, 2, 3], [4, 3, 5]]);
    // All triangles of a plane face the same side.
    let MeshFile { mesh, warnings, .. } = read(file("0 1 2 3 4 5", "", ""));
    let point = |corner: u32| mesh.positions[corner as usize];
    assert!(mesh.triangles.iter().all(|[a, b, c]| (point(*b) - point(*a)).cross(point(*c) - point(*a)).z == 1.0));
    assert!(mesh.triangles.len() == 4 && warnings.is_empty(), "{warnings:?}");
    // Faces and strips are joined; strips have no colors.
    let face = "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    let MeshFile { mesh, warnings, .. } = read(file("0 1 2", face, "3 3 4 5 255 0 0\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(warnings, ["colors of faces are ignored: triangle strips have none"]);
    let (_, message) = error(file("0 1 6", "", ""));
    assert!(message.contains("vertex index 6 is out of range: there are 6 vertices"), "{message}");
    assert!(error(file("0 1 -2", "", "")).1.contains("vertex index -2 is out of range"));
}

/// MeshLab's coordinates of wedges: corners of a vertex with other coordinates become vertices.
#[test]
fn coordinates_of_corners_split_vertices() {
    let text = SQUARE
        .replace("element face 1", "element face 2")
        .replace("vertex_indices\n", "vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n")
        .replace("property float z\n", "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n")
        .replace("0 0 0\n1 0 0\n1 1 0\n0 1 0\n", "0 0 0 0 0 1\n1 0 0 0 1 0\n1 1 0 1 0 0\n0 1 0 0 0 1\n")
        .replace("4 0 1 2 3\n", "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 .5 .5 0 1 0\n");
    let MeshFile { mesh, warnings, .. } = read(&text);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 3, 4]]);
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), vec3(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(mesh.uvs, [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.5, 0.5), vec2(0.0, 1.0)]);
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::Y, Vec3::X, Vec3::X, Vec3::Z]);
    assert_eq!(warnings, ["ignored properties of 'face': 'texnumber'"]);
    // A face without coordinates.
    let MeshFile { mesh, warnings, .. } = read(text.replace("6 0 0 .5 .5 0 1 0", "0 0"));
    assert_eq!((mesh.triangles.len(), mesh.uvs.len()), (2, 5));
    assert!(warnings.contains(&"faces without texture coordinates, which get 0 0: 1".to_owned()), "{warnings:?}");
    // Small pieces give the same mesh.
    let whole = Ply.read(text.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap();
    assert_eq!(Ply.read(text.as_bytes(), &MeshLimits::default(), pieces(1)).unwrap(), whole);
}
