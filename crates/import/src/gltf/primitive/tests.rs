use super::*;
use crate::gltf::Gltf;
use crate::gltf::Limits;
use crate::gltf::testing::{Builder, f32_bytes};
use juggler_math::{Vec2, Vec3};
use std::collections::BTreeMap;

const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];

/// File with a mesh of one primitive, whose attributes are `POSITION` of a square and others.
fn file(build: impl FnOnce(&mut Builder) -> (String, String)) -> Builder {
    let mut file = Builder::default();
    file.floats("VEC3", 3, &SQUARE);
    let (attributes, rest) = build(&mut file);
    let primitive = format!(r#"{{"attributes": {{"POSITION": 0{attributes}}}{rest}}}"#);
    file.member(format!(r#""meshes": [{{"primitives": [{primitive}]}}]"#));
    file
}

fn arrays(file: &Builder) -> PrimitiveArrays {
    match file.load().assemble(0, 0) {
        Ok(Assembly::Arrays(arrays)) => *arrays,
        other => panic!("{other:?}"),
    }
}

fn warnings(warnings: &Warnings) -> Vec<String> {
    warnings.list().iter().map(ToString::to_string).collect()
}

/// Faces of a primitive of a mode with indices of 16 bits.
fn faces(mode: u32, indices: &[u16]) -> (Faces, Vec<String>) {
    let file = file(|file| {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let accessor = file.array(5123, "SCALAR", indices.len(), &bytes);
        (String::new(), format!(r#", "indices": {accessor}, "mode": {mode}"#))
    });
    let arrays = arrays(&file);
    (arrays.faces, warnings(&arrays.warnings))
}

#[test]
fn modes_make_faces() {
    let none: Vec<String> = Vec::new();
    assert_eq!(faces(0, &[3, 1, 1]), (Faces::Points(vec![3, 1, 1]), none.clone()));
    assert_eq!(faces(1, &[0, 1, 2, 3]), (Faces::Lines(vec![[0, 1], [2, 3]]), none.clone()));
    assert_eq!(faces(2, &[0, 1, 2]), (Faces::Lines(vec![[0, 1], [1, 2], [2, 0]]), none.clone()));
    assert_eq!(faces(3, &[0, 1, 2]), (Faces::Lines(vec![[0, 1], [1, 2]]), none.clone()));
    assert_eq!(faces(4, &[0, 1, 2, 2, 3, 0]), (Faces::Triangles(vec![[0, 1, 2], [2, 3, 0]]), none.clone()));
    let strip = Faces::Triangles(vec![[0, 1, 2], [1, 3, 2], [2, 3, 0]]);
    assert_eq!(faces(5, &[0, 1, 2, 3, 0]), (strip, none.clone()));
    let fan = Faces::Triangles(vec![[1, 2, 0], [2, 3, 0], [3, 1, 0]]);
    assert_eq!(faces(6, &[0, 1, 2, 3, 1]), (fan, none));
}

#[test]
fn degenerate_and_incomplete_faces_are_counted() {
    let (found, warnings) = faces(5, &[0, 1, 2, 2, 2, 3, 0]);
    assert_eq!(found, Faces::Triangles(vec![[0, 1, 2], [2, 3, 0]]));
    assert_eq!(warnings, ["/meshes/0/primitives/0: faces with two equal corners are left out (3 of them)"]);
    let (found, warnings) = faces(4, &[0, 1, 2, 0, 0, 1, 2, 3]);
    assert_eq!(found, Faces::Triangles(vec![[0, 1, 2]]));
    let texts = ["vertices at the end make no whole face (2 of them)", "faces with two equal corners are left out"];
    assert_eq!(warnings, texts.map(|text| format!("/meshes/0/primitives/0: {text}")));
}

#[test]
fn primitives_without_indices_use_all_vertices() {
    let file = file(|_| (String::new(), r#", "mode": 5"#.to_owned()));
    assert_eq!(arrays(&file).faces, Faces::Triangles(vec![[0, 1, 2], [1, 3, 2]]));
}

#[test]
fn indices_are_less_than_the_number_of_positions() {
    for (component, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        let assemble = |last: u32| {
            let file = file(|file| {
                let indices = [0_u32, 1, 2, 0, 2, last];
                let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()[..size].to_vec()).collect();
                let accessor = file.array(component, "SCALAR", 6, &bytes);
                (String::new(), format!(r#", "indices": {accessor}"#))
            });
            file.load().assemble(0, 0).map(|_| ()).map_err(|fault| fault.to_string())
        };
        assert_eq!(assemble(3), Ok(()));
        let text = "/meshes/0/primitives/0: index 4 at element 5, there are 4 positions";
        assert_eq!(assemble(4), Err(text.to_owned()));
        let restart = u32::MAX >> (32 - 8 * size);
        let text =
            format!("/meshes/0/primitives/0: index {restart} at element 5 restarts the primitive, which glTF forbids");
        assert_eq!(assemble(u32::MAX), Err(text));
    }
}

#[test]
fn primitives_without_positions_or_faces_are_left_out() {
    let reason = |file: &Builder| match file.load().assemble(0, 0) {
        Ok(Assembly::LeftOut(left_out)) => warnings(&left_out).join("; "),
        other => panic!("{other:?}"),
    };
    let mut empty = Builder::default();
    empty.floats("VEC3", 3, &SQUARE);
    empty.member(r#""meshes": [{"primitives": [{"attributes": {"NORMAL": 0}}]}]"#);
    assert_eq!(reason(&empty), "/meshes/0/primitives/0: has no `POSITION` and is left out");
    let one = file(|file| {
        let accessor = file.array(5121, "SCALAR", 2, &[0, 1]);
        (String::new(), format!(r#", "indices": {accessor}"#))
    });
    assert!(reason(&one).ends_with("has no faces and is left out"), "{}", reason(&one));
    let points = file(|_| (String::new(), r#", "mode": 0"#.to_owned()));
    let limits = Limits { points_and_lines: 3, ..Limits::default() };
    let data = Gltf::open("a.glb", points.glb(), &limits).unwrap().load(&BTreeMap::new()).unwrap();
    assert!(matches!(data.assemble(0, 0), Ok(Assembly::LeftOut(_))));
    assert!(data.assemble(0, 1).is_err() && data.assemble(1, 0).is_err());
}

#[test]
fn attributes_are_converted_to_our_conventions() {
    let file = file(|file| {
        let up = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        let normals = file.floats("VEC3", 3, &up);
        let tangents = file.floats("VEC4", 4, &[1.0, 0.0, 0.0, -1.0].repeat(4));
        let first = file.floats("VEC2", 2, &[0.0, 0.25].repeat(4));
        let second = file.view(&[0, 51, 255, 255, 0, 0, 0, 0], "");
        let second = file.accessor(&format!(
            r#""bufferView": {second}, "componentType": 5121, "count": 4, "type": "VEC2", "normalized": true"#
        ));
        let colors = file.floats("VEC3", 3, &[-1.0, 0.5, 2.0].repeat(4));
        let rest = format!(
            r#", "NORMAL": {normals}, "TANGENT": {tangents}, "TEXCOORD_0": {first}, "TEXCOORD_2": {second},
               "COLOR_0": {colors}, "COLOR_1": {colors}, "_MINE": {colors}"#
        );
        (rest, String::new())
    });
    let arrays = arrays(&file);
    let vertices = &arrays.vertices;
    assert_eq!(vertices.positions[2], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(vertices.normals[..2], [Vec3::Z, Vec3::ZERO], "a zero normal stays");
    assert_eq!(vertices.tangents[3], [1.0, 0.0, 0.0, -1.0]);
    let sets: Vec<usize> = vertices.texcoords.iter().map(Vec::len).collect();
    assert_eq!(sets, [4, 0, 4]);
    assert_eq!(vertices.texcoords[0][0], Vec2::new(0.0, 0.75));
    assert_eq!(vertices.texcoords[2][..2], [Vec2::new(0.0, 0.8), Vec2::new(1.0, 0.0)]);
    assert_eq!(vertices.colors[0], [0.0, 0.5, 1.0, 1.0]);
    let found = warnings(&arrays.warnings);
    assert!(found.contains(&"/meshes/0/primitives/0: the attribute `COLOR_1` has no effect".to_owned()), "{found:?}");
}

#[test]
fn colors_of_all_types_have_alpha() {
    for (component, bytes) in [(5121, vec![255, 0, 51, 102]), (5123, vec![255, 255, 0, 0, 51, 51, 102, 102])] {
        let file = file(|file| {
            let view = file.view(&bytes.repeat(4), "");
            let colors = file.accessor(&format!(
                r#""bufferView": {view}, "componentType": {component}, "count": 4, "type": "VEC4", "normalized": true"#
            ));
            (format!(r#", "COLOR_0": {colors}"#), String::new())
        });
        assert_eq!(arrays(&file).vertices.colors[0], [1.0, 0.0, 0.2, 0.4]);
    }
}

#[test]
fn tangents_need_normals() {
    let file = file(|file| {
        let tangents = file.floats("VEC4", 4, &[1.0, 0.0, 0.0, 1.0].repeat(4));
        (format!(r#", "TANGENT": {tangents}"#), r#", "mode": 5"#.to_owned())
    });
    let arrays = arrays(&file);
    assert!(arrays.vertices.tangents.is_empty() && arrays.vertices.normals.is_empty());
    assert_eq!(warnings(&arrays.warnings), ["/meshes/0/primitives/0: tangents have no effect without normals"]);
}

#[test]
fn joint_weights_are_normalized_over_all_sets() {
    let file = file(|file| {
        let joints = file.array(5121, "VEC4", 4, &[3, 2, 1, 0].repeat(4));
        let first = [[0.5, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.0; 4], [0.4995, 0.0, 0.0, 0.0]];
        let second = [[0.0, 0.0, 1.0, 0.5], [0.0; 4], [0.0; 4], [0.5, 0.0, 0.0, 0.0]];
        let [first, second] = [first, second].map(|set| file.floats("VEC4", 4, set.as_flattened()));
        let rest = format!(
            r#", "JOINTS_0": {joints}, "WEIGHTS_0": {first}, "JOINTS_1": {joints}, "WEIGHTS_1": {second}, "JOINTS_2": {joints}"#
        );
        (rest, r#", "mode": 5"#.to_owned())
    });
    let arrays = arrays(&file);
    let [first, second] = arrays.joints.as_slice() else { panic!("{:?}", arrays.joints) };
    assert_eq!(first.joints[0], [3, 2, 1, 0]);
    assert_eq!((first.weights[0], second.weights[0]), ([0.25, 0.0, 0.0, 0.0], [0.0, 0.0, 0.5, 0.25]));
    assert_eq!((first.weights[1], first.weights[2]), ([0.5, 0.5, 0.0, 0.0], [0.0; 4]));
    assert_eq!(first.weights[3], [0.4995, 0.0, 0.0, 0.0], "within the tolerance");
    let texts = [
        "`JOINTS_2` has no effect without `WEIGHTS_2`",
        "vertices have joint weights whose sum was not 1; they were normalized",
    ];
    assert_eq!(warnings(&arrays.warnings), texts.map(|text| format!("/meshes/0/primitives/0: {text}")));
}

#[test]
fn morph_targets_displace_what_the_mesh_has() {
    let file = file(|file| {
        let texcoords = file.floats("VEC2", 2, &[0.0; 8]);
        let colors = file.floats("VEC4", 4, &[0.5; 16]);
        let deltas = file.floats("VEC3", 3, &[0.5, -2.0, 3.0].repeat(4));
        let moves = file.floats("VEC2", 2, &[0.25, 0.5].repeat(4));
        let target = format!(
            r#"{{"POSITION": {deltas}, "NORMAL": {deltas}, "TANGENT": {deltas}, "TEXCOORD_0": {moves},
                "TEXCOORD_1": {moves}, "COLOR_0": {deltas}}}"#
        );
        let attributes = format!(r#", "TEXCOORD_0": {texcoords}, "COLOR_0": {colors}"#);
        (attributes, format!(r#", "targets": [{target}, {{"POSITION": {deltas}}}]"#))
    });
    let targets = arrays(&file).targets;
    assert_eq!(targets.len(), 2);
    assert_eq!(targets[0].positions[3], Vec3::new(0.5, -2.0, 3.0));
    assert!(targets[0].normals.is_empty() && targets[0].tangents.is_empty(), "the mesh has none");
    assert_eq!(targets[0].texcoords, [vec![Vec2::new(0.25, -0.5); 4]]);
    assert_eq!(targets[0].colors[0], [0.5, -2.0, 3.0, 0.0]);
    assert!(targets[1].colors.is_empty());
}

#[test]
fn wrong_bounds_are_a_warning() {
    let bounds = |high: &str| {
        let mut file = Builder::default();
        let view = file.view(&f32_bytes(&SQUARE), "");
        file.accessor(&format!(
            r#""bufferView": {view}, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, {high}, 0]"#
        ));
        file.member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}]"#);
        warnings(&arrays(&file).warnings)
    };
    assert!(bounds("1").is_empty() && bounds("1.0000001").is_empty());
    let text = "/meshes/0/primitives/0: `min` and `max` of the positions are wrong; they have no effect";
    assert_eq!((bounds("1.1"), bounds("1e300")), (vec![text.to_owned()], vec![text.to_owned()]));
}

#[test]
fn draco_primitives_use_the_given_decoder() {
    let file = file(|file| {
        let view = file.view(b"DRACO", "");
        let extension =
            format!(r#"{{"KHR_draco_mesh_compression": {{"bufferView": {view}, "attributes": {{"POSITION": 7}}}}}}"#);
        (String::new(), format!(r#", "extensions": {extension}"#))
    });
    let data = file.load();
    let Ok(Assembly::Draco(stream)) = data.assemble(0, 0) else { panic!("not compressed") };
    assert_eq!((stream.data, stream.attributes.find(&Semantic::Position)), (&b"DRACO"[..], Some(7.into())));
    let moved: Vec<f32> = SQUARE.iter().map(|number| number + 1.0).collect();
    let mut decoded = DracoArrays { indices: vec![0, 1, 2], ..DracoArrays::default() };
    decoded.attributes.insert(Semantic::Position, f32_bytes(&moved));
    let Ok(Assembly::Arrays(arrays)) = data.assemble_draco(0, 0, &decoded) else { panic!("no arrays") };
    assert_eq!(arrays.vertices.positions[0], Vec3::ONE);
    assert_eq!(arrays.faces, Faces::Triangles(vec![[0, 1, 2]]));
    decoded.indices = vec![0, 1, 4];
    let fault = data.assemble_draco(0, 0, &decoded).unwrap_err().to_string();
    assert_eq!(fault, "/meshes/0/primitives/0: index 4 at element 2, there are 4 positions");
    decoded.attributes.insert(Semantic::Position, f32_bytes(&moved[..9]));
    let fault = data.assemble_draco(0, 0, &decoded).unwrap_err().to_string();
    assert_eq!(fault, "/accessors/0: has 48 bytes, its decoded data has 36");
}

#[test]
fn equal_primitives_have_equal_keys() {
    let mut file = Builder::default();
    file.floats("VEC3", 3, &SQUARE);
    let one = r#"{"attributes": {"POSITION": 0}, "material": 0}"#;
    let other = r#"{"attributes": {"POSITION": 0}, "mode": 5}"#;
    let same = r#"{"attributes": {"POSITION": 0}}"#;
    file.member(format!(r#""materials": [{{}}], "meshes": [{{"primitives": [{one}, {other}, {same}]}}]"#));
    let gltf = file.open().unwrap();
    let keys: Vec<GeometryKey> = gltf.document.meshes[0].primitives.iter().map(GeometryKey::new).collect();
    assert!(keys[0] == keys[2] && keys[0] != keys[1]);
}
