//! White furnaces: under uniform illumination of radiance 1, objects that absorb no light have
//! radiance 1.

use crate::probe::{Estimate, Scene, looking, measure, path};
use juggler_math::{Transform, Vec3};

/// Radiance of a point of a sphere of this material, viewed at 45 degrees.
fn sphere(material: &str, samples: u32) -> Estimate {
    let scene = Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, material).in_light(1.0);
    let point = Vec3::new(1.0, 0.0, 1.0).normalize();
    // Without absorption, Russian roulette would only add noise.
    measure(&scene.world(), &looking(Vec3::Z * 5.0 + point, point), &*path(r#""max_depth": 1000"#), samples)
}

#[test]
fn white_objects_vanish() {
    let materials = [
        r#"{"diffuse": {"reflectance": 1}}"#,
        r#"{"diffuse": {"reflectance": 1, "roughness": 0.7}}"#,
        r#"{"conductor": {"reflectance": 1}}"#,
        r#"{"dielectric": {"ior": 1.5}}"#,
        r#"{"dielectric": {"ior": 2.4}}"#,
        r#"{"dielectric": {"ior": 0.7}}"#,
        r#"{"dielectric": {"ior": 1}}"#,
        r#"{"dielectric": {"ior": 1.5, "thin": true}}"#,
        r#"{"principled": {"base_color": 1, "transmission": 1, "roughness": 0, "specular": 0, "thin": true}}"#,
        r#"{"principled": {"base_color": 1, "transmission": 1, "roughness": 0, "specular": 0.5}}"#,
        r#"{"boundary": {"medium": {"scattering": 2, "anisotropy": 0.5}}}"#,
        r#"{"dielectric": {"ior": 1.3, "medium": {"scattering": [2, 1, 0.5], "anisotropy": -0.3}}}"#,
        r#"{"phong": {"diffuse": 1, "specular": 0}}"#,
        r#"{"phong": {"diffuse": 0.5, "specular": 0, "reflection": 0.5}}"#,
        r#"{"phong": {"diffuse": 0, "specular": 0, "reflection": 0.4, "transparency": 0.6, "ior": 1.5}}"#,
        r#"{"phong": {"diffuse": 0, "specular": 0, "reflection": 1, "transparency": 1, "ior": 1.5, "fresnel": true}}"#,
        r#"{"mix": {"amount": 0.3, "a": {"diffuse": {"reflectance": 1}}, "b": {"dielectric": {"ior": 1.5}}}}"#,
        r#"{"mask": {"opacity": 0.4, "material": {"diffuse": {"reflectance": 1}}}}"#,
    ];
    for material in materials {
        println!("{material}");
        sphere(material, 64).is(1.0);
    }
}

/// The tables of multiple scattering are accurate to half a percent per surface, and paths hit two
/// or more surfaces.
#[test]
fn rough_white_objects_nearly_vanish_in_a_furnace() {
    for roughness in [0.05, 0.3, 1.0] {
        let of = |kind: &str| format!(r#"{{"{kind}, "roughness": {roughness}}}}}"#);
        let kinds = [
            r#"conductor": {"reflectance": 1"#,
            r#"dielectric": {"ior": 1.5"#,
            r#"dielectric": {"ior": 0.7"#,
            r#"dielectric": {"ior": 1.5, "thin": true"#,
        ];
        for kind in kinds {
            // Light trapped in rough glass makes the estimate noisier.
            let samples = if kind.contains("ior") { 256 } else { 64 };
            let Estimate { mean, sigma } = sphere(&of(kind), samples);
            assert!((mean - 1.0).abs() < 3.0 * sigma + 0.007 && sigma < 0.004, "{kind}, {roughness}: {mean} ± {sigma}");
        }
    }
}

/// A turned cube refracts most light to a face at which reflection is total, where no specular
/// weight may absorb it.
#[test]
fn a_turned_cube_of_any_specular_weight_vanishes() {
    let turn = Transform::rotation(Vec3::new(1.0, 2.0, 0.5), 1.0).unwrap();
    for (specular, roughness) in [(0.0, 0.0), (0.3, 0.0), (0.0, 0.3)] {
        let glass = format!(
            r#"{{"principled": {{"base_color": 1, "transmission": 1, "specular": {specular}, "roughness": {roughness}}}}}"#
        );
        let scene = Scene::new().placed(r#"{"cuboid": {}}"#, turn, &glass).in_light(1.0);
        let camera = looking(Vec3::Z * 5.0 + Vec3::X * 0.2, Vec3::X * 0.2);
        let Estimate { mean, sigma } = measure(&scene.world(), &camera, &*path(r#""max_depth": 1000"#), 256);
        let bound = 4.0 * sigma + if roughness > 0.0 { 0.007 } else { 1e-5 };
        assert!((mean - 1.0).abs() <= bound && sigma < 0.004, "{glass}: {mean} ± {sigma}");
    }
}

/// Without energy compensation, light is lost, more on rougher surfaces.
#[test]
fn rough_metal_without_energy_compensation_is_darker() {
    let of = |roughness: f64| {
        sphere(
            &format!(
                r#"{{"conductor": {{"reflectance": 1, "roughness": {roughness}, "energy_compensation": false}}}}"#
            ),
            64,
        )
        .mean
    };
    let (smooth, rough) = (of(0.3), of(0.9));
    assert!(rough < 0.95 && rough > 0.4 && smooth < 1.0 && smooth > rough + 0.02, "{smooth} {rough}");
}

/// Many objects of all kinds that absorb no light, on a white floor under a white sky.
#[test]
fn a_white_scene_is_white() {
    let shapes = [
        (r#"{"cuboid": {}}"#, r#"{"dielectric": {"ior": 1.5}}"#),
        (r#"{"sphere": {"radius": 0.7}}"#, r#"{"diffuse": {"reflectance": 1}}"#),
        (r#"{"sphere": {"radius": 0.6}}"#, r#"{"dielectric": {"ior": 1.33}}"#),
        (r#"{"cylinder": {}}"#, r#"{"conductor": {"reflectance": 1}}"#),
        (r#"{"sphere": {"radius": 0.9}}"#, r#"{"boundary": {"medium": {"scattering": 3}}}"#),
    ];
    let mut scene = Scene::new().with(r#"{"plane": {}}"#, -Vec3::Y, r#"{"diffuse": {"reflectance": 1}}"#).in_light(1.0);
    for (i, (shape, material)) in (0u8..).zip(shapes) {
        let turn = Transform::rotation(Vec3::new(1.0, 2.0, 0.5), f32::from(i)).unwrap();
        let place = Transform::translation(Vec3::new(f32::from(i) * 1.1 - 2.0, 0.2, f32::from(i % 2) - 0.5));
        scene = scene.placed(shape, turn.then(&place), material);
    }
    let camera = crate::probe::camera(
        r#"{"perspective": {"eye": [0, 1.5, 6], "look_at": [0, 0, 0], "vertical_fov_degrees": 40}}"#,
    );
    measure(&scene.world(), &camera, &*path(r#""max_depth": 1000"#), 32).is(1.0);
}
