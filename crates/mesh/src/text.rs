//! Scanner of words, lines and numbers, shared by the readers of OBJ and its libraries of materials
//! (MTL), text PLY and text STL.
//!
//! Every byte up to and including the space (0x20) separates words. A line ends with `\n`, `\r\n`
//! or a lone `\r`.

use crate::error::{FilePosition, MeshErrorKind, quote};
use crate::pieces::line_break;
use memchr::memchr2;

/// Reads a text word by word and tracks the line number.
#[derive(Clone)]
pub struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    obj_rules: bool,
}

impl<'a> Scanner<'a> {
    /// Creates a scanner at the first byte, on line 1.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1, obj_rules: false }
    }

    /// Sets the number of the first line.
    pub fn starting_at_line(self, line: u64) -> Self {
        Self { line, ..self }
    }

    /// Creates a scanner with the rules of OBJ: `#` starts a comment, and `\` at the end of a line
    /// continues the line.
    pub fn with_obj_rules(bytes: &'a [u8]) -> Self {
        Self { obj_rules: true, ..Self::new(bytes) }
    }

    /// Number of the current line.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Line of the last word read.
    pub fn place(&self) -> FilePosition {
        FilePosition::Line(self.line)
    }

    /// Number of bytes scanned.
    pub fn position(&self) -> usize {
        self.at
    }

    /// The text not scanned yet.
    pub fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Returns the next word of this line; `None` at the end of the line.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            self.skip_blanks();
            let rest = self.rest();
            let length = rest.iter().position(|&byte| byte <= b' ').unwrap_or(rest.len());
            let (word, after) = rest.split_at_checked(length)?;
            if self.obj_rules && word.first() == Some(&b'#') {
                self.skip_to_line_end();
                return None;
            }
            if self.obj_rules
                && let Some(before) = word.strip_suffix(b"\\")
                && line_break(after) > 0
            {
                self.at += before.len();
                if !before.is_empty() {
                    return Some(before);
                }
                self.at += 1;
                self.break_line();
                continue;
            }
            self.at += length;
            return (length > 0).then_some(word);
        }
    }

    /// Returns the next word of this line or a later one; `None` at the end of the text.
    pub fn word_anywhere(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.word() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    /// Whether this line has no more words.
    pub fn at_line_end(&self) -> bool {
        Scanner { bytes: self.bytes, ..*self }.word().is_none()
    }

    /// Advances to the first word of the next line that has one, or of this line; `false` at the
    /// end of the text.
    pub fn skip_empty_lines(&mut self) -> bool {
        loop {
            self.skip_blanks();
            if self.rest().is_empty() {
                return false;
            }
            if !self.break_line() {
                return true;
            }
        }
    }

    /// Skips the rest of this line and its end; `false` if there is no next line.
    pub fn next_line(&mut self) -> bool {
        let start = self.at;
        self.skip_to_line_end();
        if self.obj_rules && self.bytes.get(start..self.at).is_some_and(|line| line.ends_with(b"\\")) {
            // The line continues, unless the `\` ends a comment.
            self.at = start;
            while self.word().is_some() {}
            self.skip_to_line_end();
        }
        self.break_line()
    }

    /// Returns the rest of this line without its end.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        self.skip_to_line_end();
        rest.get(..rest.len() - self.rest().len()).unwrap_or_default()
    }

    /// Parses the next word of this line as a number, which may be infinite or NaN. `what` names it
    /// in errors.
    pub fn real(&mut self, what: &str) -> Result<f32, MeshErrorKind> {
        let word = self.word();
        word.and_then(real).ok_or_else(|| self.expected(&format!("a number for {what}"), word))
    }

    /// Parses the next word of this line as a finite number.
    pub fn finite(&mut self, what: &str) -> Result<f32, MeshErrorKind> {
        finite(self.real(what)?, self.place(), what)
    }

    /// Creates an error: `what` was expected, `found` (`None`: the end of the line) was found.
    pub fn expected(&self, what: &str, found: Option<&[u8]>) -> MeshErrorKind {
        let end = if self.rest().is_empty() { "the end of the file" } else { "the end of the line" };
        let found = found.map_or_else(|| end.to_owned(), quote);
        self.place().error(format!("expected {what}, found {found}"))
    }

    fn skip_blanks(&mut self) {
        let blank = |byte: &u8| *byte <= b' ' && *byte != b'\n' && *byte != b'\r';
        self.at += self.rest().iter().take_while(|byte| blank(byte)).count();
    }

    fn skip_to_line_end(&mut self) {
        let rest = self.rest();
        self.at += memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
    }

    fn break_line(&mut self) -> bool {
        let length = line_break(self.rest());
        self.at += length;
        self.line += u64::from(length > 0);
        length > 0
    }
}

