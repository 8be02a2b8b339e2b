//! A camera while the shutter is open.

use super::{LANES, Projection};
use juggler_math::motion::stretch;
use juggler_math::{Ray, UVec2, Vec2};

/// A camera for one size of picture while the shutter is open: still, or moving.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    first: Projection,
    /// At even times after the first, until the shutter closes; nothing when it stays as it is. In between everything
    /// goes straight.
    later: Vec<Projection>,
}

impl From<Projection> for Shot {
    fn from(first: Projection) -> Self {
        Self { first, later: Vec::new() }
    }
}

impl Shot {
    /// Through `first` and the `later` ones, at even times from the opening of the shutter to its closing.
    pub fn moving(first: Projection, mut later: Vec<Projection>) -> Self {
        if later.iter().all(|key| *key == first) {
            later.clear();
        }
        Self { first, later }
    }

    /// Whether it moves while the shutter is open.
    #[inline]
    pub fn moves(&self) -> bool {
        !self.later.is_empty()
    }

    /// Whether the place on the lens makes a difference.
    #[inline]
    pub fn needs_lens(&self) -> bool {
        self.first.needs_lens() || self.later.iter().any(Projection::needs_lens)
    }

    /// What it is at a time between 0 and 1.
    pub fn at(&self, time: f32) -> Projection {
        if self.later.is_empty() {
            return self.first;
        }
        let (key, share) = stretch(self.later.len() + 1, time);
        let from = key.checked_sub(1).and_then(|before| self.later.get(before)).unwrap_or(&self.first);
        from.towards(self.later.get(key).unwrap_or(from), share)
    }

    /// The same film in other pixels: cut into `to` of them instead of `from`.
    #[must_use]
    pub fn resampled(&self, from: UVec2, to: UVec2) -> Self {
        let later = self.later.iter().map(|key| key.resampled(from, to)).collect();
        Self { first: self.first.resampled(from, to), later }
    }

    /// The first `count` of eight rays at once, each with its time; see [`Projection::rays`].
    #[inline]
    pub fn rays(
        &self,
        films: &[[f32; LANES]; 2],
        lenses: &[Vec2; LANES],
        times: &[f32; LANES],
        count: usize,
        rays: &mut Vec<Ray>,
    ) {
        if self.moves() {
            let ray = |i: usize| self.at(times[i]).ray(Vec2::new(films[0][i], films[1][i]), lenses[i], times[i]);
            return rays.extend((0..count.min(LANES)).map(ray));
        }
        let start = rays.len();
        self.first.rays(films, lenses, count, rays);
        for (ray, time) in rays[start..].iter_mut().zip(times) {
            ray.time = *time;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AnyCamera;

    const SIZE: UVec2 = UVec2::new(40, 30);

    fn at(json: &str) -> Projection {
        let camera: AnyCamera = serde_json::from_str(json).unwrap();
        camera.project(SIZE).unwrap()
    }

    #[test]
    fn is_where_its_keys_say_and_between_them_otherwise() {
        let keys = [0.0, 2.0, 3.0]
            .map(|x| at(&format!(r#"{{"perspective": {{"eye": [{x}, 0, 5], "direction": [0, 0, -1]}}}}"#)));
        let shot = Shot::moving(keys[0], keys[1..].to_vec());
        assert!(shot.moves() && !shot.needs_lens());
        let film = Vec2::new(20.0, 15.0);
        for (time, x) in [(0.0, 0.0), (0.25, 1.0), (0.5, 2.0), (0.75, 2.5), (1.0, 3.0)] {
            let ray = shot.at(time).ray(film, Vec2::ZERO, time);
            assert!((ray.origin.x - x).abs() < 1e-6 && ray.time == time);
        }
        assert!(!Shot::moving(keys[0], vec![keys[0]; 3]).moves());
    }

    #[test]
    fn eight_rays_are_those_one_by_one() {
        let from = at(r#"{"thin_lens": {"eye": [0, 0, 5], "aperture_radius": 0.1}}"#);
        let to = at(r#"{"thin_lens": {"eye": [1, 0, 4], "aperture_radius": 0.3}}"#);
        let films = [[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0], [3.5; LANES]];
        let (lenses, times) = ([Vec2::new(0.2, 0.9); LANES], [0.0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.99]);
        for shot in [Shot::from(from), Shot::moving(from, vec![to])] {
            assert!(shot.needs_lens());
            let mut rays = Vec::new();
            shot.rays(&films, &lenses, &times, 7, &mut rays);
            assert_eq!(rays.len(), 7);
            for (i, ray) in rays.iter().enumerate() {
                let alone = shot.at(times[i]).ray(Vec2::new(films[0][i], films[1][i]), lenses[i], times[i]);
                assert_eq!(*ray, alone);
            }
        }
    }
}
