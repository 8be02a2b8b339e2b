//! Splits text into numbers, names and signs.

use crate::error::{ExpressionResult, fail};
use std::ops::Range;

/// Smallest part of an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Token<'t> {
    /// Number.
    Number(f64),
    /// Name of a variable or function, or of a component of a variable: `ball.x`.
    Name(&'t str),
    /// Operator, parenthesis or comma.
    Sign(&'t str),
    /// End of the text.
    End,
}

const SIGNS: [&str; 17] = ["<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "%", "^", "(", ")", ",", "=", "!"];

/// Token that begins at or after `from`, and its byte range.
pub fn next(text: &str, from: usize) -> ExpressionResult<(Token<'_>, Range<usize>)> {
    let rest = text.get(from..).unwrap_or_default();
    let blank = rest.len() - rest.trim_start().len();
    let (start, rest) = (from + blank, rest.trim_start());
    let Some(first) = rest.chars().next() else { return Ok((Token::End, start..start)) };
    if first.is_ascii_digit() || first == '.' {
        let length = number_length(rest.as_bytes());
        let at = start..start + length;
        let digits = rest.get(..length).unwrap_or_default();
        return match digits.parse() {
            Ok(value) => Ok((Token::Number(value), at)),
            Err(_) => fail(at, format!("`{digits}` is not a number")),
        };
    }
    if first.is_ascii_alphabetic() || first == '_' {
        let length = name_length(rest.as_bytes());
        return Ok((Token::Name(rest.get(..length).unwrap_or_default()), start..start + length));
    }
    match SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
        Some(sign) => Ok((Token::Sign(sign), start..start + sign.len())),
        None => {
            let at = start..start + first.len_utf8();
            fail(at, format!("`{first}` has no meaning in an expression"))
        }
    }
}

/// Length of a name in bytes: letters, digits and _, and at most one point, before a letter.
fn name_length(bytes: &[u8]) -> usize {
    let word = |from: usize| bytes.iter().skip(from).take_while(|b| b.is_ascii_alphanumeric() || **b == b'_').count();
    let base = word(0);
    let component = bytes.get(base) == Some(&b'.') && bytes.get(base + 1).is_some_and(u8::is_ascii_alphabetic);
    if component { base + 1 + word(base + 1) } else { base }
}

/// Length of a number in bytes: digits, a point, an exponent with its sign.
fn number_length(bytes: &[u8]) -> usize {
    let digits = |from: usize| bytes.iter().skip(from).take_while(|b| b.is_ascii_digit()).count();
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}