/// The bytes of a file without a UTF-8 byte order mark at their start.
pub fn without_byte_order_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Parses a word as a number, rounded once to the nearest `f32`. Accepts `inf` and `nan`.
pub fn real(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Whether a word is a form in which C libraries write a number that is none: `nan(ind)`,
/// `-nan(snan)`, `1.#IND`, `-1.#QNAN0`.
pub(crate) fn is_nan_of_c(word: &[u8]) -> bool {
    let unsigned = word.strip_prefix(b"-").or_else(|| word.strip_prefix(b"+")).unwrap_or(word).to_ascii_lowercase();
    unsigned.starts_with(b"nan(") && unsigned.ends_with(b")")
        || unsigned.starts_with(b"1.#ind")
        || unsigned.starts_with(b"1.#qnan")
}

/// Parses a word as an integer.
pub(crate) fn integer(word: &[u8]) -> Option<i64> {
    let (digits, negative) = match word {
        [b'-', digits @ ..] => (digits, true),
        [b'+', digits @ ..] => (digits, false),
        digits => (digits, false),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0_i64;
    for byte in digits {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        value = value.checked_mul(10)?.checked_add(i64::from(digit))?;
    }
    Some(if negative { -value } else { value })
}

/// Returns the value, or an error if it is infinite or NaN.
pub(crate) fn finite(value: f32, place: FilePosition, what: &str) -> Result<f32, MeshErrorKind> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(place.error(format!("expected a finite number for {what}, found {value}")))
}

/// Converts an integral floating-point number to an integer; an error if it has a fraction or
/// exceeds 2^53.
pub(crate) fn whole(value: f64, place: FilePosition, what: &str) -> Result<i64, MeshErrorKind> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    if value.trunc() == value && value.abs() <= EXACT {
        return Ok(value as i64);
    }
    Err(place.error(format!("expected {what}, found {value}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(mut scanner: Scanner<'_>) -> Vec<(u64, String)> {
        let mut found = Vec::new();
        while let Some(word) = scanner.word_anywhere() {
            let FilePosition::Line(line) = scanner.place() else { panic!("a text has lines") };
            found.push((line, String::from_utf8_lossy(word).into_owned()));
        }
        found
    }

    fn pairs(list: &[(u64, &str)]) -> Vec<(u64, String)> {
        list.iter().map(|(line, word)| (*line, (*word).to_owned())).collect()
    }

    #[test]
    fn line_ends_of_three_systems_count_once() {
        let found = words(Scanner::new(b"a b\nc\r\nd\re\r\n\r\n\tf"));
        assert_eq!(found, pairs(&[(1, "a"), (1, "b"), (2, "c"), (3, "d"), (4, "e"), (6, "f")]));
    }

    #[test]
    fn comments_and_line_continuations_apply_only_to_obj() {
        let text = b"f 1 \\\r\n 2\\\n3 # not 4 \\\nv #x\n\\";
        let found = words(Scanner::with_obj_rules(text));
        let expected = [(1, "f"), (1, "1"), (2, "2"), (3, "3"), (4, "v"), (5, "\\")];
        assert_eq!(found, pairs(&expected));
        assert_eq!(words(Scanner::new(b"a \\\n#b")), pairs(&[(1, "a"), (1, "\\"), (2, "#b")]));
    }

    #[test]
    fn next_line_follows_continuations() {
        let mut scanner = Scanner::with_obj_rules(b"g a \\\nb c\nv");
        assert_eq!(scanner.word(), Some(&b"g"[..]));
        assert!(scanner.next_line());
        assert_eq!(scanner.word(), Some(&b"v"[..]));
        assert_eq!(scanner.place(), FilePosition::Line(3));
        assert!(!scanner.next_line());
    }

    #[test]
    fn integers_are_parsed_without_overflow() {
        let cases: [(&[u8], Option<i64>); 9] = [
            (b"0", Some(0)),
            (b"-17", Some(-17)),
            (b"+8", Some(8)),
            (b"9223372036854775807", Some(i64::MAX)),
            (b"9223372036854775808", None),
            (b"", None),
            (b"-", None),
            (b"1.0", None),
            (b"1:", None),
        ];
        for (word, value) in cases {
            assert_eq!(integer(word), value, "{}", String::from_utf8_lossy(word));
        }
    }

    #[test]
    fn numbers_are_finite_or_refused() {
        let mut scanner = Scanner::new(b"1.5e-3 .5 5. +2 1e39 nan 1,5 \xff");
        assert_eq!(scanner.finite("x").ok(), Some(1.5e-3));
        assert_eq!(scanner.finite("x").ok(), Some(0.5));
        assert_eq!(scanner.finite("x").ok(), Some(5.0));
        assert_eq!(scanner.finite("x").ok(), Some(2.0));
        let messages: Vec<String> = (0..5).map(|_| scanner.finite("x").unwrap_err().to_string()).collect();
        assert_eq!(messages[0], "line 1: expected a finite number for x, found inf");
        assert_eq!(messages[1], "line 1: expected a finite number for x, found NaN");
        assert_eq!(messages[2], "line 1: expected a number for x, found '1,5'");
        assert_eq!(messages[3], "line 1: expected a number for x, found '\u{fffd}'");
        assert_eq!(messages[4], "line 1: expected a number for x, found the end of the file");
    }
}
