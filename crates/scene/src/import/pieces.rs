//! Reading a file in pieces, side by side. A file is cut by its content and the size of a piece alone, and what was
//! read is taken over in the order of the file: neither a mesh nor a fault depends on how many threads there are.

use super::error::Fault;
use memchr::{memchr2, memchr2_iter};
use rayon::prelude::*;

/// Bytes of a piece, about.
pub(super) const PIECE: usize = 1 << 22;

/// Pieces a thread that are read before the first of them is taken over: little is held twice.
const BATCH: usize = 4;

/// Reads the pieces and takes over the results in their order, up to the first fault.
pub(super) fn read_pieces<P: Sync, R: Send>(
    pieces: &[P],
    read: impl Fn(&P) -> Result<R, Fault> + Sync,
    mut take: impl FnMut(R) -> Result<(), Fault>,
) -> Result<(), Fault> {
    for batch in pieces.chunks(BATCH * rayon::current_num_threads()) {
        let found: Vec<Result<R, Fault>> = batch.par_iter().map(&read).collect();
        found.into_iter().try_for_each(|piece| take(piece?))?;
    }
    Ok(())
}

/// Where the first line starts that begins `from` bytes into the text or later, and of which `fits` holds: it is
/// given what stands before the end of the line before, and what stands from there on.
pub(super) fn next_line_start(text: &[u8], from: usize, fits: impl Fn(&[u8], &[u8]) -> bool) -> Option<usize> {
    let mut at = from.max(1) - 1;
    loop {
        let end = at + memchr2(b'\n', b'\r', text.get(at..)?)?;
        let (before, rest) = text.split_at_checked(end)?;
        let start = end + line_break(rest);
        // A break that the search began in the middle of.
        let before = if rest.starts_with(b"\n") { before.strip_suffix(b"\r").unwrap_or(before) } else { before };
        if start >= from && fits(before, text.get(start..)?) {
            return Some(start);
        }
        at = start;
    }
}

/// Length of the line's end that stands here; 0 when none does.
pub(super) fn line_break(bytes: &[u8]) -> usize {
    match bytes {
        [b'\r', b'\n', ..] => 2,
        [b'\r' | b'\n', ..] => 1,
        _ => 0,
    }
}

/// Lines' ends in a text.
pub(super) fn line_breaks(text: &[u8]) -> u64 {
    let ends = memchr2_iter(b'\n', b'\r', text);
    ends.filter(|&at| text.get(at) == Some(&b'\n') || text.get(at + 1) != Some(&b'\n')).count() as u64
}
