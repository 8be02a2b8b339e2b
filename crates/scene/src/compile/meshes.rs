//! Mesh files of a scene. Each file is loaded, prepared and hashed once and shared by all objects,
//! frames and copies of a scene. For image files see [`super::images`], for files of lights and
//! backgrounds [`super::lighting`].

use super::file_cache::{FileCache, file_stamp, hash};
use super::images::ImageCache;
use super::lighting::LightFiles;
use super::loaded_instances::LoadedInstances;
use crate::asset::{Asset, display_name};
use crate::description::Description;
use crate::document::Sources;
use crate::mesh_scene::MeshOverview;
use crate::model::{ModelCache, ModelNeeds, OpenedModel};
use crate::path::{Path, PathRef};
use crate::picture_reading::PictureReading;
use crate::report::{Finding, plain_io};
use crate::store::{MAX_FILE_BYTES, Store};
use juggler_imaging::regular::ReadError;
use juggler_math::BuildControl;
use juggler_mesh::{FileContent, MeshError, MeshLimits};
use juggler_shape::{InvalidShape, Mesh, MeshData, MorphArrays, Shape};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Cache of loaded files.
#[derive(Clone, Debug, Default)]
pub struct AssetCache {
    store: Store,
    entries: Arc<Mutex<BTreeMap<PathBuf, Arc<Entry>>>>,
    images: ImageCache,
    light_files: LightFiles,
    instances: FileCache<LoadedInstances>,
    models: ModelCache,
}

/// Mesh file.
#[derive(Debug)]
struct Entry {
    /// Hash of the content; zeros if the file could not be read.
    digest: [u8; 32],
    /// Prepared mesh with its warnings, or an error message.
    mesh: Result<(Mesh, Vec<String>), String>,
    /// Name of the picture of the surface that the file names.
    texture_file: Option<String>,
    /// Length and modification time, taken before the file was read.
    stamp: Option<(u64, SystemTime)>,
}

impl AssetCache {
    /// Creates an empty cache of files from a store.
    pub fn new(store: Store) -> Self {
        Self { store, ..Self::default() }
    }

    /// Sets the cache of model files, and what is read of pictures.
    #[must_use]
    pub fn with_models(self, models: ModelCache, reading: PictureReading) -> Self {
        Self { models, images: ImageCache::new(reading), ..self }
    }

    /// Model file.
    pub(crate) fn model(&self, path: &std::path::Path) -> Arc<OpenedModel> {
        self.model_with_control(path, &NEVER_CANCELLED)
    }

    /// Model file; one with a message, which is not kept, if `control` is cancelled.
    pub(crate) fn model_with_control(&self, path: &std::path::Path, control: &BuildControl) -> Arc<OpenedModel> {
        self.models.get(path, &self.store, control)
    }

    /// Memory that a model file needs.
    pub(crate) fn model_needs(&self, path: &std::path::Path) -> ModelNeeds {
        self.models.needs(path, &self.store)
    }

    /// Whether a file is in a known format of models, by its first bytes or its name.
    pub(crate) fn is_model(&self, path: &std::path::Path) -> bool {
        self.models.format(path, &self.store.head(path)).is_some()
    }

    /// Whether a file in a format of models shows nothing but a mesh, so that the scene around it
    /// is that of a mesh file.
    pub(crate) fn is_plain_mesh(&self, path: &std::path::Path) -> bool {
        if matches!(self.store.content(path), FileContent::Unsupported(_)) {
            return false;
        }
        self.models.format(path, &self.store.head(path)).is_some_and(|format| {
            let bytes = self.store.read_bytes(path, MAX_FILE_BYTES);
            format.is_plain_mesh(&bytes.unwrap_or_default())
        })
    }

    /// Adds an asset under a name, or replaces the asset of that name. Other scenes that share the
    /// library's files are not changed.
    pub fn insert_asset(&mut self, name: String, asset: Asset) {
        self.store.assets.insert(name, asset);
    }

    /// Store that files are read from.
    pub fn store(&self) -> &Store {
        &self.store
    }

