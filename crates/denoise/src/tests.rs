//! Tests of the whole filter on pictures whose ground truth is known.

use crate::{Denoised, Features, Noisy, Settings, SimdLevel, denoise, denoise_at, denoise_unless, strips};
use juggler_math::testing::Random;
use juggler_math::{Rgb, Vec3};

/// A picture of two walls that meet in the middle, with its ground truth.
struct Walls {
    width: usize,
    height: usize,
    truth: Vec<Rgb>,
    halves: [Vec<Rgb>; 2],
    albedo: Vec<Rgb>,
    normal: Vec<Vec3>,
    depth: Vec<f32>,
}

const LEFT: Rgb = Rgb::new(0.8, 0.2, 0.1);
const RIGHT: Rgb = Rgb::new(0.1, 0.3, 0.6);

impl Walls {
    /// Creates walls with an irradiance of 2 on the left and 0.5 on the right, and uniform noise of
    /// ± `noise` times the color in each half.
    fn new(width: usize, height: usize, noise: f32) -> Self {
        let mut random = Random::new(7);
        let left = |i: usize| i % width < width / 2;
        let all = || 0..width * height;
        let truth: Vec<Rgb> = all().map(|i| if left(i) { LEFT * 2.0 } else { RIGHT * 0.5 }).collect();
        let mut half = || truth.iter().map(|c| *c * (1.0 + noise * random.range(-1.0, 1.0))).collect::<Vec<Rgb>>();
        Self {
            halves: [half(), half()],
            albedo: all().map(|i| if left(i) { LEFT } else { RIGHT }).collect(),
            normal: all().map(|i| if left(i) { Vec3::X } else { Vec3::Z }).collect(),
            depth: all().map(|i| 2.0 + (i / width) as f32 * 0.01).collect(),
            width,
            height,
            truth,
        }
    }

    fn features(&self) -> Features<'_> {
        Features {
            albedo: Some([&self.albedo, &self.albedo]),
            normal: Some([&self.normal, &self.normal]),
            depth: Some([&self.depth, &self.depth]),
        }
    }

    fn noisy<'a>(&'a self, features: Features<'a>) -> Noisy<'a> {
        Noisy::new(self.width, self.height, [&self.halves[0], &self.halves[1]], features).unwrap()
    }

    fn denoised(&self) -> Vec<Rgb> {
        denoise(&self.noisy(self.features()), &Settings::default())
    }

    fn input(&self) -> Vec<Rgb> {
        self.halves[0].iter().zip(&self.halves[1]).map(|(a, b)| (*a + *b) * 0.5).collect()
    }

    /// Mean squared relative error.
    fn error(&self, pixels: &[Rgb]) -> f32 {
        let pixel = |(c, t): (&Rgb, &Rgb)| ((c.r - t.r) / t.r) * ((c.r - t.r) / t.r);
        pixels.iter().zip(&self.truth).map(pixel).sum::<f32>() / pixels.len() as f32
    }
}

fn bits(pixels: &[Rgb]) -> Vec<[u32; 3]> {
    pixels.iter().map(|c| c.to_array().map(f32::to_bits)).collect()
}

#[test]
fn a_constant_picture_stays_as_it_is() {
    for color in [Rgb::BLACK, Rgb::new(0.3, 40.0, 1e-3), Rgb::splat(1e14)] {
        let pixels = vec![color; 50 * 31];
        let noisy = Noisy::new(50, 31, [&pixels, &pixels], Features::default()).unwrap();
        for found in denoise(&noisy, &Settings::default()) {
            for (f, c) in found.to_array().into_iter().zip(color.to_array()) {
                assert!((f - c).abs() <= 2e-6 * c.max(color.max_channel() * 0.1), "{f} {c}");
            }
        }
    }
}

#[test]
fn a_picture_without_noise_stays_as_it_is() {
    let mut random = Random::new(3);
    let pixels: Vec<Rgb> = (0..70 * 41).map(|_| random.rgb() * 5.0).collect();
    let walls = Walls { halves: [pixels.clone(), pixels.clone()], ..Walls::new(70, 41, 0.0) };
    for features in [Features::default(), walls.features()] {
        for (found, expected) in denoise(&walls.noisy(features), &Settings::default()).iter().zip(&pixels) {
            assert!((*found - *expected).map(f32::abs).max_channel() < 1e-5 * 5.0, "{found:?} {expected:?}");
        }
    }
}

