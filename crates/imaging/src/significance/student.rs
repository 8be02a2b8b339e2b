//! Student's t distribution.

use juggler_math::portable;

/// Maximum number of steps of the continued fraction.
const MAX_STEPS: u32 = 10_000;
/// Relative change at which the continued fraction has converged.
const TOLERANCE: f64 = 1e-14;
/// Replaces zero denominators.
const TINY: f64 = 1e-300;

/// Two-sided p-value: probability that |T| is at least |`t`|, for `degrees_of_freedom` >= 1 degrees
/// of freedom.
pub fn two_sided(t: f64, degrees_of_freedom: f64) -> f64 {
    incomplete_beta(
        degrees_of_freedom / 2.0,
        0.5,
        degrees_of_freedom / (degrees_of_freedom + t * t),
        t * t / (degrees_of_freedom + t * t),
    )
}

/// Regularized incomplete beta function I_x(a, b), with `rest` = 1 - x, by the continued fraction
/// of Abramowitz and Stegun (1964, 26.5.8) or its complement, whichever converges faster.
fn incomplete_beta(a: f64, b: f64, x: f64, rest: f64) -> f64 {
    if x <= 0.0 || rest <= 0.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    let front = ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * portable::ln_f64(x) + b * portable::ln_f64(rest);
    let front = portable::exp_f64(front);
    let share = if x < (a + 1.0) / (a + b + 2.0) {
        front * continued_fraction(a, b, x) / a
    } else {
        1.0 - front * continued_fraction(b, a, rest) / b
    };
    share.clamp(0.0, 1.0)
}

/// Evaluates the continued fraction 1 / (1 + d1 / (1 + d2 / ...)) forward (Lentz 1976).
fn continued_fraction(a: f64, b: f64, x: f64) -> f64 {
    let safe = |value: f64| if value.abs() < TINY { TINY } else { value };
    let (mut c, mut d) = (1.0, 1.0 / safe(1.0 - (a + b) * x / (a + 1.0)));
    let mut value = d;
    for step in 1..MAX_STEPS {
        let m = f64::from(step);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let before = value;
        for term in [even, odd] {
            d = 1.0 / safe(1.0 + term * d);
            c = safe(1.0 + term / c);
            value *= c * d;
        }
        if (value / before - 1.0).abs() < TOLERANCE {
            break;
        }
    }
    value
}

/// ln Γ(x) for x > 0: recurrence up to x >= 10, then Stirling's series with an error below 1e-14.
fn ln_gamma(mut x: f64) -> f64 {
    let mut product = 1.0;
    while x < 10.0 {
        product *= x;
        x += 1.0;
    }
    let square = 1.0 / (x * x);
    let series =
        1.0 / 12.0 - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square * (1.0 / 1680.0 - square / 1188.0)));
    (x - 0.5) * portable::ln_f64(x) - x + 0.5 * portable::ln_f64(std::f64::consts::TAU) + series / x
        - portable::ln_f64(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn student_distribution_matches_tables_and_closed_forms() {
        // Table of two-sided quantiles at 5 %, 1 % and 0.1 %.
        let table = [
            (12.706_204_736, 1.0, 0.05),
            (4.302_652_730, 2.0, 0.05),
            (63.656_741_16, 1.0, 0.01),
            (3.169_272_673, 10.0, 0.01),
            (3.645_958_635, 30.0, 0.001),
            (1.959_963_985, 1e6, 0.05),
            (4.891_638_476, 1e6, 1e-6),
        ];
        for (t, degrees_of_freedom, p) in table {
            let found = two_sided(t, degrees_of_freedom);
            assert!((found / p - 1.0).abs() < 2e-4, "{t} {degrees_of_freedom}: {found} instead of {p}");
            assert_eq!(found, two_sided(-t, degrees_of_freedom));
        }
        // One degree of freedom (Cauchy): 1 - 2 atan(t) / π. Two degrees: 1 - t / √(2 + t²).
        for t in [0.01f64, 0.5, 1.0, 3.0, 40.0] {
            assert!((two_sided(t, 1.0) - (1.0 - 2.0 * t.atan() / std::f64::consts::PI)).abs() < 1e-12);
            assert!((two_sided(t, 2.0) - (1.0 - t / (2.0 + t * t).sqrt())).abs() < 1e-12);
        }
        assert_eq!((two_sided(0.0, 5.0), two_sided(1e200, 1e6)), (1.0, 0.0));
        assert!(two_sided(256.0, 255.0) < 1e-200);
    }

    #[test]
    fn log_gamma_matches_factorials_and_half_integers() {
        let factorials = [(1.0, 1.0), (2.0, 1.0), (5.0, 24.0), (11.0, 3_628_800.0), (0.5, std::f64::consts::PI.sqrt())];
        for (x, gamma) in factorials {
            assert!((ln_gamma(x) - f64::ln(gamma)).abs() < 1e-12, "{x}");
        }
    }
}
