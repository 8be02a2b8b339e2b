//! Mesh files: each loaded, prepared and hashed once, shared by all objects, frames and copies of a scene.

use crate::document::{Node, Sources};
use crate::import::{Fault, ImportError, Imported, Limits, load};
use crate::path::{Path, Trail};
use crate::report::{Finding, plain_io};
use juggler_tracer::shape::{Mesh, MeshData, Shape};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// The meshes that were loaded so far.
#[derive(Clone, Debug, Default)]
pub struct Library {
    entries: Arc<Mutex<BTreeMap<PathBuf, Entry>>>,
}

/// A mesh ready to be placed, with all that is odd about it; or why there is none.
type Entry = Result<(Mesh, Vec<String>), String>;

impl Library {
    fn get(&self, path: &std::path::Path) -> Entry {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        entries.entry(path.to_path_buf()).or_insert_with(|| read(path)).clone()
    }
}

fn read(path: &std::path::Path) -> Entry {
    let Imported { mesh, mut warnings } = import(path).map_err(|error| explain(&error))?;
    let mut shape = Mesh::from(mesh);
    shape.prepare().map_err(|invalid| format!("`{}` holds a mesh that cannot be: {invalid}", path.display()))?;
    warnings.extend(shape.warnings());
    Ok((shape, warnings))
}

/// Loads an ordinary file: what waits for another program could wait forever.
fn import(path: &std::path::Path) -> Result<Imported, ImportError> {
    let refuse = |fault| ImportError { path: path.to_owned(), fault };
    let metadata = std::fs::metadata(path).map_err(|error| refuse(Fault::Read(error)))?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { std::io::ErrorKind::IsADirectory } else { std::io::ErrorKind::Unsupported };
        return Err(refuse(Fault::Read(kind.into())));
    }
    load(path, &Limits::default())
}

fn explain(error: &ImportError) -> String {
    let shown = error.path.display();
    match &error.fault {
        Fault::Read(error) => format!("cannot read `{shown}`: {}", plain_io(error)),
        fault => format!("cannot read `{shown}`: {fault}"),
    }
}

/// Where a scene's files lie.
#[derive(Clone, Copy)]
pub struct Files<'s> {
    /// The texts of the scene, and its tree with the places in them; nothing for scenes made by programs.
    pub origin: Option<(&'s Sources, &'s Node)>,
    /// What was loaded before.
    pub library: &'s Library,
}

impl Files<'_> {
    /// A file named at `path`, relative to the scene file that names it.
    pub fn locate(&self, path: &Path, file: &str) -> PathBuf {
        match self.origin {
            Some((sources, tree)) => sources.folder(tree.place_of(path).0).join(file),
            None => PathBuf::from(file),
        }
    }

    /// The mesh that a description at `path` means: its own arrays, or those of its file.
    pub fn mesh(&self, mesh: &Mesh, path: &Trail<'_>, findings: &mut Vec<Finding>) -> Option<Mesh> {
        let Some(file) = &mesh.file else {
            return Some(mesh.clone());
        };
        let path = Path::from(path).key("file");
        if let Err(invalid) = mesh.clone().load(MeshData::default()) {
            findings.push(Finding::error(invalid.message).at(&path));
            return None;
        }
        match self.library.get(&self.locate(&path, file)) {
            Ok((mesh, warnings)) => {
                findings.extend(warnings.into_iter().map(|warning| Finding::warning(warning).at(&path)));
                Some(mesh)
            }
            Err(message) => {
                findings.push(Finding::error(message).at(&path));
                None
            }
        }
    }
}
