//! What a scene will need memory for, told before its files are read and its world is built.

use super::areas;
use super::count::{count, stored};
use super::emitting::emitters;
use super::images::pictures;
use super::lighting::{self, Purpose};
use super::meshes::Files;
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::Trail;
use juggler_light::background::Panorama;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_shape::AnyShape;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// What a scene will need memory for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Bytes of the scene itself: its texts as trees and types.
    pub text: u64,
    /// Mesh files that exist, each once.
    pub files: BTreeSet<PathBuf>,
    /// Picture files that exist, each once.
    pub pictures: BTreeSet<PathBuf>,
    /// Pictures of everything around that exist, each once.
    pub panoramas: BTreeSet<PathBuf>,
    /// Bytes of textures and panoramas that are made of images in memory.
    pub images: u64,
    /// Triangles of meshes that stand in the scene itself.
    pub triangles: u64,
    /// Objects that are stored, those of groups that are stored once counted once.
    pub objects: u64,
    /// Shapes that emit light, those of groups counted as often as they are placed.
    pub emitters: u64,
    /// Most rays that go on from one point.
    pub rays: u64,
    /// Most shadow rays from one point.
    pub shadows: u64,
}

impl Needs {
    /// Of a scene whose files lie there.
    pub fn of(scene: &Description, files: Files<'_>) -> Self {
        // Too many objects are refused when they are to be placed.
        let areas = areas::of(&scene.lights).count() as u64;
        let counts = count(scene).ok();
        let objects = counts.as_ref().map_or(0, |counts| stored(scene, counts).saturating_add(areas));
        let emitters = counts.as_ref().map_or(0, |_| emitters(scene).saturating_add(areas));
        let shadows = scene.lights.iter().map(|light| u64::from(light.shadow_samples())).sum();
        let text = files.sources.bytes_to_read();
        let mut needs = Self { text, objects, emitters, shadows, ..Self::default() };
        let pictures: Vec<PathBuf> = pictures(scene, &files).into_iter().map(|(file, _)| file).collect();
        let panoramas = lighting::files(scene, &files).into_iter();
        let panoramas: Vec<PathBuf> =
            panoramas.filter(|(_, p)| *p == Purpose::Panorama).map(|(file, _)| file).collect();
        // An image is copied to floats with smaller copies, or to a panorama with its table.
        needs.images = files
            .image_bytes(&pictures, |pixels| 16 * pixels)
            .saturating_add(files.image_bytes(&panoramas, Panorama::bytes));
        needs.pictures = pictures.into_iter().filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        needs.panoramas = panoramas.into_iter().filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        scene.materials.values().for_each(|material| needs.material(material));
        let groups = Trail::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| needs.add(objects, files, &groups.key(name)));
        needs.add(&scene.objects, files, &Trail::Root.key("objects"));
        needs
    }

    fn add(&mut self, objects: &[Item<Object>], files: Files<'_>, path: &Trail<'_>) {
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| object.is_visible()) {
            let path = path.index(i);
            if let Some(MaterialRef::Inline(material)) = &object.material {
                self.material(material);
            }
            if let Some(AnyShape::Mesh(mesh)) = &object.shape {
                self.triangles = self.triangles.saturating_add(mesh.arrays().triangles.len() as u64);
                let path = path.key("shape").key("mesh").join("file");
                let file = mesh.file.as_ref().map(|file| files.locate(&path, file));
                self.files.extend(file.and_then(|file| std::fs::canonicalize(file).ok()));
            }
            self.add(object.inner(), files, &path.key("objects"));
        }
    }

    fn material(&mut self, material: &AnyMaterial) {
        self.rays = self.rays.max(material.glossy_rays());
    }
}
