//! Animated transforms while the shutter is open.
//!
//! Time runs from 0 (shutter opens) to 1 (shutter closes). Keys stand at equal intervals, and every
//! point moves in a straight line between them. [`Motion::smoothed`] approximates rotations by more
//! keys, found by polar decomposition. If the motion between keys turns about a center that stays,
//! the origin follows the arc about that center (a screw motion, Chasles 1830).

use crate::polar::{self, PolarDecomposition};
use crate::{Aabb, Ray, Transform, Vec3};
use glam::Mat3;
use std::borrow::Cow;
use std::sync::Arc;

/// Maximum rotation between two keys, in radians. The sagitta of the chord is at most 1.2e-4 of the
/// radius.
pub const STEP_RADIANS: f64 = 1.0 / 32.0;
/// Maximum number of keys after smoothing.
const MAX_KEYS: usize = 4097;
/// Maximum deviation from linear interpolation of a key that is dropped, relative to the object's
/// size.
const TOLERANCE: f32 = 2e-4;

/// Object-to-world transform as a function of shutter time: 24 bytes, since a world has millions.
/// Still motions may share their linear part, which [`Motion::sharing`] arranges.
#[derive(Clone, Debug)]
pub enum Motion {
    /// The same translation at all times.
    Translation(Vec3),
    /// The same transform at all times: that of its linear part, with another translation.
    Still(Vec3, Arc<Transform>),
    /// At least two keys at equal intervals from 0 to 1; matrices are interpolated linearly.
    Moving(Arc<[Transform]>),
}

impl From<Transform> for Motion {
    fn from(transform: Transform) -> Self {
        let (origin, linear) = (transform.origin(), transform.with_translation(Vec3::ZERO));
        if linear.has_bits_of(&Transform::IDENTITY) {
            Self::Translation(origin)
        } else {
            Self::Still(origin, Arc::new(linear))
        }
    }
}

impl PartialEq for Motion {
    fn eq(&self, other: &Self) -> bool {
        *self.keys() == *other.keys()
    }
}

impl Motion {
    /// Constructs a motion from keys at equal intervals; still if all are equal, `None` if there are
    /// none.
    pub fn from_keys(keys: Vec<Transform>) -> Option<Self> {
        let first = *keys.first()?;
        let moves = keys.iter().any(|key| *key != first);
        Some(if moves { Self::Moving(keys.into()) } else { first.into() })
    }

