//! `juggler compare`.

use crate::harness::Folder;
use juggler::imaging::{self, Header, ImageFormat};
use juggler::math::{Image, Rgb};

#[test]
fn comparisons_answer_with_their_status() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o a.pfm");
    folder.good("render ball.json -q -o b.pfm --seed 1");
    folder.good("render ball.json -q -o small.pfm --size 4x4");
    assert!(folder.good("compare a.pfm a.pfm").stdout.starts_with("identical, bit for bit"));
    let different = folder.run("compare a.pfm b.pfm");
    assert!(different.status == 1 && different.stdout.starts_with("different") && different.stderr.is_empty());
    assert!(folder.good("compare a.pfm b.pfm --tolerance 10").stdout.starts_with("equal within"));
    assert_eq!(folder.run("compare a.pfm b.pfm --tolerance 1e-9").status, 1);
    assert!(folder.bad("compare a.pfm small.pfm", 1).contains("16×9"));
    let stats: serde_json::Value = serde_json::from_str(&folder.run("compare a.pfm b.pfm --stats -").stdout).unwrap();
    assert!(stats["equal"] == false && stats["rmse"].as_f64().unwrap() > 0.0, "{stats}");
    let keys: Vec<&String> = stats.as_object().unwrap().keys().collect();
    assert_eq!(keys, ["version", "equal", "same_bits", "rmse", "relative_mse", "max", "max_at", "flip", "limits"]);
}

/// Pictures that differ in alpha alone are different, over white if not over black.
#[test]
fn alpha_is_compared() {
    let folder = Folder::new();
    let write = |name: &str, alpha: f32| {
        let (colors, alpha) = (vec![Rgb::BLACK; 64], vec![alpha; 64]);
        let header = Header { transparent: true, ..Header::new(8, 8) };
        let mut file = imaging::create(&folder.path(name), ImageFormat::Exr, &header).unwrap();
        file.write_rows(juggler::math::PixelRows { colors: &colors, alpha: Some(&alpha) }).unwrap();
        file.finish().unwrap();
    };
    write("a.exr", 0.25);
    write("b.exr", 0.75);
    write("c.exr", 1.0);
    imaging::write_image(
        imaging::create(&folder.path("black.exr"), ImageFormat::Exr, &Header::new(8, 8)).unwrap(),
        &Image::filled(8, 8, Rgb::BLACK),
    )
    .unwrap();
    assert!(folder.good("compare a.exr a.exr").stdout.starts_with("identical"));
    let stats: serde_json::Value = serde_json::from_str(&folder.run("compare a.exr b.exr --stats -").stdout).unwrap();
    assert!(stats["equal"] == false && (stats["rmse"].as_f64().unwrap() - 0.5).abs() < 1e-6, "{stats}");
    assert!(stats["flip"]["mean"].as_f64().unwrap() > 0.1, "{stats}");
    assert_eq!(folder.run("compare a.exr b.exr --tolerance 0.4").status, 1);
    folder.good("compare a.exr b.exr --tolerance 0.51");
    // A picture without alpha is opaque.
    folder.good("compare c.exr black.exr --tolerance 0");
    assert_eq!(folder.run("compare a.exr black.exr --tolerance 0.1").status, 1);
}

#[test]
fn compare_reports_the_perceived_difference_and_its_location() {
    let folder = Folder::new();
    for (name, flags) in [("a.pfm", ""), ("b.exr", "--seed 1"), ("a.png", ""), ("b.png", "--exposure 1")] {
        folder.good(&format!("render ball.json -q -o {name} {flags}"));
    }
    let stats = |line: &str| -> serde_json::Value { serde_json::from_str(&folder.run(line).stdout).unwrap() };
    // Tone-mapped files are compared as LDR; if one file contains linear radiance, as HDR.
    for (pair, range) in [("a.png b.png", "ldr"), ("a.pfm b.exr", "hdr"), ("a.png a.pfm", "hdr")] {
        let flip = &stats(&format!("compare {pair} --stats -"))["flip"];
        assert!(flip["range"] == range && (1e-4..1.0).contains(&flip["mean"].as_f64().unwrap()), "{pair}: {flip}");
    }
    let same = serde_json::json!({"mean": 0.0, "range": "hdr", "max": 0.0, "max_at": null});
    assert_eq!(stats("compare a.pfm a.pfm --stats -")["flip"], same);
    let words = folder.run("compare a.png b.png --difference map.png").stdout;
    assert!(words.lines().any(|line| line.starts_with("FLIP") && line.ends_with("(LDR)")), "{words}");
    let map = imaging::read(&folder.path("map.png")).unwrap();
    assert_eq!((map.width(), map.height()), (16, 9));
    assert!(map.pixels().iter().any(|pixel| pixel.luminance() > 0.1));
    // The map of equal pictures is black in every format, and the exit status is that of the
    // comparison.
    for name in ["none.exr", "none.jpg"] {
        folder.good(&format!("compare a.png a.png --difference {name}"));
        let map = imaging::read(&folder.path(name)).unwrap();
        assert!(map.pixels().iter().all(|pixel| pixel.luminance() < 0.01), "{name}");
    }
    assert_eq!(folder.run("compare a.pfm b.exr --tolerance 10 --difference map.webp").status, 0);
    folder.bad("compare a.pfm b.exr --difference map.tga", 2);
    folder.bad("compare a.pfm none.pfm --difference other.png", 3);
    assert!(!folder.files().contains(&"other.png".to_owned()));
}

