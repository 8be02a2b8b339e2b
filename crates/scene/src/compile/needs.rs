//! Memory requirements of a scene, known before its files are read and its world is built.

use super::area_lights;
use super::count::{count, instances, stored};
use super::emitter_count::emitters;
use super::images::image_files;
use super::lighting::{self, Purpose};
use super::meshes::Files;
use super::picture_estimate::PictureNeeds;
use crate::asset::Asset;
use crate::description::{Description, InstanceFile, Object};
use crate::item::Item;
use crate::motion::{ListTracks, ObjectTrack, Tracks};
use crate::path::PathRef;
use crate::texel_array::TexelArray;
use juggler_light::background::Panorama;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_mesh::MeshEstimate;
use juggler_shape::{Mesh, MeshData};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

/// Quantities that determine the memory of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Memory of the scene description in bytes, as JSON trees and types.
    pub text: u64,
    /// Existing mesh files, each once.
    pub files: BTreeSet<PathBuf>,
    /// Pictures of textures, each once.
    pub pictures: Vec<PictureNeeds>,
    /// Environment maps, each once.
    pub panoramas: Vec<PictureNeeds>,
    /// Memory in bytes of textures and environment maps from images in memory.
    pub images: u64,
    /// Memory in bytes of opened model files, beside the objects that they become.
    pub models: u64,
    /// Memory in bytes of meshes in memory that files stand for, each once, with their hierarchies
    /// while these are built.
    pub meshes: u64,
    /// Existing files of instances, each once.
    pub instance_files: BTreeSet<PathBuf>,
    /// Memory in bytes of the arrays of instances in memory, each once for each object that has them.
    pub instance_arrays: u64,
    /// Number of distinct meshes in the scene itself.
    pub inline_meshes: u64,
    /// Triangles of these meshes.
    pub triangles: u64,
    /// Memory in bytes of the arrays of these meshes.
    pub arrays: u64,
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
    /// Determines the needs of a scene with these files, whose objects with `tracks` move.
    pub fn from_scene(scene: &Description, tracks: &Tracks, files: Files<'_>) -> Self {
        // Placement reports too many objects.
        let areas = area_lights::iter(&scene.lights).count() as u64;
        let counts = count(scene).ok();
        let instances = counts.as_ref().map_or(0, |counts| instances(scene, counts));
        let objects = counts.as_ref().map_or(0, |counts| stored(scene, counts).saturating_add(areas));
        let objects = objects.saturating_sub(instances);
        let emitters = counts.as_ref().map_or(0, |_| emitters(scene).saturating_add(areas));
        let shadows = scene.lights.iter().map(|light| u64::from(light.shadow_samples())).sum();
        let text = files.sources.bytes_to_read();
        let images: Vec<PathBuf> = image_files(scene, &files).into_iter().map(|(file, _)| file).collect();
        let panoramas = lighting::files(scene, &files).into_iter();
        let panoramas: Vec<PathBuf> =
            panoramas.filter(|(_, p)| *p == Purpose::Panorama).map(|(file, _)| file).collect();
        // An image in memory becomes a pyramid of floats, or an environment map with its table.
        let pixels = files
            .image_bytes(&images, |pixels| 16 * pixels)
            .saturating_add(files.image_bytes(&panoramas, Panorama::bytes))
            .saturating_add(files.texel_bytes(&images, TexelArray::texture_bytes))
            .saturating_add(files.texel_bytes(&panoramas, panorama_bytes));
        let (pictures, panoramas) = (files.picture_needs(scene), files.panorama_needs(&panoramas));
        let needs = Self { text, objects, instances, emitters, shadows, pictures, panoramas, ..Self::default() };
        let mut collector = Collector { needs: Self { images: pixels, ..needs }, files, seen: BTreeSet::new() };
        scene.materials.values().for_each(|material| collector.material(material));
        let groups = PathRef::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| collector.add(objects, &groups.key(name)));
        collector.add(&scene.objects, &PathRef::Root.key("objects"));
        tracks.groups.values().chain([&tracks.objects]).for_each(|tracks| collector.moving(tracks));
        collector.finish()
    }
}

