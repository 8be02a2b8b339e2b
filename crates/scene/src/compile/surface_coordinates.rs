//! Materials whose textures vary over the surface coordinates, which some meshes lack.

use crate::description::Description;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_texture::TextureTable;
use serde_json::Value;
use std::collections::BTreeSet;

/// Maximum depth of nested materials that are searched.
const MAX_DEPTH: u32 = 32;

/// Names of the textures and materials of a scene that vary over the surface coordinates.
#[derive(Default)]
pub struct OverUv {
    textures: BTreeSet<String>,
    materials: BTreeSet<String>,
}

impl OverUv {
    /// Searches a scene's named materials.
    pub fn new(scene: &Description, textures: &TextureTable) -> Self {
        let textures = textures.names().filter(|name| textures.is_over_uv(name)).map(str::to_owned).collect();
        let mut found = Self { textures, materials: BTreeSet::new() };
        if !found.textures.is_empty() {
            let named = scene.materials.iter().filter(|(_, material)| found.uses(material, scene, MAX_DEPTH));
            found.materials = named.map(|(name, _)| name.clone()).collect();
        }
        found
    }

    /// Whether a material, or one inside it, has a texture over the surface coordinates.
    pub fn contains(&self, material: &MaterialRef, scene: &Description) -> bool {
        match material {
            MaterialRef::Name(name) => self.materials.contains(name),
            MaterialRef::Inline(material) => !self.textures.is_empty() && self.uses(material, scene, MAX_DEPTH),
        }
    }

    fn uses(&self, material: &AnyMaterial, scene: &Description, depth: u32) -> bool {
        let nested = material.nested_materials();
        let json = serde_json::to_value(material).unwrap_or_default();
        let settings = json.as_object().and_then(|kind| kind.values().next()).and_then(Value::as_object);
        let own = settings.into_iter().flatten().filter(|(field, _)| nested.iter().all(|(other, _)| other != field));
        own.into_iter().any(|(_, value)| self.names_texture(value))
            || depth > 0 && nested.iter().any(|(_, material)| self.nested_uses(material, scene, depth - 1))
    }

    fn nested_uses(&self, material: &MaterialRef, scene: &Description, depth: u32) -> bool {
        match material {
            MaterialRef::Inline(material) => self.uses(material, scene, depth),
            MaterialRef::Name(name) => {
                scene.materials.get(name).is_some_and(|material| self.uses(material, scene, depth))
            }
        }
    }

    /// Whether a setting is the name of such a texture or contains it.
    fn names_texture(&self, value: &Value) -> bool {
        match value {
            Value::String(name) => self.textures.contains(name),
            Value::Array(values) => values.iter().any(|value| self.names_texture(value)),
            Value::Object(fields) => fields.values().any(|value| self.names_texture(value)),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Scene;

    fn report(texture: &str, material: &str, uvs: &str) -> String {
        let mesh =
            format!(r#"{{"mesh": {{"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]{uvs}}}}}"#);
        let text = format!(
            r#"{{"version": 1, "textures": {{"pattern": {texture}}},
                "materials": {{"named": {{"diffuse": {{"reflectance": "pattern"}}}}}},
                "objects": [{{"shape": {mesh}, "material": {material}}}]}}"#
        );
        Scene::from_json(text, "test.json").unwrap().check().to_string()
    }

    #[test]
    fn meshes_without_surface_coordinates_under_such_textures_are_reported() {
        let (board, inline) = (r#"{"checker": {}}"#, r#"{"diffuse": {"reflectance": "pattern"}}"#);
        let coat = r#"{"mask": {"opacity": 1, "material": "named"}}"#;
        let message = "the mesh has no surface coordinates: use space `local` or `triplanar`";
        for material in [r#""named""#, inline, coat] {
            let found = report(board, material, "");
            assert_eq!(found.matches(message).count(), 1, "{material}: {found}");
            let uvs = r#", "uvs": [[0, 0], [1, 0], [0, 1]]"#;
            assert!(!report(board, material, uvs).contains(message));
            assert!(!report(r#"{"checker": {"space": "local"}}"#, material, "").contains(message));
        }
        assert!(!report(board, r#"{"diffuse": {}}"#, "").contains(message));
    }
}
