//! Node of eight children, and their importances at a point.
//!
//! All loops run over eight numbers without branches, so that the compiler vectorizes them for the
//! instruction set of the caller (hence `inline(always)`). Sums, products, quotients and square
//! roots give the same bits on all machines.

use super::child_bounds::ChildBounds;
use juggler_math::Vec3;

/// Children per node.
pub(super) const WIDTH: usize = 8;

type Lanes = [f32; WIDTH];

/// Slack of a squared sine that is computed from a cosine. Near 0 it loses its digits to rounding;
/// a sine that is too large widens the bound of an angle and never narrows it.
const SINE_SLACK: f32 = 1e-6;

/// Cosine up to which a child below the plane counts as on the plane.
const PLANE_SLACK: f32 = 1e-5;

/// Lower bounds on the cosines where light may arrive.
const MIN_COS_EMISSION: f32 = 1e-3;
const MIN_COS_SURFACE: f32 = 1e-4;

/// Lower bound on the mean emission of several lights in a direction, times the sine of the half
/// angle that their bounding sphere subtends: a nearby point sees the lights from different sides.
const MIN_EMISSION_PROFILE: f32 = 0.2;

/// Approximate increase of the mean 1/d² factor from the surface of a bounding sphere to its
/// center.
const CENTER_BOOST: f32 = 3.0;

/// Bit of a child's number that marks a light; otherwise the number is that of a node.
const LIGHT: u32 = 1 << 31;

/// Eight children in structure-of-arrays layout.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    /// Center of the child's bounding sphere.
    center: [Lanes; 3],
    /// Radius of the bounding sphere, slightly enlarged, with a minimum that keeps squares away
    /// from 0.
    radius: Lanes,
    /// Axis of the cone of normals.
    axis: [Lanes; 3],
    /// Cosine and sine of the cone's half angle.
    cos_spread: Lanes,
    sin_spread: Lanes,
    /// Cosine of the largest angle between a normal and the emitted light, slightly reduced.
    cos_emission: Lanes,
    /// 0 for a child that emits from both sides; otherwise a number that excludes the cosine of the
    /// back.
    back_offset: Lanes,
    /// Emission profile over directions: constant, linear and quadratic terms.
    constant: Lanes,
    linear: [Lanes; 3],
    quadratic: [Lanes; 5],
    /// Power relative to the strongest light; 0 in an empty slot.
    power: Lanes,
    child: [u32; WIDTH],
}

/// Content of a slot, by index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Child {
    Node(usize),
    Light(u32),
}

/// Shading point in the tree's coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadingContext {
    point: Vec3,
    normal: Vec3,
    /// Lower bound on the cosine at the point; 1 if the cosine does not count.
    min_cos_surface: f32,
}

impl ShadingContext {
    #[inline(always)]
    pub fn new(point: Vec3, normal: Vec3) -> Self {
        Self { point, normal, min_cos_surface: if normal == Vec3::ZERO { 1.0 } else { MIN_COS_SURFACE } }
    }
}

impl Node {
    /// Creates a node without children.
    pub fn empty() -> Self {
        Self {
            center: [[0.0; WIDTH]; 3],
            radius: [1.0; WIDTH],
            axis: [[0.0; WIDTH]; 3],
            cos_spread: [1.0; WIDTH],
            sin_spread: [0.0; WIDTH],
            cos_emission: [0.0; WIDTH],
            back_offset: [0.0; WIDTH],
            constant: [0.0; WIDTH],
            linear: [[0.0; WIDTH]; 3],
            quadratic: [[0.0; WIDTH]; 5],
            power: [0.0; WIDTH],
            child: [LIGHT; WIDTH],
        }
    }

