//! Camera over the shutter interval.

use super::{LANES, Projection};
use juggler_math::motion::key_interval;
use juggler_math::{Ray, UVec2, Vec2};

/// Camera for one picture size over the shutter interval, static or animated.
#[derive(Clone, Debug, PartialEq)]
pub struct ShutterCamera {
    first: Projection,
    /// Keys at equal intervals after the first, up to the end of the shutter interval; empty for a
    /// static camera.
    later_keys: Vec<Projection>,
}

impl From<Projection> for ShutterCamera {
    fn from(first: Projection) -> Self {
        Self { first, later_keys: Vec::new() }
    }
}

impl ShutterCamera {
    /// Creates a camera from the keys `first` and `later_keys`, at equal intervals of the shutter
    /// interval.
    pub fn from_keys(first: Projection, mut later_keys: Vec<Projection>) -> Self {
        if later_keys.iter().all(|key| *key == first) {
            later_keys.clear();
        }
        Self { first, later_keys }
    }

    /// Whether the camera moves during the shutter interval.
    #[inline]
    pub fn moves(&self) -> bool {
        !self.later_keys.is_empty()
    }

    /// Whether rays depend on a lens sample.
    #[inline]
    pub fn needs_lens(&self) -> bool {
        self.first.needs_lens() || self.later_keys.iter().any(Projection::needs_lens)
    }

    /// Projection at a time between 0 and 1.
    pub fn projection_at(&self, time: f32) -> Projection {
        if self.later_keys.is_empty() {
            return self.first;
        }
        let (key, fraction) = key_interval(self.later_keys.len() + 1, time);
        let from = key.checked_sub(1).and_then(|before| self.later_keys.get(before)).unwrap_or(&self.first);
        from.interpolated(self.later_keys.get(key).unwrap_or(from), fraction)
    }

    /// Divides the same film into `to` pixels instead of `from`.
    #[must_use]
    pub fn resampled(&self, from: UVec2, to: UVec2) -> Self {
        let later_keys = self.later_keys.iter().map(|key| key.resampled(from, to)).collect();
        Self { first: self.first.resampled(from, to), later_keys }
    }

    /// Appends the first `count` of eight rays, each with its time; see [`Projection::rays`].
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
            let ray =
                |i: usize| self.projection_at(times[i]).ray(Vec2::new(films[0][i], films[1][i]), lenses[i], times[i]);
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

    fn projection(json: &str) -> Projection {
        let camera: AnyCamera = serde_json::from_str(json).unwrap();
        camera.projection(SIZE).unwrap()
    }

    #[test]
    fn shutter_camera_interpolates_its_keys() {
        let keys = [0.0, 2.0, 3.0]
            .map(|x| projection(&format!(r#"{{"perspective": {{"eye": [{x}, 0, 5], "direction": [0, 0, -1]}}}}"#)));
        let camera = ShutterCamera::from_keys(keys[0], keys[1..].to_vec());
        assert!(camera.moves() && !camera.needs_lens());
        let film = Vec2::new(20.0, 15.0);
        for (time, x) in [(0.0, 0.0), (0.25, 1.0), (0.5, 2.0), (0.75, 2.5), (1.0, 3.0)] {
            let ray = camera.projection_at(time).ray(film, Vec2::ZERO, time);
            assert!((ray.origin.x - x).abs() < 1e-6 && ray.time == time);
        }
        assert!(!ShutterCamera::from_keys(keys[0], vec![keys[0]; 3]).moves());
    }

    /// A rolling camera keeps its field of view between two keys.
    #[test]
    fn rotation_is_interpolated_as_rotation() {
        for kind in ["orthographic", "perspective"] {
            let [first, last] = [0.0, 120.0].map(|roll| {
                let view = r#""eye": [1, 2, 5], "look_at": [1, 2, 0]"#;
                projection(&format!(r#"{{"{kind}": {{{view}, "roll_degrees": {roll}}}}}"#))
            });
            let camera = ShutterCamera::from_keys(first, vec![last]);
            for (time, degrees) in [(0.0, 0.0f32), (0.25, 30.0), (0.5, 60.0), (1.0, 120.0)] {
                let Projection { right, down, corner, .. } = camera.projection_at(time);
                assert!((right.length() / first.right.length() - 1.0).abs() < 1e-5, "{time}: {right}");
                assert!((corner.length() / first.corner.length() - 1.0).abs() < 1e-5, "{time}: {corner}");
                assert!(right.dot(down).abs() < 1e-6 * right.length());
                let cosine = right.normalize().dot(first.right.normalize());
                assert!((cosine - degrees.to_radians().cos()).abs() < 1e-5, "{time}: {cosine}");
            }
        }
    }

    /// A resampled film shows the same picture with other numbers of columns and rows.
    #[test]
    fn resampled_films_keep_their_corners() {
        let keys = [0.0, 2.0]
            .map(|x| projection(&format!(r#"{{"perspective": {{"eye": [{x}, 0, 5], "direction": [0, 0.3, -1]}}}}"#)));
        // Twice as many columns, a third of the rows.
        let to = UVec2::new(80, 10);
        for camera in [ShutterCamera::from(keys[0]), ShutterCamera::from_keys(keys[0], vec![keys[1]])] {
            for (time, share) in [(0.0, [0.0, 1.0]), (0.5, [1.0, 0.0]), (1.0, [0.3, 0.8])] {
                let film = |size: UVec2| size.as_vec2() * Vec2::from(share);
                let ray = |camera: &ShutterCamera, size| camera.projection_at(time).ray(film(size), Vec2::ZERO, time);
                let (original, resampled) = (ray(&camera, SIZE), ray(&camera.resampled(SIZE, to), to));
                assert_eq!(resampled.origin, original.origin);
                assert!(resampled.direction.abs_diff_eq(original.direction, 1e-6), "{resampled:?} for {original:?}");
            }
        }
    }

    #[test]
    fn eight_rays_equal_single_rays() {
        let from = projection(r#"{"thin_lens": {"eye": [0, 0, 5], "lens_radius": 0.1}}"#);
        let to = projection(r#"{"thin_lens": {"eye": [1, 0, 4], "lens_radius": 0.3}}"#);
        let films = [[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0], [3.5; LANES]];
        let (lenses, times) = ([Vec2::new(0.2, 0.9); LANES], [0.0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.99]);
        for camera in [ShutterCamera::from(from), ShutterCamera::from_keys(from, vec![to])] {
            assert!(camera.needs_lens());
            let mut rays = Vec::new();
            camera.rays(&films, &lenses, &times, 7, &mut rays);
            assert_eq!(rays.len(), 7);
            for (i, ray) in rays.iter().enumerate() {
                let alone =
                    camera.projection_at(times[i]).ray(Vec2::new(films[0][i], films[1][i]), lenses[i], times[i]);
                assert_eq!(*ray, alone);
            }
        }
    }
}
