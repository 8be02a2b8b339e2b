//! Long lists of a document, parsed in chunks. A JSON tree of hundreds of thousands of objects
//! would take several times the memory of the objects themselves.

use super::limits::{SyntaxError, skip_comment, skip_string};
use super::parse::parse_part;
use super::source::FileId;
use super::tree::Node;
use crate::path::PathRef;
use std::ops::Range;

/// Sections of a scene that may be long lists.
const LISTS: [&str; 2] = ["objects", "lights"];
/// Minimum number of elements of a long list.
const MIN_ELEMENTS: usize = 1000;
/// Maximum text size of a chunk in bytes; a chunk has at least one element.
const CHUNK: usize = 1 << 17;
/// Upper estimate of the memory per element in bytes, beside its text: the item and its text range.
const ELEMENT: u64 = 1000;

/// Parsed elements of a chunk with their errors, or the first syntax error.
pub type Chunk = Result<(Vec<Node>, Vec<SyntaxError>), SyntaxError>;

/// List with many elements, kept as text ranges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LongList {
    /// The section of the scene: `objects` or `lights`.
    pub key: &'static str,
    /// Byte ranges of the elements, in order.
    elements: Vec<Range<usize>>,
}

impl LongList {
    /// Parses the list in chunks. Yields the index of each chunk's first element, and its elements.
    pub fn chunks<'t>(&'t self, text: &'t str, file: FileId) -> impl Iterator<Item = (usize, Chunk)> + 't {
        let mut first = 0;
        std::iter::from_fn(move || {
            let rest = self.elements.get(first..).filter(|rest| !rest.is_empty())?;
            let begin = rest.first().map_or(0, |element| element.start);
            let count = rest.iter().take_while(|element| element.end - begin <= CHUNK).count().max(1);
            let chunk = rest.get(..count).unwrap_or_default();
            let number = first;
            first += count;
            Some((number, self.trees(text, file, number, chunk)))
        })
    }

    fn trees(&self, text: &str, file: FileId, first: usize, chunk: &[Range<usize>]) -> Chunk {
        let (mut nodes, mut errors) = (Vec::with_capacity(chunk.len()), Vec::new());
        let section = PathRef::Root.key(self.key);
        for (i, element) in chunk.iter().enumerate() {
            let (node, more) = parse_part(text, element.clone(), file, &section.index(first + i))?;
            nodes.push(node);
            errors.extend(more);
        }
        Ok((nodes, errors))
    }
}

/// Splits a document into its text with emptied long lists (all byte offsets unchanged) and the
/// lists. `None` for a document without long lists, or with a syntax error that the scan notices.
pub fn split(text: &str) -> Option<(String, Vec<LongList>)> {
    let bytes = text.as_bytes();
    let (mut depth, mut i) = (0_usize, 0);
    let (mut word, mut key) = (0..0, None);
    let mut found: Vec<(LongList, Range<usize>)> = Vec::new();
    while let Some(byte) = bytes.get(i) {
        match byte {
            b'"' => {
                let end = skip_string(bytes, i);
                word = i + 1..end;
                i = end;
            }
            b'/' => i = skip_comment(bytes, i),
            b':' if depth == 1 => key = text.get(word.clone()).and_then(|w| LISTS.into_iter().find(|list| *list == w)),
            b'[' if depth == 1 && key.is_some() => {
                let (elements, end) = elements(bytes, i + 1)?;
                let key = key.take()?;
                if found.iter().any(|(known, _)| known.key == key) {
                    return None;
                }
                found.push((LongList { key, elements }, i + 1..end));
                i = end;
            }
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth = depth.checked_sub(1)?,
            b',' if depth == 1 => key = None,
            _ => {}
        }
        i += 1;
    }
    found.retain(|(list, _)| list.elements.len() >= MIN_ELEMENTS);
    if found.is_empty() {
        return None;
    }
    let mut rest = bytes.to_vec();
    for (_, inner) in &found {
        rest.get_mut(inner.clone())?.fill(b' ');
    }
    Some((String::from_utf8(rest).ok()?, found.into_iter().map(|(list, _)| list).collect()))
}

