//! Files of instances. Each is read once and shared by all objects, frames and copies of a scene.

use super::count::MAX_STORED;
use super::file_cache::CachedFile;
use super::loaded_instances::LoadedInstances;
use super::meshes::{AssetCache, Files};
use crate::asset::display_name;
use crate::description::{Instances, Object};
use crate::item::Item;
use crate::path::{Path, PathRef};
use crate::report::Finding;
use crate::store::MAX_FILE_BYTES;
use juggler_mesh::MeshLimits;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

/// Limits of a file of points.
const LIMITS: MeshLimits = MeshLimits { file_bytes: MAX_FILE_BYTES, vertices: MAX_STORED as u32, triangles: 0 };

impl AssetCache {
    /// Instances of a file or asset.
    fn instance_file(&self, path: &std::path::Path) -> Arc<CachedFile<LoadedInstances>> {
        let asset = self.store().assets.at(path);
        match asset.and_then(|asset| Some((asset.digest(), asset.instances()?))) {
            Some((digest, instances)) => self
                .instances()
                .insert_asset(path, digest, || LoadedInstances::of_asset(instances, &display_name(path))),
            None => self.instances().load(path, self.store(), LIMITS.file_bytes, |bytes| {
                LoadedInstances::parse(bytes, &LIMITS, &display_name(path))
            }),
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

impl Files<'_> {
    /// Locations of the scene's files of instances, without duplicates.
    pub fn instance_files(&self) -> BTreeSet<PathBuf> {
        let mut found = BTreeSet::new();
        let groups = PathRef::Root.key("groups");
        for (name, objects) in self.scene.groups.iter() {
            collect(objects, &groups.key(name), self, &mut found);
        }
        collect(&self.scene.objects, &PathRef::Root.key("objects"), self, &mut found);
        found
    }
}

fn collect(objects: &[Item<Object>], path: &PathRef<'_>, files: &Files<'_>, found: &mut BTreeSet<PathBuf>) {
    for (i, object) in objects.iter().enumerate() {
        let path = path.index(i);
        let file = object.instances.as_ref().and_then(|instances| instances.file.as_ref());
        found.extend(file.map(|file| files.locate(&path.key("instances").join("file"), file.name())));
        collect(object.inner(), &path.key("objects"), files, found);
    }
}
