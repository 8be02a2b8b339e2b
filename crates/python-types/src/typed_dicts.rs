//! The module `typing`: the scene format as dictionaries, and aliases for what fields accept.

use crate::annotations::{Annotations, input_alias};
use crate::model::{Class, Model, Module, VALUE_FORM, choices, kinds, object, reference, words};
use crate::{NOTICE, names};
use serde_json::Value;
use std::fmt::Write;

/// Start of the module, after the imports of the package.
const ALIASES: &str = r#"

class ArrayLike(Protocol):
    """Array of any library, such as NumPy, that converts itself to lists."""

    def tolist(self) -> Any: ...


Number: TypeAlias = "float | SupportsFloat | str | ValueForm"
"""Number, expression such as "=2 * radius", or value form."""
Integer: TypeAlias = "int | SupportsIndex | str | ValueForm"
"""Whole number, expression or value form."""
VectorLike: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Array of numbers, expression or value form."""
Vec2Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Two numbers, expression or value form."""
Vec3Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Three numbers, expression or value form."""
Vec4Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Four numbers, expression or value form."""
ColorLike: TypeAlias = "str | Number | Sequence[Number] | ArrayLike"
"""Color: "\#rrggbb", a gray as one number, or three numbers in linear light."""
"#;

/// The module.
pub fn module(model: &Model<'_>) -> String {
    let mut text = format!(
        "{NOTICE}\"\"\"Types of the scene format for type checkers: dictionaries, and what fields accept.\n\n\
         Import this module under `TYPE_CHECKING`: nothing needs it at run time.\n\"\"\"\n\n\
         from __future__ import annotations\n\n\
         from collections.abc import Mapping, Sequence\n\
         from typing import TYPE_CHECKING, Any, Literal, Protocol, Required, SupportsFloat, SupportsIndex\n\
         from typing import TypeAlias, TypedDict\n\n\
         if TYPE_CHECKING:\n"
    );
    let mut modules: Vec<&str> = model.modules.iter().map(|module| module.name.as_str()).collect();
    modules.sort_unstable();
    for module in modules {
        let _ = writeln!(text, "    from . import {module}");
    }
    text.push_str(&ALIASES.replace("\\#", "#"));
    let writer = Writer { model, annotations: Annotations::in_typing(model) };
    writer.inputs(&mut text);
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
    text.truncate(text.trim_end().len());
    text + "\n"
}

#[derive(Clone, Copy, Debug)]
struct Writer<'m, 's> {
    model: &'m Model<'s>,
    annotations: Annotations<'m, 's>,
}

impl<'s> Writer<'_, 's> {
    /// Aliases for the inputs of materials and textures.
    fn inputs(&self, text: &mut String) {
        for (name, schema) in self.model.definitions() {
            if let Some(value) = name.strip_prefix("Input_") {
                let _ = writeln!(
                    text,
                    "{}: TypeAlias = \"{}\"",
                    input_alias(value),
                    escaped(&self.annotations.definition(schema))
                );
            }
        }
    }

    fn family(&self, text: &mut String, module: &Module<'s>, family: &str) {
        let classes: Vec<String> =
            module.classes.iter().map(|class| format!("{}.{}", module.name, class.name)).collect();
        let noun = names::family(family).unwrap_or(family);
        let dict = |class: &Class<'_>| match names::family(family) {
            Some(noun) => format!("{}{noun}Dict", class.name),
            None => format!("{}Dict", class.name),
        };
        let members = module.classes.iter().filter_map(|class| {
            let value = if family == VALUE_FORM { dict(class) } else { format!("{} | ValueForm", dict(class)) };
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
        let fields =
            class.fields.iter().map(|field| (field.key, self.annotations.accepts(field.schema), field.required));
        typed_dict(text, name, &constants.chain(fields).collect::<Vec<_>>());
    }

    /// Dictionaries of the definitions that have no class, such as the steps of a transform.
    fn other_definitions(&self, text: &mut String) {
        for (name, schema) in self.model.definitions() {
            let is_family = names::family(name).is_some() || name == VALUE_FORM;
            let is_class = self.model.modules.iter().flat_map(|module| &module.classes).any(|class| {
                class.definition == Some(name) || class.kind.is_none() && names::definition_class(name) == class.name
            });
            if is_family || is_class {
                continue;
            }
            let kinds: Vec<_> = kinds(schema).collect();
            if !kinds.is_empty() {
                self.variants(text, name, schema);
            } else if object(schema).is_some() {
                self.object(text, &format!("{name}Dict"), schema);
                alias(text, &format!("{name}Like"), &format!("{name}Dict | ValueForm"));
            }
        }
    }

    fn variants(&self, text: &mut String, name: &str, schema: &'s Value) {
        let mut members = Vec::new();
        for kind in kinds(schema) {
            let value = match object(kind.content).filter(|_| reference(kind.content).is_none()) {
                Some(_) => {
                    let inner = format!("{name}{}Dict", names::camel(kind.name));
                    self.object(text, &inner, kind.content);
                    format!("{inner} | ValueForm")
                }
                None => self.annotations.accepts(kind.content),
            };
            members.push((kind.name, value, false));
        }
        typed_dict(text, &format!("{name}Dict"), &members);
        let classes = self.classes_like(schema);
        alias(text, &format!("{name}Like"), &format!("{classes}{name}Dict | ValueForm"));
    }

    /// The classes of a family whose kinds have the names of all variants of another definition:
    /// the shapes of area lights are shapes.
    fn classes_like(&self, schema: &'s Value) -> String {
        let keys: Vec<&str> = kinds(schema).map(|kind| kind.name).collect();
        let classes = self.model.modules.iter().find_map(|module| {
            let class = |key: &&str| module.classes.iter().find(|class| class.kind == Some(key));
            let found: Option<Vec<_>> = keys.iter().map(class).collect();
            Some((&module.name, found?))
        });
        let Some((module, classes)) = classes else { return String::new() };
        classes.iter().map(|class| format!("{module}.{} | ", class.name)).collect()
    }

    fn object(&self, text: &mut String, name: &str, schema: &'s Value) {
        let Some(object) = object(schema) else { return };
        let required = |key: &str| {
            object.get("required").and_then(Value::as_array).is_some_and(|keys| keys.iter().any(|one| one == key))
        };
        let fields = object.get("properties").and_then(Value::as_object).into_iter().flatten();
        let members = fields.map(|(key, schema)| (key.as_str(), self.annotations.accepts(schema), required(key)));
        typed_dict(text, name, &members.collect::<Vec<_>>());
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
