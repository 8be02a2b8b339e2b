//! Normal maps, bump maps, and directions of anisotropic highlights.

use super::*;
use juggler_bsdf::fresnel::reflect;
use juggler_math::testing::{Random, close, close3};
use std::f32::consts::PI;

/// Horizontal surface with normal y, at the surface coordinates (0.3, 0.4).
fn ground() -> Surface {
    Surface::new(Vec3::new(0.3, 0.0, 0.4), 0.0, Vec3::Y, Vec2::new(0.3, 0.4))
}

fn tangents(u: Vec3, v: Vec3) -> Tangents {
    Tangents { u, v, local_u: u, local_v: v, given: None }
}

/// Mapped shading normal of the ground, seen from above.
fn normal(json: &str, tangents: &Tangents) -> Vec3 {
    let (table, id) = compile(json).unwrap();
    assert!(table.needs_tangents(id) && table.is_textured(id));
    let surface = ground();
    table.shade(id, &ShadingView { tangents: Some(tangents), ..ShadingView::along_normal(&surface) }).frame.normal
}

/// BSDF times cosine for light from `wi` towards `view.wo`.
fn light(table: &MaterialTable, id: MaterialId, view: &ShadingView, wi: Vec3) -> Rgb {
    let shading = table.shade(id, view);
    shading.bsdf.eval(shading.frame.to_local(view.wo), shading.frame.to_local(wi))
}

