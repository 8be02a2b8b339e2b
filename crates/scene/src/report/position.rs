//! Lines and columns of places in texts.

use crate::document::{FileId, SourceSpan};

/// Position in a text.
pub struct Cursor {
    file: FileId,
    /// Number of bytes before the position.
    offset: usize,
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
}

impl Cursor {
    /// Start of the main file.
    pub fn new() -> Self {
        Self { file: FileId::MAIN, offset: 0, line: 1, column: 1 }
    }

    /// Cursor at the start of a place in `text`. Counts only the text after this cursor if the place
    /// lies there.
    pub fn moved_to(self, place: &SourceSpan, text: &str) -> Self {
        let offset = text.floor_char_boundary(place.start as usize);
        let is_before = self.file == place.file && self.offset <= offset;
        let from = if is_before { self } else { Self { file: place.file, offset: 0, line: 1, column: 1 } };
        let passed = text.get(from.offset..offset).unwrap_or_default();
        let column = match passed.rsplit_once('\n') {
            Some((_, last)) => 1 + last.chars().count(),
            None => from.column + passed.chars().count(),
        };
        Self { file: place.file, offset, line: from.line + passed.matches('\n').count(), column }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Sources;

    /// Places forward and backward, in two files, at line ends, after characters of several bytes
    /// and beyond the text.
    #[test]
    fn lines_and_columns_are_counted_from_any_position() {
        let mut sources = Sources::default();
        let files = [sources.add("a", "ab\ncdé\n\nf".into()), sources.add("b", "x\ny".into())];
        let places = [
            (0, 1, (1, 2)),
            (0, 2, (1, 3)),
            (0, 3, (2, 1)),
            (0, 7, (2, 4)),
            (0, 9, (4, 1)),
            (1, 2, (2, 1)),
            (0, 0, (1, 1)),
            (0, 10, (4, 2)),
            (0, 99, (4, 2)),
            (1, 0, (1, 1)),
        ];
        let mut cursor = Cursor::new();
        for (file, start, expected) in places {
            let place = SourceSpan { file: files[file], start, end: start + 1 };
            cursor = cursor.moved_to(&place, &sources.get(files[file]).unwrap().text);
            assert_eq!((cursor.line, cursor.column), expected, "{start} of file {file}");
        }
    }
}
