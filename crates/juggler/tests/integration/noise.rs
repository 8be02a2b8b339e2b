//! Significance tests on rendered images that differ only by noise, and on others.

use juggler::imaging::significance::{NoisyImage, significance};
use juggler::render::Control;
use juggler::{Picture, Settings, estimate};
use juggler_scene::Scene;

/// A room with a small emitter, glass, a rough mirror and a sky through the window, for many kinds
/// of noise.
fn room(power: f32, material: &str) -> Scene {
    let text = format!(
        r#"{{"version": 1,
        "render": {{"size": [40, 30], "samples": 32, "integrator": "path"}},
        "camera": {{"perspective": {{"eye": [0, 1.2, 5], "look_at": [0, 0.9, 0], "vertical_fov_degrees": 40}}}},
        "background": [0.2, 0.3, 0.5],
        "lights": [{{"point": {{"position": [2, 4, 3], "intensity": {}}}}}],
        "objects": [
            {{"shape": "plane", "material": {{"diffuse": {{"reflectance": [0.6, 0.5, 0.4]}}}}}},
            {{"shape": {{"sphere": {{"radius": 0.7}}}}, "transform": [{{"translate": [-1, 0.7, 0]}}], "material": {material}}},
            {{"shape": {{"sphere": {{"radius": 0.6}}}}, "transform": [{{"translate": [1, 0.6, 0.4]}}],
              "material": {{"conductor": {{"roughness": 0.3}}}}}},
            {{"shape": {{"sphere": {{"radius": 0.1}}}}, "transform": [{{"translate": [0, 2.4, -1]}}],
              "material": {{"emissive": {{"radiance": [1, 0.8, 0.5], "scale": {}}}}}}}
        ]}}"#,
        30.0 * power,
        60.0 * power
    );
    Scene::from_json(text, "room.json").unwrap()
}

const SMALL: [u32; 2] = [40, 30];
const LARGE: [u32; 2] = [112, 84];
const GLASS: &str = r#"{"dielectric": {"ior": 1.5}}"#;

fn estimated(scene: &Scene, seed: u64, samples: u32, size: [u32; 2]) -> NoisyImage {
    let settings = Settings { seed: Some(seed), samples: Some(samples), size: Some(size), ..Settings::default() };
    let picture = Picture::new(scene, &settings).unwrap();
    let film = picture.film();
    picture.render_film(&film, &Control::default()).unwrap();
    estimate::from_film(&film)
}

#[test]
fn significance_of_different_seeds_is_calibrated() {
    let scene = room(1.0, GLASS);
    for (first, second) in [(32, 32), (32, 96)] {
        let pairs: Vec<f64> = (0..40)
            .map(|pair| {
                let a = estimated(&scene, 2 * pair, first, SMALL);
                significance(&a, &estimated(&scene, 2 * pair + 1, second, SMALL)).unwrap().p
            })
            .collect();
        let mean = pairs.iter().sum::<f64>() / 40.0;
        let below = |level: f64| pairs.iter().filter(|p| **p <= level).count();
        // Of 40 pairs, more than 3 below 1 % have a probability of 1 in 1,300, more than 11 below
        // 10 % 1 in 1,700.
        assert!(below(0.01) <= 3 && below(0.1) <= 11, "{pairs:?}");
        assert!(below(0.5) >= 4 && mean < 0.9, "far too cautious: {pairs:?}");
    }
}

#[test]
fn significance_detects_changed_lights_and_materials() {
    let plain = estimated(&room(1.0, GLASS), 1, 64, LARGE);
    let brighter = estimated(&room(1.02, GLASS), 2, 64, LARGE);
    let other = estimated(&room(1.0, r#"{"dielectric": {"ior": 1.6}}"#), 3, 64, LARGE);
    let darker = estimated(&room(1.0, r#"{"dielectric": {"ior": 1.5, "transmission_tint": 0.9}}"#), 4, 64, LARGE);
    let again = estimated(&room(1.0, GLASS), 5, 64, LARGE);
    for changed in [&brighter, &other, &darker] {
        let found = significance(&plain, changed).unwrap();
        assert!(found.p < 0.01, "{found:?}");
    }
    let found = significance(&plain, &again).unwrap();
    assert!(found.p > 0.01, "{found:?}");
}
