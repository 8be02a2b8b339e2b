//! Output files of `juggler render`.

use crate::harness::{Folder, Run, wait_until};
use juggler::imaging;
use juggler::math::Image;
use std::fs::{self, File};
use std::io::BufReader;
use std::process::Command;

fn image(folder: &Folder, name: &str) -> Image {
    imaging::read(&folder.path(name)).unwrap()
}

#[test]
fn the_picture_is_named_after_the_scene() {
    let folder = Folder::new();
    let run = folder.good("render ball.json");
    assert_eq!(folder.files(), ["ball.png"]);
    assert!(run.stdout.starts_with("ball.png: 16x9, 2 samples, "), "{}", run.stdout);
    assert!(run.stdout.trim_end().ends_with(" rays/s"), "{}", run.stdout);
    let took = run.stdout.split(", ").nth(2).unwrap_or_default();
    assert!(took.starts_with(|c: char| c.is_ascii_digit()) && took.ends_with('s'), "{}", run.stdout);
    folder.good("render juggler --size 8x5 --samples 1 -q");
    assert_eq!(folder.files(), ["ball.png", "juggler.png"]);
}

#[test]
fn one_pixel_is_a_picture() {
    let folder = Folder::new();
    folder.good("render ball.json --size 1x1 --samples 1 -q");
    let one = image(&folder, "ball.png");
    assert_eq!((one.width(), one.height()), (1, 1));
}

#[test]
fn every_format_holds_the_same_picture() {
    let folder = Folder::new();
    for name in ["a.pfm", "a.exr", "a.hdr", "a.png", "a.webp", "a.jpg"] {
        folder.good(&format!("render ball.json -q -o {name}"));
        assert_eq!((image(&folder, name).width(), image(&folder, name).height()), (16, 9), "{name}");
    }
    folder.good("compare a.exr a.pfm");
    folder.good("compare a.hdr a.pfm --tolerance 0.01");
    folder.good("compare a.webp a.png");
    folder.good("render ball.json -q -o half.exr --bits 16");
    folder.good("compare half.exr a.pfm --tolerance 0.001");
    folder.good("render ball.json -q -o deep.png --bits 16");
    assert!(fs::metadata(folder.path("deep.png")).unwrap().len() > fs::metadata(folder.path("a.png")).unwrap().len());
    folder.good("render ball.json -q -o low.jpg --quality 5");
    assert!(fs::metadata(folder.path("low.jpg")).unwrap().len() < fs::metadata(folder.path("a.jpg")).unwrap().len());
}

#[test]
fn standard_output_gets_the_bytes_of_the_file() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o a.png");
    folder.good("render ball.json -q -o a.exr");
    let png = folder.run("render ball.json -o -");
    assert!(png.status == 0 && png.stderr.contains("16x9"), "{}", png.stderr);
    assert_eq!(png.bytes, fs::read(folder.path("a.png")).unwrap());
    assert_eq!(folder.good("render ball.json -q -o - --format exr").bytes, fs::read(folder.path("a.exr")).unwrap());
    assert_eq!(folder.files(), ["a.exr", "a.png"]);
}

#[test]
fn an_existing_picture_is_replaced() {
    let folder = Folder::new();
    fs::write(folder.path("ball.png"), "old").unwrap();
    folder.good("render ball.json -q");
    assert_eq!(image(&folder, "ball.png").width(), 16);
    assert_eq!(folder.files(), ["ball.png"]);
}

#[test]
fn frames_are_half_open() {
    let folder = Folder::new();
    let run = folder.good("render ball.json --frames 1..3");
    assert_eq!(folder.files(), ["ball_0001.png", "ball_0002.png"]);
    assert_eq!(run.stdout.lines().count(), 2);
    folder.good("render ball.json -q --frames 2.. -o f_##.png --stats s##.json");
    assert_eq!(folder.files(), ["ball_0001.png", "ball_0002.png", "f_02.png", "f_03.png", "s02.json", "s03.json"]);
    folder.good("compare ball_0002.png f_02.png");
    folder.good("render ball.json -q --frame 2 -o single.png");
    folder.good("compare single.png f_02.png");
    folder.good("render ball.json -q --at 1.0 -o moment.png");
    folder.good("compare moment.png single.png");
    assert_eq!(folder.run("compare f_02.png f_03.png").status, 1);
}

#[test]
fn a_crop_is_a_rectangle_of_the_picture() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o whole.pfm");
    folder.good("render ball.json -q -o part.pfm --crop 5,2,4,3");
    let (whole, part) = (image(&folder, "whole.pfm"), image(&folder, "part.pfm"));
    assert_eq!((part.width(), part.height()), (4, 3));
    for (y, row) in part.pixels().chunks(4).enumerate() {
        let start = (y + 2) * 16 + 5;
        assert_eq!(row, &whole.pixels()[start..start + 4]);
    }
}

