//! FLIP against the authors' evaluator: eleven synthetic pairs of images with the results of
//! `flip-evaluator` 1.7 (PyPI). With `JUGGLER_FLIP_PICTURES=folder` the pairs are written there,
//! for `tests/flip/agree.py`.

use super::*;
use crate::{Header, ImageFormat, create, write_image};
use juggler_math::color::srgb_decode;
use juggler_math::testing::Random;
use std::path::Path;

const WIDTH: u32 = 120;
const HEIGHT: u32 = 88;

struct Pair {
    name: &'static str,
    range: DynamicRange,
    /// Mean reported by the authors' evaluator.
    mean: f64,
    picture: Image,
    reference: Image,
}

fn image(pixel: impl FnMut([u32; 2]) -> Rgb) -> Image {
    let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| [x, y]));
    Image::from_pixels(WIDTH, HEIGHT, places.map(pixel).collect()).unwrap()
}

/// Image of 8-bit sRGB levels.
fn levels(mut pixel: impl FnMut([u32; 2]) -> [f32; 3]) -> Image {
    image(|place| Rgb::from(pixel(place).map(|v| srgb_decode(v.round().clamp(0.0, 255.0) / 255.0))))
}

fn share([x, y]: [u32; 2]) -> [f32; 2] {
    [x as f32 / WIDTH as f32, y as f32 / HEIGHT as f32]
}

fn gradient(place: [u32; 2], more: f32) -> [f32; 3] {
    let [u, v] = share(place);
    [255.0 * u + more, 200.0 * v + more, 255.0 - 255.0 * u * v - more]
}

fn checkered([x, y]: [u32; 2], shift: u32) -> [f32; 3] {
    if ((x + shift) / 15 + y / 15).is_multiple_of(2) { [230.0, 220.0, 200.0] } else { [30.0, 40.0, 90.0] }
}

fn bars([x, _]: [u32; 2], turn: usize) -> [f32; 3] {
    let bar = (x * 6 / WIDTH) as usize;
    let color =
        [[220.0, 30.0, 40.0], [230.0, 200.0, 30.0], [40.0, 180.0, 60.0], [30.0, 60.0, 220.0], [250.0; 3], [20.0; 3]]
            [bar];
    std::array::from_fn(|c| color[(c + turn) % 3])
}

fn disc([x, y]: [i32; 2]) -> [f32; 3] {
    let (dx, dy) = (x.rem_euclid(30) - 15, y.rem_euclid(30) - 15);
    if dx * dx + dy * dy < 81 { [240.0, 120.0, 20.0] } else { [60.0, 80.0, 110.0] }
}

fn blurred_disc([x, y]: [u32; 2]) -> [f32; 3] {
    let around = (-2..=2).flat_map(|j| (-2..=2).map(move |i| disc([x as i32 + i, y as i32 + j])));
    let sum = around.fold([0.0; 3], |sum: [f32; 3], v| std::array::from_fn(|c| sum[c] + v[c]));
    sum.map(|v| v / 25.0)
}

fn spots([x, y]: [u32; 2], shift: u32, bright: f32) -> Rgb {
    let ((x, y), v) = ((x + shift, y), share([x, y])[1]);
    let spot = (x % 24 < 4 && y % 22 < 4) as u32 as f32;
    Rgb::new(0.02 + 0.1 * v, 0.05, 0.1 - 0.05 * v) + Rgb::new(1.0, 0.8, 0.5) * (spot * bright)
}

fn pair(name: &'static str, range: DynamicRange, mean: f64, picture: Image, reference: Image) -> Pair {
    Pair { name, range, mean, picture, reference }
}

fn ldr() -> Vec<Pair> {
    let mut random = Random::new(20);
    let of = |name, mean, picture, reference| pair(name, DynamicRange::Ldr, mean, picture, reference);
    let plain = levels(|place| gradient(place, 0.0));
    let noise = levels(|_| [(); 3].map(|()| random.range(90.0, 160.0)));
    let specks = levels(|place| if random.below(150) == 0 { [255.0; 3] } else { gradient(place, 0.0) });
    let steps = levels(|place| gradient(place, 0.0).map(|v| (v / 16.0).floor() * 16.0 + 8.0));
    let shifted = |shift| levels(|place| checkered(place, shift));
    let hues = |turn| levels(|place| bars(place, turn));
    vec![
        of("brighter", 0.232491, levels(|place| gradient(place, 9.0)), plain.clone()),
        of("noise", 0.159494, noise, levels(|_| [125.0; 3])),
        of("shifted", 0.391641, shifted(3), shifted(0)),
        of("hues", 0.673855, hues(1), hues(0)),
        of("blurred", 0.137586, levels(blurred_disc), levels(|[x, y]| disc([x as i32, y as i32]))),
        of("specks", 0.038705, specks, plain.clone()),
        of("steps", 0.084016, steps, plain),
    ]
}

