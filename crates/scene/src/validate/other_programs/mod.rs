//! Names of other programs, such as `box` and `fov`, and their names here. One table, `words.txt`,
//! provides both the suggestions of error reports and the page `docs/names.md`.

use super::rule::Rule;
use super::wording;
use crate::document::{FileId, Node, parse};
use example::{Example, plain};
use std::sync::LazyLock;

mod example;
mod json_line;
mod outside;
mod page;
mod several;
#[cfg(test)]
mod tests;

pub use example::{MAX_VALUE, Written};
pub use json_line::{json_line, shown};
pub use page::page;

/// Text of the table.
const TABLE: &str = include_str!("words.txt");

/// Parsed lines of the table.
static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    let mut section = "";
    let mut entries = Vec::new();
    for line in TABLE.lines() {
        match line.strip_prefix("## ") {
            Some(title) => section = title,
            None if !line.starts_with('#') => entries.extend(Entry::read(line, section)),
            None => {}
        }
    }
    entries
});

/// A line of the table.
#[derive(Debug)]
struct Entry {
    /// Heading above the line.
    section: &'static str,
    /// Whether the words are kinds or other fixed words; otherwise they are keys.
    is_kind: bool,
    /// Whether the words are keys that are read as the target's, with a warning.
    is_alias: bool,
    /// Definitions in which the words occur.
    owners: Vec<&'static str>,
    /// The words as their programs spell them.
    words: Vec<&'static str>,
    /// The words in the normalized form of [`plain`].
    plain_words: Vec<String>,
    /// Path of definitions to the name here.
    target: Vec<&'static str>,
    /// Example of the correct form.
    example: Example,
    /// Programs that use these words.
    programs: &'static str,
    /// Explanation of the value, such as its unit; empty for most.
    note: &'static str,
}

impl Entry {
    fn read(line: &'static str, section: &'static str) -> Option<Self> {
        let mut cells = line.split('|').map(str::trim);
        let (place, names) = (cells.next()?, cells.next()?);
        let (target, example, programs) = (cells.next()?, Example::read(cells.next()?)?, cells.next()?);
        let note = cells.next().unwrap_or_default();
        let (sort, owners) = place.split_once(' ')?;
        let list = |text: &'static str| text.split(',').map(str::trim).collect();
        let (owners, words): (Vec<_>, Vec<&str>) = (list(owners), list(names));
        let plain_words = words.iter().map(|word| plain(word)).collect();
        let target = target.split('.').collect();
        let (is_kind, is_alias) = (sort == "kind", sort == "alias");
        Some(Self { section, is_kind, is_alias, owners, words, plain_words, target, example, programs, note })
    }