/// An EXR keeps the place of the crop: it is the whole picture with black around the crop, also
/// after a merge, and a movie's frames are recognized.
#[test]
fn a_crop_in_an_exr_keeps_its_place() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o whole.exr");
    folder.good("render ball.json -q -o part.exr --crop 5,2,4,3");
    let (whole, part) = (image(&folder, "whole.exr"), image(&folder, "part.exr"));
    assert_eq!((part.width(), part.height()), (whole.width(), whole.height()));
    let width = whole.width() as usize;
    for (index, pixel) in part.pixels().iter().enumerate() {
        let inside = (5..9).contains(&(index % width)) && (2..5).contains(&(index / width));
        let expected = if inside { whole.pixels()[index] } else { Default::default() };
        assert_eq!(*pixel, expected, "{index}");
    }
    let said = folder.good("info part.exr").stdout;
    let [w, h] = [whole.width(), whole.height()];
    assert!(said.contains(&format!("\ndata window  4x3 at 5, 2\ndisplay      {w}x{h} at 0, 0\n")), "{said}");
    let json: serde_json::Value = serde_json::from_str(&folder.good("info part.exr --json").stdout).unwrap();
    assert_eq!(json["windows"], serde_json::json!({"data": [5, 2, 4, 3], "display": [0, 0, w, h]}));
    folder.good("render ball.json -q --frames 0..2 -o f_##.exr --crop 5,2,4,3");
    let again = folder.good("render ball.json --frames 0..2 -o f_##.exr --crop 5,2,4,3");
    assert!(again.stdout.contains("f_00.exr: exists already"), "{}", again.stdout);
}

#[test]
fn half_floats_that_are_clamped_are_reported() {
    let folder = Folder::new();
    let scene = r#"{"version": 1, "camera": {"orthographic": {"height": 2}}, "render": {"size": [8, 8], "samples": 2, "integrator": "path"},
        "objects": [{"shape": {"sphere": {"radius": 0.4}}, "material": {"emissive": {"radiance": 1e6}}}]}"#;
    fs::write(folder.path("bright.json"), scene).unwrap();
    folder.good("render bright.json -q -o a.jfilm --aov light_groups");
    for line in [
        "render bright.json -o a.exr --bits 16",
        "render bright.json -o a.exr --bits 16 --aov depth",
        "merge a.jfilm -o a.exr --bits 16",
        "relight a.jfilm --gain rest=1 -o a.exr --bits 16",
    ] {
        let said = folder.run(line).stderr;
        let expected = "warning: `a.exr`: ";
        assert!(said.contains(expected) && said.contains("beyond the range of 16-bit floats"), "{line}: {said}");
        folder.good(&line.replace("16", "32"));
        assert!(image(&folder, "a.exr").pixels().iter().any(|pixel| pixel.r > 9e5), "{line}");
        folder.good(&format!("{line} -q"));
        let largest = image(&folder, "a.exr").pixels().iter().map(|pixel| pixel.r).fold(0.0, f32::max);
        assert_eq!(largest, 65_504.0, "{line}");
    }
}

#[test]
fn only_flags_that_affect_the_samples_change_the_hash() {
    let folder = Folder::new();
    let plain = folder.hash("ball.json");
    for same in
        ["--threads 1", "--threads 3", "--frame 0", "--at 0", "--integrator classic", "--camera main", "--exposure -1"]
    {
        assert_eq!(folder.hash(&format!("ball.json {same}")), plain, "{same}");
    }
    let others =
        ["--samples 3", "--seed 1", "--size 16x10", "--camera top", "--frame 1", "--at 0.1", "--integrator normals"];
    let mut seen = vec![plain];
    for other in others {
        let hash = folder.hash(&format!("ball.json {other}"));
        assert!(!seen.contains(&hash), "{other}");
        seen.push(hash);
    }
}

#[test]
fn exposure_and_tone_change_levels_only() {
    let folder = Folder::new();
    let render = |flags: &str| folder.good(&format!("render ball.json -q -o tone.png {flags}"));
    let level = |flags: &str| {
        render(flags);
        let file = BufReader::new(File::open(folder.path("tone.png")).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut levels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut levels).unwrap();
        levels.iter().map(|level| f64::from(*level)).sum::<f64>() / levels.len() as f64
    };
    let plain = level("");
    let [brighter, darker, linear] = ["--exposure 1", "--exposure -1", "--tone linear"].map(level);
    assert!(brighter > plain + 5.0 && darker < plain - 5.0 && linear < plain - 5.0, "{brighter} {darker} {linear}");
    let [agx, cooler] = ["--tone agx", "--white-balance 3200"].map(level);
    assert!((agx - plain).abs() > 0.5 && (cooler - plain).abs() > 0.5, "{plain} {agx} {cooler}");
    for flags in ["--exposure 1", "--tone linear", "--tone aces", "--white-balance 3000,5", "--dither off"] {
        assert_eq!(folder.hash(&format!("ball.json {flags}")), folder.hash("ball.json"), "{flags}");
    }
}

