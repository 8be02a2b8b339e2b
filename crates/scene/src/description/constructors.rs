//! `new` sets the same fields as JSON.

use super::{Animation, Chain, ControlSphere, Limb, LookAt, Rotate, ScenePath};
use serde::de::DeserializeOwned;
use std::fmt::Debug;

fn check<T: Debug + PartialEq + DeserializeOwned>(built: &T, json: &str) {
    assert_eq!(*built, serde_json::from_str(json).unwrap());
}

#[test]
fn constructors_equal_json() {
    let (from, to) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
    check(&Rotate::new(from, 7.0), r#"{"axis": [1, 2, 3], "degrees": 7}"#);
    check(&LookAt::new(from, to), r#"{"from": [1, 2, 3], "to": [4, 5, 6]}"#);
    check(&Animation::new(48, 24.0), r#"{"frames": 48, "frames_per_second": 24}"#);
    check(&ScenePath::new([from, to]), r#"{"points": [[1, 2, 3], [4, 5, 6]]}"#);
    let spheres = (ControlSphere::new(from, 7.0), ControlSphere::new(to, 8.0));
    check(
        &Chain::new(spheres.0, spheres.1, 9),
        r#"{"from": {"center": [1, 2, 3], "radius": 7}, "to": {"center": [4, 5, 6], "radius": 8}, "count": 9}"#,
    );
    check(
        &Limb::new(from, to, [7.0, 8.0], [9.0, 10.0, 11.0], [12.0, 13.0, 14.0]),
        r#"{"from": [1, 2, 3], "to": [4, 5, 6], "lengths": [7, 8],
            "plane_normal": [9, 10, 11], "radii": [12, 13, 14]}"#,
    );
}
