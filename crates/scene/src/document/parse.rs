//! Text → tree. Syntax by `jsonc-parser`; comments and trailing commas are the only liberties.

use super::guard::{self, Refused};
use super::source::{FileId, Place};
use super::tree::{Member, Members, Node, Value};
use crate::path::{Path, Step};
use indexmap::map::Entry;
use jsonc_parser::ast;
use jsonc_parser::common::Range as Bytes;
use jsonc_parser::errors::ParseErrorKind as Kind;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use serde_json::Number;
use std::ops::Range;
use std::sync::Arc;

/// The tree of a text with every duplicate key and unreadable number in it, or the first mistake of syntax.
///
/// In the tree the first of two equal keys stands, and a 1 for a number that cannot be read.
pub fn parse(text: &str, file: FileId) -> Result<(Node, Vec<Refused>), Refused> {
    guard::check(text)?;
    parse_part(text, 0..text.len(), file, Path::root())
}

/// The same of the value that stands in a part of a text whose depth and size were checked; the value's path is `path`.
pub fn parse_part(text: &str, part: Range<usize>, file: FileId, path: Path) -> Result<(Node, Vec<Refused>), Refused> {
    let start = part.start;
    let text = text.get(part).unwrap_or_default();
    let parsed = parse_to_ast(text, &CollectOptions::default(), &options()).map_err(|error| {
        let at = on_characters(text, error.range().start..error.range().end);
        let (message, help) = explain(error.kind(), text.get(at.clone()).unwrap_or_default());
        Refused { at: start + at.start..start + at.end, path: None, message, help }
    })?;
    let Some(value) = parsed.value else {
        let help = Some("the smallest scene is {\"version\": 1, \"objects\": [{\"shape\": \"sphere\"}]}".into());
        return Err(Refused { at: 0..0, path: None, message: "the file is empty".into(), help });
    };
    let mut reader = Reader { file, start, path, refused: Vec::new() };
    let node = reader.node(value);
    Ok((node, reader.refused))
}

/// Strict JSON plus comments and trailing commas.
fn options() -> ParseOptions {
    ParseOptions {
        allow_comments: true,
        allow_trailing_commas: true,
        allow_loose_object_property_names: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    }
}

/// The parser's complaint about `word` in our words, with what to do.
fn explain(kind: &Kind, word: &str) -> (String, Option<String>) {
    let small = word.to_ascii_lowercase();
    let quoted = format!("write \"{word}\"");
    let (message, help) = match kind {
        Kind::UnterminatedObject => ("this `{` is never closed by `}`", ""),
        Kind::UnterminatedArray => ("this `[` is never closed by `]`", ""),
        Kind::UnterminatedCommentBlock => ("this comment is never closed by `*/`", ""),
        Kind::UnexpectedCloseBrace => ("unexpected `}`", ""),
        Kind::UnexpectedCloseBracket => ("unexpected `]`", ""),
        Kind::UnexpectedComma => ("unexpected `,`", ""),
        Kind::UnexpectedColon => ("unexpected `:`", ""),
        Kind::ExpectedComma => ("a `,` is missing here", ""),
        Kind::ExpectedColonAfterObjectKey => ("a `:` and a value must follow the key", ""),
        Kind::ExpectedObjectValue => ("a value must follow the `:`", ""),
        Kind::ExpectedStringObjectProperty => ("keys stand in double quotes", quoted.as_str()),
        Kind::SingleQuotedStringsNotAllowed => ("strings stand in double quotes", ""),
        Kind::NonFiniteNumbersNotAllowed => ("numbers must be finite", ""),
        Kind::HexadecimalNumbersNotAllowed => ("numbers are decimal", "colours are written \"#rrggbb\", in quotes"),
        Kind::UnaryPlusNumbersNotAllowed => ("a number has no `+` in front", ""),
        Kind::BareDecimalPointNumbersNotAllowed => ("digits must stand on both sides of the point", "write 0.5"),
        Kind::UnexpectedWord | Kind::UnexpectedToken if matches!(small.as_str(), "true" | "false" | "null") => {
            ("true, false and null are written in small letters", "")
        }
        Kind::UnexpectedWord | Kind::UnexpectedToken => {
            ("words stand in double quotes", "only true, false and null stand without")
        }
        Kind::MultipleRootJsonValues => ("a file holds one value, and it ended before this", ""),
        other => return (format!("this is not JSON: {}", lower_first(&other.to_string())), None),
    };
    (message.to_owned(), (!help.is_empty()).then(|| help.to_owned()))
}

