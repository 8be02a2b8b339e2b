//! `new` sets the same fields as JSON.

use crate::medium::Medium;
use crate::*;
use juggler_math::Rgb;

fn check(built: impl Into<AnyMaterial>, json: &str) {
    assert_eq!(built.into(), serde_json::from_str(json).unwrap());
}

#[test]
fn constructors_equal_json() {
    check(Phong::new([1.0, 0.5, 0.25]), r#"{"phong": {"diffuse": [1, 0.5, 0.25]}}"#);
    check(Diffuse::new(0.25), r#"{"diffuse": {"reflectance": [0.25, 0.25, 0.25]}}"#);
    check(Conductor::new("wood"), r#"{"conductor": {"reflectance": "wood"}}"#);
    check(Conductor::from_metal(MetalName::Gold), r#"{"conductor": {"metal": "gold"}}"#);
    check(Dielectric::new(1.25), r#"{"dielectric": {"ior": 1.25}}"#);
    check(Plastic::new("wood"), r#"{"plastic": {"reflectance": "wood"}}"#);
    check(Velvet::new("wood"), r#"{"velvet": {"sheen_color": "wood"}}"#);
    check(Translucent::new("a", "b"), r#"{"translucent": {"reflectance": "a", "transmittance": "b"}}"#);
    check(Principled::new("wood"), r#"{"principled": {"base_color": "wood"}}"#);
    check(Emissive::new(2.0), r#"{"emissive": {"radiance": [2, 2, 2]}}"#);
    check(Unlit::new("wood"), r#"{"unlit": {"color": "wood"}}"#);
    check(Checkerboard::new("a", String::from("b")), r#"{"checkerboard": {"even": "a", "odd": "b"}}"#);
    check(Mask::new("leaf", "green"), r#"{"mask": {"opacity": "leaf", "material": "green"}}"#);
    check(Mix::new("a", "b", 0.25), r#"{"mix": {"a": "a", "b": "b", "amount": 0.25}}"#);
    check(NormalMap::new("n", "a"), r#"{"normal_map": {"texture": "n", "material": "a"}}"#);
    check(
        BumpMap::new("h", Diffuse::new(0.0)),
        r#"{"bump_map": {"height": "h", "material": {"diffuse": {"reflectance": [0, 0, 0]}}}}"#,
    );
    let fog = Medium { scattering: Rgb::splat(0.5), ..Medium::default() };
    check(Boundary::new(fog), r#"{"boundary": {"medium": {"scattering": [0.5, 0.5, 0.5]}}}"#);
    assert_eq!(Spread::new(5.0, 16), serde_json::from_str(r#"{"half_angle_degrees": 5, "rays": 16}"#).unwrap());
}
