//! Test support for this and other crates (feature `testing`): random inputs from a fixed seed, and
//! statistical tests with a stated significance level.

use crate::{Ray, Rgb, Transform, Vec2, Vec3, portable};
use glam::Mat3;
use std::fs::OpenOptions;
use std::io::Write;

/// Reports why a test checks nothing on this machine: on standard error, and as a line appended to
/// the file that `JUGGLER_SKIPPED` names, which `check.sh` prints at its end.
#[expect(clippy::print_stderr, reason = "a skipped test is reported to the person who runs it")]
pub fn skipped(reason: &str) {
    eprintln!("SKIPPED: {reason}");
    let Some(path) = std::env::var_os("JUGGLER_SKIPPED") else { return };
    let file = OpenOptions::new().create(true).append(true).open(path);
    if let Err(error) = file.and_then(|mut file| file.write_all(format!("{reason}\n").as_bytes())) {
        eprintln!("cannot write to the file that JUGGLER_SKIPPED names: {error}");
    }
}

/// Pseudorandom numbers (SplitMix64: Steele, Lea, Flood 2014), the same on every platform.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Constructs a generator whose sequence depends on `seed` only.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 random bits.
    pub fn bits64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next 32 random bits.
    pub fn bits(&mut self) -> u32 {
        (self.bits64() >> 32) as u32
    }

    /// A number in [0, 1).
    pub fn f32(&mut self) -> f32 {
        crate::hash::unit_f32(self.bits())
    }

    /// A number in [low, high).
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        (low + (high - low) * self.f32()).min(high.next_down())
    }

    /// A uniform integer in 0..count; 0 when count is 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits64()) * count as u128) >> 64) as usize
    }

    /// A uniform point in the unit square [0, 1)².
    pub fn vec2(&mut self) -> Vec2 {
        Vec2::new(self.f32(), self.f32())
    }

    /// A uniform point in the unit cube [0, 1)³.
    pub fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.f32(), self.f32(), self.f32())
    }

    /// A color with channels in [0, 1).
    pub fn rgb(&mut self) -> Rgb {
        Rgb::new(self.f32(), self.f32(), self.f32())
    }

    /// A uniform direction, by rejection sampling and so independent of the mappings under test.
    pub fn unit_vector(&mut self) -> Vec3 {
        loop {
            let v = self.vec3() * 2.0 - 1.0;
            let squared = v.length_squared();
            if squared > 1e-4 && squared <= 1.0 {
                return v / squared.sqrt();
            }
        }
    }

    /// A uniform point in the cube of half edge `radius` around the origin.
    pub fn point(&mut self, radius: f32) -> Vec3 {
        (self.vec3() * 2.0 - 1.0) * radius
    }

    /// An unbounded ray from within the cube of half edge `radius`, in a uniform direction.
    pub fn ray(&mut self, radius: f32) -> Ray {
        let origin = self.point(radius);
        Ray::new(origin, self.unit_vector())
    }

    /// A rotation about a uniform axis.
    pub fn rotation(&mut self) -> Transform {
        let (axis, angle) = (self.unit_vector(), self.range(-3.2, 3.2));
        Transform::rotation(axis, angle).unwrap_or(Transform::IDENTITY)
    }

    /// A random affine transform with |det| > 0.2; half of them are reflections.
    pub fn transform(&mut self) -> Transform {
        loop {
            let matrix = Mat3::from_cols(self.point(1.5), self.point(1.5), self.point(1.5));
            let well = matrix.determinant().abs() > 0.2;
            let translation = self.point(5.0);
            if let Some(transform) = Transform::new(matrix, translation).filter(|_| well) {
                return transform;
            }
        }
    }
}

