//! Parser from text to tree, for JSON with comments and trailing commas.
//!
//! The parser builds nodes directly from the text. `jsonc-parser` decodes strings with escapes and
//! explains the first error of a text that this parser rejects; building nodes from its syntax tree
//! took more than twice the time.

use super::explain::explain;
use super::limits::{self, SyntaxError};
use super::members::Members;
use super::source::{FileId, SourceSpan};
use super::tree::{Member, Node, Value};
use crate::path::PathRef;
use jsonc_parser::tokens::Token;
use jsonc_parser::{CollectOptions, ParseOptions, ParseResult, Scanner, ScannerOptions, parse_to_ast};
use serde_json::Number;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// Parses a text. Returns the tree with an error for each duplicate key and unreadable number, or
/// the first syntax error. The tree keeps the first of two equal keys, and 1 for an unreadable
/// number.
pub fn parse(text: &str, file: FileId) -> Result<(Node, Vec<SyntaxError>), SyntaxError> {
    limits::check(text)?;
    parse_part(text, 0..text.len(), file, &PathRef::Root)
}

/// Parses the value in a part of a text whose depth and size were checked. `at` is the path of the
/// value.
pub fn parse_part(
    text: &str,
    part: Range<usize>,
    file: FileId,
    at: &PathRef<'_>,
) -> Result<(Node, Vec<SyntaxError>), SyntaxError> {
    let start = part.start;
    let text = text.get(part).unwrap_or_default();
    let mut reader = Reader { text, next: 0, file, start, errors: Vec::new() };
    match reader.document(at) {
        Some(node) => Ok((node, reader.errors)),
        None => Err(first_error(text, start)),
    }
}

/// First syntax error in a text that begins at the byte `start` of its file.
fn first_error(text: &str, start: usize) -> SyntaxError {
    let (at, message, help) = match parse_to_ast(text, &CollectOptions::default(), &strict()) {
        Err(error) => {
            let range = error.range();
            let at = on_characters(text, range.start..range.end);
            let (message, help) = explain(error.kind(), text.get(at.clone()).unwrap_or_default());
            (start + at.start..start + at.end, message, help)
        }
        Ok(ParseResult { value: None, .. }) => {
            let help = Some("the smallest scene is {\"version\": 1, \"objects\": [{\"shape\": \"sphere\"}]}".into());
            (0..0, "the file is empty".to_owned(), help)
        }
        // Both parsers accept the same texts, so only a bug leads here.
        Ok(_) => (start..start + text.len(), "invalid JSON".to_owned(), None),
    };
    SyntaxError { at, path: None, message, help }
}

