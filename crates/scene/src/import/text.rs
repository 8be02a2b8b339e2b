//! Words, lines and numbers of a text file: what the readers of OBJ, ASCII PLY and ASCII STL share.
//!
//! Every byte up to the space separates words. A line ends with `\n`, `\r\n` or a lone `\r`.

use super::error::{Fault, Place, quote};
use super::pieces::line_break;
use memchr::memchr2;

/// Walks through a text word by word and knows the line it is on.
#[derive(Clone)]
pub(super) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    wavefront: bool,
}

impl<'a> Scanner<'a> {
    /// Starts at the first byte, on line 1.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1, wavefront: false }
    }

    /// Has the first line count as this one.
    pub fn starting_at_line(self, line: u64) -> Self {
        Self { line, ..self }
    }

    /// As [`Scanner::new`] by the rules of OBJ: `#` starts a comment, `\` at a line's end continues it.
    pub fn wavefront(bytes: &'a [u8]) -> Self {
        Self { wavefront: true, ..Self::new(bytes) }
    }

    /// Number of this line.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// The line of the word read last.
    pub fn place(&self) -> Place {
        Place::Line(self.line)
    }

    /// Bytes walked past so far.
    pub fn position(&self) -> usize {
        self.at
    }

    /// What has not been walked past.
    pub fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// The next word on this line; `None` at the line's end.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            self.skip_blanks();
            let rest = self.rest();
            let length = rest.iter().position(|&byte| byte <= b' ').unwrap_or(rest.len());
            let (word, after) = rest.split_at_checked(length)?;
            if self.wavefront && word.first() == Some(&b'#') {
                self.skip_to_line_end();
                return None;
            }
            if self.wavefront
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

    /// The next word on this line or a later one; `None` at the end of the text.
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

    /// Whether no word is left on this line.
    pub fn at_line_end(&self) -> bool {
        Scanner { bytes: self.bytes, ..*self }.word().is_none()
    }

    /// Goes to the start of the next line that has a word on it; `false` at the end of the text.
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

    /// Passes what is left of this line, and its end; `false` when there is no next line.
    pub fn next_line(&mut self) -> bool {
        let start = self.at;
        self.skip_to_line_end();
        if self.wavefront && self.bytes.get(start..self.at).is_some_and(|line| line.ends_with(b"\\")) {
            // The line goes on, unless a comment ends like this.
            self.at = start;
            while self.word().is_some() {}
            self.skip_to_line_end();
        }
        self.break_line()
    }

    /// What is left of this line, without its end.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        self.skip_to_line_end();
        rest.get(..rest.len() - self.rest().len()).unwrap_or_default()
    }

    /// The next word on this line as a number, which may be infinite or NaN.
    pub fn real(&mut self, what: &str) -> Result<f32, Fault> {
        let word = self.word();
        word.and_then(real).ok_or_else(|| self.expected(&format!("a number for {what}"), word))
    }

    /// The next word on this line as a finite number.
    pub fn finite(&mut self, what: &str) -> Result<f32, Fault> {
        finite(self.real(what)?, self.place(), what)
    }

    /// The fault of having met this word (`None`: the line's end) where something else should stand.
    pub fn expected(&self, what: &str, found: Option<&[u8]>) -> Fault {
        let end = if self.rest().is_empty() { "the end of the file" } else { "the end of the line" };
        let found = found.map_or_else(|| end.to_owned(), quote);
        self.place().fault(format!("expected {what}, found {found}"))
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

/// A word as a number, rounded once to the nearest `f32`; `inf` and `nan` are numbers here.
pub(super) fn real(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word as a whole number.
pub(super) fn integer(word: &[u8]) -> Option<i64> {
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

/// The value, or a fault when it is infinite or NaN.
pub(super) fn finite(value: f32, place: Place, what: &str) -> Result<f32, Fault> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(place.fault(format!("expected a finite number for {what}, found {value}")))
}

/// A floating-point number as the whole one that it is.
pub(super) fn whole(value: f64, place: Place, what: &str) -> Result<i64, Fault> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    if value.trunc() == value && value.abs() <= EXACT {
        return Ok(value as i64);
    }
    Err(place.fault(format!("expected {what}, found {value}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(mut scanner: Scanner<'_>) -> Vec<(u64, String)> {
        let mut found = Vec::new();
        while let Some(word) = scanner.word_anywhere() {
            let Place::Line(line) = scanner.place() else { panic!("a text has lines") };
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
    fn comments_and_continuations_only_in_wavefront() {
        let text = b"f 1 \\\r\n 2\\\n3 # not 4 \\\nv #x\n\\";
        let found = words(Scanner::wavefront(text));
        let expected = [(1, "f"), (1, "1"), (2, "2"), (3, "3"), (4, "v"), (5, "\\")];
        assert_eq!(found, pairs(&expected));
        assert_eq!(words(Scanner::new(b"a \\\n#b")), pairs(&[(1, "a"), (1, "\\"), (2, "#b")]));
    }

    #[test]
    fn next_line_follows_continuations() {
        let mut scanner = Scanner::wavefront(b"g a \\\nb c\nv");
        assert_eq!(scanner.word(), Some(&b"g"[..]));
        assert!(scanner.next_line());
        assert_eq!(scanner.word(), Some(&b"v"[..]));
        assert_eq!(scanner.place(), Place::Line(3));
        assert!(!scanner.next_line());
    }

    #[test]
    fn whole_numbers() {
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
