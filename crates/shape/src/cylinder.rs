//! A cylinder around the y axis, closed by two flat caps unless `capped` is false.
//!
//! ```
//! use juggler_shape::{AnyShape, Cylinder};
//! let shape: AnyShape = serde_json::from_str(
//!     r#"{"cylinder": {"radius": 0.5, "y_min": 0, "y_max": 2, "capped": false}}"#,
//! )?;
//! assert_eq!(shape, Cylinder { radius: 0.5, y_min: 0.0, y_max: 2.0, capped: false }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::arithmetic::{
    EDGE_MARGIN, azimuth_turns, clamp_within, first_in_range, intersect_infinite_cylinder, to_f64,
};
use super::derivatives::{SurfaceDerivatives, disk_derivatives, dpdu_about_y};
use super::solid_angle::{area_pdf, area_sample, select_by_weight};
use super::tube::infinite_cylinder_surface;
use super::{Hit, InvalidShape, Shape, ShapeSample, SurfacePoint, check};
use crate::surface::Surface;
use juggler_math::{Aabb, DVec3, Ray, Vec2, Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

/// A circular cylinder around the y axis from `y_min` to `y_max`.
///
/// Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z); v goes
/// from 0 at `y_min` to 1 at `y_max` on the side, from 0 at the rim to 1 at the center on the caps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Cylinder {
    /// Radius in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub radius: f32,
    /// Lower end on the y axis, in scene units.
    #[schemars(extend("x-unit" = "scene units"))]
    pub y_min: f32,
    /// Upper end on the y axis, in scene units; greater than `y_min`.
    #[schemars(extend("x-unit" = "scene units"))]
    pub y_max: f32,
    /// Whether disks close both ends and make the cylinder a solid; without them, the inside is
    /// visible.
    pub capped: bool,
}

impl Default for Cylinder {
    fn default() -> Self {
        Self { radius: 1.0, y_min: -1.0, y_max: 1.0, capped: true }
    }
}

/// Distance from the surface, relative to the size, up to which a point counts as on it.
const TOUCHING: f32 = 1e-5;

/// Parts: the side where a ray enters the tube, the side where it leaves it, and the caps.
const SIDE: u32 = 0;
const FAR_SIDE: u32 = 1;
const BOTTOM: u32 = 2;
const TOP: u32 = 3;

impl Cylinder {
    /// Creates a solid cylinder of a radius around the y axis, between two heights.
    pub fn new(radius: f32, y_min: f32, y_max: f32) -> Self {
        Self { radius, y_min, y_max, ..Self::default() }
    }

    fn contains_y(&self, y: f64) -> bool {
        (f64::from(self.y_min)..=f64::from(self.y_max)).contains(&y)
    }

    /// Interval of a ray between the planes of both ends; each bound has the cap that the ray
    /// crosses.
    fn between_ends(&self, origin: DVec3, direction: DVec3) -> Option<[(f64, u32); 2]> {
        if direction.y == 0.0 {
            return self.contains_y(origin.y).then_some([(f64::NEG_INFINITY, BOTTOM), (f64::INFINITY, TOP)]);
        }
        let bottom = ((f64::from(self.y_min) - origin.y) / direction.y, BOTTOM);
        let top = ((f64::from(self.y_max) - origin.y) / direction.y, TOP);
        Some(if direction.y > 0.0 { [bottom, top] } else { [top, bottom] })
    }

    /// Interval of a ray inside the infinite cylinder.
    fn inside_tube(&self, origin: DVec3, direction: DVec3) -> Option<[(f64, u32); 2]> {
        let radius = f64::from(self.radius);
        if direction.x == 0.0 && direction.z == 0.0 {
            let inside = origin.x * origin.x + origin.z * origin.z <= radius * radius;
            return inside.then_some([(f64::NEG_INFINITY, SIDE), (f64::INFINITY, FAR_SIDE)]);
        }
        intersect_infinite_cylinder(origin, direction, radius).map(|(near, far)| [(near, SIDE), (far, FAR_SIDE)])
    }

    /// Running sums of the areas of side, bottom and top that are visible from `from`, and half the
    /// angle of the visible side. From inside and from the surface itself, everything is visible;
    /// an open cylinder, which may occlude itself, counts as wholly visible too.
    fn visible_areas(&self, from: Vec3) -> ([f64; 3], f32) {
        let across = Vec2::new(from.x, from.z).length();
        let margin = TOUCHING * self.radius.max(self.y_max - self.y_min);
        let (above, below) = (from.y > self.y_max + margin, from.y < self.y_min - margin);
        let beside = across > self.radius + margin;
        let everything = !self.capped || !(above || below || beside);
        let half_angle = match (everything, beside) {
            (true, _) => PI,
            (false, true) => portable::acos(self.radius / across),
            (false, false) => 0.0,
        };
        let cap = |seen: bool| {
            if self.capped && (seen || everything) { f64::from(PI * self.radius * self.radius) } else { 0.0 }
        };
        let side = f64::from(2.0 * half_angle * self.radius * (self.y_max - self.y_min));
        ([side, side + cap(below), side + cap(below) + cap(above)], half_angle)
    }

