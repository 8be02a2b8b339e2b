//! Size of an image pixel in angle and in scene units, to which navigation is scaled.

use juggler::math::{UVec2, Vec2, Vec3};
use juggler_session::Status;

/// Extent of a pixel at the image center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelExtent {
    /// Angle of a pixel, in degrees; 0 for parallel rays.
    pub degrees_per_pixel: f32,
    /// Size of a pixel at the distance of the point of interest, in scene units.
    pub units_per_pixel: f32,
}

impl PixelExtent {
    /// Computes the extent for a status's camera.
    pub fn from_status(status: &Status) -> Self {
        Self::from_camera(status).unwrap_or(Self { degrees_per_pixel: 0.1, units_per_pixel: status.extent / 1000.0 })
    }

    fn from_camera(status: &Status) -> Option<Self> {
        let size = UVec2::from(status.size);
        let projection = status.camera.as_ref()?.projection(size).ok()?;
        let middle = size.as_vec2() / 2.0;
        let [here, below] = [middle, middle + Vec2::Y].map(|film| projection.ray(film, Vec2::splat(0.5), 0.0));
        let interest = Vec3::from(status.interest);
        let depth = (interest - here.origin).dot(here.direction).max(status.extent * 1e-3);
        let [at, next] = [here, below].map(|ray| ray.origin + ray.direction * depth);
        let pixel = Self {
            degrees_per_pixel: here
                .direction
                .cross(below.direction)
                .length()
                .atan2(here.direction.dot(below.direction))
                .to_degrees(),
            units_per_pixel: at.distance(next),
        };
        (pixel.degrees_per_pixel.is_finite() && pixel.units_per_pixel.is_finite()).then_some(pixel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler::camera::{AnyCamera, Orthographic, Perspective};
    use juggler::math::vec3;

    const EYE: Vec3 = vec3(0.0, 0.0, 5.0);

    fn status(camera: Option<AnyCamera>) -> Status {
        Status { size: [200, 100], camera, interest: [0.0; 3], extent: 10.0, ..Status::default() }
    }

    #[test]
    fn pixel_extent_of_a_perspective_camera() {
        let camera = Perspective { eye: EYE, vertical_fov_degrees: Some(90.0), ..Perspective::default() };
        let pixel = PixelExtent::from_status(&status(Some(camera.into())));
        // At distance 1 half the film height is 1, so a pixel measures 1/50; at the origin 5 times
        // that.
        assert!((pixel.units_per_pixel - 0.1).abs() < 1e-3, "{pixel:?}");
        assert!((pixel.degrees_per_pixel - 0.02_f32.atan().to_degrees()).abs() < 1e-3, "{pixel:?}");
    }

    #[test]
    fn pixel_extent_of_an_orthographic_camera() {
        let camera = Orthographic { eye: EYE, height: Some(20.0), ..Orthographic::default() };
        let pixel = PixelExtent::from_status(&status(Some(camera.into())));
        assert_eq!(pixel.degrees_per_pixel, 0.0);
        assert!((pixel.units_per_pixel - 0.2).abs() < 1e-4, "{pixel:?}");
    }

    #[test]
    fn pixel_extent_of_an_unknown_camera_is_positive() {
        let pixel = PixelExtent::from_status(&status(None));
        assert!(pixel.degrees_per_pixel > 0.0 && pixel.units_per_pixel > 0.0);
    }
}
