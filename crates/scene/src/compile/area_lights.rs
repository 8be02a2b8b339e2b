//! Area lights as objects of the world: emissive shapes behind all objects of the scene, each a
//! scene entry of its own.

use super::labels::Names;
use super::materials::Materials;
use super::placer::new_object;
use crate::description::Description;
use crate::item::Item;
use crate::motion::Tracks;
use crate::path::PathRef;
use crate::report::Finding;
use juggler_light::{AnyLight, Area};
use juggler_material::{Emissive, MaterialRef, Sides};
use juggler_math::{Motion, Transform};
use juggler_world::{Content, Object};
use std::sync::Arc;

/// Objects of the world, and the index of the first shape of each scene entry.
pub type PlacedEntries = (Vec<Object>, Vec<u32>);

/// Area lights of a list, with their indices in it.
pub fn iter(lights: &[Item<AnyLight>]) -> impl Iterator<Item = (usize, &Area)> {
    lights.iter().enumerate().filter_map(|(i, light)| Some((i, light.area()?)))
}

/// Adds the scene's area lights to its objects and names their entries `lights[i]`. Lights with
/// tracks move; their size and radiance stay constant. Skips invalid area lights, which are
/// reported already.
pub fn add(
    scene: &Description,
    tracks: &Tracks,
    materials: &mut Materials,
    names: &mut Names,
    (objects, entries): &mut PlacedEntries,
    findings: &mut Vec<Finding>,
) {
    let mut shapes: u64 = objects.iter().map(Object::shapes).sum();
    let lights = PathRef::Root.key("lights");
    for (i, area) in iter(&scene.lights) {
        let Some((mut shape, place)) = area.shape_and_transform() else { continue };
        if shape.prepare().is_err() {
            continue;
        }
        let material = materials.get(&emissive(area), &lights.index(i), findings);
        let motion = motion(tracks, i).unwrap_or(place.into());
        objects.push(new_object(Content::Shape(Arc::new(shape)), motion, Some(material)));
        names.add_entry(format!("lights[{i}]"));
        entries.push(u32::try_from(shapes).unwrap_or(u32::MAX));
        shapes = shapes.saturating_add(1);
    }
}

/// Requests the same materials and entry names as [`add`] if the area lights are objects already.
pub fn request_materials(
    scene: &Description,
    materials: &mut Materials,
    names: &mut Names,
    findings: &mut Vec<Finding>,
) {
    let lights = PathRef::Root.key("lights");
    for (i, area) in iter(&scene.lights) {
        if area.shape_and_transform().is_some_and(|(mut shape, _)| shape.prepare().is_ok()) {
            materials.get(&emissive(area), &lights.index(i), findings);
            names.add_entry(format!("lights[{i}]"));
        }
    }
}

fn emissive(area: &Area) -> MaterialRef {
    Emissive { radiance: area.radiance().into(), sides: Sides::Front, ..Emissive::default() }.into()
}

/// Motion of a light over the shutter interval; `None` for a static light.
fn motion(tracks: &Tracks, light: usize) -> Option<Motion> {
    let place = |at: &Item<AnyLight>| at.area()?.shape_and_transform().map(|(_, place)| place);
    let keys: Option<Vec<Transform>> = tracks.lights.get(&light)?.iter().map(place).collect();
    Motion::from_keys(keys?)
}
