//! First pass over a document: its structure.
//!
//! Every index, type and range is checked, all sums of offsets and lengths in 64 bits without
//! overflow, and the graph of nodes. The pass allocates little beyond the document and finds all
//! faults at once. Contents of buffers are checked when they are decoded.

mod accessors;
mod animations;
mod buffers;
mod cameras;
mod checker;
mod graph;
mod images;
mod materials;
mod meshes;
mod nodes;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod types_tests;

use super::document::Document;
use super::error::GltfError;
use super::extensions::{Support, extension};
use super::limits::Limits;
use super::location::Location;
use super::warning::Warnings;
use checker::Checker;

/// Checks the structure of a document. `binary` is the length of the chunk BIN of a `.glb`. Returns
/// warnings.
///
/// # Errors
///
/// All faults, up to a limit.
pub fn check(name: &str, document: &Document, binary: Option<u64>, limits: &Limits) -> Result<Warnings, GltfError> {
    let mut checker = Checker::new(document, binary, limits);
    checker.asset();
    checker.extensions();
    checker.counts();
    // A document that is too large does not deserve more time.
    if checker.faults.is_empty() {
        checker.buffers();
        checker.buffer_views();
        checker.accessors();
        checker.images();
        checker.materials();
        checker.meshes();
        checker.cameras();
        checker.lights();
        checker.skins();
        checker.nodes();
        checker.scenes();
        checker.graph();
        checker.animations();
    }
    match checker.faults.is_empty() {
        true => Ok(checker.warnings),
        false => Err(GltfError { file: name.to_owned(), faults: checker.faults, omitted: checker.omitted }),
    }
}

impl Checker<'_> {
    /// Checks the version.
    fn asset(&mut self) {
        let asset = &self.document.asset;
        let at = Location::root("asset");
        for (key, version) in [("version", Some(&asset.version)), ("minVersion", asset.min_version.as_ref())] {
            let Some(version) = version else { continue };
            match version.split_once('.').map(|(major, minor)| (major, minor.parse::<u32>().is_ok())) {
                Some(("2", true)) => {}
                Some(("1", true)) => self.fault(&at.key(key), format_args!("glTF 1.0; convert it first")),
                _ => self.fault(&at.key(key), format_args!("version `{version}` cannot be read, expected 2.0")),
            }
        }
    }

    /// Checks that all required extensions are known; warns of those that have no effect.
    fn extensions(&mut self) {
        let document = self.document;
        let at = Location::root("extensionsRequired");
        for (position, name) in document.extensions_required.iter().enumerate() {
            if extension(name).is_none() {
                self.fault(&at.index(position), format_args!("`{name}` cannot be read"));
            }
        }
        let at = Location::root("extensionsUsed");
        for (position, name) in document.extensions_used.iter().enumerate() {
            match extension(name) {
                None => self.warn(&at.index(position), format_args!("`{name}` is not known and has no effect")),
                Some(known) if known.support != Support::Whole => {
                    let (support, note) = (known.support.name(), known.note);
                    self.warn(&at.index(position), format_args!("`{name}` is {support}: {note}"));
                }
                Some(_) => {}
            }
        }
    }

    /// Checks the numbers of objects.
    fn counts(&mut self) {
        let (document, limits) = (self.document, self.limits);
        for (key, count, limit) in [
            ("nodes", document.nodes.len(), limits.nodes),
            ("meshes", document.meshes.len(), limits.nodes),
            ("accessors", document.accessors.len(), limits.accessors),
            ("bufferViews", document.buffer_views.len(), limits.accessors),
            ("materials", document.materials.len(), limits.materials),
        ] {
            self.count(&Location::root(key), count as u64, limit as u64, key);
        }
    }
}
