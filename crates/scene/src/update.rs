//! Compilation after an edit, which keeps the parts of an earlier compilation that still hold.

use crate::compile::{self, Compiled, Files, NEVER_CANCELLED, area_lights};
use crate::fingerprint::{digests, mesh_files};
use crate::{Change, Changed, Scene, SceneError};
use juggler_light::Area;
use juggler_math::{BuildControl, BuildStage};
use std::sync::Arc;

impl Scene {
    /// Builds the world and reuses the parts that still hold of `earlier`, the compilation of an
    /// earlier state `before` of the scene. A change of cameras and settings keeps the whole world;
    /// a change of materials, lights or background keeps the objects and their hierarchies; meshes
    /// in memory are never prepared twice. The result equals the result of [`Scene::compile`], bit
    /// for bit.
    pub fn compile_after(&self, before: &Self, earlier: &Compiled) -> Result<Compiled, SceneError> {
        self.compile_after_with_control(before, earlier, &NEVER_CANCELLED)
    }

    /// [`Scene::compile_after`], which ends early if `control` is cancelled, as
    /// [`Scene::compile_with_control`] does.
    pub fn compile_after_with_control(
        &self,
        before: &Self,
        earlier: &Compiled,
        control: &BuildControl,
    ) -> Result<Compiled, SceneError> {
        control.begin(BuildStage::Preparing);
        let (mut tracks, wrong) = self.tracks_with_control(control);
        let change = self.change_since(before);
        let expansion = self.expanded_with_control(control);
        // After cancellation tracks and models are incomplete.
        control.check()?;
        let (mut description, mut files) = (&self.description, self.files());
        if let Some(expansion) = &expansion {
            (description, tracks) = (&expansion.description, Arc::clone(&expansion.tracks));
            files = self.files_of(expansion);
        }
        let found = if self.has_world(before, &change) {
            let mut findings = Vec::new();
            compile::check_settings(&self.description.render, &mut findings);
            let found = earlier.subjects.cameras_again(description, &tracks, &mut findings);
            found.map(|(cameras, camera_keys)| {
                let settings = (*self.description.render).clone();
                let integrator = self.integrator_choice();
                let hidden = earlier.clone().with_hidden_background(settings.transparent);
                (Compiled { cameras, camera_keys, settings, integrator, ..hidden }, findings)
            })
        } else if !self.has_models() && !before.has_models() && self.has_objects(before, &change) {
            compile::with_shading(description, &tracks, Files { control, ..files }, earlier)
        } else {
            None
        };
        let Some((compiled, mut findings)) = found else { return self.compile_with_control(control) };
        control.check()?;
        findings.extend(expansion.iter().flat_map(|expansion| expansion.findings.clone()));
        let warnings = self.warnings(wrong, findings)?;
        Ok(Compiled { warnings, ..compiled })
    }

    /// Whether both scenes have the same world, whatever their cameras and settings. Files are
    /// compared by content.
    pub fn has_world_of(&self, other: &Self) -> bool {
        self.has_world(other, &self.change_since(other))
    }

    fn has_world(&self, other: &Self, change: &Change) -> bool {
        use Changed::{Animation, Asset, Camera, Settings, Title, Tone};
        let same_motion = || {
            let tracks = |scene: &Self| scene.expanded().map_or_else(|| scene.tracks().0, |it| Arc::clone(&it.tracks));
            let (a, b) = (tracks(self), tracks(other));
            Arc::ptr_eq(&a, &b) || (&a.objects, &a.groups, &a.lights) == (&b.objects, &b.groups, &b.lights)
        };
        let follows_paths = |scene: &Self| scene.integrator_choice().follows_paths();
        // The conditions after the first tell whether the world depends on motion and assets that
        // changed.
        change.is_within(&[Title, Settings, Tone, Camera, Animation, Asset])
            // The default lights depend on the integrator.
            && (!self.description.lights.is_empty() || follows_paths(self) == follows_paths(other))
            && self.has_models_of(other)
            && digests(&self.description, &self.files()) == digests(&other.description, &other.files())
            && same_motion()
    }

    /// Whether both scenes have the same objects and area lights, whatever their materials. Files of
    /// meshes and instances are compared by content.
    fn has_objects(&self, other: &Self, change: &Change) -> bool {
        fn area_lights(scene: &Scene) -> Vec<(usize, &Area)> {
            area_lights::iter(&scene.description.lights).collect()
        }
        let geometry = |scene: &Self| {
            let (description, files) = (&scene.description, scene.files());
            let meshes = mesh_files(description, &files).into_iter().map(|file| scene.asset_cache.digest(&file));
            let instances = files.instance_files().into_iter();
            meshes.chain(instances.map(|file| scene.asset_cache.instance_digest(&file))).collect::<Vec<_>>()
        };
        let (tracks, others) = (self.tracks().0, other.tracks().0);
        let lights = area_lights(self);
        !change.contains(Changed::Transform)
            && !change.contains(Changed::Geometry)
            && (&tracks.objects, &tracks.groups) == (&others.objects, &others.groups)
            && lights == area_lights(other)
            && (lights.is_empty() || tracks.lights == others.lights)
            && geometry(self) == geometry(other)
    }
}
