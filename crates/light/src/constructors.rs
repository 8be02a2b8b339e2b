//! `new` sets the same fields as JSON.

use super::background::{self, AnyBackground};
use super::*;

fn check(built: impl Into<AnyLight>, json: &str) {
    assert_eq!(built.into(), serde_json::from_str(json).unwrap());
}

fn check_background(built: impl Into<AnyBackground>, json: &str) {
    assert_eq!(built.into(), serde_json::from_str(json).unwrap());
}

#[test]
fn constructors_equal_json() {
    check(Ambient::new(2.0), r#"{"ambient": {"intensity": 2}}"#);
    check(
        Area::new(AreaShape::Disk { radius: 2.0 }, [1.0, 2.0, 3.0], 4.0),
        r#"{"area": {"shape": {"disk": {"radius": 2}}, "position": [1, 2, 3], "radiance": 4}}"#,
    );
    check(Directional::new([1.0, 2.0, 3.0], 4.0), r#"{"directional": {"direction": [1, 2, 3], "intensity": 4}}"#);
    check(Point::new([1.0, 2.0, 3.0], 4.0), r#"{"point": {"position": [1, 2, 3], "intensity": 4}}"#);
    check(
        Spot::new([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], 7.0),
        r#"{"spot": {"position": [1, 2, 3], "direction": [4, 5, 6], "intensity": 7}}"#,
    );
    let attenuation: Attenuation = serde_json::from_str(r#"{"constant": 1, "linear": 2, "quadratic": 3}"#).unwrap();
    assert_eq!(Attenuation::new(1.0, 2.0, 3.0), attenuation);
    check_background(background::Solid::new([1.0, 2.0, 3.0]), r#"{"solid": {"color": [1, 2, 3]}}"#);
    check_background(
        background::Gradient::new([1.0; 3], [2.0; 3]),
        r#"{"gradient": {"horizon": [1, 1, 1], "zenith": [2, 2, 2]}}"#,
    );
    check_background(
        background::Dome::new(9.0, [1.0; 3], [2.0; 3]),
        r#"{"dome": {"radius": 9, "bottom": [1, 1, 1], "top": [2, 2, 2]}}"#,
    );
    check_background(
        background::Sky::new(20.0, 30.0),
        r#"{"sky": {"sun_elevation_degrees": 20, "sun_azimuth_degrees": 30}}"#,
    );
}
