//! Names of other programs, such as `box` and `fov`, and their names here. One table, `words.txt`,
//! provides both the suggestions of error reports and the page `docs/names.md`.

use super::rule::Rule;
use super::wording;
use std::sync::LazyLock;

mod page;
#[cfg(test)]
mod tests;

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
    /// Definitions in which the words occur.
    owners: Vec<&'static str>,
    /// The words as their programs spell them.
    words: Vec<&'static str>,
    /// The words in the normalized form of [`plain`].
    plain_words: Vec<String>,
    /// Path of definitions to the name here.
    target: Vec<&'static str>,
    /// Example of the correct form.
    example: &'static str,
    /// Programs that use these words.
    programs: &'static str,
}

impl Entry {
    fn read(line: &'static str, section: &'static str) -> Option<Self> {
        let mut cells = line.split('|').map(str::trim);
        let (place, names) = (cells.next()?, cells.next()?);
        let (target, example, programs) = (cells.next()?, cells.next()?, cells.next()?);
        let (sort, owners) = place.split_once(' ')?;
        let list = |text: &'static str| text.split(',').map(str::trim).collect();
        let (owners, words): (Vec<_>, Vec<&str>) = (list(owners), list(names));
        let plain_words = words.iter().map(|word| plain(word)).collect();
        let target = target.split('.').collect();
        Some(Self { section, is_kind: sort == "kind", owners, words, plain_words, target, example, programs })
    }

    /// Last step of the target: the kind, word or key to write.
    fn name(&self) -> &'static str {
        self.target.last().copied().unwrap_or_default()
    }

    /// All other steps of the target: an owner, perhaps with its kind.
    fn owner(&self) -> String {
        self.target.split_last().map(|(_, owner)| owner.join(".")).unwrap_or_default()
    }

    /// Describes the target independently of the place of the error.
    fn described(&self) -> String {
        match self.target.as_slice() {
            ["scene", key] => format!("`{key}` of the scene"),
            ["object", key] => format!("`{key}` of an object"),
            [family, kind] if is_kind_of(family, kind) => {
                let article = wording::article(kind);
                format!("{article} `{kind}` {}", family.replace('_', " "))
            }
            [owner, key] => format!("`{key}` of `{owner}`"),
            [family, kind, key] => format!("`{key}` of {} `{kind}` {family}", wording::article(kind)),
            _ => String::new(),
        }
    }

    fn help(&self, word: &str, is_here: bool) -> String {
        let what = if is_here { format!("called `{}`", self.name()) } else { self.described() };
        format!("`{word}` is {what} here: write {}", self.example)
    }
}

/// Normalizes a word: lower case, without `_`, `-` and spaces.
fn plain(word: &str) -> String {
    word.chars().filter(|character| !"_- ".contains(*character)).flat_map(char::to_lowercase).collect()
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

/// Suggests the name here of the kind or fixed word `word` of a family.
pub fn suggest_kind(word: &str, family: &Rule) -> Option<String> {
    let entry = kind_entry(word, family)?;
    let is_here = family.name.map(noun) == Some(entry.owner()) && entry.target.len() == 2;
    Some(entry.help(word, is_here))
}

/// The kind of the same family that other programs call `word`.
pub fn kind_name(word: &str, family: &Rule) -> Option<&'static str> {
    let entry = kind_entry(word, family).filter(|entry| entry.target.len() == 2);
    entry.map(Entry::name).filter(|name| family.kinds.iter().any(|(kind, _)| kind == name))
}

fn kind_entry(word: &str, family: &Rule) -> Option<&'static Entry> {
    let noun = family.name.map(noun)?;
    let here = |entry: &&Entry| entry.owners.contains(&noun.as_str());
    // Two families may share a noun: pixel filters and texture filters.
    let known = |name: &str| family.words.contains(&name) || family.kinds.iter().any(|(kind, _)| *kind == name);
    let fits = |entry: &&Entry| entry.owner() != noun || known(entry.name());
    entries(true, word).filter(here).find(fits)
}

/// Suggests the name here of the key `word` of an object.
pub fn suggest_key(word: &str, rule: &Rule) -> Option<String> {
    let entries: Vec<&Entry> = entries(false, word).collect();
    let owners = if entries.is_empty() { Vec::new() } else { owners(rule) };
    owners.iter().find_map(|owner| {
        let here = entries.iter().filter(|entry| entry.owners.contains(&owner.as_str()));
        here.into_iter().find_map(|entry| key_help(word, entry, rule, &owners))
    })
}

fn key_help(word: &str, entry: &Entry, rule: &Rule, owners: &[String]) -> Option<String> {
    let is_owner = owners.contains(&entry.owner());
    let has_field = rule.fields.iter().flatten().any(|(name, _)| *name == entry.name());
    // A key that only other kinds of the family have is no useful suggestion.
    let family_only = entry.target.len() == 2 && is_owner && !has_field;
    (!family_only).then(|| entry.help(word, is_owner && has_field))
}