    pub(super) fn images(&self) -> &ImageCache {
        &self.images
    }

    pub(super) fn light_files(&self) -> &LightFiles {
        &self.light_files
    }

    pub(super) fn instances(&self) -> &FileCache<LoadedInstances> {
        &self.instances
    }

    /// Cache without the files that have changed, which are read again on use.
    pub fn without_changed_files(&self) -> Self {
        let same = |path: &PathBuf, entry: &Entry| entry.stamp.is_some() && entry.stamp == file_stamp(path);
        let entries = self.entries();
        let kept = entries.iter().filter(|(path, entry)| same(path, entry));
        let kept = kept.map(|(path, entry)| (path.clone(), Arc::clone(entry))).collect();
        let (images, light_files) = (self.images.without_changed_files(), self.light_files.without_changed_files());
        let (instances, models) = (self.instances.without_changed_files(), self.models.without_changed_files());
        Self { store: self.store.clone(), entries: Arc::new(Mutex::new(kept)), images, light_files, instances, models }
    }

    /// Hash of a file's content; zeros for a file that cannot be read, which compilation reports.
    pub fn digest(&self, path: &std::path::Path) -> [u8; 32] {
        self.get(path, &NEVER_CANCELLED).digest
    }

    /// Properties of a file's mesh that decide the scene around it, or an error message.
    pub fn mesh_overview(&self, path: &std::path::Path, control: &BuildControl) -> Result<MeshOverview, String> {
        let entry = self.get(path, control);
        let (mesh, _) = entry.mesh.as_ref().map_err(Clone::clone)?;
        let arrays = mesh.arrays();
        Ok(MeshOverview {
            bounds: mesh.bounds(),
            has_colors: arrays.attributes.contains_key("color"),
            texture_file: entry.texture_file.clone().filter(|_| !arrays.uvs.is_empty()),
        })
    }

    /// Loads a file without holding the lock, since threads of one pool must not wait for each
    /// other in the middle of their work. If two threads load the same file, both get the mesh of
    /// the first. If `control` is cancelled, the entry has a message and is not kept.
    fn get(&self, path: &std::path::Path, control: &BuildControl) -> Arc<Entry> {
        if let Some(known) = self.entries().get(path) {
            return Arc::clone(known);
        }
        // Find the same file under another name.
        let file = self.store.canonical_name(path);
        let known = self.entries().get(&file).filter(|entry| entry.mesh.is_ok()).map(Arc::clone);
        let entry = known.unwrap_or_else(|| Arc::new(Entry::load(path, &self.store, control)));
        if control.is_cancelled() {
            return entry;
        }
        let mut entries = self.entries();
        let first = Arc::clone(entries.entry(file).or_insert(entry));
        Arc::clone(entries.entry(path.to_path_buf()).or_insert(first))
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<Entry>>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Entry {
    fn load(path: &std::path::Path, store: &Store, control: &BuildControl) -> Self {
        if let Some(asset) = store.assets.at(path)
            && let Some(arrays) = asset.mesh()
        {
            let mesh = prepared(Arc::clone(arrays).into(), Vec::new(), path, control);
            return Self { digest: asset.digest(), mesh, texture_file: None, stamp: None };
        }
        let (limits, stamp) = (MeshLimits::default(), file_stamp(path));
        let bytes = match store.read_bytes(path, limits.file_bytes) {
            Ok(bytes) => bytes,
            Err(error) => {
                let mesh = Err(read_error_message(path, &error, store));
                return Self { digest: [0; 32], mesh, texture_file: None, stamp };
            }
        };
        let parse = || juggler_mesh::parse_with_control(path, &bytes, &limits, control);
        let (digest, imported) = rayon::join(|| hash(&bytes, control), parse);
        let texture_file = juggler_mesh::texture_file(&bytes);
        // Free memory before the hierarchy is built.
        drop(bytes);
        let cannot_read = |error: MeshError| format!("cannot read `{}`: {}", display_name(path), error.kind);
        let mesh =
            imported.map_err(cannot_read).and_then(|found| prepared(found.mesh.into(), found.warnings, path, control));
        Self { digest, mesh, texture_file, stamp }
    }
}

/// The mesh of a file or asset with its hierarchy and its warnings, or an error message.
fn prepared(
    mut mesh: Mesh,
    mut warnings: Vec<String>,
    path: &std::path::Path,
    control: &BuildControl,
) -> Result<(Mesh, Vec<String>), String> {
    mesh.prepare_with_control(control)
        .map_err(|invalid| format!("`{}` contains an invalid mesh: {invalid}", display_name(path)))?;
    warnings.extend(mesh.warnings());
    Ok((mesh, warnings))
}

/// Message about a file or asset that cannot be read.
pub(crate) fn read_error_message(path: &std::path::Path, error: &ReadError, store: &Store) -> String {
    let shown = display_name(path);
    match error {
        ReadError::Io(error) => {
            format!("cannot read `{shown}`: {}{}", plain_io(error), store.suggestion(path, error))
        }
        ReadError::TooLarge { .. } => format!("cannot read `{shown}`: {error}"),
    }
}

/// Files of a scene.
#[derive(Clone, Copy)]
pub struct Files<'s> {
    /// Scene that names the files.
    pub scene: &'s Description,
    /// Source texts of the scene; empty for scenes built by programs.
    pub sources: &'s Sources,
    /// Cache of loaded files.
    pub asset_cache: &'s AssetCache,
    /// Control of the build that uses the files. After its cancellation, files are not read, and
    /// messages say so.
    pub control: &'s BuildControl,
}

/// Control of work that nothing cancels.
pub(crate) static NEVER_CANCELLED: BuildControl = BuildControl::new();

impl Files<'_> {
    /// Location of a file named at `path`: the asset of that name, or a file relative to the scene
    /// file that names it.
    pub fn locate(&self, path: &Path, file: &str) -> PathBuf {
        if let Some(asset) = self.asset_cache.store().assets.path_of(file) {
            return asset;
        }
        let place = self.scene.innermost_item(path).and_then(|(item, _)| item.place());
        self.sources.folder(place).join(file)
    }

