//! Counts the emissive shapes of a scene before any object is placed. Each is an emitter of its own
//! even if its group is shared; nested groups multiply.

use super::count::{MAX_EMITTERS, shapes};
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::Path;
use crate::report::Finding;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_shape::Mesh;
use juggler_world::MAX_SPLIT_TRIANGLES;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Number of emitters of a scene without recursive groups: emissive shapes, and all triangles of
/// emissive inline meshes.
pub fn emitters(scene: &Description) -> u64 {
    EmitterCounter::of_scene(scene).among(&scene.objects, false)
}

/// Error for a scene with too many emitters, at the object that exceeds the limit.
pub fn too_many(scene: &Description) -> Option<Finding> {
    let mut search = EmitterCounter::of_scene(scene);
    let mut sum = 0u64;
    for (i, object) in scene.objects.iter().enumerate() {
        sum = sum.saturating_add(search.object(object, false));
        if sum > MAX_EMITTERS {
            let total = search.among(&scene.objects, false);
            let message = format!("the scene places {total} emissive shapes, the limit is {MAX_EMITTERS}");
            let finding = Finding::error(message).at(Path::root().key("objects").index(i));
            return Some(finding.help(
                "nested groups multiply the number of shapes; give most of them a material that does not emit light",
            ));
        }
    }
    None
}

/// Address of the arrays of a mesh, which its copies share.
fn address(mesh: &Mesh) -> usize {
    Arc::as_ptr(mesh.arrays()).addr()
}

/// Adds to `repeated` the meshes that the objects place several times, outside of groups.
fn repeated_meshes(objects: &[Item<Object>], times: u64, seen: &mut BTreeSet<usize>, repeated: &mut BTreeSet<usize>) {
    for object in objects.iter().filter(|object| object.is_visible()) {
        let times = times.saturating_mul(object.instance_count());
        if let Some(mesh) = object.mesh().filter(|mesh| mesh.file.is_none())
            && (!seen.insert(address(mesh)) || times > 1)
        {
            repeated.insert(address(mesh));
        }
        repeated_meshes(object.inner(), times, seen, repeated);
    }
}

struct EmitterCounter<'s> {
    scene: &'s Description,
    /// Whether named materials emit.
    materials: BTreeMap<&'s str, bool>,
    /// Number of emitters of a group, by name and by whether the inherited material emits.
    groups: BTreeMap<(&'s str, bool), u64>,
    /// Addresses of the arrays of meshes that are one emitter each.
    whole: BTreeSet<usize>,
}

impl<'s> EmitterCounter<'s> {
    fn new(scene: &'s Description) -> Self {
        Self { scene, materials: BTreeMap::new(), groups: BTreeMap::new(), whole: BTreeSet::new() }
    }

    /// Counter of a scene, in which copies of a mesh are one emitter each if all have many
    /// triangles.
    fn of_scene(scene: &'s Description) -> Self {
        let mut counter = Self::new(scene);
        if counter.among(&scene.objects, false) > MAX_SPLIT_TRIANGLES {
            let mut seen = BTreeSet::new();
            counter.groups.clear();
            repeated_meshes(&scene.objects, 1, &mut seen, &mut counter.whole);
        }
        counter
    }

    fn among(&mut self, objects: &'s [Item<Object>], inherited: bool) -> u64 {
        objects.iter().fold(0, |sum: u64, object| sum.saturating_add(self.object(object, inherited)))
    }

    fn object(&mut self, object: &'s Object, inherited: bool) -> u64 {
        if !object.is_visible() {
            return 0;
        }
        let emits = object.material.as_ref().map_or(inherited, |material| self.emits(material));
        let mut count = match object.mesh() {
            _ if !emits => 0,
            Some(mesh) if self.whole.contains(&address(mesh)) => 1,
            Some(mesh) => (mesh.arrays().triangles.len() as u64).max(1),
            _ => shapes(object),
        };
        if let Some(group) = &object.group {
            count = count.saturating_add(self.group(&group.0, emits));
        }
        count.saturating_add(self.among(object.inner(), emits)).saturating_mul(object.instance_count())
    }

    fn group(&mut self, name: &'s str, inherited: bool) -> u64 {
        if let Some(count) = self.groups.get(&(name, inherited)) {
            return *count;
        }
        let scene = self.scene;
        let objects = scene.groups.get(name).map(|o| o.as_slice()).unwrap_or_default();
        let count = self.among(objects, inherited);
        self.groups.insert((name, inherited), count);
        count
    }

    /// Whether any part of a material emits light.
    fn emits(&mut self, material: &'s MaterialRef) -> bool {
        match material {
            MaterialRef::Inline(material) => self.is_emitting(material),
            MaterialRef::Name(name) => {
                if let Some(known) = self.materials.get(name.as_str()) {
                    return *known;
                }
                // Terminate cycles of materials, which validation reports.
                self.materials.insert(name.as_str(), false);
                let scene = self.scene;
                let emits = scene.materials.get(name).is_some_and(|material| self.is_emitting(material));
                self.materials.insert(name.as_str(), emits);
                emits
            }
        }
    }

    fn is_emitting(&mut self, material: &'s AnyMaterial) -> bool {
        material.is_area_light() || material.nested_materials().into_iter().any(|(_, part)| self.emits(part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    fn scene(objects: &str) -> Scene {
        let text = format!(
            r#"{{"version": 1,
            "materials": {{"emitter": {{"emissive": {{}}}}, "panes": {{"checkerboard": {{"even": "emitter", "odd": {{"phong": {{}}}}}}}},
                "dull": {{"phong": {{"emission": 1}}}}}},
            "groups": {{
                "row": [{{"chain": {{"from": {{"center": [0, 0, 0], "radius": 1}}, "to": {{"center": [9, 0, 0], "radius": 1}},
                    "count": 1000}}}}, {{"shape": "sphere", "material": "dull"}}],
                "rows": [{{"group": "row"}}, {{"group": "row", "material": "emitter"}}, {{"group": "row", "visible": false}}],
                "many": [{}]
            }},
            "objects": [{{"shape": "plane"}}, {objects}]}}"#,
            vec![r#"{"group": "rows"}"#; 500].join(", ")
        );
        Scene::from_json(text, "test.json").unwrap()
    }

    #[test]
    fn emitters_are_counted_with_the_materials_that_they_inherit() {
        for (objects, expected) in [
            (r#"{"group": "row"}"#, 0),
            (r#"{"group": "row", "material": "panes"}"#, 1000),
            (r#"{"group": "rows"}"#, 1000),
            (
                r#"{"objects": [{"group": "rows"}, {"shape": "disk"}], "material": {"mask": {"opacity": 0.5, "material": "emitter"}}}"#,
                2001,
            ),
            (r#"{"group": "many", "material": "emitter"}, {"group": "many"}"#, 1_500_000),
            (
                r#"{"shape": {"mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2], [2, 1, 0]]}},
                "material": {"principled": {"emissive": 1}}}"#,
                2,
            ),
        ] {
            assert_eq!(emitters(&scene(objects).description), expected, "{objects}");
        }
    }

    #[test]
    fn too_many_emitters_are_refused_where_they_stand() {
        let many = r#"{"group": "many", "material": "emitter"}"#;
        assert_eq!(scene(&[many; 4].join(", ")).check().errors(), 0);
        let problems = scene(&[many; 5].join(", ")).check();
        let problem = &problems.list()[0];
        assert_eq!((problems.errors(), problem.path.as_str()), (1, "objects[5]"));
        assert!(problem.message.contains("5000000 emissive shapes, the limit is 4000000"), "{}", problem.message);
    }
}
