//! Modules of a crate, read from its files: the names that each module defines and imports, and the
//! paths in its code. Tests are left out.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Keywords that define the name after them.
const DEFINING: &[&str] = &["struct", "enum", "union", "trait", "type", "const", "static", "fn"];

/// Keywords of items that end with a semicolon, whatever their braces.
const UNTIL_SEMICOLON: &[&str] = &["use", "const", "static", "type"];

/// Segments of a path, such as `crate`, `plan`, `Target`.
pub type Segments = Vec<String>;

/// A module.
#[derive(Default)]
pub struct Module {
    /// Index of the module that contains it; 0 for the root itself.
    pub parent: usize,
    pub file: PathBuf,
    /// Names of the items that the module defines.
    pub items: Vec<String>,
    /// Indices of the modules that it contains.
    pub children: HashMap<String, usize>,
    /// Imported names with their paths.
    pub imports: HashMap<String, Segments>,
    /// Paths of modules whose names are all imported.
    pub globs: Vec<Segments>,
    /// All paths in the code of the module; a single name is a path, too.
    pub paths: Vec<Segments>,
}

/// Reads all modules of a crate; the first is the root, whose file is given.
pub fn modules(root: &Path) -> Vec<Module> {
    let mut reader = Reader { modules: vec![Module { file: root.to_owned(), ..Module::default() }] };
    let folder = root.parent().unwrap();
    reader.items(0, folder, tokens_of(root));
    reader.modules
}

fn tokens_of(file: &Path) -> TokenStream {
    std::fs::read_to_string(file).unwrap().parse().unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

struct Reader {
    modules: Vec<Module>,
}

impl Reader {
    /// Reads the items of a module whose child modules have their files in `folder`.
    fn items(&mut self, module: usize, folder: &Path, tokens: TokenStream) {
        let mut item = Vec::new();
        for token in tokens {
            let keyword = item.iter().find_map(keyword_of);
            let is_end = match &token {
                TokenTree::Punct(punct) => punct.as_char() == ';',
                TokenTree::Group(group) => {
                    group.delimiter() == Delimiter::Brace
                        && !keyword.is_some_and(|keyword| UNTIL_SEMICOLON.contains(&keyword.as_str()))
                }
                _ => false,
            };
            item.push(token);
            if is_end || is_inner_attribute(&item) {
                self.item(module, folder, &std::mem::take(&mut item));
            }
        }
    }

    fn item(&mut self, module: usize, folder: &Path, item: &[TokenTree]) {
        let (attributes, item) = without_attributes(item);
        if attributes
            .iter()
            .any(|attribute| attribute.starts_with("cfg (test") || attribute.starts_with("cfg (all (test"))
        {
            return;
        }
        match item.iter().find_map(keyword_of).as_deref() {
            Some("use") => self.import(module, item),
            Some("mod") => self.child(module, folder, item),
            Some("impl") => {}
            _ => self.define(module, item),
        }
        self.paths(module, item);
    }

    /// Reads a child module, inline or from its file.
    fn child(&mut self, parent: usize, folder: &Path, item: &[TokenTree]) {
        let name = item.iter().filter_map(ident).skip_while(|word| word != "mod").nth(1).unwrap();
        let child = self.modules.len();
        let inner = folder.join(&name);
        let body = item.iter().find_map(|token| match token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => Some(group.stream()),
            _ => None,
        });
        let own = [folder.join(format!("{name}.rs")), inner.join("mod.rs")].into_iter().find(|file| file.exists());
        let (file, tokens) = match (body, own) {
            (Some(body), _) => (self.modules[parent].file.clone(), body),
            (None, Some(file)) => (file.clone(), tokens_of(&file)),
            // The attribute `path` names the file.
            (None, None) => return,
        };
        self.modules.push(Module { parent, file, ..Module::default() });
        self.modules[parent].children.insert(name, child);
        self.items(child, &inner, tokens);
    }

    /// Records the names that an item defines; those within the braces too if it is a macro's.
    fn define(&mut self, module: usize, item: &[TokenTree]) {
        let words: Vec<String> = item.iter().filter_map(ident).collect();
        let defines = |word: &str| DEFINING.contains(&word) || word == "macro_rules";
        for pair in words.windows(2) {
            if defines(&pair[0]) && !defines(&pair[1]) {
                self.modules[module].items.push(pair[1].clone());
            }
        }
        let is_macro = item.iter().any(|token| is_punct(token, '!'))
            && !words.iter().any(|word| DEFINING.contains(&word.as_str()));
        if let (true, Some(TokenTree::Group(group))) = (is_macro, item.last()) {
            self.define(module, &group.stream().into_iter().collect::<Vec<_>>());
        }
    }

    /// Records a `use` declaration.
    fn import(&mut self, module: usize, item: &[TokenTree]) {
        let start = item.iter().position(|token| ident(token).is_some_and(|word| word == "use")).unwrap();
        let mut leaves = Vec::new();
        use_tree(&item[start + 1..], &mut Vec::new(), &mut leaves);
        for (name, path) in leaves {
            match name.as_str() {
                "*" => self.modules[module].globs.push(path),
                _ => drop(self.modules[module].imports.insert(name, path)),
            }
        }
    }

    /// Records all paths of an item.
    fn paths(&mut self, module: usize, tokens: &[TokenTree]) {
        let mut at = 0;
        while at < tokens.len() {
            if let TokenTree::Group(group) = &tokens[at] {
                self.paths(module, &group.stream().into_iter().collect::<Vec<_>>());
            }
            match ident(&tokens[at]).as_deref() {
                // A declaration within a function.
                Some("use") => {
                    let end =
                        tokens[at..].iter().position(|token| is_punct(token, ';')).map_or(tokens.len(), |end| at + end);
                    self.import(module, &tokens[at..end]);
                    at = end;
                }
                Some(_) if !is_member(&tokens[..at]) => {
                    let path = path(&tokens[at..]);
                    at += 3 * (path.len() - 1);
                    self.modules[module].paths.push(path);
                }
                _ => {}
            }
            at += 1;
        }
    }
}

