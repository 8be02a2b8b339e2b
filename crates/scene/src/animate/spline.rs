//! Catmull-Rom splines through values at uneven times (Catmull and Rom 1974; Barry and Goldman
//! 1988), as cubic Hermite segments: the slope at a value is that of the parabola through the value
//! and its two neighbors.

/// Slope at a value between two segments of durations `before` and `after`, from the slopes of
/// their chords.
pub fn tangent([slope_before, slope_after]: [f64; 2], [before, after]: [f64; 2]) -> f64 {
    (slope_before * after + slope_after * before) / (before + after)
}

/// Cubic Hermite segment from `a` to `b` with the slopes `slope_a` and `slope_b` and the duration
/// `length`, at the parameter `u` from 0 to 1.
pub fn hermite([a, b]: [f64; 2], [slope_a, slope_b]: [f64; 2], length: f64, u: f64) -> f64 {
    let rest = 1.0 - u;
    let bend = (slope_a * length - (b - a)) * rest - (slope_b * length - (b - a)) * u;
    a * rest + b * u + u * rest * bend
}

/// Derivative of [`hermite`] with respect to time.
pub fn hermite_slope([a, b]: [f64; 2], [slope_a, slope_b]: [f64; 2], length: f64, u: f64) -> f64 {
    let rest = 1.0 - u;
    let chord = (b - a) / length;
    6.0 * u * rest * chord + rest * (1.0 - 3.0 * u) * slope_a + u * (3.0 * u - 2.0) * slope_b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_and_their_slopes_are_interpolated() {
        let (ends, slopes, length) = ([3.0, -1.0], [0.5, -2.0], 4.0);
        let at = |u: f64| hermite(ends, slopes, length, u);
        assert_eq!((at(0.0), at(1.0)), (3.0, -1.0));
        for (u, slope) in [(0.0, 0.5), (1.0, -2.0), (0.3, hermite_slope(ends, slopes, length, 0.3))] {
            let measured = (at(u + 1e-6) - at(u - 1e-6)) / (2e-6 * length);
            assert!((measured - slope).abs() < 1e-6, "{measured} {slope}");
            assert!((hermite_slope(ends, slopes, length, u) - slope).abs() < 1e-12);
        }
    }

    /// The tangent of a parabola through three values at uneven times is exact.
    #[test]
    fn parabolas_keep_their_slope() {
        let parabola = |t: f64| 2.0 * t * t - 3.0 * t + 1.0;
        let (t0, t1, t2) = (0.0, 1.0, 3.5);
        let slope = |a: f64, b: f64| (parabola(b) - parabola(a)) / (b - a);
        let tangent = tangent([slope(t0, t1), slope(t1, t2)], [t1 - t0, t2 - t1]);
        assert!((tangent - (4.0 * t1 - 3.0)).abs() < 1e-12);
    }
}