    /// Stores a child in a slot.
    pub fn set(&mut self, slot: usize, bounds: &ChildBounds, child: Child) {
        for axis in 0..3 {
            self.center[axis][slot] = bounds.center[axis];
            self.axis[axis][slot] = bounds.axis[axis];
            self.linear[axis][slot] = bounds.emission.linear[axis];
        }
        for (values, number) in self.quadratic.iter_mut().zip(bounds.emission.quadratic) {
            values[slot] = number;
        }
        self.constant[slot] = bounds.emission.constant;
        self.radius[slot] = bounds.radius;
        self.cos_spread[slot] = bounds.cos_spread;
        self.sin_spread[slot] = (1.0 - f64::from(bounds.cos_spread) * f64::from(bounds.cos_spread)).sqrt() as f32;
        self.cos_emission[slot] = bounds.cos_emission;
        self.back_offset[slot] = if bounds.two_sided { 0.0 } else { -4.0 };
        self.power[slot] = bounds.power;
        self.child[slot] = match child {
            Child::Node(index) => index as u32,
            Child::Light(index) => index | LIGHT,
        };
    }

    #[inline(always)]
    pub fn child(&self, slot: usize) -> Child {
        let child = self.child[slot & (WIDTH - 1)];
        if child & LIGHT == 0 { Child::Node(child as usize) } else { Child::Light(child & !LIGHT) }
    }

    /// Importance of each child at a shading point, or 0 if certainly no light arrives. The latter
    /// follows from cos θ' and cos θ'ᵢ: θ' is the angle to the cone of normals and θ'ᵢ the angle to
    /// the shading normal, both reduced by the half angle that the child's bounding sphere
    /// subtends. The importance is the power, times the emission in that direction, times the
    /// cosine at the plane, over d², each averaged over the sphere's lights. Bounds instead of
    /// averages give far more noise (docs/notes/path-tracing.md).
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "a plain loop is made a vector loop")]
    pub fn importances(&self, context: &ShadingContext) -> Importances {
        let (p, n) = (context.point, context.normal);
        let mut importances = [0.0; WIDTH];
        for i in 0..WIDTH {
            let to = [self.center[0][i] - p.x, self.center[1][i] - p.y, self.center[2][i] - p.z];
            let squared = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
            let radius_squared = self.radius[i] * self.radius[i];
            let outside = squared > radius_squared;
            let inverse = 1.0 / select(outside, squared, radius_squared).sqrt();

            // Compute the half angle of the bounding sphere (all directions from inside), and of
            // the cone and the sphere together.
            let sin_sphere = self.radius[i] * inverse;
            let cos_sphere = select(outside, max(1.0 - sin_sphere * sin_sphere, 0.0).sqrt(), -1.0);
            let (cos_cone, sin_cone) = (self.cos_spread[i], self.sin_spread[i]);
            let cos_both = cos_cone * cos_sphere - sin_cone * sin_sphere;
            let sin_both = sin_cone * cos_sphere + cos_cone * sin_sphere;
            let narrow = outside & (sin_both > 0.0);

            let along_axis = to[0] * self.axis[0][i] + to[1] * self.axis[1][i] + to[2] * self.axis[2][i];
            let front = -along_axis * inverse;
            let cos_axis = max(front, self.back_offset[i] - front);
            let cos_leaving = select(narrow, cos_difference(cos_axis, cos_both, sin_both), 1.0);

            let cos_plane = (to[0] * n.x + to[1] * n.y + to[2] * n.z) * inverse;
            let may_arrive = (cos_leaving > self.cos_emission[i]) & (cos_plane > -PLANE_SLACK - sin_sphere);
            let emitted = max(
                self.emission_profile(i, to.map(|component| -component * inverse)),
                MIN_EMISSION_PROFILE * sin_sphere,
            );
            let leaving = max(select(emitted < cos_leaving, emitted, cos_leaving), MIN_COS_EMISSION);
            let arriving = max(mean_clamped_cos(cos_plane, sin_sphere), context.min_cos_surface);
            let nearness = (inverse * inverse) * (1.0 + CENTER_BOOST * (1.0 - squared * (inverse * inverse)));
            importances[i] = select(may_arrive, self.power[i] * leaving * arriving * nearness, 0.0);
        }
        Importances::new(importances)
    }

    /// [`EmissionProfile`](super::emission_profile::EmissionProfile) of a child in a direction `w`.
    /// A `w` shorter than 1 gives the mean over the directions around it.
    #[inline(always)]
    fn emission_profile(&self, child: usize, w: [f32; 3]) -> f32 {
        let (l, q) = (&self.linear, &self.quadratic);
        let linear = l[0][child] * w[0] + l[1][child] * w[1] + l[2][child] * w[2];
        let zz = w[2] * w[2];
        let squares = q[0][child] * (w[0] * w[0] - zz) + q[1][child] * (w[1] * w[1] - zz);
        let products = q[2][child] * w[0] * w[1] + q[3][child] * w[0] * w[2] + q[4][child] * w[1] * w[2];
        self.constant[child] + linear + squares + products
    }
}