    fn cap_surface(&self, ray: &Ray, primitive: u32) -> Surface {
        let (origin, direction) = to_f64(ray);
        let (y, normal) = if primitive == TOP { (self.y_max, Vec3::Y) } else { (self.y_min, Vec3::NEG_Y) };
        let t = (f64::from(y) - origin.y) / direction.y;
        let found = (origin + direction * t).as_vec3();
        let across = Vec2::new(found.x, found.z).clamp_length_max(self.radius * (1.0 - EDGE_MARGIN));
        let point = Vec3::new(across.x, y, across.y);
        let inwards = 1.0 - across.length() / self.radius;
        Surface::new(point, 0.0, normal, Vec2::new(azimuth_turns(point.x, point.z), inwards.max(0.0)))
    }
}

impl Shape for Cylinder {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::positive("radius", self.radius)?;
        check::coordinate("y_min", self.y_min)?;
        check::coordinate("y_max", self.y_max)?;
        if self.y_max > self.y_min {
            return Ok(());
        }
        let message = format!("`y_max` must be greater than `y_min` {}, is {}", self.y_min, self.y_max);
        Err(check::invalid("y_max", message))
    }

    fn bounds(&self) -> Aabb {
        let r = self.radius;
        Aabb { min: Vec3::new(-r, self.y_min, -r), max: Vec3::new(r, self.y_max, r) }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (origin, direction) = to_f64(ray);
        let tube = self.inside_tube(origin, direction)?;
        if !self.capped {
            return first_in_range(
                ray,
                tube.map(|(t, primitive)| {
                    (if self.contains_y(origin.y + direction.y * t) { t } else { f64::NAN }, primitive)
                }),
            );
        }
        let ends = self.between_ends(origin, direction)?;
        let enter = if tube[0].0 > ends[0].0 { tube[0] } else { ends[0] };
        let leave = if tube[1].0 < ends[1].0 { tube[1] } else { ends[1] };
        if enter.0 > leave.0 { None } else { first_in_range(ray, [enter, leave]) }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        if hit.primitive == BOTTOM || hit.primitive == TOP {
            return self.cap_surface(ray, hit.primitive);
        }
        let side = infinite_cylinder_surface(self.radius, ray, hit);
        let margin = EDGE_MARGIN * self.radius.max(self.y_max - self.y_min);
        let point = side.point.with_y(clamp_within(side.point.y, self.y_min, self.y_max, margin));
        let v = (point.y - self.y_min) / (self.y_max - self.y_min);
        Surface { point, local: point, uv: side.uv.with_y(v), ..side }
    }

    fn derivatives(&self, local: Vec3, hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        if hit.primitive == BOTTOM || hit.primitive == TOP {
            return disk_derivatives(local, self.radius);
        }
        SurfaceDerivatives::new(dpdu_about_y(local), Vec3::Y * (self.y_max - self.y_min))
    }

    fn area(&self) -> f32 {
        let caps = if self.capped { self.radius } else { 0.0 };
        2.0 * PI * self.radius * (self.y_max - self.y_min + caps)
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let (areas, half_angle) = self.visible_areas(from);
        let (primitive, rest) = select_by_weight(&areas, u.x)?;
        let area = areas[2] as f32;
        if primitive > 0 {
            let (y, normal) = if primitive == 1 { (self.y_min, Vec3::NEG_Y) } else { (self.y_max, Vec3::Y) };
            let (sin, cos) = portable::sin_cos_turns(u.y);
            let across = self.radius * rest.sqrt();
            return area_sample(from, Vec3::new(across * cos, y, across * sin), normal, area);
        }
        let towards = Vec2::new(from.x, from.z).normalize_or(Vec2::X);
        let (sin, cos) = portable::sin_cos(half_angle * (2.0 * rest - 1.0));
        let normal = Vec3::new(towards.x * cos - towards.y * sin, 0.0, towards.y * cos + towards.x * sin);
        let y = self.y_min + u.y * (self.y_max - self.y_min);
        area_sample(from, normal * self.radius + Vec3::Y * y, normal, area)
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        let ([side, bottom, all], half_angle) = self.visible_areas(from);
        let is_picked = match at.primitive {
            BOTTOM => bottom > side,
            TOP => all > bottom,
            _ => half_angle == PI || at.normal.dot(from - at.point) > 0.0,
        };
        if is_picked { area_pdf(from, at, all as f32) } else { 0.0 }
    }
}

#[cfg(any(test, feature = "testing"))]
impl Cylinder {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let made = |radius, y_min, y_max, capped| Self { radius, y_min, y_max, capped };
        vec![
            Self::default(),
            made(0.5, 0.0, 2.0, false),
            made(1e-3, -1.0, 1.0, true),
            made(2.0, 3.0, 3.01, true),
            made(1e-4, -2e-4, 1e-4, true),
            made(1e6, -1e6, 2e6, true),
        ]
    }
}
