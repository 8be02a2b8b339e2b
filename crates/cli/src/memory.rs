//! `--max-memory` for commands that read pictures without rendering.

use crate::failure::Failure;
use crate::format::bytes;
use juggler::memory::PROGRAM;

/// Whether the program and `needed` bytes fit in `most` bytes.
pub fn fits(needed: u64, most: u64) -> bool {
    needed.saturating_add(PROGRAM) <= most
}

/// Fails if `needed` bytes do not fit; `what` begins the message.
pub fn check(what: &str, needed: u64, most: u64) -> Result<(), Failure> {
    if fits(needed, most) {
        return Ok(());
    }
    let needed = bytes(needed.saturating_add(PROGRAM));
    Err(Failure::Invalid(format!("{what} needs about {needed} of memory, more than --max-memory {}", bytes(most))))
}
