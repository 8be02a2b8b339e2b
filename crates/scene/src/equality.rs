//! Equality of scenes.

use crate::Scene;
use crate::motion::{ItemSource, animated_values};
use std::sync::Arc;

/// Two scenes are equal if they are at the same frame, hold the same values and assets, and animate
/// the same values by the same expressions and value forms. Files count by name, not by content:
/// [`Scene::fingerprint`] covers contents. Source locations do not count. Comparing copies of one
/// scene takes time for what was edited only.
impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&self.description, &other.description);
        if self.frame != other.frame || self.asset_cache.store().assets != other.asset_cache.store().assets {
            return false;
        }
        a == b && self.animates_as(other)
    }
}

impl Scene {
    /// Whether both scenes have the same animation settings, variables and paths, and animate the
    /// same values by the same expressions and value forms.
    pub(crate) fn animates_as(&self, other: &Self) -> bool {
        if self.description.has_same_motion(&other.description) {
            return true;
        }
        let (a, b) = (self.edits_merged(), other.edits_merged());
        (&a.animation, &a.variables, &a.paths, &a.list_forms) == (&b.animation, &b.variables, &b.paths, &b.list_forms)
            && same_templates(&a.templates(|_| true), &b.templates(|_| true))
    }
}

/// Whether the same items animate the same values alike. The other values of a template are part of
/// the description.
fn same_templates(a: &[ItemSource], b: &[ItemSource]) -> bool {
    let same = |(a, b): (&ItemSource, &ItemSource)| {
        let (template, other) = (&a.template, &b.template);
        a.path == b.path
            && (Arc::ptr_eq(template, other) || animated_values(&template.node) == animated_values(&other.node))
    };
    a.len() == b.len() && a.iter().zip(b).all(same)
}
