use super::Document;

fn document(members: &str) -> Document {
    let text = format!(r#"{{"asset": {{"version": "2.0"}}, {members}}}"#);
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Properties of an object and values that differ from their defaults. `#` is the object's place in
/// the document.
type Properties = (&'static str, &'static [(&'static str, &'static str)]);

const TEXTURE: &str = r#"{"index": 3}"#;
const UNIT: &str = "0.375";
const COLOR: &str = "[0.1, 0.2, 0.3]";
const RGBA: &str = "[0.1, 0.2, 0.3, 0.4]";

const MATERIALS: [Properties; 14] = [
    (
        r#""materials": [{#}]"#,
        &[
            ("normalTexture", TEXTURE),
            ("occlusionTexture", TEXTURE),
            ("emissiveTexture", TEXTURE),
            ("emissiveFactor", COLOR),
            ("alphaMode", r#""MASK""#),
            ("alphaCutoff", UNIT),
            ("doubleSided", "true"),
            ("name", r#""a""#),
        ],
    ),
    (
        r#""materials": [{"pbrMetallicRoughness": {#}}]"#,
        &[
            ("baseColorFactor", RGBA),
            ("baseColorTexture", TEXTURE),
            ("metallicFactor", UNIT),
            ("roughnessFactor", UNIT),
            ("metallicRoughnessTexture", TEXTURE),
        ],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_anisotropy": {#}}}]"#,
        &[("anisotropyStrength", UNIT), ("anisotropyRotation", UNIT), ("anisotropyTexture", TEXTURE)],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_clearcoat": {#}}}]"#,
        &[
            ("clearcoatFactor", UNIT),
            ("clearcoatTexture", TEXTURE),
            ("clearcoatRoughnessFactor", UNIT),
            ("clearcoatRoughnessTexture", TEXTURE),
            ("clearcoatNormalTexture", TEXTURE),
        ],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_diffuse_transmission": {#}}}]"#,
        &[
            ("diffuseTransmissionFactor", UNIT),
            ("diffuseTransmissionTexture", TEXTURE),
            ("diffuseTransmissionColorFactor", COLOR),
            ("diffuseTransmissionColorTexture", TEXTURE),
        ],
    ),
    (r#""materials": [{"extensions": {"KHR_materials_dispersion": {#}}}]"#, &[("dispersion", UNIT)]),
    (r#""materials": [{"extensions": {"KHR_materials_emissive_strength": {#}}}]"#, &[("emissiveStrength", UNIT)]),
    (r#""materials": [{"extensions": {"KHR_materials_ior": {#}}}]"#, &[("ior", "1.25")]),
    (
        r#""materials": [{"extensions": {"KHR_materials_iridescence": {#}}}]"#,
        &[
            ("iridescenceFactor", UNIT),
            ("iridescenceTexture", TEXTURE),
            ("iridescenceIor", "1.25"),
            ("iridescenceThicknessMinimum", UNIT),
            ("iridescenceThicknessMaximum", UNIT),
            ("iridescenceThicknessTexture", TEXTURE),
        ],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_sheen": {#}}}]"#,
        &[
            ("sheenColorFactor", COLOR),
            ("sheenColorTexture", TEXTURE),
            ("sheenRoughnessFactor", UNIT),
            ("sheenRoughnessTexture", TEXTURE),
        ],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_specular": {#}}}]"#,
        &[
            ("specularFactor", UNIT),
            ("specularTexture", TEXTURE),
            ("specularColorFactor", COLOR),
            ("specularColorTexture", TEXTURE),
        ],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_transmission": {#}}}]"#,
        &[("transmissionFactor", UNIT), ("transmissionTexture", TEXTURE)],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_volume": {#}}}]"#,
        &[
            ("thicknessFactor", UNIT),
            ("thicknessTexture", TEXTURE),
            ("attenuationDistance", UNIT),
            ("attenuationColor", COLOR),
        ],
    ),
    (
        r#""materials": [{"extensions": {"KHR_materials_pbrSpecularGlossiness": {#}}}]"#,
        &[
            ("diffuseFactor", RGBA),
            ("diffuseTexture", TEXTURE),
            ("specularFactor", COLOR),
            ("glossinessFactor", UNIT),
            ("specularGlossinessTexture", TEXTURE),
        ],
    ),
];

const OTHERS: [Properties; 26] = [
    (
        r##""x": 0, #"##,
        &[
            ("scene", "3"),
            ("extensionsUsed", r#"["a"]"#),
            ("extensionsRequired", r#"["a"]"#),
            ("extensions", r#"{"KHR_materials_variants": {"variants": [{"name": "a"}]}}"#),
        ],
    ),
    (
        r#""accessors": [{"componentType": 5126, "count": 2, "type": "VEC2", #}]"#,
        &[
            ("bufferView", "3"),
            ("byteOffset", "8"),
            ("normalized", "true"),
            ("min", "[1, 2]"),
            ("max", "[1, 2]"),
            (
                "sparse",
                r#"{"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}"#,
            ),
        ],
    ),
    (
        r#""accessors": [{"componentType": 5126, "count": 2, "type": "VEC2", "sparse": {"count": 1,
           "indices": {"bufferView": 1, "componentType": 5121, #}, "values": {"bufferView": 2}}}]"#,
        &[("byteOffset", "8")],
    ),
    (
        r#""accessors": [{"componentType": 5126, "count": 2, "type": "VEC2", "sparse": {"count": 1,
           "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2, #}}}]"#,
        &[("byteOffset", "8")],
    ),
    (
        r#""buffers": [{"byteLength": 3, #}]"#,
        &[
            ("uri", r#""a""#),
            ("extensions", r#"{"EXT_meshopt_compression": {"fallback": true}}"#),
            ("extensions", r#"{"KHR_meshopt_compression": {"fallback": true}}"#),
        ],
    ),
    (
        r#""bufferViews": [{"buffer": 0, "byteLength": 3, #}]"#,
        &[
            ("byteOffset", "8"),
            ("byteStride", "8"),
            ("target", "34962"),
            (
                "extensions",
                r#"{"EXT_meshopt_compression": {"buffer": 1, "byteLength": 2, "byteStride": 4, "count": 3, "mode": "INDICES"}}"#,
            ),
        ],
    ),
    (
        r#""bufferViews": [{"buffer": 0, "byteLength": 3, "extensions": {"KHR_meshopt_compression": {"buffer": 1,
           "byteLength": 2, "byteStride": 4, "count": 3, "mode": "ATTRIBUTES", #}}}]"#,
        &[("byteOffset", "8"), ("filter", r#""COLOR""#)],
    ),
    (
        r#""meshes": [{"primitives": [{"attributes": {}, #}]}]"#,
        &[
            ("indices", "3"),
            ("material", "3"),
            ("mode", "3"),
            ("targets", r#"[{"POSITION": 3}]"#),
            ("extensions", r#"{"KHR_draco_mesh_compression": {"bufferView": 3, "attributes": {"POSITION": 1}}}"#),
            ("extensions", r#"{"KHR_materials_variants": {"mappings": [{"variants": [1], "material": 2}]}}"#),
        ],
    ),
    (r#""meshes": [{"primitives": [], #}]"#, &[("weights", "[1]"), ("name", r#""a""#)]),
    (
        r#""nodes": [{#}]"#,
        &[
            ("camera", "3"),
            ("children", "[3]"),
            ("mesh", "3"),
            ("skin", "3"),
            ("matrix", "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]"),
            ("rotation", RGBA),
            ("scale", COLOR),
            ("translation", COLOR),
            ("weights", "[1]"),
            ("name", r#""a""#),
            ("extensions", r#"{"KHR_lights_punctual": {"light": 3}}"#),
            ("extensions", r#"{"KHR_node_visibility": {"visible": false}}"#),
            ("extensions", r#"{"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": 3}}}"#),
            ("extensions", r#"{"EXT_lights_ies": {"light": 3}}"#),
        ],
    ),
    (r#""nodes": [{"extensions": {"EXT_lights_ies": {"light": 0, #}}}]"#, &[("multiplier", UNIT), ("color", COLOR)]),
    (
        r#""scenes": [{#}]"#,
        &[("nodes", "[3]"), ("name", r#""a""#), ("extensions", r#"{"EXT_lights_image_based": {"light": 3}}"#)],
    ),
    (r#""images": [{#}]"#, &[("uri", r#""a""#), ("mimeType", r#""a""#), ("bufferView", "3"), ("name", r#""a""#)]),
    (
        r#""textures": [{#}]"#,
        &[
            ("sampler", "3"),
            ("source", "3"),
            ("extensions", r#"{"KHR_texture_basisu": {"source": 3}}"#),
            ("extensions", r#"{"EXT_texture_webp": {"source": 3}}"#),
        ],
    ),
    (r#""samplers": [{#}]"#, &[("magFilter", "9728"), ("minFilter", "9987"), ("wrapS", "33071"), ("wrapT", "33648")]),
    (
        r#""materials": [{"normalTexture": {"index": 0, #}}]"#,
        &[("texCoord", "1"), ("scale", UNIT), ("strength", UNIT), ("extensions", r#"{"KHR_texture_transform": {}}"#)],
    ),
    (
        r#""materials": [{"normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": {#}}}}]"#,
        &[("offset", "[1, 2]"), ("rotation", "1"), ("scale", "[2, 3]"), ("texCoord", "1")],
    ),
    (r#""materials": [{"extensions": {#}}]"#, &[("KHR_materials_unlit", "{}")]),
    (
        r#""cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1, #}}]"#,
        &[("aspectRatio", "2"), ("zfar", "3")],
    ),
    (
        r#""cameras": [{"type": "orthographic", #}]"#,
        &[("orthographic", r#"{"xmag": 1, "ymag": 2, "znear": 3, "zfar": 4}"#), ("name", r#""a""#)],
    ),
    (r#""skins": [{"joints": [1], #}]"#, &[("inverseBindMatrices", "3"), ("skeleton", "3"), ("name", r#""a""#)]),
    (
        r#""animations": [{"samplers": [{"input": 0, "output": 1, #}], "channels": []}]"#,
        &[("interpolation", r#""CUBICSPLINE""#)],
    ),
    (
        r#""animations": [{"samplers": [], "channels": [{"sampler": 0, "target": {"path": "pointer", #}}]}]"#,
        &[("node", "3"), ("extensions", r#"{"KHR_animation_pointer": {"pointer": "/a"}}"#)],
    ),
    (
        r#""extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", #}]}}"#,
        &[
            ("color", COLOR),
            ("intensity", UNIT),
            ("range", UNIT),
            ("spot", r#"{"innerConeAngle": 0.1}"#),
            ("spot", r#"{"outerConeAngle": 0.1}"#),
            ("name", r#""a""#),
        ],
    ),
    (
        r#""extensions": {"EXT_lights_image_based": {"lights": [{"specularImages": [[1, 2, 3, 4, 5, 6]], "specularImageSize": 4,
           "irradianceCoefficients": [[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]], #}]}}"#,
        &[("rotation", RGBA), ("intensity", UNIT), ("name", r#""a""#)],
    ),
    (
        r#""extensions": {"EXT_lights_ies": {"lights": [{#}]}}"#,
        &[("uri", r#""a""#), ("mimeType", r#""a""#), ("bufferView", "3"), ("name", r#""a""#)],
    ),
];

/// A property under a wrong name would be ignored.
#[test]
fn every_property_is_read() {
    for (template, properties) in MATERIALS.iter().chain(&OTHERS) {
        let without = document(&template.replace(", #", "").replace('#', ""));
        let values =
            properties.iter().map(|(key, value)| document(&template.replace('#', &format!("\"{key}\": {value}"))));
        for ((key, value), with) in properties.iter().zip(values) {
            assert_ne!(with, without, "{template}: {key}: {value}");
        }
    }
}

#[test]
fn unknown_properties_are_ignored() {
    let known = document(r#""nodes": [{"mesh": 1}]"#);
    let text =
        r#""nodes": [{"mesh": 1, "extras": {"a": [1, null]}, "extensions": {"MY_ext": 7}, "other": true}], "more": []"#;
    let mut unknown = document(text);
    unknown.nodes[0].extensions = None;
    assert_eq!(unknown, known);
}

#[test]
fn texture_transforms_may_override_the_uv_set() {
    let set = |info: &str| {
        let document = document(&format!(r#""materials": [{{"normalTexture": {info}}}]"#));
        document.materials[0].normal_texture.as_ref().unwrap().set().get()
    };
    assert_eq!(set(r#"{"index": 0, "texCoord": 1}"#), 1);
    assert_eq!(set(r#"{"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {}}}"#), 1);
    assert_eq!(set(r#"{"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"texCoord": 2}}}"#), 2);
}
