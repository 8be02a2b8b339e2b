//! Projection of a camera for one picture size.

use super::pose::CameraAxes;
use juggler_math::quaternion::slerp;
use juggler_math::{DMat3, DQuat, Ray, UVec2, Vec2, Vec3, warp};

/// Number of rays that [`Projection::rays`] generates together.
pub const LANES: usize = 8;

/// Difference of the components of two axes up to which they count as the same: rounding errors of
/// single precision.
const SAME_AXES: f64 = 1e-6;

/// Camera for one picture size, with everything that ray generation needs.
///
/// The film is at unit distance from the eye; that of a parallel projection contains the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Eye, in world space.
    pub(super) origin: Vec3,
    /// Vector from the eye to the film's top left corner.
    pub(super) corner: Vec3,
    /// Vector to the next pixel on the right.
    pub(super) right: Vec3,
    /// Vector to the next pixel below.
    pub(super) down: Vec3,
    /// Lens of the camera.
    pub(super) lens: Lens,
}

/// Lens of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lens {
    /// All rays pass through one point.
    Pinhole,
    /// Rays pass through a disk around the eye, spanned by two radii, with the focal plane at a
    /// distance of 1 / `focus`.
    Disk { right: Vec3, up: Vec3, focus: f32 },
    /// All rays are parallel.
    Parallel { forward: Vec3 },
}

impl Projection {
    /// Pinhole projection; `half` is half of the film's width and height at unit distance.
    pub(super) fn pinhole(axes: &CameraAxes, half: Vec2, size: UVec2) -> Self {
        Self::from_film(axes, axes.forward, half, size, Lens::Pinhole)
    }

    /// Thin-lens projection with a lens of `radius` around the eye, focused at `focus_distance`.
    pub(super) fn thin_lens(axes: &CameraAxes, half: Vec2, size: UVec2, radius: f32, focus_distance: f32) -> Self {
        let lens = Lens::Disk { right: axes.right * radius, up: axes.up * radius, focus: 1.0 / focus_distance };
        Self::from_film(axes, axes.forward, half, size, lens)
    }

    /// Parallel projection; rays start on a film through the eye.
    pub(super) fn parallel(axes: &CameraAxes, half: Vec2, size: UVec2) -> Self {
        Self::from_film(axes, Vec3::ZERO, half, size, Lens::Parallel { forward: axes.forward })
    }

    fn from_film(axes: &CameraAxes, center: Vec3, half: Vec2, size: UVec2, lens: Lens) -> Self {
        let pixel = half * 2.0 / size.max(UVec2::ONE).as_vec2();
        let corner = center - axes.right * half.x + axes.up * half.y;
        Self { origin: axes.eye, corner, right: axes.right * pixel.x, down: axes.up * -pixel.y, lens }
    }

    /// Divides the same film into `to` pixels instead of `from`.
    #[must_use]
    pub fn resampled(&self, from: UVec2, to: UVec2) -> Self {
        let scale = from.max(UVec2::ONE).as_vec2() / to.max(UVec2::ONE).as_vec2();
        Self { right: self.right * scale.x, down: self.down * scale.y, ..*self }
    }

    /// Interpolates to another projection: the rotation spherically, all else linearly. If the
    /// lenses are of different kinds, the nearer one is used.
    pub(super) fn interpolated(&self, other: &Self, fraction: f32) -> Self {
        let turns = self.turns_to(other, fraction);
        let between = |from: Vec3, to: Vec3| {
            let [from, to] = match turns {
                Some([first, second]) => [(first * from.as_dvec3()).as_vec3(), (second * to.as_dvec3()).as_vec3()],
                None => [from, to],
            };
            juggler_math::motion::lerp(from, to, fraction)
        };
        let lens = match (self.lens, other.lens) {
            (Lens::Disk { right, up, focus }, Lens::Disk { right: to_right, up: to_up, focus: to_focus }) => {
                Lens::Disk {
                    right: between(right, to_right),
                    up: between(up, to_up),
                    focus: focus * (1.0 - fraction) + to_focus * fraction,
                }
            }
            (Lens::Parallel { forward }, Lens::Parallel { forward: to }) => {
                Lens::Parallel { forward: between(forward, to).try_normalize().unwrap_or(forward) }
            }
            (from, to) => {
                if fraction < 0.5 {
                    from
                } else {
                    to
                }
            }
        };
        Self {
            origin: juggler_math::motion::lerp(self.origin, other.origin, fraction),
            corner: between(self.corner, other.corner),
            right: between(self.right, other.right),
            down: between(self.down, other.down),
            lens,
        }
    }

    /// Rotations of this projection and of another one to the orientation between them; `None` if
    /// both have the same orientation.
    fn turns_to(&self, other: &Self, fraction: f32) -> Option<[DQuat; 2]> {
        let axes = |projection: &Self| {
            let [right, down] = [projection.right, projection.down].map(|axis| axis.as_dvec3().normalize_or_zero());
            DMat3::from_cols(right, down, right.cross(down))
        };
        let [from, to] = [axes(self), axes(other)];
        if from.abs_diff_eq(to, SAME_AXES) {
            return None;
        }
        let [from, to] = [from, to].map(|axes| DQuat::from_mat3(&axes));
        let middle = slerp(from, to, f64::from(fraction));
        Some([middle * from.inverse(), middle * to.inverse()])
    }

    /// Eye of the camera, in world space.
    pub fn eye(&self) -> Vec3 {
        self.origin
    }

    /// View direction: the unit normal of the film that points into the picture.
    pub fn view_direction(&self) -> Vec3 {
        let [right, down] = [self.right, self.down].map(|v| v.as_dvec3().normalize_or_zero());
        right.cross(down).normalize_or_zero().as_vec3()
    }

    /// Pixel size at the ray origin, and its growth per unit of distance, at the center of the
    /// film.
    pub fn pixel_footprint(&self) -> [f32; 2] {
        let size = (self.right.length() * self.down.length()).sqrt();
        if matches!(self.lens, Lens::Parallel { .. }) { [size, 0.0] } else { [0.0, size] }
    }

    /// Whether rays depend on a lens sample.
    #[inline]
    pub fn needs_lens(&self) -> bool {
        matches!(self.lens, Lens::Disk { .. })
    }

    /// Generates the ray through a film point in pixels, with the lens sample `lens` in the unit
    /// square. The direction is a unit vector; the ray carries `time`.
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

    /// Appends the first `count` of eight rays, identical to those of [`Projection::ray`]; `films`
    /// holds all x and all y.
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