    /// Keys; one if nothing moves.
    pub fn keys(&self) -> Cow<'_, [Transform]> {
        match self {
            Self::Moving(keys) => Cow::Borrowed(keys),
            still => Cow::Owned(vec![still.at(0.0)]),
        }
    }

    /// The transform, if it is the same at all times.
    #[inline]
    pub fn still(&self) -> Option<Transform> {
        (!self.moves()).then(|| self.at(0.0))
    }

    fn key_count(&self) -> usize {
        if let Self::Moving(keys) = self { keys.len() } else { 1 }
    }

    /// Whether the transform is the identity at all times.
    pub fn is_identity(&self) -> bool {
        self.still() == Some(Transform::IDENTITY)
    }

    /// Stores the linear part together with that of `other` if both are still and equal.
    #[must_use]
    pub fn sharing(self, other: &Self) -> Self {
        match (self, other) {
            (Self::Still(origin, linear), Self::Still(_, shared)) if linear.has_bits_of(shared) => {
                Self::Still(origin, Arc::clone(shared))
            }
            (motion, _) => motion,
        }
    }

    /// Whether the transform changes with time.
    pub fn moves(&self) -> bool {
        matches!(self, Self::Moving(_))
    }

    /// Transforms a ray to object space at the time of the ray.
    #[inline(always)]
    pub fn ray_to_local(&self, ray: &Ray) -> Ray {
        match self {
            Self::Still(origin, linear) => Ray {
                origin: linear.vector_to_local(ray.origin - *origin),
                direction: linear.vector_to_local(ray.direction),
                ..*ray
            },
            Self::Translation(origin) => Transform::translation(*origin).ray_to_local(ray),
            moving => moving.moving_ray_to_local(ray),
        }
    }

    /// Kept out of line, since motion is rare.
    #[inline(never)]
    fn moving_ray_to_local(&self, ray: &Ray) -> Ray {
        self.at(ray.time).ray_to_local(ray)
    }

    /// Transform at a time, which is clamped to 0 to 1.
    #[inline]
    pub fn at(&self, time: f32) -> Transform {
        match self {
            Self::Translation(origin) => Transform::translation(*origin),
            Self::Still(origin, linear) => linear.with_translation(*origin),
            Self::Moving(keys) => {
                let (key, fraction) = key_interval(keys.len(), time);
                keys[key].lerp(&keys[key + 1], fraction)
            }
        }
    }

    /// Composition at each time: applies `self` first, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        if let (Some(first), Some(next)) = (self.still(), next.still()) {
            return first.then(&next).into();
        }
        let count = self.key_count().max(next.key_count());
        let at = |motion: &Self, key: usize| match motion {
            Self::Moving(keys) if keys.len() == count => keys[key],
            other => other.at(key as f32 / (count - 1) as f32),
        };
        Self::Moving((0..count).map(|key| at(self, key).then(&at(next, key))).collect())
    }

    /// Bounds of a local box over the whole shutter interval.
    pub fn aabb(&self, local: &Aabb) -> Aabb {
        let Self::Moving(keys) = self else { return self.at(0.0).aabb(local) };
        // Points move on straight lines, so the union of the keys' boxes bounds the motion up to
        // rounding.
        let all = keys.iter().map(|key| key.aabb(local)).fold(Aabb::EMPTY, Aabb::union);
        let size = all.min.abs().max(all.max.abs()).max_element();
        if all.is_finite() && !all.is_empty() { all.grown(8.0 * f32::EPSILON * size) } else { all }
    }

    /// Bounds of a local box from one time to a later one.
    pub fn aabb_between(&self, local: &Aabb, from: f32, to: f32) -> Aabb {
        let Self::Moving(keys) = self else { return self.aabb(local) };
        let last = (keys.len() - 1) as f32;
        let [first, end] = [(from * last).floor() as usize + 1, (to * last).ceil() as usize];
        let inner = keys.get(first..end.min(keys.len())).unwrap_or_default().iter().map(|key| key.aabb(local));
        let ends = self.at(from).aabb(local).union(self.at(to).aabb(local));
        let all = inner.fold(ends, Aabb::union);
        let size = all.min.abs().max(all.max.abs()).max_element();
        if all.is_finite() && !all.is_empty() { all.grown(8.0 * f32::EPSILON * size) } else { all }
    }

    /// Resamples the motion: adds keys where it rotates, drops keys where linear interpolation
    /// suffices. `size` is the object's size in world space.
    #[must_use]
    pub fn smoothed(self, size: f32) -> Self {
        let Self::Moving(keys) = &self else { return self };
        let parts: Option<Vec<PolarDecomposition>> = keys.iter().map(PolarDecomposition::from_transform).collect();
        let Some(parts) = parts else { return self };
        let rotation = parts.windows(2).map(|pair| pair[0].angle_to(&pair[1])).fold(0.0, f64::max);
        let steps = (rotation / STEP_RADIANS).ceil().clamp(1.0, (MAX_KEYS / keys.len()).max(1) as f64) as usize;
        if steps == 1 {
            let straight = |at: &_, before: &_, after: &_| is_between(at, before, after, size);
            return Self::Moving(without_redundant_keys(keys.to_vec(), straight).into());
        }
        let mut round = Vec::with_capacity(steps * (keys.len() - 1) + 1);
        let centers = polar::lasting_centers(&parts);
        for ((pair, ends), center) in parts.windows(2).zip(keys.windows(2)).zip(centers) {
            round.push(ends[0]);
            for step in 1..steps {
                let between = pair[0].lerp(&pair[1], center, step as f64 / steps as f64).transform();
                round.push(between.unwrap_or(ends[0]));
            }
        }
        round.extend(keys.last());
        Self::Moving(round.into())
    }
}

/// Index of the key before `time` and the fraction of the interval to the next key. `keys` is the
/// number of keys at equal intervals, at least 2.
#[inline]
pub fn key_interval(keys: usize, time: f32) -> (usize, f32) {
    let last = keys - 1;
    let place = time.clamp(0.0, 1.0) * last as f32;
    let key = (place as usize).min(last - 1);
    (key, place - key as f32)
}

/// Halves the number of keys at equal intervals while `straight(key, before, after)` accepts each
/// dropped key as an interpolation of its neighbors.
pub fn without_redundant_keys<T>(mut keys: Vec<T>, straight: impl Fn(&T, &T, &T) -> bool) -> Vec<T> {
    while keys.len() > 2 && keys.len() % 2 == 1 {
        if !keys.windows(3).step_by(2).all(|three| straight(&three[1], &three[0], &three[2])) {
            break;
        }
        keys = keys.into_iter().step_by(2).collect();
    }
    keys
}

