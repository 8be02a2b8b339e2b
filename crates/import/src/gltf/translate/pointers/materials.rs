//! Animated numbers of materials and of their textures.

use super::number::{ANY, NOT_NEGATIVE, Number, POSITIVE, UNIT};
use crate::gltf::document::{Material, MaterialExtensions, TextureInfo};

/// Sets a property of a material; `None` if it is none that can be animated.
pub fn apply(material: &mut Material, tokens: &[&str], values: &[f64]) -> Option<()> {
    let base = &mut material.pbr_metallic_roughness;
    match tokens {
        ["emissiveFactor"] => material.emissive_factor.set(values, UNIT),
        ["alphaCutoff"] => material.alpha_cutoff.set(values, NOT_NEGATIVE),
        ["normalTexture", rest @ ..] => texture(&mut material.normal_texture, rest, values),
        ["occlusionTexture", rest @ ..] => texture(&mut material.occlusion_texture, rest, values),
        ["emissiveTexture", rest @ ..] => texture(&mut material.emissive_texture, rest, values),
        ["pbrMetallicRoughness", "baseColorFactor"] => base.base_color_factor.set(values, UNIT),
        ["pbrMetallicRoughness", "metallicFactor"] => base.metallic_factor.set(values, UNIT),
        ["pbrMetallicRoughness", "roughnessFactor"] => base.roughness_factor.set(values, UNIT),
        ["pbrMetallicRoughness", "baseColorTexture", rest @ ..] => texture(&mut base.base_color_texture, rest, values),
        ["pbrMetallicRoughness", "metallicRoughnessTexture", rest @ ..] => {
            texture(&mut base.metallic_roughness_texture, rest, values)
        }
        ["extensions", name, rest @ ..] => extension(material.extensions.as_deref_mut()?, name, rest, values),
        _ => None,
    }
}

