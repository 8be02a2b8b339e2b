//! The modules that Python runs.

use crate::model::{Class, Model, Module};
use crate::{NOTICE, docstring};
use std::fmt::Write;

/// The module of a family, of the value forms, or of all other objects.
pub fn module(model: &Model<'_>, module: &Module<'_>) -> String {
    let mut text = format!("{NOTICE}\"\"\"{}\"\"\"\n\n", module.summary);
    for base in bases(module) {
        let _ = writeln!(text, "{base}");
    }
    text.push_str(&all(module));
    for one in &module.classes {
        text.push_str(&class(model, module, one));
    }
    text
}

/// Assignment of the names of a module's classes.
pub fn all(module: &Module<'_>) -> String {
    let names = quoted(module.classes.iter().map(|class| class.name.as_str()));
    format!("\n__all__ = [\n{}]\n", list(&names, "    "))
}

/// Statements that import the base classes of a module.
pub fn bases(module: &Module<'_>) -> Vec<String> {
    let mut bases: Vec<(&str, &str)> = module.classes.iter().map(base).collect();
    bases.sort_unstable();
    bases.dedup();
    bases.into_iter().map(|(module, name)| format!("from .{module} import {name}")).collect()
}

/// Module and name of the base of a class.
pub fn base(class: &Class<'_>) -> (&'static str, &'static str) {
    class.extension.map_or(("_node", "Node"), |extension| extension.base)
}

/// The module that lists what the package has, so that `import juggler` need not load the classes.
pub fn exports(model: &Model<'_>) -> String {
    let mut text = format!("{NOTICE}\"\"\"Names of the modules and of the classes of `scene_types`.\"\"\"\n");
    let modules = quoted(model.modules.iter().map(|module| module.name.as_str()));
    let others = model.modules.iter().filter(|module| module.family.is_none());
    let types = quoted(others.flat_map(|module| &module.classes).map(|class| class.name.as_str()));
    let _ = write!(text, "\nMODULES = (\n{})\nSCENE_TYPES = (\n{})\n", list(&modules, "    "), list(&types, "    "));
    text
}

fn class(model: &Model<'_>, module: &Module<'_>, class: &Class<'_>) -> String {
    let mut text =
        format!("\n\nclass {}({}):\n{}\n", class.name, base(class).1, docstring::class(model, module, class));
    text.push_str(&tuple("__slots__", &quoted(class.fields.iter().map(|field| field.name.as_str()))));
    if let Some(kind) = class.kind {
        let _ = writeln!(text, "    _kind = \"{kind}\"");
    }
    let required: Vec<&str> = class.required().collect();
    for (attribute, names) in [("_positional", class.positional()), ("_required", required)] {
        if !names.is_empty() {
            text.push_str(&tuple(attribute, &quoted(names)));
        }
    }
    let renamed: Vec<String> = class
        .fields
        .iter()
        .filter(|field| field.key != field.name)
        .map(|field| format!("\"{}\": \"{}\"", field.name, field.key))
        .collect();
    let constants: Vec<String> = class.constants.iter().map(|(key, value)| format!("\"{key}\": {value}")).collect();
    for (attribute, members) in [("_keys", renamed), ("_constants", constants)] {
        if !members.is_empty() {
            let _ = writeln!(text, "    {attribute} = {{{}}}", members.join(", "));
        }
    }
    text
}

/// Names as strings of Python.
pub fn quoted<'n>(names: impl IntoIterator<Item = &'n str>) -> Vec<String> {
    names.into_iter().map(|name| format!("\"{name}\"")).collect()
}

/// Assignment of a tuple to an attribute of a class.
pub fn tuple(attribute: &str, items: &[String]) -> String {
    let line = match items {
        [one] => format!("    {attribute} = ({one},)\n"),
        items => format!("    {attribute} = ({})\n", items.join(", ")),
    };
    if line.len() <= 100 { line } else { format!("    {attribute} = (\n{}    )\n", list(items, "        ")) }
}

fn list(items: &[String], indent: &str) -> String {
    items.iter().map(|item| format!("{indent}{item},\n")).collect()
}
