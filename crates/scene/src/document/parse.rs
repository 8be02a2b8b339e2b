//! Text → tree. Tokens by `jsonc-parser`; comments and trailing commas are the only liberties.

use super::guard::{self, Refused};
use super::source::{FileId, Place};
use super::tree::{Member, Members, Node, Value};
use crate::path::Trail;
use jsonc_parser::errors::ParseErrorKind as Kind;
use jsonc_parser::tokens::Token;
use jsonc_parser::{Scanner, ScannerOptions};
use serde_json::Number;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// The tree of a text with every duplicate key and unreadable number in it, or the first mistake of syntax.
///
/// In the tree the first of two equal keys stands, and a 1 for a number that cannot be read.
pub fn parse(text: &str, file: FileId) -> Result<(Node, Vec<Refused>), Refused> {
    guard::check(text)?;
    parse_part(text, 0..text.len(), file, &Trail::Root)
}

/// The same of the value that stands in a part of a text whose depth and size were checked; the value's path is `at`.
pub fn parse_part(
    text: &str,
    part: Range<usize>,
    file: FileId,
    at: &Trail<'_>,
) -> Result<(Node, Vec<Refused>), Refused> {
    let start = part.start;
    let text = text.get(part).unwrap_or_default();
    let mut reader = Reader { text, scanner: Scanner::new(text, &STRICT), file, start, refused: Vec::new() };
    match reader.document(at)? {
        Some(node) => Ok((node, reader.refused)),
        None => {
            let help = Some("the smallest scene is {\"version\": 1, \"objects\": [{\"shape\": \"sphere\"}]}".into());
            Err(Refused { at: 0..0, path: None, message: "the file is empty".into(), help })
        }
    }
}

/// The tokens of strict JSON, and comments.
const STRICT: ScannerOptions = ScannerOptions {
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

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

/// Reads the tokens of a text into a tree.
struct Reader<'t> {
    text: &'t str,
    scanner: Scanner<'t>,
    file: FileId,
    /// Where the part that is read begins.
    start: usize,
    refused: Vec<Refused>,
}

impl<'t> Reader<'t> {
    /// The only value of the text; `None` if the text has none.
    fn document(&mut self, at: &Trail<'_>) -> Result<Option<Node>, Refused> {
        let node = match self.token()? {
            Some(token) => Some(self.node(token, at)?),
            None => None,
        };
        match self.token()? {
            Some(_) => Err(self.mistake(&Kind::MultipleRootJsonValues)),
            None => Ok(node),
        }
    }

