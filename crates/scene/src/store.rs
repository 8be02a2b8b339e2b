//! Where the files of a scene come from: the disk, or memory where there is none.

use crate::asset::Assets;
use crate::document::{self, Unreadable, text_of};
use crate::import::{self, Content, ImportError, Limits};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Where the files of a scene come from, and the scene's assets.
#[derive(Clone, Debug, Default)]
pub struct Store {
    place: Place,
    pub(crate) assets: Assets,
}

/// Where files come from.
#[derive(Clone, Debug, Default)]
enum Place {
    /// The file system.
    #[default]
    Disk,
    /// These files alone.
    Memory(Bundle),
}

impl From<Bundle> for Store {
    /// A store of the files of a bundle alone.
    fn from(bundle: Bundle) -> Self {
        Self { place: Place::Memory(bundle), assets: Assets::default() }
    }
}

/// Files in memory, by name. Cheap to clone.
///
/// A file is found by its path or, as files that people drop on a page come without their folders, by its name alone.
#[derive(Clone, Debug, Default)]
pub struct Bundle(Arc<BTreeMap<PathBuf, Vec<u8>>>);

impl FromIterator<(String, Vec<u8>)> for Bundle {
    fn from_iter<Files: IntoIterator<Item = (String, Vec<u8>)>>(files: Files) -> Self {
        Self(Arc::new(files.into_iter().map(|(name, bytes)| (plain(Path::new(&name)), bytes)).collect()))
    }
}

impl Bundle {
    fn find(&self, path: &Path) -> Option<(&PathBuf, &Vec<u8>)> {
        let alone = || self.0.get_key_value(Path::new(path.file_name()?));
        self.0.get_key_value(&plain(path)).or_else(alone)
    }
}

impl Store {
    /// The text of a file.
    pub(crate) fn text(&self, path: &Path) -> Result<String, Unreadable> {
        match &self.place {
            Place::Disk => document::read_text(path),
            Place::Memory(bundle) => {
                let (_, bytes) = bundle.find(path).ok_or_else(|| Unreadable::Io(ErrorKind::NotFound.into()))?;
                text_of(bytes.clone()).map_err(Unreadable::NotText)
            }
        }
    }

    /// What a file holds that is given as a scene.
    pub(crate) fn content(&self, path: &Path) -> Content {
        match &self.place {
            Place::Disk => Content::of_file(path),
            Place::Memory(bundle) => {
                bundle.find(path).map_or(Content::Scene, |(_, bytes)| Content::of(path, bytes, bytes.len() as u64))
            }
        }
    }

    /// The bytes of a file or asset.
    pub(crate) fn mesh(&self, path: &Path, limits: &Limits) -> Result<Cow<'_, [u8]>, ImportError> {
        if let Some(asset) = self.assets.at(path) {
            let wrong = || std::io::Error::other("the asset of this name holds pixels, not the bytes of a file");
            let bytes = asset.bytes().map(Cow::Borrowed);
            return bytes.ok_or_else(|| ImportError { path: path.to_owned(), fault: wrong().into() });
        }
        match &self.place {
            Place::Disk => import::read(path, limits).map(Cow::Owned),
            Place::Memory(bundle) => match bundle.find(path) {
                Some((_, bytes)) => Ok(Cow::Borrowed(bytes)),
                None => {
                    Err(ImportError { path: path.to_owned(), fault: std::io::Error::from(ErrorKind::NotFound).into() })
                }
            },
        }
    }

    /// The name that tells whether two files are one.
    pub(crate) fn true_name(&self, path: &Path) -> PathBuf {
        if self.assets.at(path).is_some() {
            return path.to_owned();
        }
        match &self.place {
            Place::Disk => std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()),
            Place::Memory(bundle) => bundle.find(path).map_or_else(|| plain(path), |(name, _)| name.clone()),
        }
    }
}

/// A path without `.`, and without `..` as far as a folder is left to go out of.
fn plain(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut plain, component| {
        match component {
            Component::CurDir => {}
            Component::ParentDir if plain.file_name().is_some() => {
                plain.pop();
            }
            other => plain.push(other),
        }
        plain
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bundle(names: &[&str]) -> Store {
        let file = |name: &&str| ((*name).to_owned(), name.as_bytes().to_vec());
        names.iter().map(file).collect::<Bundle>().into()
    }

    #[test]
    fn files_in_memory_are_found_by_path_and_else_by_name() {
        let store = bundle(&["scene.json", "models/a.obj", "b.obj", "./c/../d.obj"]);
        let found = |path: &str| {
            store.mesh(Path::new(path), &Limits::default()).map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        };
        assert_eq!(found("./models/x/../a.obj").unwrap(), "models/a.obj");
        assert_eq!(found("elsewhere/b.obj").unwrap(), "b.obj", "by its name alone");
        assert_eq!(found("d.obj").unwrap(), "./c/../d.obj");
        assert!(found("a.obj").unwrap_err().to_string().contains("a.obj"), "in a folder nobody named");
        assert_eq!(store.true_name(Path::new("elsewhere/b.obj")), Path::new("b.obj"));
        assert_eq!(store.true_name(Path::new("x/../y.obj")), Path::new("y.obj"));
        assert!(matches!(store.text(Path::new("none.json")), Err(Unreadable::Io(_))));
        assert_eq!(store.text(Path::new("scene.json")).unwrap(), "scene.json");
    }
}
