//! Animation curves: keys with step, linear or cubic spline interpolation (glTF 2.0, section 3.11
//! and appendix C).
//!
//! Keys are in single precision, as in the file; evaluation is in double precision. Where two keys
//! have one time, the curve jumps: the earlier key ends the segment before, the later key counts at
//! that time.

use glam::{DQuat, DVec3};
use juggler_math::quaternion;
use std::array;

/// Cosine of half the angle between two rotations above which their quaternions are interpolated
/// linearly.
const NEARLY_EQUAL: f64 = 0.9995;

/// Largest deviation of a quaternion's length from 1 that needs no warning.
pub(super) const UNIT_TOLERANCE: f64 = 1e-3;

/// Interpolation between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Holds the value of the earlier key.
    Step,
    /// Linear interpolation, of rotations spherical linear interpolation along the shorter arc.
    #[default]
    Linear,
    /// Cubic Hermite spline: each key has an in-tangent, a value and an out-tangent; tangents are
    /// per second.
    CubicSpline,
}

/// Element of a key.
#[derive(Clone, Copy)]
enum Element {
    InTangent,
    Value,
    OutTangent,
}

impl Interpolation {
    /// Number of elements per key: 3 for a cubic spline, otherwise 1.
    pub fn elements_per_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }

    /// Position of an element in its key.
    fn position(self, element: Element) -> usize {
        match (self, element) {
            (Self::CubicSpline, Element::Value) => 1,
            (Self::CubicSpline, Element::OutTangent) => 2,
            _ => 0,
        }
    }
}

/// Error of the keys of a curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// There are no keys.
    #[error("there are no keys; a curve needs at least one")]
    NoKeys,
    /// The time of a key is less than that of the key before it.
    #[error("key {key} is at {time} s, after a key at {previous} s; times must rise")]
    Falling {
        /// Index of the later key.
        key: usize,
        /// Its time in seconds.
        time: f32,
        /// Time of the key before it.
        previous: f32,
    },
    /// A time is infinite or not a number.
    #[error("the time of key {key} is {time}; times must be finite")]
    Time {
        /// Index of the key.
        key: usize,
        /// Its time.
        time: f32,
    },
    /// The number of values does not fit the number of keys.
    #[error("there are {found} numbers for {keys} keys, which need {expected}")]
    Count {
        /// Number of keys.
        keys: usize,
        /// Number of numbers found.
        found: usize,
        /// Number of numbers needed.
        expected: usize,
    },
    /// A value or tangent is infinite or not a number.
    #[error("key {key} contains {value}; values and tangents must be finite")]
    Value {
        /// Index of the key.
        key: usize,
        /// The number.
        value: f32,
    },
    /// A rotation is the zero quaternion.
    #[error("the quaternion of key {key} is 0 0 0 0, which is no rotation")]
    ZeroRotation {
        /// Index of the key.
        key: usize,
    },
}

/// A function of time given by keys: one or more numbers at each key, constant before the first and
/// after the last key.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Times in seconds, which do not fall; at least one.
    times: Vec<f32>,
    /// Elements of all keys, `components` numbers each.
    values: Vec<f32>,
    components: usize,
    interpolation: Interpolation,
}

/// Two neighboring keys with a parameter between them.
struct Segment {
    from: usize,
    to: usize,
    /// Parameter, 0 at `from` and below 1.
    fraction: f64,
    /// Time between the keys in seconds.
    duration: f64,
}

