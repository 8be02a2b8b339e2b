//! The schema compiled to rules for validation. All lookups by text are done once, ahead of all
//! scenes.

use super::wording;
use crate::schema::{Schema, exactly_one, variants};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Constraints on a value.
#[derive(Debug)]
pub struct Rule {
    /// Name of the schema's definition, if it has one.
    pub name: Option<&'static str>,
    /// Schema of the value, for messages.
    pub schema: &'static Value,
    /// Whether any value is allowed, because it is checked elsewhere.
    pub allows_anything: bool,
    /// Alternative forms of the value; empty if there is only one.
    pub alternatives: Vec<Alternative>,
    /// The kinds of a family.
    pub kinds: Vec<(&'static str, RuleId)>,
    /// Fixed words.
    pub words: Vec<&'static str>,
    /// Allowed JSON types.
    pub types: Types,
    /// Whether strings are colors.
    pub is_color: bool,
    /// Limits of a number.
    pub numbers: Numbers,
    /// Minimum and maximum number of elements of an array.
    pub length: (Option<usize>, Option<usize>),
    /// The elements of an array.
    pub items: Option<RuleId>,
    /// Fixed keys of an object, with the rules of their values.
    pub fields: Option<Vec<(&'static str, RuleId)>>,
    /// Rule of the values of an object whose keys are names.
    pub additional: Option<RuleId>,
    /// Required keys.
    pub required: Vec<&'static str>,
    /// Keys of which exactly one is required.
    pub exactly_one: Vec<&'static str>,
}

/// Index of a rule in the list of all rules.
#[derive(Clone, Copy, Debug)]
pub struct RuleId(usize);

/// An alternative form of a value.
#[derive(Clone, Copy, Debug)]
pub struct Alternative {
    /// Name of the definition that offers the form.
    pub owner: Option<&'static str>,
    /// Rule of the form; never itself a choice of forms.
    pub rule: RuleId,
}

/// Set of JSON types.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "a set")]
pub struct Types {
    /// `null`.
    pub null: bool,
    /// `true` or `false`.
    pub boolean: bool,
    /// Any number.
    pub number: bool,
    /// Integers.
    pub integer: bool,
    /// Strings.
    pub string: bool,
    /// Arrays.
    pub array: bool,
    /// Objects.
    pub object: bool,
}

/// Limits of a number.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    /// Whether the number is stored as `f32`.
    pub single: bool,
    /// Inclusive minimum.
    pub min: Option<f64>,
    /// Inclusive maximum.
    pub max: Option<f64>,
    /// Exclusive minimum.
    pub exclusive_min: Option<f64>,
    /// Exclusive maximum.
    pub exclusive_max: Option<f64>,
}

/// Largest double below 2^64. It stands for all integers from there to 2^64 - 1, which doubles do
/// not distinguish.
pub const MAX_U64: f64 = 18_446_744_073_709_549_568.0;

/// All rules; the first is the rule of a whole scene.
static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    let mut builder = Builder { schema: Schema::get(), rules: Vec::new(), known: BTreeMap::new() };
    builder.rule(Schema::get().root());
    // Add the definitions that the scene does not refer to.
    for (name, definition) in Schema::get().definitions() {
        builder.add(Some(name), definition);
    }
    builder.rules.into_iter().flatten().collect()
});

/// Rules of definitions by name.
static NAMED: LazyLock<BTreeMap<&'static str, &'static Rule>> =
    LazyLock::new(|| RULES.iter().filter_map(|rule| Some((rule.name?, rule))).collect());

impl Rule {
    /// Rule of a whole scene.
    pub fn root() -> Option<&'static Self> {
        RULES.first()
    }

    /// All rules.
    pub fn all() -> &'static [Self] {
        &RULES
    }

    /// Rule of a definition.
    pub fn named(name: &str) -> Option<&'static Self> {
        NAMED.get(name).copied()
    }

    /// Whether numbers are allowed.
    pub fn allows_number(&self) -> bool {
        self.types.number || self.types.integer
    }

    /// Whether the value is one of several kinds or words.
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
        let other = || self.additional.map(|rule| (key.to_owned().into(), rule));
        field.map(|(name, rule)| ((*name).into(), *rule)).or_else(other)
    }
}

