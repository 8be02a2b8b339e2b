//! Checks that the names in references exist.

use super::rule::Rule;
use super::{Validator, other_programs};
use crate::description::Description;
use crate::document::Node;
use crate::model::has_models;
use crate::path::PathRef;
use crate::report::Finding;
use crate::suggest::{closest, did_you_mean, list_of_known};

/// Families of named items of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedFamily {
    /// In `materials`.
    Material,
    /// In `textures`.
    Texture,
    /// In `groups`.
    Group,
    /// In `cameras`.
    Camera,
}

impl NamedFamily {
    /// Section of the scene that defines the items, and the noun for one of them.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Material => ("materials", "material"),
            Self::Texture => ("textures", "texture"),
            Self::Group => ("groups", "group"),
            Self::Camera => ("cameras", "camera"),
        }
    }
}

/// Set of the names that a scene defines.
#[derive(Clone, Copy)]
pub enum NameScope<'t> {
    /// Names in the tree of a whole scene.
    Tree(&'t Node),
    /// Names in a scene description.
    Scene(&'t Description),
}

impl<'t> NameScope<'t> {
    fn has(self, part: &str, name: &str) -> bool {
        match self {
            Self::Tree(tree) => tree.get(part).is_some_and(|part| part.get(name).is_some()),
            Self::Scene(scene) => match part {
                "materials" => scene.materials.contains_key(name),
                "textures" => scene.textures.contains_key(name),
                "groups" => scene.groups.contains_key(name),
                _ => scene.cameras.contains_key(name),
            },
        }
    }

    /// Whether objects of the scene's own list, or in them, are models.
    fn has_models(self) -> bool {
        fn are_in(objects: Option<&Node>) -> bool {
            let objects = objects.map(Node::elements).unwrap_or_default();
            objects.iter().any(|object| object.get("model").is_some() || are_in(object.get("objects")))
        }
        match self {
            Self::Tree(tree) => are_in(tree.get("objects")),
            Self::Scene(scene) => has_models(scene),
        }
    }

    fn all(self, part: &str) -> Vec<&'t str> {
        match self {
            Self::Tree(tree) => tree.get(part).into_iter().flat_map(Node::members).map(|(name, _)| &**name).collect(),
            Self::Scene(scene) => match part {
                "materials" => scene.materials.keys().map(String::as_str).collect(),
                "textures" => scene.textures.keys().map(String::as_str).collect(),
                "groups" => scene.groups.keys().map(String::as_str).collect(),
                _ => scene.cameras.keys().map(String::as_str).collect(),
            },
        }
    }
}

impl Validator<'_> {
    /// Whether the scene defines a texture of this name.
    pub(super) fn has_texture(&self, name: &str) -> bool {
        self.known.has(NamedFamily::Texture.words().0, name)
    }

    /// Reports an error if the scene does not define a name.
    pub(super) fn check_reference(
        &mut self,
        family: NamedFamily,
        node: &Node,
        name: &str,
        at: &PathRef<'_>,
        rule: &'static Rule,
    ) {
        let (part, noun) = family.words();
        // The cameras of models are known when the models are expanded, which checks the name.
        if self.known.has(part, name) || family == NamedFamily::Camera && self.known.has_models() {
            return;
        }
        let known = self.known;
        let help = self.suggestion(|| {
            let names = known.all(part);
            if let Some(near) = closest(name, names.iter().copied()) {
                return Some(did_you_mean(near));
            }
            if let Some(help) = rule.rewritten(node, at) {
                return Some(help);
            }
            let kind = (family == NamedFamily::Material).then(|| kind_of_material(name)).flatten();
            let listed = kind.or_else(|| list_of_known(names.iter().copied()));
            listed.or_else(|| Some(none_known(family, part)))
        });
        self.report::<()>(node, at, Finding::error(format!("no {noun} is called `{name}`")).maybe_help(help));
    }
}

/// Help where the scene defines no names of a family.
fn none_known(family: NamedFamily, part: &str) -> String {
    match family {
        NamedFamily::Texture => {
            "the scene has no `textures`; a color is written [r, g, b], \"#rrggbb\" or as a name of CSS".into()
        }
        _ => format!("the scene has no `{part}`"),
    }
}

/// Suggests the correct form if a material's name is a kind of material.
fn kind_of_material(name: &str) -> Option<String> {
    let family = Rule::named("AnyMaterial")?;
    let own = family.kinds.iter().any(|(kind, _)| *kind == name);
    let own = own.then(|| format!("`{name}` is a kind of material: write {{\"{name}\": {{...}}}}"));
    own.or_else(|| other_programs::suggest_kind(name, family, None))
}
