//! Attribute of a mesh or of instances as a color, such as vertex colors.
//!
//! ```json
//! {"attribute": {"name": "color", "channel": "rgb"}}
//! ```

use super::{
    Channel, CompiledTexture, InvalidTexture, SharedTexture, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Name of the attribute that is a color from 0 to 1.
const COLOR: &str = "color";

/// Attribute of a mesh, in linear light, interpolated over its triangles, or else of the innermost
/// [instances](#object-instances) that have one of this name. Surfaces without an attribute of this
/// name are white.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Attribute {
    /// Name of the attribute among the `attributes` of the mesh or of its instances. `color`, the
    /// colors of vertices or faces in a model file, is clamped to 0 to 1.
    pub name: String,
    /// Channels that the texture uses. A single channel gives gray. Alpha is 1 where the attribute
    /// has fewer than four channels.
    pub channel: Channel,
}

impl Attribute {
    /// Creates a texture of a mesh's attribute.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }
}

impl Default for Attribute {
    fn default() -> Self {
        Self { name: COLOR.to_owned(), channel: Channel::Rgb }
    }
}

impl Texture for Attribute {
    fn check(&self) -> Result<(), InvalidTexture> {
        if self.name.is_empty() {
            return Err(InvalidTexture::new("name", "`name` must not be empty"));
        }
        Ok(())
    }

    fn compile(&self, _: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledAttribute(self.clone())))
    }
}

/// A compiled [`Attribute`].
#[derive(Clone, Debug)]
pub struct CompiledAttribute(Attribute);

/// Red, green, blue and alpha of an attribute at a point; white where the surface has none of this
/// name.
pub fn value(name: &str, at: &TextureLookup) -> [f32; 4] {
    let Some(value) = at.mesh.and_then(|point| point.attribute(name)) else { return [1.0; 4] };
    // `max` turns NaN into 0.
    if name == COLOR { value.map(|number| number.max(0.0).clamp(0.0, 1.0)) } else { value }
}

impl CompiledTexture for CompiledAttribute {
    fn eval(&self, _textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let Self(Attribute { name, channel }) = self;
        let [r, g, b, a] = value(name, at);
        match channel {
            Channel::Rgb => Rgb::new(r, g, b),
            Channel::R => Rgb::splat(r),
            Channel::G => Rgb::splat(g),
            Channel::B => Rgb::splat(b),
            Channel::A => Rgb::splat(a),
            Channel::Luminance => Rgb::splat(Rgb::new(r, g, b).luminance()),
        }
    }
}

#[cfg(any(test, feature = "testing"))]
impl Attribute {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { name: "heat".to_owned(), channel: Channel::G }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::reader;
    use juggler_math::{Vec2, Vec3};
    use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
    use juggler_shape::{MeshData, MeshPoint};

    fn mesh() -> MeshData {
        let color = MeshAttribute {
            domain: AttributeDomain::Vertex,
            channels: 4,
            data: AttributeData::U8(vec![255, 0, 0, 51, 0, 255, 0, 102, 0, 0, 255, 153]),
        };
        let heat = MeshAttribute { domain: AttributeDomain::Face, channels: 1, data: AttributeData::F32(vec![7.0]) };
        MeshData {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            attributes: [("color".to_owned(), color), ("heat".to_owned(), heat)].into(),
            ..MeshData::default()
        }
    }

    #[test]
    fn attributes_are_interpolated_and_missing_ones_are_white() {
        let mesh = mesh();
        let point = MeshPoint::new(&mesh, 0, Vec2::new(0.25, 0.5));
        let at = TextureLookup { mesh: Some(&point), ..TextureLookup::default() };
        let close = |found: Rgb, expected: [f32; 3]| {
            found.to_array().into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6)
        };
        assert!(close(reader(r#"{"attribute": {}}"#)(&at), [0.25, 0.25, 0.5]));
        assert!(close(reader(r#"{"attribute": {"channel": "a"}}"#)(&at), [0.05 + 0.1 + 0.3; 3]));
        assert!(close(reader(r#"{"attribute": {"name": "heat"}}"#)(&at), [7.0; 3]));
        assert_eq!(reader(r#"{"attribute": {"name": "cold"}}"#)(&at), Rgb::WHITE);
        assert_eq!(reader(r#"{"attribute": {}}"#)(&TextureLookup::default()), Rgb::WHITE);
    }
}
