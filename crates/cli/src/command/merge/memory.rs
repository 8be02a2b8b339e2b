//! What merging takes, told from the heads of the parts: bands of rows, what writes the files, and what the noise is taken
//! out with.

use crate::failure::Failure;
use crate::memory;
use juggler::camera::film::{Extras, Sum, TILE};
use juggler::denoise::Guides;
use juggler::film;
use juggler::imaging::{Format, Header};
use juggler::{Aov, LayerSet};

/// Pixels of a band of rows that are joined at once, unless one row of tiles has more.
const BAND: u64 = 1 << 20;
/// Bytes of a tile of a part: where it is, and which samples it holds.
const TILE_BYTES: u64 = 160;
/// Bytes of the name of an object or a material in the texts of masks.
const NAME: u64 = 400;

/// Refuses a merge that needs more than `most` bytes; `picture` is the file that is written, if it is no part.
pub fn check(
    merge: &film::Merge,
    set: &LayerSet,
    picture: Option<(Format, &Header, bool)>,
    most: Option<u64>,
) -> Result<(), Failure> {
    let Some(most) = most else { return Ok(()) };
    let region = merge.description().region;
    let planes = set.layers();
    let pixel = size_of::<Sum>() as u64 + Extras::bytes_a_pixel(planes.planes.len(), planes.masks);
    let band = region.area().min(BAND.max(u64::from(region.width) * u64::from(TILE)));
    // Gathered tiles, one that is read, finished rows.
    let mut needed = band.saturating_mul(2 * pixel + 12 + 8 * set.channels() as u64);
    needed = needed.saturating_add(merge.tiles().saturating_mul(TILE_BYTES));
    if let Some((format, header, seekable)) = picture {
        let names = u64::from(merge.description().layers.entries).saturating_mul(NAME);
        let has_names = set.wanted().iter().any(|aov| matches!(aov, Aov::CryptoObject | Aov::CryptoMaterial));
        let denoise = if set.denoiser().is_some() { region.area().saturating_mul(Guides::BYTES) } else { 0 };
        needed = needed.saturating_add(format.memory_needed(header, seekable)).saturating_add(denoise);
        needed = needed.saturating_add(if has_names { names } else { 0 });
    }
    memory::check("merging the parts", needed, most)
}
