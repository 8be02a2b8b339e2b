//! Light, backdrop, floor, turntable and camera of models and meshes from the command line.

use crate::harness::Folder;
use juggler::imaging;
use juggler::math::Rgb;
use serde_json::Value;
use std::fs;

/// A folder with a tetrahedron, 2 units high.
fn with_solid() -> Folder {
    let folder = Folder::new();
    let text = "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 2 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
    fs::write(folder.path("solid.obj"), text).unwrap();
    folder
}

fn scene(folder: &Folder, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.path(name)).unwrap()).unwrap()
}

/// A product picture on white: the background is white to the last level, the shadow is gray.
#[test]
fn a_product_stands_on_white_with_a_soft_shadow() {
    let folder = with_solid();
    folder.good("render solid.obj -q --background white --floor shadow --size 40x30 --samples 16 -o a.png");
    let image = imaging::read_with_alpha(&folder.path("a.png")).unwrap();
    assert_eq!(image.alpha, None);
    let pixels = image.colors.pixels();
    assert_eq!((pixels[0], pixels[39]), (Rgb::WHITE, Rgb::WHITE));
    let darkened = pixels.iter().filter(|pixel| pixel.g < 0.97).count();
    assert!(darkened > 100, "{darkened}");
    // JPEG and movies show the color, too; linear files have alpha instead.
    folder.good("render solid.obj -q --background white --size 40x30 --samples 2 -o a.jpg");
    folder.good("render solid.obj -q --background transparent --size 40x30 --samples 2 -o b.png");
    assert!(imaging::read_with_alpha(&folder.path("b.png")).unwrap().alpha.is_some());
    let refused = folder.bad("render solid.obj --background white --size 40x30 --samples 2 -o a.hdr", 2);
    assert!(refused.contains("cannot be transparent"), "{refused}");
}

#[test]
fn a_turntable_is_a_movie_in_one_command() {
    let folder = with_solid();
    folder.good("render solid.obj -q --turntable 5 --size 20x16 --samples 2 -o turn.gif");
    let bytes = fs::read(folder.path("turn.gif")).unwrap();
    // Each frame has a graphic control extension.
    assert_eq!(bytes.windows(3).filter(|start| start == b"\x21\xf9\x04").count(), 5);
}

