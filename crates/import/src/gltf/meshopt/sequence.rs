//! Codec of index sequences (mode `INDICES`): each index is a difference from one of two baselines,
//! which follow two interleaved monotonic sequences. The header byte is 0xd1, and the tail is four
//! bytes of padding.

use super::MeshoptError;
use super::reader::{Reader, unzigzag};

const HEADER: u8 = 0xd1;
const TAIL: usize = 4;

/// Decodes a stream to `count` indices and passes each to `emit`.
///
/// # Errors
///
/// The header is unknown, or the content has another length than `count` indices need.
pub(super) fn decode(count: usize, stream: &[u8], mut emit: impl FnMut(u32)) -> Result<(), MeshoptError> {
    let mut reader = Reader::new(stream, &[HEADER], TAIL)?;
    let mut baselines = [0_u32; 2];
    for _ in 0..count {
        // The lowest bit selects the baseline; the others are the difference from it.
        let code = reader.varint()?;
        let [even, odd] = &mut baselines;
        let baseline = if code & 1 == 0 { even } else { odd };
        *baseline = baseline.wrapping_add(unzigzag(code >> 1));
        emit(*baseline);
    }
    reader.finish()
}
