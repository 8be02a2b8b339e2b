//! Deviations from the format that most readers accept; each is counted for a warning.

use super::notes::Notes;
use crate::error::MeshErrorKind;
use crate::text::{Scanner, is_nan_of_c, real};
use juggler_math::{Vec3, vec3};

/// Word before a comment that no blank separates from it, such as `4` of `4#text`, and whether there
/// is such a comment.
pub(super) fn without_comment<'w>(word: &'w [u8], notes: &mut Notes) -> (&'w [u8], bool) {
    let Some(at) = memchr::memchr(b'#', word) else { return (word, false) };
    notes.glued_comments += 1;
    (word.get(..at).unwrap_or_default(), true)
}

/// Reads a normal. Words such as `-nan(ind)`, which C libraries write for numbers that are none, make
/// it a missing normal.
pub(super) fn normal(scanner: &mut Scanner<'_>, notes: &mut Notes) -> Result<Vec3, MeshErrorKind> {
    let mut next = |name: &str| {
        let word = scanner.word();
        match word.and_then(real) {
            Some(number) => Ok(number),
            None if word.is_some_and(is_nan_of_c) => {
                notes.nan_words += 1;
                Ok(f32::NAN)
            }
            None => Err(scanner.expected(&format!("a number for {name}"), word)),
        }
    };
    Ok(vec3(next("x")?, next("y")?, next("z")?))
}
