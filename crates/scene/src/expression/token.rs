//! Characters → numbers, names and signs.

use super::ExpressionError;
use std::ops::Range;

/// The smallest parts of an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Token<'t> {
    /// A number.
    Number(f64),
    /// A name of a variable or function, or of a component of a variable: `ball.x`.
    Name(&'t str),
    /// An operator, parenthesis or comma.
    Sign(&'t str),
    /// Nothing is left.
    End,
}

const SIGNS: [&str; 17] = ["<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "%", "^", "(", ")", ",", "=", "!"];

/// The token that begins at or after `from`, and its bytes.
pub fn next(text: &str, from: usize) -> Result<(Token<'_>, Range<usize>), ExpressionError> {
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
            Err(_) => Err(ExpressionError { message: format!("`{digits}` is not a number"), at, help: None }),
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
            Err(ExpressionError { at, message: format!("`{first}` has no meaning in an expression"), help: None })
        }
    }
}

/// How many bytes a name takes: letters, digits and _, and once a point before a letter.
fn name_length(bytes: &[u8]) -> usize {
    let word = |from: usize| bytes.iter().skip(from).take_while(|b| b.is_ascii_alphanumeric() || **b == b'_').count();
    let base = word(0);
    let component = bytes.get(base) == Some(&b'.') && bytes.get(base + 1).is_some_and(u8::is_ascii_alphabetic);
    if component { base + 1 + word(base + 1) } else { base }
}

/// How many bytes a number takes: digits, a point, an exponent with its sign.
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
