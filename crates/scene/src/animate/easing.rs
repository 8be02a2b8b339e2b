//! Easing between two keys, as a cubic Bézier curve from (0, 0) to (1, 1) as in CSS (Easing
//! Functions Level 1, section 2.2).
//!
//! ```json
//! {"ease": "in_out"}
//! {"ease": [0.42, 0, 0.58, 1]}
//! ```

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bisection steps for the curve's parameter, sufficient for the precision of 64 bits.
const BISECTION_STEPS: u32 = 60;

/// Named easing between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Easing {
    /// Constant rate of change.
    #[default]
    Linear,
    /// Slow start: `[0.42, 0, 1, 1]`.
    In,
    /// Slow end: `[0, 0, 0.58, 1]`.
    Out,
    /// Slow start and end: `[0.42, 0, 0.58, 1]`.
    InOut,
    /// Holds the value of the earlier key until the next.
    Step,
}

/// Easing between two keys: a name, or the inner control points x1, y1, x2, y2 of a cubic Bézier
/// curve as in CSS. x (time) must be from 0 to 1; y (value) may leave this range to overshoot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Ease {
    /// Named easing.
    Named(Easing),
    /// Inner control points.
    Bezier([f64; 4]),
}

impl Default for Ease {
    fn default() -> Self {
        Self::Named(Easing::default())
    }
}

impl Ease {
    /// Whether the value is constant until the next key.
    pub fn is_step(&self) -> bool {
        *self == Self::Named(Easing::Step)
    }

    /// Error message if the control points are invalid.
    pub fn error(&self) -> Option<&'static str> {
        match self {
            Self::Bezier([x1, _, x2, _]) if !(0.0..=1.0).contains(x1) || !(0.0..=1.0).contains(x2) => {
                Some("x1 and x2 (the first and third numbers) must be between 0 and 1, since they are times")
            }
            _ => None,
        }
    }

    /// Fraction of the change of value at a fraction of the time between two keys.
    pub fn at(&self, share: f64) -> f64 {
        match self {
            Self::Named(Easing::Linear | Easing::Step) => share,
            Self::Named(Easing::In) => bezier([0.42, 0.0, 1.0, 1.0], share),
            Self::Named(Easing::Out) => bezier([0.0, 0.0, 0.58, 1.0], share),
            Self::Named(Easing::InOut) => bezier([0.42, 0.0, 0.58, 1.0], share),
            Self::Bezier(points) => bezier(*points, share),
        }
    }
}

/// Solves the curve for y at x. x increases monotonically along the curve.
fn bezier([x1, y1, x2, y2]: [f64; 4], x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    let bezier_coordinate = |a: f64, b: f64, s: f64| {
        let rest = 1.0 - s;
        s * (3.0 * rest * (rest * a + s * b) + s * s)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BISECTION_STEPS {
        let middle = 0.5 * (low + high);
        if bezier_coordinate(x1, x2, middle) < x { low = middle } else { high = middle }
    }
    bezier_coordinate(y1, y2, 0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMED: [Easing; 4] = [Easing::Linear, Easing::In, Easing::Out, Easing::InOut];

    /// Reference values, computed with 50 digits.
    #[test]
    fn easing_matches_reference_values_of_css() {
        for (easing, share, value) in [
            (Easing::In, 0.5, 0.315_356_813),
            (Easing::Out, 0.5, 0.684_643_187),
            (Easing::InOut, 0.5, 0.5),
            (Easing::In, 0.25, 0.093_464_659),
            (Easing::Linear, 0.3, 0.3),
        ] {
            let found = Ease::Named(easing).at(share);
            assert!((found - value).abs() < 1e-7, "{easing:?} {share}: {found}");
        }
        // "ease", the default of CSS.
        assert!((Ease::Bezier([0.25, 0.1, 0.25, 1.0]).at(0.5) - 0.802_403_388).abs() < 1e-7);
    }

    #[test]
    fn easing_curves_rise_from_0_to_1() {
        for ease in NAMED.map(Ease::Named).into_iter().chain([Ease::Bezier([1.0, 0.0, 0.0, 1.0])]) {
            assert_eq!((ease.at(0.0), ease.at(1.0)), (0.0, 1.0));
            let values: Vec<f64> = (0..=1000).map(|i| ease.at(f64::from(i) / 1000.0)).collect();
            assert!(values.is_sorted(), "{ease:?}");
            assert!(values.windows(2).all(|pair| pair[1] - pair[0] < 0.2), "{ease:?} leaps");
        }
    }

    #[test]
    fn in_and_out_mirror_each_other() {
        for i in 0..=20 {
            let x = f64::from(i) / 20.0;
            let (a, b) = (Ease::Named(Easing::In).at(x), Ease::Named(Easing::Out).at(1.0 - x));
            assert!((a + b - 1.0).abs() < 1e-12);
            assert!((Ease::Bezier([0.3, 0.3, 0.6, 0.6]).at(x) - x).abs() < 1e-12, "on the diagonal");
        }
    }

    #[test]
    fn bezier_control_points_may_exceed_the_unit_range_in_y_but_not_in_x() {
        let back = Ease::Bezier([0.5, -1.0, 0.5, 2.0]);
        assert!(back.at(0.2) < 0.0 && back.at(0.8) > 1.0 && back.error().is_none());
        assert!(Ease::Bezier([-0.1, 0.0, 0.5, 1.0]).error().is_some());
        assert!(Ease::Bezier([0.1, 0.0, 1.5, 1.0]).error().is_some());
    }
}
