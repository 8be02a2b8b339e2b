//! Memory estimate of a merge, from the headers of the partial renders: bands of rows, file
//! writers, and the denoiser.

use crate::failure::Failure;
use crate::memory;
use juggler::camera::film::{AovSums, Sum, TILE_EDGE};
use juggler::denoise::DenoiserInput;
use juggler::film;
use juggler::imaging::{Header, ImageFormat};
use juggler::{Aov, AovSet};

/// Number of pixels in a band of rows; more if a single row of tiles has more.
const BAND: u64 = 1 << 20;
/// Bytes per tile of a partial render: its position and its ranges of samples.
const TILE_BYTES: u64 = 160;
/// Bytes per name of an object or material in Cryptomatte manifests.
const NAME: u64 = 400;

/// Refuses a merge that needs more than `most` bytes. `picture` describes the output file, unless
/// it is a partial render.
pub fn check(
    merge: &film::Merge,
    set: &AovSet,
    picture: Option<(ImageFormat, &Header, bool)>,
    most: Option<u64>,
) -> Result<(), Failure> {
    let Some(most) = most else { return Ok(()) };
    let region = merge.description().region;
    let planes = set.film_aovs();
    let pixel = size_of::<Sum>() as u64 + AovSums::bytes_per_pixel(planes.planes.len(), planes.masks);
    let band = region.area().min(BAND.max(u64::from(region.width) * u64::from(TILE_EDGE)));
    // Gathered tiles, one tile being read, and finished rows.
    let mut needed = band.saturating_mul(2 * pixel + 12 + 8 * set.channels() as u64);
    needed = needed.saturating_add(merge.tiles().saturating_mul(TILE_BYTES));
    if let Some((format, header, seekable)) = picture {
        let names = u64::from(merge.description().aovs.entries).saturating_mul(NAME);
        let has_names = set.selected().iter().any(|aov| matches!(aov, Aov::CryptoObject | Aov::CryptoMaterial));
        let bytes = set.denoiser().map_or(0, |_| DenoiserInput::bytes_per_pixel(set.is_transparent()));
        let denoise = region.area().saturating_mul(bytes);
        needed = needed.saturating_add(format.memory_needed(header, seekable)).saturating_add(denoise);
        needed = needed.saturating_add(if has_names { names } else { 0 });
    }
    memory::check("merging the partial renders", needed, most)
}
