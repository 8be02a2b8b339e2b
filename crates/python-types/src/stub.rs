//! Stubs of the modules, for editors and type checkers.

use crate::annotations::Annotations;
use crate::model::{Class, Model, Module};
use crate::{NOTICE, docstring, python};
use std::fmt::Write;

/// Names that stubs import if they use them.
const IMPORTS: [(&str, &[&str]); 2] =
    [("collections.abc", &["Mapping", "Sequence"]), ("typing", &["Any", "Literal", "Self"])];

/// Statements that import what the classes use, and what they use.
const MODULES: [(&str, &str); 3] = [
    ("scene_types.", "from . import scene_types\n"),
    ("t.", "from . import typing as t\n"),
    ("PerFace", "from ._array_nodes import PerFace\n"),
];

/// The stub of a module.
pub fn module(model: &Model<'_>, module: &Module<'_>) -> String {
    let classes: String = module.classes.iter().map(|one| class(model, module, one)).collect();
    let mut text = format!("{NOTICE}\"\"\"{}\"\"\"\n\n", module.summary);
    for (source, names) in IMPORTS {
        let used: Vec<&str> = names.iter().copied().filter(|name| uses(&classes, name)).collect();
        if !used.is_empty() {
            let _ = writeln!(text, "from {source} import {}", used.join(", "));
        }
    }
    text.push('\n');
    for (name, statement) in MODULES {
        if classes.contains(name) {
            text.push_str(statement);
        }
    }
    for base in python::bases(module) {
        let _ = writeln!(text, "{base}");
    }
    text + &python::all(module) + &classes
}

fn uses(text: &str, name: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name)
}

fn class(model: &Model<'_>, module: &Module<'_>, class: &Class<'_>) -> String {
    let annotations = Annotations::new(model, "t.");
    let docstring = docstring::class(model, module, class);
    let mut text = format!("\nclass {}({}):\n{docstring}", class.name, python::base(class).1);
    text.push_str(&python::tuple("__match_args__", &python::quoted(class.match_args())));
    for field in &class.fields {
        let _ = writeln!(text, "    {}: {}", field.name, annotations.gives(field.schema, &module.name));
    }
    for (name, _, _) in class.extra() {
        let _ = writeln!(text, "    {name}: Any");
    }
    let (positional, required): (Vec<&str>, Vec<&str>) = (class.positional(), class.required().collect());
    // Parameters of the constructor, and of `replace`, where each field may be left out.
    let (mut first, mut keywords, mut changes) = (String::new(), String::new(), String::new());
    let fields = class.fields.iter().map(|field| {
        let own = class.accepts(&field.name).map(str::to_owned);
        (field.name.as_str(), own.unwrap_or_else(|| annotations.accepts(field.schema)))
    });
    for (name, annotation) in fields.chain(class.extra().iter().map(|(name, one, _)| (*name, (*one).to_owned()))) {
        let place = if positional.contains(&name) { &mut first } else { &mut keywords };
        if required.contains(&name) {
            let _ = writeln!(place, "        {name}: {annotation},");
            let _ = writeln!(changes, "        {name}: {annotation} = ...,");
        } else {
            let _ = writeln!(place, "        {name}: {annotation} | None = None,");
            let _ = writeln!(changes, "        {name}: {annotation} | None = ...,");
        }
    }
    let [before_keywords, before_changes] =
        [&keywords, &changes].map(|p| if p.is_empty() { "" } else { "        *,\n" });
    let _ = write!(
        text,
        "    def __init__(\n        self,\n{first}{before_keywords}{keywords}    ) -> None: ...\n    \
         def replace(\n        self,\n{before_changes}{changes}    ) -> Self: ...\n"
    );
    text
}
