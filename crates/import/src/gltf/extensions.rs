//! Extensions of glTF, and how far they are supported.

/// Support of an extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// All of its properties have their effect.
    Whole,
    /// Its properties have nearly their effect.
    Approximated,
    /// Its properties have no effect.
    Ignored,
}

impl Support {
    /// Word for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Approximated => "approximated",
            Self::Ignored => "ignored",
        }
    }
}

/// An extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extension {
    /// Name, with the prefix of its author.
    pub name: &'static str,
    /// Support of the extension.
    pub support: Support,
    /// What is lost; empty if nothing is.
    pub note: &'static str,
}

const fn whole(name: &'static str) -> Extension {
    Extension { name, support: Support::Whole, note: "" }
}

const fn approximated(name: &'static str, note: &'static str) -> Extension {
    Extension { name, support: Support::Approximated, note }
}

const fn ignored(name: &'static str, note: &'static str) -> Extension {
    Extension { name, support: Support::Ignored, note }
}

/// All extensions that documents may require, by name.
pub const EXTENSIONS: [Extension; 34] = [
    approximated("EXT_lights_ies", "a light is a point with the profile"),
    approximated("EXT_lights_image_based", "the images of level 0 become an environment"),
    whole("EXT_mesh_gpu_instancing"),
    whole("EXT_meshopt_compression"),
    whole("EXT_texture_webp"),
    whole("KHR_animation_pointer"),
    whole("KHR_draco_mesh_compression"),
    ignored("KHR_interactivity", "a rendered scene does not react"),
    whole("KHR_lights_punctual"),
    whole("KHR_materials_anisotropy"),
    whole("KHR_materials_clearcoat"),
    whole("KHR_materials_diffuse_transmission"),
    whole("KHR_materials_dispersion"),
    whole("KHR_materials_emissive_strength"),
    whole("KHR_materials_ior"),
    whole("KHR_materials_iridescence"),
    whole("KHR_materials_pbrSpecularGlossiness"),
    whole("KHR_materials_sheen"),
    whole("KHR_materials_specular"),
    whole("KHR_materials_transmission"),
    whole("KHR_materials_unlit"),
    whole("KHR_materials_variants"),
    whole("KHR_materials_volume"),
    whole("KHR_mesh_quantization"),
    whole("KHR_meshopt_compression"),
    ignored("KHR_node_hoverability", "a rendered scene does not react"),
    ignored("KHR_node_selectability", "a rendered scene does not react"),
    whole("KHR_node_visibility"),
    if cfg!(feature = "ktx2") {
        whole("KHR_texture_basisu")
    } else {
        ignored("KHR_texture_basisu", "the plain image of the texture is used")
    },
    whole("KHR_texture_transform"),
    ignored("KHR_xmp_json_ld", "metadata has no effect on images"),
    ignored("KHR_xmp", "metadata has no effect on images"),
    ignored("MSFT_lod", "the finest level of detail is rendered"),
    ignored("MSFT_texture_dds", "the plain image of the texture is used"),
];

/// The extension of this name; `None` if it is not known. Documents that require an unknown
/// extension are refused.
pub fn extension(name: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_notes_say_what_is_lost() {
        for (position, extension) in EXTENSIONS.iter().enumerate() {
            assert!(EXTENSIONS.iter().skip(position + 1).all(|other| other.name != extension.name), "{extension:?}");
            assert_eq!(extension.note.is_empty(), extension.support == Support::Whole, "{extension:?}");
        }
        assert_eq!(extension("KHR_materials_ior").map(|found| found.support.name()), Some("whole"));
        assert_eq!(extension("EXT_lights_ies").map(|found| found.support.name()), Some("approximated"));
        assert_eq!(extension("MSFT_lod").map(|found| found.support.name()), Some("ignored"));
        assert_eq!(extension("KHR_gaussian_splatting"), None);
    }
}
