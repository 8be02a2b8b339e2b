//! Inputs of textures and materials: constants, textures, and products with attributes of meshes.

use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Number or color: a constant, a texture (inline or by name) whose value varies over the surface,
/// or a product of a texture, a factor and an attribute of the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, a color, the name of a texture or a product")]
#[schemars(rename = "Input_{T}")]
pub enum Input<T> {
    /// Constant value.
    Value(T),
    /// Name of a texture of the scene.
    Texture(String),
    /// Product of a texture, a factor and an attribute of the mesh.
    Product(Box<InputProduct<T>>),
}

/// Product of a texture, a factor and an attribute of the mesh. At least a texture or an attribute
/// is required. Products outside of the input's range are clamped, as values of textures are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InputProduct_{T}")]
pub struct InputProduct<T> {
    /// Texture: inline, or the name of one. Numbers use its luminance. Without it, the product
    /// consists of the other parts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub texture: Option<TextureRef>,
    /// Constant factor, in the range of the input; without it, 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub factor: Option<T>,
    /// Name of an attribute of the mesh, such as `color`. Colors use its red, green and blue,
    /// numbers its alpha, which is 1 where the attribute has fewer than four channels. Surfaces
    /// without an attribute of this name count as white. For other channels, use the texture
    /// `attribute`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attribute: Option<String>,
}

/// Inline texture, or the name of one of the scene's textures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "the name of a texture")]
pub enum TextureRef {
    /// Name of a texture of the scene.
    Name(String),
}

/// Value that an input gives: a number or a color.
pub trait InputValue: Copy + PartialEq {
    /// Zero in every channel.
    const ZERO: Self;
    /// One in every channel.
    const ONE: Self;
}

impl InputValue for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

impl InputValue for Rgb {
    const ZERO: Self = Self::BLACK;
    const ONE: Self = Self::WHITE;
}

/// Constant number.
impl From<f32> for Input<f32> {
    fn from(number: f32) -> Self {
        Self::Value(number)
    }
}

/// Constant number, rounded to the nearest `f32`. Literals such as `0.6` have this type.
impl From<f64> for Input<f32> {
    fn from(number: f64) -> Self {
        Self::Value(number as f32)
    }
}

/// Constant color.
impl From<Rgb> for Input<Rgb> {
    fn from(color: Rgb) -> Self {
        Self::Value(color)
    }
}

/// Constant color, linear red, green and blue.
impl From<[f32; 3]> for Input<Rgb> {
    fn from(channels: [f32; 3]) -> Self {
        Self::Value(channels.into())
    }
}

/// Constant gray.
impl From<f32> for Input<Rgb> {
    fn from(gray: f32) -> Self {
        Self::Value(Rgb::splat(gray))
    }
}

/// Constant gray, rounded to the nearest `f32`. Literals such as `0.6` have this type.
impl From<f64> for Input<Rgb> {
    fn from(gray: f64) -> Self {
        Self::Value(Rgb::splat(gray as f32))
    }
}

/// Name of a texture of the scene.
impl From<&str> for Input<f32> {
    fn from(texture: &str) -> Self {
        Self::Texture(texture.to_owned())
    }
}

/// Name of a texture of the scene.
impl From<String> for Input<f32> {
    fn from(texture: String) -> Self {
        Self::Texture(texture)
    }
}

/// Color `"#rrggbb"` or `"#rgb"` as in scene files, or the name of a texture of the scene.
impl From<&str> for Input<Rgb> {
    fn from(text: &str) -> Self {
        Rgb::from_hex(text).map_or_else(|| Self::Texture(text.to_owned()), Self::Value)
    }
}

/// Color `"#rrggbb"` or `"#rgb"` as in scene files, or the name of a texture of the scene.
impl From<String> for Input<Rgb> {
    fn from(text: String) -> Self {
        text.as_str().into()
    }
}

/// Zero in every channel.
impl<T: InputValue> Default for Input<T> {
    fn default() -> Self {
        Self::Value(T::ZERO)
    }
}

impl<T: InputValue> Input<T> {
    /// Product of a texture and a factor.
    pub fn product(texture: impl Into<String>, factor: T) -> Self {
        let texture = Some(TextureRef::Name(texture.into()));
        Self::Product(Box::new(InputProduct { texture, factor: Some(factor), attribute: None }))
    }

