//! Choice of the number of camera rays by a small picture of the whole frame, each pixel of which
//! shows an area as large as a pixel of the frame.

use super::Engine;
use crate::{Cancelled, Control, Job, Work};
use juggler_camera::aov::{FilmAov, FilmAovs};
use juggler_camera::film::{FilterSampler, Rect};
use juggler_camera::sampler::AnySampler;
use juggler_math::{Rgb, UVec2};
use rayon::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;

/// Size of the small picture.
const WIDTH: u32 = 64;
const HEIGHT: u32 = 36;
/// Samples of each of its pixels.
const SAMPLES: u32 = 4;

/// Samples per pixel at which the choice is best. Noise of directly seen light falls faster with the
/// number of samples than other noise.
const TYPICAL_SAMPLES: f64 = 16.0;
/// Time of an additional camera ray, in units of the mean time of all rays with their shading.
const RELATIVE_COST: f64 = 0.4;
/// Numbers of camera rays, each with the share of the noise of directly seen light that stays. On an
/// edge, the variance of a well-distributed set of n points falls as n to the power of -3/2; two
/// rays are two such sets.
const COUNTS: [(u32, f64); 4] = [(1, 1.0), (2, 0.5), (4, 0.125), (8, 0.044)];
/// Gain in efficiency below which a sample keeps one camera ray.
const MIN_GAIN: f64 = 1.05;

/// What a row of the small picture tells.
struct Row {
    pixels: Vec<PixelNoise>,
    rays: u64,
}

/// Luminance of a pixel, and variances of its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PixelNoise {
    mean: f64,
    /// Variance of the light that camera rays see directly.
    seen: f64,
    /// Variance of all other light.
    rest: f64,
}

/// Chooses the number of camera rays of each sample of a picture whose whole frame has this size.
pub fn choose_camera_rays(job: &Job, frame: UVec2, control: &Control) -> Result<u32, Cancelled> {
    let aovs = FilmAovs { planes: vec![FilmAov::Emission], ..FilmAovs::default() };
    let camera = job.camera.resampled(frame, UVec2::new(WIDTH, HEIGHT));
    // A tent filter of this radius is as wide as the pixels of the frame.
    let scale = ((WIDTH * HEIGHT) as f32 / (frame.x as f32 * frame.y as f32)).sqrt();
    let small = Job {
        camera: &camera,
        filter: FilterSampler::Tent(scale * FRAC_1_SQRT_2),
        pattern: AnySampler::default().point_set(SAMPLES),
        samples: SAMPLES,
        seed: 0,
        aovs: &aovs,
        frames: None,
        ..*job
    };
    let row = |y| Engine::new(&small).noise_of_row(y, control);
    let rows: Vec<Row> = (0..HEIGHT).into_par_iter().map(row).collect::<Result<_, _>>()?;
    let rays: u64 = rows.iter().map(|row| row.rays).sum();
    let pixels: Vec<PixelNoise> = rows.into_iter().flat_map(|row| row.pixels).collect();
    let samples = f64::from(WIDTH * HEIGHT * SAMPLES);
    Ok(best_count(&pixels, rays as f64 / samples))
}

/// Number of camera rays of the best efficiency for samples of `rays` rays.
fn best_count(pixels: &[PixelNoise], rays: f64) -> u32 {
    // Sum up relative variances; pixels darker than the mean count less.
    let mean = pixels.iter().map(|pixel| pixel.mean).sum::<f64>() / pixels.len().max(1) as f64;
    let sum = |variance: fn(&PixelNoise) -> f64| {
        let relative = |pixel: &PixelNoise| variance(pixel) / ((pixel.mean + mean) * (pixel.mean + mean));
        pixels.iter().map(relative).filter(|noise| noise.is_finite()).sum::<f64>()
    };
    let (seen, rest) = (sum(|pixel| pixel.seen) / TYPICAL_SAMPLES.sqrt(), sum(|pixel| pixel.rest));
    let cost = RELATIVE_COST / rays.max(1.0);
    let inefficiencies = COUNTS.map(|(count, share)| {
        let time = 1.0 + f64::from(count - 1) * cost;
        (count, (rest + seen * share) * time)
    });
    let best = inefficiencies.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
    best.filter(|best| rest + seen > best.1 * MIN_GAIN).map_or(1, |(count, _)| count)
}

impl Engine<'_> {
    /// Renders a row of the small picture.
    fn noise_of_row(&mut self, y: u32, control: &Control) -> Result<Row, Cancelled> {
        let work = Work::first(Rect { x: 0, y, width: WIDTH, height: 1 }, SAMPLES);
        self.pass(&work, SAMPLES.into(), 0..u64::from(WIDTH * SAMPLES), control)?;
        let samples = self.buffers.samples();
        let pixels = samples.radiance.chunks(SAMPLES as usize).zip(samples.planes.chunks(SAMPLES as usize));
        let pixels = pixels.map(|(all, seen)| PixelNoise::from_samples(all, seen)).collect();
        Ok(Row { pixels, rays: u64::from(WIDTH * SAMPLES) + self.rays.total() })
    }
}

impl PixelNoise {
    /// Noise of a pixel by the radiance of its samples, and the part that camera rays see directly.
    fn from_samples(all: &[Rgb], seen: &[Rgb]) -> Self {
        let luminance = |color: &Rgb| if color.is_finite() { f64::from(color.luminance()) } else { 0.0 };
        let (count, seen) = (all.len().max(2) as f64, seen.iter().map(luminance).collect::<Vec<_>>());
        let rest: Vec<f64> = all.iter().zip(&seen).map(|(all, seen)| luminance(all) - seen).collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
        let variance = |values: &[f64]| {
            let mean = mean(values);
            values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0)
        };
        Self { mean: mean(&seen) + mean(&rest), seen: variance(&seen), rest: variance(&rest) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(seen: f64, rest: f64, rays: f64) -> u32 {
        best_count(&[PixelNoise { mean: 1.0, seen, rest }; 100], rays)
    }

    #[test]
    fn the_number_follows_the_noise_that_more_camera_rays_remove() {
        // Without noise at edges, additional rays only cost time.
        assert_eq!(chosen(0.0, 1.0, 10.0), 1);
        assert_eq!(chosen(0.0, 0.0, 10.0), 1);
        // A fifth of the noise is at edges, or nearly all.
        assert_eq!(chosen(1.0, 1.0, 10.0), 4);
        assert_eq!(chosen(40.0, 1.0, 10.0), 8);
        // Additional rays are dear where a sample has few rays.
        assert_eq!(chosen(1.0, 1.0, 1.0), 1);
    }

    #[test]
    fn black_pictures_keep_one_ray() {
        assert_eq!(best_count(&[PixelNoise { mean: 0.0, seen: 0.0, rest: 0.0 }; 4], 1.0), 1);
        assert_eq!(best_count(&[], 1.0), 1);
    }

    #[test]
    fn noise_of_a_pixel_by_hand() {
        let all = [1.0, 3.0, 1.0, 3.0].map(Rgb::splat);
        let seen = [1.0, 1.0, 0.0, 0.0].map(Rgb::splat);
        let noise = PixelNoise::from_samples(&all, &seen);
        // Seen directly: 1, 1, 0, 0; the rest: 0, 2, 1, 3.
        let expected = PixelNoise { mean: 2.0, seen: 1.0 / 3.0, rest: 5.0 / 3.0 };
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(close(noise.mean, expected.mean) && close(noise.seen, expected.seen), "{noise:?}");
        assert!(close(noise.rest, expected.rest), "{noise:?}");
    }
}
