//! Files of instances. Each is read once and shared by all objects, frames and copies of a scene.

use super::count::MAX_STORED;
use super::file_cache::{CachedFile, FileCache};
use super::meshes::{AssetCache, Files};
use crate::asset::display_name;
use crate::description::{Description, InstanceFile, Instances, Object};
use crate::item::Item;
use crate::path::{Path, PathRef};
use crate::report::Finding;
use crate::store::MAX_FILE_BYTES;
use juggler_mesh::MeshLimits;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Limits of a file of points.
const LIMITS: MeshLimits = MeshLimits { file_bytes: MAX_FILE_BYTES, vertices: MAX_STORED as u32, triangles: 0 };

/// Cache of files of instances.
pub type InstanceCache = FileCache<LoadedInstances>;

/// Instances of a file, with warnings about what it contains.
#[derive(Debug, Default)]
pub struct LoadedInstances {
    instances: Instances,
    warnings: Vec<String>,
}

impl AssetCache {
    /// Instances of a file or asset.
    fn instance_file(&self, path: &std::path::Path) -> std::sync::Arc<CachedFile<LoadedInstances>> {
        let asset = self.store().assets.at(path);
        match asset.and_then(|asset| Some((asset.digest(), asset.instances()?))) {
            Some((digest, instances)) => self.instances().insert_asset(path, digest, || of_asset(instances, path)),
            None => self.instances().load(path, self.store(), LIMITS.file_bytes, |bytes| parse(path, bytes)),
        }
    }

    /// Hash of the content of a file of instances; zeros for a file that cannot be read, which
    /// compilation reports.
    pub fn instance_digest(&self, path: &std::path::Path) -> [u8; 32] {
        match self.store().assets.at(path) {
            Some(asset) => asset.digest(),
            None => self.instance_file(path).digest,
        }
    }
}

/// Instances of the bytes of a PLY file.
fn parse(path: &std::path::Path, bytes: &[u8]) -> Result<LoadedInstances, String> {
    let points = juggler_mesh::parse_points(bytes, &LIMITS);
    let mut points = points.map_err(|error| format!("cannot read `{}`: {error}", display_name(path)))?;
    let warnings = std::mem::take(&mut points.warnings);
    Ok(LoadedInstances { instances: Instances::from_points(points), warnings })
}

fn of_asset(instances: &Instances, path: &std::path::Path) -> Result<LoadedInstances, String> {
    if instances.file.is_some() {
        return Err(format!("the instances of the asset `{}` must not name a `file`", display_name(path)));
    }
    Ok(LoadedInstances { instances: instances.clone(), warnings: Vec::new() })
}

impl Files<'_> {
    /// Instances of the description at `path`, with those of their file in its place. Reports a file
    /// that cannot be used, which counts as empty.
    pub fn instances(&self, instances: &Instances, path: &PathRef<'_>, findings: &mut Vec<Finding>) -> Instances {
        let Some(file) = &instances.file else { return instances.clone() };
        let at_file = Path::from(path).key("file");
        let loaded = self.asset_cache.instance_file(&self.locate(&at_file, file.name()));
        match &loaded.content {
            Ok(loaded) => {
                findings.extend(loaded.warnings.iter().map(|warning| Finding::warning(warning.clone()).at(&at_file)));
                loaded.instances.with_arrays(instances).unwrap_or_else(|wrong| {
                    findings.push(Finding::error(wrong.message).at(path.join(wrong.field)));
                    Instances::default()
                })
            }
            Err(message) => {
                findings.push(Finding::error(message.clone()).at(&at_file));
                Instances::default()
            }
        }
    }
}

impl Files<'_> {
    /// Instances of the description at `path`, with as many instances as the head of their file
    /// declares. Those of an asset are its arrays.
    pub fn declared_instances(&self, instances: &Instances, path: &PathRef<'_>) -> Instances {
        let Some(file) = &instances.file else { return instances.clone() };
        let location = self.locate(&Path::from(path).key("file"), file.name());
        let store = self.asset_cache.store();
        if store.assets.at(&location).is_some_and(|asset| asset.instances().is_some()) {
            return self.instances(instances, path, &mut Vec::new());
        }
        let count = store.points_of_head(&location).count;
        let file = file.with_declared_count(usize::try_from(count).unwrap_or(usize::MAX));
        Instances { file: Some(file), ..instances.clone() }
    }
}

/// Whether a list of objects contains instances of a file.
pub fn has_instance_files(objects: &[Item<Object>]) -> bool {
    objects.iter().any(|object| object_has_instance_files(object))
}

/// Whether an object, or one inside it, has instances of a file.
pub fn object_has_instance_files(object: &Object) -> bool {
    file_of(object).is_some() || has_instance_files(object.inner())
}

fn file_of(object: &Object) -> Option<&InstanceFile> {
    object.instances.as_ref()?.file.as_ref()
}

/// Locations of the files of instances of a scene, without duplicates.
pub fn instance_files(scene: &Description, files: &Files<'_>) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let groups = PathRef::Root.key("groups");
    for (name, objects) in scene.groups.iter() {
        collect(objects, &groups.key(name), files, &mut found);
    }
    collect(&scene.objects, &PathRef::Root.key("objects"), files, &mut found);
    found
}

fn collect(objects: &[Item<Object>], path: &PathRef<'_>, files: &Files<'_>, found: &mut BTreeSet<PathBuf>) {
    for (i, object) in objects.iter().enumerate() {
        let path = path.index(i);
        found.extend(file_of(object).map(|file| files.locate(&path.key("instances").join("file"), file.name())));
        collect(object.inner(), &path.key("objects"), files, found);
    }
}
