//! Model files as pictures: points and lines are seen, in their colors.

use juggler::Settings;
use juggler::math::{Image, Rgb};
use juggler_scene::Scene;
use std::fs;
use std::path::Path;

/// Writes a glTF file of one primitive of this mode, with colored vertices.
fn write(path: &Path, mode: u32, vertices: &[([f32; 3], [f32; 3])]) {
    let numbers = vertices.iter().map(|(at, _)| at).chain(vertices.iter().map(|(_, color)| color)).flatten();
    let bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
    let (count, half) = (vertices.len(), bytes.len() / 2);
    let accessor =
        |view: usize| format!(r#"{{"bufferView": {view}, "componentType": 5126, "type": "VEC3", "count": {count}}}"#);
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "COLOR_0": 1}}, "mode": {mode}}}]}}],
            "buffers": [{{"uri": "{}", "byteLength": {}}}], "accessors": [{}, {}],
            "bufferViews": [{{"buffer": 0, "byteLength": {half}}},
                {{"buffer": 0, "byteOffset": {half}, "byteLength": {half}}}]}}"#,
        path.with_extension("bin").file_name().unwrap().to_str().unwrap(),
        bytes.len(),
        accessor(0),
        accessor(1),
    );
    fs::write(path.with_extension("bin"), bytes).unwrap();
    fs::write(path, text).unwrap();
}

fn render(path: &Path, size: [u32; 2]) -> Image {
    let scene = juggler::loader().load(path).unwrap();
    let settings = Settings { size: Some(size), samples: Some(64), ..Settings::default() };
    juggler::render(&scene, &settings).unwrap()
}

/// The pixel of each column that differs most from the background, with the difference.
fn strongest(image: &Image) -> Vec<(Rgb, f32)> {
    let (width, height) = (image.width(), image.height());
    let distance = |pixel: &Rgb| {
        let [r, g, b] = pixel.to_array();
        (r - 0.9).abs().max((g - 0.9).abs()).max((b - 0.9).abs())
    };
    let column = |x: u32| {
        let pixels = (0..height).map(|y| image.pixels()[(y * width + x) as usize]);
        pixels.map(|pixel| (pixel, distance(&pixel))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    };
    (0..width).map(column).collect()
}

/// The background is 0.9. A black line of two pixels fills at least one pixel of each column that
/// it crosses; one of a thousandth of the diagonal stays gray in small pictures.
#[test]
fn a_line_is_seen_in_pictures_of_all_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("line.gltf");
    write(&path, 1, &[([-1.0, -0.3, 0.0], [0.0; 3]), ([1.0, 0.4, 0.0], [0.0; 3])]);
    for size in [[64, 48], [48, 64], [400, 300]] {
        let columns = strongest(&render(&path, size));
        let middle = &columns[columns.len() / 3..columns.len() * 2 / 3];
        let faintest = middle.iter().map(|(_, distance)| *distance).fold(f32::INFINITY, f32::min);
        assert!(faintest > 0.6, "{size:?}: a column differs from the background by {faintest} only");
    }
}

#[test]
fn lines_interpolate_the_colors_of_their_ends_and_points_have_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let path = folder.path().join("line.gltf");
    write(&path, 3, &[([-1.0, 0.0, 0.0], red), ([1.0, 0.0, 0.0], blue)]);
    let columns = strongest(&render(&path, [96, 72]));
    let line: Vec<(usize, Rgb)> =
        columns.iter().enumerate().filter(|(_, (_, d))| *d > 0.5).map(|(x, (pixel, _))| (x, *pixel)).collect();
    let (first, last) = (line[0].0 as f32, line[line.len() - 1].0 as f32);
    assert!(last - first > 40.0, "{line:?}");
    for (x, pixel) in &line {
        // The camera stands aside, which moves the middle by less than a tenth of the length.
        let share = (*x as f32 - first) / (last - first);
        let blue = pixel.b / (pixel.r + pixel.b);
        assert!((blue - share).abs() < 0.2, "{x}: {share} of the line, but {blue} of blue");
    }
    let path = folder.path().join("points.gltf");
    write(&path, 0, &[([-1.0, 0.0, 0.0], red), ([1.0, 0.0, 0.0], blue)]);
    let columns = strongest(&render(&path, [96, 72]));
    let strongest = |columns: &[(Rgb, f32)]| columns.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap().0;
    let (left, right) = (strongest(&columns[..48]), strongest(&columns[48..]));
    assert!(left.r > 2.0 * left.b && right.b > 2.0 * right.r, "{left:?} {right:?}");
}

