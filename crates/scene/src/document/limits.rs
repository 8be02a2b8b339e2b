//! Checks before a text is parsed: encoding, size, nesting depth and number of values.

use crate::path::{Path, Step};
use std::ops::Range;

/// Maximum size of a scene file, in bytes.
pub const MAX_BYTES: u64 = 64 << 20;
/// Maximum nesting depth of arrays and objects.
pub const MAX_DEPTH: usize = 64;
/// Maximum number of values in a file; larger meshes belong in mesh files.
pub const MAX_VALUES: usize = 4_000_000;

/// Error in a text and its location.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Byte range of the error.
    pub at: Range<usize>,
    /// Path of the wrong value, if the text could be read that far.
    pub path: Option<Path>,
    /// Description of the error.
    pub message: String,
    /// Suggestion for a fix.
    pub help: Option<String>,
}

/// Decodes the bytes of a file as UTF-8, with or without a byte order mark.
pub fn text(bytes: Vec<u8>) -> Result<String, String> {
    if bytes.len() as u64 > MAX_BYTES {
        return Err(format!("the file is larger than the limit of {} MiB", MAX_BYTES >> 20));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("the file is UTF-16; scene files are UTF-8".into());
    }
    if bytes.contains(&0) {
        return Err("this is not a text file: it contains a zero byte".into());
    }
    let mut text = String::from_utf8(bytes)
        .map_err(|e| format!("this is not a UTF-8 text file: byte {} is invalid", e.utf8_error().valid_up_to()))?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}

/// Approximate upper bound of the memory in bytes to read and check a scene of this text, from the
/// number of its values and members.
pub fn bytes_to_read(text: &[u8]) -> u64 {
    const VALUE: u64 = 240;
    const MEMBER: u64 = 1200;
    let mark = |byte: &u8| match byte {
        b',' | b'[' | b'{' => VALUE,
        b':' => MEMBER,
        _ => 0,
    };
    text.iter().map(mark).sum::<u64>() + text.len() as u64
}

/// Checks nesting depth and number of values, to protect the parser against stack overflow and
/// excessive memory use.
pub fn check(text: &str) -> Result<(), SyntaxError> {
    let bytes = text.as_bytes();
    let (mut depth, mut values, mut i) = (0_usize, 0_usize, 0);
    while let Some(byte) = bytes.get(i) {
        match byte {
            b'"' => i = skip_string(bytes, i),
            b'/' => i = skip_comment(bytes, i),
            b'[' | b'{' if depth == MAX_DEPTH => {
                let message = format!("arrays and objects are nested deeper than the limit of {MAX_DEPTH}");
                return Err(SyntaxError { at: i..i + 1, path: Some(path_after(text, i)), message, help: None });
            }
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth = depth.saturating_sub(1),
            b',' if values == MAX_VALUES => {
                let message = format!("the file contains more than the limit of {MAX_VALUES} values");
                let help = Some("store large meshes in mesh files (OBJ, PLY, STL)".into());
                return Err(SyntaxError { at: i..i + 1, path: Some(path_after(text, i)), message, help });
            }
            b',' => values += 1,
            _ => {}
        }
        i += 1;
    }
    Ok(())
}

/// Path of the value that begins after the first `length` bytes of a JSON text.
fn path_after(text: &str, length: usize) -> Path {
    let bytes = text.as_bytes().get(..length).unwrap_or_default();
    let (mut steps, mut key, mut i) = (Vec::new(), 0..0, 0);
    while let Some(byte) = bytes.get(i) {
        match byte {
            b'"' => {
                let end = skip_string(bytes, i);
                key = i..end + 1;
                i = end;
            }
            b'/' => i = skip_comment(bytes, i),
            b'{' => steps.push(Step::Key(String::new())),
            b'[' => steps.push(Step::Index(0)),
            b']' | b'}' => drop(steps.pop()),
            b':' | b',' => match steps.last_mut() {
                Some(Step::Key(last)) if *byte == b':' => *last = unescaped(text.get(key.clone()).unwrap_or_default()),
                Some(Step::Index(last)) => *last += 1,
                _ => {}
            },
            _ => {}
        }
        i += 1;
    }
    steps.into_iter().fold(Path::root(), |mut path, step| {
        path.push(step);
        path
    })
}

/// Decodes a JSON string with its quotes.
fn unescaped(quoted: &str) -> String {
    serde_json::from_str(quoted).unwrap_or_else(|_| quoted.trim_matches('"').to_owned())
}

/// Position of the closing quote of the string that opens at `start`.
pub(super) fn skip_string(bytes: &[u8], start: usize) -> usize {
    let mut i = start + 1;
    while let Some(byte) = bytes.get(i) {
        match byte {
            b'"' => return i,
            b'\\' => i += 2,
            _ => i += 1,
        }
    }
    i
}

/// Position of the last byte of the comment that opens at `start`; `start` itself if there is none.
pub(super) fn skip_comment(bytes: &[u8], start: usize) -> usize {
    let rest = bytes.get(start + 1..).unwrap_or_default();
    match rest.first() {
        Some(b'/') => start + rest.iter().take_while(|b| !matches!(b, b'\n' | b'\r')).count(),
        Some(b'*') => {
            let inner = rest.get(1..).unwrap_or_default();
            inner.windows(2).position(|pair| pair == b"*/").map_or(bytes.len(), |end| start + end + 3)
        }
        _ => start,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_counts_neither_strings_nor_comments() {
        let quiet = format!("[\"{0}\\\"{0}\" /* {0} */ // {0}\n]", "[".repeat(100));
        assert_eq!(check(&quiet), Ok(()));
        let deep = format!("/* \" */ {}", "[".repeat(65));
        assert_eq!(check(&deep).map_err(|e| e.at), Err(72..73));
    }

    #[test]
    fn nesting_errors_name_the_path() {
        let inner = format!("{{\"a\": [1, 2], \"\\u0062\": [0, {{\"c\": {}", "[".repeat(61));
        let path = check(&format!("/* [ */ [{{}}, \"[\\\"\", {inner}")).unwrap_err().path.unwrap();
        assert_eq!(path.to_string(), format!("[2].b[1].c{}", "[0]".repeat(60)));
    }

    #[test]
    fn a_comment_of_one_star_does_not_close() {
        assert_eq!(skip_comment(b"/*/ [ */ x", 0), 7);
        assert_eq!(skip_comment(b"/**/ x", 0), 3);
        assert_eq!(skip_comment(b"// ab\n", 0), 4);
        assert_eq!(skip_comment(b"/ab", 0), 0);
    }

    #[test]
    fn only_utf_8_is_accepted_as_text() {
        assert_eq!(text(b"\xef\xbb\xbf{}".to_vec()), Ok("{}".into()));
        assert!(text(vec![0x89, b'P', b'N', b'G', 0]).is_err());
        assert!(text(vec![b'a', 0xc3]).unwrap_err().contains("byte 1"));
        assert!(text(vec![0xff, 0xfe, b'{', 0]).unwrap_err().contains("UTF-16"));
    }
}
