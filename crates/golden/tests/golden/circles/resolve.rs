//! Dependencies of files: names and paths resolved, through re-exports, to the file that defines
//! them.

use super::source::Module;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::PathBuf;

/// Meaning of a path within a crate.
#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    /// An item of this module, or a name within it.
    Item(usize),
    Module(usize),
}

/// The files that each file of a crate uses.
pub fn dependencies(modules: &[Module]) -> BTreeMap<PathBuf, BTreeSet<PathBuf>> {
    let mut resolver = Resolver { modules, known: HashMap::new() };
    let mut files: BTreeMap<PathBuf, BTreeSet<PathBuf>> = BTreeMap::new();
    for (number, module) in modules.iter().enumerate() {
        let uses = files.entry(module.file.clone()).or_default();
        for path in module.imports.values().chain(&module.paths) {
            let Some(Meaning::Item(definer)) = resolver.path(number, path) else { continue };
            if modules[definer].file != module.file {
                uses.insert(modules[definer].file.clone());
            }
        }
    }
    files
}

struct Resolver<'m> {
    modules: &'m [Module],
    /// Meaning of a name in a module as the last segment of a path or not; `None` also while it is
    /// looked up, which ends circles of re-exports.
    known: HashMap<(usize, String, bool), Option<Meaning>>,
}

impl Resolver<'_> {
    /// Meaning of a path in a module; `None` for names of other crates and local variables.
    fn path(&mut self, from: usize, path: &[String]) -> Option<Meaning> {
        let (mut at, mut rest) = (from, path);
        while let [first, after @ ..] = rest {
            at = match first.as_str() {
                "crate" => 0,
                "self" => at,
                "super" => self.modules[at].parent,
                _ => break,
            };
            rest = after;
        }
        while let [name, after @ ..] = rest {
            match self.name(at, name, after.is_empty())? {
                Meaning::Module(module) => at = module,
                item @ Meaning::Item(_) => return Some(item),
            }
            rest = after;
        }
        Some(Meaning::Module(at))
    }

    /// Meaning of a name in a module. A module and another item may have one name: the last segment
    /// of a path names the item.
    fn name(&mut self, at: usize, name: &str, is_last: bool) -> Option<Meaning> {
        let key = (at, name.to_owned(), is_last);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        self.known.insert(key.clone(), None);
        let module = &self.modules[at];
        let item = module.items.iter().any(|item| item == name).then_some(Meaning::Item(at));
        let child = module.children.get(name).map(|child| Meaning::Module(*child));
        let found = match child {
            Some(_) if !is_last => child,
            _ => item
                .or_else(|| module.imports.get(name).and_then(|path| self.path(at, path)))
                .or_else(|| module.globs.iter().find_map(|path| self.in_glob(at, path, name, is_last)))
                .or(child),
        };
        self.known.insert(key, found);
        found
    }

    /// Meaning of a name in the module that `path` names.
    fn in_glob(&mut self, from: usize, path: &[String], name: &str, is_last: bool) -> Option<Meaning> {
        match self.path(from, path)? {
            Meaning::Module(other) => self.name(other, name, is_last),
            Meaning::Item(_) => None,
        }
    }
}

/// Groups of files that use each other in circles, in the order of their names.
pub fn circles(files: &BTreeMap<PathBuf, BTreeSet<PathBuf>>) -> Vec<Vec<PathBuf>> {
    let reach = |start: &PathBuf| {
        let (mut reached, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(file) = open.pop() {
            for next in files.get(file).into_iter().flatten() {
                if reached.insert(next.clone()) {
                    open.push(next);
                }
            }
        }
        reached
    };
    let reached: BTreeMap<&PathBuf, BTreeSet<PathBuf>> = files.keys().map(|file| (file, reach(file))).collect();
    let mut groups: Vec<Vec<PathBuf>> = Vec::new();
    for (file, after) in &reached {
        if !after.contains(*file) || groups.iter().any(|group| group.contains(file)) {
            continue;
        }
        let meets = |other: &&PathBuf| reached.get(other).is_some_and(|back| back.contains(*file));
        groups.push(after.iter().filter(meets).cloned().collect());
    }
    groups
}
