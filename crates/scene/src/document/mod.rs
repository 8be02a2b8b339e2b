//! Scene files as they are written: text, tree with places, includes merged. Nothing here knows what a scene is.

mod chunks;
mod guard;
mod include;
mod members;
mod parse;
mod put;
mod source;
mod tree;

pub use guard::{MAX_BYTES, MAX_DEPTH, MAX_VALUES, bytes_to_read};
pub use include::MAX_FILES;
pub use members::Members;
pub use source::{FileId, Place, Source, Sources};
pub use tree::{Member, Node, Value};

pub(crate) use chunks::LongList;
pub(crate) use include::finding;
pub(crate) use parse::{parse, parse_part};
pub(crate) use put::put;

use crate::report::Finding;
use crate::store::Store;
use juggler_imaging::regular;
use std::io;
use std::path::Path;

/// The files of a scene, merged into one tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The texts.
    pub sources: Sources,
    /// The merged tree, expressions unresolved, long lists left empty.
    pub tree: Node,
    /// The long lists of the main file, which are read piece by piece.
    pub(crate) lists: Vec<LongList>,
}

impl Document {
    /// Reads a scene from a text and the files it includes, which come from `store`; `name` is what messages call it,
    /// and the files it names are relative to that name's folder.
    ///
    /// Mistakes that leave everything in its place come with the document.
    pub fn read(name: &str, text: String, store: &Store) -> Result<(Self, Vec<Finding>), (Sources, Vec<Finding>)> {
        let mut reader = include::Reader::new(Path::new(name), store);
        let found = reader.main(name, text);
        let (sources, findings, complete) = reader.finish();
        match found {
            Some((tree, lists)) if complete => Ok((Self { sources, tree, lists }, findings)),
            _ => Err((sources, findings)),
        }
    }
}

/// Why a file gives no text.
#[derive(Debug)]
pub enum Unreadable {
    /// The system says no.
    Io(io::Error),
    /// It is no text.
    NotText(String),
}

/// The text of a file.
pub fn read_text(path: &Path) -> Result<String, Unreadable> {
    use io::Read;
    let file = regular::open(path).map_err(|error| match error {
        error if regular::is_of_kind(&error) => Unreadable::NotText(error.to_string()),
        error => Unreadable::Io(error),
    })?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(Unreadable::Io)?;
    guard::text(bytes).map_err(Unreadable::NotText)
}

/// The text of bytes that came from elsewhere.
pub fn text_of(bytes: Vec<u8>) -> Result<String, String> {
    guard::text(bytes)
}