/// Whether the midpoint of `before` and `after` approximates `at` for an object of this size.
fn is_between(at: &Transform, before: &Transform, after: &Transform, size: f32) -> bool {
    let largest = |matrix: Mat3| matrix.to_cols_array().iter().fold(0.0, |largest: f32, v| v.abs().max(largest));
    let middle = before.lerp(after, 0.5);
    (middle.origin() - at.origin()).length() <= TOLERANCE * size
        && largest(middle.matrix() - at.matrix()) <= TOLERANCE * largest(at.matrix())
}

impl Transform {
    /// Interpolates matrix and translation linearly from `self` (`fraction = 0`) to `other` (1).
    /// Where the result is singular, returns the nearer of the two.
    #[inline]
    pub fn lerp(&self, other: &Self, fraction: f32) -> Self {
        let translation = self.origin() * (1.0 - fraction) + other.origin() * fraction;
        if self.matrix() == other.matrix() {
            return self.with_translation(translation);
        }
        let matrix = self.matrix() * (1.0 - fraction) + other.matrix() * fraction;
        Self::new(matrix, translation).unwrap_or(if fraction < 0.5 { *self } else { *other })
    }
}

/// Interpolates rotation, stretch and translation from `from` (`fraction = 0`) to `to` (1), the
/// rotation along the shorter arc; `None` where the result is singular.
pub fn interpolate_parts(from: &Transform, to: &Transform, fraction: f64) -> Option<Transform> {
    let [from, to] = [from, to].map(PolarDecomposition::from_transform);
    from?.lerp(&to?, None, fraction).transform()
}

