//! `new` sets the same fields as JSON.

use super::film::{AnyFilter, Gaussian, Mitchell, Rect, Tent};
use super::*;

fn check(built: impl Into<AnyCamera>, json: &str) {
    assert_eq!(built.into(), serde_json::from_str(json).unwrap());
}

fn check_filter(built: impl Into<AnyFilter>, json: &str) {
    assert_eq!(built.into(), serde_json::from_str(json).unwrap());
}

#[test]
fn constructors_equal_json() {
    let (eye, target) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
    check(Perspective::new(eye, target), r#"{"perspective": {"eye": [1, 2, 3], "look_at": [4, 5, 6]}}"#);
    check(
        ThinLens::new(eye, target, 0.25, 9.0),
        r#"{"thin_lens": {"eye": [1, 2, 3], "look_at": [4, 5, 6], "lens_radius": 0.25, "focus_distance": 9}}"#,
    );
    check(
        Orthographic::new(eye, target, 7.0),
        r#"{"orthographic": {"eye": [1, 2, 3], "look_at": [4, 5, 6], "height": 7}}"#,
    );
    check_filter(Tent::new(2.0), r#"{"tent": {"radius": 2}}"#);
    check_filter(Gaussian::new(2.0, 0.75), r#"{"gaussian": {"radius": 2, "sigma": 0.75}}"#);
    check_filter(Mitchell::new(0.25, 0.75), r#"{"mitchell": {"b": 0.25, "c": 0.75}}"#);
    let parts = (
        LocalTranslation::new(1.0, 2.0, 3.0),
        VirtualScreen::new(1.0, 2.0),
        ViewPlane::new(1.0, 2.0, 3.0),
        Rect::new(1, 2, 3, 4),
    );
    let json = r#"[{"right": 1, "up": 2, "forward": 3}, {"width": 1, "distance": 2},
        {"width": 1, "height": 2, "distance": 3}, {"x": 1, "y": 2, "width": 3, "height": 4}]"#;
    assert_eq!(parts, serde_json::from_str(json).unwrap());
}