#[test]
fn wide_primaries_are_the_same_colors_in_other_numbers() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o a.exr");
    folder.good("render ball.json -q -o wide.exr --primaries acescg");
    folder.good("compare wide.exr a.exr --tolerance 1e-6");
    assert_ne!(fs::read(folder.path("wide.exr")).unwrap(), fs::read(folder.path("a.exr")).unwrap());
    folder.good("render ball.json -q -o a.png --bits 16");
    folder.good("render ball.json -q -o wide.png --bits 16 --primaries display_p3");
    folder.good("compare wide.png a.png --tolerance 1e-4");
    assert_eq!(folder.run("compare wide.png a.png").status, 1);
}

#[test]
fn a_converted_scene_is_the_same_picture() {
    let folder = Folder::new();
    folder.good("convert ball.json copy.json");
    for frame in ["", " --frame 3"] {
        assert_eq!(folder.hash(&format!("ball.json{frame}")), folder.hash(&format!("copy.json{frame}")));
    }
    assert_ne!(folder.hash("copy.json"), folder.hash("copy.json --frame 3"), "the ball moves");
    folder.good("convert ball.json later.json --frame 3");
    assert_eq!(folder.hash("ball.json --frame 3"), folder.hash("later.json"));
    let run = folder.good("convert juggler -");
    assert!(run.stdout.starts_with('{') && run.stdout.contains("\"version\": 1"), "{}", run.stdout);
}

/// Regression test: transforms that stretch a flat shape beyond what single precision can invert
/// made rays hit the same shape forever.
#[test]
fn renders_of_extreme_scales_terminate() {
    let folder = Folder::new();
    let shapes = ["\"disk\"", "\"rectangle\"", r#"{"triangle": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 0, 1]]}}"#];
    for (shape, scale) in shapes.iter().flat_map(|shape| ["1e24", "1e27", "1e30"].map(|scale| (shape, scale))) {
        let object = format!(r#"{{"shape": {shape}, "transform": [{{"scale": [1, {scale}, 1]}}]}}"#);
        fs::write(folder.path("flat.json"), format!(r#"{{"version": 1, "objects": [{object}]}}"#)).unwrap();
        let mut child = folder.command("render flat.json --size 8x8 --samples 1 -q").spawn().unwrap();
        wait_until("the render ends", || child.try_wait().unwrap().is_some());
        assert!(child.wait().unwrap().success(), "{shape}, {scale}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_to_a_missing_file_creates_that_file() {
    let folder = Folder::new();
    fs::create_dir(folder.path("out")).unwrap();
    std::os::unix::fs::symlink("out/real.png", folder.path("link.png")).unwrap();
    folder.good("render ball.json -q -o link.png");
    assert!(fs::symlink_metadata(folder.path("link.png")).unwrap().is_symlink());
    assert_eq!(image(&folder, "out/real.png").width(), 16);
}

#[test]
fn file_names_may_have_255_bytes() {
    let folder = Folder::new();
    for ending in [".png", ".exr", ".jfilm"] {
        let name = "x".repeat(255 - ending.len()) + ending;
        folder.good(&format!("render ball.json -q -o {name}"));
        assert_eq!(folder.files(), [name.as_str()]);
        fs::remove_file(folder.path(&name)).unwrap();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn closed_standard_output_is_an_error() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o a.jfilm");
    for line in ["render ball.json -q -o -", "merge a.jfilm -q -o -"] {
        let run = |redirection: &str| {
            let program = folder.command(line);
            let mut shell = Command::new("sh");
            shell.args(["-c", &format!(r#"exec "$0" "$@" {redirection}"#)]);
            shell.arg(program.get_program()).args(program.get_args());
            Run::of(shell.current_dir(folder.path(".")).output().unwrap())
        };
        let closed = run(">&-");
        assert_eq!(closed.status, 2, "{line}: {}", closed.stderr);
        assert!(closed.stderr.contains("standard output, which is closed"), "{line}: {}", closed.stderr);
        let discarded = run("> /dev/null");
        assert_eq!((discarded.status, discarded.stderr.as_str()), (0, ""), "{line}");
    }
}
