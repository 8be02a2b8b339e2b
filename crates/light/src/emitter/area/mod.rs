//! Sampling of points on emitting surfaces in world space: uniformly by solid angle where a mapping
//! exists, otherwise uniformly by area. The caller decides which side emits.

use super::LightBounds;
use juggler_math::{Aabb, DVec3, Vec2, Vec3};

mod disk;
mod flat;
mod rectangle;
mod sphere;
#[cfg(test)]
mod tests;
mod triangle;

pub use disk::DiskEmitter;
use flat::Flat;
pub use rectangle::RectangleEmitter;
pub use sphere::SphereEmitter;
pub use triangle::TriangleEmitter;

/// Sampled point on an emitting surface, as seen from a shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSample {
    /// Sampled point, in world space; on the surface up to rounding.
    pub point: Vec3,
    /// Unit normal at the point, towards the front (outward for a sphere).
    pub normal: Vec3,
    /// Position on a rectangle or triangle in units of its two edges; zero for other surfaces.
    pub uv: Vec2,
    /// Unit direction towards the point.
    pub wi: Vec3,
    /// Distance of the point, above 0.
    pub distance: f32,
    /// Density per steradian of `wi`, above 0.
    pub pdf: f32,
}

/// Emitting surface. Large variants are boxed, because scenes may have millions of emitting
/// spheres.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaEmitter {
    /// Sphere.
    Sphere(SphereEmitter),
    /// Flat, full disk.
    Disk(Box<DiskEmitter>),
    /// Rectangle.
    Rectangle(Box<RectangleEmitter>),
    /// Triangle.
    Triangle(Box<TriangleEmitter>),
}

impl AreaEmitter {
    /// Samples a point as seen from `from`, with `u` in the unit square. `None` if the surface is
    /// seen edge-on or `from` is the sampled point itself.
    #[inline]
    pub fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        match self {
            Self::Sphere(sphere) => sphere.sample(from, u),
            Self::Disk(disk) => disk.sample(from, u),
            Self::Rectangle(rectangle) => rectangle.sample(from, u),
            Self::Triangle(triangle) => triangle.sample(from, u),
        }
    }

    /// Density per steradian with which [`AreaEmitter::sample`] samples the direction to `point`.
    /// The point lies on the surface and, for a sphere seen from outside, on its visible side.
    #[inline]
    pub fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        match self {
            Self::Sphere(sphere) => sphere.pdf(from, point),
            Self::Disk(disk) => disk.pdf(from, point),
            Self::Rectangle(rectangle) => rectangle.pdf(from, point),
            Self::Triangle(triangle) => triangle.pdf(from, point),
        }
    }

    /// Area of the front in square scene units.
    pub fn area(&self) -> f32 {
        match self {
            Self::Sphere(sphere) => sphere.area() as f32,
            Self::Disk(disk) => disk.area() as f32,
            Self::Rectangle(rectangle) => rectangle.area() as f32,
            Self::Triangle(triangle) => triangle.area() as f32,
        }
    }

    /// Heap memory in bytes.
    pub fn heap_bytes(&self) -> usize {
        match self {
            Self::Sphere(_) => 0,
            Self::Disk(disk) => size_of_val(&**disk),
            Self::Rectangle(rectangle) => size_of_val(&**rectangle),
            Self::Triangle(triangle) => size_of_val(&**triangle),
        }
    }

    /// Bounds for the light tree, for a uniform radiance with the luminance `radiance`.
    pub fn light_bounds(&self, radiance: f32, two_sided: bool) -> LightBounds {
        let area_sample = if matches!(self, Self::Sphere(_)) { 0.25 * self.area() } else { self.area() };
        let power = 4.0 * std::f32::consts::PI * area_sample * radiance;
        let (bounds, axis, cos_theta_o) = match self {
            Self::Sphere(sphere) => (sphere.bounds(), Vec3::Z, -1.0),
            Self::Disk(disk) => (disk.bounds(), disk.normal(), 1.0),
            Self::Rectangle(rectangle) => (rectangle.bounds(), rectangle.normal(), 1.0),
            Self::Triangle(triangle) => (triangle.bounds(), triangle.normal(), 1.0),
        };
        LightBounds { bounds, axis, cos_theta_o, cos_theta_e: 0.0, power, two_sided }
    }
}

impl From<SphereEmitter> for AreaEmitter {
    fn from(sphere: SphereEmitter) -> Self {
        Self::Sphere(sphere)
    }
}

impl From<DiskEmitter> for AreaEmitter {
    fn from(disk: DiskEmitter) -> Self {
        Self::Disk(Box::new(disk))
    }
}

impl From<RectangleEmitter> for AreaEmitter {
    fn from(rectangle: RectangleEmitter) -> Self {
        Self::Rectangle(Box::new(rectangle))
    }
}

impl From<TriangleEmitter> for AreaEmitter {
    fn from(triangle: TriangleEmitter) -> Self {
        Self::Triangle(Box::new(triangle))
    }
}

/// Builds the sample of a point with density `pdf` per steradian.
fn area_sample(from: DVec3, point: DVec3, normal: DVec3, pdf: f64) -> Option<AreaSample> {
    let to_point = point - from;
    let (distance, pdf) = (to_point.length(), pdf as f32);
    let usable = distance as f32 > 0.0 && pdf > 0.0 && pdf < f32::INFINITY;
    usable.then(|| AreaSample {
        point: point.as_vec3(),
        normal: normal.as_vec3(),
        uv: Vec2::ZERO,
        wi: (to_point / distance).as_vec3(),
        distance: distance as f32,
        pdf,
    })
}

/// Density per steradian, as seen from `from`, of a point sampled uniformly on `area`: distance² /
/// (area · cos) (PBR 4th ed., section 4.2.3). 0 where it overflows.
fn uniform_area_pdf(from: DVec3, point: DVec3, normal: DVec3, area: f64) -> f64 {
    let to_point = point - from;
    let squared = to_point.length_squared();
    let density = squared * squared.sqrt() / (to_point.dot(normal).abs() * area);
    if density < f64::from(f32::MAX) { density } else { 0.0 }
}

/// Bounding box of points in double precision, rounded outward.
fn box_around(points: impl IntoIterator<Item = DVec3>) -> Aabb {
    let outwards = |bounds: Aabb, point: DVec3| {
        let near = point.as_vec3();
        let slack = near.abs() * f32::EPSILON;
        bounds.with_point(near - slack).with_point(near + slack)
    };
    points.into_iter().fold(Aabb::EMPTY, outwards)
}