    /// Last step of the target: the kind, word or keys to write.
    fn names(&self) -> impl Iterator<Item = &'static str> + Clone {
        self.target.last().copied().unwrap_or_default().split('+')
    }

    /// The kind, word or first key to write.
    fn name(&self) -> &'static str {
        self.names().next().unwrap_or_default()
    }

    /// All other steps of the target: an owner, perhaps with its kind.
    fn owner(&self) -> String {
        self.target.split_last().map(|(_, owner)| owner.join(".")).unwrap_or_default()
    }

    /// Describes the target independently of the place of the error.
    fn described(&self) -> String {
        let names = wording::list(self.names(), "and");
        match self.target.as_slice() {
            ["scene", _] => format!("{names} of the scene"),
            ["object", _] => format!("{names} of an object"),
            [family, kind] if is_kind_of(family, kind) => {
                let article = wording::article(kind);
                format!("{article} {names} {}", family.replace('_', " "))
            }
            [owner, _] => format!("{names} of `{owner}`"),
            [family, kind, _] => format!("{names} of {} `{kind}` {family}", wording::article(kind)),
            _ => String::new(),
        }
    }

    /// The example with the value that the user wrote.
    fn advice(&self, written: Option<Written<'_>>) -> String {
        self.example.advice(written, |text| self.is_right(text))
    }

    /// Help for a word, with the value that the user wrote.
    fn help(&self, word: &str, is_here: bool, written: Option<Written<'_>>) -> String {
        self.help_with(word, is_here, &self.advice(written))
    }

    /// Help for a word, with an example.
    fn help_with(&self, word: &str, is_here: bool, example: &str) -> String {
        let what = match self.names().count() {
            1 if is_here => format!("called `{}`", self.name()),
            _ if is_here => wording::list(self.names(), "and"),
            _ => self.described(),
        };
        format!("`{word}` is {what} here: write {example}{}", self.note_in_parentheses())
    }

    fn note_in_parentheses(&self) -> String {
        if self.note.is_empty() { String::new() } else { format!(" ({})", self.note) }
    }

    /// Whether the example can carry the value that the user wrote.
    fn carries(&self, written: Option<Written<'_>>) -> bool {
        written.is_some_and(|written| self.example.converted(written, |text| self.is_right(text)).is_some())
    }

    /// Whether a text is valid where the example is.
    fn is_right(&self, text: &str) -> bool {
        let nodes = [text.to_owned(), format!("{{{text}}}")].map(|text| parse(&text, FileId::MAIN));
        let nodes: Vec<Node> = nodes.into_iter().filter_map(|parsed| Some(parsed.ok()?.0)).collect();
        self.rules().iter().any(|rule| nodes.iter().any(|node| is_valid_excerpt(node, rule)))
    }

    /// Rules of the places where the words or the target occur.
    fn rules(&self) -> Vec<&'static Rule> {
        let owners = self.owners.iter().flat_map(|owner| owner.split('.'));
        let nouns = self.target.iter().copied().chain(owners).chain(["object", "scene", "render"]);
        nouns.flat_map(named).flat_map(|rule| [vec![rule], contents(rule)].concat()).collect()
    }
}

/// Rules with this noun in the table.
fn named(owner: &str) -> Vec<&'static Rule> {
    if owner == "scene" {
        return Rule::root().into_iter().collect();
    }
    Rule::all().iter().filter(|rule| rule.name.is_some_and(|name| noun(name) == owner)).collect()
}

/// Rules of the kinds of a family, or the rule of an object itself.
fn contents(rule: &'static Rule) -> Vec<&'static Rule> {
    let kinds: Vec<_> = rule.kinds.iter().map(|(_, content)| content.get()).collect();
    if kinds.is_empty() { vec![rule] } else { kinds }
}

/// Whether a value is valid by a rule, except for undefined names and missing keys beside it, since
/// examples are excerpts.
pub fn is_valid_excerpt(node: &Node, rule: &'static Rule) -> bool {
    let of_excerpts = ["is called", "missing here", "exactly one of"];
    super::is_valid(node, rule, |finding| of_excerpts.iter().any(|words| finding.message_contains(words)))
}

/// Name of a definition in the table.
fn noun(name: &str) -> String {
    wording::noun(name).replace(' ', "_")
}

fn is_kind_of(family: &str, kind: &str) -> bool {
    let families = Rule::all().iter().filter(|rule| rule.name.is_some_and(|name| noun(name) == family));
    families.into_iter().any(|rule| rule.kinds.iter().any(|(name, _)| *name == kind))
}

/// Names of an object in the table, most specific first: `texture.mix`, `mix`, `texture`.
fn owners(rule: &Rule) -> Vec<String> {
    let mut owners = Vec::new();
    let mut families = Vec::new();
    for family in Rule::all() {
        let Some(name) = family.name.filter(|_| !family.kinds.is_empty()).map(noun) else { continue };
        let own = family.kinds.iter().filter(|(_, content)| std::ptr::eq(content.get(), rule));
        for (kind, _) in own {
            owners.extend([format!("{name}.{kind}"), (*kind).to_owned()]);
            families.push(name.clone());
        }
    }
    let is_root = Rule::root().is_some_and(|root| std::ptr::eq(root, rule));
    owners.extend(if is_root { Some("scene".to_owned()) } else { rule.name.map(noun) });
    owners.append(&mut families);
    owners
}

fn entries(is_kind: bool, word: &str) -> impl Iterator<Item = &'static Entry> {
    let word = plain(word);
    ENTRIES.iter().filter(move |entry| entry.is_kind == is_kind && entry.plain_words.contains(&word))
}