/// Sets a property of a reference to a texture.
fn texture(texture: &mut Option<TextureInfo>, tokens: &[&str], values: &[f64]) -> Option<()> {
    let texture = texture.as_mut()?;
    match tokens {
        ["scale"] => texture.scale.set(values, ANY),
        ["strength"] => texture.strength.set(values, UNIT),
        ["extensions", "KHR_texture_transform", name] => {
            let transform = texture.extensions.transform.get_or_insert_default();
            match *name {
                "offset" => transform.offset.set(values, ANY),
                "rotation" => transform.rotation.set(values, ANY),
                "scale" => transform.scale.set(values, ANY),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Declares a function that sets a property of an extension: names of its numbers with their ranges,
/// and of its textures.
macro_rules! properties {
    ($function:ident($type:ident) { $($name:literal: $field:ident $range:ident,)* } { $($texture_name:literal: $texture:ident,)* }) => {
        fn $function(extension: &mut crate::gltf::document::$type, tokens: &[&str], values: &[f64]) -> Option<()> {
            match tokens {
                $([$name] => extension.$field.set(values, $range),)*
                $([$texture_name, rest @ ..] => texture(&mut extension.$texture, rest, values),)*
                _ => None,
            }
        }
    };
}

properties! { anisotropy(Anisotropy) {
    "anisotropyStrength": anisotropy_strength UNIT,
    "anisotropyRotation": anisotropy_rotation ANY,
} { "anisotropyTexture": anisotropy_texture, } }

properties! { clearcoat(Clearcoat) {
    "clearcoatFactor": clearcoat_factor UNIT,
    "clearcoatRoughnessFactor": clearcoat_roughness_factor UNIT,
} {
    "clearcoatTexture": clearcoat_texture,
    "clearcoatRoughnessTexture": clearcoat_roughness_texture,
    "clearcoatNormalTexture": clearcoat_normal_texture,
} }

properties! { diffuse_transmission(DiffuseTransmission) {
    "diffuseTransmissionFactor": diffuse_transmission_factor UNIT,
    "diffuseTransmissionColorFactor": diffuse_transmission_color_factor UNIT,
} {
    "diffuseTransmissionTexture": diffuse_transmission_texture,
    "diffuseTransmissionColorTexture": diffuse_transmission_color_texture,
} }

properties! { dispersion(Dispersion) { "dispersion": dispersion NOT_NEGATIVE, } {} }

properties! { emissive_strength(EmissiveStrength) { "emissiveStrength": emissive_strength NOT_NEGATIVE, } {} }

properties! { iridescence(Iridescence) {
    "iridescenceFactor": iridescence_factor UNIT,
    "iridescenceIor": iridescence_ior NOT_NEGATIVE,
    "iridescenceThicknessMinimum": iridescence_thickness_minimum NOT_NEGATIVE,
    "iridescenceThicknessMaximum": iridescence_thickness_maximum NOT_NEGATIVE,
} {
    "iridescenceTexture": iridescence_texture,
    "iridescenceThicknessTexture": iridescence_thickness_texture,
} }

properties! { ior(Ior) { "ior": ior NOT_NEGATIVE, } {} }

properties! { sheen(Sheen) {
    "sheenColorFactor": sheen_color_factor UNIT,
    "sheenRoughnessFactor": sheen_roughness_factor UNIT,
} { "sheenColorTexture": sheen_color_texture, "sheenRoughnessTexture": sheen_roughness_texture, } }

properties! { specular(Specular) {
    "specularFactor": specular_factor UNIT,
    "specularColorFactor": specular_color_factor NOT_NEGATIVE,
} { "specularTexture": specular_texture, "specularColorTexture": specular_color_texture, } }

properties! { transmission(Transmission) { "transmissionFactor": transmission_factor UNIT, } {
    "transmissionTexture": transmission_texture,
} }

properties! { volume(Volume) {
    "thicknessFactor": thickness_factor NOT_NEGATIVE,
    "attenuationColor": attenuation_color UNIT,
} { "thicknessTexture": thickness_texture, } }

properties! { specular_glossiness(SpecularGlossiness) {
    "diffuseFactor": diffuse_factor UNIT,
    "specularFactor": specular_factor UNIT,
    "glossinessFactor": glossiness_factor UNIT,
} { "diffuseTexture": diffuse_texture, "specularGlossinessTexture": specular_glossiness_texture, } }

/// Sets a property of an extension of a material.
fn extension(all: &mut MaterialExtensions, name: &str, tokens: &[&str], values: &[f64]) -> Option<()> {
    match name {
        "KHR_materials_anisotropy" => anisotropy(all.anisotropy.as_mut()?, tokens, values),
        "KHR_materials_clearcoat" => clearcoat(all.clearcoat.as_mut()?, tokens, values),
        "KHR_materials_diffuse_transmission" => {
            diffuse_transmission(all.diffuse_transmission.as_mut()?, tokens, values)
        }
        "KHR_materials_dispersion" => dispersion(all.dispersion.as_mut()?, tokens, values),
        "KHR_materials_emissive_strength" => emissive_strength(all.emissive_strength.as_mut()?, tokens, values),
        "KHR_materials_ior" => ior(all.ior.as_mut()?, tokens, values),
        "KHR_materials_iridescence" => iridescence(all.iridescence.as_mut()?, tokens, values),
        "KHR_materials_sheen" => sheen(all.sheen.as_mut()?, tokens, values),
        "KHR_materials_specular" => specular(all.specular.as_mut()?, tokens, values),
        "KHR_materials_transmission" => transmission(all.transmission.as_mut()?, tokens, values),
        "KHR_materials_volume" if tokens == ["attenuationDistance"] => {
            all.volume.as_mut()?.attenuation_distance.get_or_insert(1.0).set(values, POSITIVE)
        }
        "KHR_materials_volume" => volume(all.volume.as_mut()?, tokens, values),
        "KHR_materials_pbrSpecularGlossiness" => specular_glossiness(all.specular_glossiness.as_mut()?, tokens, values),
        _ => None,
    }
}
