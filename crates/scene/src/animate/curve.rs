//! Spline through points, parameterized by arc length.
//!
//! Centripetal Catmull-Rom spline (Yuksel, Schaefer and Keyser 2011): the parameter interval
//! between two points is the square root of their distance, so segments have neither cusps nor
//! self-intersections. Gauss-Legendre quadrature over small pieces integrates the arc length;
//! bisection within a piece finds the point at an arc length.

use super::spline::{hermite, hermite_slope, tangent};
use juggler_expression::modulo;
use juggler_math::DVec3;

/// Pieces per segment with tabulated arc length.
const PIECES: usize = 16;
/// Bisection steps within a piece.
const BISECTION_STEPS: u32 = 48;
/// Nodes and weights of five-point Gauss-Legendre quadrature on the interval from 0 to 1.
const GAUSS_LEGENDRE: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Spline with tabulated arc length.
#[derive(Debug)]
pub struct Curve {
    segments: Vec<Segment>,
    /// Arc length at the start of each piece, followed by the total length.
    lengths: Vec<f64>,
    closed: bool,
    start: DVec3,
}

/// Cubic segment between two points.
#[derive(Clone, Copy, Debug)]
struct Segment {
    ends: [DVec3; 2],
    slopes: [DVec3; 2],
    duration: f64,
}

impl Curve {
    /// Creates the spline through points; `None` without points.
    pub fn from_points(mut points: Vec<DVec3>, closed: bool) -> Option<Self> {
        points.dedup();
        let start = *points.first()?;
        if closed && points.len() > 1 {
            // Add the segment to the first point, unless the last point equals it.
            if points.last() != Some(&start) {
                points.push(start);
            }
        }
        let durations: Vec<f64> = points.windows(2).map(|pair| (pair[1] - pair[0]).length().sqrt()).collect();
        let chords: Vec<DVec3> =
            points.windows(2).zip(&durations).map(|(pair, duration)| (pair[1] - pair[0]) / *duration).collect();
        let slopes = slopes(&chords, &durations, closed);
        let segments: Vec<Segment> = points
            .windows(2)
            .zip(slopes.windows(2))
            .zip(&durations)
            .map(|((ends, slopes), duration)| Segment {
                ends: [ends[0], ends[1]],
                slopes: [slopes[0], slopes[1]],
                duration: *duration,
            })
            .collect();
        let mut lengths = vec![0.0];
        for segment in &segments {
            for piece in 0..PIECES {
                let [from, to] = [piece, piece + 1].map(|piece| piece as f64 / PIECES as f64);
                let before = lengths.last().copied().unwrap_or_default();
                lengths.push(before + segment.length(from, to));
            }
        }
        Some(Self { segments, lengths, closed, start })
    }

    /// Total arc length.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or_default()
    }

    /// Point at a fraction of the arc length. A closed curve wraps around; an open curve stays at
    /// its ends.
    pub fn point_at(&self, fraction: f64) -> DVec3 {
        let fraction = if self.closed { modulo(fraction, 1.0) } else { fraction };
        let distance = if fraction.is_finite() { fraction.clamp(0.0, 1.0) * self.length() } else { 0.0 };
        if distance <= 0.0 {
            return self.start;
        }
        let piece = self.lengths.partition_point(|length| *length <= distance).saturating_sub(1);
        let piece = piece.min((self.segments.len() * PIECES).saturating_sub(1));
        let Some(segment) = self.segments.get(piece / PIECES) else { return self.start };
        let begin = (piece % PIECES) as f64 / PIECES as f64;
        let remainder = distance - self.lengths.get(piece).copied().unwrap_or_default();
        let (mut low, mut high) = (begin, begin + 1.0 / PIECES as f64);
        for _ in 0..BISECTION_STEPS {
            let middle = 0.5 * (low + high);
            if segment.length(begin, middle) < remainder { low = middle } else { high = middle }
        }
        segment.point(0.5 * (low + high))
    }
}

/// Slope at each point. At the ends of an open curve, the slope is that of the chord.
fn slopes(chords: &[DVec3], durations: &[f64], closed: bool) -> Vec<DVec3> {
    let count = chords.len();
    let at = |i: usize| {
        let before = if i > 0 { Some(i - 1) } else { closed.then(|| count.saturating_sub(1)) };
        let after = if i < count { Some(i) } else { closed.then_some(0) };
        let segment = |i: usize| Some((*chords.get(i)?, *durations.get(i)?));
        match (before.and_then(segment), after.and_then(segment)) {
            (Some((a, before)), Some((b, after))) => {
                let component = |k: usize| tangent([a[k], b[k]], [before, after]);
                DVec3::new(component(0), component(1), component(2))
            }
            (Some((chord, _)), None) | (None, Some((chord, _))) => chord,
            (None, None) => DVec3::ZERO,
        }
    };
    (0..=count).map(at).collect()
}

