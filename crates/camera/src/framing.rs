//! Cameras that frame points: the points fill a fraction of the picture and are in its middle.

use super::Perspective;
use juggler_math::portable::{self, power_of_ten};
use juggler_math::{DVec3, Vec3};

/// Size of points that are further apart, relative to their coordinates; others count as one point.
const MIN_SIZE: f64 = 1e-6;
/// Distance of the camera from the nearest point, at least, as a part of the size of all points.
const MIN_DISTANCE: f64 = 1e-3;
/// Distance of the camera from a single point, in scene units.
const SINGLE_DISTANCE: f64 = 5.0;
/// Steps of the bisection that moves the points to the middle, for all bits of a position.
const STEPS: u32 = 60;
/// Coordinates are rounded to this part of the power of ten below the distance of the nearest
/// point.
const ROUNDING: f64 = 1e-3;

/// How a camera frames points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// Direction from the points to the camera, of any length above 0.
    pub towards_camera: Vec3,
    /// Vertical field of view in degrees, between 0 and 180.
    pub vertical_fov_degrees: f32,
    /// Fraction of the picture's width or height that the points fill, above 0 and at most 1.
    pub fill: f32,
}

impl Default for Framing {
    /// From the front, slightly right and above, with the field of view of a portrait lens; the
    /// points fill 80 % of the picture.
    fn default() -> Self {
        Self { towards_camera: Vec3::new(0.45, 0.4, 1.0), vertical_fov_degrees: 30.0, fill: 0.8 }
    }
}

impl Framing {
    /// The nearest camera in the direction that sees all `points` within the fraction `fill` of a
    /// picture of `size` pixels, with the points in the middle of the picture. Its coordinates have
    /// few digits.
    pub fn camera(&self, points: &[Vec3], [width, height]: [u32; 2]) -> Perspective {
        let (vertical, horizontal) = self.slopes(f64::from(width.max(1)) / f64::from(height.max(1)));
        let axes = Axes::looking_from(self.towards_camera);
        let (low, high) = bounds(points);
        let (center, size) = ((low + high) * 0.5, (high - low).length());
        let is_single = size <= MIN_SIZE * low.abs().max(high.abs()).max_element();
        let seen: Vec<DVec3> = points.iter().map(|point| axes.local(point.as_dvec3() - center)).collect();
        let [across, along] = [0, 1].map(|axis| Side { axis, points: &seen });
        let nearest = seen.iter().map(|point| point.z).fold(0.0, f64::max);
        let least = nearest + if is_single { SINGLE_DISTANCE } else { MIN_DISTANCE * size };
        let distance = least.max(across.distance(horizontal)).max(along.distance(vertical));
        let middle = axes.world(DVec3::new(across.middle(distance), along.middle(distance), 0.0));
        let step = power_of_ten(distance - nearest) * ROUNDING;
        let rounded = |at: DVec3| at.to_array().map(|number| ((number / step).round() * step) as f32).into();
        Perspective {
            eye: rounded(center + middle + axes.back * distance),
            look_at: Some(rounded(center + middle)),
            up: axes.given_up,
            vertical_fov_degrees: Some(self.vertical_fov_degrees),
            ..Perspective::default()
        }
    }

    /// Largest tangents of angles up and right within the filled fraction of a picture.
    fn slopes(&self, aspect: f64) -> (f64, f64) {
        let half = f64::from(self.vertical_fov_degrees).to_radians() * 0.5;
        let vertical = portable::tan_f64(half) * f64::from(self.fill);
        (vertical, vertical * aspect)
    }
}

/// Axes of a camera, of unit length.
struct Axes {
    right: DVec3,
    up: DVec3,
    /// Against the view direction.
    back: DVec3,
    /// Direction of the picture's top in the camera's description.
    given_up: Vec3,
}

impl Axes {
    fn looking_from(towards_camera: Vec3) -> Self {
        let back = towards_camera.as_dvec3().try_normalize().unwrap_or(DVec3::Z);
        // Plans have north, −z, at the top; from below, pictures are turned about the x axis.
        let vertical = if back.y > 0.0 { Vec3::NEG_Z } else { Vec3::Z };
        let given_up = if back.x.abs().max(back.z.abs()) < 1e-3 { vertical } else { Vec3::Y };
        let right = given_up.as_dvec3().cross(back).normalize();
        Self { right, up: back.cross(right), back, given_up }
    }

    fn local(&self, vector: DVec3) -> DVec3 {
        DVec3::new(vector.dot(self.right), vector.dot(self.up), vector.dot(self.back))
    }

    fn world(&self, local: DVec3) -> DVec3 {
        self.right * local.x + self.up * local.y + self.back * local.z
    }
}

/// Points in a camera's axes, seen along one axis of the picture: 0 across, 1 along it.
struct Side<'p> {
    axis: usize,
    points: &'p [DVec3],
}

