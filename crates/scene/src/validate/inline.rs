//! Textures that are written where a name may stand: each gets a name, its place as a JSON pointer such as
//! `/materials/red/phong/diffuse`, and joins the scene's textures.

use super::Walk;
use super::rule::Way;
use super::words;
use crate::document::Node;
use crate::path::{Path, Trail};
use crate::report::Finding;
use serde_json::{Map, Value};

/// Whether a way to write a value is a texture written in place.
pub fn is_texture(way: &Way) -> bool {
    way.rule.name == Some("AnyTexture") && way.owner.map(words::family) == Some("Input")
}

impl Walk<'_> {
    /// The name that a texture written in place gets.
    pub(super) fn texture(&mut self, node: &Node, at: &Trail<'_>, way: &Way) -> Option<Value> {
        let texture = self.value(node, at, way.rule.get())?;
        let name = Path::from(at).pointer();
        self.textures.push((name.clone(), texture));
        Some(name.into())
    }

    /// Adds the textures that were written in place to those of a scene, and returns their names.
    pub(super) fn add_textures(&mut self, scene: &mut Map<String, Value>) -> Vec<(String, Value)> {
        if self.textures.is_empty() {
            return Vec::new();
        }
        let named = scene.entry("textures").or_insert_with(|| Value::Object(Map::new()));
        let Some(named) = named.as_object_mut() else { return Vec::new() };
        let mut added = Vec::new();
        for (name, texture) in std::mem::take(&mut self.textures) {
            if named.contains_key(&name) {
                let finding =
                    Finding::error(format!("a texture written in place is called `{name}`, as one of `textures` is"));
                self.findings
                    .push(finding.at(Path::from_pointer(&name)).help("give the texture in `textures` another name"));
                continue;
            }
            added.push((name.clone(), Value::Null));
            named.insert(name, texture);
        }
        added
    }
}
