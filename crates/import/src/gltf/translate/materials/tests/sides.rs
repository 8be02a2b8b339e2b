//! One-sided and unlit surfaces.

use super::*;

#[test]
fn one_sided_surfaces_have_no_back_unless_light_passes_through_them() {
    let sides = |material: &str| principled(&parts(material, &LIT)).sides;
    assert_eq!(sides("{}"), SurfaceSides::Front);
    assert_eq!(sides(r#"{"doubleSided": true}"#), SurfaceSides::Both);
    for extension in [
        r#""KHR_materials_transmission": {"transmissionFactor": 0.5}"#,
        r#""KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5}"#,
        r#""KHR_materials_volume": {"thicknessFactor": 0.5}"#,
    ] {
        assert_eq!(sides(&format!(r#"{{"extensions": {{{extension}}}}}"#)), SurfaceSides::Both, "{extension}");
    }
    let none = r#"{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0}}}"#;
    assert_eq!(sides(none), SurfaceSides::Front);
}

#[test]
fn unlit_surfaces_show_their_base_color() {
    let text = r#"{"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.5]}, "alphaMode": "BLEND",
        "extensions": {"KHR_materials_unlit": {}}}"#;
    let parts = parts(text, &LIT);
    let AnyMaterial::Unlit(shown) = only(&parts) else { panic!("{parts:?}") };
    assert_eq!((shown.color.clone(), shown.opacity.clone()), (Rgb::new(0.1, 0.2, 0.3).into(), 0.5.into()));
    let parts = self::parts(&text.replace("BLEND", "MASK"), &LIT);
    let AnyMaterial::Mask(mask) = only(&parts) else { panic!("{parts:?}") };
    assert_eq!((mask.opacity.clone(), mask.cutoff), (0.5.into(), Some(0.5)));
    let points = self::parts("{}", &UNLIT);
    let AnyMaterial::Unlit(shown) = only(&points) else { panic!("{points:?}") };
    assert_eq!(shown.color, Rgb::WHITE.into());
}
