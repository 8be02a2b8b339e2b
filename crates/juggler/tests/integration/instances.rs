//! Instances equal as many objects.

use juggler::math::{Rgb, Transform, Vec3};
use juggler::{Picture, Settings};
use juggler_scene::{Asset, InstanceAttribute, Instances, Loader, Object, ScaleFactors, Scene};
use juggler_shape::attribute::AttributeData;

/// A scene of these objects and render settings, with the groups `two` (a ball on a cylinder) and
/// `many` (18 balls).
fn scene(objects: &str, render: &str) -> Scene {
    let ball = |x: usize| {
        format!(r#"{{"shape": {{"sphere": {{"radius": 0.1}}}}, "transform": {{"translate": [0, 0, {x}]}}}}"#)
    };
    let balls: Vec<String> = (0..18).map(ball).collect();
    let text = format!(
        r#"{{"version": 1, "render": {{"size": [32, 24], "samples": 2, "integrator": "path" {render}}},
            "animation": {{"frames": 9, "frames_per_second": 24}},
            "camera": {{"perspective": {{"eye": [4, 5, 9], "look_at": [1, 0.5, 0], "vertical_fov_degrees": 40}}}},
            "background": 1, "materials": {{"red": {{"diffuse": {{"reflectance": [0.8, 0.1, 0.1]}}}}}},
            "groups": {{"two": [{{"shape": {{"sphere": {{"radius": 0.3}}}}, "material": "red"}},
                    {{"shape": {{"cylinder": {{"radius": 0.2, "y_min": 0, "y_max": 0.5}}}}, "transform": {{"translate": [0, -0.5, 0]}}}}],
                "many": [{}]}},
            "objects": [{{"shape": "plane"}}, {objects}]}}"#,
        balls.join(", ")
    );
    Scene::from_json(&text, "instances.json").unwrap()
}

fn pixels(scene: &Scene) -> Vec<Rgb> {
    juggler::render(scene, &Settings::default()).unwrap().pixels().to_vec()
}

/// Transform steps of instances that are scaled, rotated and translated.
const PLACES: [([f32; 3], f32, f32); 3] =
    [([0.0, 0.5, 0.0], 1.0, 0.0), ([1.5, 0.6, 0.2], 2.0, 90.0), ([2.5, 0.4, 1.0], 0.5, 180.0)];

fn instances() -> String {
    let half = |degrees: f32| (degrees.to_radians() / 2.0).sin_cos();
    let positions: Vec<String> = PLACES.iter().map(|(at, ..)| format!("{at:?}")).collect();
    let scales: Vec<String> = PLACES.iter().map(|(_, scale, _)| scale.to_string()).collect();
    let rotations = PLACES.iter().map(|(.., degrees)| half(*degrees));
    let rotations: Vec<String> = rotations.map(|(sin, cos)| format!("[0, {sin}, 0, {cos}]")).collect();
    format!(
        r#""instances": {{"positions": [{}], "rotations": [{}], "scales": [{}]}}"#,
        positions.join(", "),
        rotations.join(", "),
        scales.join(", ")
    )
}

