//! Tests of the translation of materials.

use super::*;
use crate::gltf::testing::Builder;
use juggler_material::{Principled, SurfaceSides};
use juggler_math::Rgb;
use juggler_texture::{Channel, ColorSpace, Filter, Image, Input, Mix, MixMode, Wrap};
use std::collections::BTreeMap;

mod coats;
mod sides;

const LIT: PrimitiveSurface = PrimitiveSurface { has_color: false, is_lit: true };
const COLORED: PrimitiveSurface = PrimitiveSurface { has_color: true, is_lit: true };
const UNLIT: PrimitiveSurface = PrimitiveSurface { has_color: false, is_lit: false };

/// File of a material, with two images, three samplers and four textures.
fn file(material: &str) -> GltfData {
    let mut builder = Builder::default();
    let view = builder.view(b"\x89PNG", "");
    builder.member(format!(r#""images": [{{"bufferView": {view}, "name": "Wood"}}, {{"bufferView": {view}}}]"#));
    builder.member(r#""samplers": [{}, {"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}, {"minFilter": 9729}]"#);
    builder.member(
        r#""textures": [{"source": 0}, {"source": 0, "sampler": 1}, {"source": 1, "sampler": 2},
            {"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}]"#,
    );
    builder.member(format!(r#""materials": [{material}]"#));
    let mut data = builder.load();
    data.load_media(&BTreeMap::new(), &juggler_math::BuildControl::new()).unwrap();
    data
}

fn parts(material: &str, surface: &PrimitiveSurface) -> MaterialParts {
    let data = file(material);
    let mut set = MaterialSet::new(&data.gltf.document, &data, "m/");
    set.material(Some(0), surface).unwrap();
    set.finish()
}

/// The only material of the parts.
fn only(parts: &MaterialParts) -> &AnyMaterial {
    assert_eq!(parts.materials.len(), 1);
    &parts.materials[0]
}

fn principled(parts: &MaterialParts) -> Principled {
    match only(parts) {
        AnyMaterial::Principled(material) => material.clone(),
        other => panic!("{other:?}"),
    }
}

/// Material with these extensions.
fn extended(extensions: &str) -> MaterialParts {
    parts(&format!(r#"{{"doubleSided": true, "extensions": {{{extensions}}}}}"#), &LIT)
}

fn image(parts: &MaterialParts, input: &Input<f32>) -> Image {
    match input {
        Input::Texture(name) => image_named(parts, name),
        other => panic!("{other:?}"),
    }
}

fn image_named(parts: &MaterialParts, name: &str) -> Image {
    match &parts.textures[name] {
        AnyTexture::Image(image) => image.clone(),
        other => panic!("{other:?}"),
    }
}

fn color_name(input: &Input<Rgb>) -> &str {
    match input {
        Input::Texture(name) => name,
        other => panic!("{other:?}"),
    }
}

fn mix(parts: &MaterialParts, name: &str) -> Mix {
    match &parts.textures[name] {
        AnyTexture::Mix(mix) => mix.clone(),
        other => panic!("{other:?}"),
    }
}

fn texts(parts: &MaterialParts) -> Vec<String> {
    parts.warnings.list().iter().map(|warning| warning.fault.message.clone()).collect()
}

#[test]
fn default_material_is_white_rough_metal() {
    let data = file("{}");
    let mut set = MaterialSet::new(&data.gltf.document, &data, "m/");
    assert_eq!(set.material(None, &LIT).unwrap(), "m/default material");
    let parts = set.finish();
    let expected = Principled {
        base_color: Rgb::WHITE.into(),
        metallic: 1.0.into(),
        roughness: 1.0.into(),
        sides: SurfaceSides::Front,
        ..Principled::default()
    };
    assert_eq!(principled(&parts), expected);
}

#[test]
fn names_are_unique_and_equal_uses_share_a_material() {
    let data = file(r#"{"name": "Oak"}, {"name": "Oak"}, {}"#);
    let mut set = MaterialSet::new(&data.gltf.document, &data, "m/");
    let names = [Some(0), Some(1), Some(2), Some(0)].map(|index| set.material(index, &LIT).unwrap());
    assert_eq!(names, ["m/Oak", "m/Oak#2", "m/material 2", "m/Oak"]);
    assert_eq!(set.material(Some(0), &COLORED).unwrap(), "m/Oak with colors");
    assert_eq!(set.finish().materials.len(), 4);
}

#[test]
fn factors_multiply_textures_of_their_channels() {
    let parts = parts(
        r#"{"doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1],
            "baseColorTexture": {"index": 0}, "metallicFactor": 0.5, "roughnessFactor": 0.25,
            "metallicRoughnessTexture": {"index": 1}}, "emissiveFactor": [0.5, 0.5, 0.5],
            "emissiveTexture": {"index": 0}}"#,
        &LIT,
    );
    let material = principled(&parts);
    let Input::Product(product) = &material.base_color else { panic!("{:?}", material.base_color) };
    assert_eq!((product.factor, &product.attribute), (Some(Rgb::new(1.0, 0.5, 0.25)), &None));
    let base = image_named(&parts, product.texture_name().unwrap());
    assert_eq!((base.color_space, base.channel, base.factor), (ColorSpace::Srgb, Channel::Rgb, 1.0));
    assert_eq!((base.file.as_str(), base.wrap, base.filter), ("m/images/0.png", Wrap::Repeat, Filter::Trilinear));
    let metallic = image(&parts, &material.metallic);
    assert_eq!((metallic.color_space, metallic.channel, metallic.factor), (ColorSpace::Linear, Channel::B, 0.5));
    assert_eq!((metallic.wrap, metallic.wrap_v, metallic.filter), (Wrap::Clamp, Some(Wrap::Mirror), Filter::Nearest));
    let roughness = image(&parts, &material.roughness);
    assert_eq!((roughness.channel, roughness.factor), (Channel::G, 0.25));
    assert_eq!(image_named(&parts, color_name(&material.emissive)).factor, 0.5);
    assert_eq!(parts.assets.keys().collect::<Vec<_>>(), ["m/images/0.png"]);
    assert!(texts(&parts).is_empty(), "{:?}", texts(&parts));
}

#[test]
fn equal_textures_are_added_once_and_webp_comes_first() {
    let parts = parts(
        r#"{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, {}"#,
        &LIT,
    );
    assert_eq!(parts.textures.keys().collect::<Vec<_>>(), ["m/Wood"]);
    let parts = self::parts(r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 3}}}"#, &LIT);
    assert_eq!(image_named(&parts, "m/image 1").file, "m/images/1.png");
}

#[test]
fn texture_transforms_become_matrices_with_v_upwards() {
    let parts = parts(
        r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 3, "extensions":
            {"KHR_texture_transform": {"offset": [0.1, 0.2], "scale": [2, 3], "texCoord": 1,
            "rotation": 1.5707963267948966}}}}}"#,
        &LIT,
    );
    let mapping = image_named(&parts, "m/Wood").mapping;
    assert_eq!(mapping.uv_set, 1);
    // u' = ox + sy v, v' = oy - sx u with v downwards.
    let expected = [0.0, -3.0, 3.1, 2.0, 0.0, 0.8];
    let found = mapping.matrix.unwrap();
    assert!(found.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-6), "{found:?}");
    for u in [[0.0, 0.0], [1.0, 0.0], [0.3, 0.7]] {
        let [a, b, c, d, e, f] = found.map(f64::from);
        let up = [a * u[0] + b * (1.0 - u[1]) + c, d * u[0] + e * (1.0 - u[1]) + f];
        let down: [f64; 2] = [0.1 + 3.0 * u[1], 0.2 - 2.0 * u[0]];
        assert!((up[0] - down[0]).abs() < 1e-6 && (1.0 - up[1] - down[1]).abs() < 1e-6, "{u:?} {up:?} {down:?}");
    }
}

#[test]
fn alpha_modes_decide_opacity() {
    let of = |mode: &str| {
        let base = r#""pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": {"index": 0}}"#;
        let parts = parts(&format!(r#"{{{mode}{base}}}"#), &LIT);
        let material = principled(&parts);
        let filter = matches!(material.opacity, Input::Texture(_)).then(|| image(&parts, &material.opacity));
        (material, filter.map(|image| (image.channel, image.factor, image.filter)))
    };
    let (opaque, image) = of("");
    assert_eq!((opaque.opacity, opaque.alpha_cutoff, image), (1.0.into(), None, None));
    let (mask, image) = of(r#""alphaMode": "MASK", "#);
    assert_eq!((mask.alpha_cutoff, image), (Some(0.5), Some((Channel::A, 0.5, Filter::Bilinear))));
    let (blend, image) = of(r#""alphaMode": "BLEND", "#);
    assert_eq!((blend.alpha_cutoff, image), (None, Some((Channel::A, 0.5, Filter::Trilinear))));
    let (hidden, _) = of(r#""alphaMode": "MASK", "alphaCutoff": 1.5, "#);
    assert_eq!((hidden.opacity, hidden.alpha_cutoff), (0.0.into(), None));
}

#[test]
fn vertex_colors_multiply_color_and_alpha() {
    let parts =
        parts(r#"{"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}"#, &COLORED);
    let material = principled(&parts);
    let color = serde_json::to_value(&material.base_color).unwrap();
    assert_eq!(color, serde_json::json!({"attribute": "color"}));
    let opacity = serde_json::to_value(&material.opacity).unwrap();
    assert_eq!(opacity, serde_json::json!({"factor": 0.5, "attribute": "color"}));
    assert!(parts.textures.is_empty());
}

#[test]
fn layers_take_the_values_of_their_extensions() {
    let parts = extended(
        r#""KHR_materials_ior": {"ior": 1.4}, "KHR_materials_emissive_strength": {"emissiveStrength": 7},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": {"index": 0},
            "specularColorFactor": [2, 1, 1]},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatTexture": {"index": 0},
            "clearcoatRoughnessFactor": 0.3, "clearcoatRoughnessTexture": {"index": 0}},
        "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.6,
            "sheenRoughnessTexture": {"index": 0}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.9, "anisotropyRotation": 1.5707963267948966}"#,
    );
    let material = principled(&parts);
    let channel = |input| {
        let image = image(&parts, input);
        (image.channel, image.factor, image.color_space)
    };
    assert_eq!((material.ior, material.emissive_strength), (1.4, 7.0));
    assert_eq!(channel(&material.specular), (Channel::A, 0.5, ColorSpace::Linear));
    assert_eq!(material.specular_color, Rgb::new(2.0, 1.0, 1.0).into());
    assert_eq!(channel(&material.clearcoat), (Channel::R, 0.8, ColorSpace::Linear));
    assert_eq!(channel(&material.clearcoat_roughness), (Channel::G, 0.3, ColorSpace::Linear));
    assert_eq!(material.clearcoat_ior, 1.5);
    assert_eq!(material.sheen_color, Rgb::new(0.1, 0.2, 0.3).into());
    assert_eq!(channel(&material.sheen_roughness), (Channel::A, 0.6, ColorSpace::Linear));
    assert_eq!((material.anisotropy, material.anisotropy_rotation), (0.9.into(), 0.25.into()));
}

#[test]
fn directions_of_anisotropy_come_from_its_texture() {
    let parts = extended(
        r#""KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 0},
            "anisotropyRotation": 1.5707963267948966}"#,
    );
    let material = principled(&parts);
    assert_eq!(image(&parts, &material.anisotropy).channel, Channel::B);
    let Input::Texture(name) = &material.anisotropy_rotation else { panic!("{:?}", material.anisotropy_rotation) };
    let AnyTexture::Direction(direction) = &parts.textures[name] else { panic!("{:?}", parts.textures[name]) };
    assert_eq!(direction.turns, 0.25);
    let image = image_named(&parts, color_name(&direction.of));
    assert_eq!((image.channel, image.color_space), (Channel::Rgb, ColorSpace::Linear));
    assert!(texts(&parts).is_empty(), "{:?}", texts(&parts));
}

#[test]
fn film_thickness_runs_from_minimum_to_maximum() {
    let film = |texture: &str| {
        extended(&format!(
            r#""KHR_materials_iridescence": {{"iridescenceFactor": 1, "iridescenceThicknessMinimum": 200,
            "iridescenceThicknessMaximum": 600{texture}}}"#
        ))
    };
    let plain = principled(&film(""));
    assert_eq!((plain.iridescence, plain.iridescence_ior), (1.0.into(), 1.3));
    assert_eq!(plain.iridescence_thickness, 600.0.into());
    let parts = film(r#", "iridescenceThicknessTexture": {"index": 0}"#);
    let Input::Texture(name) = principled(&parts).iridescence_thickness else { panic!("a texture") };
    let range = mix(&parts, &name);
    assert_eq!((range.a, range.b), (Rgb::splat(200.0).into(), Rgb::splat(600.0).into()));
    assert_eq!(image(&parts, &range.amount).channel, Channel::G);
}

#[test]
fn glass_is_thin_without_thickness() {
    let glass = r#""KHR_materials_transmission": {"transmissionFactor": 0.75}"#;
    let thin = principled(&extended(glass));
    assert_eq!((thin.transmission, thin.thin), (0.75.into(), true));
    let volume = |thickness: &str| {
        principled(&extended(&format!(
            r#"{glass}, "KHR_materials_volume": {{"thicknessFactor": {thickness}, "attenuationDistance": 2,
            "attenuationColor": [0.5, 1, 0]}}"#
        )))
    };
    assert!(volume("0").thin && volume("0").medium.is_clear());
    let solid = volume("0.1");
    assert_eq!((solid.thin, solid.medium.distance), (false, 2.0));
    assert_eq!(solid.medium.color, Rgb::new(0.5, 1.0, 0.0));
    let leaf = extended(
        r#""KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5,
        "diffuseTransmissionTexture": {"index": 0}, "diffuseTransmissionColorFactor": [0, 1, 0]}"#,
    );
    let material = principled(&leaf);
    assert_eq!(image(&leaf, &material.diffuse_transmission).channel, Channel::A);
    assert_eq!((material.diffuse_transmission_color, material.thin), (Rgb::new(0.0, 1.0, 0.0).into(), true));
}

