//! Hashes of lattice cells, and smooth noise between lattice points.

use juggler_math::hash::{combine, unit_f32};
use juggler_math::{Vec3, portable};

/// Integer coordinates of a lattice cell. Hashes repeat after 2^32 cells.
pub type Cell = [i64; 3];

/// Cell of a point, and the point's position in the cell, 0 to 1 along each axis.
#[inline]
pub fn cell(p: Vec3) -> (Cell, Vec3) {
    let floor = p.floor();
    // Infinite coordinates saturate, and their position in the cell is NaN.
    ([floor.x as i64, floor.y as i64, floor.z as i64], p - floor)
}

/// Hash of a cell.
#[inline]
pub fn hash([x, y, z]: Cell, seed: u32) -> u32 {
    combine(combine(combine(seed, x as u32), y as u32), z as u32)
}

/// Three numbers from 0 to 1 that derive from a hash.
#[inline]
pub fn unit_cube_point(hash: u32) -> Vec3 {
    Vec3::new(unit_f32(hash), unit_f32(combine(hash, 1)), unit_f32(combine(hash, 2)))
}

/// Perlin's gradients: the midpoints of a cube's edges.
const DIRECTIONS: [[f32; 3]; 12] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
];

#[inline]
fn gradient_dot(hash: u32, off: Vec3) -> f32 {
    let index = (u64::from(hash) * DIRECTIONS.len() as u64) >> 32;
    Vec3::from(DIRECTIONS[index as usize]).dot(off)
}

/// Gradient noise from -1 to 1 with features about one unit wide. It is 0 at all lattice points and
/// 0 in the mean (Perlin, Improving Noise, 2002; a hash instead of a table chooses the gradients).
pub fn noise(p: Vec3, seed: u32) -> f32 {
    let ([x, y, z], at) = cell(p);
    let fade = at * at * at * (at * (at * 6.0 - 15.0) + 10.0);
    let column = |dx: i64| combine(seed, (x.wrapping_add(dx)) as u32);
    let row = |column: u32, dy: i64| combine(column, (y.wrapping_add(dy)) as u32);
    let along_z = |row: u32, dx: f32, dy: f32| {
        let low = gradient_dot(combine(row, z as u32), at - Vec3::new(dx, dy, 0.0));
        let high = gradient_dot(combine(row, z.wrapping_add(1) as u32), at - Vec3::new(dx, dy, 1.0));
        low + (high - low) * fade.z
    };
    let along_y = |column: u32, dx: f32| {
        let low = along_z(row(column, 0), dx, 0.0);
        low + (along_z(row(column, 1), dx, 1.0) - low) * fade.y
    };
    let low = along_y(column(0), 0.0);
    let value = low + (along_y(column(1), 1.0) - low) * fade.x;
    // The sum rarely exceeds 1, and by little.
    value.clamp(-1.0, 1.0)
}

/// Smoothstep: 0 below `low`, 1 above `high`, a cubic in between; a step if both are equal.
#[inline]
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    if high > low {
        let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    } else if x < low {
        0.0
    } else {
        1.0
    }
}

/// Share of the amplitude that a filter of diameter `width` keeps of a pattern with period 1: all
/// of it at four or more samples per period, none well beyond the Nyquist limit.
#[inline]
pub fn filter_amplitude(width: f32) -> f32 {
    1.0 - smoothstep(0.25, 0.75, width)
}

