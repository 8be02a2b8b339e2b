//! Materials of a file as `principled` materials (KHR_materials_*).

use super::Names;
use super::textures::TextureSet;
use crate::gltf::data::GltfData;
use crate::gltf::document::{AlphaMode, Material, MaterialExtensions, SpecularGlossiness};
use crate::gltf::error::Fault;
use crate::gltf::warning::Warnings;
use indexmap::IndexMap;
use juggler_material::medium::Medium;
use juggler_material::{AnyMaterial, Emissive, MaterialRef, NormalMap, Principled, Sides};
use juggler_math::Rgb;
use juggler_scene::Asset;
use juggler_texture::{AnyTexture, Channel, Input};
use std::f64::consts::TAU;

/// Properties of a primitive that determine its material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrimitiveSurface {
    /// Whether the vertices have colors.
    pub has_color: bool,
    /// Whether the primitive is lit. Points and lines without normals are not.
    pub is_lit: bool,
}

/// Materials of a file that a scene uses, with their textures and pictures.
#[derive(Debug)]
pub struct MaterialSet<'a> {
    data: &'a GltfData,
    names: &'a Names,
    prefix: &'a str,
    textures: TextureSet<'a>,
    materials: IndexMap<String, AnyMaterial>,
    warnings: Warnings,
}

/// Result of the translation of materials.
#[derive(Debug)]
pub struct MaterialParts {
    /// Textures by name.
    pub textures: IndexMap<String, AnyTexture>,
    /// Materials by name.
    pub materials: IndexMap<String, AnyMaterial>,
    /// Pictures by name.
    pub assets: IndexMap<String, Asset>,
    /// Warnings.
    pub warnings: Warnings,
}

impl<'a> MaterialSet<'a> {
    /// Creates an empty set.
    pub fn new(data: &'a GltfData, names: &'a Names, prefix: &'a str) -> Self {
        let textures = TextureSet::new(data, names, prefix);
        Self { data, names, prefix, textures, materials: IndexMap::new(), warnings: Warnings::default() }
    }

    /// Name of the material of a primitive. Adds the material on its first use.
    ///
    /// # Errors
    ///
    /// An image of the material is not valid.
    pub fn material(&mut self, index: Option<usize>, surface: &PrimitiveSurface) -> Result<String, Fault> {
        let name = match index {
            Some(index) => self.names.materials.get(index).map(String::as_str).unwrap_or_default(),
            None => "default material",
        };
        let name = format!("{}{name}", self.prefix);
        if surface.has_color {
            self.warnings.add("/meshes", "vertex colors are ignored", 1);
        }
        if !self.materials.contains_key(&name) {
            let found = index.and_then(|index| self.data.gltf.document.materials.get(index));
            let at = index.map_or_else(|| "/materials".to_owned(), |index| format!("/materials/{index}"));
            let material = self.translate(&found.cloned().unwrap_or_default(), &at);
            self.materials.insert(name.clone(), material);
        }
        Ok(name)
    }

    /// The materials with their textures and pictures.
    pub fn finish(self) -> MaterialParts {
        let TextureSet { textures, images, warnings: more, .. } = self.textures;
        let mut warnings = self.warnings;
        warnings.append(more);
        let assets = images.into_iter().filter_map(|image| {
            let asset = self.data.image_asset(image)?;
            Some((super::textures::asset_name(self.prefix, image), asset))
        });
        MaterialParts { textures, materials: self.materials, assets: assets.collect(), warnings }
    }

