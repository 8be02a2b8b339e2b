//! The files of a scene: meshes (pictures in [`super::images`], what light comes from in [`super::lighting`]), each loaded, prepared and hashed once, shared by all objects, frames and copies of a scene.

use super::images::Pictures;
use super::lighting::Lighting;
use crate::asset::Asset;
use crate::description::Description;
use crate::document::Sources;
use crate::import::{Fault, ImportError, Limits, parse};
use crate::path::{Path, Trail};
use crate::report::{Finding, plain_io};
use crate::store::Store;
use juggler_math::{Aabb, Vec3};
use juggler_shape::{InvalidShape, Mesh, MeshData, Shape};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// The files that were loaded so far.
#[derive(Clone, Debug, Default)]
pub struct Library {
    store: Store,
    entries: Arc<Mutex<BTreeMap<PathBuf, Arc<Entry>>>>,
    pictures: Pictures,
    lighting: Lighting,
}

/// A mesh file.
#[derive(Debug)]
struct Entry {
    /// The hash of its content; zeros when it could not be read.
    digest: [u8; 32],
    /// A mesh ready to be placed, with all that is odd about it; or why there is none.
    mesh: Result<(Mesh, Vec<String>), String>,
    /// How long the file was and when it was last written to, before it was read.
    state: Option<(u64, SystemTime)>,
}

/// How long a file is and when it was last written to.
pub(super) fn state(path: &std::path::Path) -> Option<(u64, SystemTime)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

impl Library {
    /// Of files that come from there.
    pub fn new(store: Store) -> Self {
        Self { store, ..Self::default() }
    }

    /// Adds an asset under a name, or replaces the asset of that name. Other scenes that share the
    /// library's files are not changed.
    pub fn insert_asset(&mut self, name: String, asset: Asset) {
        self.store.assets.insert(name, asset);
    }

    /// Where files come from.
    pub fn store(&self) -> &Store {
        &self.store
    }

    pub(super) fn pictures(&self) -> &Pictures {
        &self.pictures
    }

    pub(super) fn lighting(&self) -> &Lighting {
        &self.lighting
    }

    /// A library that reads those files again that have changed.
    pub fn renewed(&self) -> Self {
        let same = |path: &PathBuf, entry: &Entry| entry.state.is_some() && entry.state == state(path);
        let entries = self.entries();
        let kept = entries.iter().filter(|(path, entry)| same(path, entry));
        let kept = kept.map(|(path, entry)| (path.clone(), Arc::clone(entry))).collect();
        let (pictures, lighting) = (self.pictures.renewed(), self.lighting.renewed());
        Self { store: self.store.clone(), entries: Arc::new(Mutex::new(kept)), pictures, lighting }
    }

    /// The hash of a file's content; zeros for a file that cannot be read, which compiling reports.
    pub fn digest(&self, path: &std::path::Path) -> [u8; 32] {
        self.get(path).digest
    }

    /// The box around the mesh of a file, or why there is none.
    pub fn bounds(&self, path: &std::path::Path) -> Result<Aabb, String> {
        self.get(path).mesh.as_ref().map(|(mesh, _)| mesh.bounds()).map_err(Clone::clone)
    }

    /// Files are loaded without the lock, which threads of one pool must not wait for in the midst of their work:
    /// of two threads that load the same file, both take the mesh of the first.
    fn get(&self, path: &std::path::Path) -> Arc<Entry> {
        if let Some(known) = self.entries().get(path) {
            return Arc::clone(known);
        }
        // The same file by another name.
        let file = self.store.true_name(path);
        let known = self.entries().get(&file).filter(|entry| entry.mesh.is_ok()).map(Arc::clone);
        let entry = known.unwrap_or_else(|| Arc::new(Entry::load(path, &self.store)));
        let mut entries = self.entries();
        let first = Arc::clone(entries.entry(file).or_insert(entry));
        Arc::clone(entries.entry(path.to_path_buf()).or_insert(first))
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<Entry>>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Entry {
    fn load(path: &std::path::Path, store: &Store) -> Self {
        let (limits, state) = (Limits::default(), state(path));
        let bytes = match store.mesh(path, &limits) {
            Ok(bytes) => bytes,
            Err(error) => return Self { digest: [0; 32], mesh: Err(explain(&error)), state },
        };
        let (digest, imported) = rayon::join(|| blake3::hash(&bytes).into(), || parse(path, &bytes, &limits));
        // Building the hierarchy takes memory of its own.
        drop(bytes);
        let mesh = imported.map_err(|error| explain(&error)).and_then(|found| {
            let mut shape = Mesh::from(found.mesh);
            let invalid = |invalid| format!("`{}` holds a mesh that cannot be: {invalid}", path.display());
            shape.prepare().map_err(invalid)?;
            let mut warnings = found.warnings;
            warnings.extend(shape.warnings());
            Ok((shape, warnings))
        });
        Self { digest, mesh, state }
    }
}

pub(super) fn explain(error: &ImportError) -> String {
    let shown = error.path.display();
    match &error.fault {
        Fault::Read(error) => format!("cannot read `{shown}`: {}", plain_io(error)),
        fault => format!("cannot read `{shown}`: {fault}"),
    }
}

/// Where a scene's files lie.
#[derive(Clone, Copy)]
pub struct Files<'s> {
    /// The scene.
    pub scene: &'s Description,
    /// The texts that it was read from; none for scenes made by programs.
    pub sources: &'s Sources,
    /// What was loaded before.
    pub library: &'s Library,
}

impl Files<'_> {
    /// A file named at `path`: an asset of that name, or a file relative to the scene file that
    /// names it.
    pub fn locate(&self, path: &Path, file: &str) -> PathBuf {
        if let Some(asset) = self.library.store().assets.path_of(file) {
            return asset;
        }
        let place = self.scene.item_of(path).and_then(|(item, _)| item.place());
        self.sources.folder(place).join(file)
    }

