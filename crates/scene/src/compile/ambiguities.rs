//! Warnings about objects of which the order in the file decides what is seen.

use super::{Assembly, NEVER_CANCELLED};
use crate::report::Finding;
use juggler_world::{Ambiguity, Object, World};

/// Maximum number of shapes, instances counted, of a scene that is searched; a ray through a heap of
/// more would take too long.
const MAX_SHAPES: u64 = 2_000_000;
/// Maximum number of warnings.
const MAX_WARNINGS: usize = 5;

impl Assembly {
    /// Builds the world and returns warnings about surfaces of unlike materials at one place,
    /// and about overlapping solids of equal priority; none in a scene of very many shapes.
    pub fn ambiguity_warnings(self) -> Vec<Finding> {
        let Self { objects, materials, labels, names, .. } = self;
        if objects.iter().map(Object::shapes).fold(0, u64::saturating_add) > MAX_SHAPES {
            return Vec::new();
        }
        let Ok(world) = World::without_emitters(objects, materials, &NEVER_CANCELLED) else { return Vec::new() };
        let found = world.with_labels(labels).ambiguities();
        let warning = |(kind, first, second): &(Ambiguity, u32, u32)| {
            let [first, second] = [first, second].map(|entry| names.object(*entry));
            match kind {
                Ambiguity::Surfaces => surfaces(&first, &second),
                Ambiguity::Solids => solids(&first, &second),
            }
        };
        let mut warnings: Vec<Finding> = found.iter().take(MAX_WARNINGS).map(warning).collect();
        if let more @ 1.. = found.len().saturating_sub(MAX_WARNINGS) {
            warnings.push(Finding::warning(format!("{more} more pairs of objects touch or overlap like that")));
        }
        warnings
    }
}

fn surfaces(first: &str, second: &str) -> Finding {
    let message =
        format!("`{first}` and `{second}` have surfaces at one place: which of them is seen depends on their order");
    Finding::warning(message).help("move one of them, or leave out the surface that is hidden")
}

fn solids(first: &str, second: &str) -> Finding {
    let message = format!(
        "the solids `{first}` and `{second}` overlap and have the same priority: the material of `{first}`, which \
         comes first, fills the overlap"
    );
    Finding::warning(message).help("give the solid that shall fill the overlap a higher `priority`")
}
