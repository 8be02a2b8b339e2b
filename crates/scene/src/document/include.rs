//! Several files into one tree: `"include": ["materials.json"]`.
//!
//! What an included file holds under [`MAPS`] and [`LISTS`] joins what the including file holds; the rest of it
//! (camera of its own, size, title) is left aside, so that a whole scene can serve as a library. A file that is
//! named twice comes in once.

use super::chunks::{self, LongList};
use super::guard::{self, Refused};
use super::source::{FileId, Place, Sources};
use super::tree::{Member, Node, Value};
use super::{Unreadable, parse, parse_part};
use crate::path::Trail;
use crate::report::{Finding, plain_io};
use crate::schema::Schema;
use crate::store::Store;
use crate::validate::meant_in_scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Named things: one of each name. Variables of included files come first, as later ones may use them.
const MAPS: [&str; 6] = ["variables", "paths", "cameras", "textures", "materials", "groups"];
/// Things in order: those of included files come first.
const LISTS: [&str; 2] = ["lights", "objects"];
/// Most files of one scene.
pub const MAX_FILES: usize = 1000;
/// Longest chain of files that include each other.
const MAX_CHAIN: usize = 32;

/// Reads a scene's files.
pub struct Reader<'s> {
    store: &'s Store,
    sources: Sources,
    findings: Vec<Finding>,
    /// Every file that came in, in its one true name.
    seen: Vec<PathBuf>,
    /// The files that are being read, each included by the one before.
    open: Vec<PathBuf>,
    complete: bool,
}

impl<'s> Reader<'s> {
    /// For the scene in this file; the others come from `store`.
    pub fn new(main: &Path, store: &'s Store) -> Self {
        let main = store.true_name(main);
        Self {
            store,
            sources: Sources::default(),
            findings: Vec::new(),
            seen: vec![main.clone()],
            open: vec![main],
            complete: true,
        }
    }

    /// The merged tree of the main file, as far as there is one, and its long lists, which are left out of the tree.
    pub fn main(&mut self, name: &str, text: String) -> Option<(Node, Vec<LongList>)> {
        let split = chunks::split(&text).filter(|_| guard::check(&text).is_ok());
        let parsed = split.and_then(|(rest, lists)| Some((alone(&rest)?, lists)));
        match parsed {
            Some((parsed, lists)) => {
                let id = self.sources.add(name, text);
                Some((self.merged(id, Ok(parsed))?, lists))
            }
            None => Some((self.file(name, text)?, Vec::new())),
        }
    }

    /// What was read, and all that was wrong with it.
    ///
    /// The last tells whether every file could be read; without one of them, names would be missing everywhere.
    pub fn finish(self) -> (Sources, Vec<Finding>, bool) {
        (self.sources, self.findings, self.complete)
    }

    fn file(&mut self, name: &str, text: String) -> Option<Node> {
        let id = self.sources.add(name, text);
        let text = self.sources.get(id).map(|source| source.text.as_str()).unwrap_or_default();
        let parsed = parse(text, id);
        self.merged(id, parsed)
    }