fn hdr() -> Vec<Pair> {
    let mut random = Random::new(21);
    let of = |name, mean, picture, reference| pair(name, DynamicRange::Hdr, mean, picture, reference);
    let smooth = |place: [u32; 2]| {
        let [u, v] = share(place);
        Rgb::new(portable::exp2(13.0 * u - 6.5), 0.3 + v, 0.2 + 2.0 * u * v)
    };
    let grain = image(|place| smooth(place) * random.range(0.5, 1.5));
    let fireflies = image(|place| if random.below(400) == 0 { Rgb::new(70.0, 60.0, 90.0) } else { smooth(place) });
    let window = |dark: f32, bright: f32| image(|[x, y]| Rgb::splat(if x > 80 && y < 40 { bright } else { dark }));
    let highlights = |shift, bright| image(|place| spots(place, shift, bright));
    vec![
        of("grain", 0.150340, grain, image(smooth)),
        of("spots", 0.117938, highlights(2, 90.0), highlights(0, 100.0)),
        of("window", 0.106074, window(0.22, 55.0), window(0.2, 50.0)),
        of("fireflies", 0.027101, fireflies, image(smooth)),
    ]
}

fn measured(pair: &Pair) -> f64 {
    flip(&pair.picture, &pair.reference, pair.range, PIXELS_PER_DEGREE).unwrap().mean
}

#[test]
fn flip_matches_the_reference_implementation() {
    let folder = std::env::var("JUGGLER_FLIP_PICTURES").ok();
    for pair in ldr().into_iter().chain(hdr()) {
        if let Some(folder) = &folder {
            keep(Path::new(folder), &pair);
            continue;
        }
        let found = measured(&pair);
        assert!((found - pair.mean).abs() < 1e-3, "{}: {found}, not {}", pair.name, pair.mean);
    }
}

fn keep(folder: &Path, pair: &Pair) {
    let format = if pair.range == DynamicRange::Ldr { ImageFormat::Png } else { ImageFormat::Exr };
    for (role, image) in [("picture", &pair.picture), ("reference", &pair.reference)] {
        let path = folder.join(format!("{}.{role}.{}", pair.name, format.extension()));
        write_image(create(&path, format, &Header::new(WIDTH, HEIGHT)).unwrap(), image).unwrap();
    }
}

#[test]
fn flip_of_equal_images_is_0_and_of_opposite_colors_the_maximum() {
    for range in [DynamicRange::Ldr, DynamicRange::Hdr] {
        let picture = image(|place| spots(place, 0, 20.0));
        let found = flip(&picture, &picture, range, PIXELS_PER_DEGREE).unwrap();
        assert!(found.mean == 0.0 && found.map.iter().all(|v| *v == 0.0), "{range:?}");
    }
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|color| image(|_| Rgb::from(color)));
    let found = flip(&green, &blue, DynamicRange::Ldr, PIXELS_PER_DEGREE).unwrap();
    assert!(found.map.iter().all(|v| (v - 1.0).abs() < 1e-4), "{}", found.mean);
}

#[test]
fn maps_are_where_the_difference_is() {
    let plain = image(|_| Rgb::splat(0.3));
    let spot = image(|place| if place == [60, 40] { Rgb::splat(0.9) } else { Rgb::splat(0.3) });
    let found = flip(&spot, &plain, DynamicRange::Ldr, PIXELS_PER_DEGREE).unwrap();
    let at = |x: u32, y: u32| found.map[(y * WIDTH + x) as usize];
    assert!(at(60, 40) > 0.2 && at(60, 40) > at(62, 40) && at(62, 40) > at(66, 40) && at(0, 0) < 1e-3);
    // At a larger viewing distance the difference is less visible.
    let far = flip(&spot, &plain, DynamicRange::Ldr, 200.0).unwrap();
    let most = |map: &[f32]| map.iter().copied().fold(0.0, f32::max);
    assert!(most(&far.map) < 0.7 * most(&found.map), "{} {}", most(&far.map), most(&found.map));
}

#[test]
fn nonfinite_pixels_and_odd_sizes_give_valid_maps() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e30];
    let picture = image(|[x, _]| Rgb::splat(odd[x as usize % 5]));
    for range in [DynamicRange::Ldr, DynamicRange::Hdr] {
        let found = flip(&picture, &image(|_| Rgb::splat(0.5)), range, PIXELS_PER_DEGREE).unwrap();
        assert!(found.map.iter().all(|v| (0.0..=1.0).contains(v)), "{range:?}");
        let black = flip(&picture, &image(|_| Rgb::BLACK), range, f32::NAN).unwrap();
        assert!(black.map.iter().all(|v| (0.0..=1.0).contains(v)), "{range:?}");
        let one = Image::filled(1, 1, Rgb::WHITE);
        assert_eq!(flip(&one, &one, range, PIXELS_PER_DEGREE).unwrap().map, [0.0]);
        assert!(flip(&one, &picture, range, PIXELS_PER_DEGREE).is_err());
    }
}