/// Interpolates linearly between two points.
#[inline]
pub fn lerp(from: Vec3, to: Vec3, fraction: f32) -> Vec3 {
    from * (1.0 - fraction) + to * fraction
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, close3};

    fn spin(turns: f32, keys: usize) -> Motion {
        let key = |i: usize| {
            Transform::rotation(Vec3::Z, turns * std::f32::consts::TAU * i as f32 / (keys - 1) as f32).unwrap()
        };
        Motion::from_keys((0..keys).map(key).collect()).unwrap()
    }

    #[test]
    fn motion_interpolates_its_keys_linearly() {
        let mut random = Random::new(31);
        let keys: Vec<Transform> = (0..5).map(|_| Transform::translation(random.point(3.0))).collect();
        let motion = Motion::from_keys(keys.clone()).unwrap();
        for (i, key) in keys.iter().enumerate() {
            assert!(close3(motion.at(i as f32 / 4.0).origin(), key.origin(), 1e-6));
        }
        assert!(close3(motion.at(0.375).origin(), (keys[1].origin() + keys[2].origin()) * 0.5, 1e-6));
        assert!(motion.at(-1.0) == keys[0] && motion.at(7.0) == keys[4]);
        assert_eq!(Motion::from_keys(vec![keys[0]; 4]), Some(keys[0].into()));
        assert_eq!(Motion::from_keys(Vec::new()), None);
    }

    #[test]
    fn then_composes_motions_at_each_time() {
        let mut random = Random::new(32);
        let still = Motion::from(random.transform());
        let a = Motion::from_keys((0..3).map(|_| Transform::translation(random.point(2.0))).collect()).unwrap();
        let b = Motion::from_keys((0..5).map(|_| Transform::translation(random.point(2.0))).collect()).unwrap();
        for (first, next) in [(&a, &b), (&b, &a), (&a, &still), (&still, &b), (&still, &still)] {
            let both = first.then(next);
            for key in 0..5 {
                let (time, p) = (key as f32 / 4.0, random.point(1.0));
                assert!(close3(both.at(time).point(p), next.at(time).point(first.at(time).point(p)), 1e-5));
            }
        }
    }

    #[test]
    fn smoothed_rotation_has_constant_radius_and_speed() {
        let mut random = Random::new(33);
        let wide = Transform::scale(Vec3::new(3.0, -0.5, 1.0)).unwrap();
        for turns in [0.1, 1.0, -3.7] {
            let motion = spin(turns, 17);
            let stretched = Motion::from(wide).then(&motion);
            let (round, stretched) = (motion.smoothed(1.0), stretched.smoothed(3.0));
            for _ in 0..200 {
                let (time, p) = (random.f32(), random.point(1.0));
                let exact = Transform::rotation(Vec3::Z, turns * std::f32::consts::TAU * time).unwrap();
                assert!(close3(round.at(time).point(p), exact.point(p), 3e-4), "{turns} {time}");
                assert!(close3(stretched.at(time).point(p), exact.point(wide.point(p)), 9e-4), "{turns} {time}");
            }
        }
    }

    #[test]
    fn smoothed_rotation_about_a_distant_axis_follows_the_circle() {
        let arm = Motion::from(Transform::translation(Vec3::new(1.0, 0.0, 0.3)));
        let aside = Motion::from(Transform::translation(Vec3::new(-4.0, 2.0, 0.0)));
        for turns in [0.25, 2.0, -6.0] {
            let round = arm.then(&spin(turns, 17)).then(&aside).smoothed(0.1);
            for i in 0..=1000 {
                let time = i as f32 / 1000.0;
                let exact = Transform::rotation(Vec3::Z, turns * std::f32::consts::TAU * time).unwrap();
                let exact = exact.point(Vec3::new(1.0, 0.0, 0.3)) + Vec3::new(-4.0, 2.0, 0.0);
                assert!(close3(round.at(time).origin(), exact, 3e-4), "{turns} {time}");
            }
        }
    }

    #[test]
    fn a_spinning_object_in_flight_keeps_its_straight_path() {
        let flight = Motion::from_keys((0..17).map(|i| Transform::translation(Vec3::X * i as f32)).collect()).unwrap();
        let motion = spin(6.0, 17).then(&flight).smoothed(1.0);
        for i in 0..=1000 {
            let time = i as f32 / 1000.0;
            assert!(close3(motion.at(time).origin(), Vec3::X * 16.0 * time, 1e-4), "{time}");
        }
    }

    #[test]
    fn straight_paths_need_two_keys_and_curved_ones_more() {
        let along = |f: fn(f32) -> Vec3| {
            Motion::from_keys((0..17).map(|i| Transform::translation(f(i as f32 / 16.0))).collect()).unwrap()
        };
        assert_eq!(along(|t| Vec3::X * t * 9.0).smoothed(1.0).keys().len(), 2);
        let thrown = along(|t| Vec3::new(t, t - t * t, 0.0));
        let count = thrown.clone().smoothed(0.5).keys().len();
        assert!((5..=17).contains(&count), "{count}");
        assert_eq!(thrown.smoothed(1e6).keys().len(), 2);
        assert_eq!(Motion::from(Transform::IDENTITY).smoothed(1.0), Motion::from(Transform::IDENTITY));
    }

    #[test]
    fn boxes_contain_all_positions() {
        let mut random = Random::new(34);
        let local = Aabb { min: Vec3::new(-1.0, -0.5, -2.0), max: Vec3::new(1.0, 0.25, 0.0) };
        for _ in 0..50 {
            let motion = Motion::from_keys((0..3).map(|_| random.transform()).collect()).unwrap().smoothed(1.0);
            let all = motion.aabb(&local);
            for _ in 0..100 {
                let inside = local.min + local.extent() * random.vec3();
                assert!(all.contains(motion.at(random.f32()).point(inside)));
            }
        }
        for _ in 0..50 {
            let motion = Motion::from_keys((0..5).map(|_| random.transform()).collect()).unwrap().smoothed(1.0);
            let (a, b) = (random.f32(), random.f32());
            let part = motion.aabb_between(&local, a.min(b), a.max(b));
            for _ in 0..100 {
                let inside = local.min + local.extent() * random.vec3();
                assert!(part.contains(motion.at(a + (b - a) * random.f32()).point(inside)));
            }
        }
        assert_eq!(spin(1.0, 5).aabb(&Aabb::INFINITE), Aabb::INFINITE);
        assert_eq!(spin(1.0, 5).aabb(&Aabb::EMPTY), Aabb::EMPTY);
    }

    #[test]
    fn a_singular_interpolation_returns_a_key() {
        let mirror = Transform::scale(Vec3::new(-1.0, 1.0, 1.0)).unwrap();
        let motion = Motion::from_keys(vec![Transform::IDENTITY, mirror]).unwrap().smoothed(1.0);
        for i in 0..=64 {
            let at = motion.at(i as f32 / 64.0);
            assert!(at.matrix().is_finite() && at.inverse_matrix().is_finite());
        }
    }
}
