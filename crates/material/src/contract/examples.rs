//! Contract of all materials, tested on the examples of every kind.

use super::*;
use juggler_bsdf::Scatter;
use juggler_math::testing::{Random, close, close3};

/// All examples, compiled with the names that they use.
fn examples() -> Vec<(String, MaterialTable, MaterialId)> {
    AnyMaterial::examples().into_iter().map(|example| compile_example(&example)).collect()
}

fn compile_example(material: &AnyMaterial) -> (String, MaterialTable, MaterialId) {
    let name = serde_json::to_string(material).unwrap();
    let red = Phong { diffuse: Rgb::new(0.9, 0.1, 0.0).into(), ..Phong::default() };
    let mut compiler = MaterialCompiler::new(textures(), [("red".to_owned(), red.into())]);
    let id = compiler.compile(material).unwrap_or_else(|error| panic!("{name}: {} {error}", error.path()));
    (name, compiler.finish().unwrap(), id)
}

/// Random point and orientation, with a shading normal that differs slightly from the geometric
/// normal.
fn random_surface(random: &mut Random) -> (Surface, Tangents) {
    let normal = random.unit_vector();
    let shading_normal = (normal + random.point(0.3)).normalize();
    let uv = Vec2::new(random.range(-3.0, 3.0), random.range(-3.0, 3.0));
    let surface = Surface { shading_normal, ..Surface::new(random.point(2.0), 0.0, normal, uv) };
    let (u, v) = (random.unit_vector().reject_from(normal) * 3.0, random.unit_vector().reject_from(normal) * 0.2);
    (surface, Tangents { u, v, local_u: u * 0.5, local_v: v * 0.5, given: None })
}

/// Share of the light along `wo` that is scattered, estimated from samples. Checks the samples
/// against `eval_pdf`.
fn energy(name: &str, shading: &Shading, wo: Vec3, random: &mut Random) -> Rgb {
    let count = 16;
    let mut sum = Rgb::BLACK;
    for i in 0..count * count {
        let cell = Vec2::new((i % count) as f32, (i / count) as f32);
        let u = ((cell + random.vec2()) / count as f32).min(Vec2::splat(1f32.next_down()));
        let Some(sample) = shading.bsdf.sample(wo, u, random.f32()) else { continue };
        assert!(sample.weight.to_array().iter().all(|w| *w >= 0.0 && w.is_finite()), "{name}: {sample:?}");
        assert!(sample.wi.is_normalized() && sample.pdf > 0.0, "{name}: {sample:?}");
        if sample.scatter != Scatter::Specular {
            let (value, pdf) = shading.bsdf.eval_pdf(wo, sample.wi);
            let (sampled, evaluated) = (sample.weight.g * sample.pdf, value.g);
            // In very narrow lobes, a rounded direction has another value.
            let near = (sampled - evaluated).abs() <= 0.02 * sampled.abs().max(evaluated.abs()) + 1e-4;
            assert!(near && close(pdf / sample.pdf, 1.0, 0.02), "{name}: {sampled} {evaluated}, {pdf} {sample:?}");
        }
        sum += sample.weight * (sample.ior * sample.ior / (count * count) as f32);
    }
    sum
}

#[test]
fn scattered_light_is_finite_and_conserves_energy() {
    let mut random = Random::new(811);
    for (name, table, id) in examples() {
        for _ in 0..60 {
            let (surface, tangents) = random_surface(&mut random);
            let tangents = Some(&tangents).filter(|_| random.f32() < 0.8);
            let outside_ior = if random.f32() < 0.5 { 1.0 } else { 1.4 };
            let wo = random.unit_vector();
            let view = ShadingView {
                wo,
                outside_ior,
                tangents,
                u_choice: random.f32(),
                ..ShadingView::along_normal(&surface)
            };
            let shading = table.shade(id, &view);
            assert!((0.0..=1.0).contains(&shading.opacity), "{name}: {shading:?}");
            assert!(shading.emission.to_array().iter().all(|v| *v >= 0.0 && v.is_finite()), "{name}: {shading:?}");
            let Frame { tangent, bitangent, normal } = shading.frame;
            assert!(close3(tangent.cross(bitangent), normal, 1e-5) && normal.is_normalized(), "{name}: {shading:?}");
            let energy = energy(&name, &shading, shading.frame.to_local(wo), &mut random);
            assert!(energy.max_channel() <= 1.1, "{name}: {energy:?} {shading:?}");
        }
    }
}