    /// The tree of a file, what it includes merged.
    fn merged(&mut self, id: FileId, parsed: Result<(Node, Vec<Refused>), Refused>) -> Option<Node> {
        let mut tree = match parsed {
            Ok((tree, refused)) => {
                self.findings.extend(refused.into_iter().map(|refused| finding(id, refused)));
                tree
            }
            Err(refused) => {
                self.findings.push(finding(id, refused));
                self.complete = false;
                return None;
            }
        };
        let Value::Object(members) = &mut tree.value else {
            let message = format!("a scene is an object `{{...}}`, this is {}", tree.kind());
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

    /// Checks that `$schema`, which tells editors where the scene format's schema is, holds an address.
    fn check_schema(&mut self, schema: &Node) {
        if schema.as_str().is_none() {
            let message = format!("expected the address of the scene format's JSON Schema, found {}", schema.kind());
            self.findings.push(Finding::error(message).on(schema.place));
        }
    }

    /// The strings of `include`: one, or an array of them.
    fn names(&mut self, include: &Node) -> Vec<(String, Option<Place>)> {
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

    fn included(&mut self, (name, place): (String, Option<Place>), by: FileId) -> Option<Node> {
        let folder = self.sources.get(by).map(|source| source.folder.clone()).unwrap_or_default();
        let path = folder.join(&name);
        let identity = self.store.true_name(&path);
        let problem = if let Some(at) = self.open.iter().position(|open| *open == identity) {
            let chain: Vec<_> = self.open.iter().skip(at).chain([&identity]).map(|p| file_name(p)).collect();
            Some(format!("files include each other in a circle: {}", chain.join(" → ")))
        } else if self.seen.contains(&identity) {
            return None;
        } else if self.open.len() > MAX_CHAIN {
            Some(format!("more than {MAX_CHAIN} files include one another"))
        } else if self.seen.len() > MAX_FILES {
            Some(format!("a scene has at most {MAX_FILES} files"))
        } else {
            None
        };
        let text = match problem.map_or_else(|| self.store.text(&path).map_err(|why| explain(&path, why)), Err) {
            Ok(text) => text,
            Err(message) => {
                self.findings.push(Finding::error(message).on(place));
                self.complete = false;
                return None;
            }
        };
        self.seen.push(identity.clone());
        self.open.push(identity);
        let tree = self.file(&path.to_string_lossy(), text);
        self.open.pop();
        tree.iter().for_each(|tree| self.check_keys(tree));
        tree
    }

    /// What is not merged must still be something that a scene file can hold.
    fn check_keys(&mut self, tree: &Node) {
        let known = Schema::get().root().get("properties").and_then(serde_json::Value::as_object);
        let known: Vec<&str> = known.into_iter().flat_map(|known| known.keys()).map(String::as_str).collect();
        for (key, member) in tree.members().filter(|(key, _)| !known.contains(&key.as_str())) {
            let finding = Finding::error(format!("`{key}` is not known here")).on(member.key_place);
            self.findings.push(finding.maybe_help(meant_in_scene(key)));
        }
        if let Some(version) =
            tree.get("version").filter(|version| !matches!(&version.value, Value::Number(n) if n.as_f64() == Some(1.0)))
        {
            let message = "this program reads version 1 of the format, this file is of another";
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
                        let message = format!("`{name}` in `{key}` has been defined before, in {elsewhere}");
                        self.findings.push(Finding::error(message).on(member.key_place));
                    } else if key == "variables" {
                        first.push((at, name, member));
                    } else {
                        own.append(name, member);
                    }
                }
                own.insert_each(first);
            }
            // The including file's value has the wrong type: the schema will say so.
            _ => {}
        }
    }

    fn file_name(&self, place: Option<Place>) -> String {
        let source = place.and_then(|place| self.sources.get(place.file));
        source.map_or_else(|| "another file".into(), |source| source.name.clone())
    }
}

/// Tree of the main file, if the scene includes no other file. Elements of included lists come
/// before those of the main file, so scenes of several files are read as trees.
fn alone(text: &str) -> Option<(Node, Vec<Refused>)> {
    let parsed = parse_part(text, 0..text.len(), FileId::MAIN, &Trail::Root).ok()?;
    parsed.0.get("include").is_none().then_some(parsed)
}

pub fn finding(file: FileId, refused: Refused) -> Finding {
    let at = |byte: usize| u32::try_from(byte).unwrap_or(u32::MAX);
    let place = Place { file, start: at(refused.at.start), end: at(refused.at.end) };
    let finding = Finding::error(refused.message).on(Some(place)).maybe_help(refused.help);
    match refused.path {
        Some(path) => finding.at(&path),
        None => finding,
    }
}

fn explain(path: &Path, why: Unreadable) -> String {
    let shown = path.display();
    match why {
        Unreadable::Io(error) => format!("cannot read `{shown}`: {}", plain_io(&error)),
        Unreadable::NotText(message) => format!("cannot include `{shown}`: {message}"),
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
