//! Text → tree. Syntax by `jsonc-parser`; comments and trailing commas are the only liberties.

use super::guard::{self, Refused};
use super::source::{FileId, Place};
use super::tree::{Member, Members, Node, Value};
use jsonc_parser::ast;
use jsonc_parser::errors::ParseErrorKind as Kind;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use serde_json::Number;
use std::ops::Range;

/// The tree of a text, or its mistakes: the first of syntax, or every duplicate key and unreadable number.
pub fn parse(text: &str, file: FileId) -> Result<Node, Vec<Refused>> {
    guard::check(text).map_err(|refused| vec![refused])?;
    let parsed = parse_to_ast(text, &CollectOptions::default(), &options()).map_err(|error| {
        let (message, help) = explain(error.kind());
        vec![Refused { at: on_characters(text, error.range().start..error.range().end), message, help }]
    })?;
    let Some(value) = parsed.value else {
        let help = Some("the smallest scene is {\"version\": 1, \"objects\": [{\"shape\": \"sphere\"}]}".into());
        return Err(vec![Refused { at: 0..0, message: "the file is empty".into(), help }]);
    };
    let mut reader = Reader { file, refused: Vec::new() };
    let node = reader.node(value);
    if reader.refused.is_empty() { Ok(node) } else { Err(reader.refused) }
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

/// The parser's complaint in our words, with what to do.
fn explain(kind: &Kind) -> (String, Option<String>) {
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
        Kind::ExpectedStringObjectProperty => ("keys stand in double quotes", "write \"version\": 1"),
        Kind::SingleQuotedStringsNotAllowed => ("strings stand in double quotes", ""),
        Kind::NonFiniteNumbersNotAllowed => ("numbers must be finite", ""),
        Kind::HexadecimalNumbersNotAllowed => ("numbers are decimal", "colours are written \"#rrggbb\", in quotes"),
        Kind::UnaryPlusNumbersNotAllowed => ("a number has no `+` in front", ""),
        Kind::BareDecimalPointNumbersNotAllowed => ("digits must stand on both sides of the point", "write 0.5"),
        Kind::UnexpectedWord => ("words stand in double quotes", "only true, false and null stand without"),
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
    refused: Vec<Refused>,
}

impl Reader {
    fn place(&self, range: jsonc_parser::common::Range) -> Option<Place> {
        let at = |byte: usize| u32::try_from(byte).unwrap_or(u32::MAX);
        Some(Place { file: self.file, start: at(range.start), end: at(range.end) })
    }

    fn refuse(&mut self, range: jsonc_parser::common::Range, message: String) {
        self.refused.push(Refused { at: range.start..range.end, message, help: None });
    }

    fn node(&mut self, value: ast::Value<'_>) -> Node {
        let (range, value) = match value {
            ast::Value::NullKeyword(null) => (null.range, Value::Null),
            ast::Value::BooleanLit(literal) => (literal.range, Value::Bool(literal.value)),
            ast::Value::StringLit(literal) => (literal.range, Value::String(literal.value.into_owned())),
            ast::Value::NumberLit(literal) => (literal.range, self.number(&literal)),
            ast::Value::Array(array) => {
                (array.range, Value::Array(array.elements.into_iter().map(|element| self.node(element)).collect()))
            }
            ast::Value::Object(object) => (object.range, Value::Object(self.members(object))),
        };
        Node { place: self.place(range), value }
    }

    fn number(&mut self, literal: &ast::NumberLit<'_>) -> Value {
        match exact(literal.value) {
            Some(number) => Value::Number(number),
            None => {
                self.refuse(literal.range, format!("`{}` is not a number that a computer can hold", literal.value));
                Value::Null
            }
        }
    }

    fn members(&mut self, object: ast::Object<'_>) -> Members {
        let mut members = Members::default();
        for property in object.properties {
            let (key, range) = match property.name {
                ast::ObjectPropName::String(name) => (name.value.into_owned(), name.range),
                ast::ObjectPropName::Word(name) => (name.value.to_owned(), name.range),
            };
            let member = Member { key_place: self.place(range), node: self.node(property.value) };
            match members.entry(key) {
                indexmap::map::Entry::Vacant(entry) => {
                    entry.insert(member);
                }
                indexmap::map::Entry::Occupied(entry) => {
                    self.refuse(range, format!("`{}` stands here a second time", entry.key()));
                }
            }
        }
        members
    }
}
