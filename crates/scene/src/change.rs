//! What an edit changed.

use crate::Scene;
use crate::description::{Description, Named, Object, Objects};
use crate::path::{Path, PathRef};
use std::collections::BTreeSet;

/// A kind of change of a scene, by which a program decides what to update.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Changed {
    /// Title, description or version.
    Title,
    /// Render settings.
    Settings,
    /// Tone mapping.
    Tone,
    /// A camera.
    Camera,
    /// The background or its light group.
    Background,
    /// A texture.
    Texture,
    /// A material.
    Material,
    /// A light.
    Light,
    /// The transform of an object, and nothing else of the object.
    Transform,
    /// Anything else of an object or a list of objects.
    Geometry,
    /// The content of an asset.
    Asset,
    /// Frame, animation settings, variables, paths, or the expression or value form of an animated
    /// value.
    Animation,
}

impl Changed {
    /// Name of the kind, in snake case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Title => "title",
            Self::Settings => "settings",
            Self::Tone => "tone",
            Self::Camera => "camera",
            Self::Background => "background",
            Self::Texture => "texture",
            Self::Material => "material",
            Self::Light => "light",
            Self::Transform => "transform",
            Self::Geometry => "geometry",
            Self::Asset => "asset",
            Self::Animation => "animation",
        }
    }
}

/// Everything in which two states of a scene differ. Compilation after an edit
/// ([`Scene::compile_after`]) updates only what depends on it.
///
/// ```
/// use juggler_scene::{Changed, Object, Scene};
/// use juggler_shape::Sphere;
///
/// let scene = Scene::new().add(Object::new(Sphere::default()));
/// let up = serde_json::json!({"translate": [0, 1, 0]});
/// let edited = scene.with_value("/objects/0/transform", up)?;
/// let change = edited.change_since(&scene);
/// assert!(change.contains(Changed::Transform) && !change.contains(Changed::Geometry));
/// assert_eq!(change.paths()[0].pointer(), "/objects/0");
/// # Ok::<(), juggler_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Change {
    kinds: BTreeSet<Changed>,
    paths: Vec<Path>,
}

impl Change {
    /// Whether nothing changed.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Whether something of this kind changed.
    pub fn contains(&self, kind: Changed) -> bool {
        self.kinds.contains(&kind)
    }

    /// All kinds of changes.
    pub fn kinds(&self) -> impl Iterator<Item = Changed> {
        self.kinds.iter().copied()
    }

    /// Whether all changes are of these kinds.
    pub fn is_within(&self, kinds: &[Changed]) -> bool {
        self.kinds.iter().all(|kind| kinds.contains(kind))
    }

    /// Paths of the items that changed, were added or removed. A list whose length changed counts
    /// as one.
    pub fn paths(&self) -> &[Path] {
        &self.paths
    }

    /// Adds the changes of another edit.
    pub fn merge(&mut self, other: Self) {
        self.kinds.extend(other.kinds);
        let fresh: Vec<Path> = other.paths.into_iter().filter(|path| !self.paths.contains(path)).collect();
        self.paths.extend(fresh);
    }

    fn add(&mut self, kind: Changed, path: impl Into<Path>) {
        self.kinds.insert(kind);
        let path = path.into();
        // An item may change in several ways, one after the other.
        if self.paths.last() != Some(&path) {
            self.paths.push(path);
        }
    }

    fn add_if(&mut self, differs: bool, kind: Changed, path: &PathRef<'_>) {
        if differs {
            self.add(kind, path);
        }
    }

    /// Compares items by name.
    fn compare_named<T: Clone + PartialEq>(&mut self, a: &Named<T>, b: &Named<T>, kind: Changed, at: &PathRef<'_>) {
        if a.is_same(b) {
            return;
        }
        let changed = |name: &&String| a.get(*name) != b.get(*name);
        let removed = b.keys().filter(|name| !a.contains_key(*name));
        let names: Vec<&String> = a.keys().chain(removed).filter(changed).collect();
        names.iter().for_each(|name| self.add(kind, &at.key(name)));
        // The first camera is the default one.
        self.add_if(names.is_empty() && !a.keys().eq(b.keys()), kind, at);
    }

