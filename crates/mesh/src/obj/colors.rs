//! Colors of the positions of an OBJ.

use juggler_math::Vec3;
use juggler_math::color::srgb_decode;

/// Encoded color from the words after x, y and z of a position; `None` unless there are at least
/// three finite numbers.
pub(super) fn color<'w>(words: impl Iterator<Item = &'w [u8]>) -> Option<Vec3> {
    let mut numbers = words.take(3).map(|word| std::str::from_utf8(word).ok()?.parse::<f32>().ok());
    let mut channel = || numbers.next().flatten().filter(|number| number.is_finite());
    Some(Vec3::new(channel()?, channel()?, channel()?))
}

/// Color of a position without color: white in any range of numbers.
pub(super) const NO_COLOR: Vec3 = Vec3::INFINITY;

/// Largest channel of colors from 0 to 1. Larger ones in a file mean levels from 0 to 255.
const LARGEST_FRACTION: f32 = 2.0;

/// Decodes the colors of a file, which are sRGB from 0 to 1, or from 0 to 255 with a warning.
pub(super) fn decode(colors: &mut [Vec3], warnings: &mut Vec<String>) {
    let are_levels = colors.iter().any(|color| color.is_finite() && color.max_element() > LARGEST_FRACTION);
    if are_levels {
        warnings.push("colors of vertices exceed 1: taken as levels from 0 to 255".to_owned());
    }
    let scale = if are_levels { 255.0 } else { 1.0 };
    for color in colors {
        *color = color.to_array().map(|channel| srgb_decode((channel / scale).clamp(0.0, 1.0))).into();
    }
}
