//! Parallel reading of a file in pieces. The cuts depend only on the file's content and the size of
//! a piece, and results are taken in the order of the file, so neither the mesh nor an error
//! depends on the number of threads.

use crate::error::MeshErrorKind;
use juggler_math::BuildControl;
use memchr::{memchr2, memchr2_iter};
use rayon::prelude::*;

/// Approximate size of a piece, in bytes.
pub(crate) const PIECE: usize = 1 << 22;

/// Pieces per thread that are read before their results are taken. A small number keeps few results
/// in memory beside the mesh.
const BATCH: usize = 4;

/// Reader of a file in pieces.
#[derive(Clone, Copy)]
pub(crate) struct PieceReader<'c> {
    /// Approximate size of a piece, in bytes.
    pub size: usize,
    /// Ends the reading between pieces.
    pub control: &'c BuildControl,
}

impl PieceReader<'_> {
    /// Reads the pieces in parallel and passes the results to `take` in order, up to the first
    /// error.
    pub fn read<P: Sync, R: Send>(
        &self,
        pieces: &[P],
        read: impl Fn(&P) -> Result<R, MeshErrorKind> + Sync,
        mut take: impl FnMut(R) -> Result<(), MeshErrorKind>,
    ) -> Result<(), MeshErrorKind> {
        let read = |piece: &P| {
            self.control.check()?;
            read(piece)
        };
        for batch in pieces.chunks(BATCH * rayon::current_num_threads()) {
            let found: Vec<Result<R, MeshErrorKind>> = batch.par_iter().map(&read).collect();
            found.into_iter().try_for_each(|piece| take(piece?))?;
        }
        Ok(())
    }
}

/// Finds the start of the first line that begins at byte `from` or later and for which
/// `fits(before, after)` holds, where `before` is the text before the previous line's end and
/// `after` the text from the line's start.
pub(crate) fn next_line_start(text: &[u8], from: usize, fits: impl Fn(&[u8], &[u8]) -> bool) -> Option<usize> {
    let mut at = from.max(1) - 1;
    loop {
        let end = at + memchr2(b'\n', b'\r', text.get(at..)?)?;
        let (before, rest) = text.split_at_checked(end)?;
        let start = end + line_break(rest);
        // Step back if the search began between `\r` and `\n`.
        let before = if rest.starts_with(b"\n") { before.strip_suffix(b"\r").unwrap_or(before) } else { before };
        if start >= from && fits(before, text.get(start..)?) {
            return Some(start);
        }
        at = start;
    }
}

/// Length of the line ending at the start of `bytes`, in bytes; 0 if there is none.
pub(crate) fn line_break(bytes: &[u8]) -> usize {
    match bytes {
        [b'\r', b'\n', ..] => 2,
        [b'\r' | b'\n', ..] => 1,
        _ => 0,
    }
}

/// Number of line endings in a text.
pub(crate) fn line_breaks(text: &[u8]) -> u64 {
    let ends = memchr2_iter(b'\n', b'\r', text);
    ends.filter(|&at| text.get(at) == Some(&b'\n') || text.get(at + 1) != Some(&b'\n')).count() as u64
}

/// Reader in pieces of this size, which nothing cancels.
#[cfg(test)]
pub(crate) fn pieces(size: usize) -> PieceReader<'static> {
    static CONTROL: std::sync::LazyLock<BuildControl> = std::sync::LazyLock::new(BuildControl::default);
    PieceReader { size, control: &CONTROL }
}