    fn translate(&mut self, material: &Material, at: &str) -> AnyMaterial {
        let extensions = material.extensions.as_deref().cloned().unwrap_or_default();
        if extensions.unlit.is_some() {
            return self.unlit(material, at);
        }
        let mut principled = self.base(material, extensions.specular_glossiness.as_ref());
        self.layers(&mut principled, &extensions, at);
        self.glass(&mut principled, &extensions);
        self.emission(&mut principled, material, &extensions);
        self.opacity(&mut principled, material, extensions.specular_glossiness.as_ref());
        match self.textures.normals(material.normal_texture.as_ref()) {
            None => principled.into(),
            Some(texture) => {
                let scale = material.normal_texture.as_ref().map_or(1.0, |info| info.scale as f32);
                if scale < 0.0 {
                    self.warnings.add(at, "the negative scale of its normal texture counts as positive", 1);
                }
                let inner = MaterialRef::from(principled);
                NormalMap { texture, strength: scale.abs().min(1000.0).into(), material: inner }.into()
            }
        }
    }

    /// Metal, plastic and roughness.
    fn base(&mut self, material: &Material, glossiness: Option<&SpecularGlossiness>) -> Principled {
        let textures = &mut self.textures;
        if let Some(model) = glossiness {
            let [r, g, b, _] = model.diffuse_factor;
            let texture = model.specular_glossiness_texture.as_ref();
            return Principled {
                base_color: textures.color([r, g, b], model.diffuse_texture.as_ref()),
                metallic: 0.0.into(),
                roughness: textures.complement(model.glossiness_factor, texture, Channel::A),
                specular_color: textures.color(model.specular_factor, texture),
                // The highest index makes the reflectance nearly the specular color.
                ior: 10.0,
                ..Principled::default()
            };
        }
        let model = &material.pbr_metallic_roughness;
        let [r, g, b, _] = model.base_color_factor;
        let texture = model.metallic_roughness_texture.as_ref();
        Principled {
            base_color: textures.color([r, g, b], model.base_color_texture.as_ref()),
            metallic: textures.number(model.metallic_factor, texture, Channel::B),
            roughness: textures.number(model.roughness_factor, texture, Channel::G),
            ..Principled::default()
        }
    }

    /// Specular reflection, clear coat, sheen, thin film and anisotropy.
    fn layers(&mut self, principled: &mut Principled, extensions: &MaterialExtensions, at: &str) {
        let textures = &mut self.textures;
        if let Some(ior) = &extensions.ior {
            principled.ior = if ior.ior == 0.0 { 10.0 } else { (ior.ior as f32).clamp(1.0, 10.0) };
        }
        if let Some(specular) = &extensions.specular {
            principled.specular =
                textures.number(specular.specular_factor, specular.specular_texture.as_ref(), Channel::A);
            principled.specular_color =
                textures.color(specular.specular_color_factor, specular.specular_color_texture.as_ref());
        }
        if let Some(coat) = &extensions.clearcoat {
            principled.clearcoat = textures.number(coat.clearcoat_factor, coat.clearcoat_texture.as_ref(), Channel::R);
            let roughness = coat.clearcoat_roughness_texture.as_ref();
            principled.clearcoat_roughness = textures.number(coat.clearcoat_roughness_factor, roughness, Channel::G);
            let has_normals = coat.clearcoat_normal_texture.is_some();
            self.warnings.add(at, "the clear coat has the normals of its base", u64::from(has_normals));
        }
        let textures = &mut self.textures;
        if let Some(sheen) = &extensions.sheen {
            principled.sheen_color = textures.color(sheen.sheen_color_factor, sheen.sheen_color_texture.as_ref());
            let roughness = sheen.sheen_roughness_texture.as_ref();
            principled.sheen_roughness = textures.number(sheen.sheen_roughness_factor, roughness, Channel::A);
        }
        if let Some(film) = &extensions.iridescence {
            let texture = film.iridescence_texture.as_ref();
            principled.iridescence = textures.number(film.iridescence_factor, texture, Channel::R);
            principled.iridescence_ior = (film.iridescence_ior as f32).clamp(1.0, 10.0);
            principled.iridescence_thickness = self.film_thickness(film);
        }
        if let Some(anisotropy) = &extensions.anisotropy {
            let texture = anisotropy.anisotropy_texture.as_ref();
            principled.anisotropy = self.textures.number(anisotropy.anisotropy_strength, texture, Channel::B);
            principled.anisotropy_rotation = ((anisotropy.anisotropy_rotation / TAU) as f32).into();
            self.warnings.add(at, "the directions of its anisotropy texture are ignored", u64::from(texture.is_some()));
        }
        let dispersion = extensions.dispersion.as_ref().is_some_and(|dispersion| dispersion.dispersion > 0.0);
        self.warnings.add(at, "its dispersion is ignored", u64::from(dispersion));
    }