impl Side<'_> {
    /// Distance from which the points fill the picture exactly between two slopes of opposite sign.
    fn distance(&self, slope: f64) -> f64 {
        // A camera at (x, d) sees a point (p, z) if |p − x| ≤ slope (d − z). The boundaries of the
        // two conditions meet at the distance that leaves no room.
        let most = |sign: f64| {
            let needed = self.points.iter().map(|point| sign * point.to_array()[self.axis] + slope * point.z);
            needed.fold(f64::NEG_INFINITY, f64::max)
        };
        (most(1.0) + most(-1.0)) / (2.0 * slope)
    }

    /// Position of a camera at a distance that sees the points in the middle of the picture.
    fn middle(&self, distance: f64) -> f64 {
        if self.points.is_empty() {
            return 0.0;
        }
        let coordinates = || self.points.iter().map(|point| point.to_array()[self.axis]);
        let mut low = coordinates().fold(f64::INFINITY, f64::min);
        let mut high = coordinates().fold(f64::NEG_INFINITY, f64::max);
        for _ in 0..STEPS {
            let at = (low + high) * 0.5;
            let slopes = || {
                let slope = |point: &DVec3| (point.to_array()[self.axis] - at) / (distance - point.z);
                self.points.iter().map(slope)
            };
            let (least, most) = (slopes().fold(f64::INFINITY, f64::min), slopes().fold(f64::NEG_INFINITY, f64::max));
            if least + most > 0.0 { low = at } else { high = at }
        }
        (low + high) * 0.5
    }
}

fn bounds(points: &[Vec3]) -> (DVec3, DVec3) {
    let all = || points.iter().map(|point| point.as_dvec3());
    let low = all().reduce(DVec3::min).unwrap_or_default();
    (low, all().reduce(DVec3::max).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AnyCamera, Camera, WorldToFilm};
    use juggler_math::UVec2;

    const SIZES: [[u32; 2]; 3] = [[800, 600], [300, 900], [1, 1]];

    /// Largest and smallest film coordinates of points, as fractions of the way from its middle to
    /// its edge.
    fn extent(camera: &Perspective, points: &[Vec3], [width, height]: [u32; 2]) -> [[f64; 2]; 2] {
        let projection = camera.projection(UVec2::new(width, height)).unwrap();
        let film = WorldToFilm::new(&projection).unwrap();
        let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for point in points {
            let at = film.point(*point).unwrap();
            for (own, at) in found.iter_mut().zip([at.x / f64::from(width), at.y / f64::from(height)]) {
                let at = at * 2.0 - 1.0;
                *own = [own[0].min(at), own[1].max(at)];
            }
        }
        found
    }

    fn cloud(scale: Vec3, center: Vec3) -> Vec<Vec3> {
        let unit = |i: u32, k: u32| (i * k % 101) as f32 / 50.0 - 1.0;
        (0..200).map(|i| center + scale * Vec3::new(unit(i, 37), unit(i, 61), unit(i, 89))).collect()
    }

    #[test]
    fn points_fill_the_picture_and_are_in_its_middle() {
        let shapes = [
            (Vec3::ONE, Vec3::ZERO),
            (Vec3::new(5.0, 0.1, 0.1), Vec3::new(100.0, 5.0, -1.0)),
            (Vec3::new(0.1, 0.1, 30.0), Vec3::ZERO),
            (Vec3::splat(1e-3), Vec3::new(0.0, 1e-3, 0.0)),
            (Vec3::new(3e4, 2e4, 0.0), Vec3::ZERO),
        ];
        let views = [Vec3::new(0.45, 0.4, 1.0), Vec3::Y, -Vec3::Y, Vec3::X, Vec3::new(-3.0, 3.0, -3.0)];
        for ((scale, center), towards_camera) in shapes.into_iter().flat_map(|shape| views.map(|view| (shape, view))) {
            for (size, fill) in SIZES.into_iter().zip([0.8, 0.5, 1.0]) {
                let framing = Framing { towards_camera, fill, ..Framing::default() };
                let points = cloud(scale, center);
                let [[left, right], [top, bottom]] = extent(&framing.camera(&points, size), &points, size);
                let case = format!("{scale} {towards_camera} {size:?}: {left} {right} {top} {bottom}");
                assert!((left + right).abs() < 0.01 && (top + bottom).abs() < 0.01, "{case}");
                let filled = (right - left).max(bottom - top) * 0.5;
                assert!((filled - f64::from(fill)).abs() < 0.01, "{case}");
            }
        }
    }

    #[test]
    fn a_point_and_no_point_have_a_camera() {
        for points in [vec![], vec![Vec3::ONE], vec![Vec3::ONE; 3]] {
            let camera = Framing::default().camera(&points, [4, 3]);
            assert!(AnyCamera::from(camera).projection(UVec2::new(4, 3)).is_ok(), "{points:?}");
        }
    }

    #[test]
    fn coordinates_have_few_digits() {
        assert_eq!([0.5, 1.0, 7.0, 10.0, 12345.0].map(power_of_ten), [0.1, 1.0, 1.0, 10.0, 10000.0]);
        let camera = Framing::default().camera(&cloud(Vec3::ONE, Vec3::ZERO), [4, 3]);
        assert!(camera.eye.to_array().into_iter().all(|number| (number * 1e3 - (number * 1e3).round()).abs() < 1e-3));
    }

    /// From above, north is at the top of the picture; from below, it is at the bottom.
    #[test]
    fn views_along_the_vertical_axis_have_a_top() {
        for (towards_camera, up) in [(Vec3::Y, Vec3::NEG_Z), (-Vec3::Y, Vec3::Z), (Vec3::X, Vec3::Y)] {
            let framing = Framing { towards_camera, ..Framing::default() };
            assert_eq!(framing.camera(&cloud(Vec3::ONE, Vec3::ZERO), [4, 3]).up, up);
        }
    }
}
