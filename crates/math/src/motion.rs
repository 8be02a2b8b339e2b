//! Where something is while the shutter is open.
//!
//! Time runs from 0, when the shutter opens, to 1, when it closes. Between keys at even times every point moves in a
//! straight line. Turns are not straight: [`Motion::smoothed`] takes them apart (polar decomposition: Higham 1986; as
//! Shoemake and Duff 1992, "Matrix Animation and Polar Decomposition") and puts in as many keys as they need.

use crate::quaternion::slerp;
use crate::{Aabb, Transform, Vec3, fun};
use glam::{DMat3, DQuat, DVec3, Mat3};
use std::sync::Arc;

/// How much something may turn between two keys, in radians: chords of it are 1.2e-4 of the radius too short at most.
const STEP_RADIANS: f64 = 1.0 / 32.0;
/// Most keys that smoothing makes.
const MOST_KEYS: usize = 4097;
/// How far keys may be left out that lie nearly on the straight way, in sizes of what moves.
const TOLERANCE: f32 = 2e-4;

/// Where something is while the shutter is open.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Always there.
    Still(Transform),
    /// There at even times from 0 to 1; two keys at least. In between matrices are interpolated linearly.
    Moving(Arc<[Transform]>),
}

impl From<Transform> for Motion {
    fn from(transform: Transform) -> Self {
        Self::Still(transform)
    }
}

impl Motion {
    /// Through `keys` at even times; still when they are all the same, and nowhere without any.
    pub fn through(keys: Vec<Transform>) -> Option<Self> {
        let first = *keys.first()?;
        let moves = keys.iter().any(|key| *key != first);
        Some(if moves { Self::Moving(keys.into()) } else { Self::Still(first) })
    }

    /// The keys, one when it is still.
    pub fn keys(&self) -> &[Transform] {
        match self {
            Self::Still(transform) => std::slice::from_ref(transform),
            Self::Moving(keys) => keys,
        }
    }

    /// Whether it moves at all.
    pub fn moves(&self) -> bool {
        matches!(self, Self::Moving(_))
    }

    /// Where it is at a time between 0 and 1.
    #[inline]
    pub fn at(&self, time: f32) -> Transform {
        match self {
            Self::Still(transform) => *transform,
            Self::Moving(keys) => {
                let (key, share) = stretch(keys.len(), time);
                keys[key].towards(&keys[key + 1], share)
            }
        }
    }

    /// First this, then `next`, each at the same time.
    pub fn then(&self, next: &Self) -> Self {
        if let (Self::Still(first), Self::Still(next)) = (self, next) {
            return Self::Still(first.then(next));
        }
        let count = self.keys().len().max(next.keys().len());
        let at = |motion: &Self, key: usize| match motion {
            Self::Moving(keys) if keys.len() == count => keys[key],
            other => other.at(key as f32 / (count - 1) as f32),
        };
        Self::Moving((0..count).map(|key| at(self, key).then(&at(next, key))).collect())
    }

    /// A box around all the places of a local box.
    pub fn aabb(&self, local: &Aabb) -> Aabb {
        let Self::Moving(keys) = self else { return self.at(0.0).aabb(local) };
        // Between keys points move straight: what holds both ends holds the way, but for its rounding.
        let all = keys.iter().map(|key| key.aabb(local)).fold(Aabb::EMPTY, Aabb::union);
        let size = all.min.abs().max(all.max.abs()).max_element();
        if all.is_finite() && !all.is_empty() { all.grown(8.0 * f32::EPSILON * size) } else { all }
    }

    /// The same motion with turns that are round: more keys where something turns, fewer where it goes straight. `size`
    /// is that of what moves, after the motion.
    #[must_use]
    pub fn smoothed(self, size: f32) -> Self {
        let Self::Moving(keys) = &self else { return self };
        let parts: Option<Vec<Parts>> = keys.iter().map(Parts::of).collect();
        let Some(parts) = parts else { return self };
        let turn = parts.windows(2).map(|pair| pair[0].angle_to(&pair[1])).fold(0.0, f64::max);
        let steps = (turn / STEP_RADIANS).ceil().clamp(1.0, (MOST_KEYS / keys.len()).max(1) as f64) as usize;
        if steps == 1 {
            let straight = |at: &_, before: &_, after: &_| is_between(at, before, after, size);
            return Self::Moving(thinned(keys.to_vec(), straight).into());
        }
        let mut round = Vec::with_capacity(steps * (keys.len() - 1) + 1);
        for (pair, ends) in parts.windows(2).zip(keys.windows(2)) {
            round.push(ends[0]);
            for step in 1..steps {
                let between = pair[0].between(&pair[1], step as f64 / steps as f64).transform();
                round.push(between.unwrap_or(ends[0]));
            }
        }
        round.extend(keys.last());
        Self::Moving(round.into())
    }
}

