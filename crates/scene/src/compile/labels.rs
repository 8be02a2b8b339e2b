//! What belongs together, and its names: entries of the scene, materials, groups of lights.

use super::areas;
use crate::description::Description;
use juggler_camera::layer::LightGroup;
use juggler_light::AnyLight;
use juggler_material::MaterialId;
use juggler_world::{Labels, Lamp};

/// What light is called that belongs to no group.
pub const REST: &str = "rest";

/// Names of what masks and layers tell apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// How many entries the scene has: its `objects`, then its area lights.
    pub entries: u32,
    /// Of each of them that has one, by number, rising.
    pub objects: Vec<(u32, String)>,
    /// Of each material that has one, by number, rising.
    pub materials: Vec<(MaterialId, String)>,
    /// Of each group of lights, by number; the first is [`REST`].
    pub light_groups: Vec<String>,
}

impl Names {
    /// Of a scene.
    pub fn of(scene: &Description) -> Self {
        let names = (0..).zip(&scene.objects).filter_map(|(i, object)| Some((i, object.name.clone()?)));
        let entries = u32::try_from(scene.objects.len()).unwrap_or(u32::MAX);
        let mut light_groups = vec![REST.to_owned()];
        let of_lights = scene.lights.iter().filter_map(|light| light.light_group());
        let of_objects = scene.objects.iter().filter_map(|object| object.light_group.as_deref());
        for name in of_lights.chain(of_objects).chain(scene.background_light_group.as_deref()) {
            if !light_groups.iter().any(|known| known == name) {
                light_groups.push(name.to_owned());
            }
        }
        Self { entries, objects: names.collect(), materials: Vec::new(), light_groups }
    }

    /// One more entry, behind those of the scene's `objects`.
    pub(super) fn add_entry(&mut self, name: String) {
        self.objects.push((self.entries, name));
        self.entries = self.entries.saturating_add(1);
    }

    /// Of a material by number: its own, or its number.
    pub fn material(&self, number: u32) -> String {
        let found = self.materials.binary_search_by_key(&number, |(id, _)| id.0).ok();
        let name = found.and_then(|at| self.materials.get(at)).map(|(_, name)| name.clone());
        name.unwrap_or_else(|| format!("material {number}"))
    }

    /// Of an entry of the scene's objects by number: its own, or its place.
    pub fn object(&self, number: u32) -> String {
        let found = self.objects.binary_search_by_key(&number, |(entry, _)| *entry).ok();
        let name = found.and_then(|at| self.objects.get(at)).map(|(_, name)| name.clone());
        name.unwrap_or_else(|| format!("objects[{number}]"))
    }

    fn group(&self, name: Option<&str>) -> LightGroup {
        let place = name.and_then(|name| self.light_groups.iter().position(|known| known == name));
        // There are fewer than that: `settings` checks it.
        place.and_then(|place| u16::try_from(place).ok()).map_or(LightGroup::REST, LightGroup)
    }

    /// Says of lamps which group they are of.
    pub fn mark(&self, lamps: &mut [Lamp], lights: &[AnyLight]) {
        for (lamp, light) in lamps.iter_mut().zip(lights) {
            lamp.group = self.group(light.light_group());
        }
    }

    /// The same of all else that shines; `entries` are the first shapes of the scene's objects.
    pub fn labels(&self, scene: &Description, entries: Vec<u32>) -> Labels {
        let of_objects = scene.objects.iter().map(|object| object.light_group.as_deref());
        let of_areas = areas::of(&scene.lights).map(|(_, area)| area.light_group.as_deref());
        let groups: Vec<Option<&str>> = of_objects.chain(of_areas).collect();
        let any = groups.iter().any(Option::is_some);
        let groups = groups.into_iter().filter(|_| any).map(|group| self.group(group)).collect();
        Labels { entries, groups, background: self.group(scene.background_light_group.as_deref()) }
    }
}
