//! Checks of materials.

use super::checker::{Checker, FINITE, NOT_NEGATIVE, POSITIVE, UNIT};
use crate::gltf::document::{Material, MaterialExtensions, SpecularGlossiness, TextureInfo};
use crate::gltf::location::Location;
use std::ops::RangeInclusive;

/// Numbers of a material, by key, with their range.
type Numbers<'m> = (&'static str, &'m [f64], RangeInclusive<f64>);
/// A texture of a material, by key.
type Texture<'m> = (&'static str, &'m Option<TextureInfo>);

impl Checker<'_> {
    /// Checks the ranges of numbers and the textures of materials.
    pub(super) fn materials(&mut self) {
        let list = Location::root("materials");
        for (position, material) in self.document.materials.iter().enumerate() {
            let at = list.index(position);
            self.core(&at, material);
            if let Some(extensions) = &material.extensions {
                let at = at.key("extensions");
                self.coats(&at, extensions);
                self.solids(&at, extensions);
                self.reflections(&at, extensions);
            }
        }
    }

    /// Checks some numbers and textures of an object.
    fn values<const N: usize, const M: usize>(
        &mut self,
        at: &Location<'_>,
        numbers: [Numbers<'_>; N],
        textures: [Texture<'_>; M],
    ) {
        for (key, values, range) in numbers {
            match values {
                [value] => self.number(&at.key(key), *value, &range),
                _ => self.numbers(&at.key(key), values, &range),
            }
        }
        for (key, texture) in textures {
            self.texture(&at.key(key), texture.as_ref());
        }
    }

    fn core(&mut self, at: &Location<'_>, material: &Material) {
        let numbers = [
            ("emissiveFactor", &material.emissive_factor[..], UNIT),
            ("alphaCutoff", &[material.alpha_cutoff], NOT_NEGATIVE),
        ];
        let textures = [
            ("normalTexture", &material.normal_texture),
            ("occlusionTexture", &material.occlusion_texture),
            ("emissiveTexture", &material.emissive_texture),
        ];
        self.values(at, numbers, textures);
        if let Some(occlusion) = &material.occlusion_texture {
            let texture = at.key("occlusionTexture");
            self.number(&texture.key("strength"), occlusion.strength, &UNIT);
        }
        let base = &material.pbr_metallic_roughness;
        let numbers = [
            ("baseColorFactor", &base.base_color_factor[..], UNIT),
            ("metallicFactor", &[base.metallic_factor], UNIT),
            ("roughnessFactor", &[base.roughness_factor], UNIT),
        ];
        let textures = [
            ("baseColorTexture", &base.base_color_texture),
            ("metallicRoughnessTexture", &base.metallic_roughness_texture),
        ];
        self.values(&at.key("pbrMetallicRoughness"), numbers, textures);
    }

    /// Checks extensions that add a layer.
    fn coats(&mut self, at: &Location<'_>, extensions: &MaterialExtensions) {
        if let Some(coat) = &extensions.clearcoat {
            let numbers = [
                ("clearcoatFactor", &[coat.clearcoat_factor][..], UNIT),
                ("clearcoatRoughnessFactor", &[coat.clearcoat_roughness_factor], UNIT),
            ];
            let textures = [
                ("clearcoatTexture", &coat.clearcoat_texture),
                ("clearcoatRoughnessTexture", &coat.clearcoat_roughness_texture),
                ("clearcoatNormalTexture", &coat.clearcoat_normal_texture),
            ];
            self.values(&at.key("KHR_materials_clearcoat"), numbers, textures);
        }
        if let Some(sheen) = &extensions.sheen {
            let numbers = [
                ("sheenColorFactor", &sheen.sheen_color_factor[..], UNIT),
                ("sheenRoughnessFactor", &[sheen.sheen_roughness_factor], UNIT),
            ];
            let textures = [
                ("sheenColorTexture", &sheen.sheen_color_texture),
                ("sheenRoughnessTexture", &sheen.sheen_roughness_texture),
            ];
            self.values(&at.key("KHR_materials_sheen"), numbers, textures);
        }
        if let Some(film) = &extensions.iridescence {
            let numbers = [
                ("iridescenceFactor", &[film.iridescence_factor][..], UNIT),
                ("iridescenceIor", &[film.iridescence_ior], 1.0..=f64::from(f32::MAX)),
                ("iridescenceThicknessMinimum", &[film.iridescence_thickness_minimum], NOT_NEGATIVE),
                ("iridescenceThicknessMaximum", &[film.iridescence_thickness_maximum], NOT_NEGATIVE),
            ];
            let textures = [
                ("iridescenceTexture", &film.iridescence_texture),
                ("iridescenceThicknessTexture", &film.iridescence_thickness_texture),
            ];
            self.values(&at.key("KHR_materials_iridescence"), numbers, textures);
        }
    }

    /// Checks extensions about transmitted light.
    fn solids(&mut self, at: &Location<'_>, extensions: &MaterialExtensions) {
        if let Some(glass) = &extensions.transmission {
            let numbers = [("transmissionFactor", &[glass.transmission_factor][..], UNIT)];
            let textures = [("transmissionTexture", &glass.transmission_texture)];
            self.values(&at.key("KHR_materials_transmission"), numbers, textures);
        }
        if let Some(diffuse) = &extensions.diffuse_transmission {
            let numbers = [
                ("diffuseTransmissionFactor", &[diffuse.diffuse_transmission_factor][..], UNIT),
                ("diffuseTransmissionColorFactor", &diffuse.diffuse_transmission_color_factor, UNIT),
            ];
            let textures = [
                ("diffuseTransmissionTexture", &diffuse.diffuse_transmission_texture),
                ("diffuseTransmissionColorTexture", &diffuse.diffuse_transmission_color_texture),
            ];
            self.values(&at.key("KHR_materials_diffuse_transmission"), numbers, textures);
        }
        if let Some(volume) = &extensions.volume {
            let numbers = [
                ("thicknessFactor", &[volume.thickness_factor][..], NOT_NEGATIVE),
                // An infinite distance is written by leaving it out.
                ("attenuationDistance", volume.attenuation_distance.as_slice(), POSITIVE),
                ("attenuationColor", &volume.attenuation_color, UNIT),
            ];
            self.values(&at.key("KHR_materials_volume"), numbers, [("thicknessTexture", &volume.thickness_texture)]);
        }
        if let Some(dispersion) = &extensions.dispersion {
            let numbers = [("dispersion", &[dispersion.dispersion][..], NOT_NEGATIVE)];
            self.values(&at.key("KHR_materials_dispersion"), numbers, []);
        }
        if let Some(ior) = extensions.ior.as_ref().map(|ior| ior.ior)
            && ior != 0.0
        {
            let numbers = [("ior", &[ior][..], 1.0..=f64::from(f32::MAX))];
            self.values(&at.key("KHR_materials_ior"), numbers, []);
        }
    }

    /// Checks extensions about reflected and emitted light.
    fn reflections(&mut self, at: &Location<'_>, extensions: &MaterialExtensions) {
        if let Some(anisotropy) = &extensions.anisotropy {
            let numbers = [
                ("anisotropyStrength", &[anisotropy.anisotropy_strength][..], UNIT),
                ("anisotropyRotation", &[anisotropy.anisotropy_rotation], FINITE),
            ];
            let textures = [("anisotropyTexture", &anisotropy.anisotropy_texture)];
            self.values(&at.key("KHR_materials_anisotropy"), numbers, textures);
        }
        if let Some(emission) = &extensions.emissive_strength {
            let numbers = [("emissiveStrength", &[emission.emissive_strength][..], NOT_NEGATIVE)];
            self.values(&at.key("KHR_materials_emissive_strength"), numbers, []);
        }
        if let Some(specular) = &extensions.specular {
            let numbers = [
                ("specularFactor", &[specular.specular_factor][..], UNIT),
                ("specularColorFactor", &specular.specular_color_factor, NOT_NEGATIVE),
            ];
            let textures = [
                ("specularTexture", &specular.specular_texture),
                ("specularColorTexture", &specular.specular_color_texture),
            ];
            self.values(&at.key("KHR_materials_specular"), numbers, textures);
        }
        if let Some(glossiness) = &extensions.specular_glossiness {
            self.specular_glossiness(&at.key("KHR_materials_pbrSpecularGlossiness"), glossiness);
        }
    }

    fn specular_glossiness(&mut self, at: &Location<'_>, material: &SpecularGlossiness) {
        let numbers = [
            ("diffuseFactor", &material.diffuse_factor[..], UNIT),
            ("specularFactor", &material.specular_factor, UNIT),
            ("glossinessFactor", &[material.glossiness_factor], UNIT),
        ];
        let textures = [
            ("diffuseTexture", &material.diffuse_texture),
            ("specularGlossinessTexture", &material.specular_glossiness_texture),
        ];
        self.values(at, numbers, textures);
    }
}
