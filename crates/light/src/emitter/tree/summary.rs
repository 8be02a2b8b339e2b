//! What several lights can do at most together, and what a group of them would cost.

use super::LightBounds;
use juggler_math::{Aabb, DVec3, Vec3, fun};
use std::f64::consts::PI;

/// A light while the tree is built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub index: u32,
    /// Of its box.
    pub center: Vec3,
    /// In the tree's coordinates, with the power in units of the strongest light's.
    pub light: LightBounds,
}

/// Bounds of some lights as a node's slot holds them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Summary {
    pub center: Vec3,
    pub radius: f32,
    pub axis: Vec3,
    pub cos_spread: f32,
    pub cos_emission: f32,
    pub power: f32,
    pub two_sided: bool,
    pub facing: Facing,
}

/// How much of the greatest light leaves some lights in a direction ω, about, in the mean by power: a + b·ω + ω·C ω, the
/// spherical harmonics up to the second order, with C symmetric and without trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facing {
    pub constant: f32,
    pub linear: Vec3,
    /// xx, yy, xy, xz, yz; the last three twice, as they count.
    pub quadratic: [f32; 5],
}

impl Facing {
    /// No less than the bounds say.
    const ANY: Self = Self { constant: 1.0, linear: Vec3::ZERO, quadratic: [0.0; 5] };

    /// The clamped cosine of flat lights (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps,
    /// 2001, equation 8): 1/4 + c/2 + 5/32 (3 c² - 1), on both sides 1/2 + 5/16 (3 c² - 1). All others, and one light
    /// alone, are taken for what their bounds say. `power` is that of all together.
    fn of(items: &[Item], power: f64) -> Self {
        if items.len() < 2 {
            return Self::ANY;
        }
        let mut sum = [0.0; 9];
        for item in items {
            let weight = f64::from(item.light.power);
            let terms = Self::terms(&item.light);
            sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term);
        }
        let [constant, x, y, z, quadratic @ ..] = sum.map(|sum| (sum / power) as f32);
        Self { constant, linear: Vec3::new(x, y, z), quadratic }
    }

    fn terms(light: &LightBounds) -> [f64; 9] {
        const FLAT: f32 = 0.999;
        let mut terms = [0.0; 9];
        if light.cos_theta_o < FLAT || light.cos_theta_e.abs() > 1.0 - FLAT {
            terms[0] = 1.0;
            return terms;
        }
        let n = light.axis.as_dvec3();
        let (constant, linear, quadratic) =
            if light.two_sided { (0.5, 0.0, 15.0 / 16.0) } else { (0.25, 0.5, 15.0 / 32.0) };
        let third = 1.0 / 3.0;
        let squares = [n.x * n.x - third, n.y * n.y - third];
        let products = [2.0 * n.x * n.y, 2.0 * n.x * n.z, 2.0 * n.y * n.z];
        terms[0] = constant;
        terms[1..4].copy_from_slice(&(n * linear).to_array());
        terms[4..6].copy_from_slice(&squares.map(|square| quadratic * square));
        terms[6..].copy_from_slice(&products.map(|product| quadratic * product));
        terms
    }
}

impl Summary {
    /// Certain bounds: a ball around the box, its centre that of the power, the cone around all cones, the widest emission.
    pub fn of(items: &[Item]) -> Self {
        /// Balls are that much larger than they are, in total: more than the rounding of angles close to a right one.
        const RADIUS_SLACK: f64 = 1e-4;
        /// No ball is smaller, so that squares stay far from 0.
        const LEAST_RADIUS: f64 = 1e-9;
        const COSINE_SLACK: f64 = 1e-6;
        const EMISSION_SLACK: f32 = 1e-5;
        let bounds = items.iter().fold(Aabb::EMPTY, |sum, item| sum.union(item.light.bounds));
        let power = items.iter().map(|item| f64::from(item.light.power)).sum();
        let center = center(items, power);
        let corner = (bounds.max.as_dvec3() - center.as_dvec3()).max(center.as_dvec3() - bounds.min.as_dvec3());
        let two_sided = items.iter().any(|item| item.light.two_sided);
        let axis = mean_axis(items, two_sided);
        let cos = items.iter().map(|item| widest(item, axis, two_sided)).fold(1.0, f64::min);
        let emission = items.iter().map(|item| item.light.cos_theta_e).fold(1.0, f32::min);
        Self {
            center,
            radius: (corner.length() * (1.0 + RADIUS_SLACK)).max(LEAST_RADIUS) as f32,
            axis,
            cos_spread: (cos - COSINE_SLACK).max(-1.0) as f32,
            cos_emission: emission - EMISSION_SLACK,
            power: power as f32,
            two_sided,
            facing: Facing::of(items, power),
        }
    }
}

