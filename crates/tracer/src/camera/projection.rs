//! A camera ready for one size of picture.

use super::pose::Axes;
use juggler_math::{Ray, UVec2, Vec2, Vec3, warp};

/// A camera for one size of picture: all that a ray needs, nothing to look up.
///
/// The film stands one unit in front of the eye (for a parallel projection: through the eye).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The eye.
    origin: Vec3,
    /// From the eye to the film's top left corner.
    corner: Vec3,
    /// One pixel to the right.
    right: Vec3,
    /// One pixel down.
    down: Vec3,
    /// How rays leave the film.
    lens: Lens,
}

/// How rays leave the film.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lens {
    /// All through one point.
    Pinhole,
    /// Through a disk around the eye, spanned by two radii; sharp at a distance of 1 / `focus`.
    Disk { right: Vec3, up: Vec3, focus: f32 },
    /// All in one direction.
    Parallel { forward: Vec3 },
}

impl Projection {
    /// All rays through the eye. `half` is half of the film's width and height.
    pub(super) fn pinhole(axes: &Axes, half: Vec2, size: UVec2) -> Self {
        Self::on_film(axes, axes.forward, half, size, Lens::Pinhole)
    }

    /// Rays through a disk of `radius` around the eye, sharp on the plane `focus_distance` away.
    pub(super) fn thin_lens(axes: &Axes, half: Vec2, size: UVec2, radius: f32, focus_distance: f32) -> Self {
        let lens = Lens::Disk { right: axes.right * radius, up: axes.up * radius, focus: 1.0 / focus_distance };
        Self::on_film(axes, axes.forward, half, size, lens)
    }

    /// Parallel rays that start on a film through the eye.
    pub(super) fn parallel(axes: &Axes, half: Vec2, size: UVec2) -> Self {
        Self::on_film(axes, Vec3::ZERO, half, size, Lens::Parallel { forward: axes.forward })
    }

    fn on_film(axes: &Axes, centre: Vec3, half: Vec2, size: UVec2, lens: Lens) -> Self {
        let pixel = half * 2.0 / size.max(UVec2::ONE).as_vec2();
        let corner = centre - axes.right * half.x + axes.up * half.y;
        Self { origin: axes.eye, corner, right: axes.right * pixel.x, down: axes.up * -pixel.y, lens }
    }

    /// Whether the place on the lens makes a difference.
    #[inline]
    pub fn needs_lens(&self) -> bool {
        matches!(self.lens, Lens::Disk { .. })
    }

    /// The ray through a point of the film in pixels, for `lens` in the unit square; `None` where the
    /// film sees nothing. Its direction is a unit vector; `time` is handed on.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<Ray> {
        let point = self.corner + self.right * film.x + self.down * film.y;
        let (origin, direction) = match &self.lens {
            Lens::Pinhole => (self.origin, point.normalize()),
            Lens::Disk { right, up, focus } => {
                let disk = warp::concentric_disk(lens);
                let offset = *right * disk.x + *up * disk.y;
                (self.origin + offset, (point - offset * *focus).normalize())
            }
            Lens::Parallel { forward } => (self.origin + point, *forward),
        };
        Some(Ray { time, ..Ray::new(origin, direction) })
    }
}