#[test]
fn surfaces_that_block_sight_show_no_light() {
    let mut random = Random::new(823);
    let (mut blocking, all) = (0, examples());
    let count = all.len();
    for (name, table, id) in all {
        let mut shows_light = false;
        for _ in 0..60 {
            let (surface, tangents) = random_surface(&mut random);
            let (wo, tangents, u_choice) = (random.unit_vector(), Some(&tangents), random.f32());
            let view = ShadingView { wo, tangents, u_choice, ..ShadingView::along_normal(&surface) };
            let shading = table.shade(id, &view);
            let passes = shading.opacity < 1.0 || table.is_absent(id, &surface, wo) || shading.transmissive;
            shows_light |= passes || shading.is_unlit || !shading.emission.is_black();
        }
        blocking += usize::from(table.blocks_sight(id));
        assert!(!(table.blocks_sight(id) && shows_light), "{name}");
    }
    assert!(blocking * 4 > count && blocking < count, "{blocking} of {count}");
}

/// Tests each example with a million samples from one direction. A material is a sum of lobes, and
/// the contract of `bsdf` tests each lobe from all directions.
#[test]
fn directions_follow_their_density() {
    let mut random = Random::new(816);
    let all = examples();
    let (mut tested, count) = (0, all.len());
    for (name, table, id) in all {
        let found = (0..20).find_map(|_| {
            let (surface, tangents) = random_surface(&mut random);
            let wo = random.unit_vector();
            let view = ShadingView {
                wo,
                tangents: Some(&tangents),
                u_choice: random.f32(),
                ..ShadingView::along_normal(&surface)
            };
            let shading = table.shade(id, &view);
            let local = shading.frame.to_local(wo);
            // Skip lobes narrower than the test's bins, and BSDFs that scatter nothing from here.
            let peak = (0..500).filter_map(|_| shading.bsdf.sample(local, random.vec2(), random.f32()));
            let peak = peak.filter(|s| s.scatter != Scatter::Specular).map(|s| s.pdf).fold(0.0, f32::max);
            (peak > 0.0 && peak < 50.0).then_some((shading.bsdf, local))
        });
        let Some((bsdf, local)) = found else { continue };
        let checked = juggler_bsdf::testing::follows_its_density(&bsdf, local, 1_000_000, 1e-3 / count as f64);
        assert!(checked.is_ok(), "{name}, {local}: {checked:?}");
        tested += 1;
    }
    assert!(tested * 2 > count, "{tested} of {count}");
}

