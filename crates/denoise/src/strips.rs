//! Division of large pictures into strips of rows, which limits the temporary memory to about 600
//! MB (300 bytes per pixel of a strip).

use crate::blend::blend;
use crate::grid::{PATCH_RADIUS, STEP, WINDOW_RADIUS};
use crate::prepare::Prepared;
use crate::{Denoised, Noisy, Settings, SimdLevel, energy, speckles, tile};

/// Number of rows around a strip that affect its pixels: windows that cover the pixel and their own
/// extent, patches and variances, the prefilters of features and outliers, and the average of
/// errors.
const APRON: usize = (2 * WINDOW_RADIUS + 2 * PATCH_RADIUS + 16).next_multiple_of(STEP);

/// Height of a strip of about two million pixels.
pub(crate) fn rows(width: usize) -> usize {
    ((1 << 21) / width).clamp(256, 1 << 21).next_multiple_of(STEP)
}

/// Denoises a picture strip by strip. If `rows` is a multiple of `STEP`, windows are at the same
/// positions as without strips.
pub(crate) fn denoise(
    level: SimdLevel,
    noisy: &Noisy,
    settings: &Settings,
    cancelled: &(dyn Fn() -> bool + Sync),
    rows: usize,
) -> Option<Denoised> {
    let (mut pixels, mut before, mut after) = (Vec::with_capacity(noisy.width * noisy.height), 0.0, 0.0);
    for start in (0..noisy.height).step_by(rows) {
        let end = noisy.height.min(start + rows);
        let padded_rows = start.saturating_sub(APRON)..noisy.height.min(end + APRON);
        let own = (start - padded_rows.start) * noisy.width..(end - padded_rows.start) * noisy.width;
        let prepared = Prepared::new(level, &noisy.rows(padded_rows), settings, own.clone());
        let filtered = tile::filter(level, &prepared, settings, cancelled)?;
        pixels.extend_from_slice(&blend(&prepared, &filtered)[own]);
        before += prepared.energy[0];
        after += prepared.energy[1];
    }
    if settings.cut_outliers {
        pixels = speckles::clamp(noisy, &pixels);
    }
    energy::conserve(noisy, settings, &mut pixels);
    let moved_energy = if before > 0.0 { (1.0 - after / before).max(0.0) } else { 0.0 };
    Some(Denoised { pixels, moved_energy })
}
