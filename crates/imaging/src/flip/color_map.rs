//! Color map for differences: black, violet, red, orange, pale yellow, with monotonically
//! increasing luminance, so that it remains readable in grayscale.

use juggler_math::{Image, Rgb, color::srgb_decode};

/// Color map at evenly spaced values from 0 to 1, in sRGB.
const STOPS: [[u8; 3]; 9] = [
    [0, 0, 2],
    [24, 16, 70],
    [78, 18, 123],
    [129, 36, 129],
    [182, 54, 122],
    [230, 80, 98],
    [251, 135, 97],
    [254, 195, 138],
    [252, 253, 192],
];

/// Color-maps differences from 0 to 1 in rows of `width` pixels; `None` if the rows are incomplete.
pub fn color_map(map: &[f32], width: u32) -> Option<Image> {
    let height = u32::try_from(map.len().checked_div(width as usize)?).ok()?;
    Image::from_pixels(width, height, map.iter().map(|v| color(*v)).collect())
}

fn color(value: f32) -> Rgb {
    let place = value.clamp(0.0, 1.0) * (STOPS.len() - 1) as f32;
    // The cast takes NaN to 0.
    let first = (place as usize).min(STOPS.len() - 2);
    let [a, b] = [STOPS[first], STOPS[first + 1]].map(|stop| Rgb::from(stop.map(|level| f32::from(level) / 255.0)));
    a.lerp(b, if place.is_nan() { 0.0 } else { place - first as f32 }).map(srgb_decode)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn color_map_has_increasing_luminance() {
        let shades: Vec<f32> = (0..=1000).map(|i| color(i as f32 / 1000.0).luminance()).collect();
        assert!(shades.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(color(f32::NAN) == color(0.0) && color(2.0) == color(1.0) && color(-1.0) == color(0.0));
        assert_eq!(color_map(&[0.0; 6], 3).map(|image| (image.width(), image.height())), Some((3, 2)));
        assert!(color_map(&[0.0; 5], 3).is_none() && color_map(&[], 0).is_none());
    }
}
