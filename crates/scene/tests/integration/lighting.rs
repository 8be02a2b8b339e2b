//! Light files: how often they are read, their part in the fingerprint, errors of invalid ones.

use juggler_imaging::{Header, ImageFormat, create};
use juggler_light::AnyLight;
use juggler_math::{Image, Ray, Rgb, Vec3};
use juggler_scene::{Bundle, Scene};
use juggler_world::World;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

const PROFILE: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 20\n0 90\n0\n100 50\n";

/// A folder with a panorama whose left half is twice as bright as its right, and a photometric
/// file.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.exr", "a.hdr", "a.png"] {
        save(&folder.path().join(name), 1.0);
    }
    fs::write(folder.path().join("luminaire.ies"), PROFILE).unwrap();
    folder
}

fn save(path: &Path, right: f32) {
    let image =
        Image::from_pixels(8, 4, (0..32).map(|i| Rgb::splat(if i % 8 < 4 { 0.5 } else { 0.25 * right })).collect());
    let mut writer = create(path, ImageFormat::from_path(path).unwrap(), &Header::new(8, 4)).unwrap();
    writer.write_rows(image.unwrap().pixels().into()).unwrap();
    writer.finish().unwrap();
}

fn scene(background: &str, lights: &str) -> String {
    format!(
        r#"{{"version": 1, "background": {background}, "lights": [{lights}],
            "animation": {{"frames": 10}}, "render": {{"shutter": [0, 1]}}, "objects": [{{"shape": "sphere"}}]}}"#
    )
}

