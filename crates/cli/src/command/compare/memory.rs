//! Memory estimate of a comparison, from the headers of the files.

use crate::failure::Failure;
use crate::memory;
use juggler::comparison::is_partial_render;
use juggler::film::PartialRender;
use juggler::imaging;
use std::path::Path;

/// Bytes per pixel of a picture, with the decoder's buffers.
const PICTURE: u64 = 12 + 24;
/// Bytes per pixel of a noise estimate: mean, variance and counts, and the layers that they are
/// read from.
const ESTIMATE: u64 = 12 + 12 + 8 + 24;
/// Bytes per pixel of FLIP.
const FLIP: u64 = 160;

/// Checks that two pictures fit in `most` bytes, including FLIP if it is `wanted`. Returns whether
/// FLIP fits.
pub fn has_room_for_flip(names: [&str; 2], wanted: bool, most: Option<u64>) -> Result<bool, Failure> {
    let Some(most) = most else { return Ok(true) };
    let [one, other] = [pixels(names[0])?, pixels(names[1])?];
    let flip = one.max(other).saturating_mul(FLIP);
    let pictures = one.saturating_add(other).saturating_mul(PICTURE + ESTIMATE);
    let needed = pictures.saturating_add(if wanted { flip } else { 0 });
    memory::check("comparing the pictures", needed, most)?;
    Ok(memory::fits(pictures.saturating_add(flip), most))
}

fn pixels(name: &str) -> Result<u64, Failure> {
    let path = Path::new(name);
    if is_partial_render(path) {
        return Ok(PartialRender::open(path)?.description().region.area());
    }
    let facts = imaging::inspect(path)?;
    Ok(u64::from(facts.width) * u64::from(facts.height))
}
