//! Text STL: `solid`s of `facet`s, with keywords in any case and on any line; coordinates are on
//! the line of their `vertex`.

use super::facets::{AllFacets, WeldedFacets};
use crate::error::MeshErrorKind;
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::{PieceReader, line_breaks, next_line_start};
use crate::text::Scanner;
use juggler_math::{Vec3, vec3};

/// Whether the file has no zero byte near its start. A binary file has one in its facet count at
/// the latest, since a count of 2^24 and more is recognized by the file's length.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    const ENOUGH: usize = 1024;
    !bytes.get(..ENOUGH).unwrap_or(bytes).contains(&0)
}

/// Reads all solids of a file in pieces.
///
/// The text is cut at lines that begin with the word `facet`, and each piece is read as if a facet
/// inside a solid began there. When the pieces are joined, a piece that does not begin where the
/// previous one ended is read again from there.
pub(super) fn read(bytes: &[u8], limits: &MeshLimits, reader: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind> {
    let mut all_facets = AllFacets::default();
    let mut at = State { position: 0, inside: false };
    reader.read(
        &cut(bytes, reader.size),
        |piece| Ok((*piece, read_piece(bytes, *piece, limits))),
        |(mut piece, mut found)| {
            if piece.start != at {
                if at.position >= piece.end {
                    return Ok(());
                }
                piece.start = at;
                found = read_piece(bytes, piece, limits);
            }
            let (welded, end) =
                found.map_err(|error| error.offset_lines(line_breaks(bytes.get(..at.position).unwrap_or_default())))?;
            at = end;
            all_facets.append(welded, limits)
        },
    )?;
    all_facets.finish(Vec::new(), limits, reader.control)
}

/// State of the reader between two facets.
#[derive(Clone, Copy, PartialEq, Eq)]
struct State {
    /// Position of the next word, in bytes.
    position: usize,
    /// Whether the position is inside a solid.
    inside: bool,
}

/// Facets from `start` to the first facet that begins at byte `end` or later.
#[derive(Clone, Copy)]
struct Piece {
    start: State,
    end: usize,
}

/// Whether several lines of a text begin with the keyword `solid`. Reads it up to the second one.
pub(super) fn has_several_solids(bytes: &[u8]) -> bool {
    let is_solid = |line: &[u8]| begins_with(line, b"solid");
    let next = |from: usize| next_line_start(bytes, from, |_, line| is_solid(line));
    let first = if is_solid(bytes) { Some(0) } else { next(1) };
    first.is_some_and(|first| next(first + 1).is_some())
}

/// Whether the first word of a line is this keyword.
fn begins_with(line: &[u8], keyword: &[u8]) -> bool {
    let line = line.get(blanks(line)..).unwrap_or_default();
    line.split_at_checked(keyword.len())
        .is_some_and(|(word, rest)| word.eq_ignore_ascii_case(keyword) && rest.first().is_none_or(|byte| *byte <= b' '))
}

/// Number of blanks at the start of a line.
fn blanks(line: &[u8]) -> usize {
    line.iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count()
}

fn cut(bytes: &[u8], piece: usize) -> Vec<Piece> {
    let mut start = State { position: 0, inside: false };
    let mut pieces = Vec::new();
    while let Some(line) =
        next_line_start(bytes, start.position.saturating_add(piece), |_, line| begins_with(line, b"facet"))
    {
        let end = line + bytes.get(line..).map_or(0, blanks);
        pieces.push(Piece { start, end });
        start = State { position: end, inside: true };
    }
    pieces.push(Piece { start, end: usize::MAX });
    pieces
}

/// Reads the facets of a piece. Returns them and the state at the end.
fn read_piece(bytes: &[u8], piece: Piece, limits: &MeshLimits) -> Result<(WeldedFacets, State), MeshErrorKind> {
    let mut scanner = Scanner::new(bytes.get(piece.start.position..).unwrap_or_default());
    let mut welded = WeldedFacets::default();
    let mut inside = piece.start.inside;
    loop {
        let more = scanner.skip_empty_lines();
        let position = piece.start.position + scanner.position();
        if position >= piece.end || !more && !inside {
            return Ok((welded, State { position, inside }));
        }
        inside = statement(&mut scanner, inside, &mut welded, limits)?;
    }
}

/// Reads a facet, or the start or end of a solid. Returns whether a solid is open afterwards.
fn statement(
    scanner: &mut Scanner<'_>,
    inside: bool,
    welded: &mut WeldedFacets,
    limits: &MeshLimits,
) -> Result<bool, MeshErrorKind> {
    let word = scanner.word();
    let is = |keyword: &[u8]| word.is_some_and(|word| word.eq_ignore_ascii_case(keyword));
    if inside && is(b"facet") {
        let corners = facet(scanner, welded)?;
        welded.push(corners, limits)?;
        return Ok(true);
    }
    if !is(if inside { b"endsolid" } else { b"solid" }) {
        return Err(scanner.expected(if inside { "'facet' or 'endsolid'" } else { "'solid'" }, word));
    }
    let rest = scanner.rest_of_line();
    if !inside {
        welded.begin_solid(rest);
    }
    Ok(!inside)
}

/// Reads a facet after its keyword. The normal is not parsed, since exporters write words such as
/// `-nan(ind)` for it. It may be absent.
fn facet(scanner: &mut Scanner<'_>, welded: &mut WeldedFacets) -> Result<[Vec3; 3], MeshErrorKind> {
    let is = |word: &[u8], keyword: &[u8]| word.eq_ignore_ascii_case(keyword);
    match scanner.word_anywhere() {
        Some(word) if is(word, b"normal") => {
            normal(scanner)?;
            keyword(scanner, "outer")?;
        }
        Some(word) if is(word, b"outer") => welded.without_normal += 1,
        word => return Err(scanner.expected("'normal'", word)),
    }
    keyword(scanner, "loop")?;
    let corners = [corner(scanner)?, corner(scanner)?, corner(scanner)?];
    keyword(scanner, "endloop")?;
    keyword(scanner, "endfacet")?;
    Ok(corners)
}

/// Skips the numbers of a normal.
fn normal(scanner: &mut Scanner<'_>) -> Result<(), MeshErrorKind> {
    for axis in ["x", "y", "z"] {
        if scanner.word_anywhere().is_none() {
            return Err(scanner.expected(&format!("a number for the normal's {axis}"), None));
        }
    }
    Ok(())
}

fn corner(scanner: &mut Scanner<'_>) -> Result<Vec3, MeshErrorKind> {
    keyword(scanner, "vertex")?;
    Ok(vec3(scanner.real("x")?, scanner.real("y")?, scanner.real("z")?))
}

fn keyword(scanner: &mut Scanner<'_>, expected: &str) -> Result<(), MeshErrorKind> {
    match scanner.word_anywhere() {
        Some(word) if word.eq_ignore_ascii_case(expected.as_bytes()) => Ok(()),
        word => Err(scanner.expected(&format!("'{expected}'"), word)),
    }
}
