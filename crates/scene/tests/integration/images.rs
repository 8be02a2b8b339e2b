//! Image textures from files: color spaces, how often they are read, errors of invalid ones.

use juggler_imaging::{Header, ImageFormat, Options, Tone, create};
use juggler_math::{Image, Rgb, color::srgb_decode};
use juggler_scene::compile::AssetCache;
use juggler_scene::{Bundle, Scene};
use juggler_texture::ColorSpace;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// A folder with an image of two colors in every format, a 16-bit PNG, and a scene.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let pixels = [Rgb::splat(0.25), Rgb::new(0.5, 0.5, 0.25)];
    let image = Image::from_pixels(16, 16, (0..256).map(|i| pixels[usize::from(i % 16 >= 8)]).collect()).unwrap();
    for format in ImageFormat::ALL {
        save(&folder.path().join(format!("a.{}", format.extension())), &image, Options::default());
    }
    save(&folder.path().join("deep.png"), &image, Options { png_16_bit: true, ..Options::default() });
    folder
}

fn save(path: &Path, image: &Image, options: Options) {
    let tone = Tone { dither: false, ..Tone::default() };
    let header = Header { options, tone, ..Header::new(image.width(), image.height()) };
    let mut writer = create(path, ImageFormat::from_path(path).unwrap(), &header).unwrap();
    writer.write_rows(image.pixels().into()).unwrap();
    writer.finish().unwrap();
}

fn scene(file: &str, more: &str) -> String {
    format!(
        r#"{{"version": 1, "textures": {{"a": {{"image": {{"file": "{file}"{more}}}}}}},
            "materials": {{"m": {{"phong": {{"diffuse": "a"}}}}}},
            "objects": [{{"shape": "sphere", "material": "m"}}]}}"#
    )
}

fn load(folder: &TempDir, file: &str, more: &str) -> Scene {
    let path = folder.path().join("scene.json");
    fs::write(&path, scene(file, more)).unwrap();
    Scene::load(path).unwrap()
}

fn complaint(folder: &TempDir, file: &str) -> String {
    let text = load(folder, file, "").compile().map(|_| ()).unwrap_err().to_string();
    text.replace(&format!("{}/", folder.path().display()), "")
}

/// Expected value: CSS Color Module Level 4, section 18, from linear Display P3 to linear sRGB.
#[test]
fn textures_convert_the_primaries_that_files_state() {
    let folder = tempfile::tempdir().unwrap();
    let original = Rgb::new(0.05, 0.25, 0.1);
    let image = Image::from_pixels(2, 1, vec![original; 2]).unwrap();
    let tone = Tone { dither: false, primaries: juggler_imaging::Primaries::DisplayP3, ..Tone::default() };
    for (name, png_16_bit) in [("a.png", false), ("deep.png", true), ("a.exr", false)] {
        let path = folder.path().join(name);
        let options = Options { png_16_bit, ..Options::default() };
        let header = Header { options, tone: tone.clone(), ..Header::new(2, 1) };
        let mut writer = create(&path, ImageFormat::from_path(&path).unwrap(), &header).unwrap();
        writer.write_rows(image.pixels().into()).unwrap();
        writer.finish().unwrap();
        let texel = |space| AssetCache::default().image(&path, space).unwrap().texel(0, 0, 0);
        let stored = [0.8225 * 0.05 + 0.1775 * 0.25, 0.0332 * 0.05 + 0.9668 * 0.25];
        for i in 0..3 {
            assert!(
                (texel(ColorSpace::Auto)[i] - original.to_array()[i]).abs() < 3e-3,
                "{name} {:?}",
                texel(ColorSpace::Auto)
            );
        }
        // A stated color space takes the levels as they are.
        let red = texel(ColorSpace::Linear)[0];
        let red = if name == "a.exr" { red } else { srgb_decode(red) };
        assert!((red - stored[0]).abs() < 3e-3 && (original.r - stored[0]).abs() > 0.03, "{name} {red}");
    }
}

