//! Materials on one side of the surface.

use super::*;
use juggler_math::testing::Random;

/// Opaque materials, as a pair of braces that a field may follow.
const OPAQUE: [&str; 6] = [
    r#"{"diffuse": {"reflectance": "tiles"#,
    r#"{"conductor": {"metal": "gold"#,
    r#"{"plastic": {"reflectance": "tiles"#,
    r#"{"velvet": {"sheen_color": "tiles"#,
    r#"{"principled": {"base_color": "tiles"#,
    r#"{"principled": {"opacity": 0.25, "alpha_cutoff": 0.1, "base_color": "tiles"#,
];

fn compile_sides(kind: &str, sides: &str) -> (MaterialTable, MaterialId) {
    compile(&format!(r#"{kind}", "sides": "{sides}"}}}}"#)).unwrap()
}

/// A view of a random surface, from the front or from behind.
fn view<'a>(surface: &'a Surface, outside: bool, random: &mut Random) -> ShadingView<'a> {
    let wo = random.unit_vector();
    let flip = (surface.normal.dot(wo) >= 0.0) != outside;
    ShadingView { wo: if flip { -wo } else { wo }, ..ShadingView::along_normal(surface) }
}

fn surface(random: &mut Random) -> Surface {
    Surface::new(random.point(2.0), 0.0, random.unit_vector(), Vec2::new(random.range(-3.0, 3.0), 0.0))
}

#[test]
fn the_front_of_a_one_sided_material_is_that_of_a_two_sided_one() {
    let mut random = Random::new(831);
    for (kind, sides) in OPAQUE.into_iter().flat_map(|kind| [(kind, "front"), (kind, "black_behind")]) {
        let ((one, one_id), (two, two_id)) = (compile_sides(kind, sides), compile_sides(kind, "both"));
        for _ in 0..20 {
            let surface = surface(&mut random);
            let view = view(&surface, true, &mut random);
            let (a, b) = (one.shade(one_id, &view), two.shade(two_id, &view));
            let wi = random.unit_vector();
            let light =
                |shading: &Shading| shading.bsdf.eval_pdf(shading.frame.to_local(view.wo), shading.frame.to_local(wi));
            assert_eq!((light(&a), a.opacity, a.frame), (light(&b), b.opacity, b.frame), "{kind} {sides}");
            assert!(!one.is_absent(one_id, &surface, view.wo));
            let through = |table: &MaterialTable, id| {
                (table.straight_transmittance(id, &surface, view.wo), table.shadow_transmittance(id, &surface, view.wo))
            };
            assert_eq!(through(&one, one_id), through(&two, two_id), "{kind} {sides}");
        }
    }
}

#[test]
fn the_back_of_a_one_sided_material_is_absent_or_black() {
    let mut random = Random::new(832);
    for (kind, sides) in OPAQUE.into_iter().flat_map(|kind| [(kind, "front"), (kind, "black_behind")]) {
        let (table, id) = compile_sides(kind, sides);
        let passes = f32::from(sides == "front");
        assert!(!table.is_simple(id) && table.interior(id).is_none());
        if passes == 1.0 {
            assert!(table.has_opacity(id) && table.is_transparent(id) && table.has_absence(id));
        }
        for _ in 0..20 {
            let surface = surface(&mut random);
            let view = view(&surface, false, &mut random);
            let shading = table.shade(id, &view);
            let [local, wi] = [view.wo, random.unit_vector()].map(|direction| shading.frame.to_local(direction));
            assert!(shading.bsdf.eval(local, wi).is_black() && shading.emission.is_black(), "{kind} {sides}");
            assert_eq!(shading.opacity, 1.0 - passes, "{kind} {sides}");
            assert_eq!(table.straight_transmittance(id, &surface, view.wo), passes, "{kind} {sides}");
            assert_eq!(table.shadow_transmittance(id, &surface, view.wo), Rgb::splat(passes), "{kind} {sides}");
            assert_eq!(table.is_absent(id, &surface, view.wo), passes == 1.0);
        }
    }
}