/// With a backdrop, frames are opaque: MP4 shows the color, and other movies have no alpha.
#[test]
fn movies_on_a_background_are_opaque() {
    let folder = with_solid();
    folder.good("render solid.obj -q --turntable 2 --background white --size 20x16 --samples 2 -o turn.mp4");
    folder.good("render ball.json -q --frames 0..2 --background white --size 20x16 -o ball.mp4");
    let text = fs::read_to_string(folder.path("ball.json")).unwrap();
    let text = text.replace(r#""samples": 2"#, r#""samples": 2, "transparent": true"#);
    let text = text.replacen('{', r#"{"tone": {"backdrop": "white"}, "#, 1);
    fs::write(folder.path("own.json"), text).unwrap();
    folder.good("render own.json -q --frames 0..2 --size 20x16 -o own.mp4");
    folder.good("render own.json -q --frames 0..2 --size 20x16 -o own.webp");
    let webp = fs::read(folder.path("own.webp")).unwrap();
    assert_eq!(webp[20] & 0b1_0010, 0b10, "an animation without alpha");
    let refused = folder.bad("render ball.json --frames 0..2 --background transparent --size 20x16 -o b.mp4", 2);
    assert!(refused.contains("MP4 cannot be transparent"), "{refused}");
    // `--background transparent` takes the backdrop of the scene away.
    folder.good("render own.json -q --background transparent -o own.png");
    assert!(imaging::read_with_alpha(&folder.path("own.png")).unwrap().alpha.is_some());
}

#[test]
fn a_turntable_asks_for_all_frames() {
    let folder = with_solid();
    let turn = "render solid.obj --turntable 3 --size 20x16 --samples 2";
    folder.good(&format!("{turn} -q -o turn.webp"));
    let webp = fs::read(folder.path("turn.webp")).unwrap();
    assert_eq!(webp.windows(4).filter(|chunk| chunk == b"ANMF").count(), 3);
    folder.good(&format!("{turn} -q -o zz_##.png"));
    assert_eq!(folder.files(), ["solid.obj", "turn.webp", "zz_00.png", "zz_01.png", "zz_02.png"]);
    // One picture is one frame; the program says so unless the frame is chosen.
    let run = folder.run(&format!("{turn} -o one.png"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("note: --turntable 3 has 3 frames"), "{}", run.stderr);
    assert!(run.stderr.contains("-o 'one_####.png' writes all of them"), "{}", run.stderr);
    for line in ["--frame 1 -o one.png", "--frame 1 -o one_#.png", "--at 0 -o one.webp"] {
        let run = folder.run(&format!("{turn} {line}"));
        assert!(run.status == 0 && !run.stderr.contains("note:"), "{}", run.stderr);
    }
    assert!(!folder.path("one_0.png").exists() && folder.path("one_1.png").exists());
    assert_eq!(fs::read(folder.path("one.webp")).unwrap()[12..16], *b"VP8L", "a picture");
}

/// The background is as white in a GIF as in a PNG, in all frames.
#[test]
fn white_is_white_in_a_gif() {
    let folder = with_solid();
    let line =
        "render solid.obj -q --turntable 2 --background white --floor none --view iso --size 200x160 --samples 4";
    folder.good(&format!("{line} -o a.gif"));
    folder.good(&format!("{line} --frame 0 -o a.png"));
    let pixels = |name: &str| imaging::read(&folder.path(name)).unwrap().pixels().to_vec();
    let (gif, png) = (pixels("a.gif"), pixels("a.png"));
    let white: Vec<usize> = (0..png.len()).filter(|i| png[*i] == Rgb::WHITE).collect();
    assert!(white.len() > png.len() / 4 && white.len() < png.len(), "{}", white.len());
    assert!(white.iter().all(|i| gif[*i] == Rgb::WHITE));
}

#[test]
fn info_knows_movies() {
    let folder = with_solid();
    for name in ["turn.gif", "turn.mp4"] {
        folder.good(&format!("render solid.obj -q --turntable 3 --size 20x16 --samples 2 -o {name}"));
    }
    let printed = folder.good("info turn.gif").stdout;
    assert!(printed.contains("20x16, GIF") && printed.contains("3 frames, 0.1 s"), "{printed}");
    let json: Value = serde_json::from_str(&folder.good("info turn.gif --json").stdout).unwrap();
    assert_eq!((json["frames"].as_u64(), json["seconds"].as_f64()), (Some(3), Some(0.1)));
    let printed = folder.good("info turn.mp4").stdout;
    assert!(printed.contains("MP4; `juggler info` does not read its frames"), "{printed}");
    let json: Value = serde_json::from_str(&folder.good("info turn.mp4 --json").stdout).unwrap();
    assert_eq!(json["format"], "mp4");
}

/// What a command shows is what `convert` writes with the same flags, and `info` prints the camera.
#[test]
fn converted_scenes_show_what_the_flags_show() {
    let folder = with_solid();
    let flags = "--environment studio --background #f4f4f0 --floor --view left --fov 20 --fit 0.6";
    folder.good(&format!("convert solid.obj a.json {flags}"));
    let written = scene(&folder, "a.json");
    assert!(written["background"]["studio"].is_object() && written["lights"].as_array().is_none_or(Vec::is_empty));
    assert_eq!(written["camera"]["perspective"]["vertical_fov_degrees"], 20.0);
    let hash = |line: &str| folder.hash(&format!("{line} --size 80x60 --samples 2 -o a.png"));
    assert_eq!(hash("a.json"), hash(&format!("solid.obj {flags}")));
    let printed: Value = serde_json::from_str(&folder.good("info a.json --json").stdout).unwrap();
    assert_eq!(printed["camera"]["perspective"]["eye"], written["camera"]["perspective"]["eye"]);
    assert!(folder.good("info a.json").stdout.contains("{\"perspective\":{"));
    // Without flags, the camera that frames the mesh is written, too.
    folder.good("convert solid.obj b.json");
    assert!(scene(&folder, "b.json")["camera"]["perspective"]["look_at"].is_array());
}

#[test]
fn the_command_in_a_picture_has_the_flags_of_its_stage() {
    let folder = with_solid();
    folder.good("render solid.obj -q --background White --view top --fit 0.5 --size 20x16 --samples 2 -o a.png");
    let printed = folder.good("info a.png").stdout;
    let command = "juggler render solid.obj --background '#ffffff' --view top --fit 0.5 --size 20x16 --samples 2";
    assert!(printed.contains(command), "{printed}");
}

#[test]
fn wrong_values_and_combinations_are_refused() {
    let folder = with_solid();
    for (flags, said) in [
        ("--background whit", "did you mean `white`?"),
        ("--background transparant", "did you mean `transparent`?"),
        ("--background fff", "did you mean `#fff`?"),
        ("--background white --transparent", "--transparent shows nothing where nothing is"),
        ("--view isometric", "did you mean `iso`?"),
        ("--floor shadows", "did you mean `shadow`?"),
        ("--floor shadow", "--floor shadow shows only shadows"),
        ("--environment studdio", "neither studio nor sky, and there is no file of this name; did you mean `studio`?"),
        ("--view up", "front, back, left, right, top, bottom, iso"),
        ("--floor wood", "solid, shadow, none"),
        ("--turntable 0", "such as 120"),
        ("--fov 180", "at most 179"),
        ("--fit 1.2", "a fraction is above 0 and at most 1, such as 0.9"),
        ("--eye 1,2", "such as 0,1.5,-4"),
        ("--eye 1,2,3 --view top", "cannot be used with"),
        ("--environment none.hdr", "none.hdr"),
    ] {
        let message = folder.bad(&format!("render solid.obj {flags} --size 20x16 -o a.png"), 2);
        assert!(message.contains(said), "{flags}: {message}");
    }
    for (flags, said) in [
        ("--floor", "`floor`"),
        ("--environment sky", "--environment is for models and meshes"),
        ("--turntable 4", "--turntable is for models and meshes"),
        ("--camera top --view left", "give one of them"),
    ] {
        let message = folder.bad(&format!("render ball.json {flags} -o a.png"), 2);
        assert!(message.contains(said) || message.contains("--floor is for models and meshes"), "{flags}: {message}");
    }
    // Cameras and backgrounds are for all scenes.
    folder.good("render ball.json -q --view top --background tomato -o a.png");
}
