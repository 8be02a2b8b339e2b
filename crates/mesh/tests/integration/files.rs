//! Real mesh files of other programs, and large generated ones.
//!
//! The real files are in the folder `JUGGLER_ASSETS` (by default `../shared/assets` beside the
//! workspace); without it, the tests report that and pass. `JUGGLER_IMPORT_TRIANGLES=1000000 cargo
//! test --release -p juggler-mesh --test integration -- --nocapture files::` measures the speed of
//! loading.

use juggler_math::testing::skipped;
use juggler_math::{DVec3, Vec3, hash};
use juggler_mesh::{FilePosition, MeshErrorKind, MeshFile, MeshLimits, load, parse};
use juggler_shape::MeshData;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Path of an asset, if the assets are available.
fn asset(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let folder = std::env::var_os("JUGGLER_ASSETS").map_or_else(beside, PathBuf::from);
    if !folder.is_dir() {
        skipped(&format!("test assets: none in {}, set JUGGLER_ASSETS to their folder", folder.display()));
        return None;
    }
    Some(folder.join(name))
}

/// Loads the mesh of an asset, or returns from the test if it is not available.
macro_rules! loaded {
    ($name:expr) => {
        match asset($name) {
            Some(path) => load(&path, &MeshLimits::default()).unwrap_or_else(|error| panic!("{error}")),
            None => return,
        }
    };
}

#[test]
fn every_mesh_of_the_assets_loads() {
    let counts = [
        ("obj/embree-cornell/cornell_box.obj", 34),
        ("obj/fuze/fuze.obj", 1000),
        ("obj/negative_indices.obj", 12),
        ("obj/spot/spot_triangulated.obj", 5856),
        ("obj/teapot.obj", 25200),
        ("obj/tinyobjloader/cornell_box.obj", 36),
        ("obj/tinyobjloader/cube-vertexcol.obj", 12),
        ("obj/tinyobjloader/cube.obj", 12),
        ("obj/tinyobjloader/pbr-mat-ext.obj", 2),
        ("obj/tinyobjloader/smoothing-group-two-squares.obj", 3),
        ("obj/tinyobjloader/usemtl-issue-68.obj", 400),
        ("ply/cube_quads.ply", 12),
        ("ply/cycloidal.ply", 43368),
        ("ply/suzanne.ply", 968),
        ("ply/test_extra_whitespace.ply", 1),
        ("ply/test_more_datatypes.ply", 1),
        ("stl/featuretype.STL", 3476),
        ("stl/two_objects_mixed_case_names.stl", 24),
    ];
    for (name, triangles) in counts {
        let MeshFile { mesh, warnings, .. } = loaded!(name);
        eprintln!("{name}: {} vertices, {} triangles {warnings:?}", mesh.positions.len(), mesh.triangles.len());
        assert_eq!(mesh.triangles.len(), triangles, "{name}");
    }
}

#[test]
fn three_platonic_shelves_are_one_mesh() {
    let text = loaded!("ply/platonic_shelf_ascii.ply").mesh;
    assert_eq!((text.positions.len(), text.triangles.len()), (50, 80));
    assert_eq!(loaded!("ply/platonic_shelf.ply").mesh, text);
    assert_eq!(loaded!("ply/platonic_shelf_big_endian.ply").mesh, text);
}

#[test]
fn text_and_binary_spheres_are_the_same() {
    let pairs = [
        ("ply/test_pos_color.ply", "ply/test_pos_color_ascii.ply"),
        ("stl/test_sphere.stl", "stl/test_sphere_ascii.stl"),
    ];
    for (binary, text) in pairs {
        let (binary, text) = (loaded!(binary).mesh, loaded!(text).mesh);
        assert_eq!((binary.positions.len(), binary.triangles.len()), (114, 224));
        assert_eq!(binary.triangles, text.triangles);
        // The text files have six digits.
        let apart = binary.positions.iter().zip(&text.positions).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(apart < 2e-6, "{apart}");
    }
}

#[test]
fn negative_indices_make_a_closed_surface() {
    let mesh = loaded!("obj/negative_indices.obj").mesh;
    assert_eq!(mesh.positions.len(), 24, "six sides with normals of their own");
    assert_eq!(open_edges(&mesh), 0);
}

#[test]
fn spot_is_closed_and_the_same_from_triangles_and_quads() {
    let (triangles, quads) =
        (loaded!("obj/spot/spot_triangulated.obj").mesh, loaded!("obj/spot/spot_quadrangulated.obj").mesh);
    assert_eq!((triangles.triangles.len(), quads.triangles.len()), (5856, 5856));
    for mesh in [&triangles, &quads] {
        assert_eq!(open_edges(mesh), 0);
        let hit = (0..60).filter(|case| crossings(mesh, *case) > 0).count();
        assert!(hit > 20, "only {hit} rays hit");
        assert!(
            (0..60).all(|case| crossings(mesh, case).is_multiple_of(2)),
            "a ray from outside left the surface open"
        );
    }
}

/// Number of edges (of welded positions) that are not used exactly once in each direction.
fn open_edges(mesh: &MeshData) -> usize {
    let mut edges = std::collections::BTreeMap::<_, i32>::new();
    let key = |corner: u32| mesh.positions[corner as usize].to_array().map(f32::to_bits);
    for [a, b, c] in &mesh.triangles {
        for (from, to) in [(key(*a), key(*b)), (key(*b), key(*c)), (key(*c), key(*a))] {
            let (edge, sign) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            *edges.entry(edge).or_default() += sign;
        }
    }
    edges.values().filter(|sum| **sum != 0).count()
}