/// Whether two numbers differ by no more than `tolerance`, absolute below 1 and relative above.
pub fn close(a: f32, b: f32, tolerance: f32) -> bool {
    a == b || (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(1.0)
}

/// Whether two vectors are [`close`] in each coordinate, relative to the longer one.
pub fn close3(a: Vec3, b: Vec3, tolerance: f32) -> bool {
    a == b || (a - b).abs().max_element() <= tolerance * a.length().max(b.length()).max(1.0)
}

/// Minimum expected count of a cell; cells of lower expectation are pooled.
const LEAST_EXPECTED: f64 = 5.0;

/// Pearson's chi-squared test of observed against expected counts. Returns an error with the
/// statistic if the p-value is below `significance`. Cells of low expectation are pooled. The sums
/// need not be equal; events that may be lost are given as one more cell.
pub fn chi_squared(observed: &[f64], expected: &[f64], significance: f64) -> Result<(), String> {
    if observed.len() != expected.len() || observed.is_empty() {
        return Err(format!("{} cells observed, {} expected", observed.len(), expected.len()));
    }
    let mut cells: Vec<(f64, f64)> = expected.iter().copied().zip(observed.iter().copied()).collect();
    if let Some(cell) = cells.iter().find(|(e, o)| e.is_nan() || *e < 0.0 || (*e == 0.0 && *o > 0.0)) {
        return Err(format!("{} events where {} are expected", cell.1, cell.0));
    }
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut statistic, mut groups, mut pool) = (0.0, 0usize, (0.0, 0.0));
    let mut rest: f64 = cells.iter().map(|c| c.0).sum();
    for (e, o) in cells {
        pool = (pool.0 + e, pool.1 + o);
        rest -= e;
        if pool.0 >= LEAST_EXPECTED && rest >= LEAST_EXPECTED || rest <= 0.0 && pool.0 > 0.0 {
            statistic += (pool.1 - pool.0) * (pool.1 - pool.0) / pool.0;
            (groups, pool) = (groups + 1, (0.0, 0.0));
        }
    }
    if pool.0 > 0.0 {
        statistic += (pool.1 - pool.0) * (pool.1 - pool.0) / pool.0;
        groups += 1;
    }
    let freedom = groups.saturating_sub(1).max(1);
    let chance = chi_squared_tail(statistic, freedom);
    if chance >= significance {
        return Ok(());
    }
    Err(format!("chi-squared {statistic:.2} with {freedom} degrees of freedom: p = {chance:.3e} < {significance}"))
}

/// Probability that a chi-squared variable with `freedom` degrees of freedom exceeds `statistic`.
pub fn chi_squared_tail(statistic: f64, freedom: usize) -> f64 {
    upper_gamma(freedom as f64 / 2.0, statistic / 2.0)
}

/// Regularized upper incomplete gamma function Q(a, x): series below a + 1, continued fraction
/// (Lentz) above (Abramowitz and Stegun 6.5.29 and 6.5.31).
fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let front = portable::exp_f64(a * portable::ln_f64(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-16 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return (1.0 - front * sum).max(0.0);
    }
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1e300, 1.0 / b);
    let mut fraction = d;
    for i in 1..10_000 {
        let i = f64::from(i);
        let numerator = i * (a - i);
        b += 2.0;
        d = 1.0 / (b + numerator * d);
        c = b + numerator / c;
        fraction *= c * d;
        if (c * d - 1.0).abs() < 1e-15 {
            break;
        }
    }
    front * fraction
}

/// Two-sided z-test of the mean of `values` against `expected`. Returns an error if the p-value is
/// below `significance`. Needs enough values for their mean to be normally distributed.
pub fn z_test(values: &[f64], expected: f64, significance: f64) -> Result<(), String> {
    let n = values.len() as f64;
    if values.len() < 2 {
        return Err("a z-test needs at least two values".into());
    }
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    // Lower bound: single-precision rounding biases the mean even where the variance is 0.
    let spread = (variance / n).sqrt().max(1e-6 * expected.abs()).max(1e-12);
    let z = (mean - expected).abs() / spread;
    let chance = libm::erfc(z / std::f64::consts::SQRT_2);
    if chance >= significance {
        return Ok(());
    }
    Err(format!("mean {mean} of {n} values, expected {expected}: {z:.2} deviations, p = {chance:.3e} < {significance}"))
}

/// Two-sided critical value, in standard errors, at which `cases` independent tests together have a
/// false alarm rate of 1 % (Šidák 1967).
pub fn family_wise_deviations(cases: usize) -> f64 {
    let level = 1.0 - portable::pow_f64(0.99, 1.0 / cases.max(1) as f64);
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if libm::erfc(middle / std::f64::consts::SQRT_2) > level { &mut low } else { &mut high }) = middle;
    }
    high
}

