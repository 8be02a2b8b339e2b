//! Textures that are written where a name may stand: each gets a name, its place as a JSON pointer such as
//! `/materials/red/phong/diffuse`, and joins the scene's textures.

use super::rule::Way;
use super::{Plain, Walk, words};
use crate::document::Node;
use crate::path::{Path, Trail};
use crate::report::Finding;
use std::borrow::Cow;
use std::collections::HashSet;

/// Whether a way to write a value is a texture written in place.
pub fn is_texture(way: &Way) -> bool {
    way.rule.name == Some("AnyTexture") && way.owner.map(words::family) == Some("Input")
}

impl Walk<'_> {
    /// The name that a texture written in place gets.
    pub(super) fn texture(&mut self, node: &Node, at: &Trail<'_>, way: &Way) -> Option<Plain> {
        let texture = self.value(node, at, way.rule.get())?;
        let name = Path::from(at).pointer();
        self.textures.push((name.clone(), texture));
        Some(Plain::String(name))
    }

    /// Adds the textures that were written in place to those of a scene, and returns their names.
    pub(super) fn add_textures(&mut self, scene: &mut Vec<(Cow<'static, str>, Plain)>) -> Vec<(String, Plain)> {
        if self.textures.is_empty() {
            return Vec::new();
        }
        if !scene.iter().any(|(key, _)| key == "textures") {
            scene.push(("textures".into(), Plain::Object(Vec::new())));
        }
        let named = scene.iter_mut().find(|(key, _)| key == "textures");
        let Some((_, Plain::Object(named))) = named else { return Vec::new() };
        let known: HashSet<Cow<'static, str>> = named.iter().map(|(name, _)| name.clone()).collect();
        let mut added = Vec::new();
        for (name, texture) in std::mem::take(&mut self.textures) {
            if known.contains(name.as_str()) {
                let finding =
                    Finding::error(format!("a texture written in place is called `{name}`, as one of `textures` is"));
                self.findings
                    .push(finding.at(Path::from_pointer(&name)).help("give the texture in `textures` another name"));
                continue;
            }
            added.push((name.clone(), Plain::Null));
            named.push((name.into(), texture));
        }
        added
    }
}