    /// The mesh that a description at `path` means: its own arrays, or those of its file, blended with its morphs.
    pub fn mesh(&self, mesh: &Mesh, path: &Trail<'_>, findings: &mut Vec<Finding>) -> Option<Mesh> {
        if mesh.morphs.is_empty() && (mesh.file.is_none() || mesh.crease_angle_degrees.is_none()) {
            return self.base(mesh, path, findings);
        }
        let mut own = Mesh::from(self.data(mesh, path, findings)?);
        own.crease_angle_degrees = mesh.crease_angle_degrees;
        Some(own)
    }

    /// What a mesh is at `moments` while the shutter is open, where that is not always the same.
    pub fn moving(
        &self,
        moments: &[&Mesh],
        path: &Trail<'_>,
        findings: &mut Vec<Finding>,
    ) -> Option<Result<Mesh, InvalidShape>> {
        let first = moments.first()?;
        if moments.iter().all(|at| at == first) {
            return None;
        }
        let mut keys = vec![self.data(first, path, findings)?];
        for at in moments.iter().skip(1) {
            // What is odd about a file has been said.
            keys.push(self.data(at, path, &mut Vec::new())?);
        }
        Some(Mesh::moving(keys, first.crease_angle_degrees))
    }

    /// The arrays of a mesh, blended.
    fn data(&self, mesh: &Mesh, path: &Trail<'_>, findings: &mut Vec<Finding>) -> Option<MeshData> {
        let mut base = self.base(mesh, path, findings)?;
        base.morphs.clone_from(&mesh.morphs);
        let mut targets: Vec<Vec<Vec3>> = Vec::new();
        for (i, morph) in mesh.morphs.iter().enumerate() {
            let path = Path::from(path).key("morphs").index(i);
            if morph.file.is_some() && !morph.positions.is_empty() {
                let message = "a morph has either `file` or `positions`, not both";
                findings.push(Finding::error(message).at(&path));
                return None;
            }
            targets.push(match &morph.file {
                None => morph.positions.clone(),
                Some(file) => self.file(file, &path.key("file"), findings)?.data()?.positions.clone(),
            });
        }
        match base.blended(&targets.iter().map(Vec::as_slice).collect::<Vec<_>>()) {
            Ok(data) => Some(data),
            Err(invalid) => {
                findings.push(Finding::error(invalid.message).at(Path::from(path).join(&invalid.field)));
                None
            }
        }
    }

    /// The mesh without its morphs.
    fn base(&self, mesh: &Mesh, path: &Trail<'_>, findings: &mut Vec<Finding>) -> Option<Mesh> {
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

    /// The mesh of a file that is named at `path`.
    fn file(&self, file: &str, path: &Path, findings: &mut Vec<Finding>) -> Option<Mesh> {
        match &self.library.get(&self.locate(path, file)).mesh {
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
        let library = Library::default();
        let first = library.get(&file);
        assert_eq!(first.digest, *blake3::hash(TRIANGLE.as_bytes()).as_bytes());
        // What is loaded is not looked at again.
        std::fs::write(&file, "v 0 0 0\n").unwrap();
        for name in [file.clone(), folder.path().join("sub/../a.obj"), folder.path().join("./a.obj")] {
            assert!(Arc::ptr_eq(&library.clone().get(&name), &first), "{}", name.display());
        }
        std::fs::write(folder.path().join("b.obj"), TRIANGLE).unwrap();
        let names = ["b.obj", "sub/../b.obj"].map(|name| folder.path().join(name));
        let found: Vec<Arc<Entry>> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..8)
                .map(|i| {
                    let name = &names[i % 2];
                    let library = &library;
                    scope.spawn(move || library.get(name))
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
        let library = Library::default();
        let broken = library.get(&file);
        assert_eq!(broken.digest, *blake3::hash(b"v 0 0\n").as_bytes());
        assert!(
            broken
                .mesh
                .as_ref()
                .unwrap_err()
                .ends_with("a.obj`: line 1: expected a number for z, found the end of the line")
        );
        assert_eq!(library.digest(&folder.path().join("none.obj")), [0; 32]);
        assert_eq!(library.digest(folder.path()), [0; 32]);
    }
}
