//! ASCII STL: `solid`s of `facet`s, words in any case, on any lines.

use super::super::error::Fault;
use super::super::pieces::{line_breaks, next_line_start, read_pieces};
use super::super::text::Scanner;
use super::super::{Imported, Limits};
use super::{Soup, Soups};
use juggler_math::{Vec3, vec3};

/// Whether the file is without the zero bytes that a binary one has, at the latest in its count of facets
/// (one with 2^24 facets and more has a length that says so).
pub(super) fn is_text(bytes: &[u8]) -> bool {
    const ENOUGH: usize = 1024;
    !bytes.get(..ENOUGH).unwrap_or(bytes).contains(&0)
}

/// Reads all solids of a file in pieces of about this many bytes.
///
/// A text is cut where a line begins with the word `facet`, and a piece is read as if a facet of a solid began there.
/// That is checked when the pieces are put together: one that does not begin where the piece before it ended is read
/// once more.
pub(super) fn read(bytes: &[u8], limits: &Limits, piece: usize) -> Result<Imported, Fault> {
    let mut soups = Soups::default();
    let mut at = State { position: 0, inside: false };
    read_pieces(
        &cut(bytes, piece),
        |piece| Ok((*piece, read_piece(bytes, *piece, limits))),
        |(mut piece, mut found)| {
            if piece.start != at {
                if at.position >= piece.end {
                    return Ok(());
                }
                piece.start = at;
                found = read_piece(bytes, piece, limits);
            }
            let (soup, end) =
                found.map_err(|fault| fault.further_down(line_breaks(bytes.get(..at.position).unwrap_or_default())))?;
            at = end;
            soups.append(soup, limits)
        },
    )?;
    soups.finish(Vec::new(), limits)
}

/// What there is to know between two facets.
#[derive(Clone, Copy, PartialEq, Eq)]
struct State {
    /// Where the next word stands.
    position: usize,
    /// Whether a solid is open.
    inside: bool,
}

/// Facets from `start` to the first that begins at `end` or later.
#[derive(Clone, Copy)]
struct Piece {
    start: State,
    end: usize,
}

fn cut(bytes: &[u8], piece: usize) -> Vec<Piece> {
    let blanks = |line: &[u8]| line.iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
    let is_facet = |line: &[u8]| {
        let line = line.get(blanks(line)..).unwrap_or_default();
        line.split_at_checked(5).is_some_and(|(word, rest)| {
            word.eq_ignore_ascii_case(b"facet") && rest.first().is_some_and(|byte| *byte <= b' ')
        })
    };
    let mut start = State { position: 0, inside: false };
    let mut pieces = Vec::new();
    while let Some(line) = next_line_start(bytes, start.position.saturating_add(piece), |_, line| is_facet(line)) {
        let end = line + bytes.get(line..).map_or(0, blanks);
        pieces.push(Piece { start, end });
        start = State { position: end, inside: true };
    }
    pieces.push(Piece { start, end: usize::MAX });
    pieces
}

/// The facets of a piece, and where it ends.
fn read_piece(bytes: &[u8], piece: Piece, limits: &Limits) -> Result<(Soup, State), Fault> {
    let mut scanner = Scanner::new(bytes.get(piece.start.position..).unwrap_or_default());
    let mut soup = Soup::default();
    let mut inside = piece.start.inside;
    loop {
        let more = scanner.skip_empty_lines();
        let position = piece.start.position + scanner.position();
        if position >= piece.end || !more && !inside {
            return Ok((soup, State { position, inside }));
        }
        inside = statement(&mut scanner, inside, &mut soup, limits)?;
    }
}

/// A facet, or the start or end of a solid; whether one is open then.
fn statement(scanner: &mut Scanner<'_>, inside: bool, soup: &mut Soup, limits: &Limits) -> Result<bool, Fault> {
    let word = scanner.word();
    let is = |keyword: &[u8]| word.is_some_and(|word| word.eq_ignore_ascii_case(keyword));
    if inside && is(b"facet") {
        soup.push(facet(scanner)?, limits)?;
        return Ok(true);
    }
    if !is(if inside { b"endsolid" } else { b"solid" }) {
        return Err(scanner.expected(if inside { "'facet' or 'endsolid'" } else { "'solid'" }, word));
    }
    // What stands behind is the solid's name.
    scanner.rest_of_line();
    Ok(!inside)
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