/// Gray pictures `gray.pfm` and `spot.pfm` of 8 by 4 pixels; the second is lighter by 0.4 in column 6
/// of row 1.
fn spot() -> Folder {
    let folder = Folder::new();
    let mut pixels = vec![Rgb::new(0.25, 0.25, 0.25); 32];
    for name in ["gray.pfm", "spot.pfm"] {
        let picture = Image::from_pixels(8, 4, pixels.clone()).unwrap();
        let file = imaging::create(&folder.path(name), ImageFormat::Pfm, &Header::new(8, 4)).unwrap();
        imaging::write_image(file, &picture).unwrap();
        pixels[8 + 6] = Rgb::new(0.25, 0.65, 0.25);
    }
    folder
}

#[test]
fn limits_of_both_errors_are_printed_with_where_pictures_differ_most() {
    let folder = spot();
    let stats = |flags: &str| -> serde_json::Value {
        serde_json::from_str(&folder.run(&format!("compare spot.pfm gray.pfm {flags} --stats -")).stdout).unwrap()
    };
    let found = stats("");
    let rmse = 0.4 / f64::from(96.0_f32).sqrt();
    assert!((found["rmse"].as_f64().unwrap() - rmse).abs() < 1e-7, "{found}");
    assert_eq!((&found["max_at"], &found["flip"]["max_at"]), (&serde_json::json!([6, 1]), &serde_json::json!([6, 1])));
    assert_eq!(found["limits"], serde_json::json!({"rmse": null, "flip": null}));
    let flip = found["flip"]["mean"].as_f64().unwrap();
    let (below, above) = (flip * 0.99, flip * 1.01);
    for (flags, status, says) in [
        (format!("--flip {above}"), 0, "equal within the limits\n".to_owned()),
        (format!("--flip {flip}"), 0, format!("(HDR), limit {flip}\n")),
        (format!("--flip {below}"), 1, format!("is more than --flip {below}\n")),
        (format!("--flip {above} --tolerance 0.05"), 0, ", limit 0.05\n".to_owned()),
        (
            format!("--flip {above} --tolerance 0.04"),
            1,
            "different: RMSE 4.082e-2 is more than --tolerance 0.04\n".to_owned(),
        ),
        (format!("--flip {below} --tolerance 0.05"), 1, "different: FLIP ".to_owned()),
        (
            format!("--flip {below} --tolerance 0.04"),
            1,
            format!("--tolerance 0.04, FLIP {flip:.3e} is more than --flip"),
        ),
        ("--flip 0".to_owned(), 1, "\n        most at 6,1: ".to_owned()),
        ("--flip 1".to_owned(), 0, "\nmax     4.000000e-1 at 6,1\n".to_owned()),
    ] {
        let run = folder.run(&format!("compare spot.pfm gray.pfm {flags}"));
        assert_eq!((run.status, run.stderr.as_str()), (status, ""), "{flags}: {}", run.stdout);
        assert!(run.stdout.contains(&says), "{flags}: {says}: {}", run.stdout);
        assert_eq!(stats(&flags)["equal"], status == 0, "{flags}");
    }
}

#[test]
fn limits_are_checked_and_reported() {
    let folder = spot();
    let stats = |flags: &str| -> serde_json::Value {
        serde_json::from_str(&folder.run(&format!("compare spot.pfm gray.pfm {flags} --stats -")).stdout).unwrap()
    };
    assert_eq!(stats("--flip 0.5 --tolerance 2")["limits"], serde_json::json!({"rmse": 2.0, "flip": 0.5}));
    assert_eq!(folder.run("compare gray.pfm gray.pfm --flip 0").status, 0);
    assert!(!folder.run("compare gray.pfm gray.pfm").stdout.contains(" at "));
    for wrong in ["-1", "1.5", "nan", "2%"] {
        let message = folder.bad(&format!("compare spot.pfm gray.pfm --flip={wrong}"), 2);
        assert!(message.contains("between 0 and 1"), "{message}");
    }
    let message = folder.bad("compare spot.pfm gray.pfm --flip 0.1 --max-memory 1M", 2);
    assert!(message.contains("of memory, more than --max-memory"), "{message}");
}
