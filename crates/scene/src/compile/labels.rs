//! Names and indices of scene entries, materials and light groups.

use super::area_lights;
use crate::description::Description;
use juggler_camera::aov::LightGroup;
use juggler_light::AnyLight;
use juggler_material::MaterialId;
use juggler_world::{Labels, SceneLight};

/// Name of the light group of all light without a group.
pub const REST: &str = "rest";

/// Names of objects, materials and light groups, for masks and AOVs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Number of scene entries: `objects`, then area lights.
    pub entries: u32,
    /// Index and name of each named entry, in ascending order.
    pub objects: Vec<(u32, String)>,
    /// Index and name of each named material, in ascending order.
    pub materials: Vec<(MaterialId, String)>,
    /// Names of light groups by index; the first is [`REST`].
    pub light_groups: Vec<String>,
}

impl Names {
    /// Collects the names of a scene.
    pub fn from_scene(scene: &Description) -> Self {
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

    /// Adds an entry after the scene's `objects`.
    pub(super) fn add_entry(&mut self, name: String) {
        self.objects.push((self.entries, name));
        self.entries = self.entries.saturating_add(1);
    }

    /// Name of a material by index; `material INDEX` for an unnamed one.
    pub fn material(&self, number: u32) -> String {
        let found = self.materials.binary_search_by_key(&number, |(id, _)| id.0).ok();
        let name = found.and_then(|at| self.materials.get(at)).map(|(_, name)| name.clone());
        name.unwrap_or_else(|| format!("material {number}"))
    }

    /// Name of a scene entry by index; its path for an unnamed one.
    pub fn object(&self, number: u32) -> String {
        let found = self.objects.binary_search_by_key(&number, |(entry, _)| *entry).ok();
        let name = found.and_then(|at| self.objects.get(at)).map(|(_, name)| name.clone());
        name.unwrap_or_else(|| format!("objects[{number}]"))
    }

    fn group(&self, name: Option<&str>) -> LightGroup {
        let place = name.and_then(|name| self.light_groups.iter().position(|known| known == name));
        // Light groups beyond the range of 16 bits belong to `rest`.
        place.and_then(|place| u16::try_from(place).ok()).map_or(LightGroup::REST, LightGroup)
    }

    /// Assigns lights to their groups.
    pub fn assign_groups(&self, compiled: &mut [SceneLight], lights: &[AnyLight]) {
        for (compiled, light) in compiled.iter_mut().zip(lights) {
            compiled.group = self.group(light.light_group());
        }
    }

    /// Scene entries and their light groups; `entries` holds the index of the first shape of each
    /// entry.
    pub fn labels(&self, scene: &Description, entries: Vec<u32>) -> Labels {
        let of_objects = scene.objects.iter().map(|object| object.light_group.as_deref());
        let of_areas = area_lights::iter(&scene.lights).map(|(_, area)| area.light_group.as_deref());
        let groups: Vec<Option<&str>> = of_objects.chain(of_areas).collect();
        let any = groups.iter().any(Option::is_some);
        let groups = groups.into_iter().filter(|_| any).map(|group| self.group(group)).collect();
        Labels { entries, groups, background: self.group(scene.background_light_group.as_deref()) }
    }
}
