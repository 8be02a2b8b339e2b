//! Motion vectors equal their closed forms.

use juggler::imaging::Matrix4;
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Aov, Picture, Settings};
use std::collections::BTreeMap;

const SIZE: usize = 32;

/// Orthographic camera with pixels of 1/16 unit and x from -1 to 1, then a moving perspective
/// camera.
const FLAT: &str = r#""camera": {"orthographic": {"eye": [0, 0, 4], "look_at": [0, 0, 0], "height": 2}}"#;
const DEEP: &str = r#""camera": {"perspective": {"eye": ["=0.1 * frame", 0.2, 4], "direction": [0, 0, -1],
    "yaw_degrees": "=3 * frame", "vertical_fov_degrees": 40}}"#;

fn scene(camera: &str, render: &str, rest: &str) -> Scene {
    let text = format!(
        r#"{{"version": 1, "animation": {{"frames": 9, "frames_per_second": 24}},
            "render": {{"size": [{SIZE}, {SIZE}], "samples": 1, "integrator": "path" {render}}}, {camera}, {rest}}}"#
    );
    Scene::from_json(text, "test").unwrap()
}

type Channels = BTreeMap<String, Vec<f32>>;

fn render(scene: &Scene, frame: f64, aovs: &[Aov]) -> (Channels, Picture) {
    let settings = Settings { aovs: aovs.to_vec(), ..Settings::default() };
    let picture = Picture::new(&scene.at_frame(frame).unwrap(), &settings).unwrap();
    let film = picture.film();
    picture.render_film(&film, &Control::default()).unwrap();
    let tiles: Vec<_> = film.tiles().map(|(_, tile)| tile).collect();
    let names = picture.aovs().headers().into_iter().flat_map(|layer| layer.channels);
    (names.zip(picture.aovs().band_values(&picture.region(), &tiles, None)).collect(), picture)
}

/// Checks the vectors of all pixels that show an object (`true`) or the background (`false`) at the
/// coordinates of [`FLAT`]. Returns their number.
fn check(channels: &Channels, layer: &str, of_objects: bool, expected: impl Fn(f32, f32) -> [f32; 2]) -> usize {
    let pixels = (0..SIZE * SIZE).filter(|pixel| (channels["alpha.A"][*pixel] > 0.0) == of_objects);
    let each = |pixel: usize| {
        let place = |cell: usize| (cell as f32 + 0.5) / 16.0 - 1.0;
        let (x, y) = (place(pixel % SIZE), -place(pixel / SIZE));
        let found = ["X", "Y"].map(|axis| channels[&format!("{layer}.{axis}")][pixel]);
        for (found, expected) in found.into_iter().zip(expected(x, y)) {
            assert!((found - expected).abs() < 2e-3, "{layer} at {x} {y}: {found} for {expected}");
        }
    };
    pixels.map(each).count()
}

const ALL: [Aov; 3] = [Aov::Motion, Aov::MotionBack, Aov::Alpha];

#[test]
fn motion_vectors_of_a_translated_sphere_are_its_displacement() {
    let ball = r#""objects": [{"shape": {"sphere": {"radius": 0.4}}, "transform": [{"translate": ["=frame / 4", "=frame * frame / 16", 0]}]}]"#;
    // With an open shutter the mean over the samples is the same for linear motion.
    for more in ["", r#", "shutter": [0, 0.5]"#] {
        let (found, _) = render(&scene(FLAT, more, ball), 1.0, &ALL);
        let moved = check(&found, "motion", true, |_, _| [4.0, if more.is_empty() { -3.0 } else { -3.5 }]);
        let back = if more.is_empty() { 1.0 } else { 1.5 };
        assert_eq!(check(&found, "motion_back", true, |_, _| [-4.0, back]), moved);
        assert!(moved > 100, "{moved}");
        // The background does not move under parallel rays.
        assert!(check(&found, "motion", false, |_, _| [0.0, 0.0]) > 100);
    }
}

#[test]
fn motion_vectors_of_a_rotating_disk_match_the_closed_form() {
    let disc = r#""objects": [{"shape": {"disk": {"radius": 0.8}}, "transform": [
        {"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"rotate": {"axis": [0, 0, 1], "degrees": "=30 * frame"}}]}]"#;
    let (found, _) = render(&scene(FLAT, "", disc), 2.0, &ALL);
    let turned = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        move |x: f32, y: f32| [(x * cos - y * sin - x) * 16.0, -(x * sin + y * cos - y) * 16.0]
    };
    assert!(check(&found, "motion", true, turned(30.0)) > 400);
    check(&found, "motion_back", true, turned(-30.0));
}

