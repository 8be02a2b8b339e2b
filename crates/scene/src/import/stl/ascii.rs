//! ASCII STL: `solid`s of `facet`s, words in any case, on any lines.

use super::super::error::Fault;
use super::super::text::Scanner;
use super::super::{Imported, Limits};
use super::Soup;
use juggler_math::{Vec3, vec3};

/// Whether the file is without the zero bytes that a binary one has, at the latest in its count of facets
/// (one with 2^24 facets and more has a length that says so).
pub(super) fn is_text(bytes: &[u8]) -> bool {
    const ENOUGH: usize = 1024;
    !bytes.get(..ENOUGH).unwrap_or(bytes).contains(&0)
}

/// Reads all solids of a file.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Imported, Fault> {
    let mut scanner = Scanner::new(bytes);
    let mut soup = Soup::default();
    while let Some(word) = scanner.word_anywhere() {
        if !word.eq_ignore_ascii_case(b"solid") {
            return Err(scanner.expected("'solid'", Some(word)));
        }
        solid(&mut scanner, &mut soup, limits)?;
    }
    soup.finish(Vec::new())
}

/// What follows the word `solid`, up to and with `endsolid` and its name.
fn solid(scanner: &mut Scanner<'_>, soup: &mut Soup, limits: &Limits) -> Result<(), Fault> {
    scanner.rest_of_line();
    loop {
        match scanner.word_anywhere() {
            Some(word) if word.eq_ignore_ascii_case(b"facet") => soup.push(facet(scanner)?, limits)?,
            Some(word) if word.eq_ignore_ascii_case(b"endsolid") => {
                scanner.rest_of_line();
                return Ok(());
            }
            word => return Err(scanner.expected("'facet' or 'endsolid'", word)),
        }
    }
}

/// What follows the word `facet`. The normal may be written in ways that are no numbers, as `-nan(ind)`.
fn facet(scanner: &mut Scanner<'_>) -> Result<[Vec3; 3], Fault> {
    keyword(scanner, "normal")?;
    for axis in ["x", "y", "z"] {
        if scanner.word_anywhere().is_none() {
            return Err(scanner.expected(&format!("a number for the normal's {axis}"), None));
        }
    }
    keyword(scanner, "outer")?;
    keyword(scanner, "loop")?;
    let corners = [corner(scanner)?, corner(scanner)?, corner(scanner)?];
    keyword(scanner, "endloop")?;
    keyword(scanner, "endfacet")?;
    Ok(corners)
}

fn corner(scanner: &mut Scanner<'_>) -> Result<Vec3, Fault> {
    keyword(scanner, "vertex")?;
    Ok(vec3(scanner.real("x")?, scanner.real("y")?, scanner.real("z")?))
}

fn keyword(scanner: &mut Scanner<'_>, expected: &str) -> Result<(), Fault> {
    match scanner.word_anywhere() {
        Some(word) if word.eq_ignore_ascii_case(expected.as_bytes()) => Ok(()),
        word => Err(scanner.expected(&format!("'{expected}'"), word)),
    }
}
