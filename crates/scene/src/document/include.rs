//! Merging of included files into one tree: `"include": ["materials.json"]`.
//!
//! The members of an included file's [`MAPS`] and [`LISTS`] are added to those of the including
//! file. All else in it (cameras, settings, title) is ignored, so that a whole scene can serve as a
//! library. A file that is included twice is merged once.

use super::chunks::{self, LongList};
use super::limits::{self, SyntaxError};
use super::source::{FileId, SourceSpan, Sources};
use super::tree::{Member, Node, Value};
use super::{Unreadable, parse, parse_part};
use crate::path::PathRef;
use crate::report::{Finding, plain_io};
use crate::schema::Schema;
use crate::store::Store;
use crate::validate::suggest_scene_key;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Sections of named members; names are unique. Variables of included files come first, since later
/// ones may use them.
const MAPS: [&str; 6] = ["variables", "paths", "cameras", "textures", "materials", "groups"];
/// Sections of ordered elements; those of included files come first.
const LISTS: [&str; 2] = ["lights", "objects"];
/// Maximum number of files of a scene: the main file and all included files.
pub const MAX_FILES: usize = 1000;
/// Maximum depth of nested includes.
const MAX_CHAIN: usize = 32;

/// Reads the files of a scene.
pub struct Reader<'s> {
    store: &'s Store,
    sources: Sources,
    findings: Vec<Finding>,
    /// Canonical names of all files read.
    read_files: Vec<PathBuf>,
    /// Canonical names of the files being read; each is included by the one before.
    open: Vec<PathBuf>,
    complete: bool,
}

impl<'s> Reader<'s> {
    /// Creates a reader for the scene in the file `main`; other files come from `store`.
    pub fn new(main: &Path, store: &'s Store) -> Self {
        let main = store.canonical_name(main);
        Self {
            store,
            sources: Sources::default(),
            findings: Vec::new(),
            read_files: vec![main.clone()],
            open: vec![main],
            complete: true,
        }
    }

    /// Reads the main file. Returns the merged tree, if it can be parsed, and the long lists that
    /// are left out of the tree.
    pub fn main(&mut self, name: &str, text: String) -> Option<(Node, Vec<LongList>)> {
        let split = chunks::split(&text).filter(|_| limits::check(&text).is_ok());
        let parsed = split.and_then(|(rest, lists)| Some((parse_without_includes(&rest)?, lists)));
        match parsed {
            Some((parsed, lists)) => {
                let id = self.sources.add(name, text);
                Some((self.merged(id, Ok(parsed))?, lists))
            }
            None => Some((self.file(name, text)?, Vec::new())),
        }
    }

    /// Returns the texts, all findings, and whether every file could be read. If one is missing,
    /// further checks would report all names that it defines as unknown.
    pub fn finish(self) -> (Sources, Vec<Finding>, bool) {
        (self.sources, self.findings, self.complete)
    }

    fn file(&mut self, name: &str, text: String) -> Option<Node> {
        let id = self.sources.add(name, text);
        let text = self.sources.get(id).map(|source| source.text.as_str()).unwrap_or_default();
        let parsed = parse(text, id);
        self.merged(id, parsed)
    }

    /// Checks the root of a parsed file and merges its includes into it.
    fn merged(&mut self, id: FileId, parsed: Result<(Node, Vec<SyntaxError>), SyntaxError>) -> Option<Node> {
        let mut tree = match parsed {
            Ok((tree, errors)) => {
                self.findings.extend(errors.into_iter().map(|error| finding(id, error)));
                tree
            }
            Err(error) => {
                self.findings.push(finding(id, error));
                self.complete = false;
                return None;
            }
        };
        let Value::Object(members) = &mut tree.value else {
            let message = format!("a scene must be an object `{{...}}`, found {}", tree.kind());
            self.findings.push(Finding::error(message).on(tree.place));
            self.complete = false;
            return None;
        };
        let members = Arc::make_mut(members);
        if let Some(schema) = members.remove("$schema") {
            self.check_schema(&schema.node);
        }
        let Some(include) = members.remove("include") else { return Some(tree) };
        for named in self.names(&include.node) {
            if let Some(other) = self.included(named, id) {
                self.merge(&mut tree, other);
            }
        }
        Some(tree)
    }

    /// Checks that `$schema`, which gives editors the address of the format's JSON Schema, is a
    /// string.
    fn check_schema(&mut self, schema: &Node) {
        if schema.as_str().is_none() {
            let message = format!("expected the address of the scene format's JSON Schema, found {}", schema.kind());
            self.findings.push(Finding::error(message).on(schema.place));
        }
    }

    /// The file names of `include`, which is a string or an array of strings.
    fn names(&mut self, include: &Node) -> Vec<(String, Option<SourceSpan>)> {
        let named = match &include.value {
            Value::Array(elements) => elements.iter().collect(),
            _ => vec![include],
        };
        let mut names = Vec::new();
        for node in named {
            match node.as_str() {
                Some(name) => names.push((name.to_owned(), node.place)),
                None => {
                    let message = format!("expected the name of a scene file, found {}", node.kind());
                    self.findings.push(Finding::error(message).on(node.place));
                }
            }
        }
        names
    }

