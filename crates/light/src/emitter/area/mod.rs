//! Places on surfaces that shine, picked evenly by the solid angle under which a point sees them wherever there is a
//! way to do so, else evenly by area. World space; which side shines is the caller's business.

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

/// A place on a surface that shines, seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSample {
    /// The place, world space; on the surface up to rounding.
    pub point: Vec3,
    /// The surface's unit normal there, to its front (outwards for a sphere).
    pub normal: Vec3,
    /// Where on a rectangle or triangle, in shares of its two edges; 0 for others.
    pub edges: Vec2,
    /// Unit direction towards the place.
    pub wi: Vec3,
    /// How far it is, above 0.
    pub distance: f32,
    /// Density per steradian with which `wi` was chosen, above 0.
    pub pdf: f32,
}

/// A surface that shines. Large kinds stand in boxes: scenes have millions of emitting spheres.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaEmitter {
    /// A sphere.
    Sphere(SphereEmitter),
    /// A flat, full disk.
    Disk(Box<DiskEmitter>),
    /// A rectangle.
    Rectangle(Box<RectangleEmitter>),
    /// A triangle.
    Triangle(Box<TriangleEmitter>),
}

impl AreaEmitter {
    /// The place for `u` in the unit square; `None` when it is seen edge-on, or from its very place.
    #[inline]
    pub fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        match self {
            Self::Sphere(sphere) => sphere.sample(from, u),
            Self::Disk(disk) => disk.sample(from, u),
            Self::Rectangle(rectangle) => rectangle.sample(from, u),
            Self::Triangle(triangle) => triangle.sample(from, u),
        }
    }

    /// Density per steradian with which `sample` picks the direction to `point`, which lies on the surface and, on a
    /// sphere seen from outside, on the side that is seen.
    #[inline]
    pub fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        match self {
            Self::Sphere(sphere) => sphere.pdf(from, point),
            Self::Disk(disk) => disk.pdf(from, point),
            Self::Rectangle(rectangle) => rectangle.pdf(from, point),
            Self::Triangle(triangle) => triangle.pdf(from, point),
        }
    }

    /// Area of the front.
    pub fn area(&self) -> f32 {
        match self {
            Self::Sphere(sphere) => sphere.area() as f32,
            Self::Disk(disk) => disk.area() as f32,
            Self::Rectangle(rectangle) => rectangle.area() as f32,
            Self::Triangle(triangle) => triangle.area() as f32,
        }
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        match self {
            Self::Sphere(_) => 0,
            Self::Disk(disk) => size_of_val(&**disk),
            Self::Rectangle(rectangle) => size_of_val(&**rectangle),
            Self::Triangle(triangle) => size_of_val(&**triangle),
        }
    }

    /// Its bounds in a light tree, when every place has this radiance (its luminance).
    pub fn light_bounds(&self, radiance: f32, two_sided: bool) -> LightBounds {
        let seen = if matches!(self, Self::Sphere(_)) { 0.25 * self.area() } else { self.area() };
        let power = 4.0 * std::f32::consts::PI * seen * radiance;
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

/// The sample of a place, chosen with density `pdf` per steradian.
fn seen(from: DVec3, point: DVec3, normal: DVec3, pdf: f64) -> Option<AreaSample> {
    let way = point - from;
    let (distance, pdf) = (way.length(), pdf as f32);
    let usable = distance as f32 > 0.0 && pdf > 0.0 && pdf < f32::INFINITY;
    usable.then(|| AreaSample {
        point: point.as_vec3(),
        normal: normal.as_vec3(),
        edges: Vec2::ZERO,
        wi: (way / distance).as_vec3(),
        distance: distance as f32,
        pdf,
    })
}

/// Density per steradian seen from `from` of a place that is picked evenly among `area`: distance² / (area · cos)
/// (PBR 4th ed., section 4.2.3); 0 where it is not a number to divide by.
fn area_density(from: DVec3, point: DVec3, normal: DVec3, area: f64) -> f64 {
    let way = point - from;
    let squared = way.length_squared();
    let density = squared * squared.sqrt() / (way.dot(normal).abs() * area);
    if density < f64::from(f32::MAX) { density } else { 0.0 }
}

/// The box around points in double precision, rounded outwards.
fn box_around(points: impl IntoIterator<Item = DVec3>) -> Aabb {
    let outwards = |bounds: Aabb, point: DVec3| {
        let near = point.as_vec3();
        let slack = near.abs() * f32::EPSILON;
        bounds.with_point(near - slack).with_point(near + slack)
    };
    points.into_iter().fold(Aabb::EMPTY, outwards)
}