fn lower_first(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_lowercase().chain(characters).collect())
}

/// A range inside the text that cuts no character.
fn on_characters(text: &str, range: Range<usize>) -> Range<usize> {
    let start = text.floor_char_boundary(range.start.min(text.len()));
    start..text.ceil_char_boundary(range.end.clamp(start, text.len()))
}

/// The nearest number that 64 bits can hold.
fn exact(text: &str) -> Option<Number> {
    if let Ok(whole) = text.parse::<i64>() {
        return Some(whole.into());
    }
    if let Ok(whole) = text.parse::<u64>() {
        return Some(whole.into());
    }
    Number::from_f64(text.parse().ok()?)
}

struct Reader {
    file: FileId,
    /// Where the part that is read begins.
    start: usize,
    path: Path,
    refused: Vec<Refused>,
}

impl Reader {
    fn place(&self, range: Bytes) -> Option<Place> {
        let at = |byte: usize| u32::try_from(self.start + byte).unwrap_or(u32::MAX);
        Some(Place { file: self.file, start: at(range.start), end: at(range.end) })
    }

    fn refuse(&mut self, range: Bytes, message: String, help: &str) {
        let at = self.start + range.start..self.start + range.end;
        let path = Some(self.path.clone());
        self.refused.push(Refused { at, path, message, help: Some(help.to_owned()) });
    }

    fn node(&mut self, value: ast::Value<'_>) -> Node {
        let (range, value) = match value {
            ast::Value::NullKeyword(null) => (null.range, Value::Null),
            ast::Value::BooleanLit(literal) => (literal.range, Value::Bool(literal.value)),
            ast::Value::StringLit(literal) => (literal.range, Value::String(literal.value.into_owned())),
            ast::Value::NumberLit(literal) => (literal.range, Value::Number(self.number(&literal))),
            ast::Value::Array(array) => {
                let elements = array.elements.into_iter().enumerate();
                let elements = elements.map(|(i, element)| self.inside(Step::Index(i), element)).collect();
                (array.range, Value::Array(Arc::new(elements)))
            }
            ast::Value::Object(object) => (object.range, Value::Object(Arc::new(self.members(object)))),
        };
        Node { place: self.place(range), value }
    }

    fn inside(&mut self, step: Step, value: ast::Value<'_>) -> Node {
        self.path.push(step);
        let node = self.node(value);
        self.path.pop();
        node
    }

    fn number(&mut self, literal: &ast::NumberLit<'_>) -> Number {
        exact(literal.value).unwrap_or_else(|| {
            let message = format!("`{}` is too large a number", literal.value);
            self.refuse(literal.range, message, "numbers reach up to 3.4e38");
            1.into()
        })
    }

    fn members(&mut self, object: ast::Object<'_>) -> Members {
        let mut members = Members::default();
        for property in object.properties {
            let (key, range) = match property.name {
                ast::ObjectPropName::String(name) => (name.value.into_owned(), name.range),
                ast::ObjectPropName::Word(name) => (name.value.to_owned(), name.range),
            };
            let node = self.inside(Step::Key(key.clone()), property.value);
            match members.entry(key) {
                Entry::Vacant(entry) => {
                    entry.insert(Member { key_place: self.place(range), node });
                }
                Entry::Occupied(entry) => {
                    self.path.push(Step::Key(entry.key().clone()));
                    let message = format!("`{}` stands here a second time", entry.key());
                    self.refuse(range, message, "join the two, or remove one");
                    self.path.pop();
                }
            }
        }
        members
    }
}
