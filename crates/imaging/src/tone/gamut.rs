//! Colours that a display cannot show, and those that it can.

use super::matrix::dot;

/// Brings a linear colour into the cube from 0 to 1: straight towards the grey of its own luminance, as far as necessary, so
/// that luminance and hue (as a direction from grey) stay. What is brighter than white becomes white. `luminances`
/// are those of the primaries, their sum being 1.
pub(super) fn into_display(color: [f64; 3], luminances: [f64; 3]) -> [f64; 3] {
    if color.iter().all(|v| (0.0..=1.0).contains(v)) {
        return color;
    }
    let grey = dot(color, luminances);
    if grey >= 1.0 {
        return [1.0; 3];
    }
    if grey.is_nan() || grey <= 0.0 {
        return [0.0; 3];
    }
    let share = color.iter().fold(1.0, |share: f64, &v| {
        if v > 1.0 {
            share.min((1.0 - grey) / (v - grey))
        } else if v < 0.0 {
            share.min(grey / (grey - v))
        } else {
            share
        }
    });
    color.map(|v| (grey + share * (v - grey)).clamp(0.0, 1.0))
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
            let grey = dot(color, LUMINANCES);
            let shown = into_display(color, LUMINANCES);
            assert!(shown.iter().all(|v| (0.0..=1.0).contains(v)));
            if !(0.0..1.0).contains(&grey) {
                assert_eq!(shown, if grey < 0.5 { [0.0; 3] } else { [1.0; 3] });
                continue;
            }
            assert!((dot(shown, LUMINANCES) - grey).abs() < 1e-12);
            // The directions from grey are parallel and not opposite.
            let (a, b) = (color.map(|v| v - grey), shown.map(|v| v - grey));
            let lengths = (dot(a, a) * dot(b, b)).sqrt();
            assert!((dot(a, b) - lengths).abs() < 1e-9, "{color:?} {shown:?}");
        }
    }

    #[test]
    fn what_can_be_shown_is_left_and_what_cannot_touches_the_border() {
        assert_eq!(into_display([0.0, 0.25, 1.0], LUMINANCES), [0.0, 0.25, 1.0]);
        let shown = into_display([0.0, 0.0, 3.0], LUMINANCES);
        assert!(shown[2] == 1.0 && shown[0] > 0.0 && shown[0] == shown[1], "{shown:?}");
        assert_eq!(into_display([f64::NAN, 0.0, 2.0], LUMINANCES), [0.0; 3]);
    }
}