impl std::ops::Deref for RuleId {
    type Target = Rule;
    fn deref(&self) -> &Rule {
        // Ids are indices into the list, which never changes.
        &RULES[self.0]
    }
}

impl RuleId {
    /// Returns the rule with a static lifetime.
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
        let (properties, additional) = (schema.get("properties"), schema.get("additionalProperties"));
        let fields = properties.and_then(Value::as_object);
        let mut alternatives = Vec::new();
        self.alternatives(name, schema, &mut alternatives);
        let family = self.schema;
        Rule {
            name,
            schema,
            allows_anything: schema.as_bool() == Some(true),
            alternatives,
            kinds: family.kinds(schema).map(|(kind, content)| (kind, self.rule(content))).collect(),
            words: wording::fixed(schema).collect(),
            types: Types::of(schema),
            is_color: schema.get("pattern").is_some(),
            numbers: Numbers::of(schema),
            length: (length("minItems"), length("maxItems")),
            items: schema.get("items").map(|items| self.rule(items)),
            fields: fields.map(|fields| fields.iter().map(|(key, field)| (key.as_str(), self.rule(field))).collect()),
            additional: additional.filter(|schema| schema.is_object()).map(|schema| self.rule(schema)),
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

    /// Collects all alternative forms of a value and flattens nested choices.
    fn alternatives(
        &mut self,
        owner: Option<&'static str>,
        schema: &'static Value,
        alternatives: &mut Vec<Alternative>,
    ) {
        for branch in schema.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
            let (name, target) = self.schema.follow(branch);
            if target.get("anyOf").is_some() {
                self.alternatives(name.or(owner), target, alternatives);
            } else {
                alternatives.push(Alternative { owner, rule: self.rule(branch) });
            }
        }
    }
}

impl Types {
    fn of(schema: &Value) -> Self {
        let allows = |json_type| wording::allows(schema, json_type);
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
        // Round the limit of a 32-bit number as the number itself, so that the limit's own value is
        // allowed.
        let rounded = |bound: f64| if single { f64::from(bound as f32) } else { bound };
        let bound = |key: &str| schema.get(key).and_then(Value::as_f64).map(rounded);
        // The maximum of an integer type follows from its format.
        let largest = match format {
            "uint32" => Some(u32::MAX.into()),
            "uint64" => Some(MAX_U64),
            "int32" => Some(i32::MAX.into()),
            _ => None,
        };
        Self {
            single,
            min: bound("minimum"),
            max: bound("maximum").or(largest),
            exclusive_min: bound("exclusiveMinimum"),
            exclusive_max: bound("exclusiveMaximum"),
        }
    }

    /// Describes the limit that a value violates; `None` if it violates none.
    pub fn violated_limit(&self, value: f64) -> Option<String> {
        if let (Some(min), Some(max)) = (self.min, self.max) {
            let broken = value < min || value > max;
            return broken.then(|| format!("between {} and {}", shown(min), shown(max)));
        }
        let rules = [
            (self.exclusive_min.filter(|b| value <= *b), "greater than"),
            (self.exclusive_max.filter(|b| value >= *b), "less than"),
            (self.min.filter(|b| value < *b), "at least"),
            (self.max.filter(|b| value > *b), "at most"),
        ];
        rules.into_iter().find_map(|(broken, words)| broken.map(|bound| format!("{words} {}", shown(bound))))
    }
}

fn shown(bound: f64) -> String {
    let single = bound as f32;
    let is_large = bound.abs() >= 1.0e16;
    match f64::from(single) == bound {
        _ if bound == MAX_U64 => u64::MAX.to_string(),
        // Print the digits that a 32-bit number needs: 0.01, not 0.009999999776482582.
        true if is_large => format!("{single:e}"),
        true => single.to_string(),
        false if is_large => format!("{bound:e}"),
        false => bound.to_string(),
    }
}
