//! Two scenes of different content have different fingerprints: every field of every type of the
//! scene format is changed, one at a time.

use juggler::scene::Scene;
use juggler_fuzz::fields::{Field, all_fields};
use std::collections::BTreeSet;

/// Fields that decide no pixel, by the beginning of their path.
const NO_PIXEL: [&str; 8] =
    ["title", "description", "include", "animation", "tone", "render.samples", "variables", "paths"];

/// Two scenes that differ in the field, if two of its values make scenes that differ.
fn pair(field: &Field) -> Option<[Scene; 2]> {
    let scenes = field.variations().into_iter();
    let mut scenes =
        scenes.filter_map(|text| Scene::from_json(text, "field.json").ok()).filter(|scene| scene.compile().is_ok());
    let first = scenes.next()?;
    let second = scenes.find(|other| *other != first)?;
    Some([first, second])
}

#[test]
fn every_field_is_part_of_the_fingerprint() {
    let (mut changed, mut unchanged) = (0, BTreeSet::new());
    for field in all_fields() {
        let Some([a, b]) = pair(&field) else { continue };
        changed += 1;
        if a.fingerprint() == b.fingerprint() {
            unchanged.insert(field.path);
        }
    }
    unchanged.retain(|path| !NO_PIXEL.iter().any(|start| path.starts_with(start)));
    assert!(unchanged.is_empty(), "fields that the fingerprint does not know: {unchanged:#?}");
    assert!(changed > 800, "only {changed} fields were changed");
}
