//! `--max-memory` of commands that read pictures and render none.

use crate::failure::Failure;
use crate::format::bytes;
use juggler::memory::PROGRAM;

/// Whether the program stays within `most` bytes with `needed` bytes beside itself.
pub fn fits(needed: u64, most: u64) -> bool {
    needed.saturating_add(PROGRAM) <= most
}

/// Refuses what does not fit; `what` begins the message.
pub fn check(what: &str, needed: u64, most: u64) -> Result<(), Failure> {
    if fits(needed, most) {
        return Ok(());
    }
    let needed = bytes(needed.saturating_add(PROGRAM));
    Err(Failure::Wrong(format!("{what} needs about {needed} of memory, more than --max-memory {}", bytes(most))))
}
