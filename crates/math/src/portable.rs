//! Elementary functions with the same bits on every platform. The platform's own `sin` or `pow`
//! differ, so no code that decides a pixel may call them.
//!
//! Sine and cosine are polynomials fitted at Chebyshev nodes, since sampling calls them at every
//! bounce. All other functions come from the crate `libm`, which is plain arithmetic; of the
//! processor it uses roots and the like, which are exact. Names ending in `_f64` are in double
//! precision.

const SIGN: u32 = 1 << 31;

/// π/2 as a sum of two parts. The first has 32 bits, so its product with an integer below 2^21 is
/// exact.
const HALF_PI_HIGH: f64 = 1.570_796_326_734_125_6;
const HALF_PI_LOW: f64 = 6.077_100_506_506_192e-11;

/// Sine and cosine of an angle in radians, each within 0.6 ulp for |angle| < 100,000.
pub fn sin_cos(radians: f32) -> (f32, f32) {
    if radians.abs() < 1e5 {
        let x = f64::from(radians);
        // Adding 1.5 · 2^52 rounds to an integer and leaves it in the lowest bits.
        let shifted = x * std::f64::consts::FRAC_2_PI + 6_755_399_441_055_744.0;
        let quarters = shifted - 6_755_399_441_055_744.0;
        let r = (x - quarters * HALF_PI_HIGH) - quarters * HALF_PI_LOW;
        in_quadrant(shifted.to_bits() as u32, sin_near_zero(r) as f32, cos_near_zero(r) as f32)
    } else {
        libm::sincosf(radians)
    }
}

/// Sine for |r| <= π/4.
fn sin_near_zero(r: f64) -> f64 {
    let z = r * r;
    let c = -0.000_198_400_864_995_936 + z * 2.724_989_523_061_167_6e-6;
    r + r * z * (-0.166_666_666_638_541_68 + z * (0.008_333_331_874_273_714 + z * c))
}

/// Cosine for |r| <= π/4.
fn cos_near_zero(r: f64) -> f64 {
    let z = r * r;
    let c = 2.480_060_018_036_381e-5 + z * -2.730_093_368_721_294_3e-7;
    1.0 - 0.5 * z + z * z * (0.041_666_666_664_320_264 + z * (-0.001_388_888_767_165_250_4 + z * c))
}

/// Sine and cosine of the angle 2π · `turns`, within 2 ulps for |turns| < 100,000. The fastest
/// form, since its range reduction is exact.
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    let quarters = turns * 4.0;
    // Adding 1.5 · 2^23 rounds to an integer and leaves it in the lowest bits.
    let shifted = quarters + 12_582_912.0;
    let r = quarters - (shifted - 12_582_912.0);
    let z = r * r;
    let sin = r * (std::f32::consts::FRAC_PI_2 + z * (-0.645_963_5 + z * (0.079_680_22 + z * -0.004_602_149)));
    let cos = 1.0 + z * (-1.233_700_5 + z * (0.253_669_4 + z * (-0.020_861_529 + z * 0.000_906_739_9)));
    in_quadrant(shifted.to_bits(), sin, cos)
}

/// Rotates (cosine, sine) of a reduced angle by `quadrant` right angles, of which the two lowest
/// bits count.
fn in_quadrant(quadrant: u32, sin: f32, cos: f32) -> (f32, f32) {
    let (s, c) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let flip = |v: f32, when: u32| f32::from_bits(v.to_bits() ^ (when << 30 & SIGN));
    (flip(s, quadrant), flip(c, quadrant.wrapping_add(1)))
}

/// Sine of an angle in radians.
pub fn sin(radians: f32) -> f32 {
    sin_cos(radians).0
}

/// Cosine of an angle in radians.
pub fn cos(radians: f32) -> f32 {
    sin_cos(radians).1
}

/// Tangent of an angle in radians.
pub fn tan(radians: f32) -> f32 {
    libm::tanf(radians)
}

/// Arcsine in radians, -π/2 to π/2. The argument is clamped to ±1.
pub fn asin(sine: f32) -> f32 {
    libm::asinf(sine.clamp(-1.0, 1.0))
}

/// Arccosine in radians, 0 to π. The argument is clamped to ±1.
pub fn acos(cosine: f32) -> f32 {
    libm::acosf(cosine.clamp(-1.0, 1.0))
}

