//! Cost of editing a scene value: `cargo bench -p juggler --bench edits` prints one table each for
//! a mesh of a million triangles in memory, a hundred thousand spheres, and ten thousand moving
//! spheres.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::material::{Conductor, Diffuse};
use juggler::prelude::*;
use juggler::shape::MeshData;
use serde_json::json;
use std::sync::Arc;
use std::time::Instant;

/// Vertices along an edge of the mesh: 977,202 triangles.
const SIDE: u32 = 700;
/// Number of spheres in the scene with many objects.
const SPHERES: u32 = 100_001;
/// Number of spheres in the scene in which all move.
const MOVING: u32 = 10_000;
/// Number of runs of each measurement, of which the median is printed.
const RUNS: usize = 9;

fn main() -> Result<(), Error> {
    million_triangles()?;
    hundred_thousand_spheres()?;
    ten_thousand_moving_spheres()
}

/// Prints the median time of some runs, in milliseconds, and returns the last result.
fn timed<T>(what: &str, runs: usize, mut run: impl FnMut() -> Result<T, Error>) -> Result<T, Error> {
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..runs {
        let start = Instant::now();
        let result = run()?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        last = Some(result);
    }
    times.sort_by(f64::total_cmp);
    println!("{what:<58} {:>9.3} ms", times.get(times.len() / 2).copied().unwrap_or_default());
    match last {
        Some(result) => Ok(result),
        None => run(),
    }
}

/// Returns a mesh of a bumpy square.
fn bumps() -> MeshData {
    let place = |i: u32| 2.0 * i as f32 / (SIDE - 1) as f32 - 1.0;
    let points = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (place(column), place(row))));
    let positions = points.map(|(x, z)| vec3(x, 0.05 * (40.0 * x).sin() * (40.0 * z).sin(), z)).collect();
    let corner = |row: u32, column: u32| row * SIDE + column;
    let cells = (1..SIDE).flat_map(|row| (1..SIDE).map(move |column| (row, column)));
    let triangles = cells.flat_map(|(row, column)| {
        let [a, b] = [corner(row - 1, column - 1), corner(row - 1, column)];
        let [c, d] = [corner(row, column - 1), corner(row, column)];
        [[a, c, d], [a, d, b]]
    });
    MeshData { positions, triangles: triangles.collect(), ..MeshData::default() }
}

/// Returns the peak memory of the process in MB; 0 if the system does not report it.
fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    peak.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).unwrap_or_default() / 1024.0
}

fn million_triangles() -> Result<(), Error> {
    let mesh = Arc::new(bumps());
    let arrays = (size_of_val(&*mesh.positions) + size_of_val(&*mesh.triangles)) as f64 / (1 << 20) as f64;
    println!("{} triangles, arrays of {arrays:.0} MB", mesh.triangles.len());
    let scene = Scene::new()
        .size(640, 360)
        .samples(1)
        .integrator(integrator::Path::default())
        .camera("main", Perspective { eye: vec3(1.5, 1.25, 2.2), look_at: Vec3::ZERO.into(), ..Default::default() })
        .material("paint", Diffuse::default())
        .light(Point { position: vec3(4.0, 6.0, 4.0), intensity: Some(60.0), ..Point::default() })
        .add(Object::new(Mesh::from(Arc::clone(&mesh))).material_named("paint"))
        .add(Object::new(Sphere { radius: 0.2 }).at(0.0, 0.3, 0.0));
    let before = peak_megabytes();
    let settings = Settings::default();
    let picture = timed("the first picture, ready to render", 1, || Picture::new(&scene, &settings))?;
    println!("{:<58} {:>9.0} MB", "peak memory that it added to the arrays", peak_megabytes() - before);
    edits(&scene, &picture)
}