    /// Attribute of the mesh: its red, green and blue for colors, its alpha for numbers.
    pub fn attribute(name: impl Into<String>) -> Self {
        Self::Product(Box::new(InputProduct { texture: None, factor: None, attribute: Some(name.into()) }))
    }

    /// Constant value or factor, which the range of the input limits; `None` for a texture alone.
    pub fn constant_factor(&self) -> Option<T> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Texture(_) => None,
            Self::Product(product) => product.factor,
        }
    }

    /// Value, if it is the same everywhere; a product with the factor 0 is 0.
    pub fn constant(&self) -> Option<T> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Texture(_) => None,
            Self::Product(product) => product.factor.filter(|factor| *factor == T::ZERO),
        }
    }
}

impl<T> InputProduct<T> {
    /// Name of the texture.
    pub fn texture_name(&self) -> Option<&str> {
        self.texture.as_ref().map(|TextureRef::Name(name)| name.as_str())
    }

    /// Message about a missing part of the product of `field`, if one is missing.
    pub(super) fn error(&self, field: &str) -> Option<String> {
        match &self.attribute {
            None if self.texture.is_none() => {
                Some(format!("the product `{field}` needs a `texture` or an `attribute`"))
            }
            Some(name) if name.is_empty() => Some(format!("the `attribute` of `{field}` must not be empty")),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(json: &str) -> Result<Input<Rgb>, serde_json::Error> {
        serde_json::from_str(json)
    }

    #[test]
    fn all_forms_round_trip() {
        for json in [
            "[1.0,0.5,0.0]",
            r#""wood""#,
            r#"{"texture":"wood"}"#,
            r#"{"texture":"wood","factor":[1.0,0.5,0.0]}"#,
            r#"{"attribute":"color"}"#,
            r#"{"texture":"wood","factor":[0.5,0.5,0.25],"attribute":"color"}"#,
        ] {
            assert_eq!(serde_json::to_string(&read(json).unwrap()).unwrap(), json);
        }
        assert_eq!(read(r##"{"texture": "t", "factor": "#ffffff"}"##).unwrap(), Input::product("t", Rgb::WHITE));
        let number = serde_json::from_str::<Input<f32>>(r#"{"texture": "t", "factor": 0.25}"#).unwrap();
        assert_eq!(number, Input::product("t", 0.25));
        assert_eq!(read(r#"{"attribute": "color"}"#).unwrap(), Input::attribute("color"));
        assert!(read(r#"{"checker": {}}"#).is_err() && read(r#"{"texture": "t", "scale": 1}"#).is_err());
    }

    #[test]
    fn numbers_colors_and_names_convert() {
        let numbers: [Input<f32>; 4] = [0.6.into(), 0.6_f32.into(), "wood".into(), String::from("wood").into()];
        let wood = Input::Texture("wood".into());
        assert_eq!(numbers, [Input::Value(0.6), Input::Value(0.6), wood.clone(), wood]);
        let gray = Input::Value(Rgb::splat(0.6));
        let grays: [Input<Rgb>; 4] = [0.6.into(), 0.6_f32.into(), [0.6; 3].into(), Rgb::splat(0.6).into()];
        assert_eq!(grays, std::array::from_fn(|_| gray.clone()));
        assert_eq!(Input::<Rgb>::from("wood"), Input::Texture("wood".into()));
    }

    #[test]
    fn texts_are_colors_or_names() {
        for text in ["#ff0000", "#f00", "wood", "#wood"] {
            assert_eq!(Input::<Rgb>::from(text), read(&format!("\"{text}\"")).unwrap_or(Input::Texture(text.into())));
        }
        assert_eq!(Input::<Rgb>::from("#f00".to_owned()), Input::Value(Rgb::new(1.0, 0.0, 0.0)));
        assert_eq!(Input::<Rgb>::from("wood"), Input::Texture("wood".into()));
        assert_eq!(Input::<f32>::from("#f00"), Input::Texture("#f00".into()));
    }

    #[test]
    fn products_are_constant_only_under_the_factor_zero() {
        assert_eq!(Input::product("t", 0.0).constant(), Some(0.0));
        assert_eq!(Input::product("t", 0.5).constant(), None);
        assert_eq!(Input::product("t", 0.5).constant_factor(), Some(0.5));
        assert_eq!(Input::<f32>::from(0.5).constant(), Some(0.5));
        assert_eq!(Input::<f32>::Texture("t".into()).constant_factor(), None);
    }
}
