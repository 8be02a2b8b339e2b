//! Maps the index of a shape to the place of its description. Counts objects in the order of
//! placement, so that no table is stored.

use super::area_lights;
use super::count::{self, Counts};
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::Path;
use juggler_material::MaterialRef;

/// Place of a shape in the scene description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapePlace {
    /// Path of the object: `objects[3]`, or `groups.tree[2]` for an object of a group.
    pub path: String,
    /// Kind of the shape; `sphere` for chains and limbs.
    pub kind: String,
    /// Name of the material, or its path if inline; `default` for the default material.
    pub material: String,
}

impl ShapePlace {
    /// Finds the shape of index `number` in a scene's world, as vertices state it.
    pub fn find(scene: &Description, number: u32) -> Option<Self> {
        let counts = count::count(scene).ok()?;
        let search = ShapeSearch { scene, counts };
        let number = u64::from(number);
        let objects: u64 = scene.objects.iter().map(|object| search.count(object)).sum();
        if let Some(light) = number.checked_sub(objects) {
            return area(scene, usize::try_from(light).ok()?);
        }
        search.among(&scene.objects, &Path::root().key("objects"), number, "default".into())
    }
}

/// Area light by its index among area lights, which follow all objects.
fn area(scene: &Description, number: usize) -> Option<ShapePlace> {
    let (light, area) = area_lights::iter(&scene.lights).nth(number)?;
    let path = Path::root().key("lights").index(light);
    Some(ShapePlace { path: path.to_string(), kind: area.shape.shape().name().into(), material: path.to_string() })
}

struct ShapeSearch<'s> {
    scene: &'s Description,
    counts: Counts<'s>,
}

impl ShapeSearch<'_> {
    fn among(&self, objects: &[Item<Object>], at: &Path, mut number: u64, inherited: String) -> Option<ShapePlace> {
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| object.is_visible()) {
            let count = self.count(object);
            if number < count {
                return self.within(object, &at.index(i), number, inherited);
            }
            number -= count;
        }
        None
    }

    fn count(&self, object: &Object) -> u64 {
        if object.is_visible() { self.count_instance(object).saturating_mul(object.instance_count()) } else { 0 }
    }

    /// Number of shapes of one instance of an object.
    fn count_instance(&self, object: &Object) -> u64 {
        let group = object.group.as_ref().and_then(|group| self.counts.get(group.0.as_str()));
        let inner = object.inner().iter().map(|object| self.count(object));
        count::shapes(object) + group.map_or(0, count::Count::objects) + inner.sum::<u64>()
    }

    fn within(&self, object: &Object, at: &Path, number: u64, inherited: String) -> Option<ShapePlace> {
        let number = number % self.count_instance(object).max(1);
        let material = match &object.material {
            None => inherited,
            Some(MaterialRef::Name(name)) => name.clone(),
            Some(MaterialRef::Inline(_)) => at.key("material").to_string(),
        };
        if let Some(group) = &object.group {
            let objects = self.scene.groups.get(&group.0)?;
            return self.among(objects, &Path::root().key("groups").key(group.0.as_str()), number, material);
        }
        if let Some(objects) = &object.objects {
            return self.among(objects, &at.key("objects"), number, material);
        }
        let kind = object.shape.as_ref().map_or("sphere", |shape| shape.name()).into();
        Some(ShapePlace { path: at.to_string(), kind, material })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    #[test]
    fn shapes_are_found_in_the_order_of_the_world() {
        let scene = r#"{
            "version": 1,
            "materials": {"red": {"phong": {}}, "blue": {"phong": {}}},
            "groups": {
                "pair": [{"shape": {"sphere": {}}}, {"shape": {"cuboid": {}}, "material": {"phong": {}}}],
                "two": [{"group": "pair", "material": "blue"}, {"group": "pair"}]
            },
            "objects": [
                {"shape": {"plane": {}}},
                {"group": "two", "material": "red"},
                {"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [9, 0, 0], "radius": 1}, "count": 3}},
                {"objects": [{"shape": {"disk": {}}, "material": "blue"}]}
            ],
            "lights": [{"point": {}}, {"area": {"shape": {"sphere": {"radius": 0.1}}, "power": 5}}]
        }"#;
        let scene = Scene::from_json(scene, "test.json").unwrap();
        let shapes = scene.compile().unwrap().world.geometry_stats().shapes as u32;
        let parts: Vec<[String; 3]> = (0..shapes)
            .map(|number| ShapePlace::find(&scene.description, number).unwrap())
            .map(|part| [part.path, part.kind, part.material])
            .collect();
        let expected = [
            ["objects[0]", "plane", "default"],
            ["groups.pair[0]", "sphere", "blue"],
            ["groups.pair[1]", "cuboid", "groups.pair[1].material"],
            ["groups.pair[0]", "sphere", "red"],
            ["groups.pair[1]", "cuboid", "groups.pair[1].material"],
            ["objects[2]", "sphere", "default"],
            ["objects[2]", "sphere", "default"],
            ["objects[2]", "sphere", "default"],
            ["objects[3].objects[0]", "disk", "blue"],
            ["lights[1]", "sphere", "lights[1]"],
        ];
        assert_eq!(parts, expected);
        assert_eq!(ShapePlace::find(&scene.description, shapes), None);
    }
}
