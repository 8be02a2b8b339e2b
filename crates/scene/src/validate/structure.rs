//! Checks of arrays and objects.

use super::other_programs::{self, Written};
use super::rule::{Rule, RuleId};
use super::{MAX_FINDINGS, MAX_WARNINGS, Plain, Validator, wording};
use crate::document::{Member, Members, Node};
use crate::path::PathRef;
use crate::report::Finding;
use crate::suggest::did_you_mean_or_list;
use std::borrow::Cow;

/// Objects that are kept when one of their members is invalid, so that the others can still be
/// checked. Members of all other objects (such as cameras and shapes) depend on each other.
const INDEPENDENT: [&str; 2] = ["Object", "Render"];

impl Validator<'_> {
    pub(super) fn array(
        &mut self,
        node: &Node,
        at: &PathRef<'_>,
        elements: &[Node],
        rule: &'static Rule,
    ) -> Option<Plain> {
        let found = elements.len();
        let expected = match rule.length {
            (Some(least), Some(most)) if least == most && found != least => Some(least.to_string()),
            (Some(least), _) if found < least => Some(format!("at least {least}")),
            (_, Some(most)) if found > most => Some(format!("at most {most}")),
            _ => None,
        };
        if let Some(expected) = expected {
            let what = wording::elements(self.schema, rule.schema);
            let message = format!("expected {expected} {what} in this array, found {found}");
            return self.report(node, at, Finding::error(message));
        }
        let items = rule.items?.get();
        let mut values = Vec::with_capacity(found);
        for (i, element) in elements.iter().enumerate() {
            if self.findings.len() >= MAX_FINDINGS {
                return None;
            }
            values.push(self.value(element, &at.index(i), items));
        }
        values.into_iter().collect::<Option<Vec<Plain>>>().map(Plain::Array)
    }

    pub(super) fn object(
        &mut self,
        node: &Node,
        at: &PathRef<'_>,
        members: &Members,
        rule: &'static Rule,
    ) -> Option<Plain> {
        let root = at.is_root();
        let is_loose = root || rule.name.is_some_and(|name| INDEPENDENT.contains(&name)) || rule.fields.is_none();
        let mut json = Vec::with_capacity(members.len());
        let mut is_valid = true;
        for (key, member) in members.iter() {
            if self.findings.len() >= MAX_FINDINGS {
                return None;
            }
            let known = rule.member(key).or_else(|| self.aliased(key, member, members, rule, at));
            // Of two names for one key, the second is an error.
            let known = known.filter(|(name, _)| name == key || json.iter().all(|(other, _)| other != name));
            let Some((name, field)) = known else {
                let written = Written { value: &member.node, siblings: Some(members) };
                let finding = self.unknown_key(key, written, rule, at).on(member.key_place);
                self.findings.push(finding.at(&at.key(key)));
                is_valid = false;
                continue;
            };
            match self.value(&member.node, &at.key(key), field.get()) {
                Some(value) => json.push((name, value)),
                None => is_valid = false,
            }
        }
        let complete = self.required(node, at, members, rule);
        self.exactly_one(node, at, members, rule);
        if root && !json.iter().any(|(key, _)| key == "version") {
            json.push(("version".into(), Plain::Number(1.into())));
        }
        ((complete || root) && (is_valid || is_loose)).then_some(Plain::Object(json))
    }

    /// Checks that all required keys are present.
    fn required(&mut self, node: &Node, at: &PathRef<'_>, members: &Members, rule: &'static Rule) -> bool {
        let missing: Vec<&str> = rule.required.iter().copied().filter(|key| !members.contains_key(key)).collect();
        if missing.is_empty() {
            return true;
        }
        let verb = if missing.len() == 1 { "is" } else { "are" };
        let mut finding =
            Finding::error(format!("{} {verb} missing here", wording::list(missing.iter().copied(), "and")));
        if missing == ["version"] {
            finding = finding.help("a scene file begins with {\"version\": 1, ...");
        }
        self.report::<()>(node, at, finding).is_some()
    }

    /// Reports an error unless exactly one of some keys is present.
    fn exactly_one(&mut self, node: &Node, at: &PathRef<'_>, members: &Members, rule: &'static Rule) {
        let keys = rule.exactly_one.iter().copied();
        let found = keys.clone().filter(|key| members.contains_key(key));
        let count = found.clone().count();
        if rule.exactly_one.is_empty() || count == 1 {
            return;
        }
        let found = if count == 0 { "none".into() } else { wording::list(found, "and") };
        let message = format!("exactly one of {} is required, found {found}", wording::list(keys, "and"));
        // A misspelled key has its own message.
        let misspelt = members.keys().any(|key| rule.field(key).is_none());
        let help = match found.as_str() {
            "none" if misspelt => return,
            "none" => "write, for example, \"shape\": \"sphere\"",
            _ => "write several objects, one for each",
        };
        self.report::<()>(node, at, Finding::error(message).help(help));
    }

    /// Reads another program's key as the key here, with a warning, unless both are given.
    fn aliased(
        &mut self,
        key: &str,
        member: &Member,
        members: &Members,
        rule: &'static Rule,
        at: &PathRef<'_>,
    ) -> Option<(Cow<'static, str>, RuleId)> {
        let name = other_programs::aliased_key(key, rule).filter(|name| !members.contains_key(name))?;
        if self.warnings.len() < MAX_WARNINGS {
            let warning = Finding::warning(format!("`{key}` is read as `{name}`, its name here"));
            self.warnings.push(warning.help(format!("write \"{name}\"")).at(&at.key(key)).on(member.key_place));
        }
        rule.member(name)
    }

    fn unknown_key(&mut self, key: &str, written: Written<'_>, rule: &'static Rule, at: &PathRef<'_>) -> Finding {
        let has_settings = rule.fields.iter().flatten().next().is_some();
        if let (false, Some(owner)) = (has_settings, at.last_key()) {
            let other = self.suggestion(|| other_programs::suggest_key(key, rule, Some(written)));
            let help = other.unwrap_or_else(|| format!("write \"{owner}\": {{}}"));
            return Finding::error(format!("`{owner}` has no settings, so `{key}` is not allowed")).help(help);
        }
        let help = self.suggestion(|| {
            let tagged = written.value.as_str().filter(|_| key == "type").and_then(|kind| parent_key(kind, rule));
            let flag = || rule.flag_for(key);
            tagged.or_else(flag).or_else(|| suggest_key(key, rule, written))
        });
        Finding::error(format!("unknown key `{key}`")).maybe_help(help)
    }
}

