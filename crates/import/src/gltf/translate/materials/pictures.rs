//! Pictures of textures: which of the images of a texture is used, and its content.

use crate::gltf::data::GltfData;
use crate::gltf::document::{Document, Index, Texture};
use crate::gltf::error::Fault;
use crate::gltf::ktx2::{self, Ktx2Error, Ktx2Picture};
use crate::gltf::media::{KTX2, MAX_TEXELS};
use crate::gltf::uri::Uri;
use crate::gltf::warning::Warnings;
use crate::textures::picture_asset_name;
use indexmap::{IndexMap, IndexSet};
use juggler_scene::Asset;

const BASISU: &str = "KHR_texture_basisu";

/// Pictures that textures use.
#[derive(Debug)]
pub struct Pictures<'a> {
    document: &'a Document,
    data: &'a GltfData,
    prefix: &'a str,
    /// Names of the images, without the prefix.
    names: IndexSet<String>,
    /// Pictures by name.
    pub assets: IndexMap<String, Asset>,
}

/// A picture that a texture uses.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of the asset.
    pub file: String,
    /// Name for people.
    pub name: String,
}

impl<'a> Pictures<'a> {
    /// No pictures yet.
    pub fn new(document: &'a Document, data: &'a GltfData, prefix: &'a str) -> Self {
        let names = super::unique_names("image", document.images.iter().map(|image| image.name.as_deref()));
        Self { document, data, prefix, names, assets: IndexMap::new() }
    }

    /// Whether the picture of a texture is missing or broken and lenient files allow it.
    pub fn is_lost(&self, texture: &Texture) -> bool {
        let basisu = texture.extensions.basisu.and_then(|basisu| basisu.source);
        let webp = texture.extensions.webp.and_then(|webp| webp.source);
        basisu.or(webp).or(texture.source).is_some_and(|image| self.data.is_lost(image.get()))
    }

    /// Picture of a texture: KTX2 before WebP before PNG and JPEG. `None` if the texture has none,
    /// or if it is lost.
    ///
    /// # Errors
    ///
    /// The picture cannot be read, and the texture has no other, or the document requires it.
    pub fn picture(&mut self, texture: &Texture, warnings: &mut Warnings) -> Result<Option<Picture>, Fault> {
        if self.is_lost(texture) {
            return Ok(None);
        }
        let webp = texture.extensions.webp.and_then(|webp| webp.source);
        let plain = webp.or(texture.source);
        let Some(basisu) = texture.extensions.basisu.and_then(|basisu| basisu.source) else {
            return plain.map(|image| self.add(image)).transpose();
        };
        let is_required = self.document.extensions_required.iter().any(|name| name == BASISU);
        match (self.add(basisu), plain) {
            (Ok(picture), _) => Ok(Some(picture)),
            (Err(_), Some(plain)) if !cfg!(feature = "ktx2") && !is_required => {
                let text = format!("{}; the plain image is shown", Ktx2Error::Disabled);
                warnings.add(self.data.image_place(basisu), text, 1);
                self.add(plain).map(Some)
            }
            (Err(fault), _) => Err(fault),
        }
    }

    /// Adds an image at its first use.
    fn add(&mut self, image: Index) -> Result<Picture, Fault> {
        let at = self.data.image_place(image);
        let missing = || Fault::at(&at, "the picture has not been read");
        let asset = self.data.image_asset(image.get()).ok_or_else(missing)?;
        let encoded = asset.bytes().filter(|bytes| bytes.starts_with(KTX2));
        let names = self.document.images.get(image.get()).and_then(|image| Uri::parse(image.uri.as_deref()?).ok());
        let name = names.as_ref().and_then(Uri::file_name);
        let name = picture_asset_name(image, name, asset.bytes().unwrap_or_default());
        // A KTX2 picture becomes a PNG.
        let file = format!("{}{name}{}", self.prefix, if encoded.is_some() { ".png" } else { "" });
        if !self.assets.contains_key(&file) {
            let convert = |bytes: &[u8]| {
                let picture = ktx2::decode(bytes, MAX_TEXELS).and_then(|picture| pixels(&picture));
                picture.map_err(|error| Fault::at(&at, error))
            };
            let decoded = encoded.map(|bytes| self.data.image_replacement(image.get(), || convert(bytes)));
            let decoded = decoded.transpose()?;
            self.assets.insert(file.clone(), decoded.unwrap_or(asset));
        }
        let name = self.names.get_index(image.get()).cloned().unwrap_or_default();
        Ok(Picture { file, name })
    }
}

/// Decoded picture as an asset.
#[cfg(feature = "ktx2")]
fn pixels(picture: &Ktx2Picture) -> Result<Asset, Ktx2Error> {
    let failed = |error: png::EncodingError| Ktx2Error::Decoder { message: error.to_string() };
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fastest);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&picture.rgba).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(Asset::from_bytes(file))
}

/// Decoded picture as an asset.
#[cfg(not(feature = "ktx2"))]
fn pixels(_picture: &Ktx2Picture) -> Result<Asset, Ktx2Error> {
    Err(Ktx2Error::Disabled)
}