#[test]
fn noise_of_flat_walls_falls_to_a_fiftieth_and_the_edge_stays() {
    let walls = Walls::new(120, 80, 1.0);
    let (before, after) = (walls.error(&walls.input()), walls.error(&walls.denoised()));
    assert!((before - 1.0 / 6.0).abs() < 0.01, "{before}");
    assert!(after < before / 50.0, "{before} {after}");
    // The columns beside the edge contain no light from the other side.
    for column in [58, 59, 60, 61] {
        let denoised = walls.denoised();
        let pixels = (20..60).map(|y| denoised[y * 120 + column].b);
        let (mean, truth) = (pixels.sum::<f32>() / 40.0, walls.truth[column].b);
        assert!((mean / truth - 1.0).abs() < 0.06, "column {column}: {mean} {truth}");
    }
}

#[test]
fn without_features_noise_falls_too() {
    let walls = Walls::new(96, 64, 0.6);
    // Evaluate only pixels away from the edge, which only the color shows here.
    let flat = |pixels: &[Rgb]| {
        let ratio = |i: usize| pixels[i].r / walls.truth[i].r - 1.0;
        let inner: Vec<f32> = (0..pixels.len()).filter(|i| (i % 96).abs_diff(48) > 4).map(ratio).collect();
        inner.iter().map(|r| r * r).sum::<f32>() / inner.len() as f32
    };
    let (before, bare) = (flat(&walls.input()), denoise(&walls.noisy(Features::default()), &Settings::default()));
    assert!(flat(&bare) < before / 30.0, "{before} {}", flat(&bare));
    let features = Features { albedo: walls.features().albedo, ..Features::default() };
    let colors = denoise(&walls.noisy(features), &Settings::default());
    assert!(flat(&colors) < before / 30.0, "{before} {}", flat(&colors));
    for column in [46, 47, 48, 49] {
        let mean = (0..64).map(|y| bare[y * 96 + column].r).sum::<f32>() / 64.0;
        // On the grid of windows, few patches have the same position relative to a sharp edge as
        // that of the pixel.
        let bound = if column == 46 || column == 49 { 0.05 } else { 0.4 };
        assert!((mean - walls.truth[column].r).abs() < bound, "column {column}: {mean}");
    }
}

/// Sums of red, green and blue.
fn energy(pixels: &[Rgb]) -> [f64; 3] {
    let sum = |channel: fn(&Rgb) -> f32| pixels.iter().map(|c| f64::from(channel(c))).sum();
    [sum(|c| c.r), sum(|c| c.g), sum(|c| c.b)]
}

/// Creates walls with the skewed noise of few samples: most pixels are too dark, some far too
/// bright, and one pixel in 200 is a firefly in one half.
fn sparkling_walls() -> Walls {
    let mut walls = Walls::new(200, 120, 0.0);
    let mut random = Random::new(11);
    for pixel in walls.halves.iter_mut().flatten() {
        let spread = random.range(0.0, 1.0);
        let firefly = if random.range(0.0, 1.0) < 0.005 { random.range(10.0, 60.0) } else { 0.0 };
        *pixel = *pixel * (3.0 * spread * spread + firefly);
    }
    walls
}

#[test]
fn energy_is_conserved() {
    for walls in [Walls::new(120, 80, 1.0), sparkling_walls()] {
        for (found, expected) in energy(&walls.denoised()).into_iter().zip(energy(&walls.input())) {
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
        }
    }
}

#[test]
fn blocks_lose_no_energy() {
    let walls = sparkling_walls();
    let (denoised, input) = (walls.denoised(), walls.input());
    for column in [0, 50, 100, 150] {
        let block = |pixels: &[Rgb]| -> f32 {
            (0..120).flat_map(|y| &pixels[y * 200 + column..][..50]).map(|c| c.r + c.g + c.b).sum()
        };
        let ratio = block(&denoised) / block(&input);
        assert!((ratio - 1.0).abs() < 0.05, "column {column}: {ratio}");
    }
}

