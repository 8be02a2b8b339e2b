//! Properties of every sampler, and a comparison of their errors.

use super::*;

/// Patterns of all samplers for a number of samples.
fn patterns(samples: u32) -> Vec<AnyPointSet> {
    let [sobol, stratified] = [Sobol {}.point_set(samples), Stratified { side: 0 }.point_set(samples)];
    let [independent, blue_noise] = [Independent {}.point_set(samples), BlueNoise {}.point_set(samples)];
    vec![sobol, stratified, independent, blue_noise]
}

fn points(pattern: AnyPointSet, count: u32) -> Vec<Vec2> {
    let pixel = Sampler::new(pattern, 7).pixel(UVec2::new(3, 5));
    (0..count)
        .map(|i| {
            let mut sampler = pixel.sample(i);
            sampler.skip(3);
            sampler.next_2d()
        })
        .collect()
}

fn cells(points: &[Vec2], x: u32, y: u32) -> Vec<u32> {
    let mut counts = vec![0; (x * y) as usize];
    for p in points {
        counts[((p.x * x as f32) as u32 * y + (p.y * y as f32) as u32) as usize] += 1;
    }
    counts
}

#[test]
fn one_dimensional_samples_are_first_coordinates() {
    for pattern in patterns(16) {
        let pixel = Sampler::new(pattern, 7).pixel(UVec2::new(3, 5));
        for (index, dimension) in (0..100).flat_map(|index| (0..4).map(move |dimension| (index, dimension))) {
            let (mut one, mut two) = (pixel.sample(index).skipped(dimension), pixel.sample(index).skipped(dimension));
            assert_eq!(one.next_1d().to_bits(), two.next_2d().x.to_bits(), "{pattern:?}, sample {index}");
            assert_eq!(one, two, "{pattern:?}: both leave the same dimension behind");
        }
    }
}

#[test]
fn sobol_fills_every_elementary_interval_once() {
    let points = points(AnyPointSet::SobolPoints(SobolPoints), 256);
    for bits in 0..=8 {
        let counts = cells(&points, 1 << bits, 1 << (8 - bits));
        assert!(counts.iter().all(|c| *c == 1), "2^{bits} columns");
    }
}

#[test]
fn stratified_fills_every_cell_once_a_set() {
    for side in [1, 3, 8] {
        let pixel = Sampler::new(Stratified { side }.point_set(1), 1).pixel(UVec2::new(9, 9));
        for dimension in 0..3 {
            let draw = |i: u32| {
                let mut sampler = pixel.sample(i);
                sampler.skip(dimension);
                sampler.next_2d()
            };
            let set: Vec<Vec2> = (side * side..2 * side * side).map(draw).collect();
            assert!(cells(&set, side, side).iter().all(|c| *c == 1), "side {side}, dimension {dimension}");
        }
    }
}

#[test]
fn batch_of_points_equals_single_points() {
    for pattern in patterns(25) {
        let pixel = Sampler::new(pattern, 5).pixel(UVec2::new(8, 1));
        for first in [0, 3, 24, 70] {
            let mut points = [Vec2::ZERO; 60];
            pixel.first_points(first, &mut points);
            let expected: Vec<Vec2> = (first..first + 60).map(|i| pixel.sample(i).next_2d()).collect();
            assert_eq!(points.to_vec(), expected, "{pattern:?} from {first}");
        }
    }
}

#[test]
fn sample_streams_are_uniform_and_uncorrelated() {
    for pattern in patterns(64) {
        let all: Vec<Vec2> = (0..64)
            .flat_map(|x| {
                let pixel = Sampler::new(pattern, 3).pixel(UVec2::new(x, 1));
                (0..64).map(move |i| pixel.sample(i).branch(2).next_2d())
            })
            .collect();
        assert!(all.iter().all(|p| p.cmpge(Vec2::ZERO).all() && p.cmplt(Vec2::ONE).all()));
        let counts = cells(&all, 8, 8);
        let chi: f32 = counts.iter().map(|c| (*c as f32 - 64.0).powi(2) / 64.0).sum();
        assert!(chi < 110.0, "{pattern:?}: chi squared {chi} for 63 degrees of freedom");
        let mean: Vec2 = all.iter().sum::<Vec2>() / all.len() as f32;
        let covariance: f32 = all.iter().map(|p| (p.x - mean.x) * (p.y - mean.y)).sum::<f32>() / all.len() as f32;
        assert!(covariance.abs() < 0.004, "{pattern:?}: covariance {covariance}");
    }
}