/// Number of intersections of the surface with a ray from far outside towards the center.
fn crossings(mesh: &MeshData, case: u32) -> usize {
    let random = |index| f64::from(hash::unit_f32(hash::combine(case, index))) - 0.5;
    let origin = DVec3::new(random(0), random(1), random(2)).normalize() * 50.0;
    let direction = DVec3::new(random(3), random(4) + 0.3, random(5)) - origin;
    let corner = |index: u32| mesh.positions[index as usize].as_dvec3();
    let crosses = |[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [corner(*a), corner(*b), corner(*c)].map(|corner| corner - origin);
        let side = |p: DVec3, q: DVec3| direction.dot(p.cross(q)) > 0.0;
        let (first, second, third) = (side(a, b), side(b, c), side(c, a));
        first == second && second == third
    };
    mesh.triangles.iter().filter(|corners| crosses(corners)).count()
}

#[test]
fn malformed_objs_name_file_and_line() {
    for (name, line) in [("malformed/invalid-relative-vertex-index.obj", 1), ("malformed/zero-face-index.obj", 16)] {
        let Some(path) = asset(name) else { return };
        let error = load(&path, &MeshLimits::default()).unwrap_err();
        assert!(error.to_string().starts_with(&format!("{}: line {line}: ", path.display())), "{error}");
        assert!(
            matches!(error.kind, MeshErrorKind::Malformed { place: FilePosition::Line(found), .. } if found == line)
        );
    }
}

/// A wavy sheet of at least this number of triangles.
fn sheet(triangles: usize) -> MeshData {
    let side = ((triangles as f64 / 2.0).sqrt().ceil() as u32).max(1);
    let point = |index: u32| {
        let (x, z) = (index % (side + 1), index / (side + 1));
        Vec3::new(x as f32 / side as f32, hash::unit_f32(hash::mix(index)) * 0.01, z as f32 / side as f32)
    };
    let positions = (0..(side + 1) * (side + 1)).map(point).collect();
    let cell = |index: u32| {
        let corner = index + index / side;
        [[corner, corner + side + 1, corner + 1], [corner + 1, corner + side + 1, corner + side + 2]]
    };
    MeshData { positions, triangles: (0..side * side).flat_map(cell).collect(), ..MeshData::default() }
}

fn ply(mesh: &MeshData, format: &str) -> Vec<u8> {
    let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    if format == "ascii" {
        let mut text = String::new();
        mesh.positions.iter().for_each(|p| text += &format!("{} {} {}\n", p.x, p.y, p.z));
        mesh.triangles.iter().for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
        bytes.extend(text.into_bytes());
        return bytes;
    }
    bytes.extend(mesh.positions.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    for corners in &mesh.triangles {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|corner| corner.to_le_bytes()));
    }
    bytes
}

fn obj(mesh: &MeshData) -> Vec<u8> {
    let mut text = String::new();
    mesh.positions.iter().for_each(|p| text += &format!("v {} {} {}\n", p.x, p.y, p.z));
    mesh.triangles.iter().for_each(|corners| {
        let [a, b, c] = corners.map(|corner| corner + 1);
        text += &format!("f {a} {b} {c}\n");
    });
    text.into_bytes()
}

fn binary_stl(mesh: &MeshData) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for corners in &mesh.triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flat_map(|c| mesh.positions[*c as usize].to_array()).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

fn text_stl(mesh: &MeshData) -> Vec<u8> {
    let mut text = "solid sheet\n".to_owned();
    for corners in &mesh.triangles {
        text.push_str("facet normal 0 1 0\nouter loop\n");
        for p in corners.map(|corner| mesh.positions[corner as usize]) {
            text += &format!("vertex {} {} {}\n", p.x, p.y, p.z);
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid sheet\n");
    text.into_bytes()
}

/// Corner positions of every triangle, which do not depend on the order of the vertices.
fn corners(mesh: &MeshData) -> Vec<[Vec3; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.positions[corner as usize])).collect()
}

#[test]
fn speed_and_equality_of_the_formats() {
    let triangles = std::env::var("JUGGLER_IMPORT_TRIANGLES").ok().and_then(|count| count.parse().ok()).unwrap_or(5000);
    let mesh = sheet(triangles);
    let files = [
        ("binary.ply", ply(&mesh, "binary_little_endian")),
        ("text.ply", ply(&mesh, "ascii")),
        ("a.obj", obj(&mesh)),
        ("binary.stl", binary_stl(&mesh)),
        ("text.stl", text_stl(&mesh)),
    ];
    for (name, bytes) in files {
        let start = Instant::now();
        let found = parse(Path::new(name), &bytes, &MeshLimits::default()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let megabytes = bytes.len() as f64 / 1e6;
        let (count, speed) = (found.mesh.triangles.len(), megabytes / seconds);
        eprintln!("{name}: {count} triangles, {megabytes:.1} MB in {seconds:.3} s, {speed:.0} MB/s");
        assert_eq!(found.mesh.positions.len(), mesh.positions.len(), "{name}");
        assert!(corners(&found.mesh) == corners(&mesh), "{name}");
        assert!(found.warnings.is_empty(), "{name}: {:?}", found.warnings);
    }
}
