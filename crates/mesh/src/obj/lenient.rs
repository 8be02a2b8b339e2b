//! Deviations from the format that most readers accept; each is counted for a warning.

use super::notes::Notes;
use crate::error::MeshErrorKind;
use crate::text::{Scanner, finite, is_nan_of_c, real};
use juggler_math::{Vec2, Vec3, vec2, vec3};

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
    let mut next = |name: &str| number(scanner, name, &mut notes.nan_words);
    Ok(vec3(next("x")?, next("y")?, next("z")?))
}

/// Reads the texture coordinates `u [v [w]]` of a statement `vt`. The coordinate v is 0 if it is
/// absent, and coordinates that are not numbers become 0.
pub(super) fn texture_coordinates(scanner: &mut Scanner<'_>, notes: &mut Notes) -> Result<Vec2, MeshErrorKind> {
    let mut next = |scanner: &mut Scanner<'_>, name: &str| {
        let value = number(scanner, name, &mut 0)?;
        if value.is_nan() {
            notes.nan_coordinates += 1;
            return Ok(0.0);
        }
        finite(value, scanner.place(), name)
    };
    let u = next(scanner, "u")?;
    Ok(vec2(u, if scanner.at_line_end() { 0.0 } else { next(scanner, "v")? }))
}

/// Reads a number. Words that C libraries write for numbers that are none are counted, and NaN.
fn number(scanner: &mut Scanner<'_>, name: &str, nan_words: &mut u64) -> Result<f32, MeshErrorKind> {
    let word = scanner.word();
    match word.and_then(real) {
        Some(number) => Ok(number),
        None if word.is_some_and(is_nan_of_c) => {
            *nan_words += 1;
            Ok(f32::NAN)
        }
        None => Err(scanner.expected(&format!("a number for {name}"), word)),
    }
}
