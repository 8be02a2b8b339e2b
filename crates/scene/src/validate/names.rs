//! Names: whatever is referred to must be there.

use super::rule::Rule;
use super::{Walk, foreign};
use crate::description::Description;
use crate::document::Node;
use crate::path::Trail;
use crate::report::Finding;
use crate::suggest::{closest, did_you_mean, meant_or_all};

/// Things that a scene gives names to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// In `materials`.
    Material,
    /// In `textures`.
    Texture,
    /// In `groups`.
    Group,
    /// In `cameras`.
    Camera,
}

impl Family {
    /// The part of the scene that defines it, and what one is called.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Material => ("materials", "material"),
            Self::Texture => ("textures", "texture"),
            Self::Group => ("groups", "group"),
            Self::Camera => ("cameras", "camera"),
        }
    }
}

/// The names of a scene.
#[derive(Clone, Copy)]
pub enum NameScope<'t> {
    /// Those of a whole scene as a tree.
    Tree(&'t Node),
    /// Those of a scene.
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

impl Walk<'_> {
    /// Reports a name that nothing in the scene has.
    pub(super) fn refer(&mut self, family: Family, node: &Node, name: &str, at: &Trail<'_>) {
        let (part, noun) = family.words();
        if self.known.has(part, name) {
            return;
        }
        let names = self.known.all(part);
        let near = closest(name, names.iter().copied()).map(did_you_mean);
        let kind = || kind_of_material(name).filter(|_| family == Family::Material);
        let known = || meant_or_all(name, names.iter().copied());
        let help = near.or_else(kind).or_else(known).unwrap_or_else(|| match family {
            Family::Texture => "the scene has no `textures`; a colour is written [r, g, b] or \"#rrggbb\"".into(),
            _ => format!("the scene has no `{part}`"),
        });
        self.report::<()>(node, at, Finding::error(format!("no {noun} is called `{name}`")).help(help));
    }
}

/// What to write where a material's kind stands for its name.
fn kind_of_material(name: &str) -> Option<String> {
    let family = Rule::named("AnyMaterial")?;
    let own = family.kinds.iter().any(|(kind, _)| *kind == name);
    let own = own.then(|| format!("`{name}` is a kind of material: write {{\"{name}\": {{...}}}}"));
    own.or_else(|| foreign::kind(name, family))
}