/// Address of the arrays of a mesh, which copies share.
fn address(arrays: &Arc<MeshData>) -> usize {
    Arc::as_ptr(arrays).addr()
}

/// Collects what the objects of a scene need.
struct Collector<'s> {
    needs: Needs,
    files: Files<'s>,
    /// Addresses of the arrays of meshes that are counted.
    seen: BTreeSet<usize>,
}

impl Collector<'_> {
    /// Separates existing files from assets.
    fn finish(self) -> Needs {
        let Self { mut needs, files, .. } = self;
        for file in std::mem::take(&mut needs.files) {
            match files.asset_cache.store().assets.at(&file).map(Asset::mesh) {
                Some(mesh) => {
                    let bytes = mesh.map_or(0, |mesh| MeshEstimate::from_arrays(mesh).peak_bytes);
                    needs.meshes = needs.meshes.saturating_add(bytes);
                }
                None => needs.files.extend(std::fs::canonicalize(file)),
            }
        }
        let instance_files = std::mem::take(&mut needs.instance_files).into_iter();
        needs.instance_files = instance_files.filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        needs
    }

    fn add(&mut self, objects: &[Item<Object>], path: &PathRef<'_>) {
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| object.is_visible()) {
            let path = path.index(i);
            if let Some(MaterialRef::Inline(material)) = &object.material {
                self.material(material);
            }
            if let Some(mesh) = object.mesh() {
                self.mesh(mesh, &path.key("shape").key("mesh"));
            }
            if let Some(instances) = &object.instances {
                let (needs, files) = (&mut self.needs, self.files);
                needs.instance_arrays = needs.instance_arrays.saturating_add(instances.bytes());
                let file = |file: &InstanceFile| files.locate(&path.key("instances").join("file"), file.name());
                needs.instance_files.extend(instances.file.as_ref().map(file));
            }
            self.add(object.inner(), &path.key("objects"));
        }
    }

    fn mesh(&mut self, mesh: &Mesh, path: &PathRef<'_>) {
        let (needs, files, arrays) = (&mut self.needs, self.files, mesh.arrays());
        if self.seen.insert(address(arrays)) {
            needs.inline_meshes = needs.inline_meshes.saturating_add(u64::from(mesh.file.is_none()));
            needs.triangles = needs.triangles.saturating_add(arrays.triangles.len() as u64);
            needs.arrays = needs.arrays.saturating_add(arrays.bytes() as u64);
        }
        needs.files.extend(mesh.file.iter().map(|file| files.locate(&path.join("file"), file)));
        let morphs = mesh.morphs.iter().enumerate();
        let file = |i, file: &String| files.locate(&path.key("morphs").index(i).join("file"), file);
        needs.files.extend(morphs.filter_map(|(i, morph)| Some(file(i, morph.file.as_ref()?))));
    }

    /// Counts meshes at sampled times, which are copied when they are prepared.
    fn moving(&mut self, tracks: &ListTracks) {
        for track in tracks.values() {
            match track {
                ObjectTrack::Whole(keys) => keys.iter().for_each(|key| self.moving_object(key)),
                ObjectTrack::Inner(tracks) => self.moving(tracks),
            }
        }
    }

    fn moving_object(&mut self, object: &Object) {
        if let Some(arrays) = object.mesh().map(Mesh::arrays).filter(|arrays| self.seen.insert(address(arrays))) {
            let bytes = arrays.bytes() as u64;
            self.needs.arrays = self.needs.arrays.saturating_add(bytes.saturating_mul(2));
        }
        object.inner().iter().for_each(|inner| self.moving_object(inner));
    }

    fn material(&mut self, material: &AnyMaterial) {
        self.needs.rays = self.needs.rays.max(material.glossy_rays());
    }
}