    /// Thickness of a thin film: mix(minimum, maximum, green), or the maximum without texture.
    fn film_thickness(&mut self, film: &crate::gltf::document::Iridescence) -> Input<f32> {
        let (low, high) = (film.iridescence_thickness_minimum, film.iridescence_thickness_maximum);
        let texture = film.iridescence_thickness_texture.as_ref();
        match self.textures.number(1.0, texture, Channel::G) {
            Input::Value(_) => (high as f32).into(),
            Input::Texture(green) => Input::Texture(self.textures.between(low as f32, high as f32, green)),
        }
    }

    /// Transmission, volume and diffuse transmission.
    fn glass(&mut self, principled: &mut Principled, extensions: &MaterialExtensions) {
        let textures = &mut self.textures;
        let volume = extensions.volume.as_ref().filter(|volume| volume.thickness_factor > 0.0);
        if let Some(transmission) = &extensions.transmission {
            let texture = transmission.transmission_texture.as_ref();
            principled.transmission = textures.number(transmission.transmission_factor, texture, Channel::R);
            principled.thin = volume.is_none();
        }
        if let Some(diffuse) = &extensions.diffuse_transmission {
            let texture = diffuse.diffuse_transmission_texture.as_ref();
            principled.diffuse_transmission = textures.number(diffuse.diffuse_transmission_factor, texture, Channel::A);
            let color = diffuse.diffuse_transmission_color_texture.as_ref();
            principled.diffuse_transmission_color = textures.color(diffuse.diffuse_transmission_color_factor, color);
            principled.thin = volume.is_none();
        }
        if let Some(volume) = volume
            && let Some(distance) = volume.attenuation_distance.filter(|distance| distance.is_finite())
        {
            let [r, g, b] = volume.attenuation_color.map(|channel| (channel as f32).max(1e-6));
            principled.medium = Medium { color: Rgb::new(r, g, b), distance: distance as f32, ..Medium::default() };
        }
    }

    fn emission(&mut self, principled: &mut Principled, material: &Material, extensions: &MaterialExtensions) {
        principled.emissive = self.textures.color(material.emissive_factor, material.emissive_texture.as_ref());
        let strength = extensions.emissive_strength.as_ref().map_or(1.0, |strength| strength.emissive_strength);
        principled.emissive_strength = strength as f32;
    }

    /// Opacity by the alpha mode.
    fn opacity(&mut self, principled: &mut Principled, material: &Material, glossiness: Option<&SpecularGlossiness>) {
        if material.alpha_mode == AlphaMode::Opaque {
            return;
        }
        let model = &material.pbr_metallic_roughness;
        let (factor, texture) = match glossiness {
            Some(model) => (model.diffuse_factor[3], model.diffuse_texture.as_ref()),
            None => (model.base_color_factor[3], model.base_color_texture.as_ref()),
        };
        principled.opacity = self.textures.number(factor, texture, Channel::A);
        if material.alpha_mode == AlphaMode::Mask {
            principled.alpha_cutoff = Some((material.alpha_cutoff as f32).clamp(0.0, 1.0));
        }
    }

    /// Material that shows its color without lighting.
    fn unlit(&mut self, material: &Material, at: &str) -> AnyMaterial {
        self.warnings.add(at, "is unlit and becomes a surface that emits its color", 1);
        let model = &material.pbr_metallic_roughness;
        let [r, g, b, _] = model.base_color_factor;
        let radiance = self.textures.color([r, g, b], model.base_color_texture.as_ref());
        Emissive { radiance, sides: Sides::Both, ..Emissive::default() }.into()
    }
}