impl Segment {
    fn each(&self, f: impl Fn([f64; 2], [f64; 2]) -> f64) -> DVec3 {
        let ([a, b], [from, to]) = (self.ends, self.slopes);
        let component = |k: usize| f([a[k], b[k]], [from[k], to[k]]);
        DVec3::new(component(0), component(1), component(2))
    }

    fn point(&self, u: f64) -> DVec3 {
        self.each(|ends, slopes| hermite(ends, slopes, self.duration, u))
    }

    fn speed(&self, u: f64) -> f64 {
        self.duration * self.each(|ends, slopes| hermite_slope(ends, slopes, self.duration, u)).length()
    }

    fn length(&self, from: f64, to: f64) -> f64 {
        let width = to - from;
        GAUSS_LEGENDRE.iter().map(|(place, weight)| self.speed(from + width * place) * weight).sum::<f64>() * width
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn circle(count: u32) -> Curve {
        let point = |i: u32| {
            let angle = TAU * f64::from(i) / f64::from(count);
            DVec3::new(2.0 * angle.cos(), 5.0, 2.0 * angle.sin())
        };
        Curve::from_points((0..count).map(point).collect(), true).unwrap()
    }

    #[test]
    fn circle_through_64_points_has_its_length_and_constant_speed() {
        let circle = circle(64);
        assert!((circle.length() - 2.0 * TAU).abs() < 1e-4, "{}", circle.length());
        let points: Vec<DVec3> = (0..=1000).map(|i| circle.point_at(f64::from(i) / 1000.0)).collect();
        let steps: Vec<f64> = points.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
        for step in &steps {
            assert!((step / (circle.length() / 1000.0) - 1.0).abs() < 1e-5, "{step}");
        }
        for (i, point) in points.iter().enumerate() {
            let angle = TAU * i as f64 / 1000.0;
            assert!(point.distance(DVec3::new(2.0 * angle.cos(), 5.0, 2.0 * angle.sin())) < 1e-4);
        }
    }

    #[test]
    fn closed_curve_repeats_and_open_curve_clamps() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 3.0, 0.0), DVec3::new(-2.0, 1.0, 4.0)];
        let closed = Curve::from_points(points.clone(), true).unwrap();
        for fraction in [0.0, 0.2, 0.77] {
            for turns in [-3.0, 1.0, 8.0] {
                assert!(closed.point_at(fraction).distance(closed.point_at(fraction + turns)) < 1e-9);
            }
        }
        let open = Curve::from_points(points.clone(), false).unwrap();
        assert_eq!((open.point_at(-5.0), open.point_at(0.0)), (points[0], points[0]));
        assert!(open.point_at(1.0).distance(points[3]) < 1e-9 && open.point_at(1e300).distance(points[3]) < 1e-9);
    }

    #[test]
    fn curve_interpolates_its_points_with_continuous_tangents() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [-4.0, 2.0, 1.0]].map(DVec3::from);
        for closed in [false, true] {
            let curve = Curve::from_points(points.to_vec(), closed).unwrap();
            for point in points {
                let nearest = (0..=20_000).map(|i| curve.point_at(f64::from(i) / 20_000.0).distance(point));
                assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-3);
            }
            for (i, pair) in curve.segments.windows(2).enumerate() {
                assert_eq!(pair[0].slopes[1], pair[1].slopes[0], "{i}");
            }
            let (first, last) = (curve.segments[0], curve.segments[curve.segments.len() - 1]);
            assert_eq!(closed, first.slopes[0] == last.slopes[1]);
        }
    }

    #[test]
    fn collinear_points_give_a_line_and_degenerate_curves_are_valid() {
        let line = Curve::from_points(vec![DVec3::ZERO, DVec3::X, DVec3::X * 5.0], false).unwrap();
        assert!((line.length() - 5.0).abs() < 1e-9 && line.point_at(0.5).distance(DVec3::X * 2.5) < 1e-9);
        for (points, closed) in [(vec![DVec3::Y], true), (vec![DVec3::Y; 3], false), (vec![DVec3::Y; 3], true)] {
            let point = Curve::from_points(points, closed).unwrap();
            assert_eq!((point.point_at(0.3), point.point_at(-1.0), point.length()), (DVec3::Y, DVec3::Y, 0.0));
        }
        let there_and_back = Curve::from_points(vec![DVec3::ZERO, DVec3::X], true).unwrap();
        assert!((there_and_back.length() - 2.0).abs() < 1e-9);
        assert!(there_and_back.point_at(0.5).distance(DVec3::X) < 1e-6);
        assert!(Curve::from_points(Vec::new(), true).is_none());
        assert_eq!(line.point_at(f64::NAN), DVec3::ZERO);
    }
}