#[test]
fn opaque_materials_are_two_sided() {
    let mut random = Random::new(812);
    let sided = |name: &str| {
        ["phong", "normal_map", "bump_map", "clearcoat_normal", "\"red\"", "black_behind"]
            .iter()
            .any(|kind| name.contains(kind))
    };
    let mut compared = 0;
    for (name, table, id) in examples().into_iter().filter(|(name, ..)| !sided(name)) {
        for _ in 0..20 {
            let (surface, tangents) = random_surface(&mut random);
            let turned = Surface { normal: -surface.normal, shading_normal: -surface.shading_normal, ..surface };
            let view = ShadingView {
                wo: random.unit_vector(),
                tangents: Some(&tangents),
                ..ShadingView::along_normal(&surface)
            };
            let other = ShadingView { surface: &turned, normal: turned.shading_normal, ..view };
            let (one, other) = (table.shade(id, &view), table.shade(id, &other));
            if table.interior(id).is_some() || one.opacity == 0.0 || other.opacity == 0.0 {
                continue;
            }
            let wi = random.unit_vector();
            let light =
                |shading: &Shading| shading.bsdf.eval(shading.frame.to_local(view.wo), shading.frame.to_local(wi));
            assert_eq!(light(&one), light(&other), "{name}");
            compared += u32::from(!light(&one).is_black());
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn shading_normals_of_dielectrics_point_outside() {
    let mut random = Random::new(813);
    let (mut inside, mut thin) = (0, 0);
    for (name, table, id) in examples() {
        for _ in 0..10 {
            let (surface, tangents) = random_surface(&mut random);
            let wo = random.unit_vector();
            let shading =
                table.shade(id, &ShadingView { wo, tangents: Some(&tangents), ..ShadingView::along_normal(&surface) });
            if table.interior(id).is_some() {
                assert!(shading.opacity == 0.0 || shading.transmissive, "{name}");
                let outwards = shading.frame.normal.dot(surface.normal) > 0.0;
                assert!(outwards || shading.opacity == 0.0, "{name}");
                inside += 1;
            } else {
                assert!(shading.frame.normal.dot(wo) > 0.0, "{name}");
                thin += u32::from(shading.transmissive);
            }
        }
    }
    assert!(inside > 0 && thin > 0);
    // The relative index of refraction is the index inside over the index around, for every kind.
    for json in
        [r#"{"dielectric": {"ior": 1.8}}"#, r#"{"principled": {"ior": 1.8, "transmission": 1, "roughness": 0}}"#]
    {
        let (table, id) = compile(json).unwrap();
        let interior = table.interior(id).unwrap();
        assert_eq!(table.interiors()[interior.index()].ior, 1.8);
        let surface = at(0.0);
        let shading = table.shade(id, &ShadingView { outside_ior: 1.2, ..ShadingView::along_normal(&surface) });
        let through = shading.bsdf.deltas(Vec3::Z).into_iter().find(|delta| delta.is_transmitted(Vec3::Z)).unwrap();
        assert!(close(through.ior, 1.5, 1e-6), "{through:?}");
    }
}

#[test]
fn emission_of_the_table_bounds_the_shading() {
    let mut random = Random::new(814);
    let masked = [
        r#"{"emissive": {"radiance": 2, "material": {"mask": {"opacity": 0.3}}}}"#,
        r#"{"mix": {"amount": 0.25, "a": {"emissive": {"radiance": 4}}, "b": {"mask": {"opacity": "tiles", "material":
            {"mix": {"a": {"principled": {"emissive": [1, 2, 3]}}}}}}}}"#,
    ];
    let more = masked.map(|json| compile_example(&serde_json::from_str(json).unwrap()));
    let mut emitting = 0;
    for (name, table, id) in examples().into_iter().chain(more) {
        for _ in 0..10 {
            let (surface, _) = random_surface(&mut random);
            let view = ShadingView { wo: random.unit_vector(), ..ShadingView::along_normal(&surface) };
            let picks = 200;
            let mut mean = Rgb::BLACK;
            for i in 0..picks {
                let shading = table.shade(id, &ShadingView { u_choice: (i as f32 + 0.5) / picks as f32, ..view });
                // The color of an unlit surface is no emission.
                let weight = if shading.is_unlit { 0.0 } else { shading.opacity };
                mean += shading.emission * (weight / picks as f32);
            }
            let radiance = table.radiance(id, &view);
            let near = (mean - radiance).map(f32::abs).max_channel() <= 0.03 * radiance.max_channel() + 1e-6;
            assert!(near, "{name}: {mean:?} {radiance:?}");
            match table.emission(id) {
                None => assert!(radiance.is_black(), "{name}"),
                Some(SurfaceEmission { radiance: Some(known), sides }) if sides == Sides::Both || view.is_outside() => {
                    assert_eq!(known, radiance, "{name}");
                    emitting += 1;
                }
                Some(emission) => assert!(emission.radiance.is_none() || radiance.is_black(), "{name}"),
            }
        }
    }
    assert!(emitting > 0);
}

/// Fields that may be textures, for each kind with several of them.
const WILD: &[(&str, &[&str])] = &[
    ("diffuse", &["reflectance", "roughness"]),
    ("conductor", &["reflectance", "edge_tint", "roughness", "anisotropy", "anisotropy_rotation"]),
    ("dielectric", &["roughness", "anisotropy", "anisotropy_rotation", "reflection_tint", "transmission_tint"]),
    (
        "plastic",
        &["reflectance", "diffuse_roughness", "roughness", "anisotropy", "anisotropy_rotation", "reflection_tint"],
    ),
    ("velvet", &["sheen_color", "sheen_roughness", "reflectance", "roughness"]),
    ("translucent", &["reflectance", "transmittance"]),
    (
        "principled",
        &[
            "base_color",
            "metallic",
            "roughness",
            "specular",
            "specular_color",
            "anisotropy",
            "anisotropy_rotation",
            "clearcoat",
            "clearcoat_roughness",
            "sheen_color",
            "sheen_roughness",
            "iridescence",
            "iridescence_thickness",
            "transmission",
            "diffuse_transmission",
            "diffuse_transmission_color",
            "opacity",
        ],
    ),
    ("unlit", &["color", "opacity"]),
    ("normal_map", &["texture", "strength"]),
    ("bump_map", &["height"]),
];

