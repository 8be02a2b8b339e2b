use super::*;
use juggler_math::testing::Random;

const BLOCKS: u32 = 4;

/// Distribution of a sample, given its mean.
type Law = fn(&mut Random, f32) -> f32;

fn even(random: &mut Random, mean: f32) -> f32 {
    2.0 * mean * random.f32()
}

/// One sample of 40 carries all the energy, like a firefly.
fn rare(random: &mut Random, mean: f32) -> f32 {
    if random.f32() < 0.025 { 40.0 * mean } else { 0.0 }
}

/// Image with 64 samples per pixel in blocks of 16, like a film's.
fn estimate(random: &mut Random, size: [u32; 2], law: Law, mean: impl Fn(u32, u32) -> f32) -> NoisyImage {
    let mut made = NoisyImage { width: size[0], height: size[1], mean: vec![], variance: vec![], blocks: vec![] };
    for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
        let mut block = || (0..16).map(|_| law(random, mean(x, y))).sum::<f32>() / 16.0;
        let means: Vec<f32> = (0..BLOCKS).map(|_| block()).collect();
        let average = means.iter().sum::<f32>() / BLOCKS as f32;
        let spread = means.iter().map(|mean| (mean - average) * (mean - average)).sum::<f32>();
        let variance = spread / (BLOCKS * (BLOCKS - 1)) as f32;
        made.mean.push(Rgb::new(1.0, 0.5, 0.25) * average);
        made.variance.push(Rgb::new(1.0, 0.25, 0.0625) * variance);
        made.blocks.push(BLOCKS);
    }
    made
}

fn scene(x: u32, y: u32) -> f32 {
    if y < 20 { 0.0 } else { 0.2 + ((x / 7 + y / 5) % 4) as f32 }
}

fn p(a: &NoisyImage, b: &NoisyImage) -> f64 {
    significance(a, b).unwrap().p
}

/// P-values of pairs of images with equal means.
fn chances(law: Law, count: usize, size: [u32; 2]) -> Vec<f64> {
    let mut random = Random::new(41);
    let mut pair = || (estimate(&mut random, size, law, scene), estimate(&mut random, size, law, scene));
    (0..count).map(|_| pair()).map(|(a, b)| p(&a, &b)).collect()
}

#[test]
fn p_values_of_equal_images_are_calibrated() {
    let even = chances(even, 150, [64, 48]);
    // The test is slightly conservative, since blocks of different sizes are correlated.
    let mean = even.iter().sum::<f64>() / even.len() as f64;
    assert!((0.45..0.7).contains(&mean), "{mean}");
    let below = |chances: &[f64], level: f64| chances.iter().filter(|p| **p <= level).count();
    assert!(below(&even, 0.01) <= 6 && below(&even, 0.25) >= 15, "{even:?}");
    let rare = chances(rare, 150, [64, 48]);
    assert!(below(&rare, 0.01) <= 6 && below(&rare, 0.5) >= 15, "{rare:?}");
    let small = chances(self::rare, 300, [9, 30]);
    assert!(below(&small, 0.01) <= 9, "{small:?}");
}

#[test]
fn different_images_are_detected() {
    let mut random = Random::new(42);
    let size = [96, 64];
    for law in [even as Law, rare] {
        let mut make = |mean: &dyn Fn(u32, u32) -> f32| estimate(&mut random, size, law, mean);
        let whole = make(&|x, y| scene(x, y) * 1.2);
        let inside = |x: u32, y: u32| (50..60).contains(&x) && (40..50).contains(&y);
        let part = make(&|x, y| scene(x, y) * if inside(x, y) { 6.0 } else { 1.0 });
        let dark = make(&|x, y| scene(x, y) + if (5..15).contains(&x) && y < 10 { 0.2 } else { 0.0 });
        let plain = make(&scene);
        for other in [&whole, &part, &dark] {
            let found = significance(&plain, other).unwrap();
            assert!(found.p < 0.01, "{found:?}");
            assert!(found.worst.unwrap().deviation < -2.5);
        }
        let [x, y, width, height] = significance(&plain, &part).unwrap().worst.unwrap().area;
        assert!(x <= 55 && x + width > 55 && y <= 45 && y + height > 45, "{x} {y} {width} {height}");
    }
}

#[test]
fn single_pixel_never_decides_significance() {
    let mut random = Random::new(43);
    let a = estimate(&mut random, [64, 48], even, scene);
    let mut b = estimate(&mut random, [64, 48], even, scene);
    let before = p(&a, &b);
    for place in [3, 1000, 2999] {
        b.mean[place] = Rgb::splat(1e6);
        b.variance[place] = Rgb::BLACK;
    }
    assert!(before > 0.01 && p(&a, &b) > 0.01);
}

#[test]
fn noise_free_images_are_either_equal_or_different() {
    let flat = |value: f32| NoisyImage {
        width: 40,
        height: 20,
        mean: vec![Rgb::splat(value); 800],
        variance: vec![Rgb::BLACK; 800],
        blocks: vec![2; 800],
    };
    assert_eq!(p(&flat(1.0), &flat(1.0)), 1.0);
    assert!(p(&flat(1.0), &flat(1.0f32.next_up())) > 0.1, "rounding");
    assert!(p(&flat(1.0), &flat(1.01)) < 1e-6);
    assert_eq!(
        significance(&flat(1.0), &NoisyImage { width: 20, height: 40, ..flat(1.0) }),
        Err(SignificanceError::Sizes)
    );
    let few = NoisyImage { blocks: vec![1; 800], ..flat(1.0) };
    assert_eq!(significance(&flat(1.0), &few), Err(SignificanceError::TooFew));
    let odd = NoisyImage { mean: vec![Rgb::splat(f32::NAN); 800], ..flat(1.0) };
    assert_eq!(significance(&odd, &flat(1.0)), Err(SignificanceError::NotFinite));
    let none = NoisyImage { width: 0, height: 0, mean: vec![], variance: vec![], blocks: vec![] };
    assert_eq!(p(&none, &none), 1.0);
}

#[test]
fn degrees_of_freedom_follow_the_number_of_blocks() {
    for (blocks, expected) in [(0, 0.0), (1, 0.0), (2, 1.0), (4, 2.0), (8, 2.6849), (1 << 20, 3.5)] {
        assert!((degrees_of_freedom(blocks) - expected).abs() < 1e-4, "{blocks}: {}", degrees_of_freedom(blocks));
    }
}
