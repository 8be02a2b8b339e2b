//! The scenes of the gallery and of the lighting recipes have no errors, show something, and are
//! documented.

use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Picture, Settings};
use std::path::{Path, PathBuf};

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

/// Returns the scene files of a folder.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(Path::new(SCENES).join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "json")).collect();
    files.sort();
    files
}

#[test]
fn every_gallery_scene_is_valid_and_not_black() {
    for file in files("gallery").into_iter().chain(files("lighting")) {
        let name = file.display();
        let scene = Scene::load(&file).unwrap();
        let problems = scene.check();
        assert!(problems.list().is_empty(), "{}", problems.render(false));
        let settings = Settings { size: Some([64, 36]), samples: Some(2), ..Settings::default() };
        let image = Picture::new(&scene, &settings).unwrap().render_image(&Control::default()).unwrap();
        let light = |pixel: &juggler::math::Rgb| f64::from(pixel.luminance());
        let mean = image.pixels().iter().map(light).sum::<f64>() / image.pixels().len() as f64;
        assert!(mean > 1e-3 && mean.is_finite(), "{name}: {mean}");
    }
}

#[test]
fn each_scene_is_described_with_its_picture() {
    for (folder, least) in [("gallery", 7), ("lighting", 5)] {
        let page = format!("{folder}.md");
        let text = std::fs::read_to_string(Path::new(DOCS).join(&page)).unwrap();
        let files = files(folder);
        assert!(files.len() >= least);
        for file in files {
            let name = file.file_stem().unwrap().to_str().unwrap();
            assert!(text.contains(&format!("scenes/{folder}/{name}.json")), "{name} is not in docs/{page}");
            assert!(Path::new(DOCS).join(format!("pictures/{folder}/{name}.jpg")).exists(), "{name} has no picture");
        }
    }
}