/// The centre of their power.
fn center(items: &[Item], power: f64) -> Vec3 {
    let sum: DVec3 = items.iter().map(|item| item.center.as_dvec3() * f64::from(item.light.power)).sum();
    (sum / power).as_vec3()
}

/// An axis in the middle of all. Where both sides count, axes are turned to the side of the first.
fn mean_axis(items: &[Item], two_sided: bool) -> Vec3 {
    let first = items.first().map_or(Vec3::Z, |item| item.light.axis);
    let turned = |axis: Vec3| if two_sided && axis.dot(first) < 0.0 { -axis } else { axis };
    let sum: DVec3 = items.iter().map(|item| turned(item.light.axis).as_dvec3()).sum();
    let length = sum.length();
    if length > 1e-6 * items.len() as f64 { (sum / length).as_vec3() } else { first }
}

/// Cosine of the angle between an axis and the farthest normal of a light.
fn widest(item: &Item, axis: Vec3, two_sided: bool) -> f64 {
    let between = item.light.axis.as_dvec3().dot(axis.as_dvec3());
    let between = (if two_sided { between.abs() } else { between }).clamp(-1.0, 1.0);
    let spread = f64::from(item.light.cos_theta_o).clamp(-1.0, 1.0);
    // Together half a turn or more.
    if between <= -spread {
        return -1.0;
    }
    between * spread - ((1.0 - between * between) * (1.0 - spread * spread)).sqrt()
}

/// Sums over some lights from which the cost of a group of them is estimated: not bounds, but quickly made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tally {
    pub count: usize,
    bounds: Aabb,
    axes: Vec3,
    power: f32,
    cos_spread: f32,
    cos_emission: f32,
}

impl Tally {
    pub const NONE: Self =
        Self { count: 0, bounds: Aabb::EMPTY, axes: Vec3::ZERO, power: 0.0, cos_spread: 1.0, cos_emission: 1.0 };

    /// With one more light; the axis of one that shines to both sides is turned to the side of `side`.
    pub fn with(self, light: &LightBounds, side: Vec3) -> Self {
        let turn = light.two_sided && light.axis.dot(side) < 0.0;
        Self {
            count: self.count + 1,
            bounds: self.bounds.union(light.bounds),
            axes: if turn { self.axes - light.axis } else { self.axes + light.axis },
            power: self.power + light.power,
            cos_spread: self.cos_spread.min(light.cos_theta_o),
            cos_emission: self.cos_emission.min(light.cos_theta_e),
        }
    }

    pub fn joined(self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            bounds: self.bounds.union(other.bounds),
            axes: self.axes + other.axes,
            power: self.power + other.power,
            cos_spread: self.cos_spread.min(other.cos_spread),
            cos_emission: self.cos_emission.min(other.cos_emission),
        }
    }

    /// Edges of the box around them.
    pub fn extent(&self) -> Vec3 {
        self.bounds.extent()
    }

    /// Power times solid angle times size: what a bound around these lights hides (Conty Estevez and Kulla, equations
    /// 1 and 2, with the square of the box's diagonal for its area, which vanishes on a line).
    pub fn cost(&self) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let size = f64::from(self.bounds.extent().length_squared());
        f64::from(self.power) * self.orientation() * size
    }

    /// The solid angle into which they shine, weighted by the cosine beyond the normals. How far the axes differ is
    /// estimated from the length of their mean: (1 + cos θ) / 2 where they fill a cone of half angle θ evenly.
    fn orientation(&self) -> f64 {
        // Normals in all directions: the formula's value, to the last bit.
        if self.cos_spread <= -1.0 {
            return 4.0 * PI;
        }
        let mean = f64::from(self.axes.length()) / self.count as f64;
        let angle = |cos: f64| fun::acos_f64(cos.clamp(-1.0, 1.0));
        let spread = (angle(2.0 * mean - 1.0) + angle(f64::from(self.cos_spread))).min(PI);
        let reach = (spread + angle(f64::from(self.cos_emission))).min(PI);
        solid_angle(spread, reach)
    }
}

/// Solid angle within `spread` of an axis, and beyond it up to `reach` weighted by the cosine of the angle past `spread`.
pub(super) fn solid_angle(spread: f64, reach: f64) -> f64 {
    let (sin, cos) = fun::sin_cos_f64(spread);
    let beyond = 2.0 * reach * sin - fun::cos_f64(spread - 2.0 * reach) - 2.0 * spread * sin + cos;
    2.0 * PI * (1.0 - cos) + 0.5 * PI * beyond
}