#[test]
fn flat_normal_map_changes_nothing() {
    let mut random = Random::new(821);
    for inner in [r#"{"diffuse": {}}"#, r#"{"plastic": {"roughness": 0.5}}"#, r#"{"dielectric": {"roughness": 0.6}}"#] {
        let (plain, plain_id) = compile(inner).unwrap();
        for texture in ["[0.5, 0.5, 1]", r#""straight up""#] {
            let json = format!(r#"{{"normal_map": {{"texture": {texture}, "strength": 3, "material": {inner}}}}}"#);
            let (mapped, mapped_id) = compile(&json).unwrap();
            for _ in 0..50 {
                let normal = random.unit_vector();
                let shading_normal = (normal + random.point(0.5)).normalize();
                let surface = Surface { shading_normal, ..Surface::new(Vec3::ZERO, 0.0, normal, Vec2::ZERO) };
                let tangents = tangents(random.unit_vector(), random.unit_vector());
                let view = ShadingView {
                    wo: random.unit_vector(),
                    tangents: Some(&tangents),
                    ..ShadingView::along_normal(&surface)
                };
                let wi = random.unit_vector();
                assert_eq!(light(&plain, plain_id, &view, wi), light(&mapped, mapped_id, &view, wi), "{json}");
            }
        }
    }
}

/// Cosine term of a diffuse BSDF around a leaning shading normal: n·l above the surface of the
/// geometric normal, black below.
fn leaning_cosine(normal: Vec3, leaning: Vec3, wi: Vec3) -> f32 {
    if wi.dot(normal) <= 0.0 { 0.0 } else { leaning.dot(wi).max(0.0) }
}

#[test]
fn tilted_normal_map_equals_a_tilted_surface() {
    let mut random = Random::new(822);
    let json = r#"{"normal_map": {"texture": [0.8, 0.4, 0.9], "strength": 0.5, "material": {"diffuse": {"reflectance": 0.7}}}}"#;
    let (table, id) = compile(json).unwrap();
    for _ in 0..100 {
        let turn = random.rotation();
        let (u, n, v) = (turn.vector(Vec3::X), turn.vector(Vec3::Y), turn.vector(Vec3::NEG_Z));
        // Lengths of the tangents and their components along the normal have no effect.
        let tangents = tangents(u * 3.0 + n * 0.1, v * 0.2 + u * 0.05);
        let leaning = (u * 0.3 + v * -0.1 + n * 0.8).normalize();
        let surface = Surface::new(Vec3::ZERO, 0.0, n, Vec2::ZERO);
        let view = ShadingView { wo: n, tangents: Some(&tangents), ..ShadingView::along_normal(&surface) };
        let wi = random.unit_vector();
        let expected = 0.7 / PI * leaning_cosine(n, leaning, wi);
        assert!(close(light(&table, id, &view, wi).g, expected, 1e-4) || expected < 1e-5, "{wi}");
        // Seen from below, the relief is inverted.
        let below = ShadingView { wo: -n, ..view };
        let expected = 0.7 / PI * leaning_cosine(-n, -leaning, wi);
        assert!(close(light(&table, id, &below, wi).g, expected, 1e-4) || expected < 1e-5, "{wi}");
    }
}

/// Known answers: under light along the geometric normal, a white diffuse surface tilted by β has
/// the radiance cos β of n·l, from wherever it is seen.
#[test]
fn tilted_diffuse_surfaces_follow_the_cosine() {
    for material in [r#"{"diffuse": {"reflectance": 1}}"#, r#"{"principled": {"base_color": 1, "specular": 0}}"#] {
        for degrees in [45f32, 60.0, 80.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let color = [0.5 + 0.5 * sin, 0.5, 0.5 + 0.5 * cos];
            let (table, id) =
                compile(&format!(r#"{{"normal_map": {{"texture": {color:?}, "material": {material}}}}}"#)).unwrap();
            let (surface, t) = (ground(), tangents(Vec3::X, Vec3::NEG_Z));
            for wo in [[sin, cos, 0.0], [0.0, 1.0, 0.0], [0.5, 0.8, 0.2], [-0.5, 0.8, 0.2], [-0.98, 0.15, 0.0]] {
                let wo = Vec3::from(wo).normalize();
                let view = ShadingView { wo, tangents: Some(&t), ..ShadingView::along_normal(&surface) };
                let radiance = light(&table, id, &view, Vec3::Y).g * PI;
                assert!(close(radiance, cos, 1e-5), "{material} {degrees} {wo}: {radiance}");
            }
        }
    }
}

#[test]
fn mirrored_coordinates_mirror_normals() {
    let json = r#"{"normal_map": {"texture": [0.5, 0.7, 0.9]}}"#;
    let up = Vec3::new(0.0, 0.8, -0.4).normalize();
    assert!(close3(normal(json, &tangents(Vec3::X, Vec3::NEG_Z)), up, 1e-6));
    assert!(close3(normal(json, &tangents(Vec3::NEG_X, Vec3::NEG_Z)), up, 1e-6));
    assert!(close3(normal(json, &tangents(Vec3::X, Vec3::Z)), Vec3::new(0.0, 0.8, 0.4).normalize(), 1e-6));
}

#[test]
fn linear_bump_map_tilts_the_normal_by_its_gradient() {
    // The height is the luminance of (u, v, 0), or of the fractional parts of the point in object
    // space.
    let (red, green) = (0.2126, 0.7152);
    for (u, v) in [(Vec3::X, Vec3::NEG_Z), (Vec3::X * 2.0, Vec3::new(0.5, 0.0, -3.0)), (Vec3::Z, Vec3::X * 0.8)] {
        let t = tangents(u, v);
        let json = r#"{"bump_map": {"height": "u and v", "distance": 0.5}}"#;
        // The gradient g lies in the surface; g · u and g · v are the derivatives of the height
        // along u and v.
        let across = u.x * v.z - u.z * v.x;
        let slope = Vec3::new(red * v.z - green * u.z, 0.0, green * u.x - red * v.x) * (0.5 / across);
        assert!(close3(normal(json, &t), (Vec3::Y - slope).normalize(), 2e-3), "{u} {v}: {}", normal(json, &t));
        // An object scaled by 2 with a pattern in object space: heights stay in scene units, so
        // slopes halve.
        let t = Tangents { local_u: u * 0.5, local_v: v * 0.5, ..t };
        let carved = r#"{"bump_map": {"height": "x, y and z", "distance": -1}}"#;
        let blue = 1.0 - red - green;
        let slope = Vec3::new(red, 0.0, blue) * -0.5;
        assert!(close3(normal(carved, &t), (Vec3::Y - slope).normalize(), 2e-3), "{u} {v}: {}", normal(carved, &t));
    }
    // A constant height, and a surface without tangents.
    let level = r#"{"bump_map": {"height": 3, "material": {"diffuse": {}}}}"#;
    assert_eq!(normal(level, &tangents(Vec3::X, Vec3::Z)), Vec3::Y);
    let (table, id) = compile(r#"{"bump_map": {"height": "u and v"}}"#).unwrap();
    assert_eq!(table.shade(id, &ShadingView::along_normal(&ground())).frame.normal, Vec3::Y);
}

#[test]
fn nested_normal_maps_combine() {
    let t = tangents(Vec3::X, Vec3::NEG_Z);
    let lean = |x: f32, inner: &str| {
        let color = format!("[{}, 0.5, {}]", 0.5 + 0.5 * x, 0.5 + 0.5 * (1.0 - x * x).sqrt());
        format!(r#"{{"normal_map": {{"texture": {color}, "material": {inner}}}}}"#)
    };
    let twice = lean(0.3, &lean(0.3, r#"{"diffuse": {}}"#));
    let angle = 2.0 * 0.3f32.asin();
    let expected = Vec3::new(angle.sin(), angle.cos(), 0.0);
    assert!(close3(normal(&twice, &t), expected, 1e-5), "{}", normal(&twice, &t));
}

#[test]
fn shading_normals_reflect_the_view_above_the_surface() {
    let mut random = Random::new(823);
    let (mut bent, t) = (0, tangents(Vec3::X, Vec3::NEG_Z));
    for _ in 0..2000 {
        let color = format!("[{}, {}, {}]", random.f32(), random.f32(), random.range(0.5, 1.0));
        let (table, id) = compile(&format!(r#"{{"normal_map": {{"texture": {color}}}}}"#)).unwrap();
        let surface = ground();
        let wo = random.unit_vector();
        let view = ShadingView { wo, tangents: Some(&t), ..ShadingView::along_normal(&surface) };
        let normal = table.shade(id, &view).frame.normal;
        let side = wo.y.signum();
        assert!(normal.dot(wo) > 0.0 && reflect(wo, normal).y * side > 0.0, "{color} {wo} {normal}");
        assert!(normal.is_normalized());
        bent += u32::from(reflect(wo, normal).y * side < 0.011);
    }
    assert!(bent > 100, "{bent}");
}

#[test]
fn brushed_metal_follows_the_coordinates() {
    let mut random = Random::new(824);
    let metal = |fields: &str| compile(&format!(r#"{{"conductor": {{"roughness": 0.6, {fields}}}}}"#)).unwrap();
    let (along, along_id) = metal(r#""anisotropy": 0.8"#);
    let (across, across_id) = metal(r#""anisotropy": -0.8, "anisotropy_rotation": 0.25"#);
    let surface = ground();
    let half = (0.3f32.cos(), 0.3f32.sin());
    for _ in 0..50 {
        let angle = random.range(0.0, 7.0);
        let u = Vec3::new(angle.cos(), 0.0, angle.sin());
        let v = Vec3::Y.cross(u);
        // Highlights are elongated along u, where alpha is larger.
        let t = tangents(u, v);
        let view = ShadingView { tangents: Some(&t), ..ShadingView::along_normal(&surface) };
        let at = |tangent: Vec3| light(&along, along_id, &view, Vec3::Y * half.0 + tangent * half.1).g;
        assert!(at(u) > 1.5 * at(v) && close(at(u), at(-u), 1e-3), "{} {}", at(u), at(v));
        let wi = random.unit_vector();
        let view = ShadingView { wo: (Vec3::Y + random.point(0.9)).normalize(), ..view };
        let (one, other) = (light(&along, along_id, &view, wi).g, light(&across, across_id, &view, wi).g);
        assert!(close(one, other, 1e-3), "{one} {other}");
    }
}

#[test]
fn anisotropy_rotation_turns_from_u_to_v() {
    let surface = ground();
    let (table, id) =
        compile(r#"{"principled": {"metallic": 1, "anisotropy": 0.7, "anisotropy_rotation": 0.125}}"#).unwrap();
    for v in [Vec3::NEG_Z, Vec3::Z] {
        let t = tangents(Vec3::X, v);
        for wo in [Vec3::Y, Vec3::NEG_Y] {
            let shading =
                table.shade(id, &ShadingView { wo, tangents: Some(&t), ..ShadingView::along_normal(&surface) });
            assert!(close3(shading.frame.tangent, (Vec3::X + v).normalize(), 1e-6), "{v} {wo}");
        }
    }
}