#[test]
fn specular_and_glossiness_replace_metallic_and_roughness() {
    let model = r#""extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.2, 0.4, 0.6, 0.5],
        "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.75"#;
    let material = principled(&parts(&format!("{{{model}}}}}}}"), &LIT));
    assert_eq!(material.base_color, Rgb::new(0.2, 0.4, 0.6).into());
    assert_eq!((material.metallic.clone(), material.roughness.clone()), (0.0.into(), 0.25.into()));
    // Reflectance at normal incidence: ((ior - 1) / (ior + 1))² times the color.
    let Input::Value(color) = material.specular_color else { panic!("{:?}", material.specular_color) };
    let reflectance = ((material.ior - 1.0) / (material.ior + 1.0)).powi(2) * color.r;
    assert!((reflectance - 0.04).abs() < 1e-6, "{reflectance}");
    let stated = format!(r#"{{"pbrMetallicRoughness": {{"metallicFactor": 0.5}}, {model}}}}}}}"#);
    assert_eq!(principled(&parts(&stated, &LIT)), material, "the extension wins over its fallback");
    let beside = format!(r#"{{{model}}}, "KHR_materials_specular": {{"specularFactor": 0.5}}}}}}"#);
    let beside = parts(&beside, &LIT);
    assert_eq!(principled(&beside), material, "the extension wins over KHR_materials_specular");
    let warning = "its KHR_materials_specular has no effect beside KHR_materials_pbrSpecularGlossiness";
    assert_eq!(texts(&beside), [warning]);
    let textured = parts(&format!(r#"{{{model}, "specularGlossinessTexture": {{"index": 0}}}}}}}}"#), &LIT);
    let Input::Texture(name) = principled(&textured).roughness else { panic!("a texture") };
    let range = mix(&textured, &name);
    assert_eq!((range.a, range.b), (Rgb::splat(1.0).into(), Rgb::splat(0.25).into()));
}

#[test]
fn normals_keep_their_scale_and_sign() {
    let normal = |scale: &str| {
        let text = format!(r#"{{"doubleSided": true, "normalTexture": {{"index": 0, "scale": {scale}}}}}"#);
        let parts = parts(&text, &LIT);
        match only(&parts) {
            AnyMaterial::NormalMap(map) => (map.strength.clone(), color_name(&map.texture).to_owned(), parts.clone()),
            other => panic!("{other:?}"),
        }
    };
    let (strength, name, parts) = normal("0.5");
    assert_eq!((strength, image_named(&parts, &name).color_space), (0.5.into(), ColorSpace::Linear));
    let (strength, name, parts) = normal("-2");
    assert_eq!((strength, mix(&parts, &name).mode), (2.0.into(), MixMode::Difference));
}

#[test]
fn tangents_are_needed_for_normal_maps_and_anisotropy() {
    let set = |material: &str| {
        let data = file(material);
        tangent_uv_set(&data.gltf.document, 0)
    };
    assert_eq!(set("{}"), None);
    assert_eq!(set(r#"{"normalTexture": {"index": 0, "texCoord": 1}}"#), Some(1));
    let anisotropy = r#"{"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}}"#;
    assert_eq!(set(anisotropy), Some(0));
    let coat =
        r#"{"extensions": {"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0, "texCoord": 1}}}}"#;
    assert_eq!(set(coat), Some(1));
}

#[test]
fn settings_without_effect_are_reported() {
    let parts = parts(r#"{"extensions": {"KHR_materials_dispersion": {"dispersion": 1}}}"#, &LIT);
    assert_eq!(texts(&parts), ["its dispersion has no effect, because it refracts no light"]);
}

#[test]
fn missing_pictures_are_errors_that_name_them() {
    let mut builder = Builder::default();
    builder.member(r#""images": [{"uri": "a.png"}], "textures": [{"source": 0}]"#);
    builder.member(r#""materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}]"#);
    let data = builder.load();
    let mut set = MaterialSet::new(&data.gltf.document, &data, "");
    let fault = set.material(Some(0), &LIT).unwrap_err();
    assert_eq!(fault.to_string(), "/images/0 (a.png): the picture has not been read");
}

#[cfg(not(feature = "ktx2"))]
#[test]
fn compressed_pictures_give_way_to_plain_ones_unless_required() {
    let file = |required: &str| {
        let mut builder = Builder::default();
        let views = [builder.view(b"\x89PNG", ""), builder.view(b"\xabKTX 20\xbb\r\n\x1a\n", "")];
        let [plain, compressed] = views;
        builder.member(format!(r#""images": [{{"bufferView": {plain}}}, {{"bufferView": {compressed}}}]"#));
        builder.member(r#""textures": [{"source": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}}]"#);
        builder.member(r#""materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}]"#);
        builder.member(format!(r#""extensionsUsed": ["KHR_texture_basisu"]{required}"#));
        let mut data = builder.load();
        data.load_media(&BTreeMap::new(), &juggler_math::BuildControl::new()).unwrap();
        data
    };
    let data = file("");
    let mut set = MaterialSet::new(&data.gltf.document, &data, "");
    set.material(Some(0), &LIT).unwrap();
    let parts = set.finish();
    assert_eq!(parts.assets.keys().collect::<Vec<_>>(), ["images/0.png"]);
    assert!(texts(&parts)[0].contains("feature `ktx2`"), "{:?}", texts(&parts));
    let data = file(r#", "extensionsRequired": ["KHR_texture_basisu"]"#);
    let fault = MaterialSet::new(&data.gltf.document, &data, "").material(Some(0), &LIT).unwrap_err();
    assert!(fault.to_string().contains("feature `ktx2`"), "{fault}");
}