/// Byte ranges of the elements of the array whose content starts at `i`, and the offset of its
/// closing bracket.
fn elements(bytes: &[u8], mut i: usize) -> Option<(Vec<Range<usize>>, usize)> {
    let (mut depth, mut elements) = (0_usize, Vec::new());
    let (mut start, mut end) = (None, 0);
    loop {
        let first = i;
        match bytes.get(i)? {
            b'/' => i = skip_comment(bytes, i),
            b',' | b']' if depth == 0 => {
                let is_end = bytes.get(i) == Some(&b']');
                match start.take() {
                    Some(start) => elements.push(start..end),
                    // A trailing comma is allowed only after the last element.
                    None if is_end => {}
                    None => return None,
                }
                if is_end {
                    return Some((elements, i));
                }
            }
            byte if byte.is_ascii_whitespace() => {}
            byte => {
                match byte {
                    b'"' => i = skip_string(bytes, i),
                    b'[' | b'{' => depth += 1,
                    b']' | b'}' => depth = depth.checked_sub(1)?,
                    _ => {}
                }
                start.get_or_insert(first);
                end = i + 1;
            }
        }
        i += 1;
    }
}

/// Upper estimate of the memory in bytes to read a document, with long lists read in chunks.
pub fn bytes_to_read(text: &str) -> u64 {
    let whole = |text: &str| super::bytes_to_read(text.as_bytes());
    let Some((rest, lists)) = split(text) else { return whole(text) };
    // The text with emptied lists is a copy of the same length.
    let mut bytes = whole(&rest) + text.len() as u64;
    for list in lists {
        let longest = list.elements.iter().map(|element| element.len()).max().unwrap_or_default();
        let first = list.elements.first().map_or(0, |element| element.start);
        let end = list.elements.last().map_or(0, |element| element.end);
        let length = end.saturating_sub(first) as u64;
        // Only one chunk at a time is held as a tree.
        let share = longest.max(CHUNK) as f64 / length.max(1) as f64;
        let tree = whole(text.get(first..end).unwrap_or_default()) as f64 * share.min(1.0);
        bytes += length + tree as u64 + list.elements.len() as u64 * ELEMENT;
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(count: usize) -> String {
        let ball = r#"{"shape": "sphere", /* ] */ "name": "a,\"b]"}"#;
        let balls = vec![ball; count].join(" , ");
        format!("{{\"version\": 1, // \"objects\": [\n \"lights\": [], \"objects\": [ {balls}, ], \"title\": \"[\"}}")
    }

    #[test]
    fn split_extracts_long_lists_and_keeps_all_other_positions() {
        let text = text(1000);
        let (rest, lists) = split(&text).unwrap();
        assert_eq!((rest.len(), lists.len(), lists[0].key, lists[0].elements.len()), (text.len(), 1, "objects", 1000));
        let whole = super::super::parse(&text, FileId::MAIN).unwrap().0;
        let without = super::super::parse(&rest, FileId::MAIN).unwrap().0;
        assert_eq!(without.get("title"), whole.get("title"));
        assert_eq!(without.get("objects").unwrap().elements().len(), 0);
        let mut nodes = Vec::new();
        for (first, chunk) in lists[0].chunks(&text, FileId::MAIN) {
            assert_eq!(first, nodes.len());
            nodes.extend(chunk.unwrap().0);
        }
        assert_eq!(nodes, whole.get("objects").unwrap().elements());
        let long = self::text(20_000);
        assert!(bytes_to_read(&long) * 3 / 2 < super::super::bytes_to_read(long.as_bytes()));
    }

    #[test]
    fn split_ignores_short_and_malformed_lists() {
        assert_eq!(split(&text(999)), None);
        let long = text(1000);
        for (from, to) in [(" , ", " , , "), ("\"lights\": []", "\"objects\": []"), ("], \"title\"", "}, \"title\"")] {
            assert_eq!(split(&long.replacen(from, to, 1)), None, "{to}");
        }
        for end in [0, 1, 20, long.len() / 2] {
            assert_eq!(split(&long[..end]), None);
        }
    }
}