/// Suggests a replacement for an unknown key: the key that takes a kind of this name, the name here
/// of another program's word, or a similar known key.
pub(super) fn suggest_key(key: &str, rule: &'static Rule, written: Written<'_>) -> Option<String> {
    let known: Vec<&str> = rule.fields.iter().flatten().map(|(name, _)| *name).collect();
    let other = || other_programs::suggest_key(key, rule, Some(written));
    // Advice with the user's value comes first.
    let with_value = other().filter(|advice| !advice.contains("..."));
    let or_form = || parent_key(key, rule).or_else(other);
    with_value.or_else(or_form).or_else(|| did_you_mean_or_list(key, known.iter().copied()))
}

/// Suggests the key of an object under which a kind of this name belongs: `sphere` is a kind of
/// shape and belongs under `shape`.
fn parent_key(kind: &str, rule: &'static Rule) -> Option<String> {
    rule.fields.iter().flatten().find_map(|(field, content)| {
        let alternatives = content.alternatives.iter().map(|alternative| alternative.rule.get());
        let families = std::iter::once(content.get()).chain(alternatives);
        families.into_iter().find_map(|family| {
            let own = family.kinds.iter().map(|(name, _)| *name).find(|name| *name == kind);
            let name = own.or_else(|| other_programs::kind_name(kind, family).filter(|_| *field == "shape"))?;
            let noun = wording::noun(family.name?);
            let called = if name == kind {
                format!("`{kind}` is a kind of {noun}")
            } else {
                format!("`{kind}` is a {noun} that is called `{name}` here")
            };
            Some(format!("{called}: write \"{field}\": {{\"{name}\": {{...}}}}"))
        })
    })
}
