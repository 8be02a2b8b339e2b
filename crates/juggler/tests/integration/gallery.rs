//! The scenes of the gallery are without mistakes, show something, and are told of.

use juggler::scene::Scene;
use juggler::tracer::render::Control;
use juggler::{Picture, Settings};
use std::path::{Path, PathBuf};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gallery");
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

fn files() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(FOLDER).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "json")).collect();
    files.sort();
    files
}

#[test]
fn each_scene_shows_something() {
    for file in files() {
        let name = file.display();
        let scene = Scene::load(&file).unwrap();
        let problems = scene.check();
        assert!(problems.list().is_empty(), "{}", problems.render(false));
        let settings = Settings { size: Some([64, 36]), samples: Some(2), ..Settings::default() };
        let image = Picture::new(&scene, &settings).unwrap().image(&Control::default()).unwrap();
        let light = |pixel: &juggler::math::Rgb| f64::from(pixel.luminance());
        let mean = image.pixels().iter().map(light).sum::<f64>() / image.pixels().len() as f64;
        assert!(mean > 1e-3 && mean.is_finite(), "{name}: {mean}");
    }
}

#[test]
fn each_scene_is_told_of_with_its_picture() {
    let text = std::fs::read_to_string(Path::new(DOCS).join("gallery.md")).unwrap();
    let files = files();
    assert!(files.len() >= 7);
    for file in files {
        let name = file.file_stem().unwrap().to_str().unwrap();
        assert!(text.contains(&format!("scenes/gallery/{name}.json")), "{name} is not in docs/gallery.md");
        assert!(Path::new(DOCS).join(format!("pictures/gallery/{name}.jpg")).exists(), "{name} has no picture");
    }
}
