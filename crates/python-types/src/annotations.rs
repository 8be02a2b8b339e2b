//! Annotations for type checkers: what a field accepts, and what it gives back.

use crate::model::{Model, VALUE_FORM, choices, kinds, object, reference, words};
use crate::names;
use serde_json::Value;

/// One alternative of a type.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Member {
    Number,
    Integer,
    Text,
    /// Value form, which may replace any value.
    Form,
    /// Array of numbers, perhaps of a fixed length.
    Vector(Option<u64>),
    /// Name in the module `typing` of a type that includes strings and value forms.
    Alias(String),
    /// Name in the module `typing` of a type that includes value forms.
    Like(String),
    /// Any other annotation.
    Other(String),
}

/// Writer of annotations.
#[derive(Clone, Copy, Debug)]
pub struct Annotations<'m, 's> {
    model: &'m Model<'s>,
    /// Prefix of the names of the module `typing`.
    prefix: &'static str,
}

impl<'m, 's> Annotations<'m, 's> {
    /// Annotations whose names of the module `typing` have a prefix.
    pub fn new(model: &'m Model<'s>, prefix: &'static str) -> Self {
        Self { model, prefix }
    }

    /// What a field accepts, beside `None`.
    pub fn accepts(&self, schema: &'s Value) -> String {
        self.render(&self.union(schema))
    }

    /// What a definition allows, written out.
    pub fn definition(&self, schema: &'s Value) -> String {
        self.render(&self.written_out(schema))
    }

    /// What a field gives back. The union with `Any` keeps completion for the usual class, while
    /// dictionaries, expressions and value forms, which a field may hold as well, cause no errors.
    pub fn gives(&self, schema: &'s Value, module: &str) -> String {
        let mut types = self.usual(schema, module);
        types.push("Any".into());
        types.join(" | ")
    }

    fn union(&self, schema: &'s Value) -> Vec<Member> {
        reference(schema).map_or_else(|| self.written_out(schema), |name| self.named(name))
    }

    fn named(&self, name: &'s str) -> Vec<Member> {
        let member = match name.split_once('_') {
            _ if name == VALUE_FORM => Member::Form,
            _ if name == "Expression" => Member::Text,
            _ if name == "Color" => Member::Alias("ColorLike".into()),
            Some(("Input", value)) => Member::Alias(input_alias(value)),
            _ => match self.like(name) {
                Some(alias) => Member::Like(alias),
                None => return self.model.definition(name).map(|schema| self.written_out(schema)).unwrap_or_default(),
            },
        };
        vec![member]
    }

    /// Alias for the values of a definition that has classes or dictionaries of its own.
    fn like(&self, name: &str) -> Option<String> {
        if let Some(family) = names::family(name) {
            return Some(format!("{family}Like"));
        }
        let schema = self.model.definition(name)?;
        if self.model.class_of(name).is_some() {
            return Some(format!("{}Like", names::definition_class(name)));
        }
        (object(schema).is_some() || kinds(schema).next().is_some()).then(|| format!("{name}Like"))
    }

    fn written_out(&self, schema: &'s Value) -> Vec<Member> {
        let mut union = Vec::new();
        let literals: Vec<String> = words(schema).iter().map(|word| format!("\"{word}\"")).collect();
        if !literals.is_empty() && kinds(schema).next().is_none() {
            union.push(Member::Other(format!("Literal[{}]", literals.join(", "))));
        }
        for branch in choices(schema) {
            let is_choice = branch.get("anyOf").is_some() || reference(branch).is_some();
            let members = if is_choice { self.union(branch) } else { self.plain(branch) };
            for member in members {
                if !union.contains(&member) {
                    union.push(member);
                }
            }
        }
        union
    }

    /// Type of a schema that is no choice.
    fn plain(&self, schema: &'s Value) -> Vec<Member> {
        let one = match schema.get("type").and_then(Value::as_str) {
            Some("number") => Member::Number,
            Some("integer") => Member::Integer,
            Some("boolean") => Member::Other("bool".into()),
            Some("string") => Member::Text,
            Some("array") => return self.array(schema),
            Some("object") => match schema.get("additionalProperties").filter(|others| others.is_object()) {
                Some(others) => Member::Other(format!("Mapping[str, {}]", self.accepts(others))),
                None => return Vec::new(),
            },
            _ if schema.get("oneOf").is_some() => return Vec::new(),
            _ => Member::Other("Any".into()),
        };
        vec![one]
    }