/// The object once for each place, as matrices with the same rounding.
fn separate(content: &str, outer: &str) -> String {
    let parsed: Instances = serde_json::from_str(instances().trim_start_matches(r#""instances": "#)).unwrap();
    let object = |transform: Transform| {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| transform.vector(v));
        let t = transform.origin();
        let rows = [x.x, y.x, z.x, t.x, x.y, y.y, z.y, t.y, x.z, y.z, z.z, t.z];
        format!(r#"{{{content}, "transform": [{{"matrix": {rows:?}}}{outer}]}}"#)
    };
    parsed.transforms().unwrap().into_iter().map(object).collect::<Vec<_>>().join(", ")
}

#[test]
fn instances_equal_separate_objects() {
    let outer = r#", {"rotate": {"axis": [0, 1, 0], "degrees": 20}}, {"translate": [0.1, 0.2, 0.3]}"#;
    let steps = outer.trim_start_matches(", ");
    for content in [
        r#""shape": {"sphere": {"radius": 0.4}}, "material": "red""#,
        r#""group": "two""#,
        r#""group": "many""#,
        r#""objects": [{"group": "two"}, {"shape": {"cuboid": {"min": [0, 0, 0], "max": [0.3, 0.3, 0.3]}}}]"#,
    ] {
        let bulk = scene(&format!(r#"{{{content}, {}, "transform": [{steps}]}}"#, instances()), "");
        let apart = scene(&separate(content, outer), "");
        let (bulk, apart) = (pixels(&bulk), pixels(&apart));
        assert!(bulk == apart, "{content}");
        assert!(bulk.iter().any(|pixel| *pixel != bulk[0]));
    }
}

#[test]
fn instances_of_instances_multiply() {
    let row = r#""instances": {"positions": [[0, 0.3, 0], [1, 0.3, 0]]}"#;
    let bulk = scene(&format!(r#"{{"objects": [{{"shape": {{"sphere": {{"radius": 0.3}}}}, {row}}}], {row}}}"#), "");
    let ball = |x: f32| {
        format!(r#"{{"shape": {{"sphere": {{"radius": 0.3}}}}, "transform": {{"translate": [{x}, 0.6, 0]}}}}"#)
    };
    let apart = scene(&[0.0, 1.0, 1.0, 2.0].map(ball).join(", "), "");
    assert!(pixels(&bulk) == pixels(&apart));
}

#[test]
fn moving_instances_are_blurred() {
    let shutter = r#", "shutter": [0, 0.5]"#;
    let render = |objects: &str| pixels(&scene(objects, shutter).at_frame(1.0).unwrap());
    let bulk = render(
        r#"{"shape": {"sphere": {"radius": 0.4}}, "instances": {"positions": [["=frame / 4", 0.5, 0], [2, 0.5, 0]]}}"#,
    );
    let apart = render(
        r#"{"shape": {"sphere": {"radius": 0.4}}, "transform": {"translate": ["=frame / 4", 0.5, 0]}},
           {"shape": {"sphere": {"radius": 0.4}}, "transform": {"translate": [2, 0.5, 0]}}"#,
    );
    assert!(bulk == apart);
}

#[test]
fn wrong_instances_are_errors_with_their_place() {
    let report = |instances: &str| {
        let text = format!(r#"{{"version": 1, "objects": [{{"shape": "sphere", "instances": {instances}}}]}}"#);
        Scene::from_json(&text, "instances.json").unwrap().check().to_string()
    };
    let lengths = report(r#"{"positions": [[0, 0, 0], [1, 0, 0]], "scales": [1]}"#);
    assert!(lengths.contains("`scales` has 1 elements, another array 2"), "{lengths}");
    assert!(lengths.contains("objects[0].instances.scales"), "{lengths}");
    let zero = report(r#"{"rotations": [[0, 0, 0, 0]]}"#);
    assert!(zero.contains("the rotation of instance 0 must not be zero"), "{zero}");
    let none = scene(r#"{"shape": "sphere", "instances": {}}"#, "");
    assert_eq!(none.check().errors(), 0);
    assert!(pixels(&none) == pixels(&scene(r#"{"shape": "sphere", "visible": false}"#, "")));
}

#[test]
fn a_program_places_a_million_instances() {
    let side = 1000;
    let positions = (0..side * side).map(|i| Vec3::new((i % side) as f32, 0.0, (i / side) as f32));
    let object = Object::new(juggler_shape::Sphere { radius: 0.3 }).instances(Instances::at(positions));
    let scene = Scene::new().size(8, 8).samples(1).add(object);
    let picture = Picture::new(&scene, &Settings::default()).unwrap();
    assert_eq!(picture.world().geometry_stats().shapes, 1_000_000);
}

/// A picture of an asset of instances, turned and colored, and of the same scene saved and read again.
#[test]
fn saved_instances_give_the_same_picture() {
    let count = 40;
    let number = |i: usize| (i * 37 % 41) as f32 / 41.0;
    let numbers = |channels: usize| AttributeData::F32((0..count * channels).map(number).collect());
    let color = |i| [number(i), number(i + 1), number(i + 2), 1.0];
    let instances = Instances {
        positions: (0..count).map(|i| Vec3::new(3.0 * number(i), number(3 * i), 2.0 * number(7 * i) - 1.0)).collect(),
        rotations: (0..count).map(|i| [number(i), 0.3, number(5 * i), 1.0]).collect(),
        scales: (0..count).map(|i| ScaleFactors::Each(Vec3::new(0.1, -0.3, 0.1 + number(i) / 5.0))).collect(),
        colors: (0..count).map(color).collect(),
        end_colors: (0..count).map(|i| color(i + 9)).collect(),
        attributes: [("tint".to_owned(), InstanceAttribute::new(3, numbers(3)))].into_iter().collect(),
        ..Instances::default()
    };
    let text = r#"{"version": 1, "render": {"size": [32, 24], "samples": 2, "integrator": "path"}, "background": 1,
        "camera": {"perspective": {"eye": [4, 5, 9], "look_at": [1, 0.5, 0], "vertical_fov_degrees": 20}},
        "textures": {"color": {"attribute": {}}, "tint": {"attribute": {"name": "tint"}}},
        "objects": [{"instances": {"file": "points.ply"}, "objects": [
            {"shape": {"cylinder": {"radius": 1, "y_min": 0, "y_max": 1}}, "material": {"diffuse": {"reflectance": "color"}}},
            {"shape": {"sphere": {"radius": 1}}, "material": {"diffuse": {"reflectance": "tint"}}}]}]}"#;
    let assets = [("points.ply".to_owned(), Asset::from_instances(instances))];
    let scene = Loader::default().from_json_with(text, "scene.json", assets).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("scene.json");
    scene.save(&place).unwrap();
    let (found, again) = (pixels(&scene), pixels(&Scene::load(&place).unwrap()));
    assert!(found == again);
    let colors: std::collections::BTreeSet<[u32; 3]> =
        found.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect();
    assert!(colors.len() > 100, "{}", colors.len());
}
