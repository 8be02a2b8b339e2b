//! Pictures do not depend on the unit of length: scenes scaled by 1e-4 and 1e6, and models at their
//! original size, look the same.
//!
//! With `JUGGLER_PICTURES=folder` the test also writes the pictures there.

use crate::model::Model;
use juggler::math::{Image, Ray, Vec3};
use juggler::scene::Scene;
use juggler::{Picture, Settings};
use serde_json::{Value, json};

const SIZE: [u32; 2] = [120, 80];

/// Converts lengths to scene units.
fn lengths<const N: usize>(unit: f64, values: [f64; N]) -> Value {
    json!(values.map(|value| value * unit).as_slice())
}

fn render(scene: &Value, name: &str) -> Image {
    let scene = Scene::from_json(scene.to_string(), name).unwrap();
    if let Some(folder) = std::env::var_os("JUGGLER_PICTURES") {
        let place = std::path::Path::new(&folder).join(format!("{name}.png"));
        let large = Settings { size: Some(SIZE.map(|n| 5 * n)), ..Settings::default() };
        juggler::render_to_file(&scene, &large, place).unwrap();
    }
    juggler::render(&scene, &Settings::default()).unwrap()
}

/// Fraction of pixels in which two pictures differ by more than a thousandth of white.
fn differing_fraction(a: &Image, b: &Image) -> f64 {
    let differ = |(a, b): (&juggler::math::Rgb, &juggler::math::Rgb)| {
        a.to_array().into_iter().zip(b.to_array()).any(|(a, b)| (a - b).abs() > 1e-3 || a.is_nan() != b.is_nan())
    };
    let count = a.pixels().iter().zip(b.pixels()).filter(|pair| differ(*pair)).count();
    count as f64 / a.pixels().len() as f64
}

/// A scene of every kind of solid on a checkered ground, with a mirror, glass, soft and hard
/// shadows, occlusion, and a light on a wall. `unit` is the unit of length; `scaled` uses shapes of
/// unit size with a scaling transform instead of large shapes.
fn still_life(unit: f64, scaled: bool) -> Value {
    json!({
        "version": 1,
        "render": {"size": SIZE, "samples": 4, "integrator": {"classic": {"occlusion_distance": unit}}},
        "camera": {"perspective": {"eye": lengths(unit, [1.0, 2.5, 7.0]), "look_at": lengths(unit, [0.0, 0.9, 0.0]),
            "vertical_fov_degrees": 40}},
        "background": {"solid": {"color": [0.2, 0.3, 0.5]}},
        "materials": {
            "ground": {"checkerboard": {"size": 0.7 * unit}},
            "ball": {"checkerboard": {"size": if scaled { 0.3 } else { 0.3 * unit }}},
            "plain": {"phong": {"diffuse": [0.7, 0.4, 0.2], "ambient": 0.5, "occlusion": 1}},
            "mirror": {"phong": {"diffuse": 0.05, "reflection": 0.9}},
            "glass": {"phong": {"diffuse": 0, "reflection": 1, "transparency": 0.95, "ior": 1.5, "fresnel": true}},
        },
        "lights": [
            {"ambient": {"color": 0.3}},
            {"point": {"position": lengths(unit, [3.0, 6.0, 4.0]), "intensity": 0.7, "attenuation": {"constant": 1},
                "extent": {"sphere": {"radius": 0.5 * unit}}}},
            {"point": {"position": lengths(unit, [-2.0, 3.0, -2.5]), "intensity": 0.4, "attenuation": {"constant": 1}}},
        ],
        "objects": objects(unit, scaled),
    })
}