/// The key before a time, of `keys` at even times, and the share of the way to the next.
#[inline]
pub fn stretch(keys: usize, time: f32) -> (usize, f32) {
    let last = keys - 1;
    let place = time.clamp(0.0, 1.0) * last as f32;
    let key = (place as usize).min(last - 1);
    (key, place - key as f32)
}

/// Leaves out every second of the keys at even times as long as it lies on the straight way between its neighbours, which
/// `straight` says of a key, the one before and the one after.
pub fn thinned<T>(mut keys: Vec<T>, straight: impl Fn(&T, &T, &T) -> bool) -> Vec<T> {
    while keys.len() > 2 && keys.len() % 2 == 1 {
        if !keys.windows(3).step_by(2).all(|three| straight(&three[1], &three[0], &three[2])) {
            break;
        }
        keys = keys.into_iter().step_by(2).collect();
    }
    keys
}

/// Whether something of this size is nearly where the straight way from one place to the next has it.
fn is_between(at: &Transform, before: &Transform, after: &Transform, size: f32) -> bool {
    let largest = |matrix: Mat3| matrix.to_cols_array().iter().fold(0.0, |largest: f32, v| v.abs().max(largest));
    let middle = before.towards(after, 0.5);
    (middle.origin() - at.origin()).length() <= TOLERANCE * size
        && largest(middle.matrix() - at.matrix()) <= TOLERANCE * largest(at.matrix())
}

/// A transform taken apart: stretched, then turned (and mirrored), then moved.
struct Parts {
    stretch: DMat3,
    /// −1 when it mirrors.
    sign: f64,
    turn: DQuat,
    translation: DVec3,
}

impl Parts {
    fn of(transform: &Transform) -> Option<Self> {
        let matrix = transform.matrix().as_dmat3();
        let sign = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
        let mut turn = matrix * sign;
        // Newton's iteration: each step halves what is not orthogonal, then squares it.
        for _ in 0..64 {
            let next = (turn + turn.transpose().inverse()) * 0.5;
            let change = (next - turn).to_cols_array().iter().fold(0.0, |m: f64, v| v.abs().max(m));
            turn = next;
            if change < 1e-14 {
                break;
            }
        }
        turn.is_finite().then(|| Self {
            stretch: turn.transpose() * matrix * sign,
            sign,
            turn: DQuat::from_mat3(&turn).normalize(),
            translation: transform.origin().as_dvec3(),
        })
    }

    /// The angle from one turn to the other, the shorter way; none to one that is mirrored otherwise.
    fn angle_to(&self, other: &Self) -> f64 {
        if self.sign == other.sign { 2.0 * fun::acos_f64(self.turn.dot(other.turn).abs().min(1.0)) } else { 0.0 }
    }

    fn between(&self, other: &Self, share: f64) -> Self {
        Self {
            stretch: self.stretch * (1.0 - share) + other.stretch * share,
            sign: self.sign,
            turn: slerp(self.turn, other.turn, share),
            translation: self.translation.lerp(other.translation, share),
        }
    }

    fn transform(&self) -> Option<Transform> {
        let matrix = DMat3::from_quat(self.turn) * self.stretch * self.sign;
        Transform::new(matrix.as_mat3(), self.translation.as_vec3())
    }
}

impl Transform {
    /// A share of the straight way that each point takes to where `other` brings it. Where that would flatten what
    /// moves, it stays with the nearer one.
    #[inline]
    pub fn towards(&self, other: &Self, share: f32) -> Self {
        let translation = self.origin() * (1.0 - share) + other.origin() * share;
        if self.matrix() == other.matrix() {
            return self.moved_to(translation);
        }
        let matrix = self.matrix() * (1.0 - share) + other.matrix() * share;
        Self::new(matrix, translation).unwrap_or(if share < 0.5 { *self } else { *other })
    }
}

