//! A curve through points that is gone along at an even speed.
//!
//! Centripetal Catmull-Rom (Yuksel, Schaefer, Keyser 2011): the time between two points is the root of their distance, so
//! that the curve has neither cusps nor loops between them. Lengths are integrals of the speed by Gauss and Legendre's
//! rule over small pieces; the point at a length is found by halving within its piece.

use super::spline::{hermite, hermite_slope, tangent};
use juggler_expression::modulo;
use juggler_math::DVec3;

/// Pieces of each stretch between two points whose lengths are kept.
const PIECES: usize = 16;
/// Halvings within a piece.
const HALVINGS: u32 = 48;
/// Places and weights of the rule with five points on the interval from 0 to 1.
const RULE: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// The curve, and how long it is up to each of its pieces.
#[derive(Debug)]
pub struct Curve {
    stretches: Vec<Stretch>,
    /// The length where each piece begins, and at last the whole.
    lengths: Vec<f64>,
    closed: bool,
    start: DVec3,
}

/// The curve between two points.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    ends: [DVec3; 2],
    slopes: [DVec3; 2],
    duration: f64,
}

impl Curve {
    /// Through these points; nothing when there are none.
    pub fn through(mut points: Vec<DVec3>, closed: bool) -> Option<Self> {
        points.dedup();
        let start = *points.first()?;
        if closed && points.len() > 1 {
            // The way back to the first point is a stretch too, unless the last is the first.
            if points.last() != Some(&start) {
                points.push(start);
            }
        }
        let durations: Vec<f64> = points.windows(2).map(|pair| (pair[1] - pair[0]).length().sqrt()).collect();
        let chords: Vec<DVec3> =
            points.windows(2).zip(&durations).map(|(pair, duration)| (pair[1] - pair[0]) / *duration).collect();
        let slopes = slopes(&chords, &durations, closed);
        let stretches: Vec<Stretch> = points
            .windows(2)
            .zip(slopes.windows(2))
            .zip(&durations)
            .map(|((ends, slopes), duration)| Stretch {
                ends: [ends[0], ends[1]],
                slopes: [slopes[0], slopes[1]],
                duration: *duration,
            })
            .collect();
        let mut lengths = vec![0.0];
        for stretch in &stretches {
            for piece in 0..PIECES {
                let [from, to] = [piece, piece + 1].map(|piece| piece as f64 / PIECES as f64);
                let before = lengths.last().copied().unwrap_or_default();
                lengths.push(before + stretch.length(from, to));
            }
        }
        Some(Self { stretches, lengths, closed, start })
    }

    /// How long it is.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or_default()
    }

    /// The point where this share of its length has been gone. A closed curve begins anew, an open one is held at its
    /// ends.
    pub fn at(&self, share: f64) -> DVec3 {
        let share = if self.closed { modulo(share, 1.0) } else { share };
        let gone = if share.is_finite() { share.clamp(0.0, 1.0) * self.length() } else { 0.0 };
        if gone <= 0.0 {
            return self.start;
        }
        let piece = self.lengths.partition_point(|length| *length <= gone).saturating_sub(1);
        let piece = piece.min((self.stretches.len() * PIECES).saturating_sub(1));
        let Some(stretch) = self.stretches.get(piece / PIECES) else { return self.start };
        let begin = (piece % PIECES) as f64 / PIECES as f64;
        let rest = gone - self.lengths.get(piece).copied().unwrap_or_default();
        let (mut low, mut high) = (begin, begin + 1.0 / PIECES as f64);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if stretch.length(begin, middle) < rest { low = middle } else { high = middle }
        }
        stretch.point(0.5 * (low + high))
    }
}

/// The slope at each point: at the ends of an open curve that of the chord.
fn slopes(chords: &[DVec3], durations: &[f64], closed: bool) -> Vec<DVec3> {
    let count = chords.len();
    let at = |i: usize| {
        let before = if i > 0 { Some(i - 1) } else { closed.then(|| count.saturating_sub(1)) };
        let after = if i < count { Some(i) } else { closed.then_some(0) };
        let stretch = |i: usize| Some((*chords.get(i)?, *durations.get(i)?));
        match (before.and_then(stretch), after.and_then(stretch)) {
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

impl Stretch {
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
        RULE.iter().map(|(place, weight)| self.speed(from + width * place) * weight).sum::<f64>() * width
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
        Curve::through((0..count).map(point).collect(), true).unwrap()
    }

    #[test]
    fn a_circle_of_64_points_has_its_length_and_is_gone_along_evenly() {
        let circle = circle(64);
        assert!((circle.length() - 2.0 * TAU).abs() < 1e-4, "{}", circle.length());
        let points: Vec<DVec3> = (0..=1000).map(|i| circle.at(f64::from(i) / 1000.0)).collect();
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
    fn a_closed_one_repeats_and_an_open_one_stays_at_its_ends() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 3.0, 0.0), DVec3::new(-2.0, 1.0, 4.0)];
        let closed = Curve::through(points.clone(), true).unwrap();
        for share in [0.0, 0.2, 0.77] {
            for turns in [-3.0, 1.0, 8.0] {
                assert!(closed.at(share).distance(closed.at(share + turns)) < 1e-9);
            }
        }
        let open = Curve::through(points.clone(), false).unwrap();
        assert_eq!((open.at(-5.0), open.at(0.0)), (points[0], points[0]));
        assert!(open.at(1.0).distance(points[3]) < 1e-9 && open.at(1e300).distance(points[3]) < 1e-9);
    }

    #[test]
    fn it_goes_through_all_its_points_without_corners() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [-4.0, 2.0, 1.0]].map(DVec3::from);
        for closed in [false, true] {
            let curve = Curve::through(points.to_vec(), closed).unwrap();
            for point in points {
                let nearest = (0..=20_000).map(|i| curve.at(f64::from(i) / 20_000.0).distance(point));
                assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-3);
            }
            for (i, pair) in curve.stretches.windows(2).enumerate() {
                assert_eq!(pair[0].slopes[1], pair[1].slopes[0], "{i}");
            }
            let (first, last) = (curve.stretches[0], curve.stretches[curve.stretches.len() - 1]);
            assert_eq!(closed, first.slopes[0] == last.slopes[1]);
        }
    }

    #[test]
    fn straight_lines_stay_straight_and_odd_ones_are_sound() {
        let line = Curve::through(vec![DVec3::ZERO, DVec3::X, DVec3::X * 5.0], false).unwrap();
        assert!((line.length() - 5.0).abs() < 1e-9 && line.at(0.5).distance(DVec3::X * 2.5) < 1e-9);
        for (points, closed) in [(vec![DVec3::Y], true), (vec![DVec3::Y; 3], false), (vec![DVec3::Y; 3], true)] {
            let point = Curve::through(points, closed).unwrap();
            assert_eq!((point.at(0.3), point.at(-1.0), point.length()), (DVec3::Y, DVec3::Y, 0.0));
        }
        let there_and_back = Curve::through(vec![DVec3::ZERO, DVec3::X], true).unwrap();
        assert!((there_and_back.length() - 2.0).abs() < 1e-9);
        assert!(there_and_back.at(0.5).distance(DVec3::X) < 1e-6);
        assert!(Curve::through(Vec::new(), true).is_none());
        assert_eq!(line.at(f64::NAN), DVec3::ZERO);
    }
}
