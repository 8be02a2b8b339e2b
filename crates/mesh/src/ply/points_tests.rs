//! Tests of points: what is written is read again, files of other programs, faulty files.

use super::*;
use crate::points_bytes;

fn parsed(bytes: &[u8]) -> PointFile {
    parse_points(bytes, &MeshLimits::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn text(columns: &str, rows: &str) -> PointFile {
    parsed(file(columns, rows).as_bytes())
}

/// A file of these columns `TYPE NAME`, separated by commas.
fn file(columns: &str, rows: &str) -> String {
    let columns: String = columns.split(", ").map(|column| format!("property {column}\n")).collect();
    let count = rows.lines().count();
    format!("ply\nformat ascii 1.0\nelement vertex {count}\n{columns}end_header\n{rows}")
}

fn failed(bytes: &[u8]) -> String {
    parse_points(bytes, &MeshLimits::default()).unwrap_err().to_string()
}

fn floats(file: &PointFile, name: &str) -> Vec<f32> {
    match &file.attributes[name].data {
        AttributeData::F32(numbers) => numbers.clone(),
        other => panic!("{other:?}"),
    }
}

const XYZ: &str = "float x, float y, float z";

#[test]
fn points_are_read_as_they_were_written() {
    let numbers = |count: usize, first: f32| (0..count).map(|i| first + i as f32 / 7.0).collect::<Vec<f32>>();
    let attribute = |channels: u32, data| MeshAttribute::new(channels, data);
    let full = PointFile {
        count: 3,
        positions: numbers(9, -0.0),
        rotations: numbers(12, 2.0),
        scales: numbers(9, 3.0),
        colors: numbers(12, 0.1),
        end_colors: numbers(12, 0.2),
        attributes: [
            ("heat".to_owned(), attribute(1, AttributeData::F32(vec![1e-20, -7.0, 3e9]))),
            ("color 2".to_owned(), attribute(2, AttributeData::U8(vec![0, 1, 2, 253, 254, 255]))),
            ("x".to_owned(), attribute(4, AttributeData::U16((0..12).map(|i| 5461 * i).collect()))),
        ]
        .into(),
        ..PointFile::default()
    };
    let uniform = PointFile { scales: Vec::new(), uniform_scales: numbers(3, 1.0), ..full.clone() };
    let three = |attribute: &MeshAttribute| MeshAttribute { channels: 3, ..attribute.clone() };
    let color = MeshAttribute::new(3, AttributeData::F32(numbers(9, 0.0)));
    let own_color = PointFile {
        colors: Vec::new(),
        end_colors: Vec::new(),
        attributes: [("color".to_owned(), three(&color))].into(),
        ..full.clone()
    };
    for points in [full, uniform, own_color, PointFile::default()] {
        assert_eq!(parsed(&points_bytes(&points)), points);
    }
    let matrices = PointFile { count: 2, matrices: numbers(24, -1.0), ..PointFile::default() };
    let bytes = points_bytes(&matrices);
    assert_eq!(parsed(&bytes), matrices);
    let declared = declared_points(&bytes, bytes.len() as u64);
    assert_eq!(declared, Some((2, 48)), "x, y and z are written for other programs only");
    assert_eq!(parsed(&points_bytes(&PointFile { count: 2, ..PointFile::default() })).positions, [0.0; 6]);
}

#[test]
fn columns_of_other_programs_are_attributes_in_their_own_unit() {
    let columns =
        format!("{XYZ}, uchar red, uchar green, uchar blue, uchar class, double time, float nx, list uchar int ids");
    let found = text(&columns, "1 2 3 255 0 0 7 0.5 1 0\n4 5 6 0 255 188 200 1e3 0 2 8 9\n");
    assert_eq!(found.positions, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!((floats(&found, "class"), floats(&found, "time")), (vec![7.0, 200.0], vec![0.5, 1000.0]));
    assert_eq!(found.attributes.len(), 3, "{:?}", found.attributes);
    assert_eq!(found.colors[..4], [1.0, 0.0, 0.0, 1.0], "integers are sRGB, without alpha");
    assert!((found.colors[6] - 0.502_886_4).abs() < 1e-6, "{:?}", found.colors);
    assert_eq!(found.warnings, ["ignored properties of 'vertex': 'ids'"]);
    // Gaussian splats have columns of these names with another meaning.
    let splats = text(&format!("{XYZ}, float scale_0, float rot_0"), "0 0 0 -5 0.1\n");
    assert!(splats.scales.is_empty() && splats.rotations.is_empty() && splats.attributes.len() == 2);
}

#[test]
fn colors_and_attributes_of_the_same_name_are_named() {
    let found = text(&format!("{XYZ}, float red, float green, float blue, float color"), "0 0 0 1 1 1 5\n");
    assert_eq!(
        (found.attributes.len(), found.warnings.as_slice()),
        (0, &["ignored a second attribute 'color'".to_owned()][..])
    );
    let found = text(&format!("{XYZ}, float heat, float attribute.heat"), "0 0 0 1 2\n");
    assert_eq!((floats(&found, "heat"), found.warnings.len()), (vec![2.0], 1));
}

#[test]
fn matrices_stand_in_place_of_other_transforms() {
    let names = MATRIX.map(|name| format!("float {name}")).join(", ");
    let found = text(&format!("{XYZ}, float scale, {names}"), "9 9 9 9 1 0 0 5 0 1 0 6 0 0 1 7\n");
    assert!(found.positions.is_empty() && found.uniform_scales.is_empty() && found.attributes.is_empty());
    assert_eq!(found.matrices, [1.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0, 6.0, 0.0, 0.0, 1.0, 7.0]);
    assert_eq!(found.warnings, ["ignored properties of 'vertex': 'scale'"]);
}

#[test]
fn a_mesh_is_points_too() {
    let mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let found = parsed(mesh.as_bytes());
    assert_eq!((found.count, found.warnings), (3, vec!["ignored: 1 elements 'face'".to_owned()]));
    assert!(failed(&mesh.as_bytes()[..mesh.len() - 4]).contains("line 13"), "a file that ends early");
}

#[test]
fn faulty_files_are_errors_with_their_place() {
    assert_eq!(failed(b"solid"), "line 1: expected 'ply', found 'solid'");
    let missing = failed(file("float x, float y", "0 0\n").as_bytes());
    assert_eq!(missing, "line 3: expected scalar properties x, y and z of the element 'vertex'");
    let none = failed(b"ply\nformat ascii 1.0\nend_header\n");
    assert_eq!(none, "line 1: expected an element 'vertex' with properties x, y and z");
    for number in ["nan", "inf"] {
        let error = failed(file(&format!("{XYZ}, float heat"), &format!("0 0 0 1\n0 0 0 {number}\n")).as_bytes());
        assert!(error.starts_with("line 10: ") && error.contains("heat"), "{error}");
    }
    let lies = file(XYZ, "0 0 0\n").replace("vertex 1", "vertex 3000000000");
    assert!(failed(lies.as_bytes()).contains("the header declares 3000000000 elements 'vertex'"));
    assert_eq!(declared_points(lies.as_bytes(), lies.len() as u64), None);
    let limits = MeshLimits { vertices: 1, ..MeshLimits::default() };
    let error = parse_points(file(XYZ, "0 0 0\n1 1 1\n").as_bytes(), &limits).unwrap_err().to_string();
    assert_eq!(error, "at least 2 vertices, the limit is 1");
}

#[test]
fn pieces_and_encodings_give_the_same_points() {
    let count = 40_000;
    let points = PointFile {
        count,
        positions: (0..3 * count).map(|i| i as f32 * 0.5).collect(),
        attributes: [(
            "a".to_owned(),
            MeshAttribute::new(1, AttributeData::F32((0..count).map(|i| i as f32).collect())),
        )]
        .into(),
        ..PointFile::default()
    };
    let bytes = points_bytes(&points);
    assert_eq!(parsed(&bytes), points, "several pieces");
    let rows: String = (0..count)
        .map(|i| format!("{} {} {} {i}\n", 3.0 * i as f32 * 0.5, (3 * i + 1) as f32 * 0.5, (3 * i + 2) as f32 * 0.5))
        .collect();
    assert_eq!(text(&format!("{XYZ}, float a"), &rows), points);
    assert_eq!(declared_points(&bytes, bytes.len() as u64), Some((count as u64, 16)));
}