#[test]
fn no_pixel_stands_out_from_a_plain_wall() {
    let mut walls = sparkling_walls();
    // Put fireflies into both halves.
    for (half, brightness) in [90.0, 60.0].into_iter().enumerate() {
        walls.halves[half][60 * 200 + 30] = Rgb::splat(brightness);
    }
    let pixels = walls.denoised();
    let brightness = |x: usize, y: usize| pixels[y * 200 + x].r + pixels[y * 200 + x].g + pixels[y * 200 + x].b;
    for (y, x) in (3..117).flat_map(|y| (3..197).map(move |x| (y, x))) {
        let around = (y - 3..y + 4).flat_map(|v| (x - 3..x + 4).map(move |u| (u, v))).filter(|at| *at != (x, y));
        let most = around.map(|(u, v)| brightness(u, v)).fold(0.0, f32::max);
        assert!(brightness(x, y) < 1.5 * most, "{x} {y}: {} {most}", brightness(x, y));
    }
}

#[test]
fn pictures_of_any_size_pass() {
    for (width, height) in [(1, 1), (1, 9), (23, 1), (2, 2), (8, 3), (97, 26)] {
        let walls = Walls::new(width, height, 0.5);
        for features in [walls.features(), Features::default()] {
            let pixels = denoise(&walls.noisy(features), &Settings::default());
            assert_eq!(pixels.len(), width * height);
            assert!(pixels.iter().all(|c| c.is_finite() && c.max_channel() < 3.0), "{width} {height}");
        }
    }
}

#[test]
fn pixels_that_are_not_finite_are_filled_in_and_do_not_spread() {
    let mut walls = Walls::new(90, 60, 0.5);
    let strange = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX];
    for (k, number) in strange.into_iter().enumerate() {
        let at = 30 * 90 + 10 + 3 * k;
        walls.halves[0][at] = Rgb::new(0.5, number, 0.5);
        walls.halves[1][at + 300] = Rgb::splat(number);
        (walls.halves[0][at + 900], walls.halves[1][at + 900]) = (Rgb::splat(number), Rgb::splat(number));
        walls.depth[at + 1] = number;
        walls.normal[at + 2] = Vec3::splat(number);
        walls.albedo[at + 3] = Rgb::splat(number);
    }
    let pixels = walls.denoised();
    assert!(pixels.iter().all(|c| c.is_finite()));
    assert!(walls.error(&pixels) < 0.01, "{}", walls.error(&pixels));
    let lost = 40 * 90 + 10;
    assert!((pixels[lost].r / walls.truth[lost].r - 1.0).abs() < 0.3, "{:?}", pixels[lost]);
    let nothing = vec![Rgb::splat(f32::NAN); 12];
    let noisy = Noisy::new(4, 3, [&nothing, &nothing], Features::default()).unwrap();
    assert_eq!(denoise(&noisy, &Settings::default()), vec![Rgb::BLACK; 12]);
}

#[test]
fn the_same_bits_on_any_threads_and_vector_units() {
    let walls = Walls::new(200, 70, 0.8);
    let expected = bits(&walls.denoised());
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert!(bits(&pool.install(|| walls.denoised())) == expected, "{threads} threads");
    }
    let best = SimdLevel::new();
    #[cfg(target_arch = "x86_64")]
    let levels = [best.as_sse2().map(SimdLevel::Sse2), best.as_avx2().map(SimdLevel::Avx2), Some(best)];
    #[cfg(not(target_arch = "x86_64"))]
    let levels = [Some(SimdLevel::baseline()), Some(best)];
    for level in levels.into_iter().flatten() {
        let found = denoise_at(level, &walls.noisy(walls.features()), &Settings::default(), &|| false).unwrap();
        assert!(bits(&found.pixels) == expected, "{level:?}");
    }
}

