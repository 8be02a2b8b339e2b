//! A sphere around the local origin.
//!
//! A ray `o + t d` hits it where `a t² - 2 b t + c = 0` with `a = d·d`, `b = -o·d`, `c = o·o - r²`.
//! The discriminant is computed as `a r² - |o × d|²` (Lagrange's identity), which like the form of
//! Haines, Günther and Akenine-Möller (Ray Tracing Gems 2019, chapter 7) does not cancel for small
//! and distant spheres, and needs no division. Since all arithmetic is in `f64`, huge spheres seen
//! from close by show no bands either.
//!
//! ```
//! use juggler_shape::{AnyShape, Sphere};
//! let shape: AnyShape = serde_json::from_str(r#"{"sphere": {"radius": 2}}"#)?;
//! assert_eq!(shape, Sphere { radius: 2.0 }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::arithmetic::{azimuth_turns, in_range, root_fractions, roots, to_f64};
use super::derivatives::{SurfaceDerivatives, dpdu_about_y};
use super::solid_angle::{area_pdf, area_sample};
use super::{Hit, InvalidShape, Shape, ShapeSample, SolidAngleShape, SurfacePoint, check};
use crate::surface::{Footprint, Surface};
use juggler_math::{Aabb, DVec3, Frame, Ray, Vec2, Vec3, portable, robust, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

/// A sphere around the origin of object space.
///
/// Surface coordinates: u is the longitude as a fraction of a turn (0 at +x, a quarter at -z), v
/// the latitude from 0 at the south pole (-y) to 1 at the north pole (+y).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Sphere {
    /// Radius in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub radius: f32,
}

impl Sphere {
    /// Creates a sphere of a radius around the origin.
    pub fn new(radius: f32) -> Self {
        Self { radius }
    }
}

impl Default for Sphere {
    fn default() -> Self {
        Self { radius: 1.0 }
    }
}

/// Distances at which a line enters and leaves a sphere; `None` for a miss. `origin` is relative to
/// the center; the direction may have any length.
#[inline]
pub fn sphere_interval(origin: DVec3, direction: DVec3, radius: f64) -> Option<(f64, f64)> {
    let a = direction.length_squared();
    let discriminant = a * (radius * radius) - origin.cross(direction).length_squared();
    if discriminant < 0.0 {
        return None;
    }
    let c = origin.length_squared() - radius * radius;
    Some(roots(a, -origin.dot(direction), c, discriminant))
}

/// The nearest hit in the ray's range with the sphere around `center`. It uses the arithmetic of
/// [`Sphere`] in object space, but is more precise, since the vector from the center to the ray's
/// origin is not rounded.
#[inline(always)]
pub fn intersect_sphere(center: Vec3, radius: f32, ray: &Ray) -> Option<Hit> {
    let (origin, direction) = to_f64(ray);
    let (origin, radius) = (origin - center.as_dvec3(), f64::from(radius));
    let a = direction.length_squared();
    let discriminant = a * (radius * radius) - origin.cross(direction).length_squared();
    if discriminant < 0.0 {
        return None;
    }
    let b = -origin.dot(direction);
    let c = origin.length_squared() - radius * radius;
    if c > 0.0 && b < 0.0 {
        // The ray starts outside and leaves, as shadow rays from the sphere do: a miss without a
        // square root.
        return None;
    }
    let [near, far] = root_fractions(a, b, c, discriminant);
    in_range(ray, near.0 / near.1, 0).or_else(|| in_range(ray, far.0 / far.1, 1))
}

/// Smallest error of [`sphere_surface`], in radii: twice the error of its Newton step.
const MIN_ERROR: f32 = f32::EPSILON / 128.0;

/// The surface at a hit that [`intersect_sphere`] returned for this ray; `local` is relative to the
/// center. Its `uv` is left zero: it takes two arctangents, which most materials do not need.
#[inline(always)]
pub fn sphere_surface(center: Vec3, radius: f32, ray: &Ray, hit: &Hit) -> Surface {
    let (origin, direction) = to_f64(ray);
    let (center, wide) = (center.as_dvec3(), f64::from(radius));
    let origin = origin - center;
    // From afar, the rounding of `hit.t` is not small relative to the sphere: solve again in f64.
    let afar = f64::from(hit.t) * direction.abs().max_element() > 64.0 * wide;
    let t = if afar { root(origin, direction, wide, hit) } else { f64::from(hit.t) };
    let off = (origin + direction * t) / wide;
    // The length is within 2^-16 of 1 by now; one Newton step for 1/√x leaves less than 2^-32.
    let unit = off * (1.5 - 0.5 * off.length_squared());
    let (point, normal) = ((center + unit * wide).as_vec3(), unit.as_vec3());
    // Near the origin of coordinates, rounding to f32 leaves less than that step does.
    let position_error = (robust::gamma(2) * point.abs().dot(normal.abs())).max(MIN_ERROR * radius);
    Surface {
        point,
        position_error,
        normal,
        shading_normal: normal,
        uv: Vec2::ZERO,
        local: normal * radius,
        local_normal: normal,
        footprint: Footprint::default(),
        barycentrics: Vec2::ZERO,
    }
}

