//! What is noticed in an OBJ beside the mesh: statements that are left out, positions that are not there yet.

use super::super::error::{Place, quote};
use std::collections::BTreeMap;

/// Kinds of ignored statements that a warning names; a file of random words has more.
const NAMED_STATEMENTS: usize = 16;

/// What was noticed.
#[derive(Default)]
pub(super) struct Notes {
    /// The furthest position that was named before it was defined, and where.
    pub furthest: Option<(u32, Place)>,
    /// Positions with more than three numbers.
    pub colors: u64,
    ignored: BTreeMap<String, u64>,
    other_ignored: u64,
}

impl Notes {
    /// Counts a statement that has no place in a mesh.
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

    /// Remembers the first place where the furthest position is named.
    pub fn not_yet_defined(&mut self, index: u32, place: Place) {
        if self.furthest.is_none_or(|(known, _)| known < index) {
            self.furthest = Some((index, place));
        }
    }

    /// Adds those of the next piece.
    pub fn append(&mut self, piece: Self) {
        if let Some((index, place)) = piece.furthest {
            self.not_yet_defined(index, place);
        }
        self.colors += piece.colors;
        self.other_ignored += piece.other_ignored;
        piece.ignored.into_iter().for_each(|(name, count)| self.add(name, count));
    }

    /// As warnings.
    pub fn in_words(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.colors > 0 {
            warnings.push(format!("{} vertices have colours or weights after x y z: ignored", self.colors));
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
