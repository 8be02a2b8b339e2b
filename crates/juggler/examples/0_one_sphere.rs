//! Lesson 0: renders one sphere with all defaults to `one_sphere.png`.
//!
//! `cargo run --release --example 0_one_sphere`

use juggler::prelude::*;

fn main() -> Result<(), Error> {
    let scene = Scene::new().add(Object::new(Sphere::default()));
    juggler::render_to_file(&scene, &Settings::default(), "one_sphere.png")?;
    Ok(())
}
