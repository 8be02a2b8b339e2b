//! Scene files as JSON documents: texts, a tree with text positions, merged includes. Independent
//! of the scene format's meaning, except for the names of its sections.

mod chunks;
mod explain;
mod include;
mod limits;
mod members;
mod parse;
mod set_at_pointer;
mod source;
mod tree;

pub use include::MAX_FILES;
pub use limits::{MAX_BYTES, MAX_DEPTH, MAX_VALUES, bytes_to_read};
pub use members::Members;
pub use source::{FileId, Source, SourceSpan, Sources};
pub use tree::{Member, Node, Value};

pub(crate) use chunks::LongList;
pub(crate) use include::finding;
pub(crate) use parse::{parse, parse_part};
pub(crate) use set_at_pointer::set_at_pointer;

use crate::report::Finding;
use crate::store::Store;
use juggler_imaging::regular;
use std::io;
use std::path::Path;

/// The files of a scene, merged into one tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The texts of the files.
    pub sources: Sources,
    /// The merged tree with unevaluated expressions and empty long lists.
    pub tree: Node,
    /// The long lists of the main file, which are parsed in chunks.
    pub(crate) lists: Vec<LongList>,
}

impl Document {
    /// Reads a scene from the text of its main file and from the files it includes, which come from
    /// `store`. Messages call the main file `name`, and file names in it are relative to the folder
    /// of `name`.
    ///
    /// Errors that leave the structure intact are returned with the document; other errors without
    /// one, with the texts read so far.
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

/// Error of reading a text file.
#[derive(Debug)]
pub enum Unreadable {
    /// The system reports an error.
    Io(io::Error),
    /// The content is not text, for the reason given.
    NotText(String),
}

/// Reads the text of a file of at most [`MAX_BYTES`] bytes.
pub fn read_text(path: &Path) -> Result<String, Unreadable> {
    use io::Read;
    let file = regular::open(path).map_err(|error| match error {
        error if regular::is_not_regular(&error) => Unreadable::NotText(error.to_string()),
        error => Unreadable::Io(error),
    })?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(Unreadable::Io)?;
    limits::text(bytes).map_err(Unreadable::NotText)
}

/// Decodes the bytes of a file as text.
pub fn text_of(bytes: Vec<u8>) -> Result<String, String> {
    limits::text(bytes)
}
