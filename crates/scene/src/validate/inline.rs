//! Inline textures, which are written in place of a texture's name. Each is added to the scene's
//! textures under its JSON pointer as its name, such as `/materials/red/phong/diffuse`.

use super::rule::Alternative;
use super::{Plain, Validator, wording};
use crate::document::{Node, Value as NodeValue};
use crate::path::{Path, PathRef};
use crate::report::Finding;
use std::borrow::Cow;
use std::collections::HashSet;

/// Whether a form of a value is an inline texture.
pub fn is_texture(alternative: &Alternative) -> bool {
    alternative.rule.name == Some("AnyTexture") && alternative.owner.is_some_and(wording::names_textures)
}

/// Whether an object has to be a form. A product and an inline texture are both objects: a product
/// has a part, and `attribute` is the name of one there, but also the kind of a texture, which has
/// settings.
pub fn suits(node: &Node, alternative: &Alternative) -> bool {
    let NodeValue::Object(members) = &node.value else { return true };
    let is_part = |key: &str| match key {
        "attribute" => members.get(key).is_some_and(|member| !matches!(member.node.value, NodeValue::Object(_))),
        key => members.get(key).is_some(),
    };
    !alternative.rule.name.is_some_and(wording::is_product)
        || ["texture", "factor", "attribute"].into_iter().any(is_part)
}

impl Validator<'_> {
    /// Checks an inline texture. Returns the name that it gets.
    pub(super) fn texture(&mut self, node: &Node, at: &PathRef<'_>, alternative: &Alternative) -> Option<Plain> {
        let texture = self.value(node, at, alternative.rule.get())?;
        let name = Path::from(at).pointer();
        self.textures.push((name.clone(), texture));
        Some(Plain::String(name))
    }

    /// Adds the inline textures to those of a scene. Returns their names, each with `Null`.
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
                    Finding::error(format!("the name `{name}` of the inline texture is already used in `textures`"));
                self.findings.push(finding.at(Path::from_pointer(&name)).help("rename the texture in `textures`"));
                continue;
            }
            added.push((name.clone(), Plain::Null));
            named.push((name.into(), texture));
        }
        added
    }
}