fn objects(unit: f64, scaled: bool) -> Vec<Value> {
    let object = |kind: &str, mut shape: Value, material: &str, turn: f64, place: [f64; 3]| {
        let mut steps = vec![json!({"rotate": {"axis": [1, 2, 0.5], "degrees": turn}})];
        if scaled {
            steps.push(json!({"scale": unit}));
        } else {
            scale(&mut shape, unit);
        }
        steps.push(json!({"translate": lengths(unit, place)}));
        json!({"shape": {kind: shape}, "material": material, "transform": steps})
    };
    let cube = json!({"min": [-0.5, -0.5, -0.5], "max": [0.5, 0.5, 0.5]});
    let tetrahedron = json!({"positions": [[0, 0, 0], [1, 0, 0], [0, 0, -1], [0.3, 1, -0.3]],
        "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]});
    vec![
        json!({"shape": "plane", "material": "ground"}),
        json!({"shape": {"rectangle": {"size": lengths(unit, [20.0, 20.0])}}, "material": "plain", "transform": [
            {"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": lengths(unit, [0.0, 0.0, -2.5])}]}),
        object("sphere", json!({"radius": 0.8}), "mirror", 0.0, [-1.6, 0.8, -0.5]),
        object("sphere", json!({"radius": 0.6}), "glass", 0.0, [0.9, 0.6, 2.0]),
        object("sphere", json!({"radius": 0.5}), "ball", 50.0, [-0.8, 0.5, 1.8]),
        object("cuboid", cube, "plain", 30.0, [0.2, 0.8, -0.4]),
        object("cylinder", json!({"radius": 0.3, "y_min": 0.0, "y_max": 1.4}), "plain", 0.0, [1.9, 0.0, -0.8]),
        object("disk", json!({"radius": 0.6, "inner_radius": 0.2}), "plain", 70.0, [2.4, 0.7, 0.6]),
        object("mesh", tetrahedron, "plain", 20.0, [-2.8, 0.3, 1.2]),
    ]
}

/// Multiplies all lengths of a shape; vertex indices stay.
fn scale(shape: &mut Value, unit: f64) {
    match shape {
        Value::Array(values) => values.iter_mut().for_each(|value| scale(value, unit)),
        Value::Object(fields) => {
            fields.iter_mut().filter(|(name, _)| *name != "triangles").for_each(|(_, value)| scale(value, unit));
        }
        Value::Number(number) => *shape = json!(number.as_f64().unwrap() * unit),
        _ => {}
    }
}

#[test]
fn a_scene_looks_the_same_in_any_unit() {
    for scaled in [false, true] {
        let expected = render(&still_life(1.0, scaled), &format!("still-life-1-{scaled}"));
        for unit in [1e-4, 1e6] {
            let fraction = differing_fraction(
                &render(&still_life(unit, scaled), &format!("still-life-{unit:e}-{scaled}")),
                &expected,
            );
            assert!(fraction <= 0.004, "unit {unit}, scaled {scaled}: {fraction} of all pixels differ");
        }
    }
}

/// A scene of a model on the ground under a light that casts shadows, viewed from the front, right
/// and above.
fn portrait(model: &Model) -> Value {
    let (low, high) = model.corners();
    let (size, center) = (f64::from((high - low).max_element()), (low + high) * 0.5);
    let beside = |x: f32, y: f32, z: f32| json!((center + Vec3::new(x, y, z) * size as f32).to_array());
    let corners: Vec<[f32; 3]> = model.positions.iter().map(|p| p.to_array()).collect();
    json!({
        "version": 1,
        "render": {"size": SIZE, "samples": 1},
        "camera": {"perspective": {
            "eye": beside(1.0, 0.7, 1.6), "look_at": center.to_array(), "vertical_fov_degrees": 38
        }},
        "background": {"solid": {"color": [0.3, 0.4, 0.6]}},
        "materials": {"clay": {"phong": {"diffuse": 0.8, "ambient": 0.2}}},
        "lights": [{"ambient": {"color": 0.3}},
            {"point": {"position": beside(1.5, 3.0, 1.0), "attenuation": {"constant": 1}}}],
        "objects": [
            {"shape": {"mesh": {"positions": corners, "triangles": model.triangles}}, "material": "clay"},
            {"shape": "plane", "material": "clay", "transform": [{"translate": [0, low.y, 0]}]},
        ],
    })
}

/// Fraction of shadow rays that are blocked within a thousandth of the model's size, which only
/// creases may cause.
fn self_shadowed_fraction(model: &Model) -> f64 {
    let scene = Scene::from_json(portrait(model).to_string(), "portrait").unwrap();
    let picture = Picture::new(&scene, &Settings::default()).unwrap();
    let (low, high) = model.corners();
    let (size, center) = ((high - low).max_element(), (low + high) * 0.5);
    let eye = center + Vec3::new(1.0, 0.7, 1.6) * size;
    let light = center + Vec3::new(1.5, 3.0, 1.0) * size;
    let (mut count, mut stopped) = (0u32, 0u32);
    for i in 0..200_u16 {
        for j in 0..200_u16 {
            let target = low + (high - low) * Vec3::new(f32::from(i) / 199.0, f32::from(j) / 199.0, 0.5);
            let mut ray = Ray::new(eye, (target - eye).normalize());
            let hit = picture.world().closest(&mut ray);
            if !hit.is_some() {
                continue;
            }
            let surface = picture.world().vertex(&ray, &hit).surface;
            let to = light - surface.point;
            if to.dot(surface.normal) * -ray.direction.dot(surface.normal) > 0.0 {
                count += 1;
                let mut shadow = surface.spawn_ray_to(to.normalize(), to.length(), 0.0);
                let blocker = picture.world().closest(&mut shadow);
                stopped += u32::from(blocker.is_some() && blocker.hit.t < 1e-3 * size);
            }
        }
    }
    assert!(count > 5_000, "only {count} places can be lit");
    f64::from(stopped) / f64::from(count)
}

/// An avocado of 6 cm and a fox of 155 units, at their original size.
#[test]
fn models_show_no_acne_at_the_size_they_come_in() {
    for (name, longest) in [("Avocado/glTF/Avocado.gltf", 0.0629), ("Fox/glTF-Binary/Fox.glb", 154.7)] {
        let Some(native) = Model::asset(name) else { return };
        let (low, high) = native.corners();
        let size = (high - low).max_element();
        assert!((size / longest - 1.0).abs() < 1e-3, "{name} is {size} long");
        let short = name.split('/').next().unwrap_or(name);
        let expected = render(&portrait(&native.scaled(1.0 / size)), &format!("{short}-unit"));
        for factor in [1.0, 1e-4 / size, 1e6 / size] {
            let model = native.scaled(factor);
            let fraction = differing_fraction(&render(&portrait(&model), &format!("{short}-{factor:e}")), &expected);
            assert!(fraction <= 0.004, "{name} times {factor}: {fraction} of all pixels differ");
            let stopped = self_shadowed_fraction(&model);
            assert!(stopped < 2e-3, "{name} times {factor}: {stopped} of all shadow rays end where they start");
        }
    }
}