impl Curve {
    /// Constructs a curve of `components` numbers. `values` lists the keys in the order of their
    /// times, and for each key of a cubic spline its in-tangent, value and out-tangent.
    pub fn new(
        times: Vec<f32>,
        values: Vec<f32>,
        components: usize,
        interpolation: Interpolation,
    ) -> Result<Self, CurveError> {
        if times.is_empty() {
            return Err(CurveError::NoKeys);
        }
        check_times(&times)?;
        let numbers_per_key = components.saturating_mul(interpolation.elements_per_key());
        let expected = times.len().saturating_mul(numbers_per_key);
        if values.len() != expected {
            return Err(CurveError::Count { keys: times.len(), found: values.len(), expected });
        }
        if let Some((index, value)) = values.iter().copied().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(CurveError::Value { key: index / numbers_per_key.max(1), value });
        }
        Ok(Self { times, values, components, interpolation })
    }

    /// Checks that the curve consists of quaternions other than 0.
    pub fn check_rotations(&self) -> Result<(), CurveError> {
        let is_zero = |key: &usize| self.key(*key) == [0.0; 4];
        let zero = (0..self.times.len()).find(is_zero);
        zero.map_or(Ok(()), |key| Err(CurveError::ZeroRotation { key }))
    }

    /// Number of quaternions whose length deviates from 1 by more than 1e-3. Evaluation normalizes
    /// them.
    pub fn unnormalized_rotations(&self) -> usize {
        let length = |key| self.key::<4>(key).iter().map(|number| number * number).sum::<f64>().sqrt();
        (0..self.times.len()).filter(|key| (length(*key) - 1.0).abs() > UNIT_TOLERANCE).count()
    }

    /// Number of keys that have the time of the key before them.
    pub fn equal_keys(&self) -> usize {
        self.times.windows(2).filter(|pair| matches!(pair, [a, b] if a == b)).count()
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.components
    }

    /// Interpolation between the keys.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// Time of the first key in seconds.
    pub fn first_time(&self) -> f64 {
        self.times.first().copied().map_or(0.0, f64::from)
    }

    /// Time of the last key in seconds.
    pub fn last_time(&self) -> f64 {
        self.times.last().copied().map_or(0.0, f64::from)
    }

    /// Numbers at a time in seconds, each interpolated by itself.
    pub fn evaluate(&self, seconds: f64) -> Vec<f64> {
        let segment = self.segment(seconds);
        (0..self.components).map(|component| self.interpolate(&segment, component)).collect()
    }

    /// Vector at a time in seconds: the first three components, of which missing ones are 0.
    pub fn vector(&self, seconds: f64) -> DVec3 {
        let segment = self.segment(seconds);
        DVec3::from_array(array::from_fn(|component| self.interpolate(&segment, component)))
    }

    /// Rotation at a time in seconds. Linear interpolation follows the shorter arc at constant
    /// angular speed; between nearly equal rotations it interpolates quaternions linearly. Cubic
    /// splines interpolate quaternions. The result is normalized. `None` for a zero quaternion.
    pub fn rotation(&self, seconds: f64) -> Option<DQuat> {
        let segment = self.segment(seconds);
        let key = quaternion::normalized(self.key(segment.from));
        if self.interpolation == Interpolation::Linear && segment.fraction > 0.0 {
            return Some(interpolate_rotations(key?, quaternion::normalized(self.key(segment.to))?, segment.fraction));
        }
        // A spline may pass through the zero quaternion; the earlier key replaces it.
        quaternion::normalized(array::from_fn(|component| self.interpolate(&segment, component))).or(key)
    }

    /// Whether the first component of the last key up to a time is not 0, with any interpolation.
    pub fn is_on(&self, seconds: f64) -> bool {
        self.number(self.segment(seconds).from, Element::Value, 0) != 0.0
    }

    /// Last key up to a time, and the next key.
    fn segment(&self, seconds: f64) -> Segment {
        // Clamp by `max` and `min`, which replace NaN by the first time.
        let seconds = seconds.max(self.first_time()).min(self.last_time());
        let from = self.times.partition_point(|time| f64::from(*time) <= seconds).saturating_sub(1);
        let to = from.saturating_add(1);
        match (self.times.get(from).copied(), self.times.get(to).copied()) {
            (Some(start), Some(end)) if start < end => {
                let (start, end) = (f64::from(start), f64::from(end));
                let duration = end - start;
                Segment { from, to, fraction: (seconds - start) / duration, duration }
            }
            _ => Segment { from, to: from, fraction: 0.0, duration: 0.0 },
        }
    }

    /// Number of an element of a key; 0 beyond the curve's components.
    fn number(&self, key: usize, element: Element, component: usize) -> f64 {
        if component >= self.components {
            return 0.0;
        }
        let position = key * self.interpolation.elements_per_key() + self.interpolation.position(element);
        self.values.get(position * self.components + component).copied().map_or(0.0, f64::from)
    }

    /// Value of a key.
    fn key<const COMPONENTS: usize>(&self, key: usize) -> [f64; COMPONENTS] {
        array::from_fn(|component| self.number(key, Element::Value, component))
    }

    fn interpolate(&self, segment: &Segment, component: usize) -> f64 {
        let Segment { from, to, fraction, duration } = *segment;
        let v0 = self.number(from, Element::Value, component);
        if fraction == 0.0 {
            return v0;
        }
        let v1 = self.number(to, Element::Value, component);
        match self.interpolation {
            Interpolation::Step => v0,
            Interpolation::Linear => v0 + (v1 - v0) * fraction,
            Interpolation::CubicSpline => {
                let b0 = self.number(from, Element::OutTangent, component);
                let a1 = self.number(to, Element::InTangent, component);
                hermite([v0, b0 * duration], [v1, a1 * duration], fraction)
            }
        }
    }
}

fn check_times(times: &[f32]) -> Result<(), CurveError> {
    if let Some((key, time)) = times.iter().copied().enumerate().find(|(_, time)| !time.is_finite()) {
        return Err(CurveError::Time { key, time });
    }
    let falling = times.iter().zip(times.iter().skip(1)).position(|(previous, time)| time < previous);
    match falling.and_then(|key| Some((key, *times.get(key)?, *times.get(key + 1)?))) {
        Some((key, previous, time)) => Err(CurveError::Falling { key: key + 1, time, previous }),
        None => Ok(()),
    }
}

/// Cubic Hermite spline between two values with derivatives by the parameter s, 0 to 1 (glTF 2.0,
/// appendix C.5).
fn hermite([v0, d0]: [f64; 2], [v1, d1]: [f64; 2], s: f64) -> f64 {
    let (s2, s3) = (s * s, s * s * s);
    (2.0 * s3 - 3.0 * s2 + 1.0) * v0 + (s3 - 2.0 * s2 + s) * d0 + (-2.0 * s3 + 3.0 * s2) * v1 + (s3 - s2) * d1
}

/// Interpolates two unit quaternions along the shorter arc (glTF 2.0, appendix C.4).
fn interpolate_rotations(from: DQuat, to: DQuat, fraction: f64) -> DQuat {
    let cosine = from.dot(to);
    if cosine.abs() <= NEARLY_EQUAL {
        return quaternion::slerp(from, to, fraction);
    }
    let to = if cosine < 0.0 { -to } else { to };
    let between = from * (1.0 - fraction) + to * fraction;
    quaternion::normalized(between.to_array()).unwrap_or(from)
}

#[cfg(test)]
mod tests;
