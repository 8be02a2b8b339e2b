//! Clear coats and dispersion.

use super::*;
use juggler_material::{MaterialRef, NormalMap};

#[test]
fn clear_coats_have_normals_of_their_own() {
    let coat = |own: &str, base: &str| {
        let coat = format!(r#""KHR_materials_clearcoat": {{"clearcoatFactor": 1{own}}}"#);
        let parts = parts(&format!(r#"{{"extensions": {{{coat}}}{base}}}"#), &LIT);
        let material = match only(&parts) {
            AnyMaterial::NormalMap(NormalMap { material: MaterialRef::Inline(material), .. }) => (**material).clone(),
            other => other.clone(),
        };
        match material {
            AnyMaterial::Principled(principled) => principled,
            other => panic!("{other:?}"),
        }
    };
    let (own, base) =
        (r#", "clearcoatNormalTexture": {"index": 0, "scale": 0.5}"#, r#", "normalTexture": {"index": 0}"#);
    let mapped = coat(own, base);
    assert!(matches!(mapped.clearcoat_normal, Some(Input::Texture(_))));
    assert_eq!(mapped.clearcoat_normal_scale, 0.5);
    assert!(matches!(coat(own, "").clearcoat_normal, Some(Input::Texture(_))));
    // Without a map of its own, the coat ignores that of its base.
    assert_eq!(coat("", base).clearcoat_normal, Some(Rgb::new(0.5, 0.5, 1.0).into()));
    let same = coat(r#", "clearcoatNormalTexture": {"index": 0}"#, base);
    assert_eq!(same.clearcoat_normal, None);
    assert_eq!(coat("", "").clearcoat_normal, None);
}

#[test]
fn solid_glass_disperses() {
    let dispersion = |more: &str| {
        let glass = r#""KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_dispersion":"#;
        principled(&extended(&format!(r#"{glass} {{"dispersion": 0.5}}{more}"#))).dispersion
    };
    assert_eq!(dispersion(r#", "KHR_materials_volume": {"thicknessFactor": 1}"#), 0.5);
    assert_eq!(dispersion(""), 0.0);
}
