//! A model of a scene: its objects with the model's settings, and its other parts under names of
//! their own.

use super::expand::{Expander, InModel, ModelIdentity};
use super::{ModelChoice, ModelParts, OpenedModel};
use crate::description::{BackgroundInput, Model, Object};
use crate::item::Item;
use crate::path::{Path, PathRef};
use crate::report::Finding;
use indexmap::IndexMap;
use juggler_material::MaterialRef;
use juggler_math::suggest::did_you_mean_or_list;
use juggler_math::{BuildControl, Transform, portable};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

/// Where the objects of a list are, and when.
#[derive(Clone, Copy, Default)]
pub struct Place<'p> {
    /// Transform to world space, for lights and cameras; `None` in groups, which are placed any
    /// number of times.
    pub transform: Option<Transform>,
    /// Light group of the object of the scene's own list.
    pub light_group: Option<&'p str>,
    /// Whether an enclosing object or the object itself is not visible.
    pub is_hidden: bool,
    /// Whether the time is a sample of the shutter interval and not the scene's frame.
    pub is_moment: bool,
}

impl Place<'_> {
    /// The same place at a sample of the shutter interval.
    pub fn at_moment(self) -> Self {
        Self { is_moment: true, ..self }
    }

    /// Mean factor on lengths: the cube root of the factor on volumes, without its last bits, in
    /// which rotations differ.
    fn length_scale(&self) -> f32 {
        let Some(transform) = self.transform else { return 1.0 };
        let scale = portable::powf(transform.matrix().determinant().abs(), 1.0 / 3.0);
        f32::from_bits(scale.to_bits().saturating_add(1 << 6) >> 7 << 7)
    }
}

/// Prefixes of the names of models' parts.
#[derive(Default)]
pub struct ModelNames {
    /// By file, settings that change parts, and scale.
    by_content: IndexMap<(PathBuf, String, u32), String>,
    /// By path of the model.
    by_path: BTreeMap<String, String>,
}

