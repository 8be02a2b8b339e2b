//! Textures of a model's materials: each distinct texture is added once, under a unique name.

use crate::gltf::picture_extension;
use indexmap::IndexMap;
use juggler_texture::{AnyTexture, Channel, Input, InputProduct, InputValue, TextureRef};
use std::collections::BTreeMap;
use std::fmt::Display;

/// Gray in place of a picture that is missing or broken, for lenient readers.
pub const LOST_PICTURE: f32 = 0.5;

/// Name of the vertex colors among the attributes of meshes.
pub const VERTEX_COLORS: &str = "color";

/// Maximum number of bytes of the name of a picture's file in the name of its asset.
const MAX_FILE_NAME: usize = 100;

/// Name of the asset of a picture, without the prefix of the model: its index, and the name of its
/// file or the extension of its format.
pub fn picture_asset_name(index: impl Display, file: Option<&str>, bytes: &[u8]) -> String {
    let last = file.and_then(|file| file.rsplit('/').next()).filter(|last| last.len() <= MAX_FILE_NAME);
    match last {
        Some(last) if !last.is_empty() => format!("images/{index}-{last}"),
        _ => format!("images/{index}{}", picture_extension(bytes)),
    }
}

/// Textures by name.
#[derive(Debug, Default)]
pub struct NamedTextures {
    /// The textures.
    pub by_name: IndexMap<String, AnyTexture>,
    /// Names of the textures by their content.
    known: BTreeMap<String, String>,
    /// Number of textures for which each name was requested.
    counts: BTreeMap<String, u64>,
}

impl NamedTextures {
    /// Adds a texture, unless an equal one is known, and returns its name: `name`, with a number
    /// appended if another texture has that name.
    pub fn add(&mut self, name: &str, texture: impl Into<AnyTexture>) -> String {
        let texture = texture.into();
        let content = format!("{texture:?}");
        if let Some(known) = self.known.get(&content) {
            return known.clone();
        }
        let mut unique = name.to_owned();
        while self.by_name.contains_key(&unique) {
            let count = self.counts.entry(name.to_owned()).or_insert(1);
            *count = count.saturating_add(1);
            unique = format!("{name}#{count}");
        }
        self.known.insert(content, unique.clone());
        self.by_name.insert(unique.clone(), texture);
        unique
    }
}

/// End of the name of an image texture that reads a channel.
pub fn channel_suffix(channel: Channel) -> &'static str {
    match channel {
        Channel::Rgb => "",
        Channel::R => ".r",
        Channel::G => ".g",
        Channel::B => ".b",
        Channel::A => ".a",
        Channel::Luminance => ".luminance",
    }
}

/// Product of an input and the vertex colors: their RGB for a color, their alpha for a number.
pub fn with_vertex_colors<T: InputValue>(input: Input<T>) -> Input<T> {
    let attribute = Some(VERTEX_COLORS.to_owned());
    let product = match input {
        Input::Value(value) if value == T::ZERO => return Input::Value(value),
        Input::Value(value) => {
            InputProduct { texture: None, factor: Some(value).filter(|value| *value != T::ONE), attribute }
        }
        Input::Texture(name) => InputProduct { texture: Some(TextureRef::Name(name)), factor: None, attribute },
        Input::Product(product) => InputProduct { attribute, ..*product },
    };
    Input::Product(Box::new(product))
}
