//! What comparing two pictures takes, told from their heads before a pixel is read.

use super::side::is_part;
use crate::failure::Failure;
use crate::memory;
use juggler::film::Part;
use juggler::imaging;
use std::path::Path;

/// Bytes a pixel of a picture, with what decoders hold beside.
const PICTURE: u64 = 12 + 24;
/// Bytes a pixel of what a picture may know of its noise: mean, variance and counts, and the layers that they come from.
const ESTIMATE: u64 = 12 + 12 + 8 + 24;
/// Bytes a pixel of FLIP.
const FLIP: u64 = 160;

/// Refuses two pictures that need more than `most` bytes, which FLIP is part of if it is `wanted`. Returns whether there is
/// room for FLIP.
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
    if is_part(path) {
        return Ok(Part::open(path)?.description().region.area());
    }
    let facts = imaging::inspect(path)?;
    Ok(u64::from(facts.width) * u64::from(facts.height))
}