/// Distance of a hit before it was rounded.
#[cold]
fn root(origin: DVec3, direction: DVec3, radius: f64, hit: &Hit) -> f64 {
    let crossing = sphere_interval(origin, direction, radius);
    crossing.map_or(f64::from(hit.t), |(near, far)| if hit.primitive == 0 { near } else { far })
}

/// Surface coordinates of a sphere at the unit normal `n`, object space.
pub fn longitude_latitude(n: Vec3) -> Vec2 {
    let across = (n.x * n.x + n.z * n.z).sqrt();
    Vec2::new(azimuth_turns(n.x, n.z), 0.5 + portable::atan2(n.y, across) / PI)
}

impl Shape for Sphere {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::positive("radius", self.radius)
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: Vec3::splat(-self.radius), max: Vec3::splat(self.radius) }
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        intersect_sphere(Vec3::ZERO, self.radius, ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let surface = sphere_surface(Vec3::ZERO, self.radius, ray, hit);
        Surface { uv: longitude_latitude(surface.normal), local: surface.point, ..surface }
    }

    fn derivatives(&self, local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        let across = (local.x * local.x + local.z * local.z).sqrt();
        let south_to_north = Vec3::new(-local.x * local.y / across, across, -local.z * local.y / across);
        SurfaceDerivatives::new(dpdu_about_y(local), south_to_north * PI)
    }

    fn area(&self) -> f32 {
        4.0 * PI * self.radius * self.radius
    }

    /// From outside, samples the cone that the sphere subtends uniformly (Shirley et al., Monte
    /// Carlo Techniques for Direct Lighting Calculations, 1996); from inside, samples the area
    /// uniformly.
    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let Some(cone) = SubtendedCone::seen_from(from, self.radius) else {
            let normal = warp::uniform_sphere(u);
            return area_sample(from, normal * self.radius, normal, self.area());
        };
        // Angles: θ at `from` off the axis, α at the center (PBR 4th ed., section 6.2.4).
        let one_minus_cos = u.x * cone.one_minus_cos;
        let sin_squared = one_minus_cos * (2.0 - one_minus_cos);
        let edge = (1.0 - sin_squared / cone.sin_squared).max(0.0).sqrt();
        let cos_alpha = (sin_squared / cone.sin + (1.0 - one_minus_cos) * edge).min(1.0);
        let sin_alpha = (1.0 - cos_alpha * cos_alpha).sqrt();
        let (sin, cos) = portable::sin_cos_turns(u.y);
        let normal = Frame::around(cone.axis).to_world(Vec3::new(sin_alpha * cos, sin_alpha * sin, cos_alpha));
        Some(ShapeSample { point: normal * self.radius, normal, pdf: cone.pdf() })
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        match SubtendedCone::seen_from(from, self.radius) {
            Some(cone) if at.normal.dot(from - at.point) > 0.0 => cone.pdf(),
            Some(_) => 0.0,
            None => area_pdf(from, at, self.area()),
        }
    }

    fn solid_angle_shape(&self) -> Option<SolidAngleShape> {
        Some(SolidAngleShape::Sphere { radius: self.radius })
    }

    fn sphere(&self) -> Option<&Sphere> {
        Some(self)
    }
}

/// Distance from the surface, in radii, up to which a point counts as on it.
const TOUCHING: f64 = 1e-6;

/// Cone that a sphere subtends, seen from outside.
struct SubtendedCone {
    /// Unit vector from the center to the reference point.
    axis: Vec3,
    /// Sine of half the opening angle, and its square.
    sin: f32,
    sin_squared: f32,
    /// One minus the cosine of half the opening angle, without cancellation.
    one_minus_cos: f32,
}

impl SubtendedCone {
    /// `None` from inside and from the surface itself, where rounding decides on which side a point
    /// is: from a point inside, the opposite wall is visible.
    fn seen_from(from: Vec3, radius: f32) -> Option<Self> {
        let (from, radius) = (from.as_dvec3(), f64::from(radius));
        let distance = from.length();
        let sin = radius / distance;
        (distance > radius * (1.0 + TOUCHING)).then(|| Self {
            axis: (from / distance).as_vec3(),
            sin: sin as f32,
            sin_squared: (sin * sin) as f32,
            one_minus_cos: (sin * sin / (1.0 + (1.0 - sin * sin).sqrt())) as f32,
        })
    }

    fn pdf(&self) -> f32 {
        warp::uniform_cone_pdf(self.one_minus_cos)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Sphere {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        [1.0, 2.5, 1e-4, 1e6].map(|radius| Self { radius }).to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    /// Rounding puts points on a sphere slightly inside or outside of it.
    #[test]
    fn a_point_on_the_surface_sees_the_opposite_side() {
        let mut random = Random::new(771);
        for radius in [0.3, 7.0, 1e5] {
            let sphere = Sphere { radius };
            for _ in 0..1000 {
                let from = random.unit_vector() * radius;
                let far = (0..20).filter_map(|_| sphere.sample(from, random.vec2()));
                let far = far.filter(|sample| sample.point.distance(from) > 0.2 * radius && sample.pdf > 0.0).count();
                // Uniform sampling by area puts 99 of 100 points this far away; sampling a cone of
                // half the sky would put no point there.
                assert!(far > 10, "{from}: {far}");
            }
        }
    }
}