    fn included(&mut self, (name, place): (String, Option<SourceSpan>), by: FileId) -> Option<Node> {
        let folder = self.sources.get(by).map(|source| source.folder.clone()).unwrap_or_default();
        let path = folder.join(&name);
        let identity = self.store.canonical_name(&path);
        let problem = if let Some(at) = self.open.iter().position(|open| *open == identity) {
            let chain: Vec<_> = self.open.iter().skip(at).chain([&identity]).map(|p| file_name(p)).collect();
            Some(format!("files include each other in a cycle: {}", chain.join(" → ")))
        } else if self.read_files.contains(&identity) {
            return None;
        } else if self.open.len() > MAX_CHAIN {
            Some(format!("includes are nested deeper than the limit of {MAX_CHAIN}"))
        } else if self.read_files.len() >= MAX_FILES {
            Some(format!("a scene has at most {MAX_FILES} files"))
        } else {
            None
        };
        let text =
            match problem.map_or_else(|| self.store.text(&path).map_err(|why| explain(&path, why, self.store)), Err) {
                Ok(text) => text,
                Err(message) => {
                    self.findings.push(Finding::error(message).on(place));
                    self.complete = false;
                    return None;
                }
            };
        self.read_files.push(identity.clone());
        self.open.push(identity);
        let tree = self.file(&path.to_string_lossy(), text);
        self.open.pop();
        tree.iter().for_each(|tree| self.check_keys(tree));
        tree
    }

    /// Checks keys and version of an included file, of which only a part is merged.
    fn check_keys(&mut self, tree: &Node) {
        let known = Schema::get().root().get("properties").and_then(serde_json::Value::as_object);
        let known: Vec<&str> = known.into_iter().flat_map(|known| known.keys()).map(String::as_str).collect();
        for (key, member) in tree.members().filter(|(key, _)| !known.contains(&key.as_str())) {
            let finding = Finding::error(format!("unknown key `{key}`")).on(member.key_place);
            self.findings.push(finding.maybe_help(suggest_scene_key(key, &member.node)));
        }
        if let Some(version) =
            tree.get("version").filter(|version| !matches!(&version.value, Value::Number(n) if n.as_f64() == Some(1.0)))
        {
            let message = "unsupported version of the scene format: this program reads version 1";
            self.findings.push(Finding::error(message).on(version.place));
        }
    }

    fn merge(&mut self, into: &mut Node, from: Node) {
        let (Value::Object(into), Value::Object(from)) = (&mut into.value, from.value) else { return };
        let into = Arc::make_mut(into);
        for (key, member) in Arc::unwrap_or_clone(from) {
            let known = MAPS.contains(&key.as_str()) || LISTS.contains(&key.as_str());
            match into.get_mut(&key) {
                None if known => into.append(key, member),
                Some(own) if known => self.join(&key, own, member),
                _ => {}
            }
        }
    }

    fn join(&mut self, key: &str, own: &mut Member, other: Member) {
        match (&mut own.node.value, other.node.value) {
            (Value::Array(own), Value::Array(mut elements)) => {
                Arc::make_mut(&mut elements).append(Arc::make_mut(own));
                *own = elements;
            }
            (Value::Object(own), Value::Object(other)) => {
                let own = Arc::make_mut(own);
                let mut first = Vec::new();
                for (at, (name, member)) in Arc::unwrap_or_clone(other).into_iter().enumerate() {
                    if let Some(known) = own.get(&name) {
                        let elsewhere = self.file_name(known.key_place);
                        let message = format!("`{name}` in `{key}` is already defined in {elsewhere}");
                        self.findings.push(Finding::error(message).on(member.key_place));
                    } else if key == "variables" {
                        first.push((at, name, member));
                    } else {
                        own.append(name, member);
                    }
                }
                own.insert_each(first);
            }
            // The including file's value has the wrong type, which the schema check reports.
            _ => {}
        }
    }

    fn file_name(&self, place: Option<SourceSpan>) -> String {
        let source = place.and_then(|place| self.sources.get(place.file));
        source.map_or_else(|| "another file".into(), |source| source.name.clone())
    }
}

/// Parses the main file if the scene includes no other file. Elements of included lists come before
/// those of the main file, so scenes of several files are read as whole trees.
fn parse_without_includes(text: &str) -> Option<(Node, Vec<SyntaxError>)> {
    let parsed = parse_part(text, 0..text.len(), FileId::MAIN, &PathRef::Root).ok()?;
    parsed.0.get("include").is_none().then_some(parsed)
}

pub fn finding(file: FileId, error: SyntaxError) -> Finding {
    let at = |byte: usize| u32::try_from(byte).unwrap_or(u32::MAX);
    let place = SourceSpan { file, start: at(error.at.start), end: at(error.at.end) };
    let finding = Finding::error(error.message).on(Some(place)).maybe_help(error.help);
    match error.path {
        Some(path) => finding.at(&path),
        None => finding,
    }
}

fn explain(path: &Path, why: Unreadable, store: &Store) -> String {
    let shown = path.display();
    match why {
        Unreadable::Io(error) => {
            format!("cannot read `{shown}`: {}{}", plain_io(&error), store.suggestion(path, &error))
        }
        Unreadable::NotText(message) => format!("cannot include `{shown}`: {message}"),
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
