//! The schema as the walk over a scene asks for it: every look-up by a text done once, ahead of all scenes.

use super::words;
use crate::schema::{Schema, exactly_one, variants};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// What may stand at one place.
#[derive(Debug)]
pub struct Rule {
    /// The name of the definition, when it has one.
    pub name: Option<&'static str>,
    /// The same as a schema, for messages.
    pub schema: &'static Value,
    /// Whether everything may stand there, to be checked by others.
    pub anything: bool,
    /// Several ways to write a value; empty when there is one.
    pub ways: Vec<Way>,
    /// The kinds of a family.
    pub kinds: Vec<(&'static str, RuleId)>,
    /// A list of fixed words.
    pub words: Vec<&'static str>,
    /// JSON types that may stand there.
    pub types: Types,
    /// Whether texts are colours.
    pub color: bool,
    /// Limits of a number.
    pub numbers: Numbers,
    /// Fewest and most elements of an array.
    pub length: (Option<usize>, Option<usize>),
    /// The elements of an array.
    pub items: Option<RuleId>,
    /// The keys of an object that has fixed ones.
    pub fields: Option<Vec<(&'static str, RuleId)>>,
    /// Values of an object whose keys are names.
    pub others: Option<RuleId>,
    /// Keys that must stand.
    pub required: Vec<&'static str>,
    /// Keys of which exactly one must stand.
    pub exactly_one: Vec<&'static str>,
}

/// A rule's place in the list of all.
#[derive(Clone, Copy, Debug)]
pub struct RuleId(usize);

/// One way to write a value.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// The definition that offers it.
    pub owner: Option<&'static str>,
    /// What may stand there: never itself a choice.
    pub rule: RuleId,
}

/// JSON types.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "a set")]
pub struct Types {
    /// null
    pub null: bool,
    /// true or false
    pub boolean: bool,
    /// Any number.
    pub number: bool,
    /// Whole numbers.
    pub integer: bool,
    /// Texts.
    pub string: bool,
    /// Arrays.
    pub array: bool,
    /// Objects.
    pub object: bool,
}

/// Limits of a number.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    /// Whether it is kept in 32 bits.
    pub single: bool,
    /// Not less than this.
    pub least: Option<f64>,
    /// Not more than this.
    pub most: Option<f64>,
    /// More than this.
    pub above: Option<f64>,
    /// Less than this.
    pub below: Option<f64>,
}

/// Largest double below 2^64. It stands for all whole numbers from there to 2^64 - 1, which doubles do not tell apart.
pub const MOST_U64: f64 = 18_446_744_073_709_549_568.0;

/// Every rule; the first is that of a whole scene.
static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    let mut builder = Builder { schema: Schema::get(), rules: Vec::new(), known: BTreeMap::new() };
    builder.rule(Schema::get().root());
    // Some definitions are only checked by themselves.
    for (name, definition) in Schema::get().definitions() {
        builder.add(Some(name), definition);
    }
    builder.rules.into_iter().flatten().collect()
});

/// Those of definitions, by name.
static NAMED: LazyLock<BTreeMap<&'static str, &'static Rule>> =
    LazyLock::new(|| RULES.iter().filter_map(|rule| Some((rule.name?, rule))).collect());

impl Rule {
    /// What a whole scene must be.
    pub fn root() -> Option<&'static Self> {
        RULES.first()
    }

    /// Every rule.
    pub fn all() -> &'static [Self] {
        &RULES
    }

    /// What a definition says.
    pub fn named(name: &str) -> Option<&'static Self> {
        NAMED.get(name).copied()
    }

    /// Whether any number may stand there.
    pub fn allows_number(&self) -> bool {
        self.types.number || self.types.integer
    }

    /// Whether it is one of several kinds or words.
    pub fn is_family(&self) -> bool {
        !self.kinds.is_empty() || !self.words.is_empty()
    }

    /// The rule of a key.
    pub fn field(&self, key: &str) -> Option<RuleId> {
        self.member(key).map(|(_, rule)| rule)
    }

    /// The rule of a key, and the key itself, borrowed from the schema if it is fixed there.
    pub fn member(&self, key: &str) -> Option<(Cow<'static, str>, RuleId)> {
        let field = self.fields.iter().flatten().find(|(name, _)| *name == key);
        let other = || self.others.map(|rule| (key.to_owned().into(), rule));
        field.map(|(name, rule)| ((*name).into(), *rule)).or_else(other)
    }
}

impl std::ops::Deref for RuleId {
    type Target = Rule;
    fn deref(&self) -> &Rule {
        // Ids are places in the list, which never changes.
        &RULES[self.0]
    }
}

impl RuleId {
    /// The rule, for good.
    pub fn get(self) -> &'static Rule {
        &RULES[self.0]
    }
}

