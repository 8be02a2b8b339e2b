//! Emitters in motion: light samples, BSDF samples and both combined have one expected value, that
//! of a numerical integral where there is one.

use super::blur::pixels;
use juggler::scene::Scene;
use juggler::{Picture, Settings};

/// Reflectance of the floor.
const REFLECTANCE: f64 = 0.8;

/// Mean radiance that the floor around the origin reflects, by each of the strategies `mis`, `light`
/// and `bsdf`. The shutter is open for one second.
fn reflected(objects: &str) -> [f64; 3] {
    ["mis", "light", "bsdf"].map(|sampling| {
        let scene = format!(
            r#"{{"version": 1, "animation": {{"frames": 9, "frames_per_second": 8}}, "background": 0,
            "render": {{"size": [16, 16], "samples": 2048, "shutter": [0, 8],
                "integrator": {{"path": {{"max_depth": 2, "sampling": "{sampling}"}}}}}},
            "camera": {{"orthographic": {{"eye": [0, 0.5, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "height": 0.01}}}},
            "materials": {{"floor": {{"diffuse": {{"reflectance": {REFLECTANCE}}}}},
                "light": {{"emissive": {{"radiance": 10, "sides": "both"}}}}}},
            "groups": {{"square": [{{"shape": {{"mesh": {{"positions": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
                    "triangles": [[0, 1, 2], [0, 2, 3]]}}}}, "transform": {{"translate": ["=1 + 2 * seconds", 0, 0]}}}}]}},
            "objects": [{{"shape": {{"plane": {{}}}}, "material": "floor"}}, {objects}]}}"#
        );
        let scene = Scene::from_json(scene, "emitters.json").unwrap();
        let all = pixels(&Picture::new(&scene, &Settings::default()).unwrap());
        all.iter().map(|pixel| f64::from(pixel.g)).sum::<f64>() / all.len() as f64
    })
}

/// The means must agree within 3 %, more than four standard deviations of the noise.
fn all_strategies_agree(name: &str, objects: &str) -> f64 {
    let [mis, light, bsdf] = reflected(objects);
    assert!(
        mis > 0.01 && (light / mis - 1.0).abs() < 0.03 && (bsdf / mis - 1.0).abs() < 0.03,
        "{name}: {mis} {light} {bsdf}"
    );
    mis
}

#[test]
fn an_emitter_whose_mesh_moves_illuminates_as_the_integral_says() {
    let found = all_strategies_agree(
        "morph",
        r#"{"shape": {"mesh": {"positions": [[-2.5, 2, -0.5], [-1.5, 2, -0.5], [-1.5, 2, 0.5], [-2.5, 2, 0.5]],
            "triangles": [[0, 1, 2], [0, 2, 3]], "morphs": [{"weight": "=seconds",
                "positions": [[1.5, 2, -0.5], [2.5, 2, -0.5], [2.5, 2, 0.5], [1.5, 2, 0.5]]}]}}, "material": "light"}"#,
    );
    // Irradiance from a square at height 2: the integral of 1 · cos² / d² over area and time.
    const STEPS: i32 = 100;
    let at = |step: i32| (f64::from(step) + 0.5) / f64::from(STEPS);
    let mut sum = 0.0;
    for time in 0..STEPS {
        for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
            let (x, z) = (4.0 * at(time) - 2.0 + at(i) - 0.5, at(j) - 0.5);
            let squared = x * x + z * z + 4.0;
            sum += 4.0 / (squared * squared);
        }
    }
    let expected = sum / f64::from(STEPS).powi(3) * 10.0 * REFLECTANCE / std::f64::consts::PI;
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

/// Triangles without an area at the first or at all keyframes, with unequal growth.
#[test]
fn strategies_agree_on_meshes_that_deform() {
    let cases = [
        (
            "grows",
            "[[-1, 1.5, 0], [1, 1.5, 0], [1, 1.5, 0.001], [-1, 1.5, 0.01]]",
            "[[-1, 2, 0], [1, 1, 0], [0, 1.5, 2], [-1, 1.5, 0.01]]",
        ),
        (
            "folds",
            "[[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]]",
            "[[-1, 3, -1], [1, 1, -1], [1, 2, 1], [1, 1, -1]]",
        ),
    ];
    for (name, positions, morph) in cases {
        let mesh = format!(
            r#"{{"shape": {{"mesh": {{"positions": {positions}, "triangles": [[0, 1, 2], [0, 2, 3]],
                "morphs": [{{"weight": "=seconds", "positions": {morph}}}]}}}}, "material": "light",
                "transform": {{"rotate": {{"axis": [0, 1, 0], "degrees": "=90 * seconds"}}}}}}"#
        );
        all_strategies_agree(name, &mesh);
    }
}

/// The shared group moves within its instances, which scale, rotate and move.
#[test]
fn strategies_agree_on_emitters_that_move_in_moving_instances() {
    let instance = |x: f32| {
        format!(
            r#"{{"group": "square", "material": "light", "transform": [{{"scale": ["=0.2 + seconds", 1, "=1 - 0.8 * seconds"]}},
                {{"rotate": {{"axis": [0, 0, 1], "degrees": "=50 * seconds"}}}}, {{"translate": [{x}, 2, 0]}}]}}"#
        )
    };
    let all: Vec<String> = (0..80).map(|i| instance(i as f32 * 0.02 - 2.0)).collect();
    all_strategies_agree("instances", &all.join(", "));
    let sphere = r#"{"shape": {"sphere": {"radius": "=0.2 + 0.3 * seconds"}}, "material": "light",
        "transform": [{"translate": [1, 0, 0]}, {"rotate": {"axis": [0, 1, 0], "degrees": "=700 * seconds"}}, {"translate": [0, 1.5, 0]}]}"#;
    all_strategies_agree("sphere", sphere);
}
