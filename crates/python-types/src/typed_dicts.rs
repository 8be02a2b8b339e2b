//! The module `typing`: the scene format as dictionaries, and aliases for what fields accept.

use crate::annotations::{Annotations, input_alias};
use crate::model::{Class, Field, Kind, Model, Module, VALUE_FORM, choices, fields, kinds, object, reference, words};
use crate::{NOTICE, names};
use serde_json::Value;
use std::fmt::Write;

/// Start of the module, with the aliases that do not depend on the schema.
const HEAD: &str = include_str!("typing_head.py");

/// The module.
pub fn module(model: &Model<'_>) -> String {
    let mut modules: Vec<&str> = model.modules.iter().map(|module| module.name.as_str()).collect();
    modules.sort_unstable();
    let mut text = format!("{NOTICE}{}", HEAD.replace("MODULES", &modules.join("\n    from . import ")));
    let writer = Writer { model, annotations: Annotations::new(model, "") };
    for (name, schema) in model.definitions() {
        if let Some(value) = name.strip_prefix("Input_") {
            alias(&mut text, &input_alias(value), &writer.annotations.definition(schema));
        }
    }
    for module in &model.modules {
        match module.family {
            Some(family) => writer.family(&mut text, module, family),
            None => writer.scene_types(&mut text, module),
        }
    }
    writer.other_definitions(&mut text);
    while text.contains("\n\n\n\n") {
        text = text.replace("\n\n\n\n", "\n\n\n");
    }
    format!("{}\n", text.trim_end())
}

#[derive(Clone, Copy, Debug)]
struct Writer<'m, 's> {
    model: &'m Model<'s>,
    annotations: Annotations<'m, 's>,
}

impl<'s> Writer<'_, 's> {
    fn family(&self, text: &mut String, module: &Module<'s>, family: &str) {
        let classes: Vec<String> =
            module.classes.iter().map(|class| format!("{}.{}", module.name, class.name)).collect();
        let noun = names::family(family).unwrap_or(family);
        let dict = |class: &Class<'_>| match names::family(family) {
            Some(noun) => format!("{}{noun}Dict", class.name),
            None => format!("{}Dict", class.name),
        };
        let members = module.classes.iter().filter_map(|class| {
            // With the dictionaries of value forms in every type, mypy takes five times as long.
            let any = (family == VALUE_FORM).then(|| "Mapping[str, Any]".to_owned());
            let value = any.unwrap_or_else(|| format!("{} | ValueForm", dict(class)));
            Some((class.kind?, value, false))
        });
        typed_dict(text, &format!("{noun}Dict"), &members.collect::<Vec<_>>());
        let names = self.model.definition(family).map(words).unwrap_or_default();
        let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        let names = if names.is_empty() { String::new() } else { format!(" | Literal[{}]", names.join(", ")) };
        if family == VALUE_FORM {
            alias(text, VALUE_FORM, &format!("{} | {noun}Dict", classes.join(" | ")));
        } else {
            alias(text, noun, &classes.join(" | "));
            alias(text, &format!("{noun}Like"), &format!("{noun} | {noun}Dict{names} | ValueForm"));
        }
        for class in &module.classes {
            self.class(text, &dict(class), class);
        }
    }

    fn scene_types(&self, text: &mut String, module: &Module<'s>) {
        for class in &module.classes {
            let name = &class.name;
            self.class(text, &format!("{name}Dict"), class);
            let form = class.definition.and_then(|name| self.model.definition(name)).is_some_and(has_form);
            let form = if form { " | ValueForm" } else { "" };
            alias(text, &format!("{name}Like"), &format!("{}.{name} | {name}Dict{form}", module.name));
        }
    }

    fn class(&self, text: &mut String, name: &str, class: &Class<'s>) {
        let constants = class.constants.iter().map(|(key, value)| (*key, format!("Literal[{value}]"), true));
        typed_dict(text, name, &constants.chain(self.members(&class.fields)).collect::<Vec<_>>());
    }

    fn members(&self, fields: &[Field<'s>]) -> Vec<(&'s str, String, bool)> {
        let member = |field: &Field<'s>| (field.key, self.annotations.accepts(field.schema), field.required);
        fields.iter().map(member).collect()
    }

    /// Dictionaries of the definitions that have no class, such as the steps of a transform.
    fn other_definitions(&self, text: &mut String) {
        let classes = || self.model.modules.iter().flat_map(|module| &module.classes);
        for (name, schema) in self.model.definitions() {
            let is_class = self.model.class_of(name).is_some() || classes().any(|class| class.definition == Some(name));
            let mut members = object(schema).map(|object| self.members(&fields(object))).unwrap_or_default();
            members.extend(kinds(schema).map(|kind| (kind.name, self.variant(text, name, kind), false)));
            if !is_class && names::family(name).is_none() && name != VALUE_FORM && !members.is_empty() {
                typed_dict(text, &format!("{name}Dict"), &members);
                let classes = self.classes_like(schema);
                alias(text, &format!("{name}Like"), &format!("{classes}{name}Dict | ValueForm"));
            }
        }
    }

    /// Annotation of a variant; the object of a variant without a definition gets a dictionary.
    fn variant(&self, text: &mut String, owner: &str, kind: Kind<'s>) -> String {
        let Some(object) = object(kind.content) else { return self.annotations.accepts(kind.content) };
        let name = format!("{owner}{}Dict", names::camel(kind.name));
        typed_dict(text, &name, &self.members(&fields(object)));
        format!("{name} | ValueForm")
    }

    /// The classes of a family whose kinds have the names of all variants of another definition:
    /// the shapes of area lights are shapes.
    fn classes_like(&self, schema: &'s Value) -> String {
        let keys: Vec<&str> = kinds(schema).map(|kind| kind.name).collect();
        let classes = self.model.modules.iter().filter(|_| !keys.is_empty()).find_map(|module| {
            let class = |key: &&str| module.classes.iter().find(|class| class.kind == Some(key));
            let name = |key| class(key).map(|class| format!("{}.{} | ", module.name, class.name));
            keys.iter().map(name).collect()
        });
        classes.unwrap_or_default()
    }
}

fn has_form(schema: &Value) -> bool {
    choices(schema).any(|branch| reference(branch) == Some(VALUE_FORM))
}

fn alias(text: &mut String, name: &str, value: &str) {
    let _ = writeln!(text, "{name}: TypeAlias = \"{}\"", escaped(value));
}

fn escaped(annotation: &str) -> String {
    annotation.replace('"', "'")
}

/// Writes a dictionary type with its members: key, annotation, and whether it is required. A class
/// cannot have a keyword as the name of a member; a call can.
fn typed_dict(text: &mut String, name: &str, members: &[(&str, String, bool)]) {
    let annotation = |annotation: &str, required: bool| {
        if required { format!("Required[{annotation}]") } else { annotation.to_owned() }
    };
    if members.iter().all(|(key, _, _)| names::field(key).as_deref() == Some(*key)) {
        let _ = write!(text, "\n\nclass {name}(TypedDict, total=False):\n");
        for (key, value, required) in members {
            let _ = writeln!(text, "    {key}: {}", annotation(value, *required));
        }
        text.push_str(if members.is_empty() { "    pass\n\n\n" } else { "\n\n" });
        return;
    }
    let _ = write!(text, "\n\n{name} = TypedDict(\n    \"{name}\",\n    {{\n");
    for (key, value, required) in members {
        let _ = writeln!(text, "        \"{key}\": \"{}\",", escaped(&annotation(value, *required)));
    }
    text.push_str("    },\n    total=False,\n)\n\n\n");
}