/// Importances of the children of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Importances {
    values: Lanes,
    /// Prefix sums of the importances.
    prefix_sums: Lanes,
}

impl Importances {
    #[inline(always)]
    fn new(values: Lanes) -> Self {
        // Sum both halves in parallel. Each sum extends the one before, so the sums never decrease.
        let mut prefix_sums = values;
        for i in 1..WIDTH / 2 {
            prefix_sums[i] += prefix_sums[i - 1];
            prefix_sums[WIDTH / 2 + i] += prefix_sums[WIDTH / 2 + i - 1];
        }
        let half = prefix_sums[WIDTH / 2 - 1];
        prefix_sums[WIDTH / 2..].iter_mut().for_each(|sum| *sum += half);
        Self { values, prefix_sums }
    }

    /// These importances, or the powers if all are 0: the bounds of a node are wider than those of
    /// its children, so a node may be selected although no child can illuminate the point.
    #[inline(always)]
    pub fn or_by_power(self, node: &Node) -> Self {
        if self.prefix_sums[WIDTH - 1] > 0.0 { self } else { Self::new(node.power) }
    }

    /// Selects a slot with `u` in [0, 1): the slot, its probability, and `u` rescaled to [0, 1).
    /// `None` if all importances are 0.
    #[inline(always)]
    pub fn sample(&self, u: f32) -> Option<(usize, f32, f32)> {
        let total = self.prefix_sums[WIDTH - 1];
        let target = u * total;
        // The target is below the total because u is below 1, so the importance of the slot is
        // above 0.
        let slot = self.prefix_sums.iter().map(|sum| usize::from(*sum <= target)).sum::<usize>();
        if slot >= WIDTH {
            return None;
        }
        let below = if slot == 0 { 0.0 } else { self.prefix_sums[slot - 1] };
        let rest = (target - below) / self.values[slot];
        Some((slot, self.values[slot] / total, rest.clamp(0.0, 1f32.next_down())))
    }

    /// Probability of a slot.
    #[inline(always)]
    pub fn probability(&self, slot: usize) -> f32 {
        let total = self.prefix_sums[WIDTH - 1];
        if total > 0.0 { self.values[slot] / total } else { 0.0 }
    }
}

/// Cosine of the difference of two angles, which is at least 0. The first angle is given by its
/// cosine, the second by its cosine and sine.
#[inline(always)]
fn cos_difference(cos: f32, cos_other: f32, sin_other: f32) -> f32 {
    let sin = (max(1.0 - cos * cos, 0.0) + SINE_SLACK).sqrt();
    select(cos >= cos_other, 1.0, cos * cos_other + sin * sin_other)
}

/// Approximate mean of the cosine, clamped at 0 below the plane, over a sphere that subtends a half
/// angle with the sine `sin_sphere`: a parabola where the plane intersects the sphere.
#[inline(always)]
fn mean_clamped_cos(cos_center: f32, sin_sphere: f32) -> f32 {
    let rise = max(cos_center + sin_sphere, 0.0);
    select(cos_center > sin_sphere, cos_center, rise * rise / (4.0 * sin_sphere))
}

/// Maximum by a plain comparison, which is a single instruction.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn select(which: bool, yes: f32, no: f32) -> f32 {
    if which { yes } else { no }
}