#[test]
fn textures_beyond_their_range_are_cut_off() {
    let mut random = Random::new(815);
    for (kind, fields) in WILD {
        let all = fields.iter().map(|field| vec![*field]).chain([fields.to_vec()]);
        for wild in all {
            let texts: Vec<String> = wild.iter().map(|field| format!(r#""{field}": "wild""#)).collect();
            let json = format!(r#"{{"{kind}": {{{}}}}}"#, texts.join(", "));
            let (table, id) = compile(&json).unwrap_or_else(|error| panic!("{json}: {error}"));
            // Rotation has no effect on isotropic roughness.
            assert!(table.is_textured(id) || wild == ["anisotropy_rotation"], "{json}");
            for _ in 0..8 {
                let (surface, tangents) = random_surface(&mut random);
                let wo = random.unit_vector();
                let view = ShadingView { wo, tangents: Some(&tangents), ..ShadingView::along_normal(&surface) };
                let shading = table.shade(id, &view);
                let energy = energy(&json, &shading, shading.frame.to_local(wo), &mut random);
                assert!(energy.max_channel() <= 1.1, "{json}: {energy:?}");
                assert!((0.0..=1.0).contains(&shading.opacity), "{json}");
            }
        }
        // The error about an unknown name states its field.
        for field in *fields {
            let error = compile(&format!(r#"{{"{kind}": {{"{field}": "nothing"}}}}"#)).unwrap_err();
            assert_eq!(error.path(), format!("{kind}.{field}"));
        }
    }
}

#[test]
fn invalid_fields_are_rejected_by_path() {
    for (json, path) in [
        (r#"{"diffuse": {"roughness": 2}}"#, "diffuse.roughness"),
        (r#"{"conductor": {"anisotropy": -2}}"#, "conductor.anisotropy"),
        (r#"{"dielectric": {"anisotropy_rotation": 1e9}}"#, "dielectric.anisotropy_rotation"),
        (r#"{"plastic": {"ior": 0.9}}"#, "plastic.ior"),
        (r#"{"plastic": {"reflectance": [0, 2, 0]}}"#, "plastic.reflectance"),
        (r#"{"velvet": {"sheen_roughness": -1}}"#, "velvet.sheen_roughness"),
        (r#"{"translucent": {"reflectance": 0.6, "transmittance": [0.1, 0.5, 0.1]}}"#, "translucent.transmittance"),
        (r#"{"principled": {"metallic": 1.5}}"#, "principled.metallic"),
        (r#"{"principled": {"ior": 0.5}}"#, "principled.ior"),
        (r#"{"principled": {"emissive": [-1, 0, 0]}}"#, "principled.emissive"),
        (r#"{"principled": {"emissive_strength": -1}}"#, "principled.emissive_strength"),
        (r#"{"principled": {"medium": {"distance": 0}}}"#, "principled.medium.distance"),
        (r#"{"principled": {"alpha_cutoff": 3}}"#, "principled.alpha_cutoff"),
        (r#"{"principled": {"opacity": -0.1}}"#, "principled.opacity"),
        (r#"{"principled": {"dispersion": -0.1}}"#, "principled.dispersion"),
        (r#"{"principled": {"clearcoat_normal": [0.5, 1.5, 1]}}"#, "principled.clearcoat_normal"),
        (r#"{"principled": {"clearcoat_normal_scale": -1}}"#, "principled.clearcoat_normal_scale"),
        (r#"{"dielectric": {"dispersion": 21}}"#, "dielectric.dispersion"),
        (r#"{"mask": {"cutoff": 2}}"#, "mask.cutoff"),
        (r#"{"normal_map": {"strength": -1}}"#, "normal_map.strength"),
        (r#"{"normal_map": {"material": {"plastic": {"ior": 11}}}}"#, "normal_map.material.plastic.ior"),
        (r#"{"bump_map": {"distance": 1e9}}"#, "bump_map.distance"),
        (r#"{"bump_map": {"material": "nobody"}}"#, "bump_map.material"),
    ] {
        assert_eq!(compile(json).map(|_| ()).unwrap_err().path(), path, "{json}");
    }
}

#[test]
fn alpha_cutoff_makes_opacity_binary() {
    for (fields, opacity) in [(r#""opacity": 0.4"#, 0.4), (r#""opacity": 0.4, "alpha_cutoff": 0.5"#, 0.0)] {
        let (table, id) = compile(&format!(r#"{{"principled": {{{fields}}}}}"#)).unwrap();
        assert!(table.has_opacity(id) && table.is_transparent(id));
        assert!(close(table.straight_transmittance(id, &at(0.0), Vec3::Y), 1.0 - opacity, 1e-6));
        assert!(close(table.shadow_transmittance(id, &at(0.0), Vec3::Y).g, 1.0 - opacity, 1e-6));
        assert_eq!(table.shade(id, &ShadingView::along_normal(&at(0.0))).opacity, opacity);
    }
    let (table, id) = compile(r#"{"principled": {"opacity": "tiles", "alpha_cutoff": 0.2}}"#).unwrap();
    assert_eq!([0.5, 1.5].map(|x| table.straight_transmittance(id, &at(x), Vec3::Y)), [0.0, 1.0]);
    let (table, id) = compile(r#"{"principled": {"opacity": 0.6, "alpha_cutoff": 0.5}}"#).unwrap();
    assert!(!table.has_opacity(id));
}