/// Measures edits of the scene that `picture` renders.
fn edits(scene: &Scene, picture: &Picture) -> Result<(), Error> {
    let after = |edited: &Scene| picture.rebuild(scene, edited, &Settings::default());
    timed("another camera, to a picture that is ready", RUNS, || {
        let mut edited = scene.clone();
        let camera = Perspective { eye: vec3(1.0, 1.5, 2.2), look_at: Vec3::ZERO.into(), ..Default::default() };
        edited.description.cameras.insert("main".into(), AnyCamera::from(camera).into());
        after(&edited)
    })?;
    timed("other settings", RUNS, || {
        let mut edited = scene.clone();
        edited.description.render.samples = 5;
        after(&edited)
    })?;
    timed("another material", RUNS, || {
        let mut edited = scene.clone();
        edited.description.materials.insert("paint".into(), AnyMaterial::from(Conductor::default()).into());
        after(&edited)
    })?;
    timed("another light", RUNS, || {
        let mut edited = scene.clone();
        let light = Point { position: vec3(-4.0, 6.0, 4.0), intensity: Some(30.0), ..Point::default() };
        edited.description.lights[0] = AnyLight::from(light).into();
        after(&edited)
    })?;
    timed("a sphere at another place", RUNS, || {
        let mut edited = scene.clone();
        edited.description.objects[1] = Object::new(Sphere { radius: 0.2 }).at(0.5, 0.3, 0.0).into();
        after(&edited)
    })?;
    Ok(())
}

fn hundred_thousand_spheres() -> Result<(), Error> {
    println!("\n{SPHERES} spheres");
    let place = |i: u32| [(i % 47) as f32, (i / 47 % 47) as f32, (i / 2209) as f32];
    let mut scene = Scene::new().size(64, 64).samples(1);
    for [x, y, z] in (0..SPHERES).map(place) {
        scene = scene.add(Object::new(Sphere { radius: 0.4 }).at(x, y, z));
    }
    scene.description.render.shutter = [0.0, 0.5];
    timed("a copy of the scene", RUNS, || Ok(scene.clone()))?;
    timed("one sphere of a copy made invisible", RUNS, || {
        let mut edited = scene.clone();
        edited.description.objects[7].visible.0 = false;
        Ok(edited)
    })?;
    let (picture, settings) = (Picture::new(&scene, &Settings::default())?, Settings::default());
    timed("one sphere of a copy at another place, ready to render", 5, || {
        let mut edited = scene.clone();
        edited.description.objects[7] = Object::new(Sphere { radius: 0.4 }).at(0.5, 0.3, 0.0).into();
        picture.rebuild(&scene, &edited, &settings)
    })?;
    let moving = scene.with_value("/objects/7/transform", json!([{"translate": ["=frame", 0, 0]}]))?;
    timed("another frame, when one sphere moves", RUNS, || Ok(moving.at_frame(3.0)?))?;
    timed("compiled with an open shutter, all still", 5, || Ok(scene.compile()?))?;
    timed("compiled with an open shutter, one moves", 5, || Ok(moving.compile()?))?;
    Ok(())
}

fn ten_thousand_moving_spheres() -> Result<(), Error> {
    println!("\n{MOVING} moving spheres");
    let sphere = |i: u32| {
        let [x, y] = [i % 100, i / 100];
        format!(
            r#"{{"shape": {{"sphere": {{"radius": 0.4}}}}, "transform": {{"translate": [{x}, {y}, "=sin({i} + frame / 5)"]}}}}"#
        )
    };
    let spheres: Vec<String> = (0..MOVING).map(sphere).collect();
    let text = format!(
        r#"{{"version": 1, "render": {{"size": [64, 64], "shutter": [0, 0.5]}}, "objects": [{}]}}"#,
        spheres.join(", ")
    );
    let scene = Scene::from_json(text, "moving.json")?;
    timed("another frame", RUNS, || Ok(scene.at_frame(3.0)?))?;
    let still = scene.still();
    timed("compiled with an open shutter, all still", 5, || Ok(still.at_frame(0.0)?.compile()?))?;
    timed("compiled with an open shutter, all move", 5, || Ok(scene.at_frame(3.0)?.compile()?))?;
    Ok(())
}