impl Expander<'_> {
    /// Objects of a model at a time in seconds. At the frame, adds its other parts to the scene.
    /// `replaced` tells whether the object's material replaces those of the file.
    pub fn model(
        &mut self,
        model: &Model,
        replaced: bool,
        seconds: f64,
        path: &PathRef<'_>,
        place: Place<'_>,
    ) -> Vec<Object> {
        let file = self.files.locate(&Path::from(path).key("file"), &model.file);
        let opened = self.asset_cache.model_with_control(&file, self.files.control);
        let size = self.description.render.size;
        let choice = ModelChoice { picture_size: Some(size), ..model.choice(seconds) };
        let prefix = self.prefix(&file, model, replaced, path, place);
        let mut parts = match open_parts(&opened, &choice, &prefix, self.files.control) {
            Ok(parts) => parts,
            Err(faults) => {
                let at = Path::from(path).key("file");
                faults.into_iter().for_each(|fault| self.report(Finding::error(fault), at.clone(), place));
                return Vec::new();
            }
        };
        if place.is_moment {
            self.identities.last_mut().iter_mut().for_each(|identity| identity.times.push(choice.seconds));
        } else {
            let size = size.map(f64::from).into_iter().filter(|_| parts.depends_on_size);
            let times = std::iter::once(choice.seconds).chain(size).collect();
            self.identities.push(ModelIdentity { files: Arc::clone(&opened.digests), times });
        }
        self.check_names(model, &parts, &prefix, path, place);
        let mut objects = selected(model, std::mem::take(&mut parts.objects));
        let lists = parts.groups.values_mut().flatten().chain(&mut objects);
        if replaced {
            lists.for_each(clear_materials);
        } else if !model.materials.is_empty() {
            lists.for_each(|object| replace_materials(object, model, &prefix));
        }
        self.add_lights_and_cameras(model, &parts, path, place);
        if !place.is_moment {
            self.add_parts(model, parts, path, place);
        }
        objects
    }

    /// Prefix of the names of a model's parts: the stem of the file's name, with a number if models
    /// of other files, settings or scales have the same.
    fn prefix(
        &mut self,
        file: &std::path::Path,
        model: &Model,
        replaced: bool,
        path: &PathRef<'_>,
        place: Place<'_>,
    ) -> String {
        let at = Path::from(path).to_string();
        if let Some(known) = self.names.by_path.get(&at).filter(|_| place.is_moment) {
            return known.clone();
        }
        let canonical = self.files.asset_cache.store().canonical_name(file);
        let Model { scene, variant, animation, at: time, repeat, photometric, materials, .. } = model;
        let settings = format!("{:?}", (scene, variant, animation, time, repeat, photometric, materials, replaced));
        let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let is_free = |prefix: &String| {
            let known = &self.files.scene;
            !self.names.by_content.values().any(|other| other == prefix)
                && !known.materials.keys().any(|name| name.starts_with(prefix))
                && !known.textures.keys().chain(known.cameras.keys()).any(|name| name.starts_with(prefix))
                && !known.groups.keys().any(|name| name.starts_with(prefix))
        };
        let numbered = (2..).map(|number: u32| format!("{stem}#{number}/"));
        let free = std::iter::once(format!("{stem}/")).chain(numbered).find(is_free).unwrap_or_default();
        let key = (canonical, settings, place.length_scale().to_bits());
        let prefix = self.names.by_content.entry(key).or_insert(free).clone();
        self.names.by_path.insert(at, prefix.clone());
        prefix
    }

    /// Reports names of nodes and materials that the file does not have.
    fn check_names(&mut self, model: &Model, parts: &ModelParts, prefix: &str, path: &PathRef<'_>, place: Place<'_>) {
        let names = parts.objects.iter().filter_map(|object| object.name.as_deref());
        let nodes: BTreeSet<&str> = names.flat_map(|name| name.split('/')).collect();
        let materials = parts.materials.keys().map(|name| name.strip_prefix(prefix).unwrap_or(name));
        let materials: BTreeSet<&str> = materials.collect();
        let at = |key: &str| Path::from(path).key(key);
        let listed = [("nodes", &model.nodes), ("hide", &model.hide)].into_iter();
        let listed = listed.flat_map(|(key, names)| names.iter().enumerate().map(move |(i, n)| (n, at(key).index(i))));
        let listed = listed.map(|(name, path)| ("node", name, &nodes, path));
        let replaced = model.materials.keys().map(|name| ("material", name, &materials, at("materials").key(name)));
        for (kind, name, known, path) in listed.chain(replaced).filter(|(_, name, known, _)| !known.contains(&***name))
        {
            let help = did_you_mean_or_list(name, known.iter().copied());
            let help = help.map(|help| format!("; {help}")).unwrap_or_default();
            self.report(Finding::error(format!("the model has no {kind} `{name}`{help}")), path, place);
        }
    }

    /// Adds materials, textures, groups and pictures of a model to the scene.
    fn add_parts(&mut self, model: &Model, parts: ModelParts, path: &PathRef<'_>, place: Place<'_>) {
        let ModelParts { assets, textures, materials, groups, warnings, background, .. } = parts;
        let at = Path::from(path).key("file");
        self.findings.extend(warnings.into_iter().map(|warning| Finding::warning(warning).at(&at)));
        for (name, asset) in assets {
            self.asset_cache.insert_asset(name, asset);
        }
        for (name, texture) in textures {
            self.description.textures.insert(name, texture.into());
        }
        let scale = Some(place.length_scale()).filter(|&scale| scale != 1.0 && scale > 0.0 && scale.is_finite());
        for (name, mut material) in materials {
            scale.iter().for_each(|scale| material.scale_distances(*scale));
            self.description.materials.insert(name, material.into());
        }
        for (name, objects) in groups {
            self.description.groups.insert(name, objects.into_iter().map(Item::from).collect());
        }
        if let (Some(background), None, true) = (background, &self.description.background, model.lights) {
            self.description.background = Some(BackgroundInput::from(background).into());
        }
    }

    /// Adds lights and cameras of a model, or their values at a sample of the shutter interval.
    fn add_lights_and_cameras(&mut self, model: &Model, parts: &ModelParts, path: &PathRef<'_>, place: Place<'_>) {
        let Some(transform) = place.transform else {
            let left_out =
                [("lights", model.lights && !parts.lights.is_empty()), ("cameras", !parts.cameras.is_empty())];
            for (kind, _) in left_out.into_iter().filter(|(_, exist)| *exist && !place.is_hidden) {
                let message = format!(
                    "the model's {kind} are left out: it is in a group, which may be placed any number of times"
                );
                self.report(Finding::warning(message), Path::from(path).key("file"), place);
            }
            return;
        };
        let key = |i: usize| (Path::from(path).to_string(), i);
        for (i, (_, light)) in parts.lights.iter().enumerate().filter(|_| model.lights && !place.is_hidden) {
            let mut value = light.clone();
            value.transform(&transform);
            if let Some(group @ None) = value.light_group_mut() {
                *group = place.light_group.map(str::to_owned);
            }
            match self.lights.get_mut(&key(i)) {
                Some(light) => light.keys.push(value),
                None if place.is_moment => {}
                None => drop(self.lights.insert(key(i), InModel { value, keys: Vec::new() })),
            }
        }
        // A scene has either one camera or named cameras.
        for (i, (name, camera)) in parts.cameras.iter().enumerate().filter(|_| self.files.scene.camera.is_none()) {
            let mut value = camera.clone();
            value.transform(&transform);
            match self.cameras.get_mut(&key(i)) {
                Some((_, camera)) => camera.keys.push(value),
                None if place.is_moment => {}
                None => {
                    let name = self.camera_name(name);
                    self.cameras.insert(key(i), (name, InModel { value, keys: Vec::new() }));
                }
            }
        }
    }

    /// Name of a model's camera, with a number if the scene has a camera of this name.
    fn camera_name(&self, name: &str) -> String {
        let is_free = |name: &String| {
            !self.files.scene.cameras.contains_key(name) && !self.cameras.values().any(|(other, _)| other == name)
        };
        let numbered = (2..).map(|number: u32| format!("{name}#{number}"));
        std::iter::once(name.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
    }
}

