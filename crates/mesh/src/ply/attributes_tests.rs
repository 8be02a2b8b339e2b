//! Tests of attribute columns: names, types, domains, and faults.

use super::*;
use crate::pieces::{PIECE, pieces};
use crate::ply::Ply;
use crate::{MeshFile, MeshLimits, format::MeshFormat, ply_bytes};
use juggler_math::Vec3;
use juggler_shape::MeshData;

fn read(text: &str) -> MeshFile {
    let whole = Ply.read(text.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap();
    assert_eq!(Ply.read(text.as_bytes(), &MeshLimits::default(), pieces(1)).unwrap(), whole, "in small pieces");
    whole
}

/// A square polygon and a triangle, with these columns and values of vertices and faces.
fn file(vertex: [&str; 2], face: [&str; 2]) -> String {
    let columns =
        |names: &str| names.split_terminator(", ").map(|name| format!("property {name}\n")).collect::<String>();
    let [a, b, c, d] = [0, 1, 2, 3].map(|row| vertex[1].split('|').nth(row).unwrap_or_default());
    let [e, f] = [0, 1].map(|row| face[1].split('|').nth(row).unwrap_or_default());
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n{}property float y\nproperty float z\n\
         element face 2\n{}property list uchar int vertex_indices\nend_header\n\
         0 {a} 0 0\n1 {b} 0 0\n1 {c} 1 0\n0 {d} 1 0\n{e} 4 0 1 2 3\n{f} 3 0 1 2\n",
        columns(vertex[0]),
        columns(face[0])
    )
}

fn attribute(domain: AttributeDomain, channels: u32, data: AttributeData) -> MeshAttribute {
    MeshAttribute { domain, channels, data }
}

#[test]
fn columns_become_attributes_of_their_type() {
    let vertex = ["uchar attribute.part, float attribute.heat.1, float attribute.heat.0", "7 1 2|8 3 4|9 5 6|255 7 8"];
    let face = ["ushort attribute.id.0, int attribute.big, char color", "65535 -7 0|2 300 0"];
    let MeshFile { mesh, warnings, .. } = read(&file(vertex, face));
    assert_eq!(warnings, ["ignored properties of 'face': 'color'"]);
    let heat = AttributeData::F32(vec![2.0, 1.0, 4.0, 3.0, 6.0, 5.0, 8.0, 7.0]);
    // The square becomes two triangles.
    let expected = [
        ("big", attribute(AttributeDomain::Face, 1, AttributeData::F32(vec![-7.0, -7.0, 300.0]))),
        ("heat", attribute(AttributeDomain::Vertex, 2, heat)),
        ("id", attribute(AttributeDomain::Face, 1, AttributeData::U16(vec![65535, 65535, 2]))),
        ("part", attribute(AttributeDomain::Vertex, 1, AttributeData::U8(vec![7, 8, 9, 255]))),
    ];
    assert_eq!(mesh.attributes, expected.map(|(name, attribute)| (name.to_owned(), attribute)).into());
}

#[test]
fn faulty_attributes_are_left_out_and_named() {
    let rule = "channels of an attribute are numbered from 0 to at most 3 and have one type";
    for columns in [
        "float attribute.a.1",
        "float attribute.a.0, float attribute.a.2",
        "float attribute.a.0, uchar attribute.a.1",
        "float attribute.a, float attribute.a.0",
        "float attribute.%61, float attribute.a",
        "float attribute.a.0, float attribute.a.00",
        "float attribute.a.99999999999999999999999",
        "list uchar float attribute.a",
        "float attribute.a.0, float attribute.a.1, float attribute.a.2, float attribute.a.3, float attribute.a.4",
    ] {
        let count = columns.split(", ").count();
        let row = ["1"].repeat(if columns.starts_with("list") { 2 } else { count }).join(" ");
        let MeshFile { mesh, warnings, .. } = read(&file([columns, &format!("{row}|{row}|{row}|{row}")], ["", ""]));
        assert!(mesh.attributes.is_empty(), "{columns}: {:?}", mesh.attributes);
        assert!(warnings[0].starts_with("ignored properties of 'vertex': 'attribute."), "{warnings:?}");
        assert_eq!(warnings[1..], [format!("ignored attributes of 'vertex': 'a'; {rule}")], "{columns}");
    }
    let MeshFile { mesh, warnings, .. } =
        read(&file(["uchar attribute.a", "1|2|3|4"], ["float attribute.a, float attribute.face_color", "5 1|6 1"]));
    assert_eq!(mesh.attributes["a"].data, AttributeData::U8(vec![1, 2, 3, 4]));
    assert_eq!(warnings, ["ignored a second attribute 'a'"]);
}

