//! Materials (glTF 2.0, section 3.9) and their extensions.
//!
//! A texture multiplies the factor of the same name; missing textures count as 1. Colors of factors
//! are linear.

use super::image::TextureInfo;
use serde::Deserialize;

/// A material.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Material {
    /// Base color, metallic and roughness.
    pub pbr_metallic_roughness: MetallicRoughness,
    /// Normals in tangent space.
    pub normal_texture: Option<TextureInfo>,
    /// Ambient occlusion.
    pub occlusion_texture: Option<TextureInfo>,
    /// Emitted light.
    pub emissive_texture: Option<TextureInfo>,
    /// Emitted light, 0 to 1.
    pub emissive_factor: [f64; 3],
    /// Use of the alpha of the base color.
    pub alpha_mode: AlphaMode,
    /// Lowest alpha that is opaque in mode `MASK`.
    pub alpha_cutoff: f64,
    /// Whether the back is visible.
    pub double_sided: bool,
    /// Name for people.
    pub name: Option<String>,
    /// Extensions.
    pub extensions: Option<Box<MaterialExtensions>>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            pbr_metallic_roughness: MetallicRoughness::default(),
            normal_texture: None,
            occlusion_texture: None,
            emissive_texture: None,
            emissive_factor: [0.0; 3],
            alpha_mode: AlphaMode::Opaque,
            alpha_cutoff: 0.5,
            double_sided: false,
            name: None,
            extensions: None,
        }
    }
}

/// Use of the alpha of the base color.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AlphaMode {
    /// Alpha has no effect.
    Opaque,
    /// Alpha below a threshold is transparent, other alpha opaque.
    Mask,
    /// Alpha is the opacity.
    Blend,
}

