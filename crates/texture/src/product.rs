//! Products of textures, factors and attributes of meshes, with their names resolved.

use super::{InputProduct, InputValue, TextureId, TextureLookup, TextureTable, attribute};
use juggler_math::Rgb;

/// Largest magnitude of a product; products of two of these stay finite after clamping.
const MAX_PRODUCT: f32 = 1e37;

/// An [`InputProduct`] with its name resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct CompiledProduct<T> {
    texture: Option<TextureId>,
    factor: T,
    attribute: Option<String>,
}

impl<T: InputValue> CompiledProduct<T> {
    /// Product with the id of its texture.
    pub(super) fn new(product: &InputProduct<T>, texture: Option<TextureId>) -> Self {
        let factor = product.factor.unwrap_or(T::ONE);
        Self { texture, factor, attribute: product.attribute.clone() }
    }

    /// Color of the texture; white without one.
    fn texture(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        self.texture.map_or(Rgb::WHITE, |id| textures.texture_color(id, at))
    }

    /// Red, green, blue and alpha of the attribute; white without one.
    fn attribute(&self, at: &TextureLookup) -> [f32; 4] {
        self.attribute.as_ref().map_or([1.0; 4], |name| attribute::value(name, at))
    }
}

impl CompiledProduct<Rgb> {
    /// Color at a point; finite.
    #[cold]
    pub(super) fn color(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let [r, g, b, _] = self.attribute(at);
        (self.texture(textures, at) * self.factor * Rgb::new(r, g, b)).map(bounded)
    }
}

impl CompiledProduct<f32> {
    /// Number at a point, from the luminance of the texture and the alpha of the attribute; finite.
    #[cold]
    pub(super) fn number(&self, textures: &TextureTable, at: &TextureLookup) -> f32 {
        let [.., alpha] = self.attribute(at);
        let texture = self.texture.map_or(1.0, |id| textures.texture_color(id, at).luminance());
        bounded(texture * self.factor * alpha)
    }
}

/// Value of magnitude [`MAX_PRODUCT`] or less; 0 for NaN.
fn bounded(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(-MAX_PRODUCT, MAX_PRODUCT) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Input, InputError, MAX_LOOKUPS, Slot};
    use juggler_math::{Vec2, Vec3};
    use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
    use juggler_shape::{MeshData, MeshPoint};

    fn table() -> TextureTable {
        let textures = r#"{"t": {"constant": {"color": [0.5, 0.25, 1]}}, "huge": {"constant": {"color": 1e37}},
            "nested": {"mix": {"a": {"texture": "t", "factor": [2, 4, 0]}, "b": 0, "amount": 0.5}}}"#;
        let named: std::collections::BTreeMap<String, crate::AnyTexture> = serde_json::from_str(textures).unwrap();
        let (table, errors) = TextureTable::compile(named, &crate::NoImages);
        assert!(errors.is_empty(), "{errors:?}");
        table
    }

    fn color(json: &str, at: &TextureLookup) -> Rgb {
        let table = table();
        table.color(&table.resolve("base", &serde_json::from_str::<Input<Rgb>>(json).unwrap()).unwrap(), at)
    }

    fn number(json: &str, at: &TextureLookup) -> f32 {
        let table = table();
        table.number(&table.resolve("opacity", &serde_json::from_str::<Input<f32>>(json).unwrap()).unwrap(), at)
    }

    fn mesh() -> MeshData {
        let data = AttributeData::F32([1.0, 0.5, 0.25, 0.5].repeat(3));
        let color = MeshAttribute { domain: AttributeDomain::Vertex, channels: 4, data };
        let data = AttributeData::F32(vec![f32::NAN]);
        let broken = MeshAttribute { domain: AttributeDomain::Face, channels: 1, data };
        MeshData {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            attributes: [("color".to_owned(), color), ("broken".to_owned(), broken)].into(),
            ..MeshData::default()
        }
    }

    #[test]
    fn products_multiply_their_parts() {
        let mesh = mesh();
        let point = MeshPoint::new(&mesh, 0, Vec2::new(0.25, 0.25));
        let at = TextureLookup { mesh: Some(&point), ..TextureLookup::default() };
        let close = |a: Rgb, b: Rgb| (a - b).map(f32::abs).max_channel() < 1e-6;
        let all = r#"{"texture": "t", "factor": [0.5, 1, 2], "attribute": "color"}"#;
        assert!(close(color(all, &at), Rgb::new(0.25, 0.125, 0.5)));
        assert!(close(color(all, &TextureLookup::default()), Rgb::new(0.25, 0.25, 2.0)), "no attribute is white");
        assert!(close(color(r#"{"attribute": "color"}"#, &at), Rgb::new(1.0, 0.5, 0.25)));
        assert!(close(color(r#"{"texture": "nested", "factor": 0.5}"#, &at), Rgb::new(0.25, 0.25, 0.0)));
        assert_eq!(color(r#"{"attribute": "none", "factor": [3, 2, 1]}"#, &at), Rgb::new(3.0, 2.0, 1.0));
        let luminance = Rgb::new(0.5, 0.25, 1.0).luminance();
        let number = number(r#"{"texture": "t", "factor": 0.5, "attribute": "color"}"#, &at);
        assert!((number - luminance * 0.25).abs() < 1e-6, "{number}");
    }

    #[test]
    fn products_are_finite() {
        let mesh = mesh();
        let point = MeshPoint::new(&mesh, 0, Vec2::new(0.25, 0.25));
        let at = TextureLookup { mesh: Some(&point), ..TextureLookup::default() };
        assert_eq!(color(r#"{"texture": "huge", "factor": 1e37}"#, &at), Rgb::splat(1e37));
        assert_eq!(number(r#"{"texture": "huge", "factor": -1e37}"#, &at), -1e37);
        assert_eq!(color(r#"{"texture": "huge", "attribute": "broken"}"#, &at).r, 0.0);
    }

    #[test]
    fn products_lack_no_part_and_cost_nothing_under_the_factor_zero() {
        let resolve = |json: &str| table().resolve("base", &serde_json::from_str::<Input<Rgb>>(json).unwrap());
        for json in ["{}", r#"{"factor": 0.5}"#, r#"{"texture": "t", "attribute": ""}"#] {
            assert!(matches!(resolve(json), Err(InputError::Incomplete { field: "base", .. })), "{json}");
        }
        assert_eq!(resolve(r#"{"texture": "t", "factor": 0}"#), Ok(Slot::Value(Rgb::BLACK)));
        assert!(resolve(r#"{"texture": "t"}"#).unwrap().is_texture());
    }

    #[test]
    fn textures_in_products_count_as_lookups() {
        let next = |i: u32| format!(r#"{{"mix": {{"a": {{"texture": "{0}"}}, "b": {{"texture": "{0}"}}}}}}"#, i + 1);
        let named = (0..20).map(|i| (format!("{i}"), serde_json::from_str(&next(i)).unwrap()));
        let last = ("20".to_owned(), serde_json::from_str(r#"{"mix": {}}"#).unwrap());
        let errors = TextureTable::compile(named.chain([last]), &crate::NoImages).1;
        let message = errors.first().unwrap().1.to_string();
        assert!(message.contains(&MAX_LOOKUPS.to_string()), "{message}");
    }
}