/// Parser options: strict JSON plus comments and trailing commas.
fn strict() -> ParseOptions {
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

/// Scanner options: strings of strict JSON.
const STRICT: ScannerOptions = ScannerOptions {
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// Extends a range to character boundaries within the text.
fn on_characters(text: &str, range: Range<usize>) -> Range<usize> {
    let start = text.floor_char_boundary(range.start.min(text.len()));
    start..text.ceil_char_boundary(range.end.clamp(start, text.len()))
}

/// Parses a number as `i64`, `u64` or else the nearest `f64`; `None` if it is not finite.
fn parse_number(text: &str) -> Option<Number> {
    if let Ok(whole) = text.parse::<i64>() {
        return Some(whole.into());
    }
    if let Ok(whole) = text.parse::<u64>() {
        return Some(whole.into());
    }
    Number::from_f64(text.parse().ok()?)
}

/// Recursive-descent parser of a text. Its methods return `None` at the first syntax error.
struct Reader<'t> {
    text: &'t str,
    /// Offset of the next byte.
    next: usize,
    file: FileId,
    /// Offset of the text in its file.
    start: usize,
    errors: Vec<SyntaxError>,
}

impl<'t> Reader<'t> {
    /// Parses the text's only value.
    fn document(&mut self, at: &PathRef<'_>) -> Option<Node> {
        self.skip_blanks();
        let node = self.node(at)?;
        self.skip_blanks();
        (self.next == self.text.len()).then_some(node)
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.next).copied()
    }

    /// Consumes the next byte if it is `byte`.
    fn take(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.next += usize::from(is_next);
        is_next
    }

    /// Skips white space and comments.
    fn skip_blanks(&mut self) {
        while let Some(byte) = self.peek() {
            self.next = match byte {
                b' ' | b'\t' | b'\n' | b'\r' | b'\x0b' | b'\x0c' => self.next + 1,
                b'/' => match limits::skip_comment(self.text.as_bytes(), self.next) {
                    last if last > self.next => last + 1,
                    _ => return,
                },
                0x80.. => match self.text.get(self.next..).and_then(|rest| rest.chars().next()) {
                    Some(blank) if blank.is_whitespace() => self.next + blank.len_utf8(),
                    _ => return,
                },
                _ => return,
            };
        }
    }

    fn place(&self, range: Range<usize>) -> Option<SourceSpan> {
        let at = |byte: usize| u32::try_from(self.start + byte).unwrap_or(u32::MAX);
        Some(SourceSpan { file: self.file, start: at(range.start), end: at(range.end) })
    }

    fn add_error(&mut self, range: Range<usize>, at: &PathRef<'_>, message: String, help: &str) {
        let bytes = self.start + range.start..self.start + range.end;
        self.errors.push(SyntaxError { at: bytes, path: Some(at.into()), message, help: Some(help.to_owned()) });
    }

    fn node(&mut self, at: &PathRef<'_>) -> Option<Node> {
        let start = self.next;
        let value = match self.peek()? {
            b'{' => Value::Object(Arc::new(self.members(at)?)),
            b'[' => Value::Array(Arc::new(self.elements(at)?)),
            b'"' => Value::String(self.string()?.into_owned()),
            b'-' | b'0'..=b'9' => Value::Number(self.number(at)?),
            b't' => self.word("true", Value::Bool(true))?,
            b'f' => self.word("false", Value::Bool(false))?,
            b'n' => self.word("null", Value::Null)?,
            _ => return None,
        };
        Some(Node { place: self.place(start..self.next), value })
    }

    fn word(&mut self, word: &str, value: Value) -> Option<Value> {
        let rest = self.text.get(self.next..)?;
        self.next += word.len();
        rest.starts_with(word).then_some(value)
    }

    fn string(&mut self) -> Option<Cow<'t, str>> {
        let start = self.next;
        if !self.take(b'"') {
            return None;
        }
        let rest = self.text.get(self.next..)?;
        let length = rest.bytes().position(|byte| matches!(byte, b'"' | b'\\'))?;
        let (plain, rest) = rest.split_at_checked(length)?;
        if rest.starts_with('"') {
            self.next += length + 1;
            return Some(Cow::Borrowed(plain));
        }
        self.next = limits::skip_string(self.text.as_bytes(), start) + 1;
        match Scanner::new(self.text.get(start..self.next)?, &STRICT).scan().ok()?? {
            Token::String(text) => Some(text),
            _ => None,
        }
    }

    fn number(&mut self, at: &PathRef<'_>) -> Option<Number> {
        let start = self.next;
        self.take(b'-');
        if !self.take(b'0') {
            self.digits()?;
        }
        if self.take(b'.') {
            self.digits()?;
        }
        if self.take(b'e') || self.take(b'E') {
            let _ = self.take(b'-') || self.take(b'+');
            self.digits()?;
        }
        let text = self.text.get(start..self.next)?;
        Some(parse_number(text).unwrap_or_else(|| {
            let message = format!("number `{text}` is too large");
            self.add_error(start..self.next, at, message, "the largest number is 3.4e38");
            1.into()
        }))
    }

    /// Consumes one or more digits.
    fn digits(&mut self) -> Option<()> {
        let start = self.next;
        while self.peek().is_some_and(|byte| byte.is_ascii_digit()) {
            self.next += 1;
        }
        (self.next > start).then_some(())
    }

    fn elements(&mut self, at: &PathRef<'_>) -> Option<Vec<Node>> {
        let mut elements = Vec::new();
        self.next += 1;
        loop {
            self.skip_blanks();
            if self.take(b']') {
                return Some(elements);
            }
            elements.push(self.node(&at.index(elements.len()))?);
            self.skip_blanks();
            if !self.take(b',') && self.peek() != Some(b']') {
                return None;
            }
        }
    }

    fn members(&mut self, at: &PathRef<'_>) -> Option<Members> {
        let mut members = Members::default();
        self.next += 1;
        loop {
            self.skip_blanks();
            if self.take(b'}') {
                return Some(members);
            }
            self.member(&mut members, at)?;
            self.skip_blanks();
            if !self.take(b',') && self.peek() != Some(b'}') {
                return None;
            }
        }
    }

    fn member(&mut self, members: &mut Members, at: &PathRef<'_>) -> Option<()> {
        let start = self.next;
        let key = self.string()?;
        let range = start..self.next;
        self.skip_blanks();
        if !self.take(b':') {
            return None;
        }
        self.skip_blanks();
        let at = at.key(&key);
        let node = self.node(&at)?;
        if members.contains_key(&key) {
            let message = format!("duplicate key `{key}`");
            self.add_error(range, &at, message, "merge the two values or remove one");
        } else {
            let key_place = self.place(range);
            members.append(key.into_owned(), Member { key_place, node });
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jsonc_parser::ast;
    use jsonc_parser::common::Ranged;

    const TEXT: &str = "/* [ */ {\"a\": [1, -2.5e+3, 0.25, 1e400, true, false, null, ], // ]\n \u{a0}\"a\": \"x\", \
        \"\\u00e9\\ud83d\\ude00\": \"\u{e9}\\n\\\"\", \"b\": {}, \"c\": [[], {\"d\": \"\"}, -0, 10]}";
    const PIECES: [&str; 32] = [
        "{", "}", "[", "]", ",", ":", "\"", "\\", "/", "*", "//", "/*", "*/", "\n", "\r", " ", "\u{a0}", "\u{e9}", "0",
        "7", "-", "+", ".", "e", "x", "\\u12", "\\'", "'", "true", "nul", "\t", "\u{b}",
    ];

    /// Tree of a text, converted from the syntax tree of `jsonc-parser`.
    fn expected(value: &ast::Value<'_>) -> Node {
        let place = |range: &dyn Ranged| {
            let at = |byte: usize| u32::try_from(byte).unwrap();
            Some(SourceSpan { file: FileId::MAIN, start: at(range.start()), end: at(range.end()) })
        };
        let tree = match value {
            ast::Value::NullKeyword(_) => Value::Null,
            ast::Value::BooleanLit(literal) => Value::Bool(literal.value),
            ast::Value::StringLit(literal) => Value::String(literal.value.to_string()),
            ast::Value::NumberLit(literal) => Value::Number(parse_number(literal.value).unwrap_or(1.into())),
            ast::Value::Array(array) => Value::Array(Arc::new(array.elements.iter().map(expected).collect())),
            ast::Value::Object(object) => {
                let mut members = Members::default();
                for property in object.properties.iter().rev() {
                    let ast::ObjectPropName::String(name) = &property.name else { panic!("a key without quotes") };
                    let member = Member { key_place: place(name), node: expected(&property.value) };
                    members.insert(name.value.to_string(), member);
                }
                Value::Object(Arc::new(members))
            }
        };
        Node { place: place(value), value: tree }
    }

    fn check(text: &str) -> bool {
        let parsed = parse_to_ast(text, &CollectOptions::default(), &strict());
        let found = parse_part(text, 0..text.len(), FileId::MAIN, &PathRef::Root);
        match (parsed.ok().and_then(|parsed| parsed.value), found) {
            (Some(value), Ok((node, _))) => assert_eq!(node, expected(&value), "{text:?}"),
            (None, Err(error)) => assert_ne!(error.message, "invalid JSON", "{text:?}"),
            (value, found) => panic!("{text:?}: {value:?}, {found:?}"),
        }
        parse_part(text, 0..text.len(), FileId::MAIN, &PathRef::Root).is_ok()
    }

    #[test]
    fn both_parsers_accept_the_same_texts_and_read_them_alike() {
        assert!(check(TEXT));
        let starts: Vec<usize> = (0..=TEXT.len()).filter(|at| TEXT.is_char_boundary(*at)).collect();
        let (mut accepted, mut refused) = (0, 0);
        for (i, at) in starts.iter().enumerate() {
            for piece in PIECES {
                for end in starts.iter().skip(i).take(3) {
                    match check(&format!("{}{piece}{}", &TEXT[..*at], &TEXT[*end..])) {
                        true => accepted += 1,
                        false => refused += 1,
                    }
                }
            }
            check(&TEXT[..*at]);
            check(&TEXT[*at..]);
        }
        assert!(accepted > 1000 && refused > 1000, "{accepted} {refused}");
    }
}
