//! Lesson 1: builds a scene of a mirror sphere over a checkered floor, and renders it to
//! `mirror_ball.png`.
//!
//! `cargo run --release --example 1_build_a_scene`

use juggler::prelude::*;

fn main() -> Result<(), Error> {
    let tiles = texture::Checker { size: 1.0, ..texture::Checker::default() };
    let floor = Phong::new("tiles");
    let mirror = Phong { reflection: 0.9.into(), ..Phong::new(0.0) };
    let scene = Scene::new()
        .size(640, 360)
        .samples(16)
        .texture("tiles", tiles)
        .camera("main", Perspective::new([0.0, 2.0, 6.0], [0.0, 1.0, 0.0]))
        .light(Point::new([4.0, 6.0, 4.0], 60.0))
        .background([0.3, 0.5, 0.9])
        .add(Object::new(Plane::default()).material(floor))
        .add(Object::new(Sphere::new(1.0)).at(0.0, 1.0, 0.0).material(mirror));
    juggler::render_to_file(&scene, &Settings::default(), "mirror_ball.png")?;
    Ok(())
}
