//! Everything that a scene was read from, so that another process can read it again without the files.

use crate::compile::NEVER_CANCELLED;
use crate::store::{Bundle, MAX_FILE_BYTES};
use crate::{Asset, Loader, Scene, SceneError};
use juggler_imaging::regular::{self, ReadError};
use std::io;
use std::path::Path;

/// Text and files that a scene was read from. Its assets are apart ([`Scene::assets`]).
///
/// ```
/// use juggler_scene::{Loader, Scene};
///
/// let scene = Scene::built_in("juggler")?;
/// let again = Loader::default().from_package(scene.package()?, [])?;
/// assert_eq!(again.fingerprint(), scene.fingerprint());
/// # Ok::<(), juggler_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScenePackage {
    /// Path of the scene file, to whose folder the names of files are relative.
    pub name: String,
    /// Text of the scene file; `None` for a mesh or a model that was given in place of a scene, which
    /// is one of the files.
    pub text: Option<String>,
    /// Paths and contents of all other files: included texts, meshes, images, photometric files, and
    /// models with the files that they name.
    pub files: Vec<(String, Vec<u8>)>,
}

impl ScenePackage {
    /// BLAKE3 hashes of the files, in their order.
    pub fn digests(&self) -> Vec<[u8; 32]> {
        self.files.iter().map(|(_, bytes)| blake3::hash(bytes).into()).collect()
    }
}

impl Loader {
    /// Reads the scene of a package, with its assets by name.
    pub fn from_package(
        self,
        package: ScenePackage,
        assets: impl IntoIterator<Item = (String, Asset)>,
    ) -> Result<Scene, SceneError> {
        let mut cache = self.cache(package.files.into_iter().collect::<Bundle>().into());
        assets.into_iter().for_each(|(name, asset)| cache.insert_asset(name, asset));
        match package.text {
            Some(text) => Scene::parse(text, &package.name, cache, &NEVER_CANCELLED),
            None => Scene::read(Path::new(&package.name), cache, &NEVER_CANCELLED),
        }
    }
}

impl Scene {
    /// Collects the text and the files that the scene was read from, without the edits since then. A
    /// file that is missing is left out, as some models may be shown without it. Fails for a file that
    /// cannot be read.
    pub fn package(&self) -> Result<ScenePackage, SceneError> {
        let mut texts = self.sources().texts();
        let main = texts.next();
        let mut package = ScenePackage {
            name: main.map_or_else(|| self.path_of_file(), |main| main.name.clone()),
            text: main.map(|main| main.text.clone()),
            files: texts.map(|source| (source.name.clone(), source.text.clone().into_bytes())).collect(),
        };
        let store = self.asset_cache.store();
        let known = self.sources().len();
        for path in self.paths().into_iter().skip(known).filter(|path| store.assets.at(path).is_none()) {
            match regular::read(&path, MAX_FILE_BYTES) {
                Ok(bytes) => package.files.push((path.to_string_lossy().into_owned(), bytes)),
                Err(ReadError::Io(error)) if error.kind() == io::ErrorKind::NotFound => {}
                Err(ReadError::Io(source)) => return Err(SceneError::Read { path, source }),
                Err(error) => return Err(SceneError::Read { path, source: io::Error::other(error.to_string()) }),
            }
        }
        package.files.sort();
        package.files.dedup();
        Ok(package)
    }

    /// Path of the mesh or model that the scene is around.
    fn path_of_file(&self) -> String {
        let object = self.description.objects.first();
        let model = object.and_then(|object| object.model.as_ref()).map(|model| &model.file);
        let mesh = object.and_then(|object| object.mesh()).and_then(|mesh| mesh.file.as_ref());
        model.or(mesh).cloned().unwrap_or_default()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::{Asset, Loader, Scene};
    use std::fs;
    use std::path::Path;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    fn write(folder: &Path, name: &str, text: &str) {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// A scene whose files are in several folders.
    fn scene(folder: &Path) -> Scene {
        write(folder, "meshes/a.obj", TRIANGLE);
        write(folder, "parts/b.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
        write(
            folder,
            "parts/more.json",
            r#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "b.obj"}}}, {"shape": {"mesh": {"file": "c.obj"}}}]}"#,
        );
        let text = r#"{"version": 1, "include": ["parts/more.json"],
            "objects": [{"shape": {"mesh": {"file": "meshes/../meshes/a.obj"}}}]}"#;
        let name = folder.join("scene.json");
        write(folder, "scene.json", text);
        let assets = [("c.obj".to_owned(), Asset::from_bytes(TRIANGLE.as_bytes().to_vec()))];
        Loader::default().from_json_with(text, name.to_str().unwrap(), assets).unwrap()
    }

    #[test]
    fn a_package_needs_no_files() {
        let folder = tempfile::tempdir().unwrap();
        let scene = scene(folder.path());
        let package = scene.package().unwrap();
        assert_eq!(package.files.len(), 3, "{package:?}");
        let expected = scene.fingerprint();
        fs::remove_dir_all(folder.path()).unwrap();
        let assets = scene.assets().map(|(name, asset)| (name.to_owned(), asset.clone()));
        let again = Loader::default().from_package(package, assets.collect::<Vec<_>>()).unwrap();
        assert_eq!(again.fingerprint(), expected);
        assert!(again.compile().is_ok());
    }

    #[test]
    fn a_mesh_in_place_of_a_scene_is_packed() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "a.obj", TRIANGLE);
        let scene = Scene::load(folder.path().join("a.obj")).unwrap();
        let (package, expected) = (scene.package().unwrap(), scene.fingerprint());
        assert_eq!((package.files.len(), &package.text), (1, &None));
        fs::remove_dir_all(folder.path()).unwrap();
        let again = Loader::default().from_package(package, []).unwrap();
        assert_eq!(again.fingerprint(), expected);
    }

    #[test]
    fn edits_and_missing_files_are_no_part_of_a_package() {
        let folder = tempfile::tempdir().unwrap();
        let scene = scene(folder.path());
        let edited = scene.clone().samples(7);
        assert_eq!(edited.package().unwrap(), scene.package().unwrap());
        fs::remove_file(folder.path().join("meshes/a.obj")).unwrap();
        assert_eq!(scene.package().unwrap().files.len(), 2);
        fs::create_dir(folder.path().join("meshes/a.obj")).unwrap();
        assert!(scene.package().unwrap_err().to_string().contains("a.obj"));
    }
}