#[test]
fn numbers_out_of_range_are_errors() {
    let message = |column: &str, value: &str| {
        let text = file([&format!("{column} attribute.a"), &format!("1|{value}|1|1")], ["", ""]);
        Ply.read(text.as_bytes(), &MeshLimits::default(), pieces(PIECE)).unwrap_err().to_string()
    };
    let expected = "line 12: expected an integer from 0 to 255 for 'attribute.a', found 256";
    assert_eq!(message("uchar", "256"), expected);
    for (column, value) in [("uchar", "-1"), ("uchar", "0.5"), ("ushort", "65536"), ("ushort", "nan")] {
        assert!(message(column, value).contains("expected an integer from 0 to "), "{column} {value}");
    }
    for (column, value) in [("float", "inf"), ("float", "nan"), ("double", "1e300")] {
        assert!(message(column, value).contains("expected a finite number for attribute.a"), "{column} {value}");
    }
}

#[test]
fn attributes_of_corners_and_strips_fit_the_mesh() {
    // Coordinates of corners split the first and the third vertex.
    let text = file(["ushort attribute.n", "10|11|12|13"], ["list uchar float texcoord, uchar attribute.f", "@ 5|@ 6"]);
    let text = text.replacen('@', "8 0 0 1 0 1 1 0 1", 1).replacen('@', "6 .5 .5 1 0 .5 1", 1);
    let MeshFile { mesh, warnings, .. } = read(&text);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(mesh.attributes["n"].data, AttributeData::U16(vec![10, 11, 12, 13, 10, 12]));
    assert_eq!(mesh.attributes["f"].data, AttributeData::U8(vec![5, 5, 6]));
    let strips = file(["float attribute.a", "1|2|3|4"], ["float attribute.b", "1|2"])
        .replace("end_header", "element tristrips 1\nproperty list int int vertex_indices\nend_header");
    let MeshFile { mesh, warnings, .. } = read(&format!("{strips}3 1 2 3\n"));
    assert_eq!((mesh.triangles.len(), mesh.attributes.len()), (4, 1));
    assert_eq!(warnings, ["attributes of faces are ignored: triangle strips have none"]);
}

#[test]
fn names_survive_their_escapes() {
    let names = [
        "",
        " ",
        "a b",
        "a%20b",
        "%",
        "%4",
        "100%",
        "a.b",
        "a.0",
        "a.0.1",
        "a.",
        ".",
        ".0",
        "a..3",
        "1",
        "\u{7f}\n\t\r\0",
        "é ß",
        "\u{a0}\u{85}",
        "color",
        "attribute.x",
    ];
    for (channels, name) in [1_u32, 2, 4].into_iter().flat_map(|channels| names.map(|name| (channels, name))) {
        let columns = column_names(name, channels as usize);
        assert!(columns.iter().all(|column| !column.contains(|c: char| c.is_whitespace() || c.is_control())));
        for (channel, column) in columns.iter().enumerate() {
            let expected = (channels > 1).then_some(channel);
            assert_eq!(parse(column), Some((name.to_owned(), expected)), "{name:?}");
        }
        let data = AttributeData::U8((0..3 * channels as u8).collect());
        let mesh = MeshData {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            attributes: [(name.to_owned(), attribute(AttributeDomain::Vertex, channels, data))].into(),
            ..MeshData::default()
        };
        let found = Ply.read(&ply_bytes(&mesh), &MeshLimits::default(), pieces(PIECE)).unwrap();
        assert_eq!((found.mesh, found.warnings), (mesh, Vec::new()), "{name:?}");
    }
}

#[test]
fn escapes_that_are_none_stand_for_themselves() {
    assert_eq!(decoded("%zz%4"), "%zz%4");
    assert_eq!(decoded("%ff"), "\u{fffd}");
}
