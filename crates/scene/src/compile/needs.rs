//! Memory requirements of a scene, known before its files are read and its world is built.

use super::area_lights;
use super::count::{count, instances, stored};
use super::emitter_count::emitters;
use super::images::image_files;
use super::lighting::{self, Purpose};
use super::meshes::Files;
use crate::asset::Asset;
use crate::description::{Description, InstanceFile, Object};
use crate::item::Item;
use crate::path::PathRef;
use crate::texel_array::TexelArray;
use juggler_light::background::Panorama;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_mesh::MeshEstimate;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Quantities that determine the memory of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Memory of the scene description in bytes, as JSON trees and types.
    pub text: u64,
    /// Existing mesh files, each once.
    pub files: BTreeSet<PathBuf>,
    /// Existing image files, each once.
    pub pictures: BTreeSet<PathBuf>,
    /// Existing environment maps, each once.
    pub panoramas: BTreeSet<PathBuf>,
    /// Memory in bytes of textures and environment maps from images in memory.
    pub images: u64,
    /// Memory in bytes of meshes in memory that files stand for, each once, with their hierarchies
    /// while these are built.
    pub meshes: u64,
    /// Existing files of instances, each once.
    pub instance_files: BTreeSet<PathBuf>,
    /// Memory in bytes of the arrays of instances in memory, each once for each object that has them.
    pub instance_arrays: u64,
    /// Triangles of inline meshes.
    pub triangles: u64,
    /// Stored objects, without instances from lists; objects of a shared group count once.
    pub objects: u64,
    /// Stored instances of shapes, from lists of an object.
    pub instances: u64,
    /// Emissive shapes; shapes of a group count once per placement.
    pub emitters: u64,
    /// Maximum number of secondary rays from one point.
    pub rays: u64,
    /// Maximum number of shadow rays from one point.
    pub shadows: u64,
}

/// Upper bound of the memory of an environment map of texels: the samples and a copy, pixels, and
/// the map with its table.
fn panorama_bytes(texels: &TexelArray) -> u64 {
    let (count, samples) = (texels.count(), texels.count() * u64::from(texels.channels()));
    let map = Panorama::bytes(usize::try_from(count).unwrap_or(usize::MAX)) as u64;
    map.saturating_add(texels.bytes() + 4 * samples + 12 * count)
}

impl Needs {
    /// Determines the needs of a scene with these files.
    pub fn from_scene(scene: &Description, files: Files<'_>) -> Self {
        // Placement reports too many objects.
        let areas = area_lights::iter(&scene.lights).count() as u64;
        let counts = count(scene).ok();
        let instances = counts.as_ref().map_or(0, |counts| instances(scene, counts));
        let objects = counts.as_ref().map_or(0, |counts| stored(scene, counts).saturating_add(areas));
        let objects = objects.saturating_sub(instances);
        let emitters = counts.as_ref().map_or(0, |_| emitters(scene).saturating_add(areas));
        let shadows = scene.lights.iter().map(|light| u64::from(light.shadow_samples())).sum();
        let text = files.sources.bytes_to_read();
        let mut needs = Self { text, objects, instances, emitters, shadows, ..Self::default() };
        let images: Vec<PathBuf> = image_files(scene, &files).into_iter().map(|(file, _)| file).collect();
        let panoramas = lighting::files(scene, &files).into_iter();
        let panoramas: Vec<PathBuf> =
            panoramas.filter(|(_, p)| *p == Purpose::Panorama).map(|(file, _)| file).collect();
        // An image in memory becomes a pyramid of floats, or an environment map with its table.
        needs.images = files
            .image_bytes(&images, |pixels| 16 * pixels)
            .saturating_add(files.image_bytes(&panoramas, Panorama::bytes))
            .saturating_add(files.texel_bytes(&images, TexelArray::texture_bytes))
            .saturating_add(files.texel_bytes(&panoramas, panorama_bytes));
        needs.pictures = images.into_iter().filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        needs.panoramas = panoramas.into_iter().filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        scene.materials.values().for_each(|material| needs.material(material));
        let groups = PathRef::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| needs.add(objects, files, &groups.key(name)));
        needs.add(&scene.objects, files, &PathRef::Root.key("objects"));
        needs.separate_assets(files);
        let instance_files = std::mem::take(&mut needs.instance_files).into_iter();
        needs.instance_files = instance_files.filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        needs
    }

    /// Separates existing mesh files from assets.
    fn separate_assets(&mut self, files: Files<'_>) {
        for file in std::mem::take(&mut self.files) {
            match files.asset_cache.store().assets.at(&file).map(Asset::mesh) {
                Some(mesh) => {
                    let bytes = mesh.map_or(0, |mesh| MeshEstimate::from_arrays(mesh).peak_bytes);
                    self.meshes = self.meshes.saturating_add(bytes);
                }
                None => self.files.extend(std::fs::canonicalize(file)),
            }
        }
    }

    fn add(&mut self, objects: &[Item<Object>], files: Files<'_>, path: &PathRef<'_>) {
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| object.is_visible()) {
            let path = path.index(i);
            if let Some(MaterialRef::Inline(material)) = &object.material {
                self.material(material);
            }
            if let Some(mesh) = object.mesh() {
                self.triangles = self.triangles.saturating_add(mesh.arrays().triangles.len() as u64);
                let shape = path.key("shape");
                let path = shape.key("mesh");
                self.files.extend(mesh.file.iter().map(|file| files.locate(&path.join("file"), file)));
                let morphs = mesh.morphs.iter().enumerate();
                let file = |i, file: &String| files.locate(&path.key("morphs").index(i).join("file"), file);
                self.files.extend(morphs.filter_map(|(i, morph)| Some(file(i, morph.file.as_ref()?))));
            }
            if let Some(instances) = &object.instances {
                self.instance_arrays = self.instance_arrays.saturating_add(instances.bytes());
                let file = |file: &InstanceFile| files.locate(&path.key("instances").join("file"), file.name());
                self.instance_files.extend(instances.file.as_ref().map(file));
            }
            self.add(object.inner(), files, &path.key("objects"));
        }
    }

    fn material(&mut self, material: &AnyMaterial) {
        self.rays = self.rays.max(material.glossy_rays());
    }
}
