use crate::gltf::testing::Builder;
use crate::gltf::{Gltf, Limits, Warning};

/// Opens a document of members.
fn open(members: &str) -> Result<Gltf, String> {
    let text = format!(r#"{{"asset": {{"version": "2.0"}}, {members}}}"#);
    Gltf::open("a.gltf", text.into_bytes(), &Limits::default()).map_err(|error| error.to_string())
}

/// Messages about a document of members, without the name of the file.
fn faults(members: &str) -> Vec<String> {
    let message = open(members).expect_err("the document is valid");
    message.lines().map(|line| line.strip_prefix("a.gltf: ").unwrap().to_owned()).collect()
}

fn warnings(members: &str) -> Vec<String> {
    let gltf = open(members).unwrap_or_else(|error| panic!("{error}"));
    gltf.warnings.list().iter().map(Warning::to_string).collect()
}

/// A buffer of 2000 bytes and a buffer view of 1052 at byte 100.
const DATA: &str = r#""buffers": [{"byteLength": 2000, "uri": "a.bin"}],
                      "bufferViews": [{"buffer": 0, "byteOffset": 100, "byteLength": 1052}]"#;

/// An accessor in the buffer view.
fn accessor(members: &str) -> String {
    format!(r#"{DATA}, "accessors": [{{"bufferView": 0, {members}}}]"#)
}

#[test]
fn accessor_ranges_are_checked_to_the_byte() {
    let floats = |offset: u64, count: u64| {
        accessor(&format!(r#""byteOffset": {offset}, "componentType": 5126, "type": "VEC3", "count": {count}"#))
    };
    assert!(open(&floats(1040, 1)).is_ok() && open(&floats(0, 87)).is_ok());
    assert_eq!(faults(&floats(1020, 4)), ["/accessors/0: needs 48 bytes from byte 1020, bufferView 0 has 1052"]);
    assert_eq!(faults(&floats(1044, 1)), ["/accessors/0: needs 12 bytes from byte 1044, bufferView 0 has 1052"]);
    assert_eq!(faults(&floats(0, 88)), ["/accessors/0: needs 1056 bytes from byte 0, bufferView 0 has 1052"]);
    assert_eq!(faults(&floats(0, u64::MAX)).len(), 1);
    assert_eq!(faults(&floats(u64::MAX, 1)).len(), 1);
    assert_eq!(faults(&floats(0, 0)), ["/accessors/0/count: 0 is not a count of at least 1"]);
}

#[test]
fn buffer_views_are_inside_their_buffers() {
    let view =
        |members: &str| format!(r#""buffers": [{{"byteLength": 100, "uri": "a"}}], "bufferViews": [{{{members}}}]"#);
    assert!(open(&view(r#""buffer": 0, "byteOffset": 60, "byteLength": 40"#)).is_ok());
    let short = faults(&view(r#""buffer": 0, "byteOffset": 61, "byteLength": 40"#));
    assert_eq!(short, ["/bufferViews/0: needs 40 bytes from byte 61, buffer 0 has 100"]);
    let overflow = faults(&view(r#""buffer": 0, "byteOffset": 18446744073709551615, "byteLength": 2"#));
    assert_eq!(overflow, ["/bufferViews/0: needs 2 bytes from byte 18446744073709551615, buffer 0 has 100"]);
    let missing = faults(&view(r#""buffer": 1, "byteLength": 40"#));
    assert_eq!(missing, ["/bufferViews/0/buffer: buffer 1 does not exist, there are 1"]);
    for (stride, is_valid) in [(4, true), (252, true), (0, false), (2, false), (6, false), (256, false)] {
        let members = view(&format!(r#""buffer": 0, "byteLength": 40, "byteStride": {stride}"#));
        assert_eq!(open(&members).is_ok(), is_valid, "{stride}");
    }
}

#[test]
fn strides_hold_an_element() {
    let members = |stride: u32, count: u32| {
        format!(
            r#""buffers": [{{"byteLength": 40, "uri": "a"}}],
               "bufferViews": [{{"buffer": 0, "byteLength": 40, "byteStride": {stride}}}],
               "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": {count}}}]"#
        )
    };
    // The last element needs no stride.
    assert!(open(&members(28, 2)).is_ok() && open(&members(12, 3)).is_ok());
    assert_eq!(faults(&members(32, 2)), ["/accessors/0: needs 44 bytes from byte 0, bufferView 0 has 40"]);
    assert_eq!(faults(&members(8, 2)), ["/accessors/0: an element has 12 bytes, bufferView 0 has a stride of 8"]);
}

#[test]
fn the_first_buffer_may_be_the_bin_chunk() {
    let mut file = Builder::default();
    file.view(&[0; 8], "");
    assert!(file.open().is_ok());
    assert_eq!(
        faults(r#""buffers": [{"byteLength": 8}], "bufferViews": [{"buffer": 0, "byteLength": 8}]"#),
        ["/buffers/0: has no `uri`, and the file has no BIN chunk"]
    );
    let unused = r#""buffers": [{"byteLength": 8, "uri": "a"}, {"byteLength": 8}]"#;
    assert_eq!(warnings(unused), ["/buffers/1: has no `uri` and no use; it is not read"]);
    let second = faults(&format!(r#"{unused}, "bufferViews": [{{"buffer": 1, "byteLength": 8}}]"#));
    assert_eq!(second, ["/buffers/1: has no `uri`; only the first buffer may be the BIN chunk"]);
    let json = r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 9}]}"#;
    let short = Gltf::open("a.glb", crate::gltf::testing::glb(json, &[0; 8]), &Limits::default());
    assert_eq!(short.unwrap_err().to_string(), "a.glb: /buffers/0: needs 9 bytes, the BIN chunk has 8");
}

#[test]
fn unsupported_versions_and_extensions_are_rejected() {
    let open = |text: &str| Gltf::open("a.gltf", text.as_bytes().to_vec(), &Limits::default());
    let version = |version: &str| open(&format!(r#"{{"asset": {{"version": "{version}"}}}}"#));
    assert!(version("2.0").is_ok() && version("2.1").is_ok());
    assert_eq!(version("1.0").unwrap_err().to_string(), "a.gltf: /asset/version: glTF 1.0; convert it first");
    for other in ["3.0", "2", "2.x", "", "02.0"] {
        let text = format!("a.gltf: /asset/version: version `{other}` cannot be read, expected 2.0");
        assert_eq!(version(other).unwrap_err().to_string(), text);
    }
    let required = faults(r#""extensionsRequired": ["KHR_materials_ior", "KHR_gaussian_splatting"]"#);
    assert_eq!(required, ["/extensionsRequired/1: `KHR_gaussian_splatting` cannot be read"]);
    let used = warnings(r#""extensionsUsed": ["KHR_materials_ior", "MY_ext", "MSFT_lod"]"#);
    let texts = [
        "/extensionsUsed/1: `MY_ext` is not known and has no effect",
        "/extensionsUsed/2: `MSFT_lod` is ignored: the finest level of detail is rendered",
    ];
    assert_eq!(used, texts);
}

#[test]
fn nodes_are_trees() {
    assert!(open(r#""nodes": [{"children": [1, 2]}, {}, {"children": [3]}, {}], "scenes": [{"nodes": [0]}]"#).is_ok());
    let cycle = r#""nodes": [{}, {}, {"children": [4]}, {}, {"children": [3, 2]}]"#;
    assert_eq!(faults(cycle), ["/nodes/4/children/1: node 2 is its own ancestor (2 -> 4 -> 2)"]);
    let longer = r#""nodes": [{"children": [3]}, {"children": [0]}, {"children": [1]}, {"children": [2]}]"#;
    assert_eq!(faults(longer), ["/nodes/1/children/0: node 0 is its own ancestor (0 -> 3 -> 2 -> 1 -> 0)"]);
    assert_eq!(faults(r#""nodes": [{"children": [0]}]"#), ["/nodes/0/children/0: node 0 is its own ancestor (0 -> 0)"]);
    let shared = faults(r#""nodes": [{"children": [2]}, {"children": [2]}, {}]"#);
    assert_eq!(shared, ["/nodes/1/children/0: node 2 is a child of node 0 already"]);
    let root = warnings(r#""nodes": [{"children": [1]}, {}], "scenes": [{"nodes": [0, 1]}]"#);
    let text = "it is shown once, with the transforms of its ancestors";
    assert_eq!(root, [format!("/scenes/0/nodes/1: node 1 is a child of node 0; {text}")]);
    let twice = faults(r#""nodes": [{}], "scenes": [{"nodes": [0, 0]}]"#);
    assert_eq!(twice, ["/scenes/0/nodes/1: 0 stands twice in the list"]);
    let missing = faults(r#""nodes": [{"children": [1]}], "scenes": [{"nodes": [1]}], "scene": 1"#);
    assert_eq!(missing.len(), 3, "{missing:?}");
}

#[test]
fn long_cycles_are_cut() {
    let nodes: Vec<String> = (0..50).map(|node| format!(r#"{{"children": [{}]}}"#, (node + 1) % 50)).collect();
    let text = faults(&format!(r#""nodes": [{}]"#, nodes.join(", ")));
    let expected =
        "/nodes/49/children/0: node 0 is its own ancestor (0 -> 1 -> 2 -> 3 -> 4 -> 5 -> 6 -> 7 -> 8 -> ... -> 0)";
    assert_eq!(text, [expected]);
}

#[test]
fn deep_trees_are_walked_without_recursion() {
    let chain = |length: usize| {
        let nodes: Vec<String> = (1..length).map(|child| format!(r#"{{"children": [{child}]}}"#)).collect();
        format!(r#""nodes": [{}, {{}}]"#, nodes.join(", "))
    };
    assert!(open(&chain(10_000)).is_ok());
    assert_eq!(faults(&chain(100_000)), ["/nodes/10000: has more than 10000 ancestors, the limit"]);
}

/// Members of a file, each with an index that does not exist and its place.
const WRONG_INDICES: &[(&str, &str)] = &[
    (r#""scene": 0"#, "/scene"),
    (r#""nodes": [{"mesh": 0}]"#, "/nodes/0/mesh"),
    (r#""nodes": [{"camera": 0}]"#, "/nodes/0/camera"),
    (r#""nodes": [{"skin": 0}]"#, "/nodes/0/skin"),
    (r#""nodes": [{"children": [1]}]"#, "/nodes/0/children/0"),
    (
        r#""nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}]"#,
        "/nodes/0/extensions/KHR_lights_punctual/light",
    ),
    (r#""nodes": [{"extensions": {"EXT_lights_ies": {"light": 0}}}]"#, "/nodes/0/extensions/EXT_lights_ies/light"),
    (
        r#""nodes": [{"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": 0}}}}]"#,
        "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE",
    ),
    (r#""scenes": [{"nodes": [0]}]"#, "/scenes/0/nodes/0"),
    (
        r#""scenes": [{"extensions": {"EXT_lights_image_based": {"light": 0}}}]"#,
        "/scenes/0/extensions/EXT_lights_image_based/light",
    ),
    (r#""textures": [{"source": 0}]"#, "/textures/0/source"),
    (r#""textures": [{"sampler": 0}]"#, "/textures/0/sampler"),
    (
        r#""textures": [{"extensions": {"KHR_texture_basisu": {"source": 0}}}]"#,
        "/textures/0/extensions/KHR_texture_basisu/source",
    ),
    (
        r#""textures": [{"extensions": {"EXT_texture_webp": {"source": 0}}}]"#,
        "/textures/0/extensions/EXT_texture_webp/source",
    ),
    (r#""images": [{"bufferView": 0}]"#, "/images/0/bufferView"),
    (r#""materials": [{"normalTexture": {"index": 0}}]"#, "/materials/0/normalTexture/index"),
    (r#""materials": [{"occlusionTexture": {"index": 0}}]"#, "/materials/0/occlusionTexture/index"),
    (r#""materials": [{"emissiveTexture": {"index": 0}}]"#, "/materials/0/emissiveTexture/index"),
    (
        r#""materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]"#,
        "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
    ),
    (r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]"#, "/meshes/0/primitives/0/attributes/POSITION"),
    (r#""meshes": [{"primitives": [{"attributes": {}, "indices": 0}]}]"#, "/meshes/0/primitives/0/indices"),
    (r#""meshes": [{"primitives": [{"attributes": {}, "material": 0}]}]"#, "/meshes/0/primitives/0/material"),
    (
        r#""meshes": [{"primitives": [{"attributes": {}, "targets": [{"NORMAL": 0}]}]}]"#,
        "/meshes/0/primitives/0/targets/0/NORMAL",
    ),
    (
        r#""meshes": [{"primitives": [{"attributes": {}, "extensions": {"KHR_draco_mesh_compression":
               {"bufferView": 0, "attributes": {}}}}]}]"#,
        "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView",
    ),
    (r#""skins": [{"joints": [0]}]"#, "/skins/0/joints/0"),
    (r#""nodes": [{}], "skins": [{"joints": [0], "skeleton": 1}]"#, "/skins/0/skeleton"),
    (r#""nodes": [{}], "skins": [{"joints": [0], "inverseBindMatrices": 0}]"#, "/skins/0/inverseBindMatrices"),
    (
        r#""animations": [{"samplers": [], "channels": [{"sampler": 0, "target": {"path": "scale"}}]}]"#,
        "/animations/0/channels/0/sampler",
    ),
    (
        r#""extensions": {"EXT_lights_ies": {"lights": [{"bufferView": 0}]}}"#,
        "/extensions/EXT_lights_ies/lights/0/bufferView",
    ),
    (
        r#""accessors": [{"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}]"#,
        "/accessors/0/bufferView",
    ),
];

#[test]
fn every_index_is_checked() {
    for (members, pointer) in WRONG_INDICES {
        let found = faults(members);
        assert_eq!(found.len(), 1, "{members}: {found:?}");
        let expected = format!("{pointer}: ");
        assert!(found[0].starts_with(&expected) && found[0].contains("does not exist, there are"), "{found:?}");
    }
}

#[test]
fn references_to_variants_and_samplers_are_checked() {
    let variants = |variant: u32, material: u32| {
        let mapping = format!(r#"{{"variants": [0, {variant}], "material": {material}}}"#);
        format!(
            r#""materials": [{{}}], "extensions": {{"KHR_materials_variants": {{"variants": [{{"name": "a"}}, {{"name": "b"}}]}}}},
               "meshes": [{{"primitives": [{{"attributes": {{}}, "extensions":
               {{"KHR_materials_variants": {{"mappings": [{mapping}]}}}}}}]}}]"#
        )
    };
    assert!(open(&variants(1, 0)).is_ok());
    let at = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0";
    assert_eq!(faults(&variants(2, 0)), [format!("{at}/variants/1: variant 2 does not exist, there are 2")]);
    assert_eq!(faults(&variants(1, 1)), [format!("{at}/material: material 1 does not exist, there are 1")]);
}

#[test]
fn all_faults_are_found_at_once_up_to_a_limit() {
    let nodes: Vec<String> = (0..300).map(|node| format!(r#"{{"mesh": {node}}}"#)).collect();
    let found = faults(&format!(r#""nodes": [{}], "scene": 7"#, nodes.join(", ")));
    assert_eq!((found.len(), found[200].as_str()), (201, "101 further errors"));
}