#[test]
fn integer_images_default_to_srgb_and_float_images_to_linear() {
    let folder = folder();
    let red =
        |name: &str, space| AssetCache::default().image(&folder.path().join(name), space).unwrap().texel(0, 0, 0)[0];
    // Integer formats are encoded with the sRGB transfer function.
    for (name, tolerance) in [("a.png", 0.002), ("a.jpg", 0.01), ("a.webp", 0.002), ("deep.png", 1e-5)] {
        assert!((red(name, ColorSpace::Auto) - 0.25).abs() < tolerance, "{name} {}", red(name, ColorSpace::Auto));
        assert_eq!(red(name, ColorSpace::Auto), red(name, ColorSpace::Srgb));
        let level = red(name, ColorSpace::Linear);
        assert!((srgb_decode(level) - 0.25).abs() < tolerance, "{name} {level}");
    }
    for name in ["a.exr", "a.hdr", "a.pfm"] {
        assert_eq!((red(name, ColorSpace::Auto), red(name, ColorSpace::Linear)), (0.25, 0.25), "{name}");
        assert!((red(name, ColorSpace::Srgb) - srgb_decode(0.25)).abs() < 1e-7, "{name}");
    }
}

#[test]
fn textures_keep_the_smallest_sufficient_sample_type() {
    let folder = folder();
    for (name, bytes_a_sample) in [("a.png", 1), ("a.jpg", 1), ("a.exr", 2), ("a.hdr", 2), ("deep.png", 4)] {
        let path = folder.path().join(name);
        let pixels = AssetCache::default().image(&path, ColorSpace::Auto).unwrap();
        assert_eq!(pixels.bytes(), 341 * 3 * bytes_a_sample, "{name}");
        let needs = load(&folder, name, "").needs();
        let estimate = needs.pictures[0].estimate;
        assert_eq!((needs.pictures.len(), needs.pictures[0].name.as_str()), (1, name));
        assert!(
            estimate.resident_bytes >= pixels.bytes() as u64 && estimate.peak_bytes > estimate.resident_bytes,
            "{name}: {estimate:?}"
        );
        assert!(estimate.resident_bytes <= 4 * pixels.bytes() as u64 + 64, "{name}: {estimate:?}");
    }
    assert_eq!(load(&folder, "none.png", "").needs().pictures, []);
}

#[test]
fn a_picture_is_read_once_and_is_part_of_the_fingerprint() {
    let folder = folder();
    let scene = load(&folder, "a.png", "");
    let world = scene.compile().unwrap().world;
    assert_eq!(world.geometry_stats().texture_bytes, 341 * 3);
    assert_eq!(scene.needs().pictures.len(), 1);
    let before = scene.fingerprint();
    assert!(before.parts().contains_key("file a.png"));
    assert!(scene.paths().contains(&folder.path().join("a.png")));
    // The file changes, but was read already; a scene that is loaded again uses the new file.
    fs::copy(folder.path().join("a.webp"), folder.path().join("a.png")).unwrap();
    assert_eq!(scene.at_frame(1.0).unwrap().fingerprint(), before);
    let again = load(&folder, "a.png", "");
    assert_ne!(again.fingerprint(), before);
    assert!(!again.has_world_of(&scene) && again.has_world_of(&again.at_frame(1.0).unwrap()));
    let path = folder.path().join("scene.json");
    assert_eq!(scene.reload(path).unwrap().fingerprint(), again.fingerprint());
}

