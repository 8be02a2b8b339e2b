//! Loading files: names, contents that belie them, limits.

use super::*;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const FACET: &str =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const TABLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                     element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn the_three_formats_are_one_mesh_whatever_their_name_says() {
    let expected = parse(Path::new("a.obj"), TRIANGLE.as_bytes(), &Limits::default()).unwrap();
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
        let found = parse(Path::new(name), text.as_bytes(), &Limits::default()).unwrap();
        assert_eq!(found.mesh, expected.mesh, "{name}");
        let warning = is.map(|is| format!("the name does not say so, but the content is {is}"));
        assert_eq!(found.warnings, Vec::from_iter(warning), "{name}");
    }
}

#[test]
fn files_are_loaded_and_their_size_is_limited() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Part.Obj");
    std::fs::write(&path, TRIANGLE).unwrap();
    assert_eq!(load(&path, &Limits::default()).unwrap().mesh.triangles, [[0, 1, 2]]);
    let size = TRIANGLE.len() as u64;
    assert!(load(&path, &Limits { file_bytes: size, ..Limits::default() }).is_ok());
    let error = load(&path, &Limits { file_bytes: size - 1, ..Limits::default() }).unwrap_err();
    assert_eq!(error.to_string(), format!("{}: at least 32 bytes, the limit is 31", path.display()));
    assert_eq!(error.path, path);
}

#[test]
fn what_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = load(&folder.path().join("none.ply"), &Limits::default()).unwrap_err();
    assert!(matches!(missing.fault, Fault::Read(_)));
    assert!(missing.to_string().contains("none.ply: cannot be read: "), "{missing}");
    let directory = folder.path().join("folder.ply");
    std::fs::create_dir(&directory).unwrap();
    assert!(matches!(load(&directory, &Limits::default()).unwrap_err().fault, Fault::Read(_)));
    let unknown = parse(Path::new("cow.fbx"), b"Kaydara FBX", &Limits::default()).unwrap_err();
    assert_eq!(unknown.to_string(), "cow.fbx: not a known mesh format: expected a file named .obj, .ply or .stl");
}

#[test]
fn an_error_names_file_and_line() {
    let error = parse(Path::new("models/cow.obj"), b"v 0 0 0\nv 1 0\n", &Limits::default()).unwrap_err();
    assert_eq!(error.to_string(), "models/cow.obj: line 2: expected a number for z, found the end of the line");
    assert!(matches!(error.fault, Fault::Malformed { place: Place::Line(2), .. }));
}
