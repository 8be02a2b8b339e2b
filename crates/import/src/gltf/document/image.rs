//! Images, samplers and textures (glTF 2.0, section 3.8), with KHR_texture_transform,
//! KHR_texture_basisu and EXT_texture_webp.

use super::number::Index;
use serde::Deserialize;

/// An image in a file, in a data URI or in a buffer view.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Image {
    /// URI of the file, or a data URI.
    pub uri: Option<String>,
    /// MIME type: only a hint, because the reader detects the type from the content.
    pub mime_type: Option<String>,
    /// Index of the buffer view that contains the encoded image.
    pub buffer_view: Option<Index>,
    /// Name for people.
    pub name: Option<String>,
}

/// An image with a sampler.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Texture {
    /// Index of the sampler. Without it, the texture repeats along u and v.
    pub sampler: Option<Index>,
    /// Index of the image, a PNG or JPEG.
    pub source: Option<Index>,
    /// Name for people.
    pub name: Option<String>,
    /// Extensions.
    #[serde(default)]
    pub extensions: TextureExtensions,
}

/// Extensions of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub struct TextureExtensions {
    /// KTX2 image with Basis Universal compression.
    #[serde(rename = "KHR_texture_basisu")]
    pub basisu: Option<AlternativeSource>,
    /// WebP image.
    #[serde(rename = "EXT_texture_webp")]
    pub webp: Option<AlternativeSource>,
}

/// Image of another format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub struct AlternativeSource {
    /// Index of the image.
    pub source: Option<Index>,
}

/// Filters and wrap modes of a texture.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Sampler {
    /// Filter of magnified textures.
    pub mag_filter: Option<MagFilter>,
    /// Filter of minified textures.
    pub min_filter: Option<MinFilter>,
    /// Wrap mode along u.
    #[serde(default)]
    pub wrap_s: Wrap,
    /// Wrap mode along v.
    #[serde(default)]
    pub wrap_t: Wrap,
    /// Name for people.
    pub name: Option<String>,
}

/// Filter of magnified textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Index")]
pub enum MagFilter {
    /// Nearest texel.
    Nearest,
    /// Bilinear interpolation.
    Linear,
}

impl TryFrom<Index> for MagFilter {
    type Error = String;

    fn try_from(number: Index) -> Result<Self, String> {
        match number.get() {
            9728 => Ok(Self::Nearest),
            9729 => Ok(Self::Linear),
            _ => Err(format!("there is no magnification filter {number}, expected 9728 or 9729")),
        }
    }
}

/// Filter of minified textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Index")]
pub enum MinFilter {
    /// Nearest texel, without mip levels.
    Nearest,
    /// Bilinear interpolation, without mip levels.
    Linear,
    /// Nearest texel of the nearest mip level.
    NearestMipmapNearest,
    /// Bilinear interpolation in the nearest mip level.
    LinearMipmapNearest,
    /// Nearest texels of two mip levels.
    NearestMipmapLinear,
    /// Trilinear interpolation.
    LinearMipmapLinear,
}

impl TryFrom<Index> for MinFilter {
    type Error = String;

    fn try_from(number: Index) -> Result<Self, String> {
        match number.get() {
            9728 => Ok(Self::Nearest),
            9729 => Ok(Self::Linear),
            9984 => Ok(Self::NearestMipmapNearest),
            9985 => Ok(Self::LinearMipmapNearest),
            9986 => Ok(Self::NearestMipmapLinear),
            9987 => Ok(Self::LinearMipmapLinear),
            _ => Err(format!("there is no minification filter {number}, expected 9728, 9729 or 9984 to 9987")),
        }
    }
}

/// Continuation of a texture outside of the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Index")]
pub enum Wrap {
    /// The texels at the edge extend outwards.
    ClampToEdge,
    /// The texture repeats, mirrored every other time.
    MirroredRepeat,
    /// The texture repeats.
    #[default]
    Repeat,
}

impl TryFrom<Index> for Wrap {
    type Error = String;

    fn try_from(number: Index) -> Result<Self, String> {
        match number.get() {
            33071 => Ok(Self::ClampToEdge),
            33648 => Ok(Self::MirroredRepeat),
            10497 => Ok(Self::Repeat),
            _ => Err(format!("there is no wrap mode {number}, expected 33071, 33648 or 10497")),
        }
    }
}

/// Reference of a material to a texture.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct TextureInfo {
    /// Index of the texture.
    pub index: Index,
    /// Index n of the set of texture coordinates, `TEXCOORD_n`.
    #[serde(default)]
    pub tex_coord: Index,
    /// Factor on the x and y components of normals; normal textures only.
    #[serde(default = "one")]
    pub scale: f64,
    /// Strength of the occlusion, 0 (none) to 1; occlusion textures only.
    #[serde(default = "one")]
    pub strength: f64,
    /// Extensions.
    #[serde(default)]
    pub extensions: TextureInfoExtensions,
}

/// Extensions of a reference to a texture.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct TextureInfoExtensions {
    /// Transform of the texture coordinates.
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<Box<TextureTransform>>,
}

/// Transform of texture coordinates: scale, then rotation, then offset, with v downwards
/// (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct TextureTransform {
    /// Offset along u and v.
    pub offset: [f64; 2],
    /// Counter-clockwise rotation in radians.
    pub rotation: f64,
    /// Scale factors along u and v.
    pub scale: [f64; 2],
    /// Index of the set of texture coordinates, in place of [`TextureInfo::tex_coord`].
    pub tex_coord: Option<Index>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

impl TextureInfo {
    /// Index of the set of texture coordinates that the reference uses.
    pub fn set(&self) -> Index {
        self.extensions.transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(self.tex_coord)
    }
}

fn one() -> f64 {
    1.0
}
