//! Motion blur of parts that move alone: a morph, a skin, a fast rotation. Each blurred picture
//! equals the mean of pictures at many times while the shutter is open, pixel by pixel. Emitters
//! in motion give the same picture by all strategies of sampling.

use super::blur::pixels;
use juggler::math::Rgb;
use juggler::scene::Scene;
use juggler::{Picture, Settings};
use std::fs;

/// Number of pictures whose mean is compared; a prime number, so that whole turns do not repeat
/// positions.
const INSTANTS: u32 = 257;
/// Samples per pixel of the blurred picture.
const SAMPLES: u32 = 1024;

/// A scene of emitting `objects` on black, so that a sample is 0 or 1, seen along −z.
fn emitters(objects: &str) -> String {
    format!(
        r#"{{"version": 1, "animation": {{"frames": 9, "frames_per_second": 8}}, "background": 0,
            "render": {{"size": [24, 24], "samples": 4, "integrator": "path", "filter": {{"box": {{}}}}}},
            "camera": {{"orthographic": {{"eye": [0, 0, 5], "look_at": [0, 0, 0], "height": 3}}}},
            "groups": {{"ball": [{{"shape": {{"sphere": {{"radius": 0.2}}}}, "transform": {{"translate": [1, 0, 0]}}}}]}},
            "materials": {{"light": {{"emissive": {{"radiance": 1, "sides": "both"}}}}}}, "objects": {objects}}}"#
    )
}

fn rendered(scene: &Scene, settings: &Settings) -> Vec<Rgb> {
    pixels(&Picture::new(scene, settings).unwrap())
}

/// Compares the picture of an open shutter with the mean of instants: each pixel by its z-score, and
/// the mean of the picture.
fn blur_is_the_mean_of_instants(scene: &Scene, frames: f64) {
    let open = Settings { shutter: Some([0.0, frames]), samples: Some(SAMPLES), ..Settings::default() };
    assert!(Picture::new(scene, &open).unwrap().world().moves());
    let blurred = rendered(scene, &open);
    let mut mean = vec![0.0; blurred.len()];
    for i in 0..INSTANTS {
        let frame = frames * (f64::from(i) + 0.5) / f64::from(INSTANTS);
        let few = Settings { samples: Some(16), seed: Some(u64::from(i)), ..Settings::default() };
        let instant = rendered(&scene.at_frame(frame).unwrap(), &few);
        mean.iter_mut().zip(instant).for_each(|(sum, pixel)| *sum += f64::from(pixel.g) / f64::from(INSTANTS));
    }
    let mut sum = 0.0;
    for (at, (blurred, mean)) in blurred.iter().zip(&mean).enumerate() {
        let difference = f64::from(blurred.g) - mean;
        sum += difference;
        // Standard deviation of a sample of 0 or 1, with the error of the finite number of instants.
        let deviation = (mean * (1.0 - mean) / f64::from(SAMPLES)).sqrt() + 1.5 / f64::from(INSTANTS);
        assert!(difference.abs() < 4.0 * deviation, "pixel {at}: {} and {mean}", blurred.g);
    }
    let bias = sum / mean.len() as f64;
    assert!(bias.abs() < 1e-3, "{bias}");
    let closed = rendered(scene, &Settings { samples: Some(64), ..Settings::default() });
    let change = closed.iter().zip(&mean).map(|(a, b)| (f64::from(a.g) - b).abs()).sum::<f64>();
    assert!(change > 0.02 * mean.len() as f64, "the instant is another picture");
}

fn of_objects(objects: &str) -> Scene {
    Scene::from_json(emitters(objects), "moving.json").unwrap()
}

#[test]
fn a_morph_that_moves_alone_is_blurred() {
    let scene = of_objects(
        r#"[{"material": "light", "shape": {"mesh": {"positions": [[-1, -1, 0], [0, -1, 0], [-0.5, 0, 0]],
            "triangles": [[0, 1, 2]], "morphs": [{"positions": [[0, 0, 0], [1, 0, 0], [0.5, 1.4, 0]],
            "weight": "=seconds * seconds"}]}}}]"#,
    );
    blur_is_the_mean_of_instants(&scene, 8.0);
}

/// The sphere's path has the radius 1 at all times, at 90° and at 6 turns, and in instances of
/// groups.
#[test]
fn a_part_that_rotates_about_a_distant_axis_is_blurred_along_the_circle() {
    let turning = |degrees: &str| {
        format!(
            r#"{{"group": "ball", "material": "light",
            "transform": [{{"rotate": {{"axis": [0, 0, 1], "degrees": "={degrees} * seconds"}}}}]}}"#
        )
    };
    for degrees in ["90", "-810", "2160", "5760"] {
        blur_is_the_mean_of_instants(&of_objects(&format!("[{}]", turning(degrees))), 8.0);
    }
    // Two instances share the group.
    let second = r#"{"group": "ball", "material": "light", "transform": {"translate": [-1, 0, 0]}}"#;
    blur_is_the_mean_of_instants(&of_objects(&format!("[{}, {second}]", turning("1000"))), 8.0);
}

/// A square of two joints, the upper of which turns by a right angle within a second.
const SKIN: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {}], "skins": [{"joints": [1, 2]}],
    "materials": [{"doubleSided": true, "emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2}, "indices": 3, "material": 0}]}],
    "animations": [{"channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}],
        "samplers": [{"input": 4, "output": 5}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.4, 0, 0], "max": [0.4, 1, 0]},
        {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC4"},
        {"bufferView": 1, "componentType": 5121, "count": 4, "type": "VEC4"},
        {"bufferView": 1, "byteOffset": 16, "componentType": 5121, "count": 6, "type": "SCALAR"},
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 2, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC4"}],
    "bufferViews": [{"buffer": 0, "byteLength": 112}, {"buffer": 0, "byteOffset": 112, "byteLength": 24},
        {"buffer": 0, "byteOffset": 136, "byteLength": 40}],
    "buffers": [{"uri": "skin.bin", "byteLength": 176}]}"#;

#[test]
fn a_skin_that_moves_alone_is_blurred() {
    let folder = tempfile::tempdir().unwrap();
    let positions = [[-0.4f32, 0.0, 0.0], [0.4, 0.0, 0.0], [-0.4, 1.0, 0.0], [0.4, 1.0, 0.0]].concat();
    let weights = [[1.0f32, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]].map(|[a, b]| [a, b, 0.0, 0.0]).concat();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let clip = [0.0f32, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half];
    let bytes = |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let joints = [[0u8, 1, 0, 0]; 4].concat();
    let indices = [0u8, 1, 2, 1, 3, 2, 0, 0];
    let buffer = [bytes(&positions), bytes(&weights), joints, indices.to_vec(), bytes(&clip)].concat();
    fs::write(folder.path().join("skin.bin"), buffer).unwrap();
    fs::write(folder.path().join("skin.gltf"), SKIN).unwrap();
    fs::write(folder.path().join("scene.json"), emitters(r#"[{"model": {"file": "skin.gltf"}}]"#)).unwrap();
    let scene = juggler::loader().load(folder.path().join("scene.json")).unwrap();
    blur_is_the_mean_of_instants(&scene, 7.0);
}
