//! Lesson 4: renders a mesh with a texture, both computed in memory, and a moving sphere to
//! `wave.png`; then edits the scene for `wave_later.png` and `wave_polished.png`. The example reads
//! no file and converts no array to text.
//!
//! `cargo run --release --example 4_meshes_images_and_motion`

use juggler::prelude::*;

/// Points along an edge of the surface.
const POINTS: u32 = 240;

/// Height of the wave at a distance from its center, both in scene units.
fn height(distance: f32) -> f32 {
    let x = 9.0 * distance;
    if x < 1e-3 { 1.0 } else { x.sin() / x }
}

/// The wave over the square from -1 to 1, with a normal at every point.
fn wave() -> Mesh {
    let place = |i: u32| 2.0 * i as f32 / (POINTS - 1) as f32 - 1.0;
    let points = (0..POINTS).flat_map(|row| (0..POINTS).map(move |column| (place(column), place(row))));
    let (mut positions, mut normals, mut uvs) = (Vec::new(), Vec::new(), Vec::new());
    for (x, z) in points {
        let distance = x.hypot(z);
        let slope = (height(distance + 1e-3) - height(distance)) / 1e-3 / distance.max(1e-3);
        positions.push(vec3(x, height(distance), z));
        normals.push(vec3(-slope * x, 1.0, -slope * z));
        uvs.push(vec2(0.5 + 0.5 * x, 0.5 - 0.5 * z));
    }
    let corner = |row: u32, column: u32| row * POINTS + column;
    let cells = (1..POINTS).flat_map(|row| (1..POINTS).map(move |column| (row, column)));
    let triangles = cells.flat_map(|(row, column)| {
        let [a, b] = [corner(row - 1, column - 1), corner(row - 1, column)];
        let [c, d] = [corner(row, column - 1), corner(row, column)];
        [[a, c, d], [a, d, b]]
    });
    Mesh::from_triangles(positions, triangles.collect::<Vec<_>>()).with_normals(normals).with_uvs(uvs)
}

/// Texture that maps height to color, from blue over white to orange, with a dark line every tenth.
fn colors() -> Option<Image> {
    const EDGE: u32 = 1024;
    let place = |i: u32| 2.0 * i as f32 / (EDGE - 1) as f32 - 1.0;
    let color = |x: f32, y: f32| {
        let height = height(x.hypot(y));
        let (low, middle, high) = (Rgb::new(0.03, 0.11, 0.4), Rgb::splat(0.75), Rgb::new(0.9, 0.25, 0.02));
        let plain = if height < 0.0 { middle.lerp(low, -4.0 * height) } else { middle.lerp(high, height.sqrt()) };
        let to_line = (10.0 * height - (10.0 * height).round()).abs();
        plain * if to_line < 0.04 { 0.25 } else { 1.0 }
    };
    let pixels = (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| color(place(x), place(y))));
    Image::from_pixels(EDGE, EDGE, pixels.collect())
}

fn main() -> Result<(), Error> {
    let sky = background::Sky { sun_elevation_degrees: 28.0, sun_azimuth_degrees: 200.0, ..Default::default() };
    let camera = Perspective::new([1.5, 1.25, 2.2], [0.0, 0.25, 0.0]);
    let paint = Diffuse::new("heights");
    let mut scene = Scene::new()
        .size(800, 450)
        .samples(64)
        .integrator(integrator::Path::default())
        .camera("main", camera)
        .background(sky)
        .texture("heights", texture::Image::new("colors"))
        .material("paint", paint)
        .add(Object::new(wave()).material_named("paint"))
        .add(Object::new(Plane::default()).at(0.0, -0.25, 0.0).material(Diffuse::new(0.25)));
    if let Some(image) = colors() {
        scene = scene.image("colors", image);
    }

    // Move a sphere around the wave by expressions of the frame, and keep the shutter open for
    // half a frame.
    let circle = ValueSource::expressions(["0.62 * cos(frame / 12)", "-0.02", "0.62 * sin(frame / 12)"]);
    let ball = Object::new(Sphere::new(0.09)).material(Conductor::default());
    let mut scene = scene.add_animated(Animated::new(ball).moved(circle))?;
    scene.description.render.shutter = [0.0, 0.5];
    let picture = Picture::new(&scene, &Settings::default())?;
    picture.render_in_memory(None, &Control::default())?.save("wave.png")?;
    juggler::render_to_file(&scene.at_frame(12.0)?, &Settings::default(), "wave_later.png")?;

    // Replace the material by editing its value. The new picture shares meshes and hierarchies with
    // the old one.
    let mut polished = scene.clone();
    polished.description.materials.insert("paint".into(), AnyMaterial::from(Conductor::default()).into());
    let picture = picture.rebuild(&scene, &polished, &Settings::default())?;
    picture.render_in_memory(None, &Control::default())?.save("wave_polished.png")?;
    Ok(())
}
