//! A model of a scene: its objects with the model's settings, and its other parts under names of
//! their own.

use super::expand::{Expander, InModel, ModelIdentity};
use super::{ModelChoice, ModelParts, OpenedModel};
use crate::description::{BackgroundInput, Model, Object, Objects};
use crate::item::Item;
use crate::path::{Path, PathRef};
use crate::report::Finding;
use indexmap::IndexMap;
use juggler_material::{AnyMaterial, MaterialRef, Principled};
use juggler_math::suggest::did_you_mean_or_list;
use juggler_math::{Rgb, Transform, portable};
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
    /// By file, settings that change parts, and scale; `None` for all scales, of parts that do not
    /// depend on it.
    by_content: IndexMap<(PathBuf, String, Option<u32>), String>,
    /// By path of the model.
    by_path: BTreeMap<String, String>,
    /// Names of cameras, and the number of cameras for which each name was requested.
    cameras: BTreeSet<String>,
    camera_counts: BTreeMap<String, u32>,
}

/// What distinguishes copies of a model: the prefix of the names of its parts, the bits of its time
/// in seconds, and the names of nodes that it shows and hides.
type CopyKey = (String, u64, Vec<String>, Vec<String>);

/// Parts of models that copies share.
pub type SharedCopies = BTreeMap<CopyKey, Arc<SharedCopy>>;

/// Parts of a model at a time, which copies of the model share.
pub struct SharedCopy {
    objects: Objects,
    /// The other parts, without those that are in the scene.
    parts: ModelParts,
    /// Names that the file does not have: their paths in the model, and messages.
    unknown_names: Vec<(Path, String)>,
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
    ) -> Objects {
        let file = self.files.locate(&Path::from(path).key("file"), &model.file);
        let opened = self.asset_cache.model_with_control(&file, self.files.control);
        let size = self.description.render.size;
        let choice = ModelChoice { picture_size: Some(size), ..model.choice(seconds) };
        let copy = match self.copy(model, replaced, &opened, &choice, (path, place)) {
            Ok(copy) => copy,
            Err(faults) => {
                let at = Path::from(path).key("file");
                faults.into_iter().for_each(|fault| self.report(Finding::error(fault), at.clone(), place));
                return Objects::default();
            }
        };
        if place.is_moment {
            self.identities.last_mut().iter_mut().for_each(|identity| identity.times.push(choice.seconds));
        } else {
            let size = size.map(f64::from).into_iter().filter(|_| copy.parts.depends_on_size);
            let times = std::iter::once(choice.seconds).chain(size).collect();
            self.identities.push(ModelIdentity { files: Arc::clone(&opened.digests), times });
        }
        for (name, message) in &copy.unknown_names {
            let whole = Path::from_steps(Path::from(path).steps().iter().chain(name.steps()));
            self.report(Finding::error(message.clone()), whole, place);
        }
        self.add_lights_and_cameras(model, &copy.parts, path, place);
        if let (Some(background), None, true) = (&copy.parts.background, &self.description.background, model.lights)
            && !place.is_moment
        {
            self.description.background = Some(BackgroundInput::from(background.clone()).into());
        }
        for warning in &copy.parts.warnings {
            self.report(Finding::warning(warning), Path::from(path).key("file"), place);
        }
        copy.objects.clone()
    }

    /// Parts of a copy of a model. The first copy opens them and, at the frame, adds them to the
    /// scene.
    fn copy(
        &mut self,
        model: &Model,
        replaced: bool,
        opened: &OpenedModel,
        choice: &ModelChoice,
        (path, place): (&PathRef<'_>, Place<'_>),
    ) -> Result<Arc<SharedCopy>, Vec<String>> {
        let file = opened.file.as_ref().map_err(Clone::clone)?;
        let content = self.content(opened, model, replaced);
        let prefix = self.prefix(&content, opened, path, place);
        // Parts without an animation are the same at all times.
        let time = if file.moves(choice) { choice.seconds.to_bits() } else { 0 };
        let key = (prefix.clone(), time, model.nodes.clone(), model.hide.clone());
        if let Some(known) = self.copies.get(&key) {
            return Ok(Arc::clone(known));
        }
        let parts = file.parts_with_control(choice, &prefix, self.files.control).map_err(|error| error.faults)?;
        let unknown_names = unknown_names(model, &parts, &prefix);
        let mut copy = SharedCopy { parts, unknown_names, objects: Objects::default() };
        self.model_bytes.insert(content.0.clone(), file.bytes());
        if !copy.parts.materials.values().any(has_distances) {
            let (file, settings) = content;
            self.names.by_content.insert((file, settings, None), prefix.clone());
        }
        copy.place(model, replaced, &prefix);
        self.add_parts(&mut copy.parts, place);
        let copy = Arc::new(copy);
        self.copies.insert(key, Arc::clone(&copy));
        Ok(copy)
    }

    /// File of a model and its settings that change parts.
    fn content(&self, opened: &OpenedModel, model: &Model, replaced: bool) -> (PathBuf, String) {
        let file = opened.paths().next().cloned().unwrap_or_default();
        let Model { scene, variant, animation, at, repeat, photometric, materials, .. } = model;
        let settings = format!("{:?}", (scene, variant, animation, at, repeat, photometric, materials, replaced));
        (self.files.asset_cache.store().canonical_name(&file), settings)
    }

    /// Prefix of the names of a model's parts: the stem of the file's name, with a number if models
    /// of other files, settings or scales have the same.
    fn prefix(
        &mut self,
        content: &(PathBuf, String),
        opened: &OpenedModel,
        path: &PathRef<'_>,
        place: Place<'_>,
    ) -> String {
        let at = Path::from(path).to_string();
        if let Some(known) = self.names.by_path.get(&at).filter(|_| place.is_moment) {
            return known.clone();
        }
        let key = |scale| (content.0.clone(), content.1.clone(), scale);
        let scaled = key(Some(place.length_scale().to_bits()));
        let known = self.names.by_content.get(&key(None)).or_else(|| self.names.by_content.get(&scaled));
        let prefix = known.cloned().unwrap_or_else(|| self.free_prefix(opened));
        self.names.by_content.entry(scaled).or_insert_with(|| prefix.clone());
        self.names.by_path.insert(at, prefix.clone());
        prefix
    }

    /// Prefix that no other name begins with.
    fn free_prefix(&self, opened: &OpenedModel) -> String {
        let stem = opened.paths().next().and_then(|file| file.file_stem());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let is_free = |prefix: &String| {
            let known = &self.files.scene;
            !self.names.by_content.values().any(|other| other == prefix)
                && !known.materials.keys().any(|name| name.starts_with(prefix))
                && !known.textures.keys().chain(known.cameras.keys()).any(|name| name.starts_with(prefix))
                && !known.groups.keys().any(|name| name.starts_with(prefix))
        };
        let numbered = (2..).map(|number: u32| format!("{stem}#{number}/"));
        std::iter::once(format!("{stem}/")).chain(numbered).find(is_free).unwrap_or_default()
    }

    /// Moves materials, textures, groups and pictures of a model to the scene; those at a sample of
    /// the shutter interval are the same as at the frame.
    fn add_parts(&mut self, parts: &mut ModelParts, place: Place<'_>) {
        let ModelParts { assets, textures, materials, groups, .. } = parts;
        let (assets, textures) = (std::mem::take(assets), std::mem::take(textures));
        let (materials, groups) = (std::mem::take(materials), std::mem::take(groups));
        if place.is_moment {
            return;
        }
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
    fn camera_name(&mut self, name: &str) -> String {
        // A crowd has thousands of cameras of one name.
        let count = self.names.camera_counts.entry(name.to_owned()).or_insert(0);
        loop {
            *count = count.saturating_add(1);
            let candidate = if *count == 1 { name.to_owned() } else { format!("{name}#{count}") };
            if !self.files.scene.cameras.contains_key(&candidate) && self.names.cameras.insert(candidate.clone()) {
                return candidate;
            }
        }
    }
}

