//! Unpacking: models and arrays of a scene become objects, files of meshes and instances, and pictures.

use crate::asset::Asset;
use crate::compile::AssetCache;
use crate::description::{Instances, Object, Objects};
use crate::item::Item;
use crate::report::Finding;
use crate::{Scene, SceneError};
use juggler_shape::{Mesh, MeshData};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Folder of the mesh files, and the name of a file whose object has none.
const MESH: [&str; 2] = ["meshes", "mesh"];
/// As [`MESH`], for the files of instances.
const INSTANCES: [&str; 2] = ["instances", "points"];
/// Number of instances from which their arrays become a file. Fewer are easier to read in the scene.
const MIN_INSTANCES: usize = 1000;
/// Maximum number of bytes of a name that a file takes from its object.
const MAX_NAME: usize = 80;

impl Scene {
    /// The scene at its frame, with the objects, materials and lights of its models in their place.
    /// Meshes that are arrays become assets, which [`Scene::save`] writes as PLY files, and so do arrays of
    /// many instances; the pictures of models are assets, too.
    ///
    /// # Errors
    ///
    /// A model cannot be read.
    pub fn unpacked(&self) -> Result<Self, SceneError> {
        let mut scene = self.still();
        let Some(expansion) = self.expanded() else {
            scene.unpack_meshes();
            return Ok(scene);
        };
        if expansion.findings.iter().any(Finding::is_error) {
            return Err(SceneError::Problems(self.report(expansion.findings.clone())));
        }
        scene.description = expansion.description.clone();
        scene.description.make_static();
        scene.asset_cache = expansion.asset_cache.clone();
        scene.unpack_meshes();
        Ok(scene)
    }

    fn unpack_meshes(&mut self) {
        let asset_cache = &mut self.asset_cache;
        let (files, instances, names) = Default::default();
        let mut unpacker = Unpacker { asset_cache, files, instances, names };
        for (name, objects) in self.description.groups.iter_mut() {
            unpacker.list(objects, name);
        }
        unpacker.list(&mut self.description.objects, "");
    }
}

struct Unpacker<'s> {
    asset_cache: &'s mut AssetCache,
    /// Names of the files by the addresses of the arrays that they contain, which the assets' meshes
    /// keep alive.
    files: BTreeMap<usize, (Arc<MeshData>, String)>,
    /// Names of the files of instances by the hashes of their arrays.
    instances: BTreeMap<[u8; 32], String>,
    /// Names in lower case, as file systems may compare them.
    names: BTreeSet<String>,
}

impl Unpacker<'_> {
    /// Unpacks the meshes of a list of objects. `outer` is the name of the list or of its object.
    fn list(&mut self, objects: &mut Objects, outer: &str) {
        for object in objects.iter_mut().filter(|object| has_arrays(object)) {
            let object = object.value_mut_unmarked();
            let name = object.name.clone().unwrap_or_else(|| outer.to_owned());
            if let Some(mesh) = object.shape.as_mut().and_then(|shape| shape.mesh_mut())
                && let Some(file) = self.file(mesh, &name)
            {
                let crease_angle_degrees = mesh.crease_angle_degrees;
                *mesh = Mesh::from_file(file);
                mesh.crease_angle_degrees = crease_angle_degrees;
            }
            if let Some(instances) = object.instances.as_mut().filter(|instances| are_many(instances)) {
                **instances = Instances::from_file(self.instance_file(instances, &name));
            }
            object.objects.iter_mut().for_each(|objects| self.list(objects, &name));
        }
    }

    /// File of the arrays of a mesh; `None` if they stay in the scene.
    fn file(&mut self, mesh: &Mesh, name: &str) -> Option<String> {
        if mesh.file.is_some() || !mesh.morphs.is_empty() {
            return None;
        }
        let arrays = mesh.arrays();
        let address = Arc::as_ptr(arrays) as usize;
        if let Some((_, known)) = self.files.get(&address) {
            return Some(known.clone());
        }
        let file = self.unique(MESH, name);
        self.asset_cache.insert_asset(file.clone(), Asset::from_mesh(Arc::clone(arrays)));
        self.files.insert(address, (Arc::clone(arrays), file.clone()));
        Some(file)
    }

    /// File of the arrays of instances.
    fn instance_file(&mut self, instances: &Instances, name: &str) -> String {
        let asset = Asset::from_instances(instances.clone());
        if let Some(known) = self.instances.get(&asset.digest()) {
            return known.clone();
        }
        let file = self.unique(INSTANCES, name);
        self.instances.insert(asset.digest(), file.clone());
        self.asset_cache.insert_asset(file.clone(), asset);
        file
    }

    /// Name of a new file after the last part of a name such as `car/Root/Wheel`.
    fn unique(&mut self, [folder, default]: [&str; 2], name: &str) -> String {
        let last = name.rsplit('/').next().unwrap_or_default();
        let plain = |c: char| if c.is_alphanumeric() || "-_ ".contains(c) { c } else { '_' };
        let stem: String = last.chars().map(plain).collect();
        let stem = stem.get(..stem.floor_char_boundary(MAX_NAME)).unwrap_or_default().trim();
        let stem = if stem.is_empty() { default } else { stem };
        let numbered = (2..).map(|number: u64| format!("{folder}/{stem}-{number}.ply"));
        let mut candidates = std::iter::once(format!("{folder}/{stem}.ply")).chain(numbered);
        candidates.find(|file| self.names.insert(file.to_lowercase())).unwrap_or_default()
    }
}

/// Whether an object or an object inside it is a mesh of arrays or has many instances.
fn has_arrays(object: &Item<Object>) -> bool {
    let own =
        object.mesh().is_some_and(|mesh| mesh.file.is_none()) || object.instances.as_deref().is_some_and(are_many);
    own || object.inner().iter().any(has_arrays)
}

/// Whether arrays of instances become a file.
fn are_many(instances: &Instances) -> bool {
    instances.file.is_none() && instances.count() >= MIN_INSTANCES
}