#[test]
fn sample_depends_only_on_seed_pixel_index_branch_and_dimension() {
    let pixel = Sampler::new(AnyPointSet::SobolPoints(SobolPoints), 11).pixel(UVec2::new(4, 2));
    let mut first = pixel.sample(5);
    first.next_2d();
    let second = first.next_2d();
    let mut again = pixel.sample(5);
    again.skip(1);
    assert_eq!(again.next_2d(), second);
    assert_ne!(pixel.sample(6).next_2d(), pixel.sample(5).next_2d());
    assert_ne!(pixel.sample(5).branch(0).next_2d(), pixel.sample(5).branch(1).next_2d());
    assert_ne!(
        Sampler::new(AnyPointSet::SobolPoints(SobolPoints), 1 << 32).pixel(UVec2::ZERO),
        Sampler::new(AnyPointSet::SobolPoints(SobolPoints), 0).pixel(UVec2::ZERO)
    );
}

/// The numbers of two dimensions of a sample are independent, over all pixels.
#[test]
fn dimensions_are_uncorrelated() {
    for pattern in patterns(16) {
        for (a, b) in [(0, 1), (1, 2), (2, 9), (3, 259)] {
            let picture = Sampler::new(pattern, 17);
            let mut counts = [0.0; 64];
            for i in 0..64 * 64 * 16 {
                let sample = picture.pixel(UVec2::new(i / 16 % 64, i / 1024)).sample(i % 16);
                let (x, y) = (sample.skipped(a).next_1d(), sample.skipped(b).next_1d());
                counts[((x * 8.0) as u32 * 8 + (y * 8.0) as u32) as usize] += 1.0;
            }
            let chi: f64 = counts.iter().map(|count: &f64| (count - 1024.0).powi(2) / 1024.0).sum();
            assert!(chi < 130.0, "{pattern:?}, {a} and {b}: chi squared {chi} for 63 degrees of freedom");
        }
    }
}

/// Errors of a picture with edges and slopes, `EDGE` pixels wide and high.
fn errors(pattern: AnyPointSet, samples: u32, seed: u64) -> Vec<f64> {
    let value = |u: Vec2| f64::from(u8::from(u.x + 0.5 * u.y < 0.7)) + f64::from(u.x * u.y);
    let exact = 0.45 + 0.25;
    let picture = Sampler::new(pattern, seed);
    let pixels = (0..EDGE * EDGE).map(|i| picture.pixel(UVec2::new(i % EDGE, i / EDGE)));
    let sum = |pixel: Sampler| (0..samples).map(|i| value(pixel.sample(i).skipped(3).next_2d())).sum::<f64>();
    pixels.map(|pixel| sum(pixel) / f64::from(samples) - exact).collect()
}

const EDGE: u32 = 120;

/// Mean square of the means over cells of `cell` × `cell` pixels.
fn mean_square_of_cells(errors: &[f64], cell: u32) -> f64 {
    let count = EDGE / cell;
    let mean = |from: UVec2| {
        let at = |i: u32| errors[((from.y + i / cell) * EDGE + from.x + i % cell) as usize];
        (0..cell * cell).map(at).sum::<f64>() / f64::from(cell * cell)
    };
    let cells = (0..count * count).map(|i| UVec2::new(i % count, i / count) * cell);
    cells.map(|from| mean(from).powi(2)).sum::<f64>() / f64::from(count * count)
}

/// Cells of 3 and 5 pixels do not align with the quadrants of blue noise. All pixels share one
/// scrambling, which may suit a picture or not, so the test averages several pictures.
#[test]
fn errors_of_blue_noise_are_of_high_frequency() {
    for samples in [1, 4, 16] {
        let [sobol, _, independent, blue] = patterns(samples).try_into().unwrap_or_else(|_| unreachable!());
        let [sobol, independent, blue] = [sobol, independent, blue].map(|pattern| {
            let pictures: Vec<Vec<f64>> = (0..12).map(|seed| errors(pattern, samples, seed)).collect();
            [1, 3, 5].map(|cell| pictures.iter().map(|errors| mean_square_of_cells(errors, cell)).sum::<f64>() / 12.0)
        });
        // The total error is the same, at other frequencies.
        assert!((blue[0] / sobol[0] - 1.0).abs() < 0.2, "{samples} samples: {} and {}", blue[0], sobol[0]);
        for (i, share) in [(1, 0.8), (2, 0.6)] {
            let least = sobol[i].min(independent[i]);
            assert!(blue[i] < share * least, "{samples} samples: {blue:?}, {sobol:?}, {independent:?}");
        }
    }
}
