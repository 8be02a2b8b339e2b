//! Tests of types, numbers and compression.

use crate::gltf::testing::Builder;
use crate::gltf::{Gltf, Limits};

fn open(members: &str) -> Result<Gltf, String> {
    let text = format!(r#"{{"asset": {{"version": "2.0"}}, {members}}}"#);
    Gltf::open("a.gltf", text.into_bytes(), &Limits::default()).map_err(|error| error.to_string())
}

fn fault(members: &str) -> String {
    open(members).expect_err("the document is valid").strip_prefix("a.gltf: ").unwrap().to_owned()
}

/// Mesh with accessors of the given component types, element types and counts, one for each
/// attribute.
fn mesh(attributes: &[(&str, u32, &str, u32)], rest: &str) -> String {
    let accessors: Vec<String> = attributes
        .iter()
        .map(|(_, component, element, count)| {
            format!(r#"{{"componentType": {component}, "type": "{element}", "count": {count}}}"#)
        })
        .collect();
    let names: Vec<String> = attributes.iter().enumerate().map(|(i, (name, ..))| format!(r#""{name}": {i}"#)).collect();
    format!(
        r#""accessors": [{}], "meshes": [{{"primitives": [{{"attributes": {{{}}}{rest}}}]}}]"#,
        accessors.join(", "),
        names.join(", ")
    )
}

const POSITION: (&str, u32, &str, u32) = ("POSITION", 5126, "VEC3", 4);

#[test]
fn attributes_have_their_types() {
    let valid = [
        ("NORMAL", 5126, "VEC3", 4),
        ("TANGENT", 5126, "VEC4", 4),
        ("TEXCOORD_3", 5122, "VEC2", 4),
        ("COLOR_0", 5126, "VEC3", 4),
        ("JOINTS_0", 5121, "VEC4", 4),
        ("WEIGHTS_1", 5126, "VEC4", 4),
        ("_MINE", 5125, "MAT2", 1),
    ];
    for attribute in valid {
        assert!(open(&mesh(&[POSITION, attribute], "")).is_ok(), "{attribute:?}");
    }
    let attribute = |attribute| fault(&mesh(&[POSITION, attribute], ""));
    let at = "/meshes/0/primitives/0/attributes";
    assert_eq!(attribute(("NORMAL", 5126, "VEC4", 4)), format!("{at}/NORMAL: accessor 1 is VEC4, expected VEC3"));
    let text = "accessor 1 has components of FLOAT, expected UNSIGNED_BYTE or UNSIGNED_SHORT";
    assert_eq!(attribute(("JOINTS_0", 5126, "VEC4", 4)), format!("{at}/JOINTS_0: {text}"));
    let text = "accessor 1 has components of UNSIGNED_BYTE, which must be normalized";
    assert_eq!(attribute(("COLOR_0", 5121, "VEC4", 4)), format!("{at}/COLOR_0: {text}"));
    let text = "accessor 1 has 3 elements, there are 4 vertices";
    assert_eq!(attribute(("TEXCOORD_0", 5126, "VEC2", 3)), format!("{at}/TEXCOORD_0: {text}"));
    let indices = fault(&mesh(&[POSITION, ("_I", 5122, "SCALAR", 3)], r#", "indices": 1"#));
    let text = "accessor 1 has components of SHORT, expected UNSIGNED_BYTE or UNSIGNED_SHORT or UNSIGNED_INT";
    assert_eq!(indices, format!("/meshes/0/primitives/0/indices: {text}"));
}

#[test]
fn morph_targets_fit_their_mesh() {
    let delta = ("_D", 5126, "VEC3", 4);
    assert!(open(&mesh(&[POSITION, delta], r#", "targets": [{"POSITION": 1, "TANGENT": 1}]"#)).is_ok());
    let short = fault(&mesh(&[POSITION, ("_D", 5126, "VEC3", 3)], r#", "targets": [{"POSITION": 1}]"#));
    let text = "accessor 1 has 3 elements, there are 4 vertices";
    assert_eq!(short, format!("/meshes/0/primitives/0/targets/0/POSITION: {text}"));
    let weights =
        mesh(&[POSITION], r#", "targets": [{}, {}]"#).replace("[{\"primitives\"", "[{\"weights\": [1], \"primitives\"");
    assert_eq!(fault(&weights), "/meshes/0/weights: 1 weights, there are 2 morph targets");
    let node = format!(r#"{}, "nodes": [{{"mesh": 0, "weights": [1, 2]}}]"#, mesh(&[POSITION], ""));
    assert_eq!(fault(&node), "/nodes/0/weights: 2 weights, the mesh has 0 morph targets");
}

#[test]
fn limits_of_counts_hold() {
    let large = fault(&mesh(&[("POSITION", 5121, "VEC3", 1 << 29)], ""));
    assert!(large.contains("/meshes/0/primitives/0: 536870912 vertices, the limit is 268435456"), "{large}");
    let keys = r#""accessors": [{"componentType": 5126, "type": "SCALAR", "count": 10000001}],
                  "animations": [{"channels": [], "samplers": [{"input": 0, "output": 0}]}]"#;
    assert_eq!(fault(keys), "/animations/0/samplers/0/input: 10000001 keys, the limit is 10000000");
    let materials = vec!["{}"; 65_537].join(",");
    assert_eq!(
        fault(&format!(r#""materials": [{materials}]"#)),
        "/materials: there are more than 65536 materials, the limit"
    );
    let escaped = format!(r#""m\u0061terials": [{materials}]"#);
    assert_eq!(fault(&escaped), "/materials: 65537 materials, the limit is 65536");
}

/// Members of a file, each with a number out of its range and the message.
const OUT_OF_RANGE: &[(&str, &str)] = &[
    (r#""materials": [{"alphaCutoff": -1}]"#, "/materials/0/alphaCutoff: -1 is not a finite number of at least 0"),
    (
        r#""materials": [{"pbrMetallicRoughness": {"metallicFactor": 1.5}}]"#,
        "/materials/0/pbrMetallicRoughness/metallicFactor: 1.5 is not from 0 to 1",
    ),
    (r#""materials": [{"emissiveFactor": [0, 2, 0]}]"#, "/materials/0/emissiveFactor/1: 2 is not from 0 to 1"),
    (
        r#""materials": [{"extensions": {"KHR_materials_ior": {"ior": 0.5}}}]"#,
        "/materials/0/extensions/KHR_materials_ior/ior: 0.5 is not a finite number of at least 1",
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_volume": {"attenuationDistance": 0}}}]"#,
        "/materials/0/extensions/KHR_materials_volume/attenuationDistance: 0 is not a finite number above 0",
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e39}}}]"#,
        "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength: \
             1000000000000000000000000000000000000000 is not a finite number of at least 0",
    ),
    (r#""nodes": [{"rotation": [0, 0, 0, 0]}]"#, "/nodes/0/rotation: 0 0 0 0 is no rotation"),
    (
        r#""nodes": [{"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0.5, 0,0,0,1]}]"#,
        "/nodes/0/matrix: the last row is 0 0 0.5 1, expected 0 0 0 1",
    ),
    (
        r#""nodes": [{"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "scale": [1, 1, 1]}]"#,
        "/nodes/0/matrix: a node has either a matrix or translation, rotation and scale",
    ),
    (
        r#""cameras": [{"type": "perspective", "perspective": {"yfov": 45, "znear": 0.1}}]"#,
        "/cameras/0/perspective/yfov: 45 is not less than pi; the angle is in radians",
    ),
    (r#""cameras": [{"type": "perspective"}]"#, "/cameras/0: has no `perspective`"),
    (
        r#""cameras": [{"type": "orthographic", "orthographic": {"xmag": 0, "ymag": 1, "znear": 0, "zfar": 1}}]"#,
        "/cameras/0/orthographic/xmag: 0 is no size of an image",
    ),
    (
        r#""extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"innerConeAngle": 1}}]}}"#,
        "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle: \
             1 is greater than `outerConeAngle`, 0.7853981633974483",
    ),
    (
        r#""extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "range": 0}]}}"#,
        "/extensions/KHR_lights_punctual/lights/0/range: 0 is not a finite number above 0",
    ),
    (r#""images": [{}]"#, "/images/0: has neither `uri` nor `bufferView`"),
    (r#""skins": [{"joints": []}]"#, "/skins/0/joints: there are no joints"),
    (r#""nodes": [{}], "skins": [{"joints": [0, 0]}]"#, "/skins/0/joints/1: 0 stands twice in the list"),
];

#[test]
fn numbers_are_in_their_ranges() {
    for (members, expected) in OUT_OF_RANGE {
        assert_eq!(fault(members), *expected);
    }
    assert!(open(r#""materials": [{"extensions": {"KHR_materials_ior": {"ior": 0}}}]"#).is_ok());
}

#[test]
fn animations_have_as_many_values_as_keys() {
    let animation = |path: &str, interpolation: &str, element: &str, count: u32| {
        format!(
            r#""accessors": [{{"componentType": 5126, "type": "SCALAR", "count": 4}},
                             {{"componentType": 5126, "type": "{element}", "count": {count}}}, {{"componentType": 5126, "type": "VEC3", "count": 1}}],
               "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 2}}, "targets": [{{}}, {{}}]}}]}}], "nodes": [{{"mesh": 0}}],
               "animations": [{{"samplers": [{{"input": 0, "output": 1, "interpolation": "{interpolation}"}}],
                                "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "{path}"}}}}]}}]"#
        )
    };
    for (path, interpolation, element, count) in [
        ("translation", "LINEAR", "VEC3", 4),
        ("rotation", "STEP", "VEC4", 4),
        ("scale", "CUBICSPLINE", "VEC3", 12),
        ("weights", "LINEAR", "SCALAR", 8),
        ("weights", "CUBICSPLINE", "SCALAR", 24),
        ("other", "LINEAR", "SCALAR", 1),
    ] {
        assert!(open(&animation(path, interpolation, element, count)).is_ok(), "{path}");
    }
    let at = "/animations/0/channels/0/sampler";
    let short = fault(&animation("weights", "LINEAR", "SCALAR", 4));
    assert_eq!(short, format!("{at}: accessor 1 has 4 elements, 4 keys need 8"));
    let wrong = fault(&animation("rotation", "LINEAR", "VEC3", 4));
    assert_eq!(wrong, format!("{at}: accessor 1 is VEC3, expected VEC4"));
    let unknown = fault(&animation("rotation", "BEZIER", "VEC4", 4));
    assert!(unknown.starts_with("/animations/0/samplers/0/interpolation: unknown variant `BEZIER`"), "{unknown}");
    let pointer = open(&animation("pointer", "LINEAR", "SCALAR", 4)).unwrap().warnings.texts();
    let text = "/animations/0/channels/0/target: has no `KHR_animation_pointer`, so the channel has no effect";
    assert_eq!(pointer, [text]);
}

#[test]
fn compressed_views_decode_to_their_length() {
    let view = |members: &str, length: u32| {
        let mut file = Builder::default();
        let extension = format!(r#"{{"EXT_meshopt_compression": {{"buffer": 0, {members}}}}}"#);
        file.view(&[0; 40], &format!(r#""extensions": {extension}"#));
        let json = file.json().replace("\"byteLength\": 40, \"ext", &format!("\"byteLength\": {length}, \"ext"));
        let text = crate::gltf::testing::glb(&json, &[0; 40]);
        Gltf::open("a.glb", text, &Limits::default()).map(|_| ()).map_err(|error| error.to_string())
    };
    let members = |count: u64, stride: u32, length: u32| {
        format!(r#""byteLength": {length}, "byteStride": {stride}, "count": {count}, "mode": "ATTRIBUTES""#)
    };
    let prefix = "a.glb: /bufferViews/0/extensions/EXT_meshopt_compression: ";
    assert_eq!(view(&members(10, 4, 40), 40), Ok(()));
    let error = |members: &str| view(members, 40).unwrap_err().strip_prefix(prefix).unwrap().to_owned();
    assert_eq!(error(&members(10, 8, 40)), "decodes to 80 bytes, the buffer view has 40");
    assert_eq!(error(&members(0, 4, 40)), "0 elements of 4 bytes are no data");
    assert_eq!(error(&members(10, 4, 41)), "needs 41 bytes from byte 0, buffer 0 has 40");
    let unknown = view(&members(10, 4, 40).replace("ATTRIBUTES", "OTHER"), 40).unwrap_err();
    assert!(unknown.contains("unknown mode `OTHER`"), "{unknown}");
}

#[test]
fn instances_have_equal_counts() {
    let instancing = |scales: u32| {
        format!(
            r#""accessors": [{{"componentType": 5126, "type": "VEC3", "count": 3}}, {{"componentType": 5126, "type": "VEC3", "count": {scales}}}],
               "nodes": [{{"extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{"TRANSLATION": 0, "SCALE": 1}}}}}}}}]"#
        )
    };
    assert!(open(&instancing(3)).is_ok());
    let text = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION: 3 elements, `SCALE` has 2";
    assert_eq!(fault(&instancing(2)), text);
}
