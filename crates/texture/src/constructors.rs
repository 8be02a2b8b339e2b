//! `new` sets the same fields as JSON.

use super::*;
use juggler_math::Rgb;

/// Stops from red at 0 to the texture `wood` at 1, and their JSON.
fn stops() -> ([Stop; 2], &'static str) {
    let stops = [Stop::new(0.0, Rgb::new(1.0, 0.0, 0.0)), Stop::new(1.0, "wood")];
    (stops, r#"[{"position": 0, "color": [1, 0, 0]}, {"position": 1, "color": "wood"}]"#)
}

fn check(built: impl Into<AnyTexture>, json: &str) {
    assert_eq!(built.into(), serde_json::from_str(json).unwrap());
}

#[test]
fn constructors_equal_json() {
    let (stops, json) = stops();
    check(Gradient::new(stops.clone()), &format!(r#"{{"gradient": {{"stops": {json}}}}}"#));
    check(Ramp::new(0.25, stops), &format!(r#"{{"ramp": {{"input": 0.25, "stops": {json}}}}}"#));
    check(Image::new("a.png"), r#"{"image": {"file": "a.png"}}"#);
    check(Attribute::new("heat"), r#"{"attribute": {"name": "heat"}}"#);
    check(Constant::new([1.0, 0.5, 0.25]), r#"{"constant": {"color": [1, 0.5, 0.25]}}"#);
    check(Direction::new("grain"), r#"{"direction": {"of": "grain"}}"#);
    check(Checker::new(0.75, "wood"), r#"{"checker": {"even": [0.75, 0.75, 0.75], "odd": "wood"}}"#);
    check(Mix::new("a", "b", 0.25), r#"{"mix": {"a": "a", "b": "b", "amount": 0.25}}"#);
    check(Noise::new("a", "b"), r#"{"noise": {"low": "a", "high": "b"}}"#);
    check(Fbm::new("a", "b"), r#"{"fbm": {"low": "a", "high": "b"}}"#);
    check(Turbulence::new("a", "b"), r#"{"turbulence": {"low": "a", "high": "b"}}"#);
    check(Marble::new("a", "b"), r#"{"marble": {"stone": "a", "vein": "b"}}"#);
    check(Voronoi::new("a", "b"), r#"{"voronoi": {"low": "a", "high": "b"}}"#);
    check(Brick::new("a", "b"), r#"{"brick": {"brick": "a", "mortar": "b"}}"#);
    check(Dots::new("a", "b"), r#"{"dots": {"dot": "a", "ground": "b"}}"#);
    check(Triplanar::new("a"), r#"{"triplanar": {"texture": "a"}}"#);
    check(Wood::new("a", "b"), r#"{"wood": {"light": "a", "dark": "b"}}"#);
    check(Wave::new("a", "b"), r#"{"wave": {"low": "a", "high": "b"}}"#);
}
