//! Every built-in scene has a thumbnail that resembles its rendered image.
use juggler::imaging::{Limits, Tone, decode};
use juggler::math::{Image, Rgb};
use juggler::scene::{Scene, built_in_scenes};
use juggler::{Settings, render};
use juggler_session::{screen::DisplayTransform, thumbnail};
use std::io::Cursor;

/// Maximum total size of all thumbnails, in bytes.
const MOST_BYTES: usize = 200 << 10;
/// Number of cells per axis in which images are compared.
const FIELDS: u32 = 8;
/// Maximum mean difference of the cells of a thumbnail and a noisy render, in 8-bit levels. Images
/// of two scenes differ by 82 in the median; twelve of 946 pairs, dark or nearly the same, differ
/// by less.
const MOST_LEVELS: f64 = 16.0;

fn decoded(name: &str) -> Image {
    let file =
        thumbnail(name).unwrap_or_else(|| panic!("`{name}` has no thumbnail; CONTRIBUTING tells how to make it"));
    decode(name, Cursor::new(file), &Limits::default()).unwrap()
}

/// Returns the mean 8-bit levels of each cell.
fn fields(image: &Image, tone: &Tone) -> Vec<f64> {
    let transform = DisplayTransform::new(tone);
    let (width, height) = (image.width(), image.height());
    let mut sums = vec![(0.0, 0.0); (FIELDS * FIELDS * 3) as usize];
    for (place, pixel) in (0..).zip(image.pixels()) {
        let (x, y): (u32, u32) = (place % width, place / width);
        let field = ((y * FIELDS / height) * FIELDS + x * FIELDS / width) * 3;
        for (channel, level) in transform.rgba(*pixel)[..3].iter().enumerate() {
            let (sum, count) = &mut sums[field as usize + channel];
            (*sum, *count) = (*sum + f64::from(*level), *count + 1.0);
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.len() as f64
}

#[test]
fn every_built_in_scene_has_a_small_thumbnail() {
    let bytes: usize = built_in_scenes().iter().filter_map(|scene| thumbnail(scene.name)).map(<[u8]>::len).sum();
    assert!(bytes <= MOST_BYTES, "{bytes}");
    for scene in built_in_scenes() {
        let image = decoded(scene.name);
        assert_eq!(image.width().max(image.height()), 208, "{}", scene.name);
        assert!(image.pixels().iter().any(|pixel| *pixel != Rgb::BLACK), "{}", scene.name);
    }
    assert!(thumbnail("no-such-scene").is_none());
}

#[test]
fn thumbnails_match_their_scenes() {
    let display = Tone::default();
    let thumbnails: Vec<(&str, Vec<f64>)> =
        built_in_scenes().iter().map(|scene| (scene.name, fields(&decoded(scene.name), &display))).collect();
    for (name, fields_of_thumbnail) in &thumbnails {
        let scene = Scene::built_in(name).unwrap();
        let image = decoded(name);
        let size = Some([image.width() / 4, image.height() / 4]);
        let settings = Settings { size, samples: Some(8), ..Settings::default() };
        let rendered = render(&scene, &settings).unwrap();
        let off = difference(fields_of_thumbnail, &fields(&rendered, &scene.description.tone));
        assert!(off < MOST_LEVELS, "the thumbnail of `{name}` is off by {off:.1} levels");
    }
}