/// Path at the start of some tokens: an identifier, and further ones after `::`.
fn path(tokens: &[TokenTree]) -> Segments {
    let mut segments: Segments = tokens.first().and_then(ident).into_iter().collect();
    let mut rest = tokens.get(1..).unwrap_or_default();
    while let [first, second, next, ..] = rest
        && is_punct(first, ':')
        && is_punct(second, ':')
        && let Some(word) = ident(next)
    {
        segments.push(word);
        rest = &rest[3..];
    }
    segments
}

/// Whether the tokens before an identifier make it a field, a method or a lifetime.
fn is_member(before: &[TokenTree]) -> bool {
    match before {
        [.., range, dot] if is_punct(dot, '.') => !is_punct(range, '.'),
        [.., last] => is_punct(last, '\''),
        [] => false,
    }
}

/// Names that a `use` declaration makes, with their paths; `*` for all names.
fn use_tree(tokens: &[TokenTree], prefix: &mut Segments, leaves: &mut Vec<(String, Segments)>) {
    for branch in tokens.split(|token| is_punct(token, ',')) {
        let length = prefix.len();
        let mut alias = None;
        let mut words = branch.iter().peekable();
        while let Some(token) = words.next() {
            match token {
                TokenTree::Group(group) => {
                    use_tree(&group.stream().into_iter().collect::<Vec<_>>(), prefix, leaves);
                    prefix.truncate(length);
                    break;
                }
                TokenTree::Ident(word) if word == "as" => alias = words.peek().and_then(|token| ident(token)),
                TokenTree::Ident(word) if alias.is_none() => prefix.push(word.to_string()),
                TokenTree::Punct(punct) if punct.as_char() == '*' => leaves.push(("*".to_owned(), prefix.clone())),
                _ => {}
            }
        }
        let is_glob = branch.iter().any(|token| is_punct(token, '*'));
        if prefix.len() > length && !is_glob {
            if prefix.last().is_some_and(|last| last == "self") {
                prefix.pop();
            }
            let name = alias.or_else(|| prefix.last().cloned());
            leaves.extend(name.map(|name| (name, prefix.clone())));
        }
        prefix.truncate(length);
    }
}

/// Attributes of an item as text, and the item without them.
fn without_attributes(mut item: &[TokenTree]) -> (Vec<String>, &[TokenTree]) {
    let mut attributes = Vec::new();
    while let [hash, TokenTree::Group(group), rest @ ..] = item
        && is_punct(hash, '#')
    {
        attributes.push(group.stream().to_string());
        item = rest;
    }
    (attributes, item)
}

fn is_inner_attribute(item: &[TokenTree]) -> bool {
    matches!(item, [hash, not, TokenTree::Group(_)] if is_punct(hash, '#') && is_punct(not, '!'))
}

/// The keyword of an item, if the token is one.
fn keyword_of(token: &TokenTree) -> Option<String> {
    ident(token).filter(|word| {
        DEFINING.contains(&word.as_str()) || ["use", "mod", "impl", "macro_rules"].contains(&word.as_str())
    })
}

fn ident(token: &TokenTree) -> Option<String> {
    if let TokenTree::Ident(word) = token { Some(word.to_string()) } else { None }
}

fn is_punct(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
}