    /// The next token that is no comment; `None` at the end of the text.
    fn token(&mut self) -> Result<Option<Token<'t>>, Refused> {
        loop {
            match self.scanner.scan() {
                Ok(Some(Token::CommentLine(_) | Token::CommentBlock(_))) => {}
                Ok(token) => return Ok(token),
                Err(error) => {
                    let range = error.range();
                    return Err(self.mistake_in(error.kind(), range.start..range.end));
                }
            }
        }
    }

    /// A mistake of syntax at the current token.
    fn mistake(&self, kind: &Kind) -> Refused {
        self.mistake_in(kind, self.range())
    }

    fn mistake_in(&self, kind: &Kind, range: Range<usize>) -> Refused {
        let at = on_characters(self.text, range);
        let (message, help) = explain(kind, self.text.get(at.clone()).unwrap_or_default());
        Refused { at: self.start + at.start..self.start + at.end, path: None, message, help }
    }

    /// Bytes of the current token.
    fn range(&self) -> Range<usize> {
        self.scanner.token_start()..self.scanner.token_end()
    }

    fn place(&self, range: Range<usize>) -> Option<Place> {
        let at = |byte: usize| u32::try_from(self.start + byte).unwrap_or(u32::MAX);
        Some(Place { file: self.file, start: at(range.start), end: at(range.end) })
    }

    fn refuse(&mut self, range: Range<usize>, at: &Trail<'_>, message: String, help: &str) {
        let bytes = self.start + range.start..self.start + range.end;
        self.refused.push(Refused { at: bytes, path: Some(at.into()), message, help: Some(help.to_owned()) });
    }

    /// The value that begins with the current token.
    fn node(&mut self, token: Token<'t>, at: &Trail<'_>) -> Result<Node, Refused> {
        let start = self.scanner.token_start();
        let value = match token {
            Token::OpenBrace => Value::Object(Arc::new(self.members(at)?)),
            Token::OpenBracket => Value::Array(Arc::new(self.elements(at)?)),
            Token::String(text) => Value::String(text.into_owned()),
            Token::Boolean(value) => Value::Bool(value),
            Token::Number(text) => Value::Number(self.number(text, at)),
            Token::Null => Value::Null,
            Token::CloseBracket => return Err(self.mistake(&Kind::UnexpectedCloseBracket)),
            Token::CloseBrace => return Err(self.mistake(&Kind::UnexpectedCloseBrace)),
            Token::Comma => return Err(self.mistake(&Kind::UnexpectedComma)),
            Token::Colon => return Err(self.mistake(&Kind::UnexpectedColon)),
            Token::Word(_) | Token::CommentLine(_) | Token::CommentBlock(_) => {
                return Err(self.mistake(&Kind::UnexpectedWord));
            }
        };
        Ok(Node { place: self.place(start..self.scanner.token_end()), value })
    }

    fn number(&mut self, text: &str, at: &Trail<'_>) -> Number {
        exact(text).unwrap_or_else(|| {
            self.refuse(self.range(), at, format!("`{text}` is too large a number"), "numbers reach up to 3.4e38");
            1.into()
        })
    }

    /// The elements of an array after its `[`.
    fn elements(&mut self, at: &Trail<'_>) -> Result<Vec<Node>, Refused> {
        let start = self.scanner.token_start();
        let mut elements = Vec::new();
        let mut token = self.token()?;
        loop {
            match token {
                Some(Token::CloseBracket) => return Ok(elements),
                Some(token) => elements.push(self.node(token, &at.index(elements.len()))?),
                None => return Err(self.mistake_in(&Kind::UnterminatedArray, start..self.scanner.token_end())),
            }
            let end = self.scanner.token_end();
            token = match self.token()? {
                Some(Token::Comma) => self.token()?,
                Some(Token::OpenBrace | Token::OpenBracket | Token::String(_)) => return Err(self.no_comma(end)),
                Some(Token::Boolean(_) | Token::Number(_) | Token::Null) => return Err(self.no_comma(end)),
                other => other,
            };
        }
    }

    /// The members of an object after its `{`.
    fn members(&mut self, at: &Trail<'_>) -> Result<Members, Refused> {
        let start = self.scanner.token_start();
        let mut members = Members::default();
        let mut token = self.token()?;
        loop {
            match token {
                Some(Token::CloseBrace) => return Ok(members),
                Some(Token::String(key)) => self.member(&mut members, key, at)?,
                Some(Token::Word(_) | Token::Number(_) | Token::Boolean(_) | Token::Null) => {
                    return Err(self.mistake(&Kind::ExpectedStringObjectProperty));
                }
                Some(_) => return Err(self.mistake(&Kind::UnexpectedTokenInObject)),
                None => return Err(self.mistake_in(&Kind::UnterminatedObject, start..self.scanner.token_end())),
            }
            let end = self.scanner.token_end();
            token = match self.token()? {
                Some(Token::Comma) => self.token()?,
                Some(Token::String(_) | Token::Word(_) | Token::Number(_)) => return Err(self.no_comma(end)),
                Some(Token::Boolean(_) | Token::Null) => return Err(self.no_comma(end)),
                other => other,
            };
        }
    }

    /// Reads the member that begins with the current token, its key.
    fn member(&mut self, members: &mut Members, key: Cow<'t, str>, at: &Trail<'_>) -> Result<(), Refused> {
        let range = self.range();
        if self.token()? != Some(Token::Colon) {
            return Err(self.mistake(&Kind::ExpectedColonAfterObjectKey));
        }
        let at = at.key(&key);
        let node = match self.token()? {
            Some(token) => self.node(token, &at)?,
            None => return Err(self.mistake(&Kind::ExpectedObjectValue)),
        };
        if members.contains_key(&*key) {
            let message = format!("`{key}` stands here a second time");
            self.refuse(range, &at, message, "join the two, or remove one");
        } else {
            let key_place = self.place(range);
            members.insert(key.into_owned(), Member { key_place, node });
        }
        Ok(())
    }

    /// The mistake of a comma that is missing behind the byte `end`.
    fn no_comma(&self, end: usize) -> Refused {
        self.mistake_in(&Kind::ExpectedComma, end..end)
    }
}
