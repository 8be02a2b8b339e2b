//! What every background must keep.

use super::*;
use juggler_math::Vec3;
use juggler_math::testing::Random;

#[test]
fn light_is_finite_and_never_negative() {
    let mut random = Random::new(102);
    for background in AnyBackground::examples() {
        background.check().unwrap();
        for size in [0.0, 1.0, 1e6, 1e18, 1e30] {
            for _ in 0..200 {
                let ray = Ray::new(random.point(size), random.unit_vector());
                let light = background.radiance(&ray);
                assert!(
                    light.to_array().iter().all(|v| *v >= 0.0 && v.is_finite()),
                    "{background:?} {ray:?} {light:?}"
                );
            }
        }
    }
    let lost = Ray::new(Vec3::splat(f32::INFINITY), Vec3::Y);
    assert!(Dome::default().radiance(&lost).is_finite());
}

#[test]
fn json_goes_round() {
    for background in AnyBackground::examples() {
        let text = serde_json::to_string(&background).unwrap();
        assert_eq!(serde_json::from_str::<AnyBackground>(&text).unwrap(), background, "{text}");
    }
}

#[test]
fn says_what_is_wrong() {
    for (json, field) in [
        (r#"{"solid": {"color": [0, -1, 0]}}"#, "color"),
        (r#"{"gradient": {"zenith": [1e39, 0, 0]}}"#, "zenith"),
        (r#"{"gradient": {"nadir": [-1, 0, 0]}}"#, "nadir"),
        (r#"{"gradient": {"axis": [0, 0, 0]}}"#, "axis"),
        (r#"{"dome": {"radius": 0}}"#, "radius"),
        (r#"{"dome": {"top": [0, 0, -2]}}"#, "top"),
    ] {
        let error = serde_json::from_str::<AnyBackground>(json).unwrap().check().unwrap_err();
        assert_eq!(error.field, field, "{json}");
    }
}
