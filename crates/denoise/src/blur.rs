//! Box filter with a square window.

use rayon::prelude::*;

/// Means over the pixels of the picture within `radius` columns and rows.
pub(crate) fn mean(width: usize, numbers: &[f32], radius: usize) -> Vec<f32> {
    let mut across = vec![0.0; numbers.len()];
    across.par_chunks_mut(width).zip(numbers.par_chunks(width)).for_each(|(sums, row)| {
        let mut padded = vec![0.0; width + 2 * radius];
        padded[radius..radius + width].copy_from_slice(row);
        for shift in 0..=2 * radius {
            sums.iter_mut().zip(&padded[shift..]).for_each(|(sum, number)| *sum += number);
        }
        sums.iter_mut().enumerate().for_each(|(x, sum)| *sum /= count(x, width, radius));
    });
    let height = numbers.len() / width;
    let mut means = vec![0.0; numbers.len()];
    means.par_chunks_mut(width).enumerate().for_each(|(y, sums)| {
        for other in y.saturating_sub(radius)..height.min(y + radius + 1) {
            let row = &across[other * width..(other + 1) * width];
            sums.iter_mut().zip(row).for_each(|(sum, number)| *sum += number);
        }
        sums.iter_mut().for_each(|sum| *sum /= count(y, height, radius));
    });
    means
}

/// Number of positions within `radius` of `place` that lie in `0..length`.
fn count(place: usize, length: usize, radius: usize) -> f32 {
    (length.min(place + radius + 1) - place.saturating_sub(radius)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_blur_equals_direct_summation() {
        let (width, height) = (7, 5);
        let numbers: Vec<f32> = (0..width * height).map(|i| (i * 37 % 11) as f32).collect();
        for radius in 0..4 {
            let means = mean(width, &numbers, radius);
            for (i, found) in means.iter().enumerate() {
                let (x, y) = (i % width, i / width);
                let near = |a: usize, b: usize| a.abs_diff(b) <= radius;
                let around = (0..numbers.len()).filter(|j| near(j % width, x) && near(j / width, y));
                let all: Vec<f32> = around.map(|j| numbers[j]).collect();
                let expected = all.iter().sum::<f32>() / all.len() as f32;
                assert!((found - expected).abs() < 1e-5, "{x} {y} {radius}: {found} {expected}");
            }
        }
    }
}
