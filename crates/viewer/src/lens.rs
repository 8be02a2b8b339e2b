//! What the camera says about a pixel: by how much it turns, and how wide it is where one looks.

use juggler::camera::AnyCamera;
use juggler::math::{UVec2, Vec2, Vec3};
use juggler_session::Status;

/// How far a pixel in the middle of the picture reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// The angle that it spans; 0 when all rays are parallel.
    pub degrees_per_pixel: f32,
    /// What it covers at the point of interest, scene units.
    pub units_per_pixel: f32,
    /// How far one goes at speed 1 in some seconds, scene units: the size of the scene, or a few times the distance of the
    /// point of interest where that is less, so that a far horizon makes nobody too fast.
    pub reach: f32,
}

/// How many distances of the point of interest are a reach.
const DISTANCES: f32 = 4.0;

impl Lens {
    /// Of the camera that a status tells of.
    pub fn of(status: &Status) -> Self {
        Self::seen(status).unwrap_or(Self {
            degrees_per_pixel: 0.1,
            units_per_pixel: status.extent / 1000.0,
            reach: status.extent,
        })
    }

    fn seen(status: &Status) -> Option<Self> {
        let camera: AnyCamera = serde_json::from_value(status.camera.clone()).ok()?;
        let size = UVec2::from(status.size);
        let projection = camera.project(size).ok()?;
        let middle = size.as_vec2() / 2.0;
        let [here, below] = [middle, middle + Vec2::Y].map(|film| projection.ray(film, Vec2::splat(0.5), 0.0));
        let interest = Vec3::from(status.interest);
        let depth = (interest - here.origin).dot(here.direction).max(status.extent * 1e-3);
        let [at, next] = [here, below].map(|ray| ray.origin + ray.direction * depth);
        let extent = status.extent.max(f32::MIN_POSITIVE);
        let lens = Self {
            degrees_per_pixel: here
                .direction
                .cross(below.direction)
                .length()
                .atan2(here.direction.dot(below.direction))
                .to_degrees(),
            units_per_pixel: at.distance(next),
            reach: (here.origin.distance(interest) * DISTANCES).clamp(extent * 0.01, extent),
        };
        (lens.degrees_per_pixel.is_finite() && lens.units_per_pixel.is_finite()).then_some(lens)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn status(camera: serde_json::Value) -> Status {
        Status { size: [200, 100], camera, interest: [0.0; 3], extent: 10.0, ..Status::default() }
    }

    #[test]
    fn of_a_pinhole() {
        let lens = Lens::of(&status(json!({"perspective": {"eye": [0, 0, 5], "vertical_fov_degrees": 90}})));
        // The film's half height is 1 at distance 1: a pixel is 1/50 there, five times that at the origin.
        assert!((lens.units_per_pixel - 0.1).abs() < 1e-3, "{lens:?}");
        assert!((lens.degrees_per_pixel - 0.02_f32.atan().to_degrees()).abs() < 1e-3, "{lens:?}");
    }

    #[test]
    fn a_far_horizon_makes_nobody_too_fast() {
        let camera = json!({"perspective": {"eye": [0, 0, 5]}});
        let lens = Lens::of(&Status { extent: 1e4, ..status(camera) });
        assert_eq!(lens.reach, 100.0);
        let lens = Lens::of(&Status { extent: 60.0, ..status(json!({"perspective": {"eye": [0, 0, 5]}})) });
        assert!((lens.reach - 20.0).abs() < 1e-3, "{lens:?}");
    }

    #[test]
    fn of_parallel_rays() {
        let lens = Lens::of(&status(json!({"orthographic": {"eye": [0, 0, 5], "height": 20}})));
        assert_eq!((lens.degrees_per_pixel, lens.reach), (0.0, 10.0));
        assert!((lens.units_per_pixel - 0.2).abs() < 1e-4, "{lens:?}");
    }

    #[test]
    fn of_nothing_that_is_known() {
        let lens = Lens::of(&status(json!({"periscope": {}})));
        assert!(lens.degrees_per_pixel > 0.0 && lens.units_per_pixel > 0.0);
    }
}