/// Share of `[x - width / 2, x + width / 2]` that lies in the first `duty` of each unit: a
/// box-filtered train of pulses (Apodaca and Gritz, Advanced RenderMan, 2000, section 11.3).
pub fn filtered_pulse_train(x: f32, duty: f32, width: f32) -> f32 {
    let (x, duty, width) = (f64::from(x), f64::from(duty), f64::from(width));
    let sum = |x: f64| {
        let whole = portable::floor_f64(x);
        whole * duty + (x - whole).min(duty)
    };
    if !x.is_finite() {
        return duty as f32;
    }
    if width < 1e-6 {
        return if x - portable::floor_f64(x) < duty { 1.0 } else { 0.0 };
    }
    (((sum(x + width * 0.5) - sum(x - width * 0.5)) / width) as f32).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, z_test};

    #[test]
    fn noise_is_zero_at_lattice_points_and_within_its_range() {
        let mut random = Random::new(700);
        let (mut least, mut most) = (1.0f32, -1.0f32);
        for _ in 0..100_000 {
            let p = random.point(100.0);
            let value = noise(p, 7);
            (least, most) = (least.min(value), most.max(value));
            assert_eq!(noise(p.round(), 7), 0.0);
        }
        assert!(least > -1.0 && least < -0.7 && most < 1.0 && most > 0.7, "{least} {most}");
        assert_ne!(noise(Vec3::splat(0.3), 1), noise(Vec3::splat(0.3), 2), "seeds differ");
        assert_eq!(noise(Vec3::new(0.3, 1.6, -2.2), 0).to_bits(), noise(Vec3::new(0.3, 1.6, -2.2), 0).to_bits());
    }

    #[test]
    fn noise_has_zero_mean_and_no_long_range_correlation() {
        let mut random = Random::new(701);
        let points: Vec<Vec3> = (0..20_000).map(|_| random.point(1e4)).collect();
        let values: Vec<f64> = points.iter().map(|p| noise(*p, 3).into()).collect();
        z_test(&values, 0.0, 1e-3).unwrap();
        for away in [Vec3::X * 5.5, Vec3::Y * 17.25, Vec3::ONE * 3.3] {
            let products: Vec<f64> =
                points.iter().zip(&values).map(|(p, v)| v * f64::from(noise(*p + away, 3))).collect();
            z_test(&products, 0.0, 1e-3).unwrap();
        }
    }

    #[test]
    fn noise_and_its_slope_are_continuous_across_cells() {
        let mut random = Random::new(702);
        for _ in 0..1000 {
            let edge = Vec3::new(random.range(-9.0, 9.0).round(), random.range(-9.0, 9.0), random.range(-9.0, 9.0));
            let step = Vec3::X * 0.001;
            let [a, b, c, d] = [-1.5, -0.5, 0.5, 1.5].map(|k| f64::from(noise(edge + step * k, 5)));
            assert!((c - b).abs() < 0.003, "{edge}: {b} {c}");
            assert!(((d - c) - (b - a)).abs() < 5e-5, "{edge}: {}", (d - c) - (b - a));
        }
    }

    #[test]
    fn noise_is_finite_at_huge_coordinates() {
        for far in [1e9, -1e15, 1e30, f32::MAX, f32::MIN] {
            assert!(noise(Vec3::new(far, 0.5, -far), 1).is_finite());
        }
    }

    #[test]
    fn filtered_pulse_train_equals_the_brute_force_mean() {
        let mut random = Random::new(703);
        for _ in 0..300 {
            let (x, duty, width) = (random.range(-50.0, 50.0), random.f32(), random.range(1e-3, 5.0));
            let inside = |i: u32| {
                let x = f64::from(x) + f64::from(width) * ((f64::from(i) + 0.5) / 20_000.0 - 0.5);
                f64::from(u8::from(x - x.floor() < f64::from(duty)))
            };
            let mean: f64 = (0..20_000).map(inside).sum::<f64>() / 20_000.0;
            assert!((f64::from(filtered_pulse_train(x, duty, width)) - mean).abs() < 2e-3, "{x} {duty} {width}");
        }
        assert_eq!(
            (
                filtered_pulse_train(0.2, 0.5, 0.0),
                filtered_pulse_train(-0.2, 0.5, 0.0),
                filtered_pulse_train(7.4, 0.5, 0.0)
            ),
            (1.0, 0.0, 1.0)
        );
    }

    #[test]
    fn octave_filter_fades_smoothly() {
        assert_eq!(
            (
                filter_amplitude(0.0),
                filter_amplitude(0.25),
                filter_amplitude(0.5),
                filter_amplitude(0.75),
                filter_amplitude(1e30)
            ),
            (1.0, 1.0, 0.5, 0.0, 0.0)
        );
        assert_eq!((smoothstep(1.0, 1.0, 0.9), smoothstep(1.0, 1.0, 1.0)), (0.0, 1.0));
    }
}
