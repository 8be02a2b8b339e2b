//! Documentation of the classes.

use crate::model::{Class, Field, Model, Module, description};
use crate::words;
use std::fmt::Write;

/// Width of the text, in characters.
const WIDTH: usize = 100;
/// Examples: an expression of Python a line, by class.
const EXAMPLES: &str = include_str!("examples.txt");

/// Documentation string of a class, with the quotation marks, indented by four spaces.
pub fn class(model: &Model<'_>, module: &Module<'_>, class: &Class<'_>) -> String {
    let mut text = String::new();
    for (index, paragraph) in paragraphs(class.description).iter().enumerate() {
        // The first line begins with the quotation marks.
        let (separator, first) = if index == 0 { ("", 7) } else { ("\n", 4) };
        let _ = write!(text, "{separator}{}", wrapped(paragraph, first, 4));
    }
    if !class.fields.is_empty() || !class.extra().is_empty() {
        text.push_str("\n    Args:\n");
        for field in &class.fields {
            let is_required = class.required().any(|name| name == field.name);
            text.push_str(&argument(model, field, is_required));
        }
        for (name, _, description) in class.extra() {
            text.push_str(&wrapped(&format!("{name}: {description}"), 8, 12));
        }
    }
    if let Some(example) = example(module, class) {
        let _ = write!(text, "\n    Example:\n        {example}\n");
    }
    let text = text.trim().replace('\\', "\\\\");
    let end = if text.contains('\n') || text.len() > WIDTH - 10 { "\n    " } else { "" };
    format!("    \"\"\"{text}{end}\"\"\"\n")
}

/// Example of a class.
pub fn example(module: &Module<'_>, class: &Class<'_>) -> Option<&'static str> {
    let qualified =
        if module.family.is_some() { format!("{}.{}(", module.name, class.name) } else { format!("{}(", class.name) };
    EXAMPLES.lines().find(|line| line.starts_with(&qualified))
}

fn argument(model: &Model<'_>, field: &Field<'_>, is_required: bool) -> String {
    let schema = field.schema;
    let text = paragraphs(description(schema)).join(" ");
    let mut facts = vec![words::value(model, schema)];
    facts.extend(words::unit(schema).filter(|unit| !text.contains(unit)).map(str::to_owned));
    if is_required {
        facts.push("required".into());
    } else if let Some(default) = words::default(schema) {
        facts.push(format!("default {default}"));
    }
    facts.retain(|fact| !fact.is_empty());
    wrapped(&format!("{} ({}): {text}", field.name, facts.join("; ")), 8, 12)
}

/// Paragraphs of a description, without blocks of code, which are in other languages.
fn paragraphs(description: &str) -> Vec<String> {
    let prose: String = description.split("```").step_by(2).collect();
    let paragraphs = prose.split("\n\n").map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "));
    paragraphs.filter(|text| !text.is_empty()).collect()
}

/// Lines of a text, the first indented by `first` spaces, all others by `rest`.
fn wrapped(text: &str, first: usize, rest: usize) -> String {
    let mut lines = String::new();
    let mut line = " ".repeat(first);
    let mut is_empty = true;
    for word in text.split(' ') {
        if !is_empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(lines, "{line}");
            line = " ".repeat(rest);
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    let _ = writeln!(lines, "{line}");
    lines
}