/// A point's way from one place to another.
#[inline]
pub fn between(from: Vec3, to: Vec3, share: f32) -> Vec3 {
    from * (1.0 - share) + to * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, close3};

    fn spin(turns: f32, keys: usize) -> Motion {
        let key = |i: usize| {
            Transform::rotation(Vec3::Z, turns * std::f32::consts::TAU * i as f32 / (keys - 1) as f32).unwrap()
        };
        Motion::through((0..keys).map(key).collect()).unwrap()
    }

    #[test]
    fn goes_through_its_keys_and_straight_between() {
        let mut random = Random::new(31);
        let keys: Vec<Transform> = (0..5).map(|_| Transform::translation(random.point(3.0))).collect();
        let motion = Motion::through(keys.clone()).unwrap();
        for (i, key) in keys.iter().enumerate() {
            assert!(close3(motion.at(i as f32 / 4.0).origin(), key.origin(), 1e-6));
        }
        assert!(close3(motion.at(0.375).origin(), (keys[1].origin() + keys[2].origin()) * 0.5, 1e-6));
        assert!(motion.at(-1.0) == keys[0] && motion.at(7.0) == keys[4]);
        assert_eq!(Motion::through(vec![keys[0]; 4]), Some(Motion::Still(keys[0])));
        assert_eq!(Motion::through(Vec::new()), None);
    }

    #[test]
    fn one_after_the_other_at_each_time() {
        let mut random = Random::new(32);
        let still = Motion::Still(random.transform());
        let a = Motion::through((0..3).map(|_| Transform::translation(random.point(2.0))).collect()).unwrap();
        let b = Motion::through((0..5).map(|_| Transform::translation(random.point(2.0))).collect()).unwrap();
        for (first, next) in [(&a, &b), (&b, &a), (&a, &still), (&still, &b), (&still, &still)] {
            let both = first.then(next);
            for key in 0..5 {
                let (time, p) = (key as f32 / 4.0, random.point(1.0));
                assert!(close3(both.at(time).point(p), next.at(time).point(first.at(time).point(p)), 1e-5));
            }
        }
    }

    #[test]
    fn a_smoothed_turn_is_round_and_even() {
        let mut random = Random::new(33);
        let wide = Transform::scale(Vec3::new(3.0, -0.5, 1.0)).unwrap();
        for turns in [0.1, 1.0, -3.7] {
            let motion = spin(turns, 17);
            let stretched = Motion::Still(wide).then(&motion);
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
    fn straight_ways_need_two_keys_and_bent_ones_more() {
        let along = |f: fn(f32) -> Vec3| {
            Motion::through((0..17).map(|i| Transform::translation(f(i as f32 / 16.0))).collect()).unwrap()
        };
        assert_eq!(along(|t| Vec3::X * t * 9.0).smoothed(1.0).keys().len(), 2);
        let thrown = along(|t| Vec3::new(t, t - t * t, 0.0));
        let count = thrown.clone().smoothed(0.5).keys().len();
        assert!((5..=17).contains(&count), "{count}");
        assert_eq!(thrown.smoothed(1e6).keys().len(), 2);
        assert_eq!(Motion::Still(Transform::IDENTITY).smoothed(1.0), Motion::Still(Transform::IDENTITY));
    }

    #[test]
    fn boxes_hold_all_places() {
        let mut random = Random::new(34);
        let local = Aabb { min: Vec3::new(-1.0, -0.5, -2.0), max: Vec3::new(1.0, 0.25, 0.0) };
        for _ in 0..50 {
            let motion = Motion::through((0..3).map(|_| random.transform()).collect()).unwrap().smoothed(1.0);
            let all = motion.aabb(&local);
            for _ in 0..100 {
                let inside = local.min + local.extent() * random.vec3();
                assert!(all.contains(motion.at(random.f32()).point(inside)));
            }
        }
        assert_eq!(spin(1.0, 5).aabb(&Aabb::INFINITE), Aabb::INFINITE);
        assert_eq!(spin(1.0, 5).aabb(&Aabb::EMPTY), Aabb::EMPTY);
    }

    #[test]
    fn what_would_be_flat_on_the_way_stays_with_a_key() {
        let mirror = Transform::scale(Vec3::new(-1.0, 1.0, 1.0)).unwrap();
        let motion = Motion::through(vec![Transform::IDENTITY, mirror]).unwrap().smoothed(1.0);
        for i in 0..=64 {
            let at = motion.at(i as f32 / 64.0);
            assert!(at.matrix().is_finite() && at.inverse_matrix().is_finite());
        }
    }
}