/// Arctangent in radians, -π/2 to π/2.
pub fn atan(tangent: f32) -> f32 {
    libm::atanf(tangent)
}

/// Azimuth in radians, -π to π, of the point (x, y); 0 for the origin.
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// e to the power of `x`.
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// 2 to the power of `x`.
pub fn exp2(x: f32) -> f32 {
    libm::exp2f(x)
}

/// Natural logarithm.
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Logarithm to base 2.
pub fn log2(x: f32) -> f32 {
    libm::log2f(x)
}

/// `x` to the power of `y`. Integer exponents up to 1024 use [`powi`].
pub fn powf(x: f32, y: f32) -> f32 {
    if (0.0..=1024.0).contains(&y) && y == (y as u32) as f32 { powi(x, y as u32) } else { libm::powf(x, y) }
}

/// `x` to the power of `n` by repeated squaring.
pub fn powi(x: f32, mut n: u32) -> f32 {
    let (mut result, mut square) = (1.0, x);
    while n > 0 {
        if n & 1 == 1 {
            result *= square;
        }
        square *= square;
        n >>= 1;
    }
    result
}

/// Sine of an angle in radians.
pub fn sin_f64(radians: f64) -> f64 {
    libm::sin(radians)
}

/// Cosine of an angle in radians.
pub fn cos_f64(radians: f64) -> f64 {
    libm::cos(radians)
}

/// Sine and cosine of an angle in radians.
pub fn sin_cos_f64(radians: f64) -> (f64, f64) {
    libm::sincos(radians)
}

/// Tangent of an angle in radians.
pub fn tan_f64(radians: f64) -> f64 {
    libm::tan(radians)
}

/// Arcsine in radians. The argument is clamped to ±1.
pub fn asin_f64(sine: f64) -> f64 {
    libm::asin(sine.clamp(-1.0, 1.0))
}

/// Arccosine in radians. The argument is clamped to ±1.
pub fn acos_f64(cosine: f64) -> f64 {
    libm::acos(cosine.clamp(-1.0, 1.0))
}

/// Arctangent in radians.
pub fn atan_f64(tangent: f64) -> f64 {
    libm::atan(tangent)
}