struct Builder {
    schema: &'static Schema,
    rules: Vec<Option<Rule>>,
    known: BTreeMap<&'static str, RuleId>,
}

impl Builder {
    fn rule(&mut self, schema: &'static Value) -> RuleId {
        let (name, schema) = self.schema.follow(schema);
        self.add(name, schema)
    }

    fn add(&mut self, name: Option<&'static str>, schema: &'static Value) -> RuleId {
        if let Some(known) = name.and_then(|name| self.known.get(name)) {
            return *known;
        }
        let id = RuleId(self.rules.len());
        self.rules.push(None);
        self.known.extend(name.map(|name| (name, id)));
        let rule = self.read(name, schema);
        self.rules[id.0] = Some(rule);
        id
    }

    fn read(&mut self, name: Option<&'static str>, schema: &'static Value) -> Rule {
        let length = |key: &str| schema.get(key).and_then(Value::as_u64).and_then(|n| usize::try_from(n).ok());
        let (properties, others) = (schema.get("properties"), schema.get("additionalProperties"));
        let fields = properties.and_then(Value::as_object);
        let mut ways = Vec::new();
        self.ways(name, schema, &mut ways);
        let family = self.schema;
        Rule {
            name,
            schema,
            anything: schema.as_bool() == Some(true),
            ways,
            kinds: family.kinds(schema).map(|(kind, content)| (kind, self.rule(content))).collect(),
            words: words::fixed(schema).collect(),
            types: Types::of(schema),
            color: schema.get("pattern").is_some(),
            numbers: Numbers::of(schema),
            length: (length("minItems"), length("maxItems")),
            items: schema.get("items").map(|items| self.rule(items)),
            fields: fields.map(|fields| fields.iter().map(|(key, field)| (key.as_str(), self.rule(field))).collect()),
            others: others.filter(|others| others.is_object()).map(|others| self.rule(others)),
            required: schema
                .get("required")
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
                .filter_map(Value::as_str)
                .collect(),
            exactly_one: exactly_one(schema),
        }
    }

    /// All ways to write a value, choices inside choices opened.
    fn ways(&mut self, owner: Option<&'static str>, schema: &'static Value, ways: &mut Vec<Way>) {
        for branch in schema.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
            let (name, target) = self.schema.follow(branch);
            if target.get("anyOf").is_some() {
                self.ways(name.or(owner), target, ways);
            } else {
                ways.push(Way { owner, rule: self.rule(branch) });
            }
        }
    }
}

impl Types {
    fn of(schema: &Value) -> Self {
        let allows = |json_type| words::allows(schema, json_type);
        Self {
            null: allows("null"),
            boolean: allows("boolean"),
            number: allows("number"),
            integer: allows("integer"),
            string: allows("string"),
            array: allows("array"),
            object: allows("object") && variants(schema).next().is_none(),
        }
    }
}

impl Numbers {
    fn of(schema: &Value) -> Self {
        let format = schema.get("format").and_then(Value::as_str).unwrap_or_default();
        let single = format == "float";
        // A limit of a 32-bit number is rounded as the number itself is, so that the limit's own value is allowed.
        let rounded = |bound: f64| if single { f64::from(bound as f32) } else { bound };
        let bound = |key: &str| schema.get(key).and_then(Value::as_f64).map(rounded);
        // The largest number of an integer type is left to the format's name.
        let largest = match format {
            "uint32" => Some(u32::MAX.into()),
            "uint64" => Some(MOST_U64),
            "int32" => Some(i32::MAX.into()),
            _ => None,
        };
        Self {
            single,
            least: bound("minimum"),
            most: bound("maximum").or(largest),
            above: bound("exclusiveMinimum"),
            below: bound("exclusiveMaximum"),
        }
    }

    /// The limit that a value breaks, in words.
    pub fn broken_by(&self, value: f64) -> Option<String> {
        if let (Some(least), Some(most)) = (self.least, self.most) {
            let broken = value < least || value > most;
            return broken.then(|| format!("between {} and {}", shown(least), shown(most)));
        }
        let rules = [
            (self.above.filter(|b| value <= *b), "greater than"),
            (self.below.filter(|b| value >= *b), "less than"),
            (self.least.filter(|b| value < *b), "at least"),
            (self.most.filter(|b| value > *b), "at most"),
        ];
        rules.into_iter().find_map(|(broken, words)| broken.map(|bound| format!("{words} {}", shown(bound))))
    }
}

fn shown(bound: f64) -> String {
    let single = bound as f32;
    let is_large = bound.abs() >= 1.0e16;
    match f64::from(single) == bound {
        _ if bound == MOST_U64 => u64::MAX.to_string(),
        // The digits that a 32-bit number needs: 0.01, not 0.009999999776482582.
        true if is_large => format!("{single:e}"),
        true => single.to_string(),
        false if is_large => format!("{bound:e}"),
        false => bound.to_string(),
    }
}
