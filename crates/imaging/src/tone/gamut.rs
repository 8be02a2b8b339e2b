//! Gamut mapping: brings colors into the display's gamut.

use super::matrix::dot;

/// Moves a linear color into the unit cube, straight towards the gray of equal luminance and only
/// as far as necessary, which preserves luminance and hue (as direction from gray). Colors of
/// luminance above 1 become white. `luminances` are those of the primaries and sum to 1.
pub(super) fn map_to_gamut(color: [f64; 3], luminances: [f64; 3]) -> [f64; 3] {
    if color.iter().all(|v| (0.0..=1.0).contains(v)) {
        return color;
    }
    let gray = dot(color, luminances);
    if gray >= 1.0 {
        return [1.0; 3];
    }
    if gray.is_nan() || gray <= 0.0 {
        return [0.0; 3];
    }
    let scale = color.iter().fold(1.0, |scale: f64, &v| {
        if v > 1.0 {
            scale.min((1.0 - gray) / (v - gray))
        } else if v < 0.0 {
            scale.min(gray / (gray - v))
        } else {
            scale
        }
    });
    color.map(|v| (gray + scale * (v - gray)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    const LUMINANCES: [f64; 3] = [0.2126, 0.7152, 0.0722];

    #[test]
    fn luminance_and_hue_stay() {
        let mut random = Random::new(3);
        for _ in 0..10_000 {
            let color = [(); 3].map(|()| f64::from(random.range(-0.5, 1.8)));
            let gray = dot(color, LUMINANCES);
            let mapped = map_to_gamut(color, LUMINANCES);
            assert!(mapped.iter().all(|v| (0.0..=1.0).contains(v)));
            if !(0.0..1.0).contains(&gray) {
                assert_eq!(mapped, if gray < 0.5 { [0.0; 3] } else { [1.0; 3] });
                continue;
            }
            assert!((dot(mapped, LUMINANCES) - gray).abs() < 1e-12);
            // The directions from gray are parallel.
            let (a, b) = (color.map(|v| v - gray), mapped.map(|v| v - gray));
            let lengths = (dot(a, a) * dot(b, b)).sqrt();
            assert!((dot(a, b) - lengths).abs() < 1e-9, "{color:?} {mapped:?}");
        }
    }

    #[test]
    fn gamut_mapping_keeps_colors_inside_and_moves_others_to_the_boundary() {
        assert_eq!(map_to_gamut([0.0, 0.25, 1.0], LUMINANCES), [0.0, 0.25, 1.0]);
        let mapped = map_to_gamut([0.0, 0.0, 3.0], LUMINANCES);
        assert!(mapped[2] == 1.0 && mapped[0] > 0.0 && mapped[0] == mapped[1], "{mapped:?}");
        assert_eq!(map_to_gamut([f64::NAN, 0.0, 2.0], LUMINANCES), [0.0; 3]);
    }
}