    /// Compares lists of objects, item by item if both have the same length.
    fn compare_objects(&mut self, a: &Objects, b: &Objects, at: &PathRef<'_>) {
        if a.is_same(b) {
            return;
        }
        if a.len() != b.len() {
            return self.add(Changed::Geometry, at);
        }
        for (i, (a, b)) in a.iter().zip(b.iter()).enumerate() {
            if !a.is_same(b) && a != b {
                self.compare_object(a, b, &at.index(i));
            }
        }
    }

    fn compare_object(&mut self, a: &Object, b: &Object, at: &PathRef<'_>) {
        self.add_if(a.transform != b.transform, Changed::Transform, at);
        let kept = Object { transform: a.transform.clone(), objects: a.objects.clone(), ..b.clone() };
        let differs = kept != *a || a.objects.is_some() != b.objects.is_some();
        self.add_if(differs, Changed::Geometry, at);
        if let (Some(inner), Some(others)) = (&a.objects, &b.objects) {
            self.compare_objects(inner, others, &at.key("objects"));
        }
    }

    fn compare(&mut self, a: &Description, b: &Description) {
        let root = PathRef::Root;
        let title = (&a.title, &a.description, a.version) != (&b.title, &b.description, b.version);
        self.add_if(title, Changed::Title, &root.key("title"));
        self.add_if(a.render != b.render, Changed::Settings, &root.key("render"));
        self.add_if(a.tone != b.tone, Changed::Tone, &root.key("tone"));
        self.add_if(a.camera != b.camera, Changed::Camera, &root.key("camera"));
        self.compare_named(&a.cameras, &b.cameras, Changed::Camera, &root.key("cameras"));
        self.add_if(a.background != b.background, Changed::Background, &root.key("background"));
        let groups = (&a.background_light_group, &b.background_light_group);
        self.add_if(groups.0 != groups.1, Changed::Background, &root.key("background_light_group"));
        self.compare_named(&a.textures, &b.textures, Changed::Texture, &root.key("textures"));
        self.compare_named(&a.materials, &b.materials, Changed::Material, &root.key("materials"));
        self.compare_lights(a, b);
        self.compare_groups(a, b);
        self.compare_objects(&a.objects, &b.objects, &root.key("objects"));
    }

    fn compare_lights(&mut self, a: &Description, b: &Description) {
        let (a, b, at) = (&a.lights, &b.lights, PathRef::Root.key("lights"));
        if a.is_same(b) {
            return;
        }
        if a.len() != b.len() {
            return self.add(Changed::Light, &at);
        }
        let changed = a.iter().zip(b.iter()).enumerate().filter(|(_, (a, b))| a != b);
        changed.for_each(|(i, _)| self.add(Changed::Light, &at.index(i)));
    }

    fn compare_groups(&mut self, a: &Description, b: &Description) {
        let (a, b, at) = (&a.groups, &b.groups, PathRef::Root.key("groups"));
        if a.is_same(b) {
            return;
        }
        for (name, objects) in a.iter() {
            match b.get(name) {
                Some(others) => self.compare_objects(objects, others, &at.key(name)),
                None => self.add(Changed::Geometry, &at.key(name)),
            }
        }
        let removed = b.keys().filter(|name| !a.contains_key(*name));
        removed.for_each(|name| self.add(Changed::Geometry, &at.key(name)));
    }
}