/// Grid over the sphere: bands in z times sectors in azimuth, cells of equal solid angle.
const Z_CELLS: usize = 16;
const TURN_CELLS: usize = 32;

/// Integral of a density over a cell by the midpoint rule with `steps` × `steps` points.
fn by_midpoints(pdf: &impl Fn(Vec3) -> f32, cell: usize, steps: usize) -> f64 {
    let share = |i: usize, k: usize, cells: usize| (i as f32 + (k as f32 + 0.5) / steps as f32) / cells as f32;
    let mut sum = 0.0;
    for k in 0..steps * steps {
        let z = share(cell / TURN_CELLS, k / steps, Z_CELLS) * 2.0 - 1.0;
        let (sin, cos) = portable::sin_cos_turns(share(cell % TURN_CELLS, k % steps, TURN_CELLS));
        let radius = (1.0 - z * z).max(0.0).sqrt();
        sum += f64::from(pdf(Vec3::new(radius * cos, radius * sin, z)));
    }
    sum * 4.0 * std::f64::consts::PI / (Z_CELLS * TURN_CELLS * steps * steps) as f64
}

/// Expected number of `count` events in a cell. Refines the midpoint rule until a step barely
/// changes the test statistic. A zero integral of a cell with observed events is accepted only at
/// the finest step.
fn expected_in(pdf: &impl Fn(Vec3) -> f32, cell: usize, count: f64, was_observed: bool) -> f64 {
    // Step ratios other than 2 avoid midpoints in the same blind spots.
    let (mut steps, mut last) = (17, by_midpoints(pdf, cell, 10) * count);
    loop {
        let next = by_midpoints(pdf, cell, steps) * count;
        let is_steady = (next - last) * (next - last) <= 0.02 * next.max(LEAST_EXPECTED);
        if steps >= 250 || is_steady && (next > 0.0 || !was_observed) {
            return next;
        }
        (steps, last) = (steps * 5 / 3, next);
    }
}