/// Declares the parameters of a material with their defaults.
macro_rules! parameters {
    ($(#[$meta:meta])* $name:ident { $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        #[serde(rename_all = "camelCase", default)]
        pub struct $name {
            $($(#[$field_meta])* pub $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }
    };
}

parameters! {
    /// Base color, metallic and roughness.
    MetallicRoughness {
        /// Base color and alpha, 0 to 1.
        base_color_factor: [f64; 4] = [1.0; 4],
        /// Base color (sRGB) and alpha.
        base_color_texture: Option<TextureInfo> = None,
        /// Metallic, 0 to 1.
        metallic_factor: f64 = 1.0,
        /// Roughness, 0 to 1.
        roughness_factor: f64 = 1.0,
        /// Roughness in green, metallic in blue.
        metallic_roughness_texture: Option<TextureInfo> = None,
    }
}

/// Extensions of a material.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct MaterialExtensions {
    /// Anisotropic highlights.
    #[serde(rename = "KHR_materials_anisotropy")]
    pub anisotropy: Option<Anisotropy>,
    /// Clear coat.
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Clearcoat>,
    /// Transmission with diffuse scattering.
    #[serde(rename = "KHR_materials_diffuse_transmission")]
    pub diffuse_transmission: Option<DiffuseTransmission>,
    /// Dispersion of refracted light.
    #[serde(rename = "KHR_materials_dispersion")]
    pub dispersion: Option<Dispersion>,
    /// Factor of emitted light.
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub emissive_strength: Option<EmissiveStrength>,
    /// Index of refraction.
    #[serde(rename = "KHR_materials_ior")]
    pub ior: Option<Ior>,
    /// Thin-film interference.
    #[serde(rename = "KHR_materials_iridescence")]
    pub iridescence: Option<Iridescence>,
    /// Sheen of fabrics.
    #[serde(rename = "KHR_materials_sheen")]
    pub sheen: Option<Sheen>,
    /// Strength and color of the specular reflection.
    #[serde(rename = "KHR_materials_specular")]
    pub specular: Option<Specular>,
    /// Transmission of light.
    #[serde(rename = "KHR_materials_transmission")]
    pub transmission: Option<Transmission>,
    /// Color without lighting.
    #[serde(rename = "KHR_materials_unlit")]
    pub unlit: Option<Unlit>,
    /// Absorption inside a closed surface.
    #[serde(rename = "KHR_materials_volume")]
    pub volume: Option<Volume>,
    /// Diffuse, specular and glossiness instead of metallic and roughness (archived).
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<SpecularGlossiness>,
}

parameters! {
    /// Anisotropic highlights (KHR_materials_anisotropy).
    Anisotropy {
        /// Strength, 0 to 1.
        anisotropy_strength: f64 = 0.0,
        /// Counter-clockwise rotation from the tangent, in radians.
        anisotropy_rotation: f64 = 0.0,
        /// Direction in red and green, strength in blue.
        anisotropy_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Clear coat (KHR_materials_clearcoat).
    Clearcoat {
        /// Strength, 0 to 1.
        clearcoat_factor: f64 = 0.0,
        /// Strength in red.
        clearcoat_texture: Option<TextureInfo> = None,
        /// Roughness, 0 to 1.
        clearcoat_roughness_factor: f64 = 0.0,
        /// Roughness in green.
        clearcoat_roughness_texture: Option<TextureInfo> = None,
        /// Normals of the coat.
        clearcoat_normal_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Transmission with diffuse scattering (KHR_materials_diffuse_transmission).
    DiffuseTransmission {
        /// Fraction of diffuse light that is transmitted, 0 to 1.
        diffuse_transmission_factor: f64 = 0.0,
        /// Fraction in alpha.
        diffuse_transmission_texture: Option<TextureInfo> = None,
        /// Color of the transmitted light.
        diffuse_transmission_color_factor: [f64; 3] = [1.0; 3],
        /// Color (sRGB) of the transmitted light.
        diffuse_transmission_color_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Dispersion (KHR_materials_dispersion).
    Dispersion {
        /// 20 divided by the Abbe number; 0 for none.
        dispersion: f64 = 0.0,
    }
}

parameters! {
    /// Factor of emitted light (KHR_materials_emissive_strength).
    EmissiveStrength {
        /// The factor, at least 0.
        emissive_strength: f64 = 1.0,
    }
}

parameters! {
    /// Index of refraction (KHR_materials_ior).
    Ior {
        /// The index, at least 1, or 0 for total reflection.
        ior: f64 = 1.5,
    }
}

parameters! {
    /// Thin-film interference (KHR_materials_iridescence).
    Iridescence {
        /// Strength, 0 to 1.
        iridescence_factor: f64 = 0.0,
        /// Strength in red.
        iridescence_texture: Option<TextureInfo> = None,
        /// Index of refraction of the film.
        iridescence_ior: f64 = 1.3,
        /// Thickness of the film where the texture is 0, in nanometers.
        iridescence_thickness_minimum: f64 = 100.0,
        /// Thickness of the film where the texture is 1, or without texture, in nanometers.
        iridescence_thickness_maximum: f64 = 400.0,
        /// Thickness in green.
        iridescence_thickness_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Sheen of fabrics (KHR_materials_sheen).
    Sheen {
        /// Color.
        sheen_color_factor: [f64; 3] = [0.0; 3],
        /// Color (sRGB).
        sheen_color_texture: Option<TextureInfo> = None,
        /// Roughness, 0 to 1.
        sheen_roughness_factor: f64 = 0.0,
        /// Roughness in alpha.
        sheen_roughness_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Strength and color of the specular reflection (KHR_materials_specular).
    Specular {
        /// Strength, 0 to 1.
        specular_factor: f64 = 1.0,
        /// Strength in alpha.
        specular_texture: Option<TextureInfo> = None,
        /// Color at normal incidence, at least 0.
        specular_color_factor: [f64; 3] = [1.0; 3],
        /// Color (sRGB) at normal incidence.
        specular_color_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Transmission (KHR_materials_transmission).
    Transmission {
        /// Fraction of light that is transmitted, 0 to 1.
        transmission_factor: f64 = 0.0,
        /// Fraction in red.
        transmission_texture: Option<TextureInfo> = None,
    }
}

parameters! {
    /// Color without lighting (KHR_materials_unlit).
    Unlit {}
}

parameters! {
    /// Absorption inside a closed surface (KHR_materials_volume).
    Volume {
        /// Thickness beneath the surface in object space; 0 for a thin surface.
        thickness_factor: f64 = 0.0,
        /// Thickness in green.
        thickness_texture: Option<TextureInfo> = None,
        /// Distance in world space at which light has the attenuation color; infinite if `None`.
        attenuation_distance: Option<f64> = None,
        /// Color of white light at the attenuation distance.
        attenuation_color: [f64; 3] = [1.0; 3],
    }
}

parameters! {
    /// Diffuse, specular and glossiness (KHR_materials_pbrSpecularGlossiness, archived).
    SpecularGlossiness {
        /// Diffuse color and alpha, 0 to 1.
        diffuse_factor: [f64; 4] = [1.0; 4],
        /// Diffuse color (sRGB) and alpha.
        diffuse_texture: Option<TextureInfo> = None,
        /// Specular color, 0 to 1.
        specular_factor: [f64; 3] = [1.0; 3],
        /// Glossiness, 0 to 1.
        glossiness_factor: f64 = 1.0,
        /// Specular color (sRGB) and glossiness in alpha.
        specular_glossiness_texture: Option<TextureInfo> = None,
    }
}