#[test]
fn one_sided_emitters_emit_to_the_front() {
    for sides in ["front", "black_behind"] {
        let json = format!(r#"{{"principled": {{"emissive": [3, 2, 1], "sides": "{sides}"}}}}"#);
        let (table, id) = compile(&json).unwrap();
        let radiance = Rgb::new(3.0, 2.0, 1.0);
        assert_eq!(table.emission(id), Some(SurfaceEmission { radiance: Some(radiance), sides: Sides::Front }));
        let surface = at(0.0);
        let toward = |wo| ShadingView { wo, ..ShadingView::along_normal(&surface) };
        assert_eq!(table.shade(id, &toward(Vec3::Y)).emission, radiance);
        assert_eq!(table.radiance(id, &toward(Vec3::Y)), radiance);
        assert!(table.shade(id, &toward(-Vec3::Y)).emission.is_black());
        assert!(table.radiance(id, &toward(-Vec3::Y)).is_black());
    }
    let (table, id) = compile(r#"{"principled": {"emissive": 1, "opacity": 0.5, "sides": "front"}}"#).unwrap();
    assert_eq!(table.emission(id), Some(SurfaceEmission { radiance: None, sides: Sides::Front }));
}

#[test]
fn nested_one_sided_materials_are_absent_from_behind() {
    let front = r#"{"diffuse": {"sides": "front"}}"#;
    let black = r#"{"diffuse": {"sides": "black_behind"}}"#;
    let behind = |json: &str| {
        let (table, id) = compile(json).unwrap();
        let wo = -Vec3::Y;
        let surface = at(0.0);
        let shading = table.shade(id, &ShadingView { wo, ..ShadingView::along_normal(&surface) });
        let straight = table.straight_transmittance(id, &surface, wo);
        assert_eq!(table.shadow_transmittance(id, &surface, wo), Rgb::splat(straight), "{json}");
        (straight, 1.0 - shading.opacity, table.is_absent(id, &surface, wo))
    };
    for json in [
        format!(r#"{{"mask": {{"opacity": 0.5, "material": {front}}}}}"#),
        format!(r#"{{"normal_map": {{"texture": "straight up", "material": {front}}}}}"#),
        format!(r#"{{"bump_map": {{"height": "waves", "material": {front}}}}}"#),
        format!(r#"{{"emissive": {{"sides": "both", "material": {front}}}}}"#),
        format!(r#"{{"checkerboard": {{"even": {front}, "odd": {black}}}}}"#),
    ] {
        assert_eq!(behind(&json), (1.0, 1.0, true), "{json}");
    }
    let mix = |a: &str, b: &str| format!(r#"{{"mix": {{"amount": 0.25, "a": {a}, "b": {b}}}}}"#);
    assert_eq!(behind(&mix(front, front)).0, 1.0);
    assert_eq!(behind(&mix(front, black)).0, 0.75);
    assert_eq!(behind(&format!(r#"{{"mask": {{"opacity": 0.5, "material": {black}}}}}"#)).0, 0.5);
}

#[test]
fn transmissive_principled_materials_keep_both_sides_and_say_so() {
    for field in ["transmission", "diffuse_transmission"] {
        let json = format!(r#"{{"principled": {{"{field}": 0.5, "sides": "front"}}}}"#);
        let (table, id) = compile(&json).unwrap();
        assert!(table.is_simple(id) && !table.has_opacity(id));
        let material: AnyMaterial = serde_json::from_str(&json).unwrap();
        assert_eq!(material.ineffective_settings(), [IneffectiveSetting { field: "sides", replaced_by: field }]);
    }
    let plain: AnyMaterial = serde_json::from_str(r#"{"principled": {"sides": "front"}}"#).unwrap();
    assert!(plain.ineffective_settings().is_empty());
    assert!(serde_json::to_string(&AnyMaterial::from(Diffuse::default())).unwrap().find("sides").is_none());
}
