//! Scenes as files.

use crate::asset::Asset;
use crate::{Scene, SceneError};
use juggler_imaging::{Header, ImageFormat, atomic, create, raster_bytes, write_image};
use juggler_mesh::{ply_bytes, points_bytes};
use std::path::{Component, Path, PathBuf};

impl Scene {
    /// Saves the scene with its animation as a scene file, and its assets as files in the same
    /// folder, under the names that the scene uses: bytes as they are, images as PFM, meshes and
    /// instances as PLY, texels as PNG, or EXR if they are floats. Reading the scene file gives the same
    /// pictures. Files that the scene refers to stay where they are. Each file replaces an existing one
    /// once it is complete. Fails for an asset whose name is no relative path or leads out of the
    /// folder, and for a file that cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SceneError> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        for (name, asset) in self.asset_cache.store().assets.iter() {
            save_asset(asset, &file_of(name, folder)?)?;
        }
        write(path, self.to_json_in(folder).as_bytes())
    }
}

/// File of an asset in a folder.
fn file_of(name: &str, folder: &Path) -> Result<PathBuf, SceneError> {
    let mut parts = Path::new(name).components();
    let is_plain = !name.is_empty() && parts.all(|part| matches!(part, Component::Normal(_)));
    if is_plain { Ok(folder.join(name)) } else { Err(SceneError::AssetName(name.to_owned())) }
}

fn save_asset(asset: &Asset, path: &Path) -> Result<(), SceneError> {
    if let Some(parent) = path.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        let failed = |source| SceneError::Write { path: parent.to_owned(), source };
        std::fs::create_dir_all(parent).map_err(failed)?;
    }
    if let Some(bytes) = asset.bytes() {
        write(path, bytes)?;
    }
    if let Some(mesh) = asset.mesh() {
        write(path, &ply_bytes(mesh))?;
    }
    if let Some(instances) = asset.instances() {
        write(path, &points_bytes(&instances.to_points()))?;
    }
    if let Some(texels) = asset.texels() {
        write(path, &raster_bytes(&path.display().to_string(), &texels.raster())?)?;
    }
    if let Some(image) = asset.image() {
        let header = Header::new(image.width(), image.height());
        write_image(create(path, ImageFormat::Pfm, &header)?, image)?;
    }
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    atomic::write(path, bytes).map_err(|source| SceneError::Write { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assets_stay_in_the_folder_of_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let scene = |name: &str| Scene::new().asset(name, Asset::from_bytes(*b"bytes"));
        let place = folder.path().join("scene.json");
        for name in ["", "../a.obj", "/a.obj", "a/../../b", "."] {
            let error = scene(name).save(&place).unwrap_err().to_string();
            assert!(error.contains(&format!("`{name}`")), "{error}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        scene("models/a.obj").save(&place).unwrap();
        assert_eq!(std::fs::read(folder.path().join("models/a.obj")).unwrap(), b"bytes");
        let error = scene("scene.json/a").save(&place).unwrap_err().to_string();
        assert!(error.starts_with("cannot write `"), "{error}");
    }
}