    /// Mesh of a description at `path`: its own arrays or those of its file, with morph targets
    /// applied.
    pub fn mesh(&self, mesh: &Mesh, path: &PathRef<'_>, findings: &mut Vec<Finding>) -> Option<Mesh> {
        if mesh.morphs.is_empty() && (mesh.file.is_none() || mesh.crease_angle_degrees.is_none()) {
            return self.base(mesh, path, findings);
        }
        let mut own = Mesh::from(self.data(mesh, path, findings)?);
        own.crease_angle_degrees = mesh.crease_angle_degrees;
        Some(own)
    }

    /// Mesh that deforms from one of the `moments` to the next while the shutter is open; `None` if
    /// all of them are equal.
    pub fn moving(
        &self,
        moments: &[&Mesh],
        path: &PathRef<'_>,
        findings: &mut Vec<Finding>,
    ) -> Option<Result<Mesh, InvalidShape>> {
        let first = moments.first()?;
        if moments.iter().all(|at| at == first) {
            return None;
        }
        let mut keys = vec![self.data(first, path, findings)?];
        for at in moments.iter().skip(1) {
            // Warnings about files are reported already.
            keys.push(self.data(at, path, &mut Vec::new())?);
        }
        Some(Mesh::from_keyframes_with_control(keys, first.crease_angle_degrees, self.control))
    }

