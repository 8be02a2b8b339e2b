//! A camera ready for one size of picture.

use super::pose::Axes;
use juggler_math::{Ray, UVec2, Vec2, Vec3, warp};

/// Rays that [`Projection::rays`] makes side by side.
pub const LANES: usize = 8;

/// A camera for one size of picture: all that a ray needs, nothing to look up.
///
/// The film stands one unit in front of the eye (for a parallel projection: through the eye).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The eye.
    pub(super) origin: Vec3,
    /// From the eye to the film's top left corner.
    pub(super) corner: Vec3,
    /// One pixel to the right.
    pub(super) right: Vec3,
    /// One pixel down.
    pub(super) down: Vec3,
    /// How rays leave the film.
    pub(super) lens: Lens,
}

/// How rays leave the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lens {
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

    /// The same film in other pixels: cut into `to` of them instead of `from`.
    #[must_use]
    pub fn resampled(&self, from: UVec2, to: UVec2) -> Self {
        let scale = from.max(UVec2::ONE).as_vec2() / to.max(UVec2::ONE).as_vec2();
        Self { right: self.right * scale.x, down: self.down * scale.y, ..*self }
    }

    /// A share of the way to another projection, everything going straight. Where the lenses are of different kinds,
    /// that of the nearer one counts.
    pub(super) fn towards(&self, other: &Self, share: f32) -> Self {
        let between = |from: Vec3, to: Vec3| juggler_math::motion::between(from, to, share);
        let lens = match (self.lens, other.lens) {
            (Lens::Disk { right, up, focus }, Lens::Disk { right: to_right, up: to_up, focus: to_focus }) => {
                Lens::Disk {
                    right: between(right, to_right),
                    up: between(up, to_up),
                    focus: focus * (1.0 - share) + to_focus * share,
                }
            }
            (Lens::Parallel { forward }, Lens::Parallel { forward: to }) => {
                Lens::Parallel { forward: between(forward, to).try_normalize().unwrap_or(forward) }
            }
            (from, to) => {
                if share < 0.5 {
                    from
                } else {
                    to
                }
            }
        };
        Self {
            origin: between(self.origin, other.origin),
            corner: between(self.corner, other.corner),
            right: between(self.right, other.right),
            down: between(self.down, other.down),
            lens,
        }
    }

    /// Where the camera stands.
    pub fn eye(&self) -> Vec3 {
        self.origin
    }

    /// Diameter of a pixel where rays begin, and how much it grows on each unit of the way: in the middle of a film that is
    /// looked at straight.
    pub fn pixel(&self) -> [f32; 2] {
        let size = (self.right.length() * self.down.length()).sqrt();
        if matches!(self.lens, Lens::Parallel { .. }) { [size, 0.0] } else { [0.0, size] }
    }

    /// Whether the place on the lens makes a difference.
    #[inline]
    pub fn needs_lens(&self) -> bool {
        matches!(self.lens, Lens::Disk { .. })
    }

    /// The ray through a point of the film in pixels, for `lens` in the unit square. Its direction is a unit
    /// vector; `time` is handed on.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Ray {
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
        Ray { time, ..Ray::new(origin, direction) }
    }

    /// The first `count` of eight rays at once, the same as [`Projection::ray`] gives one by one; `films` and
    /// `lenses` hold all x and all y.
    #[inline]
    pub fn rays(&self, films: &[[f32; LANES]; 2], lenses: &[Vec2; LANES], count: usize, rays: &mut Vec<Ray>) {
        let [u, v] = films;
        if self.lens != Lens::Pinhole {
            rays.extend((0..count.min(LANES)).map(|i| self.ray(Vec2::new(u[i], v[i]), lenses[i], 0.0)));
            return;
        }
        let Self { corner, right, down, .. } = self;
        let (mut x, mut y, mut z) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            x[i] = corner.x + right.x * u[i] + down.x * v[i];
            y[i] = corner.y + right.y * u[i] + down.y * v[i];
            z[i] = corner.z + right.z * u[i] + down.z * v[i];
            let inverse = 1.0 / (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
            x[i] *= inverse;
            y[i] *= inverse;
            z[i] *= inverse;
        }
        rays.extend((0..count.min(LANES)).map(|i| Ray::new(self.origin, Vec3::new(x[i], y[i], z[i]))));
    }
}