#[test]
fn motion_vectors_follow_deforming_and_instanced_surfaces() {
    // A sphere that grows by half, a mesh stretched to the right, and a group instanced twice
    // within another.
    let wall = r#"{"mesh": {"positions": [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]],
        "triangles": [[0, 1, 2], [0, 2, 3]],
        "morphs": [{"positions": [[-0.5, -0.5, 0], [1.5, -0.5, 0], [1.5, 0.5, 0], [-0.5, 0.5, 0]], "weight": "=frame / 4"}]}}"#;
    let stretched = |x: f32, _: f32| [(x + 0.5) * 0.25 * 16.0, 0.0];
    for more in ["", r#", "shutter": [0, 0.001]"#] {
        let (found, _) = render(&scene(FLAT, more, &format!(r#""objects": [{{"shape": {wall}}}]"#)), 0.0, &ALL);
        assert!(check(&found, "motion", true, stretched) > 200);
    }
    let ball = r#""objects": [{"shape": {"sphere": {"radius": "=(2 + frame) / 8"}}, "transform": [{"translate": [0.1, 0, 0]}]}]"#;
    let (found, _) = render(&scene(FLAT, "", ball), 2.0, &ALL);
    assert!(check(&found, "motion", true, |x, y| [(x - 0.1) * 0.25 * 16.0, -y * 0.25 * 16.0]) > 100);
    let groups = r#""groups": {
            "dot": [{"shape": {"sphere": {"radius": 0.1}}, "transform": [{"translate": [0, "=frame / 16", 0]}]}],
            "pair": [{"group": "dot"}, {"group": "dot", "transform": [{"translate": [0.5, 0, 0]}]}]},
        "objects": [{"shape": {"sphere": {"radius": 0.1}}, "transform": [{"translate": [-0.8, 0.8, 0]}]},
            {"group": "pair", "transform": [{"scale": 2}, {"translate": ["=frame / 8", -0.5, 0]}]},
            {"group": "pair", "transform": [{"scale": 2}, {"translate": ["=frame / 8", 0.2, 0]}]}]"#;
    let (found, _) = render(&scene(FLAT, "", groups), 0.0, &ALL);
    let count = check(&found, "motion", true, |x, _| if x < -0.6 { [0.0, 0.0] } else { [2.0, -2.0] });
    assert!(count > 60, "{count}");
}

#[test]
fn appearing_and_disappearing_objects_have_only_camera_motion() {
    let objects = r#""objects": [
        {"shape": {"sphere": {"radius": 0.3}}, "visible": "=frame < 1", "transform": [{"translate": ["=frame", 0.5, 0]}]},
        {"shape": {"sphere": {"radius": 0.3}}, "transform": [{"translate": ["=frame / 8", -0.5, 0]}]}]"#;
    let (found, _) = render(&scene(FLAT, "", objects), 0.0, &[Aov::Motion, Aov::Alpha]);
    assert!(check(&found, "motion", true, |_, y| if y > 0.0 { [0.0, 0.0] } else { [2.0, 0.0] }) > 50);
}

#[test]
fn a_moving_camera_moves_everything() {
    let rest = r#""objects": [{"shape": "plane", "transform": [{"translate": [0, -0.5, 0]}]}, {"shape": {"sphere": {"radius": 0.5}}}]"#;
    let scene = scene(DEEP, "", rest);
    let (found, here) = render(&scene, 3.0, &[Aov::Motion, Aov::Alpha, Aov::Position]);
    let (_, next) = render(&scene, 4.0, &[]);
    let [here, next] = [here, next].map(|picture| picture.viewpoint().unwrap());
    let place = |point: [f32; 4], matrix: &Matrix4| {
        let of = |column: usize| (0..4).map(|i| point[i] * matrix[i][column]).sum::<f32>();
        [of(0) / of(3) * SIZE as f32, of(1) / of(3) * SIZE as f32]
    };
    let mut counts = [0, 0];
    for (pixel, alpha) in found["alpha.A"].iter().enumerate() {
        let is_object = *alpha > 0.0;
        // The background is at infinity.
        let point = if is_object {
            let [x, y, z] = ["X", "Y", "Z"].map(|axis| found[&format!("position.{axis}")][pixel]);
            [x, y, z, 1.0]
        } else {
            direction(pixel, 9.0)
        };
        let (from, to) = (place(point, &here.world_to_ndc), place(point, &next.world_to_ndc));
        for (axis, name) in ["motion.X", "motion.Y"].into_iter().enumerate() {
            let expected = to[axis] - from[axis];
            assert!((found[name][pixel] - expected).abs() < 5e-3, "{pixel}: {} for {expected}", found[name][pixel]);
        }
        // The camera turns to the right, so everything moves to the left.
        assert!(found["motion.X"][pixel] < -1.0);
        counts[usize::from(is_object)] += 1;
    }
    assert!(counts[0] > 200 && counts[1] > 200, "{counts:?}");
}

/// Returns the ray direction at a pixel's center for [`DEEP`], turned to the right by some degrees.
fn direction(pixel: usize, degrees: f32) -> [f32; 4] {
    let half = 20f32.to_radians().tan();
    let place = |cell: usize| ((cell as f32 + 0.5) / 16.0 - 1.0) * half;
    let (x, y, (sin, cos)) = (place(pixel % SIZE), -place(pixel / SIZE), degrees.to_radians().sin_cos());
    [x * cos + sin, y, x * sin - cos, 0.0]
}

#[test]
fn static_objects_have_exactly_zero_motion() {
    let objects = r#""objects": [{"shape": "plane", "transform": [{"rotate": {"axis": [1, 2, 3], "degrees": 70}}, {"translate": [0.3, 0.1, 7]}]}
        MORE]"#;
    let camera = DEEP.replace("\"=0.1 * frame\"", "0.1").replace("\"=3 * frame\"", "9");
    for more in ["", r#", {"shape": {"sphere": {"radius": 0.1}}, "transform": [{"translate": ["=frame", 50, 0]}]}"#] {
        let rest = objects.replace("MORE", if more.is_empty() { "" } else { more });
        let (found, _) = render(&scene(&camera, "", &rest), 3.0, &ALL);
        for channel in ["motion.X", "motion.Y", "motion_back.X", "motion_back.Y"] {
            assert!(found[channel].iter().all(|value| *value == 0.0), "{channel}");
        }
    }
}