/// Azimuth in radians, -π to π, of the point (x, y); 0 for the origin.
pub fn atan2_f64(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// e to the power of `x`.
pub fn exp_f64(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
pub fn ln_f64(x: f64) -> f64 {
    libm::log(x)
}

/// `x` to the power of `y`.
pub fn pow_f64(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// Cube root.
pub fn cbrt_f64(x: f64) -> f64 {
    libm::cbrt(x)
}

/// Square root, correctly rounded.
pub fn sqrt_f64(x: f64) -> f64 {
    x.sqrt()
}

/// Largest integer not above `x`, without a call of the platform's function.
#[inline]
pub fn floor(x: f32) -> f32 {
    // Larger numbers are whole, or not finite.
    const WHOLE: f32 = 8_388_608.0;
    if x.abs() >= WHOLE || x.is_nan() {
        return x;
    }
    // Adding 2^23 rounds to the nearest integer.
    let near = (x + WHOLE.copysign(x)) - WHOLE.copysign(x);
    let below = if near > x { near - 1.0 } else { near };
    below.copysign(x)
}

/// Largest integer not above `x`, without a call of the platform's function.
#[inline]
pub fn floor_f64(x: f64) -> f64 {
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    if x.abs() >= WHOLE || x.is_nan() {
        return x;
    }
    let near = (x + WHOLE.copysign(x)) - WHOLE.copysign(x);
    let below = if near > x { near - 1.0 } else { near };
    below.copysign(x)
}

/// Largest power of ten up to `value`, computed by multiplications and divisions only, which give
/// the same bits on every machine.
pub fn power_of_ten(value: f64) -> f64 {
    let mut power = 1.0;
    while power > value && power > 1e-300 {
        power /= 10.0;
    }
    while power * 10.0 <= value && power < 1e300 {
        power *= 10.0;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    /// Error in ulps of an `f32` of the exact value's magnitude.
    fn ulps(value: f32, truth: f64) -> f64 {
        let rounded = (truth.abs() as f32).max(f32::MIN_POSITIVE);
        (f64::from(value) - truth).abs() / f64::from(rounded.next_up() - rounded)
    }

    fn worst(range: (f32, f32), f: impl Fn(f32) -> f32, truth: impl Fn(f64) -> f64) -> f64 {
        let mut random = Random::new(11);
        let mut at = || random.range(range.0, range.1);
        (0..200_000).map(|_| at()).map(|x| ulps(f(x), truth(f64::from(x)))).fold(0.0, f64::max)
    }

    #[test]
    fn sine_and_cosine_are_accurate_wherever_the_angle_is() {
        for range in [(-0.9, 0.9), (-7.0, 7.0), (-1e4, 1e4), (-9.9e4, 9.9e4), (1e5, 1e9)] {
            assert!(worst(range, sin, f64::sin) < 0.6, "sine in {range:?}");
            assert!(worst(range, cos, f64::cos) < 0.6, "cosine in {range:?}");
        }
    }

    #[test]
    fn sine_near_multiples_of_pi_keeps_its_relative_accuracy() {
        for k in 0..30_000 {
            let x = (f64::from(k) * std::f64::consts::FRAC_PI_2) as f32;
            let (s, c) = sin_cos(x);
            assert!(ulps(s, f64::from(x).sin()) < 0.6 && ulps(c, f64::from(x).cos()) < 0.6, "{x}");
        }
    }

    #[test]
    fn sine_of_zero_tiny_and_nonfinite_angles() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin(1e-30), 1e-30);
        assert!(sin(f32::INFINITY).is_nan() && cos(f32::NAN).is_nan());
    }

    #[test]
    fn sine_and_cosine_of_turns_are_accurate_and_exact_at_quarter_turns() {
        let tau = std::f64::consts::TAU;
        // Near the zeros the f64 reference (x · tau) is itself rounded: allow an absolute error
        // there.
        for (f, truth) in [(0, f64::sin as fn(f64) -> f64), (1, f64::cos)] {
            for i in 0..1 << 18 {
                let u = i as f32 / (1 << 18) as f32;
                let value = if f == 0 { sin_cos_turns(u).0 } else { sin_cos_turns(u).1 };
                let exact = truth(f64::from(u) * tau);
                assert!(ulps(value, exact) < 2.0 || exact.abs() < 1e-9, "{u}: {value} {exact}");
            }
        }
        let quarters = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
        for (i, expected) in quarters.into_iter().cycle().take(40).enumerate() {
            assert_eq!(sin_cos_turns(i as f32 * 0.25), expected);
            assert_eq!(sin_cos_turns(-(i as f32) * 0.25), (-expected.0, expected.1));
        }
        let (s, c) = sin_cos_turns(1f32.next_down());
        assert!(s < 0.0 && s > -1e-6 && c == 1.0);
    }

    #[test]
    fn the_other_functions_agree_with_double_precision() {
        assert!(worst((-1.5, 1.5), tan, f64::tan) < 1.0);
        assert!(worst((-1.0, 1.0), asin, f64::asin) < 1.0);
        assert!(worst((-1.0, 1.0), acos, f64::acos) < 1.0);
        assert!(worst((-50.0, 50.0), atan, f64::atan) < 1.0);
        assert!(worst((-80.0, 80.0), exp, f64::exp) < 1.0);
        assert!(worst((-80.0, 80.0), exp2, f64::exp2) < 1.0);
        assert!(worst((1e-3, 1e4), ln, f64::ln) < 1.0);
        assert!(worst((1e-30, 1e4), log2, f64::log2) < 1.0);
        assert!(worst((0.0, 10.0), |x| powf(x, 2.4), |x| x.powf(f64::from(2.4f32))) < 1.0);
        assert!(worst((0.5, 1.0), |x| powf(x, 20.0), |x| x.powi(20)) < 20.0);
        assert!(worst((-3.0, 3.0), |y| atan2(y, -0.7), |y| y.atan2(f64::from(-0.7f32))) < 2.0);
    }

    #[test]
    fn inverse_sine_and_cosine_clamp_arguments_beyond_one() {
        assert_eq!(acos(1.000_001), 0.0);
        assert_eq!(asin(-1.000_001), -std::f32::consts::FRAC_PI_2);
        assert!(acos(f32::NAN).is_nan());
        assert_eq!(acos_f64(-1.5), std::f64::consts::PI);
    }

    #[test]
    fn double_precision_agrees_with_std() {
        let mut random = Random::new(12);
        let near = |a: f64, b: f64| (a - b).abs() <= 4e-16 * b.abs().max(1e-3);
        for _ in 0..10_000 {
            let x = f64::from(random.range(-20.0, 20.0));
            let y = f64::from(random.range(0.001, 20.0));
            assert!(near(sin_f64(x), x.sin()) && near(cos_f64(x), x.cos()), "{x}");
            assert!(near(sin_cos_f64(x).0, x.sin()) && near(sin_cos_f64(x).1, x.cos()), "{x}");
            assert!(near(tan_f64(x / 20.0), (x / 20.0).tan()) && near(atan_f64(x), x.atan()), "{x}");
            assert!(near(asin_f64(x / 20.0), (x / 20.0).asin()) && near(acos_f64(x / 20.0), (x / 20.0).acos()), "{x}");
            assert!(
                near(atan2_f64(x, y), x.atan2(y)) && near(exp_f64(x), x.exp()) && near(ln_f64(y), y.ln()),
                "{x} {y}"
            );
            assert!(near(pow_f64(y, x / 4.0), y.powf(x / 4.0)) && near(cbrt_f64(x), x.cbrt()), "{x} {y}");
            assert!(sqrt_f64(y) == y.sqrt() && floor_f64(x) == x.floor());
        }
    }

    #[test]
    fn floors_have_the_bits_of_the_platforms() {
        let mut random = Random::new(14);
        let edges = [0.0, 0.5, 1.0, 1.5, 2.0, 1e-40, 8_388_607.5, 8_388_608.0, 8_388_609.0, 1e30];
        let edges = edges.into_iter().chain([f32::MIN_POSITIVE, f32::INFINITY, f32::NAN, f32::MAX]);
        let numbers = (0..10_000).map(|_| random.range(-4.0, 4.0)).chain((0..10_000).map(|i| (i - 5000) as f32 * 0.25));
        let mut more = Random::new(15);
        let bits = (0..100_000).map(|_| f32::from_bits(more.bits()));
        for x in edges.flat_map(|x| [x, -x, x.next_up(), -x.next_down()]).chain(numbers).chain(bits) {
            assert_eq!(floor(x).to_bits(), x.floor().to_bits(), "{x}");
            let wide = f64::from(x);
            assert_eq!(floor_f64(wide).to_bits(), wide.floor().to_bits(), "{x}");
        }
        for x in
            [4_503_599_627_370_495.5, 4_503_599_627_370_496.0, -4_503_599_627_370_495.5, 0.1_f64.next_down(), 1e300]
        {
            assert_eq!(floor_f64(x).to_bits(), x.floor().to_bits(), "{x}");
        }
    }

    /// Golden hashes: the results may not change on any platform or in any release.
    #[test]
    fn results_match_golden_hashes() {
        let mut random = Random::new(13);
        let (mut single, mut double) = (0u32, 0u32);
        for _ in 0..20_000 {
            let x = random.range(-30.0, 30.0);
            let (s, c) = sin_cos(x);
            let (t, k) = sin_cos_turns(x / 30.0);
            let p = x.abs() + 1e-3;
            let values = [s, c, t, k, tan(x), asin(x / 30.0), acos(x / 30.0), atan(x), atan2(x, s), exp(x), exp2(x)];
            for v in values.into_iter().chain([ln(p), log2(p), powf(p, 0.417), powf(p, 7.0)]) {
                single = crate::hash::combine(single, v.to_bits());
            }
            let (x, p) = (f64::from(x), f64::from(p));
            let values = [sin_f64(x), cos_f64(x), tan_f64(x), asin_f64(x / 30.0), acos_f64(x / 30.0), atan_f64(x)];
            for v in values.into_iter().chain([atan2_f64(x, p), exp_f64(x), ln_f64(p), pow_f64(p, 0.417), cbrt_f64(x)])
            {
                let bits = v.to_bits();
                double = crate::hash::combine(double, bits as u32 ^ (bits >> 32) as u32);
            }
        }
        assert_eq!((single, double), (3_829_229_568, 525_400_306));
    }
}
