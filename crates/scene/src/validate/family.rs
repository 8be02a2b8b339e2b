//! Checks of families: `{"sphere": {...}}`, or `"sphere"` if all fields have defaults; and of fixed
//! words.

use super::other_programs::{self, Written};
use super::rule::Rule;
use super::{Plain, Validator, wording};
use crate::document::{Members, Node, Value as NodeValue};
use crate::path::PathRef;
use crate::report::Finding;
use crate::suggest::did_you_mean_or_list;

/// Maximum number of keys in the suggested form of an object.
const MAX_SHOWN: usize = 8;

impl Validator<'_> {
    pub(super) fn family(&mut self, node: &Node, at: &PathRef<'_>, family: &'static Rule) -> Option<Plain> {
        match &node.value {
            NodeValue::Object(members) if !family.kinds.is_empty() => self.kind(node, at, members, family),
            NodeValue::String(text) => self.word(node, at, text, family),
            _ => {
                let noun = noun(family);
                let example = family.kinds.first().map(|(kind, _)| format!(" such as {{\"{kind}\": ...}}"));
                let words = || format!(": {}", wording::list(family.words.iter().copied(), "or"));
                let example = example.unwrap_or_else(words);
                self.mismatch(node, at, family, &format!("{} {noun}{example}", wording::article(&noun)))
            }
        }
    }

    fn kind(&mut self, node: &Node, at: &PathRef<'_>, members: &Members, family: &'static Rule) -> Option<Plain> {
        let mut entries = members.iter();
        let (Some((key, member)), None) = (entries.next(), entries.next()) else {
            return self.not_one_kind(node, at, members, family);
        };
        let Some((kind, content)) = family.kinds.iter().find(|(kind, _)| kind == key) else {
            let finding = Finding::error(format!("unknown kind of {} `{key}`", noun(family))).on(member.key_place);
            let written = Written { value: &member.node, siblings: None };
            let other = || other_programs::suggest_kind(key, family, Some(written));
            let help = self.suggestion(|| other().or_else(|| did_you_mean_or_list(key, kinds(family))));
            self.findings.push(finding.maybe_help(help).at(&at.key(key)));
            return None;
        };
        let value = self.value(&member.node, &at.key(key), content.get())?;
        Some(Plain::member(*kind, value))
    }

    /// Reports an object with no key or several keys in place of the name of one kind.
    fn not_one_kind<T>(
        &mut self,
        node: &Node,
        at: &PathRef<'_>,
        members: &Members,
        family: &'static Rule,
    ) -> Option<T> {
        let (noun, kinds) = (noun(family), kinds(family).collect::<Vec<_>>());
        let mut named = members.keys().filter(|key| kinds.contains(&key.as_str()));
        let a = wording::article(&noun);
        if let (Some(kind), None) = (named.next(), named.next()) {
            let others = wording::list(members.keys().filter(|key| *key != kind).map(String::as_str), "and");
            let message = format!("unexpected {others} beside `{kind}`: {a} {noun} has exactly one kind");
            let help = format!("write settings of the {noun} inside {{\"{kind}\": {{...}}}}, all other keys outside");
            return self.report(node, at, Finding::error(message).help(help));
        }
        let found =
            if members.is_empty() { "none".into() } else { wording::list(members.keys().map(String::as_str), "and") };
        let message = format!("{a} {noun} must have exactly one kind, found {found}");
        let several = members.len() > 1 && members.keys().all(|key| kinds.contains(&key.as_str()));
        let is_step = family.name == Some("TransformStep");
        let other = || {
            if several && is_step {
                "write an array of steps, [{...}, {...}], applied in order".into()
            } else if several {
                "choose one".into()
            } else {
                format!("kinds: {}", wording::list(kinds, "and"))
            }
        };
        let help = self.suggestion(|| tagged(node, members, family)).unwrap_or_else(other);
        self.report(node, at, Finding::error(message).help(help))
    }

    /// Checks a kind given by its name alone, or a fixed word.
    fn word(&mut self, node: &Node, at: &PathRef<'_>, text: &str, family: &'static Rule) -> Option<Plain> {
        if family.words.contains(&text) {
            return Some(Plain::String(text.to_owned()));
        }
        match family.kinds.iter().find(|(kind, _)| *kind == text) {
            Some((kind, content)) if content.types.object && content.required.is_empty() => {
                Some(Plain::member(*kind, Plain::Object(Vec::new())))
            }
            Some((kind, content)) => {
                let needed = wording::list(content.required.iter().copied(), "and");
                let needed = if needed.is_empty() { "a value" } else { &needed };
                let message = format!("the {} `{kind}` needs {needed}", noun(family));
                self.report(node, at, Finding::error(message).help(format!("write {{\"{kind}\": {{...}}}}")))
            }
            None => {
                let known: Vec<&str> = kinds(family).chain(family.words.iter().copied()).collect();
                let what = if family.words.is_empty() { "kind of " } else { "" };
                let finding = Finding::error(format!("unknown {what}{} `{text}`", noun(family)));
                let other = || other_programs::suggest_kind(text, family, None);
                let other = || other().or_else(|| family.rewritten(node, at));
                let help = self.suggestion(|| other().or_else(|| did_you_mean_or_list(text, known.iter().copied())));
                self.report(node, at, finding.maybe_help(help))
            }
        }
    }
}

/// Suggests the correct form of `{"type": "diffuse", "reflectance": 0.5}`: the kind as a key, with
/// the other keys inside.
fn tagged(node: &Node, members: &Members, family: &Rule) -> Option<String> {
    let tag = members.get("type")?.node.as_str()?;
    let known = kinds(family).find(|kind| *kind == tag);
    let Some(kind) = known.or_else(|| other_programs::kind_name(tag, family)) else {
        let all =
            || format!("kinds are written as keys, {{\"KIND\": {{...}}}}: {}", wording::list(kinds(family), "and"));
        let written = Written { value: node, siblings: None };
        return Some(other_programs::suggest_kind(tag, family, Some(written)).unwrap_or_else(all));
    };
    let inside = members.keys().filter(|key| *key != "type").take(MAX_SHOWN).map(|key| format!("\"{key}\": ..."));
    let inside = inside.collect::<Vec<_>>().join(", ");
    let note = if tag == kind { String::new() } else { other_programs::kind_note(tag, family) };
    Some(format!("write {{\"{kind}\": {{{inside}}}}} instead of \"type\": \"{tag}\"{note}"))
}

fn noun(family: &Rule) -> String {
    wording::noun(family.name.unwrap_or("kind"))
}

fn kinds(family: &Rule) -> impl Iterator<Item = &'static str> + Clone {
    family.kinds.iter().map(|(kind, _)| *kind)
}