/// Spheres with colors of their own equal as many objects with materials of these colors.
#[test]
fn colors_of_instances_equal_materials() {
    let scene = |material: &str, objects: &str| {
        let text = format!(
            r#"{{"version": 1, "render": {{"size": [48, 24], "samples": 256, "integrator": "path"}},
                "camera": {{"perspective": {{"eye": [0, 1, 6], "look_at": [0, 0.4, 0], "vertical_fov_degrees": 30}}}},
                "background": 0.2, "materials": {{"m": {material}, "gray": {{"diffuse": {{}}}}}},
                "objects": [{{"shape": "plane", "transform": {{"translate": [0, -0.5, 0]}}, "material": "gray"}}, {objects}]}}"#
        );
        let image = juggler::render(&Scene::from_json(&text, "a.json").unwrap(), &Settings::default()).unwrap();
        let mean = |half: u32| {
            let pixels = image.pixels().iter().enumerate().filter(|(i, _)| *i as u32 % 48 / 24 == half);
            pixels.fold(Rgb::BLACK, |sum, (_, pixel)| sum + *pixel) * (1.0 / 576.0)
        };
        [mean(0), mean(1)]
    };
    for kind in [r#"{"diffuse": {"reflectance": C}}"#, r#"{"emissive": {"radiance": C}}"#] {
        let colors = ["[0.9, 0.3, 0.1]", "[0.1, 0.2, 0.8]"];
        let instances = format!(
            r#"{{"shape": {{"sphere": {{"radius": 0.5}}}}, "material": "m", "instances":
                {{"positions": [[-1, 0, 0], [1, 0, 0]], "colors": [{}, {}]}}}}"#,
            colors[0].replace(']', ", 1]"),
            colors[1].replace(']', ", 1]"),
        );
        let separate = |(color, x): (&str, f32)| {
            format!(
                r#"{{"shape": {{"sphere": {{"radius": 0.5}}}}, "material": {}, "transform": {{"translate": [{x}, 0, 0]}}}}"#,
                kind.replace('C', color)
            )
        };
        let separate = [(colors[0], -1.0), (colors[1], 1.0)].map(separate).join(", ");
        let instances = scene(&kind.replace('C', r#"{"attribute": "color"}"#), &instances);
        let separate = scene(&kind.replace('C', "0.5"), &separate);
        for (found, expected) in instances.iter().zip(separate) {
            for (found, expected) in found.to_array().into_iter().zip(expected.to_array()) {
                assert!((found / expected - 1.0).abs() < 0.01, "{kind}: {instances:?} instead of {separate:?}");
            }
        }
    }
}

/// A scene of `count` robots of three sizes, in a clip, while the shutter is open for `shutter`
/// frames.
fn crowd(count: usize, shutter: f64) -> Scene {
    let robot = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/models/robot.glb");
    let copy = |i: usize| {
        let scale = 1 + i % 3;
        format!(
            r#"{{"model": {{"file": {robot:?}}}, "transform": [{{"scale": {scale}}}, {{"translate": [{i}, 0, 0]}}]}}"#
        )
    };
    let objects: Vec<String> = (0..count).map(copy).collect();
    let text =
        format!(r#"{{"version": 1, "render": {{"shutter": [0, {shutter}]}}, "objects": [{}]}}"#, objects.join(", "));
    juggler::loader().from_json(text, "crowd.json").unwrap()
}

/// A robot has two nodes with meshes, of seven primitives.
#[test]
fn copies_of_a_model_share_meshes_and_materials() {
    for shutter in [0.0, 0.5] {
        let [one, many] = [1, 12].map(|count| {
            let scene = crowd(count, shutter);
            let stats = scene.compile().unwrap().world.geometry_stats();
            (scene.expanded_description().materials.len(), stats.unique_triangles, stats.geometry_bytes)
        });
        assert_eq!((one.0, one.1), (many.0, many.1), "shutter {shutter}");
        assert!(many.2 - one.2 < 11 * 7 * 1000, "shutter {shutter}: {} and {} bytes", one.2, many.2);
    }
}

/// The lights of a robot have 3,116 triangles; those of a crowd are one emitter for each mesh.
#[test]
fn a_crowd_with_lights_needs_little_memory() {
    let [few, many] = [2, 100].map(|count| crowd(count, 0.0).compile().unwrap().world.geometry_stats());
    assert_eq!((few.emitting_shapes, many.emitting_shapes), (4, 200));
    assert!(many.emitter_bytes < few.emitter_bytes, "{} and {} bytes", few.emitter_bytes, many.emitter_bytes);
}
