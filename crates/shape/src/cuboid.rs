//! An axis-aligned box; a transform rotates and shears it.
//!
//! ```
//! use juggler_shape::{AnyShape, Cuboid};
//! let shape: AnyShape = serde_json::from_str(
//!     r#"{"cuboid": {"min": [-1, 0, -1], "max": [1, 0.5, 1]}}"#,
//! )?;
//! assert_eq!(shape, Cuboid { min: [-1.0, 0.0, -1.0].into(), max: [1.0, 0.5, 1.0].into() }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::SurfaceDerivatives;
use super::arithmetic::{EDGE_MARGIN, clamp_within, first_in_range, to_f64};
use super::solid_angle::{area_pdf, area_sample, select_by_weight};
use super::{Hit, InvalidShape, Shape, ShapeSample, SurfacePoint, check};
use crate::surface::Surface;
use juggler_math::{Aabb, Ray, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An axis-aligned box from one corner to the opposite one; by default the cube of edge 1 around
/// the origin.
///
/// Surface coordinates from 0 to 1 on each face. On the sides, v grows with y and u to the right,
/// seen from outside. On top and bottom, u grows with x; v grows with -z on top and with z on the
/// bottom.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Cuboid {
    /// Corner of the smallest coordinates, in scene units.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub min: Vec3,
    /// Corner of the largest coordinates, in scene units, each greater than that of `min`.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub max: Vec3,
}

/// Distance from the surface, relative to the longest edge, up to which a point counts as on it.
const TOUCHING: f32 = 1e-5;

impl Default for Cuboid {
    fn default() -> Self {
        Self { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) }
    }
}

/// Axis and side of a face, which is numbered `2 axis + side`; side 1 is at `max`.
fn axis_and_side(face: u32) -> (usize, bool) {
    ((face as usize / 2).min(2), face % 2 == 1)
}

impl Cuboid {
    /// Creates a cuboid between the corners of the smallest and of the largest coordinates.
    pub fn new(min: impl Into<Vec3>, max: impl Into<Vec3>) -> Self {
        Self { min: min.into(), max: max.into() }
    }

    fn normal(face: u32) -> Vec3 {
        let (axis, far) = axis_and_side(face);
        if far { Vec3::AXES[axis] } else { -Vec3::AXES[axis] }
    }

    /// Running sums of the areas of the faces that are visible from `from`: up to three from
    /// outside, all six from inside and from the surface itself, where rounding decides on which
    /// side a point is.
    fn visible_areas(&self, from: Vec3) -> [f64; 6] {
        let e = self.max - self.min;
        let areas = [e.y * e.z, e.z * e.x, e.x * e.y].map(f64::from);
        let margin = Vec3::splat(TOUCHING * e.max_element());
        let inside = from.cmpge(self.min - margin).all() && from.cmple(self.max + margin).all();
        let mut sum = 0.0;
        std::array::from_fn(|face| {
            let (axis, far) = axis_and_side(face as u32);
            let faces = if far { from[axis] > self.max[axis] } else { from[axis] < self.min[axis] };
            sum += if faces || inside { areas[axis] } else { 0.0 };
            sum
        })
    }

    /// Surface coordinates on a face; `unit` is the position of the point between both corners, 0
    /// to 1.
    fn uv(face: u32, unit: Vec3) -> Vec2 {
        let Vec3 { x, y, z } = unit;
        match face {
            0 => Vec2::new(z, y),
            1 => Vec2::new(1.0 - z, y),
            2 => Vec2::new(x, z),
            3 => Vec2::new(x, 1.0 - z),
            4 => Vec2::new(1.0 - x, y),
            _ => Vec2::new(x, y),
        }
    }
}

impl Shape for Cuboid {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::point("min", self.min)?;
        check::point("max", self.max)?;
        for axis in 0..3 {
            if self.max[axis] <= self.min[axis] {
                let message = format!(
                    "`max[{axis}]` must be greater than `min[{axis}]` {}, is {}",
                    self.min[axis], self.max[axis]
                );
                return Err(check::invalid(format!("max[{axis}]"), message));
            }
        }
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }

    /// Slab test (Kay and Kajiya 1986), with correctly rounded divisions in `f64`.
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (origin, direction) = to_f64(ray);
        let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for axis in 0..3 {
            let (o, d) = (origin[axis], direction[axis]);
            let (low, high) = (f64::from(self.min[axis]), f64::from(self.max[axis]));
            if d == 0.0 {
                if o < low || o > high {
                    return None;
                }
                continue;
            }
            let face = 2 * axis as u32;
            let (low, high) = (((low - o) / d, face), ((high - o) / d, face + 1));
            let (near, far) = if d > 0.0 { (low, high) } else { (high, low) };
            enter = if near.0 > enter.0 { near } else { enter };
            leave = if far.0 < leave.0 { far } else { leave };
        }
        if enter.0 > leave.0 { None } else { first_in_range(ray, [enter, leave]) }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let (origin, direction) = to_f64(ray);
        let (axis, far) = axis_and_side(hit.primitive);
        let plane = if far { self.max[axis] } else { self.min[axis] };
        let t = (f64::from(plane) - origin[axis]) / direction[axis];
        let found = (origin + direction * t).as_vec3();
        let margin = EDGE_MARGIN * (self.max - self.min).max_element();
        let within = |axis: usize| clamp_within(found[axis], self.min[axis], self.max[axis], margin);
        let mut point = Vec3::new(within(0), within(1), within(2));
        point[axis] = plane;
        let unit = (point - self.min) / (self.max - self.min);
        Surface::new(point, 0.0, Self::normal(hit.primitive), Self::uv(hit.primitive, unit))
    }

    fn derivatives(&self, _local: Vec3, hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        let size = self.max - self.min;
        let (x, y, z) = (Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z);
        let (u, v) = match hit.primitive {
            0 => (z, y),
            1 => (-z, y),
            2 => (x, z),
            3 => (x, -z),
            4 => (-x, y),
            _ => (x, y),
        };
        SurfaceDerivatives::new(u, v)
    }

    fn area(&self) -> f32 {
        self.bounds().area()
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let areas = self.visible_areas(from);
        let (face, rest) = select_by_weight(&areas, u.x)?;
        let (axis, far) = axis_and_side(face as u32);
        let mut unit = Vec3::ZERO;
        unit[(axis + 1) % 3] = rest;
        unit[(axis + 2) % 3] = u.y;
        let mut point = self.min + (self.max - self.min) * unit;
        point[axis] = if far { self.max[axis] } else { self.min[axis] };
        area_sample(from, point, Self::normal(face as u32), areas[5] as f32)
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        let areas = self.visible_areas(from);
        let [below, through] = [at.primitive.checked_sub(1), Some(at.primitive)]
            .map(|face| face.and_then(|face| areas.get(face as usize)).copied().unwrap_or(0.0));
        if through > below { area_pdf(from, at, areas[5] as f32) } else { 0.0 }
    }
}

#[cfg(any(test, feature = "testing"))]
impl Cuboid {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let made = |min: [f32; 3], max: [f32; 3]| Self { min: min.into(), max: max.into() };
        vec![
            Self::default(),
            made([2.0, 3.0, -5.0], [4.0, 3.5, 1.0]),
            made([-1.0, -1.0, 0.0], [1.0, 1.0, 1e-3]),
            made([-1e-4, 0.0, 0.0], [1e-4, 1e-4, 2e-4]),
            made([-1e6, -2e6, 0.0], [1e6, 1e6, 1e6]),
        ]
    }
}
