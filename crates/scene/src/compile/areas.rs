//! Area lights as objects of the world: shapes that emit, behind all objects of the scene, each an entry of its own.

use super::labels::Names;
use super::materials::Materials;
use super::placing::placed;
use crate::description::Description;
use crate::item::Item;
use crate::motion::Tracks;
use crate::path::Trail;
use crate::report::Finding;
use juggler_light::{AnyLight, Area};
use juggler_material::{Emissive, MaterialRef, Sides};
use juggler_math::{Motion, Transform};
use juggler_world::{Content, Object};
use std::sync::Arc;

/// The world's objects, and of each entry of the scene the number of its first shape.
pub type Entries = (Vec<Object>, Vec<u32>);

/// The area lights of a list by their numbers in it.
pub fn of(lights: &[Item<AnyLight>]) -> impl Iterator<Item = (usize, &Area)> {
    lights.iter().enumerate().filter_map(|(i, light)| match &**light {
        AnyLight::Area(area) => Some((i, area)),
        _ => None,
    })
}

/// Adds the scene's area lights to its objects, and names their entries `lights[i]`. Those that have `tracks` move; size and radiance stay. Area lights that are wrong have been reported.
pub fn add(
    scene: &Description,
    tracks: &Tracks,
    materials: &mut Materials,
    names: &mut Names,
    (objects, entries): &mut Entries,
    findings: &mut Vec<Finding>,
) {
    let mut shapes: u64 = objects.iter().map(Object::shapes).sum();
    let lights = Trail::Root.key("lights");
    for (i, area) in of(&scene.lights) {
        let Some((mut shape, place)) = area.placed() else { continue };
        if shape.prepare().is_err() {
            continue;
        }
        let material = materials.get(&emissive(area), &lights.index(i), findings);
        let motion = motion(tracks, i).unwrap_or(place.into());
        objects.push(placed(Content::Shape(Arc::new(shape)), motion, Some(material)));
        names.add_entry(format!("lights[{i}]"));
        entries.push(u32::try_from(shapes).unwrap_or(u32::MAX));
        shapes = shapes.saturating_add(1);
    }
}

/// Asks for what [`add`] asks for, where the area lights are objects already.
pub fn ask(scene: &Description, materials: &mut Materials, names: &mut Names, findings: &mut Vec<Finding>) {
    let lights = Trail::Root.key("lights");
    for (i, area) in of(&scene.lights) {
        if area.placed().is_some_and(|(mut shape, _)| shape.prepare().is_ok()) {
            materials.get(&emissive(area), &lights.index(i), findings);
            names.add_entry(format!("lights[{i}]"));
        }
    }
}

fn emissive(area: &Area) -> MaterialRef {
    Emissive { radiance: area.radiance().into(), sides: Sides::Front, ..Emissive::default() }.into()
}

/// Where a light is at even times; nothing for a light that stays.
fn motion(tracks: &Tracks, light: usize) -> Option<Motion> {
    let place = |at: &Item<AnyLight>| match &**at {
        AnyLight::Area(area) => area.placed().map(|(_, place)| place),
        _ => None,
    };
    let keys: Option<Vec<Transform>> = tracks.lights.get(&light)?.iter().map(place).collect();
    Motion::through(keys?)
}