impl Scene {
    /// Everything that changed since an earlier state of the scene. Items that both states share
    /// are not compared, so the time depends on what was edited.
    pub fn change_since(&self, before: &Self) -> Change {
        let mut change = Change::default();
        change.compare(&self.description, &before.description);
        change.add_if(
            self.asset_cache.store().assets != before.asset_cache.store().assets,
            Changed::Asset,
            &PathRef::Root,
        );
        if self.frame != before.frame || !self.animates_as(before) {
            change.add(Changed::Animation, Path::root());
        }
        change
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Asset;
    use serde_json::json;

    const SCENE: &str = r##"{"version": 1, "render": {"size": [8, 8]},
        "materials": {"red": {"diffuse": {"reflectance": "#f00"}}},
        "lights": [{"point": {}}], "groups": {"pair": [{"shape": "sphere"}, {"shape": "cuboid"}]},
        "objects": [{"shape": "sphere", "material": "red"}, {"group": "pair"},
            {"objects": [{"shape": "sphere", "transform": {"translate": ["=frame", 0, 0]}}]}]}"##;

    fn scene() -> Scene {
        Scene::from_json(SCENE, "scene.json").unwrap()
    }

    /// Kinds and paths after an edit by pointer.
    fn change(pointer: &str, value: serde_json::Value) -> (Vec<Changed>, Vec<String>) {
        let scene = scene();
        let change = scene.with_value(pointer, value).unwrap().change_since(&scene);
        (change.kinds().collect(), change.paths.iter().map(Path::pointer).collect())
    }

    #[test]
    fn edits_report_the_kind_and_path_of_a_change() {
        let kinds = |pointer: &str, value, kind: Changed, at: &str| {
            assert_eq!(change(pointer, value), (vec![kind], vec![at.to_owned()]), "{pointer}");
        };
        kinds("/title", json!("a"), Changed::Title, "/title");
        kinds("/render/samples", json!(5), Changed::Settings, "/render");
        kinds("/tone/exposure_stops", json!(1), Changed::Tone, "/tone");
        kinds("/camera", json!({"perspective": {}}), Changed::Camera, "/camera");
        kinds("/background", json!("#fff"), Changed::Background, "/background");
        kinds("/textures/a", json!({"noise": {}}), Changed::Texture, "/textures/a");
        kinds("/materials/red/diffuse/reflectance", json!("#0f0"), Changed::Material, "/materials/red");
        kinds("/lights/0/point/intensity", json!(7), Changed::Light, "/lights/0");
        kinds("/lights", json!([]), Changed::Light, "/lights");
        kinds("/objects/0/transform", json!({"translate": [0, 1, 0]}), Changed::Transform, "/objects/0");
        kinds("/objects/0/visible", json!(false), Changed::Geometry, "/objects/0");
        kinds("/groups/pair/1/shape", json!("sphere"), Changed::Geometry, "/groups/pair/1");
        kinds("/objects/2/objects/0/shape", json!("cuboid"), Changed::Geometry, "/objects/2/objects/0");
        kinds("/variables/a", json!(1), Changed::Animation, "");
    }

    #[test]
    fn unedited_items_are_shared_and_report_no_change() {
        let scene = scene();
        assert!(scene.clone().change_since(&scene).is_empty() && scene.clone() == scene);
        // An edit that changes nothing is none, though it makes items anew.
        let same = scene.with_value("/objects/0/visible", json!(true)).unwrap();
        assert!(same.change_since(&scene).is_empty() && same == scene);
        let asset = scene.clone().asset("a.ply", Asset::from_bytes(*b"ply"));
        assert!(asset.change_since(&scene).contains(Changed::Asset) && asset != scene);
        let later = scene.at_frame(1.0).unwrap().change_since(&scene);
        assert!(later.contains(Changed::Transform) && later.contains(Changed::Animation));
        // Motion of another kind that has the same value at this frame.
        let moving = "/objects/2/objects/0/transform/translate/0";
        let faster = scene.with_value(moving, json!("=2*frame")).unwrap();
        assert!(faster.change_since(&scene).is_within(&[Changed::Animation]) && faster != scene);
    }

    #[test]
    fn changes_of_several_edits_are_merged() {
        let scene = scene();
        let edited = scene.with_value("/render/samples", json!(5)).unwrap();
        let mut change = edited.change_since(&scene);
        let again = edited.with_value("/lights", json!([])).unwrap();
        change.merge(again.change_since(&edited));
        assert_eq!(change.paths, again.change_since(&scene).paths);
    }
}