/// Parts of an opened file, or messages.
fn open_parts(
    opened: &OpenedModel,
    choice: &ModelChoice,
    prefix: &str,
    control: &BuildControl,
) -> Result<ModelParts, Vec<String>> {
    let file = opened.file.as_ref().map_err(Clone::clone)?;
    file.parts_with_control(choice, prefix, control).map_err(|error| error.faults)
}

/// Objects of the nodes that the model shows.
fn selected(model: &Model, objects: Vec<Object>) -> Vec<Object> {
    let is_in = |object: &Object, list: &[String]| {
        let steps = object.name.as_deref().unwrap_or_default();
        steps.split('/').any(|step| list.iter().any(|name| name == step))
    };
    let is_shown =
        |object: &Object| (model.nodes.is_empty() || is_in(object, &model.nodes)) && !is_in(object, &model.hide);
    objects.into_iter().filter(is_shown).collect()
}

fn clear_materials(object: &mut Object) {
    object.material = None;
    for inner in object.objects.iter_mut().flat_map(|objects| objects.iter_mut()) {
        clear_materials(inner.value_mut_unmarked());
    }
}

fn replace_materials(object: &mut Object, model: &Model, prefix: &str) {
    if let Some(MaterialRef::Name(name)) = &object.material
        && let Some(own) = name.strip_prefix(prefix).and_then(|name| model.materials.get(name))
    {
        object.material = Some(own.clone());
    }
    for inner in object.objects.iter_mut().flat_map(|objects| objects.iter_mut()) {
        replace_materials(inner.value_mut_unmarked(), model, prefix);
    }
}
