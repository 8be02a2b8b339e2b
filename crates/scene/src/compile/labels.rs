//! Names and indices of scene entries, materials and light groups.

use super::area_lights;
use crate::description::Description;
use crate::path::Path;
use crate::report::Finding;
use juggler_camera::aov::LightGroup;
use juggler_light::AnyLight;
use juggler_material::MaterialId;
use juggler_world::{Labels, SceneLight};
use std::collections::{BTreeMap, BTreeSet};

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
        let mut known = BTreeSet::from([REST]);
        let new = group_names(scene).filter(|name| known.insert(name)).map(str::to_owned);
        let light_groups = std::iter::once(REST.to_owned()).chain(new).collect();
        Self { entries, objects: names.collect(), materials: Vec::new(), light_groups }
    }

    /// Reports the first light group beyond [`LightGroup::MAX_COUNT`], at the scene entry that
    /// names it.
    pub(super) fn check_groups(&self, scene: &Description, findings: &mut Vec<Finding>) {
        let Some(name) = self.light_groups.get(LightGroup::MAX_COUNT) else { return };
        let is_named = |group: Option<&str>| group == Some(name.as_str());
        let root = Path::root();
        let light = scene.lights.iter().position(|light| is_named(light.light_group()));
        let object = || scene.objects.iter().position(|object| is_named(object.light_group.as_deref()));
        let path = match (light, light.is_none().then(object).flatten()) {
            (Some(i), _) => root.key("lights").index(i),
            (None, Some(i)) => root.key("objects").index(i).key("light_group"),
            (None, None) => root.key("background_light_group"),
        };
        let (count, most) = (self.light_groups.len(), LightGroup::MAX_COUNT);
        let message =
            format!("light group `{name}` exceeds the limit: {count} light groups, at most {most} are allowed");
        findings.push(Finding::error(message).at(path).help("give several lights the same light group"));
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

    /// Assigns lights to their groups.
    pub fn assign_groups(&self, compiled: &mut [SceneLight], lights: &[AnyLight]) {
        let numbers = GroupNumbers::new(&self.light_groups);
        for (compiled, light) in compiled.iter_mut().zip(lights) {
            compiled.group = numbers.group(light.light_group());
        }
    }

    /// Scene entries and their light groups; `entries` holds the index of the first shape of each
    /// entry.
    pub fn labels(&self, scene: &Description, entries: Vec<u32>) -> Labels {
        let of_objects = scene.objects.iter().map(|object| object.light_group.as_deref());
        let of_areas = area_lights::iter(&scene.lights).map(|(_, area)| area.light_group.as_deref());
        let groups: Vec<Option<&str>> = of_objects.chain(of_areas).collect();
        let any = groups.iter().any(Option::is_some);
        let numbers = GroupNumbers::new(&self.light_groups);
        let groups = groups.into_iter().filter(|_| any).map(|group| numbers.group(group)).collect();
        Labels { entries, groups, background: numbers.group(scene.background_light_group.as_deref()) }
    }
}

/// Names of the light groups of lights, objects and background, with repetitions.
fn group_names(scene: &Description) -> impl Iterator<Item = &str> {
    let of_lights = scene.lights.iter().filter_map(|light| light.light_group());
    let of_objects = scene.objects.iter().filter_map(|object| object.light_group.as_deref());
    of_lights.chain(of_objects).chain(scene.background_light_group.as_deref())
}

/// Numbers of light groups by name.
struct GroupNumbers<'n>(BTreeMap<&'n str, LightGroup>);

impl<'n> GroupNumbers<'n> {
    /// Numbers the names in order. [`Names::check_groups`] refuses scenes with more names than
    /// numbers.
    fn new(names: &'n [String]) -> Self {
        Self((0..=u16::MAX).zip(names).map(|(number, name)| (name.as_str(), LightGroup(number))).collect())
    }

    /// Group of a light, [`LightGroup::REST`] for a light without one.
    fn group(&self, name: Option<&str>) -> LightGroup {
        name.and_then(|name| self.0.get(name)).copied().unwrap_or(LightGroup::REST)
    }
}