    /// Arrays of a mesh with morph targets applied.
    fn data(&self, mesh: &Mesh, path: &PathRef<'_>, findings: &mut Vec<Finding>) -> Option<MeshData> {
        let mut base = self.base(mesh, path, findings)?;
        base.morphs.clone_from(&mesh.morphs);
        let mut files: Vec<Option<Mesh>> = Vec::new();
        for (i, morph) in mesh.morphs.iter().enumerate() {
            let path = Path::from(path).key("morphs").index(i);
            let MorphArrays { positions, normals, tangents } = morph.arrays();
            if morph.file.is_some() && !(positions.is_empty() && normals.is_empty() && tangents.is_empty()) {
                let message = "a morph has either `file` or arrays (`positions`, `normals`, `tangents`), not both";
                findings.push(Finding::error(message).at(&path));
                return None;
            }
            files.push(match &morph.file {
                None => None,
                Some(file) => Some(self.file(file, &path.key("file"), findings)?),
            });
        }
        let targets = mesh.morphs.iter().zip(&files).filter_map(|(morph, file)| match file {
            None => Some(morph.arrays()),
            Some(mesh) => mesh.data().map(|MeshData { positions, normals, tangents, .. }| MorphArrays {
                positions,
                normals,
                tangents,
            }),
        });
        match base.blended(&targets.collect::<Vec<_>>()) {
            Ok(data) => Some(data),
            Err(invalid) => {
                findings.push(Finding::error(invalid.message).at(Path::from(path).join(&invalid.field)));
                None
            }
        }
    }

    /// Mesh without morph targets.
    fn base(&self, mesh: &Mesh, path: &PathRef<'_>, findings: &mut Vec<Finding>) -> Option<Mesh> {
        let Some(file) = &mesh.file else {
            return Some(mesh.clone());
        };
        let path = Path::from(path).key("file");
        if let Err(invalid) = mesh.clone().load(MeshData::default()) {
            findings.push(Finding::error(invalid.message).at(&path));
            return None;
        }
        self.file(file, &path, findings)
    }

    /// Mesh of a file named at `path`.
    fn file(&self, file: &str, path: &Path, findings: &mut Vec<Finding>) -> Option<Mesh> {
        match &self.asset_cache.get(&self.locate(path, file), self.control).mesh {
            Ok((mesh, warnings)) => {
                findings.extend(warnings.iter().map(|warning| Finding::warning(warning.clone()).at(path)));
                Some(mesh.clone())
            }
            Err(message) => {
                findings.push(Finding::error(message.clone()).at(path));
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    #[test]
    fn a_file_is_loaded_once_under_all_its_names_and_by_all_threads() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        let file = folder.path().join("a.obj");
        std::fs::write(&file, TRIANGLE).unwrap();
        let asset_cache = AssetCache::default();
        let first = asset_cache.get(&file, &NEVER_CANCELLED);
        assert_eq!(first.digest, *blake3::hash(TRIANGLE.as_bytes()).as_bytes());
        // Loaded files are not read again.
        std::fs::write(&file, "v 0 0 0\n").unwrap();
        for name in [file.clone(), folder.path().join("sub/../a.obj"), folder.path().join("./a.obj")] {
            assert!(Arc::ptr_eq(&asset_cache.clone().get(&name, &NEVER_CANCELLED), &first), "{}", name.display());
        }
        std::fs::write(folder.path().join("b.obj"), TRIANGLE).unwrap();
        let names = ["b.obj", "sub/../b.obj"].map(|name| folder.path().join(name));
        let found: Vec<Arc<Entry>> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..8)
                .map(|i| {
                    let name = &names[i % 2];
                    let asset_cache = &asset_cache;
                    scope.spawn(move || asset_cache.get(name, &NEVER_CANCELLED))
                })
                .collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        let data = |entry: &Entry| std::ptr::from_ref(entry.mesh.as_ref().unwrap().0.data().unwrap());
        assert!(found.iter().all(|entry| data(entry) == data(&found[0])));
    }

    #[test]
    fn a_broken_file_has_a_hash_and_a_missing_one_has_none() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.obj");
        std::fs::write(&file, "v 0 0\n").unwrap();
        let asset_cache = AssetCache::default();
        let broken = asset_cache.get(&file, &NEVER_CANCELLED);
        assert_eq!(broken.digest, *blake3::hash(b"v 0 0\n").as_bytes());
        assert!(
            broken
                .mesh
                .as_ref()
                .unwrap_err()
                .ends_with("a.obj`: line 1: expected a number for z, found the end of the line")
        );
        assert_eq!(asset_cache.digest(&folder.path().join("none.obj")), [0; 32]);
        assert_eq!(asset_cache.digest(folder.path()), [0; 32]);
    }
}
