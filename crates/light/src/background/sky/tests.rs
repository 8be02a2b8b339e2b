//! Tests of the sky: the sun's disk, closed forms, and the ratios of two published models.

use super::*;

fn sky(elevation: f32, turbidity: f32) -> Sky {
    let mut sky = Sky { sun_elevation_degrees: elevation, turbidity, ..Sky::default() };
    sky.prepare().unwrap();
    sky
}

#[test]
fn sun_disk_has_the_transmitted_irradiance() {
    for (elevation, turbidity) in [(90.0, 1.0), (35.0, 2.5), (5.0, 4.0)] {
        let sky = sky(elevation, turbidity);
        let tables = sky.prepared.0.as_ref().unwrap();
        // Radiance times solid angle, relative to the irradiance above the atmosphere.
        let through = tables.disk * (TAU * sun_size()) / PI;
        let atmosphere = Atmosphere::new(f64::from(turbidity), DVec3::splat(0.3));
        let truth = rgb(atmosphere.sunlight(GROUND, f64::from(portable::sin(elevation.to_radians()))));
        for (a, b) in through.to_array().into_iter().zip(truth.to_array()) {
            assert!((a / b - 1.0).abs() < 1e-3, "{elevation}: {through:?} {truth:?}");
        }
        assert!(through.r > through.b && through.r < 1.0);
    }
}

#[test]
fn sun_disk_has_its_position_and_size() {
    let sky = sky(35.0, 2.5);
    let at = |elevation: f32, azimuth: f32| {
        let (sin, cos) = portable::sin_cos(elevation.to_radians());
        let (s, c) = portable::sin_cos(azimuth.to_radians());
        sky.radiance(&Ray::new(Vec3::ZERO, Vec3::new(cos * s, sin, -cos * c))).g
    };
    assert!(at(35.0, 135.0) > 1e4 && at(35.26, 135.0) > 1e4 && at(35.27, 135.0) < 100.0);
    assert!(at(35.0, 135.32) > 1e4 && at(35.0, 135.33) < 100.0 && at(-35.0, 135.0) < 1.0);
}

#[test]
fn skies_look_as_they_should() {
    let overhead = |sky: &Sky| sky.radiance(&Ray::new(Vec3::ZERO, Vec3::Y));
    let towards = |y: f32| Vec3::new(0.5, y, -0.5).normalize();
    let day = sky(35.0, 2.5);
    let blue = overhead(&day);
    assert!(blue.b > 1.5 * blue.r && (0.02..0.3).contains(&blue.luminance()), "{blue:?}");
    let horizon = day.radiance(&Ray::new(Vec3::ZERO, towards(0.01)));
    assert!(horizon.luminance() > 1.5 * blue.luminance() && horizon.b / horizon.r < blue.b / blue.r);
    // Red towards the setting sun, dark long after sunset.
    let dusk = sky(0.0, 2.5).radiance(&Ray::new(Vec3::ZERO, Vec3::new(0.7, 0.03, 0.7).normalize()));
    assert!(dusk.r > 1.5 * dusk.b, "{dusk:?}");
    assert!(overhead(&sky(-18.0, 2.5)).luminance() < 1e-4 * blue.luminance());
    assert!(sky(-90.0, 2.5).sample(Vec2::splat(0.5)).is_none());
}

