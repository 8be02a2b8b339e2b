//! Large pictures go through in strips of rows, so that what the filter needs beside them stays within about 600 MB
//! (300 bytes a pixel of a strip).

use crate::blend::blend;
use crate::grid::{PATCH, REACH, STEP};
use crate::prepare::Prepared;
use crate::{Denoised, Noisy, Settings, SimdLevel, energy, speckles, tile};

/// Rows around a strip that its pixels depend on: windows reach a pixel from `REACH` rows away and read as far again, patches and
/// variances from there on; the filters of features and outliers, and the neighbourhood of errors.
const APRON: usize = (2 * REACH + 2 * PATCH + 16).next_multiple_of(STEP);

/// Rows of a strip of such a width, of about two million pixels.
pub(crate) fn rows(width: usize) -> usize {
    ((1 << 21) / width).clamp(256, 1 << 21).next_multiple_of(STEP)
}

/// The picture strip by strip; windows stand where they would without strips, if `rows` is a multiple of `STEP`.
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
        let around = start.saturating_sub(APRON)..noisy.height.min(end + APRON);
        let own = (start - around.start) * noisy.width..(end - around.start) * noisy.width;
        let prepared = Prepared::new(level, &noisy.rows(around), settings, own.clone());
        let filtered = tile::filter(level, &prepared, settings, cancelled)?;
        pixels.extend_from_slice(&blend(&prepared, &filtered)[own]);
        before += prepared.light[0];
        after += prepared.light[1];
    }
    if settings.cut_outliers {
        pixels = speckles::cut(noisy, &pixels);
    }
    energy::conserve(noisy, &mut pixels);
    let moved = if before > 0.0 { (1.0 - after / before).max(0.0) } else { 0.0 };
    Some(Denoised { pixels, moved })
}
