//! Observations while reading an OBJ: ignored statements, and positions used before their
//! definition.

use crate::error::{FilePosition, quote};
use std::collections::BTreeMap;

/// Maximum number of ignored statements that a warning names; a file of random words has more.
const NAMED_STATEMENTS: usize = 16;

/// Observations of a piece or of all pieces.
#[derive(Default)]
pub(super) struct Notes {
    /// Highest index of a position used before its definition, and the line of the use.
    pub furthest: Option<(u32, FilePosition)>,
    /// Number of positions with further numbers that are no colors, such as weights.
    pub weights: u64,
    /// Number of comments that no blank separates from the number before.
    pub glued_comments: u64,
    /// Number of words such as `-nan(ind)` in normals.
    pub nan_words: u64,
    /// Number of texture coordinates that are no numbers.
    pub nan_coordinates: u64,
    ignored: BTreeMap<String, u64>,
    other_ignored: u64,
}

impl Notes {
    /// Counts an ignored statement.
    pub fn ignore(&mut self, statement: &[u8]) {
        self.add(quote(statement), 1);
    }

    fn add(&mut self, name: String, more: u64) {
        if let Some(count) = self.ignored.get_mut(&name) {
            *count += more;
        } else if self.ignored.len() < NAMED_STATEMENTS {
            self.ignored.insert(name, more);
        } else {
            self.other_ignored += more;
        }
    }

    /// Records the first use of the highest undefined position.
    pub fn not_yet_defined(&mut self, index: u32, place: FilePosition) {
        if self.furthest.is_none_or(|(known, _)| known < index) {
            self.furthest = Some((index, place));
        }
    }

    /// Adds the observations of the next piece.
    pub fn append(&mut self, piece: Self) {
        if let Some((index, place)) = piece.furthest {
            self.not_yet_defined(index, place);
        }
        self.weights += piece.weights;
        self.glued_comments += piece.glued_comments;
        self.nan_words += piece.nan_words;
        self.nan_coordinates += piece.nan_coordinates;
        self.other_ignored += piece.other_ignored;
        piece.ignored.into_iter().for_each(|(name, count)| self.add(name, count));
    }

    /// The observations as warnings.
    pub fn in_words(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.weights > 0 {
            warnings.push(format!("{} vertices have numbers after x y z that are no colors: ignored", self.weights));
        }
        if self.glued_comments > 0 {
            warnings.push(format!("comments that follow a face vertex without a blank: {}", self.glued_comments));
        }
        if self.nan_words > 0 {
            warnings.push(format!("numbers of normals that are no numbers and count as missing: {}", self.nan_words));
        }
        if self.nan_coordinates > 0 {
            warnings.push(format!("texture coordinates that are no numbers and become 0: {}", self.nan_coordinates));
        }
        let mut kinds: Vec<String> = self.ignored.iter().map(|(name, count)| format!("{count} {name}")).collect();
        if self.other_ignored > 0 {
            kinds.push(format!("{} others", self.other_ignored));
        }
        if !kinds.is_empty() {
            warnings.push(format!("ignored statements: {}", kinds.join(", ")));
        }
        warnings
    }
}