    fn array(&self, schema: &'s Value) -> Vec<Member> {
        if let Some(first) = schema.get("prefixItems").and_then(|items| items.get(0)) {
            let first = self.accepts(first);
            let texts = [format!("tuple[{first}, Any]"), format!("tuple[{first}, Any, Any]"), "list[Any]".into()];
            return texts.map(Member::Other).to_vec();
        }
        let Some(items) = schema.get("items") else { return vec![Member::Other("Sequence[Any]".into())] };
        let inner = self.union(items);
        let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
        if inner.iter().any(|member| matches!(member, Member::Number | Member::Integer)) && inner.iter().all(is_scalar)
        {
            return vec![Member::Vector(bound("minItems").filter(|least| Some(*least) == bound("maxItems")))];
        }
        let mut members = vec![Member::Other(format!("Sequence[{}]", self.render(&inner)))];
        if inner.iter().any(|member| matches!(member, Member::Vector(_))) {
            members.push(Member::Other(format!("{}ArrayLike", self.prefix)));
        }
        members
    }

    fn render(&self, union: &[Member]) -> String {
        let has_form = union.contains(&Member::Form);
        let covers_text = union.iter().any(|member| match member {
            Member::Number | Member::Integer => has_form,
            Member::Vector(_) | Member::Alias(_) => true,
            _ => false,
        });
        let covers_form = covers_text || union.iter().any(|member| matches!(member, Member::Like(_)));
        let own = |name: &str| format!("{}{name}", self.prefix);
        let mut texts: Vec<String> = Vec::new();
        for member in union {
            texts.push(match member {
                Member::Number if has_form => own("Number"),
                Member::Number => "float".into(),
                Member::Integer if has_form => own("Integer"),
                Member::Integer => "int".into(),
                Member::Text if covers_text => continue,
                Member::Text => "str".into(),
                Member::Form if covers_form => continue,
                Member::Form => own("ValueForm"),
                Member::Vector(Some(length @ 2..=4)) => own(&format!("Vec{length}Like")),
                Member::Vector(_) => own("VectorLike"),
                Member::Alias(name) | Member::Like(name) => own(name),
                Member::Other(text) => text.clone(),
            });
        }
        texts.join(" | ")
    }

    /// The types that a field usually gives back: no dictionaries, expressions or value forms.
    fn usual(&self, schema: &'s Value, module: &str) -> Vec<String> {
        if let Some(name) = reference(schema) {
            if matches!(name, VALUE_FORM | "Expression" | "Color") || name.starts_with("Input_") {
                return Vec::new();
            }
            if let Some(family) = names::family(name) {
                return vec![format!("{}{family}", self.prefix)];
            }
            if let Some(class) = self.model.class_of(name) {
                let scope = if module == "scene_types" { "" } else { "scene_types." };
                return vec![format!("{scope}{}", class.name)];
            }
            return self.model.definition(name).map(|schema| self.usual(schema, module)).unwrap_or_default();
        }
        if schema.get("anyOf").is_some() {
            return choices(schema).flat_map(|branch| self.usual(branch, module)).collect();
        }
        let inner = |key: &str| schema.get(key).map(|inner| self.gives(inner, module)).filter(|text| text != "Any");
        match schema.get("type").and_then(Value::as_str) {
            Some("array") => inner("items").map(|items| format!("list[{items}]")).into_iter().collect(),
            Some("object") => inner("additionalProperties").map(|o| format!("dict[str, {o}]")).into_iter().collect(),
            _ => self.written_out(schema).iter().filter_map(usual_name).collect(),
        }
    }
}

fn usual_name(member: &Member) -> Option<String> {
    Some(match member {
        Member::Number => "float".into(),
        Member::Integer => "int".into(),
        Member::Text => "str".into(),
        Member::Other(text) if text != "Any" => text.clone(),
        _ => return None,
    })
}

/// Alias for the inputs of materials and textures that give a number or a color.
pub fn input_alias(value: &str) -> String {
    let noun = if value == "float" { "Number" } else { value };
    format!("{noun}Input")
}

/// Whether an alternative is a single number.
fn is_scalar(member: &Member) -> bool {
    matches!(member, Member::Number | Member::Integer | Member::Text | Member::Form)
}
