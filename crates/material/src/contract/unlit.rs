//! Unlit surfaces, and emission under a clear coat.

use super::*;
use juggler_bsdf::fresnel::dielectric_reflectance;
use juggler_math::testing::{close, close3};

/// Straight transmittance, shadow transmittance and absence from both sides.
fn shadows(json: &str) -> [(f32, f32, bool); 2] {
    let (table, id) = compile(json).unwrap();
    [Vec3::Y, -Vec3::Y].map(|wo| {
        let surface = at(0.5);
        let straight = table.straight_transmittance(id, &surface, wo);
        (straight, table.shadow_transmittance(id, &surface, wo).g, table.is_absent(id, &surface, wo))
    })
}

#[test]
fn unlit_surfaces_show_their_color_and_are_absent_for_shadow_rays() {
    for (json, opacity) in [
        (r#"{"unlit": {"color": "tiles"}}"#, 1.0),
        (r#"{"unlit": {"color": "tiles", "opacity": 0.4}}"#, 0.4),
        (r#"{"mask": {"opacity": 0.4, "material": {"unlit": {"color": "tiles"}}}}"#, 0.4),
        (r#"{"normal_map": {"texture": "straight up", "material": {"unlit": {"color": "tiles"}}}}"#, 1.0),
    ] {
        assert_eq!(shadows(json), [(1.0, 1.0, true); 2], "{json}");
        let (table, id) = compile(json).unwrap();
        assert_eq!((table.emission(id), table.interior(id)), (None, None), "an unlit surface emits no light: {json}");
        assert!(table.is_textured(id) && table.has_absence(id) && !table.is_simple(id));
        for wo in [Vec3::Y, -Vec3::Y] {
            let surface = at(0.5);
            let view = ShadingView { wo, ..ShadingView::along_normal(&surface) };
            let shading = table.shade(id, &view);
            assert_eq!((shading.emission, shading.opacity), (Rgb::new(0.2, 0.4, 0.6), opacity), "{json}");
            assert!(shading.is_unlit && shading.bsdf.eval(Vec3::Z, Vec3::Z).is_black());
            assert!(table.radiance(id, &view).is_black());
        }
    }
    // Half of a mix with an opaque material casts a shadow.
    let mix = r#"{"mix": {"amount": 0.25, "a": {"unlit": {}}, "b": {"diffuse": {}}}}"#;
    assert_eq!(shadows(mix), [(0.75, 0.75, false); 2]);
}

#[test]
fn a_clear_coat_reflects_emission_back() {
    let json = r#"{"principled": {"emissive": 3, "clearcoat": 0.5, "clearcoat_ior": 1.6}}"#;
    let (table, id) = compile(json).unwrap();
    assert_eq!(table.emission(id), Some(SurfaceEmission { radiance: None, sides: Sides::Both }));
    let surface = at(0.0);
    for degrees in [0.0f32, 40.0, 80.0, 89.0] {
        let (sin, cos) = (degrees.to_radians().sin(), degrees.to_radians().cos());
        let radiance = 3.0 * (1.0 - 0.5 * dielectric_reflectance(cos, 1.6));
        for wo in [Vec3::new(sin, cos, 0.0), Vec3::new(0.0, -cos, sin)] {
            let view = ShadingView { wo, ..ShadingView::along_normal(&surface) };
            assert!(close(table.shade(id, &view).emission.g, radiance, 1e-6), "{degrees}");
            assert!(close(table.radiance(id, &view).g, radiance, 1e-6), "{degrees}");
        }
    }
}

#[test]
fn an_index_of_refraction_of_zero_reflects_the_specular_color() {
    let json = r#"{"principled": {"ior": 0, "specular_color": [0.9, 0.5, 0.1], "roughness": 0, "base_color": 0}}"#;
    let (table, id) = compile(json).unwrap();
    let surface = at(0.0);
    let shading = table.shade(id, &ShadingView::along_normal(&surface));
    let deltas = shading.bsdf.deltas(Vec3::Z);
    assert!(deltas.len() == 1 && close(deltas[0].weight.g, 0.5, 1e-6), "{deltas:?}");
    // Glass of this index does not refract.
    let glass = r#"{"principled": {"ior": 0, "transmission": 1, "roughness": 0}}"#;
    let (table, id) = compile(glass).unwrap();
    let interior = table.interior(id).unwrap();
    assert_eq!(table.interiors()[interior.index()].ior, 1.0);
    for thin in ["false", "true"] {
        let (table, id) = compile(&glass.replace(r#""ior": 0"#, &format!(r#""ior": 0, "thin": {thin}"#))).unwrap();
        let shading = table.shade(id, &ShadingView::along_normal(&surface));
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let through = shading.bsdf.deltas(wo).into_iter().find(|delta| delta.is_transmitted(wo)).unwrap();
        assert!(close3(through.wi, -wo, 1e-5), "{through:?}");
    }
}