/// Names of nodes and materials that the file does not have: each with its path in the model and a
/// message.
fn unknown_names(model: &Model, parts: &ModelParts, prefix: &str) -> Vec<(Path, String)> {
    let listed = [("nodes", &model.nodes), ("hide", &model.hide)].into_iter();
    let at = |key: &str| Path::root().key(key);
    let listed = listed.flat_map(|(key, names)| names.iter().enumerate().map(move |(i, n)| (n, at(key).index(i))));
    let replaced = model.materials.keys().map(|name| (name, at("materials").key(name.as_str())));
    let wanted: Vec<_> = listed.map(|named| ("node", named)).chain(replaced.map(|named| ("material", named))).collect();
    if wanted.is_empty() {
        return Vec::new();
    }
    let names = parts.objects.iter().filter_map(|object| object.name.as_deref());
    let nodes: BTreeSet<&str> = names.flat_map(|name| name.split('/')).collect();
    let materials = parts.materials.keys().map(|name| name.strip_prefix(prefix).unwrap_or(name));
    let materials: BTreeSet<&str> = materials.collect();
    let unknown = |(kind, (name, path)): (&str, (&String, Path))| {
        let known = if kind == "node" { &nodes } else { &materials };
        let help = did_you_mean_or_list(name, known.iter().copied());
        let help = help.map(|help| format!("; {help}")).unwrap_or_default();
        (!known.contains(name.as_str())).then(|| (path, format!("the model has no {kind} `{name}`{help}")))
    };
    wanted.into_iter().filter_map(unknown).collect()
}

/// Whether a material has distances that matter, which the scale of a model changes: over which a
/// medium absorbs and scatters light.
fn has_distances(material: &AnyMaterial) -> bool {
    if let AnyMaterial::Principled(Principled { medium, .. }) = material {
        return !medium.is_clear() || medium.color != Rgb::WHITE;
    }
    let nested = material.nested_materials();
    if nested.is_empty() {
        let mut scaled = material.clone();
        scaled.scale_distances(2.0);
        return scaled != *material;
    }
    nested.iter().any(|(_, nested)| matches!(nested, MaterialRef::Inline(material) if has_distances(material)))
}

impl SharedCopy {
    /// Selects the objects of the nodes that a model shows, and replaces their materials.
    fn place(&mut self, model: &Model, replaced: bool, prefix: &str) {
        let mut objects = selected(model, std::mem::take(&mut self.parts.objects));
        let replace = |object: &mut Object| match replaced {
            true => clear_materials(object),
            false => replace_materials(object, model, prefix),
        };
        if replaced || !model.materials.is_empty() {
            self.parts.groups.values_mut().flatten().for_each(replace);
            objects.iter_mut().for_each(|object| replace(object.value_mut_unmarked()));
        }
        self.objects = objects.into();
    }
}

/// Objects of the nodes that the model shows.
fn selected(model: &Model, objects: Vec<Item<Object>>) -> Vec<Item<Object>> {
    let is_in = |object: &Object, list: &[String]| {
        let steps = object.name.as_deref().unwrap_or_default();
        steps.split('/').any(|step| list.iter().any(|name| name == step))
    };
    let is_shown =
        |object: &Item<Object>| (model.nodes.is_empty() || is_in(object, &model.nodes)) && !is_in(object, &model.hide);
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
