//! Lesson 3: reports the progress of a render from another thread, and cancels it after two
//! seconds.
//!
//! `cargo run --release --example 3_progress_and_cancel`

use juggler::prelude::*;
use std::io::{Write, stdout};
use std::thread;
use std::time::{Duration, Instant};

fn main() -> Result<(), Error> {
    let scene = Scene::new().size(1920, 1080).samples(64).add(Object::new(Sphere::default()));
    let picture = Picture::new(&scene, &Settings::default())?;
    let control = Control::default();
    let image = thread::scope(|scope| {
        let render = scope.spawn(|| picture.render_image(&control));
        let start = Instant::now();
        while !render.is_finished() {
            let percent = 100.0 * control.samples() as f64 / picture.total_samples() as f64;
            let _ = writeln!(stdout(), "{percent:.0} %, {} rays", control.rays().total());
            if start.elapsed() > Duration::from_secs(2) {
                control.cancel();
            }
            thread::sleep(Duration::from_millis(100));
        }
        render.join()
    });
    let answer = match image {
        Ok(Ok(image)) => format!("{} pixels are there", image.pixels().len()),
        Ok(Err(stopped)) => stopped.to_string(),
        Err(_) => "the render panicked".into(),
    };
    let _ = writeln!(stdout(), "{answer}");
    Ok(())
}