/// Suggests the name here of the kind or fixed word `word` of a family. `written` is its value.
pub fn suggest_kind(word: &str, family: &Rule, written: Option<Written<'_>>) -> Option<String> {
    let Some(entry) = kind_entry(word, family) else { return family.missing_kind(word) };
    let is_here = family.name.map(noun) == Some(entry.owner()) && entry.target.len() == 2;
    Some(entry.help(word, is_here, written))
}

/// The kind of the same family that other programs call `word`.
pub fn kind_name(word: &str, family: &Rule) -> Option<&'static str> {
    let entry = kind_entry(word, family).filter(|entry| entry.target.len() == 2);
    entry.map(Entry::name).filter(|name| family.kinds.iter().any(|(kind, _)| kind == name))
}

/// Note in parentheses about the kind that other programs call `word`; empty for most.
pub fn kind_note(word: &str, family: &Rule) -> String {
    kind_entry(word, family).map(Entry::note_in_parentheses).unwrap_or_default()
}

fn kind_entry(word: &str, family: &Rule) -> Option<&'static Entry> {
    let noun = family.name.map(noun)?;
    let here = |entry: &&Entry| entry.owners.contains(&noun.as_str());
    // Two families may share a noun: pixel filters and texture filters.
    let known = |name: &str| family.words.contains(&name) || family.kinds.iter().any(|(kind, _)| *kind == name);
    let fits = |entry: &&Entry| entry.owner() != noun || known(entry.name());
    entries(true, word).filter(here).find(fits)
}

/// Suggests the name here of the key `word` of an object. `written` is its value. Of several
/// entries, the first one that can carry the value counts, or else the first one.
pub fn suggest_key(word: &str, rule: &'static Rule, written: Option<Written<'_>>) -> Option<String> {
    let entries: Vec<&Entry> = entries(false, word).collect();
    let owners = if entries.is_empty() { Vec::new() } else { owners(rule) };
    let of_owner = owners.iter().flat_map(|owner| entries.iter().filter(move |entry| entry.owners.contains(&&**owner)));
    let useful: Vec<&Entry> = of_owner.copied().filter(|entry| is_useful(entry, rule, &owners)).collect();
    let entry = useful.iter().find(|entry| entry.carries(written)).or_else(|| useful.first())?;
    let is_here = owners.contains(&entry.owner()) && has_field(rule, entry.name());
    let example = written.and_then(|written| entry.whole_example(rule, &owners, written));
    let example = example.unwrap_or_else(|| entry.advice(written));
    Some(entry.help_with(word, is_here, &example))
}

/// The key that the unknown key `word` of an object is read as; `None` for most words.
pub fn aliased_key(word: &str, rule: &Rule) -> Option<&'static str> {
    let aliases: Vec<&Entry> = entries(false, word).filter(|entry| entry.is_alias).collect();
    let owners = if aliases.is_empty() { Vec::new() } else { owners(rule) };
    let is_here = |entry: &&&Entry| entry.owners.iter().any(|owner| owners.iter().any(|own| own == owner));
    aliases.iter().find(is_here).map(|entry| entry.name()).filter(|name| has_field(rule, name))
}

/// Whether a suggestion helps: a key that only other kinds of the family have does not.
fn is_useful(entry: &Entry, rule: &Rule, owners: &[String]) -> bool {
    let family_only = entry.target.len() == 2 && owners.contains(&entry.owner()) && !has_field(rule, entry.name());
    !family_only
}

fn has_field(rule: &Rule, key: &str) -> bool {
    rule.fields.iter().flatten().any(|(name, _)| *name == key)
}
