//! Arrays and objects.

use super::rule::Rule;
use super::{MAX_FINDINGS, Plain, Walk, foreign, words};
use crate::document::{Member, Members, Node};
use crate::path::Trail;
use crate::report::Finding;
use crate::suggest::meant_or_all;

/// Objects that stay when one of their members is wrong: the others can still be checked. In all others (a
/// camera, a shape) members hang together.
const LOOSE: [&str; 2] = ["Object", "Render"];

impl Walk<'_> {
    pub(super) fn array(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        elements: &[Node],
        rule: &'static Rule,
    ) -> Option<Plain> {
        let found = elements.len();
        let wanted = match rule.length {
            (Some(least), Some(most)) if least == most && found != least => Some(least.to_string()),
            (Some(least), _) if found < least => Some(format!("at least {least}")),
            (_, Some(most)) if found > most => Some(format!("at most {most}")),
            _ => None,
        };
        if let Some(wanted) = wanted {
            let what = words::elements(self.schema, rule.schema);
            let message = format!("expected {wanted} {what} in this array, found {found}");
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
        at: &Trail<'_>,
        members: &Members,
        rule: &'static Rule,
    ) -> Option<Plain> {
        let root = at.is_root();
        let loose = root || rule.name.is_some_and(|name| LOOSE.contains(&name)) || rule.fields.is_none();
        let mut json = Vec::with_capacity(members.len());
        let mut sound = true;
        for (key, member) in members.iter() {
            if self.findings.len() >= MAX_FINDINGS {
                return None;
            }
            let Some((name, field)) = rule.member(key) else {
                let finding = unknown_key(key, member, rule, at).on(member.key_place);
                self.findings.push(finding.at(&at.key(key)));
                sound = false;
                continue;
            };
            match self.value(&member.node, &at.key(key), field.get()) {
                Some(value) => json.push((name, value)),
                None => sound = false,
            }
        }
        let complete = self.required(node, at, members, rule);
        self.exactly_one(node, at, members, rule);
        if root && !json.iter().any(|(key, _)| key == "version") {
            json.push(("version".into(), Plain::Number(1.into())));
        }
        ((complete || root) && (sound || loose)).then_some(Plain::Object(json))
    }

    /// Whether all keys stand that must stand.
    fn required(&mut self, node: &Node, at: &Trail<'_>, members: &Members, rule: &'static Rule) -> bool {
        let missing: Vec<&str> = rule.required.iter().copied().filter(|key| !members.contains_key(key)).collect();
        if missing.is_empty() {
            return true;
        }
        let verb = if missing.len() == 1 { "is" } else { "are" };
        let mut finding =
            Finding::error(format!("{} {verb} missing here", words::list(missing.iter().copied(), "and")));
        if missing == ["version"] {
            finding = finding.help("a scene file begins with {\"version\": 1, ...");
        }
        self.report::<()>(node, at, finding).is_some()
    }

    /// Complains when not exactly one of some keys stands.
    fn exactly_one(&mut self, node: &Node, at: &Trail<'_>, members: &Members, rule: &'static Rule) {
        let keys = rule.exactly_one.iter().copied();
        let found = keys.clone().filter(|key| members.contains_key(key));
        let count = found.clone().count();
        if rule.exactly_one.is_empty() || count == 1 {
            return;
        }
        let found = if count == 0 { "none".into() } else { words::list(found, "and") };
        let message = format!("exactly one of {} must stand here, found {found}", words::list(keys, "and"));
        // A misspelt one is its own message.
        let misspelt = members.keys().any(|key| rule.field(key).is_none());
        let help = match found.as_str() {
            "none" if misspelt => return,
            "none" => "write for example \"shape\": \"sphere\"",
            _ => "make it several objects, one for each",
        };
        self.report::<()>(node, at, Finding::error(message).help(help));
    }
}

fn unknown_key(key: &str, member: &Member, rule: &'static Rule, at: &Trail<'_>) -> Finding {
    let has_settings = rule.fields.iter().flatten().next().is_some();
    if let (false, Some(owner)) = (has_settings, at.last_key()) {
        let help = foreign::key(key, rule).unwrap_or_else(|| format!("write \"{owner}\": {{}}"));
        return Finding::error(format!("`{owner}` has no setting `{key}`, nor any other")).help(help);
    }
    let tagged = member.node.as_str().filter(|_| key == "type").and_then(|kind| home_of(kind, rule));
    Finding::error(format!("`{key}` is not known here")).maybe_help(tagged.or_else(|| meant(key, rule)))
}

/// What an unknown key of an object probably means: a kind of what stands in one of its keys, a word
/// of another program, or a known key.
pub(super) fn meant(key: &str, rule: &'static Rule) -> Option<String> {
    let known: Vec<&str> = rule.fields.iter().flatten().map(|(name, _)| *name).collect();
    let foreign = || foreign::key(key, rule);
    home_of(key, rule).or_else(foreign).or_else(|| meant_or_all(key, known.iter().copied()))
}

/// Where a kind by this name belongs in an object: `sphere` is a kind of shape, which stands under
/// `shape`.
fn home_of(kind: &str, rule: &'static Rule) -> Option<String> {
    rule.fields.iter().flatten().find_map(|(field, content)| {
        let ways = content.ways.iter().map(|way| way.rule.get());
        let families = std::iter::once(content.get()).chain(ways);
        families.into_iter().find_map(|family| {
            let own = family.kinds.iter().map(|(name, _)| *name).find(|name| *name == kind);
            let name = own.or_else(|| foreign::kind_name(kind, family).filter(|_| *field == "shape"))?;
            let noun = words::noun(family.name?);
            let called = if name == kind {
                format!("`{kind}` is a kind of {noun}")
            } else {
                format!("`{kind}` is a {noun} that is called `{name}` here")
            };
            Some(format!("{called}: write \"{field}\": {{\"{name}\": {{...}}}}"))
        })
    })
}