#[test]
fn denoising_in_strips_equals_denoising_the_whole() {
    let walls = Walls::new(50, 130, 0.8);
    let (noisy, settings) = (walls.noisy(walls.features()), Settings::default());
    let run = |rows: usize| strips::denoise(SimdLevel::new(), &noisy, &settings, &|| false, rows).unwrap();
    let (whole, strips) = (run(200), run(20));
    assert_eq!(strips.pixels.len(), whole.pixels.len());
    assert!((strips.moved_energy - whole.moved_energy).abs() < 1e-9);
    for (i, (a, b)) in strips.pixels.iter().zip(&whole.pixels).enumerate() {
        assert!((*a - *b).map(f32::abs).max_channel() < 1e-4, "row {}: {a:?} {b:?}", i / 50);
    }
}

#[test]
fn an_outlier_of_one_half_leaves_no_blotch_and_a_highlight_of_both_stays() {
    let mut walls = Walls::new(96, 64, 0.2);
    let (outlier, highlight) = (20 * 96 + 20, 40 * 96 + 70);
    walls.halves[0][outlier] = Rgb::splat(100.0);
    for at in [highlight, highlight + 1] {
        walls.halves[0][at] = Rgb::splat(304.0);
        walls.halves[1][at] = Rgb::splat(306.0);
    }
    let noisy = walls.noisy(walls.features());
    let run = |cut_outliers| {
        let settings = Settings { cut_outliers, ..Settings::default() };
        denoise_unless(&noisy, &settings, &|| false).unwrap()
    };
    let Denoised { pixels, moved_energy } = run(true);
    for (x, y) in [(20, 20), (19, 21), (24, 20), (28, 28)] {
        let found = pixels[y * 96 + x].r / walls.truth[y * 96 + x].r;
        assert!((found - 1.0).abs() < 0.2, "{x} {y}: {found}");
    }
    for at in [highlight, highlight + 1] {
        assert!((pixels[at].g / 305.0 - 1.0).abs() < 0.06, "{:?}", pixels[at]);
    }
    let all = walls.halves.iter().flatten().map(|c| f64::from(c.r + c.g + c.b)).sum::<f64>();
    assert!((moved_energy / (300.0 / all) - 1.0).abs() < 0.03, "{moved_energy}");
    assert_eq!(run(false).moved_energy, 0.0);
}

#[test]
fn a_single_bright_pixel_of_both_halves_stands_out_less_than_three_times() {
    let mut walls = Walls::new(96, 64, 0.2);
    let firefly = 40 * 96 + 70;
    for half in &mut walls.halves {
        half[firefly] = Rgb::splat(6.0);
    }
    let ratio = |pixels: &[Rgb]| {
        let brightness = |i: usize| pixels[i].r + pixels[i].g + pixels[i].b;
        let around = crate::window::neighbors(96, pixels.len(), firefly, 3).map(brightness);
        brightness(firefly) / around.fold(0.0, f32::max)
    };
    let run = |cut_outliers| {
        let settings = Settings { cut_outliers, ..Settings::default() };
        denoise(&walls.noisy(walls.features()), &settings)
    };
    let pixels = run(true);
    assert!(ratio(&pixels) <= 3.0, "{}", ratio(&pixels));
    assert!(ratio(&run(false)) > 4.0, "{}", ratio(&run(false)));
    let [found, expected] = [&pixels, &walls.input()].map(|all| all.iter().map(|c| f64::from(c.g)).sum::<f64>());
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
}

#[test]
fn wrong_sizes_are_rejected_and_cancellation_works() {
    let walls = Walls::new(30, 20, 0.5);
    let halves = [&walls.halves[0][..], &walls.halves[1][..]];
    let error = Noisy::new(30, 21, halves, Features::default()).unwrap_err();
    assert_eq!(error.to_string(), "half of the picture has 600 pixels instead of 30 × 21");
    assert!(Noisy::new(0, 0, [&[], &[]], Features::default()).is_err());
    assert!(Noisy::new(usize::MAX, 2, halves, Features::default()).is_err());
    let short = Features { depth: Some([&walls.depth, &walls.depth[1..]]), ..Features::default() };
    assert!(Noisy::new(30, 20, halves, short).unwrap_err().to_string().starts_with("depth has 599"));
    assert_eq!(denoise_unless(&walls.noisy(walls.features()), &Settings::default(), &|| true), None);
}