fn panorama(file: &str, more: &str) -> String {
    scene(&format!(r#"{{"environment": {{"file": "{file}"{more}}}}}"#), "")
}

fn light(file: &str, more: &str) -> String {
    scene(r##""#000000""##, &format!(r#"{{"point": {{"position": [0, 5, 0], "ies": {{"file": "{file}"{more}}}}}}}"#))
}

fn load(folder: &TempDir, text: &str) -> Scene {
    let path = folder.path().join("scene.json");
    fs::write(&path, text).unwrap();
    Scene::load(path).unwrap()
}

fn complaint(folder: &TempDir, text: &str) -> String {
    let scene = load(folder, text);
    let text = scene.compile().map(|_| ()).unwrap_err().to_string();
    assert_eq!(scene.check().to_string(), text);
    text.replace(&format!("{}/", folder.path().display()), "")
}

fn towards(world: &World, direction: Vec3) -> f32 {
    world.background_radiance(&Ray::new(Vec3::ZERO, direction)).g
}

#[test]
fn panorama_is_visible_and_loaded_once() {
    let folder = folder();
    for file in ["a.exr", "a.hdr", "a.png"] {
        let scene = load(&folder, &panorama(file, r#", "scale": 4"#));
        let world = scene.compile().unwrap().world;
        let seen = [Vec3::X, Vec3::NEG_X].map(|direction| towards(&world, direction));
        assert!((seen[0] - 2.0).abs() < 0.02 && (seen[1] - 1.0).abs() < 0.02, "{file}: {seen:?}");
        let (path, bytes) = (folder.path().join(file), world.geometry_stats().background_bytes as u64);
        let panoramas = scene.needs().panoramas;
        assert_eq!((panoramas.len(), panoramas[0].name.as_str()), (1, file));
        let estimate = panoramas[0].estimate;
        assert!(
            bytes > 0 && estimate.resident_bytes >= bytes && estimate.peak_bytes > estimate.resident_bytes,
            "{file}: {estimate:?}"
        );
        assert!(scene.fingerprint().parts().contains_key(&format!("file {file}")));
        assert!(scene.paths().contains(&path));
        // The file changes, but was read already.
        save(&path, 2.0);
        let later = scene.at_frame(1.0).unwrap();
        assert_eq!(later.fingerprint(), scene.fingerprint());
        let edited = scene.with_value("/background/environment/rotation_degrees", 180.into()).unwrap();
        let world = edited.compile().unwrap().world;
        assert!((towards(&world, Vec3::NEG_X) - 2.0).abs() < 0.02);
        let renewed = scene.reload(folder.path().join("scene.json")).unwrap();
        assert_ne!(renewed.fingerprint(), scene.fingerprint());
        assert!(!renewed.has_world_of(&scene) && later.has_world_of(&scene));
        assert!((towards(&renewed.compile().unwrap().world, Vec3::NEG_X) - 2.0).abs() < 0.02);
    }
    assert_eq!(load(&folder, &panorama("none.exr", "")).needs().panoramas[0].estimate, Default::default());
}

#[test]
fn bundled_files_are_loaded() {
    let folder = folder();
    let file = |name: &str| (name.to_owned(), fs::read(folder.path().join(name)).unwrap());
    let text = panorama("panoramas/a.exr", "").replace(
        r#""lights": []"#,
        r#""lights": [{"spot": {"position": [0, 5, 0], "ies": {"file": "luminaire.ies"}}}]"#,
    );
    let bundle: Bundle =
        [("s.json".to_owned(), text.into_bytes()), file("a.exr"), file("luminaire.ies")].into_iter().collect();
    let scene = Scene::from_bundle(bundle, "s.json").unwrap();
    assert!(scene.compile().is_ok());
}

#[test]
fn skies_are_precomputed_for_each_frame() {
    let folder = folder();
    let scene = load(&folder, &scene(r#"{"sky": {"sun_elevation_degrees": "=20 + 10 * frame"}}"#, ""));
    let up = |scene: &Scene| towards(&scene.compile().unwrap().world, Vec3::Y);
    let first = up(&scene);
    let others: Vec<f32> = (1..7).map(|frame| up(&scene.at_frame(f64::from(frame)).unwrap())).collect();
    assert!(first > 0.0 && others.iter().all(|other| *other > first), "{first} {others:?}");
    // A sky that was prepared before equals one that is prepared now.
    assert_eq!((up(&scene), up(&scene.at_frame(6.0).unwrap())), (first, others[5]));
}

#[test]
fn lights_keep_their_files_when_they_move() {
    let folder = folder();
    let text = light("luminaire.ies", "").replace("[0, 5, 0]", r#"["=4 * frame", 5, 0]"#);
    let scene = load(&folder, &text);
    let compiled = scene.compile().unwrap();
    assert!(compiled.warnings.to_string().is_empty(), "{}", compiled.warnings);
    let light = &compiled.world.lights()[0];
    assert!(light.moves());
    for time in [0.0, 0.5, 1.0] {
        let AnyLight::Point(point) = &light.at(time).light else { unreachable!() };
        assert!((point.position.x - 4.0 * time).abs() < 0.02);
        let under = point.position - Vec3::Y;
        assert!(light.at(time).light.sample(under, Default::default()).is_some(), "{time}");
    }
    assert!(scene.fingerprint().parts().contains_key("file luminaire.ies"));
    assert!(scene.paths().contains(&folder.path().join("luminaire.ies")));
    let before = scene.fingerprint();
    fs::write(folder.path().join("luminaire.ies"), PROFILE.replace("100 50", "100 60")).unwrap();
    assert_eq!(scene.at_frame(0.0).unwrap().fingerprint(), before);
    assert_ne!(load(&folder, &text).fingerprint(), before);
}

#[test]
fn infinite_pixels_of_environments_and_textures_are_warnings() {
    let folder = folder();
    let endless = [b"Pf\n1 1\n-1\n".as_slice(), &f32::INFINITY.to_le_bytes()].concat();
    fs::write(folder.path().join("endless.pfm"), endless).unwrap();
    let scene = load(&folder, &panorama("endless.pfm", ""));
    let warnings = scene.compile().unwrap().warnings.render(false);
    assert!(warnings.contains("`endless.pfm`: 1 pixel is infinite and becomes 65504"), "{warnings}");
    assert!(warnings.contains("at: background.environment.file"), "{warnings}");
    let textured = r#"{"version": 1, "textures": {"wall": {"image": {"file": "endless.pfm"}}},
        "materials": {"wall": {"diffuse": {"reflectance": "wall"}}}, "objects": [{"shape": "sphere", "material": "wall"}]}"#;
    let warnings = load(&folder, textured).compile().unwrap().warnings.render(false);
    assert!(warnings.contains("`endless.pfm`: 1 pixel is infinite and becomes 65504"), "{warnings}");
    assert!(warnings.contains("at: textures.wall"), "{warnings}");
}

#[test]
fn wrong_files_say_what_is_wrong_and_where() {
    let folder = folder();
    fs::write(folder.path().join("text.hdr"), "no picture").unwrap();
    fs::write(folder.path().join("none.pfm"), "Pf\n0 5\n-1\n").unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe.exr")).status().unwrap().success());
    for (file, message) in [
        ("pipe.exr", "cannot read `pipe.exr`: this is a named pipe (FIFO), not a regular file"),
        ("nowhere.exr", "cannot read `nowhere.exr`: file not found"),
        (".", "cannot read `.`: this is a folder, not a file"),
        ("text.hdr", "`text.hdr`: its first bytes match no supported format"),
        ("none.pfm", "`none.pfm`: its size is 0 × 5 (PFM"),
    ] {
        let text = complaint(&folder, &panorama(file, ""));
        assert!(text.contains(message), "{file}: {text}");
        assert!(text.contains("at: background.environment.file"), "{text}");
    }
    let text = complaint(&folder, &panorama("a.exr", r#", "up": [0, 0, 0]"#));
    assert!(text.contains("at: background.environment.up") && text.matches("error").count() == 1, "{text}");
    let bright = [b"Pf\n1 1\n-1\n".as_slice(), &1e3f32.to_le_bytes()].concat();
    fs::write(folder.path().join("bright.pfm"), bright).unwrap();
    let text = complaint(&folder, &panorama("bright.pfm", r#", "scale": 1e28"#));
    assert!(text.contains("at: background.environment.scale"), "{text}");

    fs::write(folder.path().join("short.ies"), &PROFILE[..PROFILE.len() - 4]).unwrap();
    fs::write(folder.path().join("word.ies"), PROFILE.replace("100 50", "100 five")).unwrap();
    fs::write(folder.path().join("long.ies"), " ".repeat((16 << 20) + 1)).unwrap();
    for (file, message) in [
        ("nowhere.ies", "cannot read `nowhere.ies`: file not found"),
        ("short.ies", "cannot read `short.ies`: line 7: "),
        ("word.ies", "cannot read `word.ies`: line 7: "),
        ("long.ies", "bytes"),
    ] {
        let text = complaint(&folder, &light(file, ""));
        assert!(text.contains(message), "{file}: {text}");
        assert!(text.contains("at: lights[0].point.ies.file") && !text.contains("no light"), "{text}");
    }
}
