//! Normals of clear coats.

use super::*;
use juggler_math::testing::{Random, close3};

/// A black base with a smooth clear coat, under a normal map that leans far.
fn coated(coat: &str) -> (MaterialTable, MaterialId) {
    let base = r#""base_color": 0, "specular": 0, "clearcoat": 1"#;
    compile(&format!(
        r#"{{"normal_map": {{"texture": [0.7, 0.4, 0.9], "material": {{"principled": {{{base}{coat}}}}}}}}}"#
    ))
    .unwrap()
}

/// The direction into which the coat reflects a viewer at `wo`, in world space.
fn mirror_direction((table, id): &(MaterialTable, MaterialId), view: &ShadingView) -> Vec3 {
    let shading = table.shade(*id, view);
    let deltas = shading.bsdf.deltas(shading.frame.to_local(view.wo));
    assert_eq!(deltas.len(), 1, "{shading:?}");
    shading.frame.to_world(deltas[0].wi)
}

#[test]
fn clear_coats_reflect_about_their_own_normals() {
    let mut random = Random::new(841);
    let mapped = |texture: [f32; 3], scale: f32, u: Vec3, v: Vec3, normal: Vec3| {
        let [x, y, z] = texture.map(|channel| 2.0 * channel - 1.0);
        (u * (x * scale) + v * (y * scale) + normal * z).normalize()
    };
    let coats = [
        ("", [0.7, 0.4, 0.9], 1.0),
        (r#", "clearcoat_normal": [0.5, 0.5, 1]"#, [0.5, 0.5, 1.0], 1.0),
        (r#", "clearcoat_normal": "straight up""#, [0.5, 0.5, 1.0], 1.0),
        (r#", "clearcoat_normal": [0.4, 0.6, 0.9], "clearcoat_normal_scale": 0.5"#, [0.4, 0.6, 0.9], 0.5),
    ];
    for (coat, texture, scale) in coats {
        let table = coated(coat);
        for _ in 0..50 {
            let normal = random.unit_vector();
            let u = random.unit_vector().reject_from(normal).normalize();
            let v = normal.cross(u);
            let tangents = Tangents { u, v, local_u: u, local_v: v, given: None };
            let surface = Surface::new(random.point(2.0), 0.0, normal, Vec2::ZERO);
            // Near the normal, neither map leans behind the viewer. Both sides have the coat.
            let side = if random.f32() < 0.5 { 1.0 } else { -1.0 };
            let wo = (normal * side + random.unit_vector() * 0.3).normalize();
            let view = ShadingView { wo, tangents: Some(&tangents), ..ShadingView::along_normal(&surface) };
            let about = mapped(texture, scale, u, v, normal);
            let expected = about * (2.0 * wo.dot(about)) - wo;
            let found = mirror_direction(&table, &view);
            assert!(close3(found, expected, 1e-4), "{coat}: {found}, not {expected}");
        }
    }
}

#[test]
fn clear_coats_with_the_normals_of_their_base_are_unchanged() {
    let plain = compile(r#"{"principled": {"clearcoat": 0.8, "clearcoat_roughness": 0.3}}"#).unwrap();
    let own = r#""clearcoat_normal": [0.5, 0.5, 1]"#;
    let own =
        compile(&format!(r#"{{"principled": {{"clearcoat": 0.8, "clearcoat_roughness": 0.3, {own}}}}}"#)).unwrap();
    let mut random = Random::new(842);
    for _ in 0..100 {
        let surface = Surface::new(random.point(2.0), 0.0, random.unit_vector(), Vec2::ZERO);
        let view = ShadingView { wo: random.unit_vector(), ..ShadingView::along_normal(&surface) };
        let [a, b] = [&plain, &own].map(|(table, id)| table.shade(*id, &view));
        let wi = random.unit_vector();
        let [a, b] = [a, b]
            .map(|shading| shading.bsdf.eval_pdf(shading.frame.to_local(view.wo), shading.frame.to_local(wi)).0.g);
        assert!((a - b).abs() <= 1e-3 * a.max(1e-3), "{a} {b}");
    }
}