/// Chi-squared test of a direction sampling routine against its density per steradian. `sample`
/// maps a point of the unit square to a direction, or to `None` when it rejects the sample; `pdf`
/// returns the density of a direction. Cells have equal solid angle; the density is integrated
/// adaptively by the midpoint rule.
pub fn chi_squared_directions(
    mut sample: impl FnMut(Vec2) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f32,
    count: u32,
    significance: f64,
) -> Result<(), String> {
    let mut random = Random::new(u64::from(count));
    let mut observed = vec![0.0; Z_CELLS * TURN_CELLS + 1];
    let index = |v: f32, cells: usize| ((v * cells as f32) as usize).min(cells - 1);
    for _ in 0..count {
        let cell = sample(random.vec2()).map_or(Z_CELLS * TURN_CELLS, |w| {
            let turn = (portable::atan2(w.y, w.x) / std::f32::consts::TAU).rem_euclid(1.0);
            index(w.z * 0.5 + 0.5, Z_CELLS) * TURN_CELLS + index(turn, TURN_CELLS)
        });
        observed[cell] += 1.0;
    }
    let mut expected: Vec<f64> =
        (0..Z_CELLS * TURN_CELLS).map(|cell| expected_in(&pdf, cell, f64::from(count), observed[cell] > 0.0)).collect();
    expected.push(0.0);
    let total: f64 = expected.iter().sum();
    if total > f64::from(count) * 1.01 {
        return Err(format!("the density integrates to {}", total / f64::from(count)));
    }
    // One minus the integral of the density is the expected share of rejected samples. Drop that
    // cell where both agree to the accuracy of the integral, or where next to nothing is rejected.
    let (rejected, expected_rejected) = (observed[Z_CELLS * TURN_CELLS], f64::from(count) - total);
    let accuracy = f64::from(count) * 5e-4;
    let is_close = (rejected - expected_rejected).abs() < accuracy;
    if is_close || rejected < accuracy && expected_rejected.abs() < f64::from(count) * 0.01 {
        observed.pop();
        expected.pop();
    } else {
        expected[Z_CELLS * TURN_CELLS] = expected_rejected.max(0.0);
    }
    chi_squared(&observed, &expected, significance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tail_agrees_with_published_tables() {
        for (statistic, freedom, chance) in
            [(3.841, 1, 0.05), (6.635, 1, 0.01), (18.307, 10, 0.05), (29.588, 10, 0.001), (124.342, 100, 0.05)]
        {
            let p = chi_squared_tail(statistic, freedom);
            assert!((p / chance - 1.0).abs() < 2e-3, "{statistic} {freedom}: {p}");
        }
        assert_eq!(chi_squared_tail(0.0, 3), 1.0);
        assert!(chi_squared_tail(1e6, 3) < 1e-100);
    }

    #[test]
    fn a_fair_die_passes_and_a_loaded_one_does_not() {
        let mut random = Random::new(1);
        let mut counts = [0.0; 6];
        for _ in 0..6000 {
            counts[random.below(6)] += 1.0;
        }
        chi_squared(&counts, &[1000.0; 6], 1e-3).unwrap();
        counts[0] += 200.0;
        chi_squared(&counts, &[1000.0; 6], 1e-3).unwrap_err();
    }

    #[test]
    fn chi_squared_pools_small_cells_and_rejects_the_impossible() {
        let expected: Vec<f64> = (0..1000).map(|i| if i < 990 { 0.1 } else { 100.0 }).collect();
        let mut observed = vec![0.0; 1000];
        (0..99).for_each(|i| observed[i * 10] = 1.0);
        observed[990..].fill(100.0);
        chi_squared(&observed, &expected, 0.01).unwrap();
        assert!(chi_squared(&[5.0, 10.0], &[0.0, 15.0], 0.01).unwrap_err().contains("0 are expected"));
        chi_squared(&[1.0], &[1.0, 2.0], 0.01).unwrap_err();
    }

    /// Under the null hypothesis, p-values below 5 % occur in 5 % of all trials.
    #[test]
    fn false_alarms_are_as_frequent_as_promised() {
        let mut random = Random::new(2);
        let alarms = (0..2000).filter(|_| {
            let mut counts = [0.0; 10];
            for _ in 0..500 {
                counts[random.below(10)] += 1.0;
            }
            chi_squared(&counts, &[50.0; 10], 0.05).is_err()
        });
        let alarms = alarms.count();
        assert!((70..135).contains(&alarms), "{alarms}");
    }

    #[test]
    fn z_test_tells_means_apart() {
        let mut random = Random::new(3);
        let values: Vec<f64> = (0..10_000).map(|_| f64::from(random.f32())).collect();
        z_test(&values, 0.5, 1e-3).unwrap();
        z_test(&values, 0.52, 1e-3).unwrap_err();
        z_test(&[0.25; 100], 0.25, 1e-3).unwrap();
        assert!(
            (family_wise_deviations(1) - 2.575_829).abs() < 1e-6 && (3.5..3.6).contains(&family_wise_deviations(24))
        );
    }

    #[test]
    fn directions_are_tested_against_their_density() {
        let uniform = |u: Vec2| Some(crate::warp::uniform_sphere(u));
        let pdf = 1.0 / (4.0 * std::f32::consts::PI);
        chi_squared_directions(uniform, |_| pdf, 100_000, 1e-3).unwrap();
        chi_squared_directions(uniform, |w| pdf * (1.0 + 0.1 * w.x), 100_000, 1e-3).unwrap_err();
        chi_squared_directions(
            |u| uniform(u).filter(|w| w.z > 0.0),
            |w| if w.z > 0.0 { pdf } else { 0.0 },
            50_000,
            1e-3,
        )
        .unwrap();
    }

    #[test]
    fn random_stays_in_range_and_close_is_relative_above_one() {
        let mut random = Random::new(4);
        for _ in 0..10_000 {
            let x = random.range(-3.0, 1e-3);
            assert!((-3.0..1e-3).contains(&x) && (0.0..1.0).contains(&random.f32()));
            assert!(close(random.unit_vector().length(), 1.0, 1e-6));
        }
        assert_eq!(Random::new(0).bits64(), 0xe220_a839_7b1d_cdaf);
        assert!(close(1e6, 1e6 + 1.0, 1e-5) && !close(1.0, 1.1, 1e-3) && !close(f32::NAN, 0.0, 1.0));
    }
}
