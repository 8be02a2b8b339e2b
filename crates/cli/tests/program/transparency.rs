//! Transparent pictures and movies from the command line.

use crate::harness::Folder;
use juggler::imaging::{self, AlphaImage};
use std::fs;

/// A red sphere without a floor.
fn folder() -> Folder {
    let folder = Folder::new();
    let text = fs::read_to_string(folder.path("ball.json")).unwrap();
    fs::write(folder.path("alone.json"), text.replace(r#"{"shape": "plane"},"#, "")).unwrap();
    folder
}

fn image(folder: &Folder, name: &str) -> AlphaImage {
    imaging::read_with_alpha(&folder.path(name)).unwrap()
}

fn hash(folder: &Folder, stats: &str) -> String {
    let json: serde_json::Value = serde_json::from_slice(&fs::read(folder.path(stats)).unwrap()).unwrap();
    json["film"]["hash"].as_str().unwrap().to_owned()
}

#[test]
fn files_with_alpha_hold_the_sphere_alone() {
    let folder = folder();
    for name in ["a.png", "a.webp", "a.exr"] {
        folder.good(&format!("render alone.json -q --transparent -o {name}"));
        let AlphaImage { alpha, colors } = image(&folder, name);
        let alpha = alpha.unwrap();
        assert_eq!((alpha[0], alpha[4 * 16 + 8]), (0.0, 1.0), "{name}");
        assert!(colors.pixels()[4 * 16 + 8].r > 0.01, "{name}");
    }
    folder.good("render alone.json -q -o opaque.png");
    assert_eq!(image(&folder, "opaque.png").alpha, None);
    // The scene may ask for it, too.
    let text = fs::read_to_string(folder.path("alone.json")).unwrap();
    let text = text.replace(r#""samples": 2"#, r#""samples": 2, "transparent": true"#);
    fs::write(folder.path("own.json"), text).unwrap();
    folder.good("render own.json -q -o b.png");
    assert_eq!(image(&folder, "b.png"), image(&folder, "a.png"));
}

#[test]
fn formats_without_alpha_are_refused_before_rendering() {
    let folder = folder();
    for name in ["a.jpg", "a.hdr", "a.pfm"] {
        let run = folder.run(&format!("render alone.json --transparent -o {name}"));
        assert!(run.status == 2 && run.stderr.contains("cannot be transparent"), "{}", run.stderr);
    }
    let run = folder.run("render alone.json --transparent --look ham -o a.png");
    assert!(run.status == 2 && run.stderr.contains("cannot be transparent"), "{}", run.stderr);
    let run = folder.run("render alone.json --transparent -o a.mp4");
    assert_eq!(run.status, 2, "{}", run.stderr);
    let text = fs::read_to_string(folder.path("alone.json")).unwrap();
    let text = text.replace(r#""samples": 2"#, r#""samples": 2, "transparent": true"#);
    fs::write(folder.path("own.json"), text).unwrap();
    let run = folder.run("render own.json -o a.jpg");
    assert!(run.status == 2 && run.stderr.contains("a JPEG file cannot be transparent"), "{}", run.stderr);
}

#[test]
fn shards_checkpoints_and_the_denoiser_keep_alpha() {
    let folder = folder();
    folder.good("render alone.json -q --transparent --samples 32 -o whole.png --stats whole.txt");
    for index in 0..2 {
        folder.good(&format!("render alone.json -q --transparent --samples 32 --shard {index}/2 -o {index}.jfilm"));
    }
    folder.good("merge 0.jfilm 1.jfilm -q -o merged.png --stats merged.txt");
    assert_eq!(hash(&folder, "merged.txt"), hash(&folder, "whole.txt"));
    assert_eq!(image(&folder, "merged.png"), image(&folder, "whole.png"));
    let run = folder.run("merge 0.jfilm 1.jfilm -o merged.jpg");
    assert!(run.status != 0 && run.stderr.contains("cannot be transparent"), "{}", run.stderr);
    // A checkpoint of 16 samples continues to 32.
    folder.good("render alone.json -q --transparent --samples 16 --checkpoint c.jfilm -o half.png");
    folder.good("render alone.json -q --transparent --samples 32 --checkpoint c.jfilm -o again.png --stats again.txt");
    assert_eq!(hash(&folder, "again.txt"), hash(&folder, "whole.txt"));
    let run = folder.run("render alone.json --samples 32 --checkpoint c.jfilm -o opaque.png");
    assert!(run.status != 0 && run.stderr.contains("transparent"), "{}", run.stderr);
    folder.good("render alone.json -q --transparent --samples 32 --denoise -o clean.exr --aov alpha");
    let clean = image(&folder, "clean.exr");
    assert_eq!(clean.alpha, image(&folder, "clean.exr").alpha);
    assert_eq!(clean.alpha.unwrap()[0], 0.0);
}

#[test]
fn movies_have_alpha() {
    let folder = folder();
    for name in ["a.webp", "a.apng", "a.gif"] {
        folder.good(&format!("render alone.json -q --transparent --frames 0..2 -o {name}"));
    }
    let webp = fs::read(folder.path("a.webp")).unwrap();
    assert_eq!(webp[20] & 0b1_0010, 0b1_0010, "an animation with alpha");
    let alpha = image(&folder, "a.apng").alpha.unwrap();
    assert_eq!((alpha[0], alpha[4 * 16 + 8]), (0.0, 1.0));
}

#[test]
fn the_picture_names_the_command_that_made_it() {
    let folder = folder();
    folder.good("render alone.json -q --transparent -o a.png");
    let info = folder.good("info a.png").stdout;
    assert!(info.contains("juggler render alone.json --transparent"), "{info}");
    for (words, help) in [
        (r#""background": "transparent""#, "\"transparent\": true"),
        (r#""background": [0, 0, 0], "render": {"film_transparent": true}"#, "\"transparent\": true"),
    ] {
        fs::write(folder.path("other.json"), format!(r#"{{"version": 1, "objects": [], {words}}}"#)).unwrap();
        let run = folder.run("check other.json");
        assert!(run.status == 1 && (run.stdout + &run.stderr).contains(help), "{words}");
    }
}