/// Clear skies of Hosek and Wilkie (2012), ground albedo 0.3, by the plug-in `sunsky` of Mitsuba
/// 3.9.1: turbidity and the sun's elevation; azimuth from the sun and elevation of the direction;
/// luminance relative to the zenith; blue over red. `tests/sky/agree.py` prints them.
#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "one of the ratios is 3.14")]
const HOSEK_WILKIE: [([f32; 2], [f32; 2], f32, f32); 36] = [
    ([2.0, 20.0], [0.0, 30.0], 5.07, 1.60),
    ([2.0, 20.0], [180.0, 20.0], 3.71, 2.48),
    ([2.0, 20.0], [26.6, 20.0], 5.17, 1.83),
    ([2.0, 20.0], [180.0, 5.0], 8.09, 1.51),
    ([2.0, 40.0], [0.0, 50.0], 2.57, 2.30),
    ([2.0, 40.0], [180.0, 40.0], 1.43, 4.08),
    ([2.0, 40.0], [32.8, 40.0], 2.31, 2.78),
    ([2.0, 40.0], [180.0, 5.0], 5.90, 1.95),
    ([2.0, 60.0], [0.0, 70.0], 1.70, 2.47),
    ([2.0, 60.0], [180.0, 60.0], 0.91, 4.52),
    ([2.0, 60.0], [51.3, 60.0], 1.33, 3.26),
    ([2.0, 60.0], [180.0, 5.0], 4.11, 2.17),
    ([3.0, 20.0], [0.0, 30.0], 7.57, 1.10),
    ([3.0, 20.0], [180.0, 20.0], 3.51, 2.37),
    ([3.0, 20.0], [26.6, 20.0], 6.36, 1.38),
    ([3.0, 20.0], [180.0, 5.0], 7.34, 1.47),
    ([3.0, 40.0], [0.0, 50.0], 3.73, 1.50),
    ([3.0, 40.0], [180.0, 40.0], 1.36, 3.75),
    ([3.0, 40.0], [32.8, 40.0], 2.72, 2.08),
    ([3.0, 40.0], [180.0, 5.0], 5.21, 1.87),
    ([3.0, 60.0], [0.0, 70.0], 2.21, 1.73),
    ([3.0, 60.0], [180.0, 60.0], 0.80, 4.14),
    ([3.0, 60.0], [51.3, 60.0], 1.40, 2.48),
    ([3.0, 60.0], [180.0, 5.0], 3.30, 2.09),
    ([5.0, 20.0], [0.0, 30.0], 12.56, 0.72),
    ([5.0, 20.0], [180.0, 20.0], 2.78, 2.05),
    ([5.0, 20.0], [26.6, 20.0], 8.54, 0.87),
    ([5.0, 20.0], [180.0, 5.0], 5.03, 1.34),
    ([5.0, 40.0], [0.0, 50.0], 6.18, 0.98),
    ([5.0, 40.0], [180.0, 40.0], 1.16, 3.09),
    ([5.0, 40.0], [32.8, 40.0], 3.55, 1.32),
    ([5.0, 40.0], [180.0, 5.0], 3.62, 1.64),
    ([5.0, 60.0], [0.0, 70.0], 3.06, 1.14),
    ([5.0, 60.0], [180.0, 60.0], 0.62, 3.14),
    ([5.0, 60.0], [51.3, 60.0], 1.51, 1.62),
    ([5.0, 60.0], [180.0, 5.0], 1.96, 1.88),
];

/// Luminance of the clear sky of CIE, type 12, relative to the zenith (ISO 15469:2004).
fn cie_clear_sky(direction: Vec3, sun: Vec3) -> f32 {
    let gradation = |cos: f32| 1.0 - (-0.32 / cos).exp();
    let indicatrix = |cos: f32| 1.0 + 10.0 * ((-3.0 * cos.acos()).exp() - (-3.0 * FRAC_PI_2).exp()) + 0.45 * cos * cos;
    indicatrix(direction.dot(sun)) * gradation(direction.y) / (indicatrix(sun.y) * gradation(1.0))
}

/// The luminance over the zenith's lies between the ratios of Hosek and Wilkie and of CIE, or within
/// 30 % of the nearer; blue over red lies within 30 % of Hosek and Wilkie's.
#[test]
fn clear_skies_lie_between_published_models() {
    let towards = |[azimuth, elevation]: [f32; 2]| {
        let ((s, c), (sin, cos)) = (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
        Vec3::new(cos * s, sin, -cos * c)
    };
    for (case, at, hosek_wilkie, blue_over_red) in HOSEK_WILKIE {
        let [turbidity, elevation] = case;
        let mut sky = Sky { sun_elevation_degrees: elevation, sun_azimuth_degrees: 0.0, turbidity, ..Sky::default() };
        sky.prepare().unwrap();
        let radiance = |direction: Vec3| sky.radiance(&Ray::new(Vec3::ZERO, direction));
        let (direction, sun) = (towards(at), towards([0.0, elevation]));
        let color = radiance(direction);
        let luminance = color.luminance() / radiance(Vec3::Y).luminance();
        let cie = cie_clear_sky(direction, sun);
        let (low, high) = (hosek_wilkie.min(cie), hosek_wilkie.max(cie));
        assert!((0.7 * low..1.3 * high).contains(&luminance), "{case:?} {at:?}: {luminance} {low} {high}");
        let hue = color.b / color.r / blue_over_red;
        assert!((0.7..1.3).contains(&hue), "{case:?} {at:?}: {hue} of {blue_over_red}");
    }
}
