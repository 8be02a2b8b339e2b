//! Bounds of groups of lights, and the cost of a group in the build.

use super::LightBounds;
use super::emission_profile::EmissionProfile;
use juggler_math::{Aabb, DVec3, Vec3, portable};
use std::f64::consts::PI;

/// Light during construction of the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct BuildLight {
    pub index: u32,
    /// Center of the bounding box.
    pub center: Vec3,
    /// Bounds in the tree's coordinates, with the power relative to the strongest light.
    pub light: LightBounds,
}

/// Bounds of a group of lights, as a slot of a node stores them.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChildBounds {
    pub center: Vec3,
    pub radius: f32,
    pub axis: Vec3,
    pub cos_spread: f32,
    pub cos_emission: f32,
    pub power: f32,
    pub two_sided: bool,
    pub emission: EmissionProfile,
}

impl ChildBounds {
    /// Conservative bounds: a sphere around the box with its center at the centroid of the power, a
    /// cone around all cones, and the widest emission.
    pub fn from_lights(items: &[BuildLight]) -> Self {
        /// Relative enlargement of spheres, more than the rounding of angles close to a right
        /// angle.
        const RADIUS_SLACK: f64 = 1e-4;
        /// Minimum radius, which keeps squares away from 0.
        const MIN_RADIUS: f64 = 1e-9;
        const COSINE_SLACK: f64 = 1e-6;
        const EMISSION_SLACK: f32 = 1e-5;
        let bounds = items.iter().fold(Aabb::EMPTY, |sum, item| sum.union(item.light.bounds));
        let power = items.iter().map(|item| f64::from(item.light.power)).sum();
        let center = center(items, power);
        let corner = (bounds.max.as_dvec3() - center.as_dvec3()).max(center.as_dvec3() - bounds.min.as_dvec3());
        let two_sided = items.iter().any(|item| item.light.two_sided);
        let axis = mean_axis(items, two_sided);
        let cos = items.iter().map(|item| farthest_cos(item, axis, two_sided)).fold(1.0, f64::min);
        let cos_emission = items.iter().map(|item| item.light.cos_theta_e).fold(1.0, f32::min);
        Self {
            center,
            radius: (corner.length() * (1.0 + RADIUS_SLACK)).max(MIN_RADIUS) as f32,
            axis,
            cos_spread: (cos - COSINE_SLACK).max(-1.0) as f32,
            cos_emission: cos_emission - EMISSION_SLACK,
            power: power as f32,
            two_sided,
            emission: EmissionProfile::from_lights(items, power),
        }
    }
}

/// Centroid of the power.
fn center(items: &[BuildLight], power: f64) -> Vec3 {
    let sum: DVec3 = items.iter().map(|item| item.center.as_dvec3() * f64::from(item.light.power)).sum();
    (sum / power).as_vec3()
}

/// Mean axis. If lights emit from both sides, axes are flipped to the side of the first.
fn mean_axis(items: &[BuildLight], two_sided: bool) -> Vec3 {
    let first = items.first().map_or(Vec3::Z, |item| item.light.axis);
    let flipped = |axis: Vec3| if two_sided && axis.dot(first) < 0.0 { -axis } else { axis };
    let sum: DVec3 = items.iter().map(|item| flipped(item.light.axis).as_dvec3()).sum();
    let length = sum.length();
    if length > 1e-6 * items.len() as f64 { (sum / length).as_vec3() } else { first }
}

/// Cosine of the angle between an axis and the farthest normal of a light.
fn farthest_cos(item: &BuildLight, axis: Vec3, two_sided: bool) -> f64 {
    let between = item.light.axis.as_dvec3().dot(axis.as_dvec3());
    let between = (if two_sided { between.abs() } else { between }).clamp(-1.0, 1.0);
    let spread = f64::from(item.light.cos_theta_o).clamp(-1.0, 1.0);
    // The angles add up to π or more.
    if between <= -spread {
        return -1.0;
    }
    between * spread - ((1.0 - between * between) * (1.0 - spread * spread)).sqrt()
}

/// Sums over a group of lights that estimate its cost: no bounds, but fast to update.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostEstimate {
    pub count: usize,
    bounds: Aabb,
    axes: Vec3,
    power: f32,
    cos_spread: f32,
    cos_emission: f32,
}

impl CostEstimate {
    pub const NONE: Self =
        Self { count: 0, bounds: Aabb::EMPTY, axes: Vec3::ZERO, power: 0.0, cos_spread: 1.0, cos_emission: 1.0 };

    /// Adds a light. The axis of a light that emits from both sides is flipped to the side of
    /// `side`.
    pub fn with_light(self, light: &LightBounds, side: Vec3) -> Self {
        let flip = light.two_sided && light.axis.dot(side) < 0.0;
        Self {
            count: self.count + 1,
            bounds: self.bounds.union(light.bounds),
            axes: if flip { self.axes - light.axis } else { self.axes + light.axis },
            power: self.power + light.power,
            cos_spread: self.cos_spread.min(light.cos_theta_o),
            cos_emission: self.cos_emission.min(light.cos_theta_e),
        }
    }

    pub fn union(self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            bounds: self.bounds.union(other.bounds),
            axes: self.axes + other.axes,
            power: self.power + other.power,
            cos_spread: self.cos_spread.min(other.cos_spread),
            cos_emission: self.cos_emission.min(other.cos_emission),
        }
    }

    /// Edge lengths of the bounding box.
    pub fn extent(&self) -> Vec3 {
        self.bounds.extent()
    }

    /// Cost of the group: power times solid angle times size (Conty Estevez and Kulla, equations 1
    /// and 2, with the squared diagonal of the box instead of its area, which vanishes on a line).
    pub fn cost(&self) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let size = f64::from(self.bounds.extent().length_squared());
        f64::from(self.power) * self.orientation() * size
    }

    /// Solid angle of emission, weighted by the cosine beyond the normals. The spread of the axes
    /// is estimated from the length of their mean, which is (1 + cos θ) / 2 if they fill a cone of
    /// half angle θ uniformly.
    fn orientation(&self) -> f64 {
        // Normals in all directions: the value of the formula, to the last bit.
        if self.cos_spread <= -1.0 {
            return 4.0 * PI;
        }
        let mean = f64::from(self.axes.length()) / self.count as f64;
        let angle = |cos: f64| portable::acos_f64(cos.clamp(-1.0, 1.0));
        let spread = (angle(2.0 * mean - 1.0) + angle(f64::from(self.cos_spread))).min(PI);
        let reach = (spread + angle(f64::from(self.cos_emission))).min(PI);
        solid_angle(spread, reach)
    }
}

/// Solid angle within `spread` of an axis, and from there to `reach` weighted by the cosine of the
/// angle beyond `spread`; angles in radians.
pub(super) fn solid_angle(spread: f64, reach: f64) -> f64 {
    let (sin, cos) = portable::sin_cos_f64(spread);
    let beyond = 2.0 * reach * sin - portable::cos_f64(spread - 2.0 * reach) - 2.0 * spread * sin + cos;
    2.0 * PI * (1.0 - cos) + 0.5 * PI * beyond
}
