//! The names that a scene declares.

use crate::description::Description;

/// The names that a scene declared when its references were checked.
#[derive(Debug)]
pub(crate) struct DeclaredNames([Vec<String>; 4]);

impl DeclaredNames {
    /// Collects the names of a scene.
    pub fn of(scene: &Description) -> Self {
        let Description { materials, textures, groups, cameras, .. } = scene;
        let cameras = cameras.keys().cloned().collect();
        Self([
            materials.keys().cloned().collect(),
            textures.keys().cloned().collect(),
            groups.keys().cloned().collect(),
            cameras,
        ])
    }

    /// Whether a scene still declares all of the names.
    pub fn are_in(&self, scene: &Description) -> bool {
        let Self([materials, textures, groups, cameras]) = self;
        materials.iter().all(|name| scene.materials.contains_key(name))
            && textures.iter().all(|name| scene.textures.contains_key(name))
            && groups.iter().all(|name| scene.groups.contains_key(name))
            && cameras.iter().all(|name| scene.cameras.contains_key(name))
    }
}