#[test]
fn bundled_files_are_loaded() {
    let folder = folder();
    let png = fs::read(folder.path().join("a.png")).unwrap();
    let text = scene("textures/a.png", r#", "color_space": "linear""#);
    let bundle: Bundle = [("s.json".to_owned(), text.into_bytes()), ("a.png".to_owned(), png)].into_iter().collect();
    assert!(Scene::from_bundle(bundle, "s.json").unwrap().compile().is_ok());
}

#[test]
fn a_file_is_looked_for_beside_the_scene_file_that_names_it() {
    let folder = folder();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::copy(folder.path().join("a.png"), folder.path().join("sub/b.png")).unwrap();
    fs::write(folder.path().join("sub/part.json"), scene("b.png", "")).unwrap();
    let path = folder.path().join("scene.json");
    fs::write(&path, r#"{"version": 1, "include": "sub/part.json"}"#).unwrap();
    assert!(Scene::load(path).unwrap().compile().is_ok());
}

#[test]
fn wrong_files_say_what_is_wrong_and_where() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("text.png"), "no picture").unwrap();
    fs::write(path("empty.png"), "").unwrap();
    for format in ImageFormat::ALL {
        let bytes = fs::read(path(&format!("a.{}", format.extension()))).unwrap();
        let cut = format!("cut.{}", format.extension());
        fs::write(path(&cut), &bytes[..bytes.len() / 2]).unwrap();
        let text = complaint(&folder, &cut);
        assert!(text.contains(&format!("cannot read `{cut}`: unexpected end of file at byte ")), "{text}");
        assert!(text.contains("at: textures.a.image.file"), "{text}");
    }
    assert!(Command::new("mkfifo").arg(path("pipe.png")).status().unwrap().success());
    // A header that declares 100,000 × 100,000 pixels.
    let mut huge = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n".to_vec();
    huge.extend([0; 64]);
    fs::write(path("huge.hdr"), huge).unwrap();
    fs::write(path("long.pfm"), b"Pf\n70000 1\n-1\n".iter().copied().chain(vec![0; 280_000]).collect::<Vec<u8>>())
        .unwrap();
    fs::write(path("none.pfm"), "Pf\n0 5\n-1\n").unwrap();
    for (file, message) in [
        ("nowhere.png", "cannot read `nowhere.png`: file not found"),
        (".", "cannot read `.`: this is a folder, not a file"),
        ("pipe.png", "cannot read `pipe.png`: this is a named pipe (FIFO), not a regular file"),
        ("/dev/zero", "cannot read `/dev/zero`: this is a device, not a regular file"),
        (
            "text.png",
            "`text.png`: its first bytes match no supported format (.png .jpg .exr .hdr .webp .pfm .tif .tga .bmp .gif)",
        ),
        ("empty.png", "`empty.png`: its first bytes match no supported format"),
        ("huge.hdr", "`huge.hdr`: 100000 × 100000 pixels are more than a Radiance HDR file of 119 bytes can hold"),
        ("long.pfm", "`long.pfm`: 70000 × 1 pixels; the limit is 65536 pixels per side"),
        ("none.pfm", "`none.pfm`: its size is 0 × 5 (PFM"),
    ] {
        let text = complaint(&folder, file);
        assert!(text.contains(message), "{file}: {text}");
    }
}

#[test]
fn a_file_of_several_pictures_gives_the_first_and_a_warning() {
    // A GIF of one red pixel, and the same with a second frame.
    let head = b"GIF89a\x01\x00\x01\x00\x80\x00\x00\xff\x00\x00\x00\xff\x00";
    let frame = |pixel: u8| [&b",\x00\x00\x00\x00\x01\x00\x01\x00\x00\x02\x02"[..], &[pixel, 0x01, 0x00]].concat();
    let folder = tempfile::tempdir().unwrap();
    let warnings = |frames: &[u8]| {
        let movie = [head.to_vec(), frames.iter().flat_map(|pixel| frame(*pixel)).collect(), b";".to_vec()].concat();
        fs::write(folder.path().join("a.gif"), movie).unwrap();
        let text = load(&folder, "a.gif", "").compile().unwrap().warnings.render(false);
        text.matches("holds several pictures; the texture shows the first").count()
    };
    assert_eq!(warnings(&[0x44]), 0);
    assert_eq!(warnings(&[0x44, 0x4c]), 1);
}
