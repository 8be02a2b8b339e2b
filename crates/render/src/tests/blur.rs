//! Tests of motion blur against closed forms: fraction of the shutter time that a point is covered.

use super::{job, look, pixels, read, world, world_in_motion};
use crate::*;
use juggler_camera::{AnyCamera, Orthographic, Projection, ShutterCamera};
use juggler_integrator::{AnyIntegrator, PathState, VertexOutput};
use juggler_math::testing::{chi_squared, z_test};
use juggler_math::{Motion, Ray, Rgb, Transform, UVec2, Vec3};
use juggler_world::Vertex;
use std::sync::Mutex;

const SAMPLES: u32 = 1024;
const WHITE: &str = r#"{"phong": {"diffuse": 1}}"#;

/// Orthographic camera that looks along −z at a square of side `height`.
fn above(eye: Vec3, height: f32, size: UVec2) -> Projection {
    let camera = Orthographic { eye, direction: Some(Vec3::NEG_Z), height: Some(height), ..Orthographic::default() };
    AnyCamera::from(camera).projection(size).unwrap()
}

/// World of a white moving object on black.
fn moving(shape: &str, motion: Motion) -> World {
    world_in_motion(&[(shape, motion, WHITE)], &[], Rgb::BLACK)
}

fn covered(world: &World, camera: &ShutterCamera, size: UVec2) -> Vec<f32> {
    let albedo: AnyIntegrator = read(r#"{"albedo": {}}"#);
    pixels(world, camera, &albedo, size, SAMPLES).iter().map(|pixel| pixel.g).collect()
}

#[test]
fn motion_blur_of_a_moving_edge_is_linear() {
    let size = UVec2::new(32, 1);
    for count in [2, 3, 17] {
        let key = |i: usize| Transform::translation(Vec3::X * (i as f32 / (count - 1) as f32));
        let motion = Motion::from_keys((0..count).map(key).collect()).unwrap();
        let world = moving(r#"{"cuboid": {"min": [-9, -9, -1], "max": [0, 9, 0]}}"#, motion);
        let camera = above(Vec3::new(0.5, 0.0, 5.0), 1.0 / 32.0, size).into();
        for (i, covered) in covered(&world, &camera, size).into_iter().enumerate() {
            let expected = 1.0 - (i as f32 + 0.5) / 32.0;
            assert!((covered - expected).abs() < 0.008, "pixel {i}: {covered} for {expected}");
        }
    }
}

/// A half plane rotates by at most half a turn; the covered fraction of the time follows from the
/// angles.
#[test]
fn motion_blur_of_a_rotating_half_plane_follows_its_angle() {
    for (turn, keys) in [(0.25, 2), (0.25, 17), (0.5, 17)] {
        let key = |i: usize| {
            Transform::rotation(Vec3::Z, turn * std::f32::consts::TAU * i as f32 / (keys - 1) as f32).unwrap()
        };
        let motion = Motion::from_keys((0..keys).map(key).collect()).unwrap().smoothed(9.0);
        let world = moving(r#"{"cuboid": {"min": [0, -9, -1], "max": [9, 9, 0]}}"#, motion);
        for step in 0..24 {
            let angle = (step as f32 + 0.5) / 24.0;
            let (sin, cos) = juggler_math::portable::sin_cos_turns(angle);
            let camera = above(Vec3::new(3.0 * cos, 3.0 * sin, 5.0), 1e-3, UVec2::ONE).into();
            // Covered while the half plane's angle is within a quarter turn of the point's.
            let inside = |low: f32, high: f32| (high.min(turn) - low.max(0.0)).max(0.0);
            let windows = [-1.0, 0.0, 1.0].map(|whole| inside(angle + whole - 0.25, angle + whole + 0.25));
            let expected = windows.iter().sum::<f32>() / turn;
            let covered = covered(&world, &camera, UVec2::ONE)[0];
            assert!((covered - expected).abs() < 0.005, "{turn} at {angle}: {covered} for {expected}");
        }
    }
}

#[test]
fn a_camera_that_moves_over_a_checkerboard_sees_its_mean() {
    let board = r#"{"checkerboard": {"size": 1, "plane": "xy",
        "even": {"phong": {"diffuse": 1}}, "odd": {"phong": {"diffuse": 0}}}}"#;
    let floor = [(r#"{"cuboid": {"min": [-50, -50, -1], "max": [50, 50, 0]}}"#, Vec3::ZERO, board)];
    let world = world(&floor, &[], Rgb::BLACK);
    for (start, distance) in [(0.2, 0.5), (0.2, 1.0), (0.7, 1.7), (0.1, 2.0), (0.4, 0.0)] {
        let at = |x: f32| above(Vec3::new(x, 0.5, 5.0), 1e-3, UVec2::ONE);
        let camera = ShutterCamera::from_keys(at(start), vec![at(start + distance * 0.5), at(start + distance)]);
        // White cells extend from even to odd x: integrate the pattern that passes under the pixel.
        let white = |x: f32| (x * 0.5).floor() + (x - (x * 0.5).floor() * 2.0).min(1.0);
        let expected = if distance == 0.0 { 1.0 } else { (white(start + distance) - white(start)) / distance };
        let covered = covered(&world, &camera, UVec2::ONE)[0];
        assert!((covered - expected).abs() < 0.004, "{start} + {distance}: {covered} for {expected}");
    }
}

/// Integrator that records the time of every ray that leaves the world.
#[derive(Default)]
struct Clock(Mutex<Vec<f32>>);

impl Integrator for Clock {
    fn vertex(&self, _: &World, _: &Ray, _: &PathState, _: &Vertex, _: &mut VertexOutput) {}
    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, _output: &mut VertexOutput) {
        self.0.lock().unwrap().push(ray.time);
    }
}

fn times(size: UVec2, samples: u32, moves: bool) -> Vec<f32> {
    let world = world(&[], &[], Rgb::BLACK);
    let at = |x: f32| above(Vec3::new(x, 0.0, 5.0), 1.0, size);
    let camera = if moves { ShutterCamera::from_keys(at(0.0), vec![at(1.0)]) } else { at(0.0).into() };
    let (clock, albedo) = (Clock::default(), read(r#"{"albedo": {}}"#));
    let job = Job { integrator: &clock, ..job(&world, &camera, &albedo, samples) };
    let pixels = Rect { x: 0, y: 0, width: size.x, height: size.y };
    job.render(&Work::first(pixels, samples), &Control::default()).unwrap();
    clock.0.into_inner().unwrap()
}

#[test]
fn ray_times_are_uniform_and_stratified() {
    let all = times(UVec2::new(64, 64), 16, true);
    let mut counts = [0.0; 64];
    all.iter().for_each(|time| counts[(time * 64.0) as usize] += 1.0);
    chi_squared(&counts, &[all.len() as f64 / 64.0; 64], 1e-4).unwrap();
    for pixel in all.chunks(16) {
        let mut parts: Vec<u32> = pixel.iter().map(|time| (time * 16.0) as u32).collect();
        parts.sort_unstable();
        assert!(parts.iter().copied().eq(0..16), "{parts:?}");
    }
    // The times of neighboring pixels are uncorrelated.
    let pairs: Vec<f64> = all.windows(17).step_by(16).map(|w| f64::from(w[0] - 0.5) * f64::from(w[16] - 0.5)).collect();
    z_test(&pairs, 0.0, 1e-4).unwrap();
    assert!(times(UVec2::new(8, 8), 4, false).iter().all(|time| *time == 0.0));
    assert!(times(UVec2::new(8, 8), 1, true).iter().all(|time| *time == 0.5));
}

/// A mirror shows a moving object at the time of the camera ray.
#[test]
fn mirrors_keep_the_time_of_the_camera_ray() {
    let mirror = r#"{"phong": {"diffuse": 0, "specular": 0, "reflection": 1}}"#;
    let white = r#"{"phong": {"diffuse": 1, "ambient": 1, "specular": 0}}"#;
    let world = |motion: Motion| {
        let floor = (r#"{"plane": {}}"#, Transform::IDENTITY.into(), mirror);
        let objects = [floor, (r#"{"sphere": {"radius": 1}}"#, motion, white)];
        world_in_motion(&objects, &[r#"{"ambient": {"intensity": 1}}"#], Rgb::BLACK)
    };
    let size = UVec2::new(24, 16);
    let start = Transform::translation(Vec3::new(-2.0, 1.5, 0.0));
    let end = Transform::translation(Vec3::new(2.0, 1.5, 0.0));
    let moving = world(Motion::from_keys(vec![start, end]).unwrap());
    let classic = AnyIntegrator::default();
    let camera = look(Vec3::new(0.0, 4.0, 12.0), Vec3::ZERO, "30", size);
    let blurred = pixels(&moving, &camera, &classic, size, 256);
    // Average many still pictures.
    let mut mean = vec![Rgb::BLACK; blurred.len()];
    for i in 0..128 {
        let place = start.lerp(&end, (i as f32 + 0.5) / 128.0);
        let picture = pixels(&world(place.into()), &camera, &classic, size, 4);
        mean.iter_mut().zip(picture).for_each(|(sum, pixel)| *sum += pixel / 128.0);
    }
    let errors = || blurred.iter().zip(&mean).map(|(a, b)| (a.g - b.g).abs());
    let (worst, square) = (errors().fold(0.0, f32::max), errors().map(|error| error * error).sum::<f32>());
    assert!(worst < 0.08 && square < 0.01_f32.powi(2) * mean.len() as f32, "{worst} {square}");
    let seen = mean.iter().filter(|pixel| pixel.g > 0.1).count();
    assert!(seen > 30, "{seen} pixels see the sphere or its image");
}
