//! Several camera rays for each sample: the mean of a picture stays.

use crate::probe::{Estimate, Scene, camera, path, picture, prepared, read};
use juggler_camera::{AnyCamera, ShutterCamera};
use juggler_light::background::AnyBackground;
use juggler_math::{Motion, Transform, UVec2, Vec3, testing::family_wise_deviations};

const SEEDS: u64 = 16;
const SAMPLES: u32 = 8;
const EMITTER: &str = r#"{"emissive": {"radiance": [6, 4, 2]}}"#;
const GRAY: &str = r#"{"diffuse": {"reflectance": [0.3, 0.5, 0.7]}}"#;

fn view(lens: &str) -> ShutterCamera {
    camera(&format!(r#"{{"{lens}": {{"eye": [0, 1.2, 5], "look_at": [0, 0.8, 0], "vertical_fov_degrees": 40}}}}"#))
}

/// An emitter over a floor, in a dim surrounding.
fn emitter(shape: &str, material: &str) -> Scene {
    Scene::new()
        .with(r#"{"plane": {}}"#, Vec3::ZERO, GRAY)
        .with(shape, Vec3::new(0.3, 1.4, 0.0), material)
        .in_light(0.2)
}

fn moving_emitter() -> Scene {
    let end = Transform::translation(Vec3::new(0.9, 0.3, 0.0));
    let keys = vec![Transform::translation(Vec3::new(-0.5, 1.2, 0.0)), end];
    let emitter = Motion::from_keys(keys).unwrap();
    Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, GRAY).placed(r#"{"sphere": {"radius": 0.4}}"#, emitter, EMITTER)
}

fn moving_camera() -> ShutterCamera {
    let key = |x: f32| {
        let json = format!(r#"{{"perspective": {{"eye": [{x}, 1.2, 5], "look_at": [0, 0.8, 0]}}}}"#);
        read::<AnyCamera>(&json).projection(UVec2::splat(crate::probe::EDGE)).unwrap()
    };
    ShutterCamera::from_keys(key(-0.4), vec![key(0.4)])
}

/// Ten scenes, each with a part that passes, bends, moves, hides or takes light on its way to the
/// camera.
fn scenes() -> Vec<(&'static str, Scene, ShutterCamera)> {
    let sphere = r#"{"sphere": {"radius": 0.5}}"#;
    let pane = r#"{"cuboid": {"min": [-1, -0.8, 0], "max": [1, 1, 0.1]}}"#;
    let in_front = |material: &str| emitter(sphere, EMITTER).with(pane, Vec3::new(0.0, 0.9, 1.5), material);
    let fog = r#"{"boundary": {"medium": {"scattering": 0.1, "absorption": 0.05}}}"#;
    let mut sky: AnyBackground = read(r#"{"gradient": {}}"#);
    sky.prepare().unwrap();
    let poster = emitter(sphere, r#"{"unlit": {"color": [0.2, 2, 1]}}"#);
    vec![
        ("an emitter", emitter(sphere, EMITTER), view("perspective")),
        ("glass before an emitter", in_front(r#"{"dielectric": {"ior": 1.5}}"#), view("perspective")),
        (
            "a mask before an emitter",
            in_front(&format!(r#"{{"mask": {{"opacity": 0.4, "material": {GRAY}}}}}"#)),
            view("perspective"),
        ),
        (
            "an emitting mask",
            emitter(sphere, &format!(r#"{{"mask": {{"opacity": 0.6, "material": {EMITTER}}}}}"#)),
            view("perspective"),
        ),
        ("an emitter out of focus", emitter(sphere, EMITTER), view("thin_lens")),
        ("a moving emitter", moving_emitter(), view("perspective")),
        ("a moving camera", emitter(sphere, EMITTER), moving_camera()),
        (
            "an emitter in fog around the camera",
            emitter(sphere, EMITTER).with(r#"{"sphere": {"radius": 9}}"#, Vec3::ZERO, fog),
            view("perspective"),
        ),
        ("an unlit sphere", poster, view("perspective")),
        ("a mirror under a sky", emitter(sphere, r#"{"conductor": {}}"#).before(sky), view("perspective")),
    ]
}

/// Means of the picture over seeds, by channel.
fn means(scene: &juggler_world::World, view: &ShutterCamera, camera_rays: u32) -> [Estimate; 3] {
    let integrator = path(&format!(r#""camera_rays": {camera_rays}, "max_depth": 6"#));
    let of_seed = |seed| {
        let pixels = picture(scene, view, &*integrator, SAMPLES, seed);
        let sum = pixels.iter().fold([0.0; 3], |sum, pixel| {
            let pixel = pixel.to_array().map(f64::from);
            std::array::from_fn(|i| sum[i] + pixel[i])
        });
        sum.map(|sum: f64| sum / pixels.len() as f64)
    };
    let all: Vec<[f64; 3]> = (1..=SEEDS).map(of_seed).collect();
    std::array::from_fn(|channel| Estimate::of(&all.iter().map(|mean| mean[channel]).collect::<Vec<_>>()))
}

#[test]
fn camera_rays_keep_the_mean() {
    let (scenes, counts) = (scenes(), [2, 4, 7, 8]);
    // Few seeds estimate the deviations, so they are exceeded more often than normal ones.
    let deviations = 1.25 * family_wise_deviations(3 * scenes.len());
    for ((name, scene, view), count) in scenes.into_iter().zip(counts.into_iter().cycle()) {
        let world = scene.world();
        let (one, several) = (means(&world, &view, 1), means(&world, &view, count));
        for (channel, (one, several)) in one.into_iter().zip(several).enumerate() {
            let sigma = (one.sigma * one.sigma + several.sigma * several.sigma).sqrt();
            let what = format!("{name}, channel {channel}, {count} camera rays: {one:?}, {several:?}");
            assert!(sigma < 0.03 * one.mean, "too noisy: {what}");
            assert!((one.mean - several.mean).abs() <= deviations * sigma + 1e-5 * one.mean, "{what}");
        }
    }
}

/// An emitter of sharp edges before black: all noise is at its edges.
#[test]
fn camera_rays_smooth_the_edges_of_emitters() {
    let world = Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::new(0.0, 1.0, 0.0), EMITTER).world();
    let noise = |camera_rays: u32| -> f64 {
        let integrator = path(&format!(r#""camera_rays": {camera_rays}"#));
        let pictures: Vec<_> =
            (0..SEEDS).map(|seed| picture(&world, &view("perspective"), &*integrator, 16, seed)).collect();
        let pixel =
            |i: usize| Estimate::of(&pictures.iter().map(|picture| f64::from(picture[i].r)).collect::<Vec<_>>());
        (0..pictures[0].len()).map(|i| pixel(i).sigma.powi(2)).sum()
    };
    let one = noise(1);
    // One set of n K well-distributed points, or two of n and n (K - 1).
    for (count, expected) in [(2, 0.5), (3, 0.27), (4, 0.125), (8, 0.044)] {
        let ratio = noise(count) / one;
        assert!(ratio > 0.6 * expected && ratio < 1.6 * expected, "{count} rays: {ratio} instead of {expected}");
    }
}

/// Light that is not seen directly keeps its bits, unless film positions are of a finer set.
#[test]
fn camera_rays_do_not_change_paths() {
    let far = prepared(r#"{"sphere": {"radius": 0.5}}"#);
    let mut scene = Scene::floor();
    let material = scene.material(EMITTER);
    let place = Transform::translation(Vec3::new(0.0, 3.0, 9.0));
    scene.objects.push(juggler_world::Object::new(far, place, material));
    let world = scene.world();
    // The camera sees the floor alone.
    let down = camera(r#"{"perspective": {"eye": [0, 2, 2], "look_at": [0, 0, 0], "vertical_fov_degrees": 30}}"#);
    let pixels = |camera_rays: u32| picture(&world, &down, &*path(&format!(r#""camera_rays": {camera_rays}"#)), 8, 3);
    let one = pixels(1);
    assert!(one.iter().all(|pixel| pixel.r > 0.0));
    assert_eq!(one, pixels(2));
    assert_eq!(one, pixels(5));
}
